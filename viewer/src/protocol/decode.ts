import * as flatbuffers from "flatbuffers";

import { kZero, type Vec3 } from "../base/vec3";
import * as wire from "../wire/rhexis_generated";
import type { Advance, Body, Edit, Front, Hello, Notice, Rates, Recorded, RecordUse, Role, ServerFrame, State, Timeline, Trial } from "./messages";

const kNoFloats = new Float32Array(0);
const kNoIndices = new Uint32Array(0);

const vec3 = (v: wire.Vec3 | null): Vec3 => (v === null ? kZero : [v.x(), v.y(), v.z()]);
/** With `Uint8Array`, flatbuffers means texts that were asked for as bytes; none is here. */
const text = (value: string | Uint8Array | null): string => (typeof value === "string" ? value : "");
function list<T>(count: number, at: (k: number) => T): T[] {
  return Array.from({ length: count }, (_, k) => at(k));
}

/** Throws an Error in words for bytes that are no frame of the program's. */
export function decode(bytes: Uint8Array): ServerFrame {
  const buffer = new flatbuffers.ByteBuffer(bytes);
  if (bytes.length < 8 || !wire.Frame.bufferHasIdentifier(buffer)) throw new Error("not a frame of Rhexis");
  const frame = wire.Frame.getRootAsFrame(buffer);
  switch (frame.payloadType()) {
    case wire.Payload.State:
      return { kind: "state", state: readState(frame.payload(new wire.State()) as wire.State) };
    case wire.Payload.Edit:
      return { kind: "edit", edit: readEdit(frame.payload(new wire.Edit()) as wire.Edit) };
    case wire.Payload.Body:
      return { kind: "body", body: readBody(frame.payload(new wire.Body()) as wire.Body) };
    case wire.Payload.Hello:
      return { kind: "hello", hello: readHello(frame.payload(new wire.Hello()) as wire.Hello) };
    case wire.Payload.Role:
      return { kind: "role", role: readRole(frame.payload(new wire.Role()) as wire.Role) };
    case wire.Payload.Notice:
      return { kind: "notice", notice: readNotice(frame.payload(new wire.Notice()) as wire.Notice) };
    case wire.Payload.Timeline:
      return { kind: "timeline", timeline: readTimeline(frame.payload(new wire.Timeline()) as wire.Timeline) };
    case wire.Payload.Recorded:
      return { kind: "recorded", recorded: readRecorded(frame.payload(new wire.Recorded()) as wire.Recorded) };
    case wire.Payload.Trial:
      return { kind: "trial", trial: readTrial(frame.payload(new wire.Trial()) as wire.Trial) };
    case wire.Payload.Pong:
      return { kind: "pong", number: Number((frame.payload(new wire.Pong()) as wire.Pong).number()) };
    default:
      throw new Error("a frame of a kind that this page does not know (the page and the program differ in version)");
  }
}

function readHello(hello: wire.Hello): Hello {
  return {
    version: text(hello.version()),
    scenes: list(hello.scenesLength(), (k) => text(hello.scenes(k))),
    devices: list(hello.devicesLength(), (k) => text(hello.devices(k))),
    declarations: text(hello.declarations()),
    replay: hello.replay(),
  };
}

function readRole(role: wire.Role): Role {
  return { hand: role.hand(), handTaken: role.handTaken(), clients: role.clients() };
}

function readFront(front: wire.Front | null): Front {
  if (front === null) return { points: [], finished: true };
  return { points: list(front.pointsLength(), (k) => vec3(front.points(k))), finished: front.finished() };
}

function readAdvance(advance: wire.Advance): Advance {
  return {
    topology: advance.topology(),
    time: advance.time(),
    started: advance.started(),
    length: advance.length(),
    angle: advance.angle(),
    tetsRemoved: advance.tetsRemoved(),
    pieces: advance.pieces(),
    volumeLost: advance.volumeLost(),
    milliseconds: advance.milliseconds(),
    forceBefore: vec3(advance.forceBefore()),
    forceAfter: vec3(advance.forceAfter()),
  };
}

function readBody(body: wire.Body): Body {
  return {
    scene: text(body.scene()),
    title: text(body.title()),
    model: text(body.model()),
    epoch: body.epoch(),
    topology: body.topology(),
    nodes: body.nodes(),
    tets: body.tets(),
    positions: body.positionsArray() ?? kNoFloats,
    node: body.nodeArray() ?? kNoIndices,
    faces: body.facesArray() ?? kNoIndices,
    local: body.localArray() ?? kNoIndices,
    held: body.heldArray() ?? kNoIndices,
    fronts: list(body.frontsLength(), (k) => readFront(body.fronts(k))),
    advances: list(body.advancesLength(), (k) => body.advances(k))
      .filter((advance): advance is wire.Advance => advance !== null)
      .map(readAdvance),
    meanEdge: body.meanEdge(),
    maxForce: body.maxForce(),
    values: text(body.values()),
    script: body.script(),
    response: text(body.response()),
    hasRecord: body.hasRecord(),
  };
}

function readEdit(edit: wire.Edit): Edit {
  const advance = edit.advance();
  return {
    epoch: edit.epoch(),
    topology: edit.topology(),
    moved: edit.movedArray() ?? kNoIndices,
    movedTo: edit.movedToArray() ?? kNoFloats,
    newPositions: edit.newPositionsArray() ?? kNoFloats,
    newNode: edit.newNodeArray() ?? kNoIndices,
    gone: edit.goneArray() ?? kNoIndices,
    slots: edit.slotsArray() ?? kNoIndices,
    faces: edit.facesArray() ?? kNoIndices,
    local: edit.localArray() ?? kNoIndices,
    fronts: list(edit.frontsLength(), (k) => readFront(edit.fronts(k))),
    advance: advance === null ? null : readAdvance(advance),
  };
}

function readRates(rates: wire.Rates | null): Rates | null {
  if (rates === null) return null;
  return {
    physicsHz: rates.physicsHz(),
    physicsWorstMs: rates.physicsWorstMs(),
    hapticHz: rates.hapticHz(),
    hapticWorstUs: rates.hapticWorstUs(),
    hapticMissed: Number(rates.hapticMissed()),
    snapshotAgeMs: rates.snapshotAgeMs(),
    realtime: rates.realtime(),
  };
}

function readRecordUse(use: wire.RecordUse | null): RecordUse | null {
  if (use === null) return null;
  return { topology: use.topology(), outside: use.outside(), pastLast: use.pastLast(), tornOff: use.tornOff() };
}

function readState(state: wire.State): State {
  const compared = state.comparedForce();
  return {
    epoch: state.epoch(),
    topology: state.topology(),
    tick: Number(state.tick()),
    time: state.time(),
    displacement: state.displacementArray() ?? kNoFloats,
    field: state.field(),
    values: state.valuesArray() ?? kNoFloats,
    held: state.held(),
    heldFace: state.heldFace(),
    heldWeights: vec3(state.heldWeights()),
    hand: vec3(state.hand()),
    force: vec3(state.force()),
    bodyForce: vec3(state.bodyForce()),
    limited: state.limited(),
    handWork: state.handWork(),
    storedEnergy: state.storedEnergy(),
    crackArea: state.crackArea(),
    advances: state.advances(),
    pieces: state.pieces(),
    paused: state.paused(),
    scripted: state.scripted(),
    recording: state.recording(),
    rates: readRates(state.rates()),
    traceTick: Number(state.traceTick()),
    trace: state.traceArray() ?? kNoFloats,
    record: readRecordUse(state.record()),
    comparedForce: compared === null ? null : vec3(compared),
  };
}

function readNotice(notice: wire.Notice): Notice {
  return { level: notice.level(), text: text(notice.text()) };
}

function readTimeline(timeline: wire.Timeline): Timeline {
  return {
    duration: timeline.duration(),
    time: timeline.time(),
    speed: timeline.speed(),
    playing: timeline.playing(),
    marks: Array.from(timeline.marksArray() ?? []),
  };
}

function readRecorded(recorded: wire.Recorded): Recorded {
  return { file: text(recorded.file()), bytes: Number(recorded.bytes()), seconds: recorded.seconds() };
}

function readTrial(trial: wire.Trial): Trial {
  return {
    title: text(trial.title()),
    number: trial.number(),
    runsDone: trial.runsDone(),
    runs: trial.runs(),
    presented: trial.presented(),
    felt: { [wire.Presented.sample]: trial.feltSample(), [wire.Presented.a]: trial.feltA(), [wire.Presented.b]: trial.feltB() },
    point: vec3(trial.point()),
    direction: vec3(trial.direction()),
    showsForce: trial.showsForce(),
    finished: trial.finished(),
    file: text(trial.file()),
  };
}
