import { describe, expect, it } from "vitest";

import { decode } from "../src/protocol/decode";
import { encode } from "../src/protocol/encode";
import * as flatbuffers from "flatbuffers";
import * as wire from "../src/wire/rhexis_generated";
import { Plate, frameOf, kDeclarations, restingState } from "./support/plate";

/** What the program reads of a command. */
function heard(bytes: Uint8Array): wire.FrameT {
  return wire.Frame.getRootAsFrame(new flatbuffers.ByteBuffer(bytes)).unpack();
}

describe("Frames of the program", () => {
  it("give back the body that was sent", () => {
    const plate = new Plate();
    const frame = decode(frameOf(wire.Payload.Body, plate.body(7, 3, "scenes/plate.toml")));
    if (frame.kind !== "body") throw new Error(frame.kind);
    const { body } = frame;
    expect([body.epoch, body.topology, body.nodes, body.scene]).toEqual([7, 3, 162, "scenes/plate.toml"]);
    expect(body.positions).toEqual(new Float32Array(plate.positions));
    expect([...body.faces]).toEqual(plate.faces);
    expect(body.fronts[0]?.points[2]).toEqual([plate.width / 2, 0, plate.thickness]);
    expect(body.maxForce).toBe(8.9);
  });

  it("give back an edit, its advance included, and one without", () => {
    const plate = new Plate();
    const sent = plate.tear(7, 4, 1.5);
    const frame = decode(frameOf(wire.Payload.Edit, sent));
    if (frame.kind !== "edit") throw new Error(frame.kind);
    expect([...frame.edit.slots]).toEqual(sent.slots);
    expect([...frame.edit.newNode]).toEqual([4, 85]);
    expect(frame.edit.advance?.time).toBe(1.5);
    expect(frame.edit.advance?.forceBefore).toEqual([4, 0, 0]);
    sent.advance = null;
    const bare = decode(frameOf(wire.Payload.Edit, sent));
    expect(bare.kind === "edit" && bare.edit.advance).toBe(null);
  });

  it("give back a state to the last bit, ticks beyond 32 bits included", () => {
    const plate = new Plate();
    const sent = restingState(plate, 7, 4, 5_000_000_123);
    sent.force = new wire.Vec3T(0.1, -2 / 3, 1e-300);
    sent.trace = [1, 2, 3];
    sent.traceTick = 5_000_000_000n;
    sent.held = true;
    const frame = decode(frameOf(wire.Payload.State, sent));
    if (frame.kind !== "state") throw new Error(frame.kind);
    expect(frame.state.force).toEqual([0.1, -2 / 3, 1e-300]);
    expect(frame.state.tick).toBe(5_000_000_123);
    expect(frame.state.traceTick).toBe(5_000_000_000);
    expect([...frame.state.trace]).toEqual([1, 2, 3]);
    expect(frame.state.held).toBe(true);
    expect(frame.state.rates?.physicsHz).toBe(480);
  });

  it("give back what is said besides", () => {
    const hello = decode(frameOf(wire.Payload.Hello, new wire.HelloT("1.2", ["a.toml", "b.toml"], ["pointer"], kDeclarations, true)));
    expect(hello).toEqual({ kind: "hello", hello: { version: "1.2", scenes: ["a.toml", "b.toml"], devices: ["pointer"], declarations: kDeclarations, replay: true } });
    expect(decode(frameOf(wire.Payload.Role, new wire.RoleT(true, true, 3)))).toEqual({ kind: "role", role: { hand: true, handTaken: true, clients: 3 } });
    expect(decode(frameOf(wire.Payload.Notice, new wire.NoticeT(wire.Level.error, "no")))).toEqual({ kind: "notice", notice: { level: wire.Level.error, text: "no" } });
    expect(decode(frameOf(wire.Payload.Timeline, new wire.TimelineT(9.5, 2, 0.5, true, [1, 2.25])))).toEqual({
      kind: "timeline",
      timeline: { duration: 9.5, time: 2, speed: 0.5, playing: true, marks: [1, 2.25] },
    });
    expect(decode(frameOf(wire.Payload.Recorded, new wire.RecordedT("x.h5", 12n, 3)))).toEqual({ kind: "recorded", recorded: { file: "x.h5", bytes: 12, seconds: 3 } });
    const trial = new wire.TrialT("t", 3, 1, 12, wire.Presented.b, true, false, true, new wire.Vec3T(0.1, 0, 0.005), new wire.Vec3T(-1, 0, 0), true, false, "trials.jsonl");
    expect(decode(frameOf(wire.Payload.Trial, trial))).toEqual({
      kind: "trial",
      trial: {
        title: "t", number: 3, runsDone: 1, runs: 12, presented: wire.Presented.b, felt: { 0: true, 1: false, 2: true },
        point: [0.1, 0, 0.005], direction: [-1, 0, 0], showsForce: true, finished: false, file: "trials.jsonl",
      },
    });
    expect(decode(frameOf(wire.Payload.Pong, new wire.PongT(8n)))).toEqual({ kind: "pong", number: 8 });
  });

  it("are refused in words when they are none", () => {
    expect(() => decode(new Uint8Array([1, 2, 3]))).toThrow("not a frame");
    expect(() => decode(new Uint8Array(64))).toThrow("not a frame");
    expect(() => decode(encode({ kind: "reset" }))).toThrow("differ in version");
  });
});

describe("Commands", () => {
  it("reach the program as they were meant", () => {
    const grasp = heard(encode({ kind: "grasp", face: 12, weights: [0.25, 0.5, 0.25], push: true }));
    expect(grasp.payloadType).toBe(wire.Payload.Grasp);
    expect(grasp.payload).toMatchObject({ face: 12, push: true, weights: { x: 0.25, y: 0.5, z: 0.25 } });
    expect(heard(encode({ kind: "move", to: [1, -2, 1e-9] })).payload).toMatchObject({ to: { x: 1, y: -2, z: 1e-9 } });
    expect(heard(encode({ kind: "setValue", key: "model.beta", value: "auto" })).payload).toMatchObject({ key: "model.beta", value: "auto" });
    expect(heard(encode({ kind: "play", on: true, speed: 0.5 })).payload).toMatchObject({ on: true, speed: 0.5 });
    expect(heard(encode({ kind: "seek", time: 3.25 })).payload).toMatchObject({ time: 3.25 });
    expect(heard(encode({ kind: "step", ticks: 10 })).payload).toMatchObject({ ticks: 10 });
    expect(heard(encode({ kind: "showField", field: wire.Field.mean_stress })).payload).toMatchObject({ field: wire.Field.mean_stress });
    expect(heard(encode({ kind: "feel", presented: wire.Presented.b })).payload).toMatchObject({ presented: wire.Presented.b });
    expect(heard(encode({ kind: "answer", same: wire.Presented.a })).payload).toMatchObject({ same: wire.Presented.a });
    expect(heard(encode({ kind: "ping", number: 5 })).payload).toMatchObject({ number: 5n });
  });

  it("without arguments carry their kind", () => {
    const kinds = (["takeHand", "giveHand", "letGo", "reset", "undo"] as const).map((kind) => heard(encode({ kind })).payloadType);
    expect(kinds).toEqual([wire.Payload.TakeHand, wire.Payload.GiveHand, wire.Payload.LetGo, wire.Payload.Reset, wire.Payload.Undo]);
    const switches = (["pause", "script", "record"] as const).map((kind) => heard(encode({ kind, on: true })));
    expect(switches.map((frame) => frame.payloadType)).toEqual([wire.Payload.Pause, wire.Payload.Script, wire.Payload.Record]);
    expect(switches.every((frame) => frame.payload !== null && "on" in frame.payload && frame.payload.on)).toBe(true);
    expect(heard(encode({ kind: "openScene", file: "b.toml" })).payload).toMatchObject({ file: "b.toml" });
  });
});
