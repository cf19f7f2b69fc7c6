import type { Vec3 } from "../base/vec3";
import type { Field, Level, Presented } from "../wire/rhexis_generated";

/**
 * The frames of schema/rhexis.fbs as the page knows them: plain data, nothing absent. Units and meaning stand in the
 * schema; long lists are views of the frame that they came in.
 */

export interface Front {
  readonly points: readonly Vec3[];
  readonly finished: boolean;
}

export interface Advance {
  readonly topology: number;
  readonly time: number;
  readonly started: boolean;
  readonly length: number;
  readonly angle: number;
  readonly tetsRemoved: number;
  readonly pieces: number;
  readonly volumeLost: number;
  readonly milliseconds: number;
  readonly forceBefore: Vec3;
  readonly forceAfter: Vec3;
}

export interface Hello {
  readonly version: string;
  readonly scenes: readonly string[];
  readonly devices: readonly string[];
  readonly declarations: string;
  readonly replay: boolean;
}

export interface Role {
  readonly hand: boolean;
  readonly handTaken: boolean;
  readonly clients: number;
}

/** Which part of a record answers, and what it does not know. */
export interface RecordUse {
  readonly topology: number;
  readonly outside: boolean;
  readonly pastLast: boolean;
  readonly tornOff: boolean;
}

export interface Body {
  readonly scene: string;
  readonly title: string;
  readonly model: string;
  readonly epoch: number;
  readonly topology: number;
  readonly nodes: number;
  readonly tets: number;
  readonly positions: Float32Array;
  readonly node: Uint32Array;
  readonly faces: Uint32Array;
  readonly local: Uint32Array;
  readonly held: Uint32Array;
  readonly fronts: readonly Front[];
  readonly advances: readonly Advance[];
  readonly meanEdge: number;
  readonly maxForce: number;
  readonly values: string;
  readonly script: number;
  readonly response: string;
  readonly hasRecord: boolean;
}

export interface Edit {
  readonly epoch: number;
  readonly topology: number;
  readonly moved: Uint32Array;
  readonly movedTo: Float32Array;
  readonly newPositions: Float32Array;
  readonly newNode: Uint32Array;
  readonly gone: Uint32Array;
  readonly slots: Uint32Array;
  readonly faces: Uint32Array;
  readonly local: Uint32Array;
  readonly fronts: readonly Front[];
  readonly advance: Advance | null;
}

export interface Rates {
  readonly physicsHz: number;
  readonly physicsWorstMs: number;
  readonly hapticHz: number;
  readonly hapticWorstUs: number;
  readonly hapticMissed: number;
  readonly snapshotAgeMs: number;
  readonly realtime: boolean;
}

export interface State {
  readonly epoch: number;
  readonly topology: number;
  readonly tick: number;
  readonly time: number;
  readonly displacement: Float32Array;
  readonly field: Field;
  readonly values: Float32Array;
  readonly held: boolean;
  readonly heldFace: number;
  readonly heldWeights: Vec3;
  readonly hand: Vec3;
  readonly force: Vec3;
  readonly bodyForce: Vec3;
  readonly limited: boolean;
  readonly handWork: number;
  readonly storedEnergy: number;
  readonly crackArea: number;
  readonly advances: number;
  readonly pieces: number;
  readonly paused: boolean;
  readonly scripted: boolean;
  readonly recording: boolean;
  readonly rates: Rates | null;
  readonly traceTick: number;
  readonly trace: Float32Array;
  readonly record: RecordUse | null;
  /** null: none is compared. */
  readonly comparedForce: Vec3 | null;
}

export interface Notice {
  readonly level: Level;
  readonly text: string;
}

export interface Timeline {
  readonly duration: number;
  readonly time: number;
  readonly speed: number;
  readonly playing: boolean;
  readonly marks: readonly number[];
}

export interface Recorded {
  readonly file: string;
  readonly bytes: number;
  readonly seconds: number;
}

/** An experiment, where it stands. */
export interface Trial {
  readonly title: string;
  readonly number: number;
  readonly runsDone: number;
  readonly runs: number;
  readonly presented: Presented;
  readonly felt: Readonly<Record<Presented, boolean>>;
  readonly point: Vec3;
  readonly direction: Vec3;
  readonly showsForce: boolean;
  readonly finished: boolean;
  readonly file: string;
}

export type ServerFrame =
  | { readonly kind: "hello"; readonly hello: Hello }
  | { readonly kind: "role"; readonly role: Role }
  | { readonly kind: "body"; readonly body: Body }
  | { readonly kind: "edit"; readonly edit: Edit }
  | { readonly kind: "state"; readonly state: State }
  | { readonly kind: "notice"; readonly notice: Notice }
  | { readonly kind: "timeline"; readonly timeline: Timeline }
  | { readonly kind: "recorded"; readonly recorded: Recorded }
  | { readonly kind: "trial"; readonly trial: Trial }
  | { readonly kind: "pong"; readonly number: number };

export type Command =
  | { readonly kind: "takeHand" | "giveHand" | "letGo" | "reset" | "undo" }
  | { readonly kind: "grasp"; readonly face: number; readonly weights: Vec3; readonly push: boolean }
  | { readonly kind: "move"; readonly to: Vec3 }
  | { readonly kind: "pause" | "script" | "record" | "compare"; readonly on: boolean }
  | { readonly kind: "step"; readonly ticks: number }
  | { readonly kind: "setValue"; readonly key: string; readonly value: string }
  | { readonly kind: "openScene"; readonly file: string }
  | { readonly kind: "showField"; readonly field: Field }
  | { readonly kind: "feel"; readonly presented: Presented }
  | { readonly kind: "answer"; readonly same: Presented }
  | { readonly kind: "seek"; readonly time: number }
  | { readonly kind: "play"; readonly on: boolean; readonly speed: number }
  | { readonly kind: "ping"; readonly number: number };
