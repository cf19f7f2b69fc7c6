import { WebSocket } from "ws";

import { decode } from "../../src/protocol/decode";
import { encode } from "../../src/protocol/encode";
import type { Command, State } from "../../src/protocol/messages";

/** A second client of the program, which knows nothing of the page: what the session itself says. */
export class Listener {
  readonly states = new Map<number, State>(); // by tick
  advances = 0; // those of the body, and of the edits since
  private readonly socket: WebSocket;

  constructor(port: number) {
    this.socket = new WebSocket(`ws://127.0.0.1:${port}/live`);
    this.socket.on("message", (data: Buffer) => {
      // A copy, since the lists of a frame are views that want to be aligned.
      const frame = decode(new Uint8Array(data));
      if (frame.kind === "state") this.states.set(frame.state.tick, frame.state);
      if (frame.kind === "body") this.advances = frame.body.advances.length;
      if (frame.kind === "edit" && frame.edit.advance !== null) this.advances += 1;
    });
  }

  async ready(): Promise<void> {
    while (this.states.size === 0) await new Promise((done) => setTimeout(done, 20));
  }

  send(command: Command): void {
    this.socket.send(encode(command));
  }

  close(): void {
    this.socket.terminate();
  }
}
