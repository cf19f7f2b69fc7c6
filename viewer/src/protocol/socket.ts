import { kFirstLink, kPingEvery, kSilence, follow, type Link, type LinkEvent } from "./connection";
import { decode } from "./decode";
import { encode } from "./encode";
import type { Command, ServerFrame } from "./messages";

export interface Listener {
  frame(frame: ServerFrame): void;
  linked(link: Link): void;
  /** A frame could not be read, in words. */
  garbled(why: string): void;
}

/** Bytes that wait in the socket above which a Move is left out: the next one says more. */
const kCrowded = 64 * 1024;

/** Keeps a WebSocket open to the program. */
export class LiveSocket {
  private link: Link = kFirstLink;
  private socket: WebSocket | null = null;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private heard = 0; // ms, when the last frame came
  private pings = 0;
  private readonly pingedAt = new Map<number, number>();
  /** ms that a Ping took there and back; null before the first. */
  roundTrip: number | null = null;
  /** ms, of performance.now(): when the next attempt is due. */
  nextAttempt = 0;

  constructor(
    private readonly address: string,
    private readonly listener: Listener,
  ) {
    setInterval(() => this.pulse(), kPingEvery * 1000);
    addEventListener("online", () => this.tryNow());
  }

  get isOpen(): boolean {
    return this.link.kind === "open";
  }

  start(): void {
    this.listener.linked(this.link);
    this.connect();
  }

  tryNow(): void {
    this.happen({ kind: "try now" });
  }

  send(command: Command): void {
    if (!this.isOpen || this.socket === null) return;
    if (command.kind === "move" && this.socket.bufferedAmount > kCrowded) return;
    this.socket.send(encode(command));
  }

  private connect(): void {
    const socket = new WebSocket(this.address);
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    socket.onopen = () => {
      this.heard = performance.now();
      this.roundTrip = null;
      this.pingedAt.clear();
      this.happen({ kind: "opened" });
      this.ping();
    };
    socket.onmessage = (event: MessageEvent<unknown>) => {
      if (event.data instanceof ArrayBuffer) this.hear(new Uint8Array(event.data));
    };
    socket.onclose = (event) => this.lose(socket, event.reason);
  }

  private hear(bytes: Uint8Array): void {
    this.heard = performance.now();
    let frame: ServerFrame;
    try {
      frame = decode(bytes);
    } catch (error) {
      this.listener.garbled(error instanceof Error ? error.message : String(error));
      return;
    }
    if (frame.kind === "pong") {
      const sent = this.pingedAt.get(frame.number);
      if (sent !== undefined) this.roundTrip = this.heard - sent;
      this.pingedAt.delete(frame.number);
    }
    this.listener.frame(frame);
  }

  private lose(socket: WebSocket, why: string): void {
    if (socket !== this.socket) return; // one that was given up before
    this.socket = null;
    this.happen({ kind: "closed", why });
  }

  private ping(): void {
    this.pings += 1;
    this.pingedAt.set(this.pings, performance.now());
    this.send({ kind: "ping", number: this.pings });
  }

  private pulse(): void {
    const socket = this.socket;
    if (!this.isOpen || socket === null) return;
    if (performance.now() - this.heard < kSilence * 1000) return this.ping();
    // A cable that was pulled closes no socket: it is given up from here.
    this.lose(socket, `nothing heard for ${kSilence} s`);
    socket.close();
  }

  private happen(event: LinkEvent): void {
    const [link, action] = follow(this.link, event);
    this.link = link;
    clearTimeout(action === "nothing" && link.kind === "waiting" ? undefined : this.timer);
    if (action === "connect") this.connect();
    if (action === "wait" && link.kind === "waiting") {
      this.nextAttempt = performance.now() + link.seconds * 1000;
      this.timer = setTimeout(() => this.happen({ kind: "waited" }), link.seconds * 1000);
    }
    this.listener.linked(link);
  }
}
