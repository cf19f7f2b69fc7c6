import { Surface } from "../body/surface";
import type { Advance, Body, Hello, Recorded, Role, ServerFrame, State, Timeline, Trial } from "../protocol/messages";
import { Level } from "../wire/rhexis_generated";
import { ForceTrace } from "./trace";

/** Something that happened, in words; kept in the list of messages and read out. */
export interface Event {
  readonly level: Level;
  readonly text: string;
}

/** What a frame changed, so that what shows it is drawn anew and nothing else. */
export type Change = "hello" | "role" | "body" | "edit" | "state" | "timeline" | "trial" | "recorded" | "event" | "pong" | "none";

/** Everything that the page knows of the interaction: what came over the wire, in the order in which it came. */
export class Store {
  hello: Hello | null = null;
  role: Role | null = null;
  body: Body | null = null;
  /** The last of the present body; null until there is one. */
  state: State | null = null;
  timeline: Timeline | null = null;
  /** null: no experiment. */
  trial: Trial | null = null;
  readonly surface = new Surface();
  readonly trace = new ForceTrace();
  /** Of the body itself, before the device's limit, and of the other response; while the two are compared. */
  readonly own = new ForceTrace();
  readonly compared = new ForceTrace();
  advances: Advance[] = [];
  recordings: Recorded[] = [];
  /** Frames taken, refused ones too. */
  frames = 0;

  constructor(private readonly tell: (event: Event) => void) {}

  get hasHand(): boolean {
    return this.role?.hand ?? false;
  }

  take(frame: ServerFrame): Change {
    this.frames += 1;
    switch (frame.kind) {
      case "hello":
        this.hello = frame.hello;
        return "hello";
      case "role":
        this.takeRole(frame.role);
        return "role";
      case "body":
        this.takeBody(frame.body);
        return "body";
      case "edit":
        if (!this.surface.applyEdit(frame.edit)) return "none";
        this.takeAdvance(frame.edit.advance);
        return "edit";
      case "state":
        return this.takeState(frame.state);
      case "timeline":
        this.timeline = frame.timeline;
        return "timeline";
      case "trial":
        this.trial = frame.trial;
        return "trial";
      case "recorded":
        this.recordings = [frame.recorded, ...this.recordings];
        return "recorded";
      case "notice":
        this.tell(frame.notice);
        return "event";
      case "pong":
        return "pong";
    }
  }

  private takeRole(role: Role): void {
    const before = this.role;
    this.role = role;
    if (before !== null && !before.hand && role.hand) this.tell({ level: Level.info, text: "You hold the hand now" });
    if (before !== null && before.hand && !role.hand) this.tell({ level: Level.info, text: "You have given the hand away" });
  }

  private takeBody(body: Body): void {
    this.body = body;
    this.surface.setBody(body);
    this.advances = [...body.advances];
    this.state = null;
  }

  private takeAdvance(advance: Advance | null): void {
    if (advance === null) return;
    this.advances = [...this.advances, advance];
  }

  private takeState(state: State): Change {
    if (!this.surface.applyState(state)) return "none";
    this.trace.add(state.traceTick, state.trace);
    this.compare(state);
    this.state = state;
    return "state";
  }

  private compare(state: State): void {
    if (state.comparedForce !== null) {
      this.own.holdTo(state.tick, state.bodyForce);
      this.compared.holdTo(state.tick, state.comparedForce);
    } else if (this.state?.comparedForce) {
      this.own.clear();
      this.compared.clear();
    }
  }
}
