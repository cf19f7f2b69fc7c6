import { counted, fixed, forceText } from "../base/format";
import { length } from "../base/vec3";
import { Level } from "../wire/rhexis_generated";
import type { Body, Hello, RecordUse, Role, State } from "../protocol/messages";

/** ms: a force law older than this is felt as a lag. */
export const kLateLaw = 100;
/** ms: a step of the physics longer than this is seen as a halt of the picture. */
export const kLateStep = 250;

/** Something that is not as it should be while it lasts. */
export interface Trouble {
  readonly id: string;
  readonly level: Level;
  readonly text: string;
  /** What changes while it lasts: shown, but not read out again and again. */
  readonly detail: string;
}

export interface Situation {
  readonly hello: Hello | null;
  readonly role: Role | null;
  readonly body: Body | null;
  readonly state: State | null;
}

/** All that is wrong at this moment, in words, the worst first. */
export function troubles(situation: Situation): Trouble[] {
  const { hello, role, body, state } = situation;
  const found: Trouble[] = [];
  const say: Say = (id, level, text, detail = "") => void found.push({ id, level, text, detail });
  if (state !== null) {
    judgePhysics(state, say);
    if (state.limited && state.held) judgeLimit(state, body, say);
    if (state.record !== null) judgeRecord(state.record, say);
    if (state.pieces > 1)
      say("pieces", Level.warning, `The body is in ${counted(state.pieces, "piece")}. What no support holds stays where it came off.`);
  }
  if (hello !== null && !hello.replay && role !== null && !role.hand) say("hand", Level.info, handText(role));
  return found.sort((a, b) => b.level - a.level);
}

type Say = (id: string, level: Level, text: string, detail?: string) => void;

function judgePhysics(state: State, say: Say): void {
  if (state.paused || state.rates === null) return;
  const { snapshotAgeMs, physicsWorstMs } = state.rates;
  if (snapshotAgeMs > kLateLaw)
    say("late", Level.warning, "The physics is late:", `the force is that of the body ${fixed(snapshotAgeMs, 0)} ms ago.`);
  else if (physicsWorstMs > kLateStep)
    say("late", Level.warning, "The physics is late:", `a step took ${fixed(physicsWorstMs, 0)} ms in the last second.`);
}

function judgeLimit(state: State, body: Body | null, say: Say): void {
  const limit = body !== null && body.maxForce > 0 ? `${fixed(body.maxForce, 1)} N` : "its limit";
  say("limited", Level.warning, `The force is cut to ${limit}:`, `the body itself pulls with ${forceText(length(state.bodyForce))} N.`);
}

function judgeRecord(record: RecordUse, say: Say): void {
  const which = `topology ${record.topology} of it answers.`;
  if (record.outside) say("record", Level.warning, "The crack is outside the record:", `the nearest, ${which}`);
  else if (record.pastLast) say("record", Level.warning, "The crack has run on more often than the record knows:", which);
  if (record.tornOff) say("record-point", Level.warning, "What is held has come off in the record. Its force is that of topologies that have it.");
}

function handText(role: Role): string {
  if (!role.handTaken) return "Nobody has the hand. Take it to hold the body or change anything.";
  return "Another page has the hand. You watch; ask for the hand to hold the body or change anything.";
}
