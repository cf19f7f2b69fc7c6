import { spawn, type ChildProcess } from "node:child_process";
import { existsSync, mkdtempSync } from "node:fs";
import { createServer, type AddressInfo } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";

import { kPage, kRepository } from "./browser";

export const kCommand = process.env["RHEXIS_COMMAND"] ?? join(kRepository, "build/release/bin/rhexis");

export async function freePort(): Promise<number> {
  const server = createServer();
  await new Promise<void>((done) => server.listen(0, "127.0.0.1", done));
  const { port } = server.address() as AddressInfo;
  await new Promise<void>((done) => server.close(() => done()));
  return port;
}

/** Of recordings and whatever else a test leaves. */
export const kScratch = mkdtempSync(join(tmpdir(), "rhexis-e2e-"));

/** A running `rhexis play` or `rhexis replay`, or an experiment with a person. */
export class Program {
  private output = "";

  private constructor(
    private readonly child: ChildProcess,
    readonly port: number,
  ) {
    const keep = (data: Buffer): void => void (this.output = (this.output + String(data)).slice(-8000));
    child.stdout?.on("data", keep);
    child.stderr?.on("data", keep);
  }

  /** `args`: without the port. Comes back when the page can be had. */
  static async start(args: readonly string[], port: number): Promise<Program> {
    if (!existsSync(kCommand)) throw new Error(`there is no ${kCommand} (make builds it; RHEXIS_COMMAND names another)`);
    const child = spawn(kCommand, [...args, "--port", String(port), "--page", kPage, "--recordings", kScratch, "--no-browser"], { cwd: kRepository, stdio: ["ignore", "pipe", "pipe"] });
    const program = new Program(child, port);
    for (let k = 0; k < 900; ++k) {
      if (child.exitCode !== null) throw new Error(`rhexis ended with ${child.exitCode}: ${program.output}`);
      const answer = await fetch(program.url).catch(() => null);
      if (answer?.ok) return program;
      await new Promise((done) => setTimeout(done, 100));
    }
    child.kill("SIGKILL");
    throw new Error(`rhexis does not answer on port ${port}: ${program.output}`);
  }

  get url(): string {
    return `http://127.0.0.1:${this.port}/`;
  }

  /** As Ctrl-C does. Its exit code. */
  async stop(): Promise<number | null> {
    return this.end("SIGINT");
  }

  /** By itself. Its exit code. */
  async ended(): Promise<number | null> {
    if (this.child.exitCode !== null || this.child.signalCode !== null) return this.child.exitCode;
    return new Promise((done) => this.child.once("exit", (code) => done(code)));
  }

  /** As a crash does. */
  async kill(): Promise<void> {
    await this.end("SIGKILL");
  }

  private async end(signal: NodeJS.Signals): Promise<number | null> {
    if (this.child.exitCode !== null || this.child.signalCode !== null) return this.child.exitCode;
    const ended = this.ended();
    this.child.kill(signal);
    return ended;
  }
}
