import { readFile } from "node:fs/promises";
import { createServer, type Server } from "node:http";
import type { AddressInfo } from "node:net";
import { extname, join, normalize } from "node:path";

import * as flatbuffers from "flatbuffers";
import { WebSocketServer, type WebSocket } from "ws";

import * as wire from "../../src/wire/rhexis_generated";
import { Plate, frameOf, kDeclarations, restingState } from "../../test/support/plate";

const kTypes: Readonly<Record<string, string>> = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml" };
/** As the program's own (src/server): the page has to work under it. */
const kPolicy =
  "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; object-src 'none'; base-uri 'none'; form-action 'none'";
const kPeriod = 20; // ms between two States
const kStiffness = 60; // N/m
const kTearAt = 0.03; // m that the hand pulls for each row that is torn

/**
 * Stands in for the program where a test needs what a healthy one will not do: to be late, in pieces, to refuse, to
 * vanish. It knows no mechanics.
 */
export class FakeProgram {
  /** Kinds of the commands that came, in their order. */
  readonly heard: wire.Payload[] = [];
  /** Of the same, what was said with them. */
  readonly said: NonNullable<wire.FrameT["payload"]>[] = [];
  /** Applied to each State before it is sent. */
  change: (state: wire.StateT) => void = () => undefined;
  role = new wire.RoleT(true, true, 1);
  replay = false;
  private http: Server | null = null;
  private sockets: WebSocketServer | null = null;
  private timer: ReturnType<typeof setInterval> | undefined;
  private plate = new Plate();
  private epoch = 1;
  private topology = 0;
  private tick = 0;
  private held: wire.GraspT | null = null;
  private hand: readonly number[] = [0, 0, 0];
  private field = wire.Field.none;
  private paused = false;
  private scripted = false;

  constructor(private readonly page: string) {}

  async start(port = 0): Promise<number> {
    const http = createServer((request, response) => {
      const path = normalize(new URL(request.url ?? "/", "http://x").pathname);
      const file = path === "/" ? "/index.html" : path;
      readFile(join(this.page, file)).then(
        (content) => response.writeHead(200, { "content-type": kTypes[extname(file)] ?? "application/octet-stream", "content-security-policy": kPolicy }).end(content),
        () => response.writeHead(404).end(),
      );
    });
    this.http = http;
    this.sockets = new WebSocketServer({ server: http, path: "/live" });
    this.sockets.on("connection", (socket) => this.welcome(socket));
    await new Promise<void>((done) => http.listen(port, "127.0.0.1", done));
    this.timer = setInterval(() => this.step(), kPeriod);
    return (http.address() as AddressInfo).port;
  }

  async stop(): Promise<void> {
    clearInterval(this.timer);
    for (const client of this.sockets?.clients ?? []) client.terminate();
    this.sockets?.close();
    const http = this.http;
    http?.closeAllConnections();
    await new Promise<void>((done) => (http === null ? done() : http.close(() => done())));
  }

  send(kind: wire.Payload, payload: wire.FrameT["payload"]): void {
    const bytes = frameOf(kind, payload);
    for (const client of this.sockets?.clients ?? []) client.send(bytes);
  }

  setRole(role: wire.RoleT): void {
    this.role = role;
    this.send(wire.Payload.Role, role);
  }

  letGo(): void {
    this.held = null;
    this.hand = [0, 0, 0];
  }

  private welcome(socket: WebSocket): void {
    socket.send(frameOf(wire.Payload.Hello, new wire.HelloT("test", ["scenes/plate-tear.toml", "scenes/bar-tear.toml"], ["pointer"], kDeclarations, this.replay)));
    socket.send(frameOf(wire.Payload.Role, this.role));
    socket.send(frameOf(wire.Payload.Body, this.plate.body(this.epoch, this.topology, "scenes/plate-tear.toml")));
    if (this.replay) socket.send(frameOf(wire.Payload.Timeline, new wire.TimelineT(12, 3, 1, true, [2, 5, 5.5, 9])));
    socket.on("message", (data: Buffer) => this.hear(socket, new Uint8Array(data)));
  }

  private hear(socket: WebSocket, bytes: Uint8Array): void {
    const { payloadType, payload } = wire.Frame.getRootAsFrame(new flatbuffers.ByteBuffer(bytes)).unpack();
    if (payload === null) return;
    if (payload instanceof wire.PingT) return socket.send(frameOf(wire.Payload.Pong, new wire.PongT(payload.number)));
    this.heard.push(payloadType);
    this.said.push(payload);
    if (payload instanceof wire.GraspT) this.held = payload;
    else if (payload instanceof wire.MoveT) this.hand = [payload.to?.x ?? 0, payload.to?.y ?? 0, payload.to?.z ?? 0];
    else if (payload instanceof wire.LetGoT) this.letGo();
    else if (payload instanceof wire.ShowFieldT) this.field = payload.field;
    else if (payload instanceof wire.PauseT) this.paused = payload.on;
    else if (payload instanceof wire.ScriptT) this.scripted = payload.on;
    else if (payload instanceof wire.ResetT || payload instanceof wire.SetValueT) this.makeAnew();
    else if (payload instanceof wire.RecordT && !payload.on) this.send(wire.Payload.Recorded, new wire.RecordedT("2026-01-02.h5", 1_300_000n, 9.5));
  }

  private makeAnew(): void {
    this.letGo();
    this.plate = new Plate();
    this.epoch += 1;
    this.topology = 0;
    this.send(wire.Payload.Body, this.plate.body(this.epoch, 0, "scenes/plate-tear.toml"));
  }

  private step(): void {
    if (!this.paused) this.tick += kPeriod;
    const pull = Math.hypot(...this.hand);
    if (this.held !== null && pull > kTearAt * (this.topology + 1) && this.plate.open < this.plate.cells) {
      this.topology += 1;
      this.send(wire.Payload.Edit, this.plate.tear(this.epoch, this.topology, this.tick / 1000));
    }
    this.send(wire.Payload.State, this.state());
  }

  private state(): wire.StateT {
    const state = restingState(this.plate, this.epoch, this.topology, this.tick);
    if (this.held !== null) {
      const corners = this.plate.faces.slice(3 * this.held.face, 3 * this.held.face + 3);
      const weights = [this.held.weights?.x ?? 0, this.held.weights?.y ?? 0, this.held.weights?.z ?? 0];
      const at = [0, 1, 2].map((c) => corners.reduce((sum, v, k) => sum + (weights[k] ?? 0) * (this.plate.positions[3 * v + c] ?? 0), 0));
      state.displacement = this.plate.displacement(at, this.hand);
      const force = this.hand.map((x) => (-kStiffness * x) / (1 + 0.2 * this.topology));
      state.held = true;
      state.heldFace = this.held.face;
      state.heldWeights = this.held.weights;
      state.hand = new wire.Vec3T(...(this.hand as [number, number, number]));
      state.force = state.bodyForce = new wire.Vec3T(...(force as [number, number, number]));
      state.trace = Array.from({ length: kPeriod }, () => force).flat();
    } else {
      state.trace = new Array<number>(3 * kPeriod).fill(0);
    }
    state.traceTick = BigInt(this.tick);
    state.field = this.field;
    if (this.field !== wire.Field.none) state.values = this.fieldValues(state.displacement);
    state.advances = this.topology;
    state.paused = this.paused;
    state.scripted = this.scripted;
    this.change(state);
    return state;
  }

  private fieldValues(displacement: readonly number[]): number[] {
    const factor = this.field === wire.Field.displacement ? 1 : 4e6;
    const offset = this.field === wire.Field.mean_stress ? -1e4 : 0;
    return Array.from({ length: displacement.length / 3 }, (_, v) => factor * Math.hypot(...displacement.slice(3 * v, 3 * v + 3)) + offset);
  }
}
