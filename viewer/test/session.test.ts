import { describe, expect, it } from "vitest";

import { decode } from "../src/protocol/decode";
import { Store, type Event } from "../src/session/store";
import { ForceTrace } from "../src/session/trace";
import { troubles } from "../src/session/troubles";
import * as wire from "../src/wire/rhexis_generated";
import { Plate, frameOf, restingState } from "./support/plate";

function store() {
  const told: Event[] = [];
  const made = new Store((event) => told.push(event));
  const take = (kind: wire.Payload, payload: wire.FrameT["payload"]) => made.take(decode(frameOf(kind, payload)));
  return { store: made, told, take };
}

describe("The store", () => {
  it("follows an interaction frame by frame", () => {
    const { store: kept, take } = store();
    const plate = new Plate();
    expect(take(wire.Payload.Hello, new wire.HelloT("1", ["a"], [], "[]", false))).toBe("hello");
    expect(take(wire.Payload.Role, new wire.RoleT(true, true, 1))).toBe("role");
    expect(take(wire.Payload.Body, plate.body(3, 0, "a"))).toBe("body");
    expect(take(wire.Payload.State, restingState(plate, 3, 0, 10))).toBe("state");
    expect(take(wire.Payload.Edit, plate.tear(3, 1, 0.01))).toBe("edit");
    expect(kept.advances.map((advance) => advance.topology)).toEqual([1]);
    expect(take(wire.Payload.State, restingState(plate, 3, 1, 20))).toBe("state");
    expect(kept.state?.tick).toBe(20);
    expect(kept.hasHand).toBe(true);
    expect(kept.frames).toBe(6);
  });

  it("keeps the force that is compared while it is, and which response answers", () => {
    const { store: kept, take } = store();
    const plate = new Plate();
    const body = plate.body(3, 0, "a");
    body.response = "recorded";
    body.hasRecord = true;
    take(wire.Payload.Body, body);
    expect(kept.body?.response).toBe("recorded");
    expect(kept.body?.hasRecord).toBe(true);
    const compared = restingState(plate, 3, 0, 10);
    compared.comparedForce = new wire.Vec3T(0, 3, 4);
    compared.bodyForce = new wire.Vec3T(6, 0, 8);
    compared.record = new wire.RecordUseT(7, true, false, false);
    take(wire.Payload.State, compared);
    expect(kept.state?.comparedForce).toEqual([0, 3, 4]);
    expect(kept.state?.record).toEqual({ topology: 7, outside: true, pastLast: false, tornOff: false });
    expect(kept.compared.columns(500, 11).size.filter((n) => n === 5).length).toBe(1);
    expect(kept.own.columns(500, 11).size.filter((n) => n === 10).length).toBe(1);
    take(wire.Payload.State, restingState(plate, 3, 0, 30));
    expect(kept.state?.comparedForce).toBe(null);
    expect(kept.state?.record).toBe(null);
    expect(kept.compared.columns(500, 31).size.every((n) => Number.isNaN(n))).toBe(true);
  });

  it("takes no state of another topology, and forgets the state with the body", () => {
    const { store: kept, take } = store();
    const plate = new Plate();
    take(wire.Payload.Body, plate.body(3, 0, "a"));
    const stale = restingState(plate, 2, 0, 10);
    expect(take(wire.Payload.State, stale)).toBe("none");
    expect(kept.state).toBe(null);
    take(wire.Payload.State, restingState(plate, 3, 0, 10));
    take(wire.Payload.Body, new Plate().body(4, 0, "a"));
    expect(kept.state).toBe(null);
    expect(kept.advances).toEqual([]);
  });

  it("keeps the trace over a body that is only sent again, until the clock starts over", () => {
    const { store: kept, take } = store();
    const plate = new Plate();
    take(wire.Payload.Body, plate.body(3, 0, "a"));
    const state = restingState(plate, 3, 0, 10);
    state.traceTick = 7n;
    state.trace = [1, 0, 0, 0, 2, 0, 0, 0, 3];
    take(wire.Payload.State, state);
    take(wire.Payload.Body, plate.body(4, 0, "a"));
    expect(kept.trace.time).toBeCloseTo(0.01, 9);
    const first = restingState(plate, 4, 0, 2);
    first.traceTick = 0n;
    first.trace = [0, 0, 0, 0, 5, 0];
    take(wire.Payload.State, first);
    expect(kept.trace.time).toBeCloseTo(0.002, 9);
  });

  it("tells what it is told, and who has the hand", () => {
    const { told, take } = store();
    take(wire.Payload.Notice, new wire.NoticeT(wire.Level.warning, "the point cannot be held"));
    take(wire.Payload.Role, new wire.RoleT(false, true, 2));
    take(wire.Payload.Role, new wire.RoleT(true, true, 2));
    take(wire.Payload.Role, new wire.RoleT(false, true, 2));
    expect(told.map((event) => event.text)).toEqual(["the point cannot be held", "You hold the hand now", "You have given the hand away"]);
    expect(told[0]?.level).toBe(wire.Level.warning);
  });
});

describe("The trace", () => {
  const forces = (...sizes: number[]): Float32Array => new Float32Array(sizes.flatMap((size) => [0, size, 0]));

  it("shows the peak of each stretch of time, and gaps where ticks are missing", () => {
    const trace = new ForceTrace();
    trace.add(0, forces(...Array.from({ length: 100 }, (_, k) => (k === 37 ? 9 : 1))));
    trace.add(140, forces(2, 2, 2, 2, 2, 2, 2, 2, 2, 2));
    const { size, along, time } = trace.columns(500); // 20 ticks each
    expect([...size.slice(-8)]).toEqual([1, 9, 1, 1, 1, NaN, NaN, 2]);
    expect(along[1][493]).toBe(9);
    expect(time[499]).toBeCloseTo(0.14, 9);
    expect(Number.isNaN(size[0])).toBe(true);
  });

  it("keeps the last ten seconds", () => {
    const trace = new ForceTrace();
    for (let k = 0; k < 30; ++k) trace.add(500 * k, forces(...new Array<number>(500).fill(k)));
    const { size, time } = trace.columns(500);
    expect(size[0]).toBe(10);
    expect(size[499]).toBe(29);
    expect(time[0]).toBeCloseTo(5, 9);
  });

  it("holds a force from state to state, and ends where another trace does", () => {
    const trace = new ForceTrace();
    trace.holdTo(19, [1, 0, 0]);
    trace.holdTo(59, [2, 0, 0]);
    trace.holdTo(2019, [3, 0, 0]); // long after: nothing is known of between
    const { size } = trace.columns(500, 2040);
    expect(size.filter((n) => n === 2).length).toBe(2);
    expect(size.filter((n) => n === 3).length).toBe(1);
    expect(Number.isNaN(size[499])).toBe(true);
  });

  it("starts over when the clock goes back", () => {
    const trace = new ForceTrace();
    trace.add(5000, forces(4, 4));
    trace.add(100, forces(1, 1));
    expect(trace.time).toBeCloseTo(0.102, 9);
    expect(trace.columns(500).size.filter((n) => n === 4).length).toBe(0);
  });
});

describe("Troubles", () => {
  function situation(change: (state: wire.StateT) => void, role = new wire.RoleT(true, true, 1), replay = false) {
    const { store: kept, take } = store();
    const plate = new Plate();
    take(wire.Payload.Hello, new wire.HelloT("1", [], [], "", replay));
    take(wire.Payload.Role, role);
    take(wire.Payload.Body, plate.body(1, 0, "a"));
    const state = restingState(plate, 1, 0, 1);
    change(state);
    take(wire.Payload.State, state);
    return troubles(kept).map(({ id, text, detail }) => [id, `${text} ${detail}`.trim()] as const);
  }

  it("are none when all is well", () => {
    expect(situation(() => undefined)).toEqual([]);
  });

  it("name a physics that is late, but not while it is paused", () => {
    const late = (state: wire.StateT): void => void (state.rates = new wire.RatesT(4, 300, 1000, 10, 0n, 250, true));
    expect(situation(late)).toEqual([["late", "The physics is late: the force is that of the body 250 ms ago."]]);
    expect(situation((state) => (late(state), (state.paused = true), undefined))).toEqual([]);
    expect(situation((state) => void (state.rates = new wire.RatesT(4, 300, 1000, 10, 0n, 50, true)))[0]?.[1]).toContain("took 300 ms");
  });

  it("name what the record does not know", () => {
    const use = (outside: boolean, pastLast: boolean, tornOff: boolean) => (state: wire.StateT) =>
      void (state.record = new wire.RecordUseT(124, outside, pastLast, tornOff));
    expect(situation(use(false, false, false))).toEqual([]);
    expect(situation(use(true, true, false))).toEqual([["record", "The crack is outside the record: the nearest, topology 124 of it answers."]]);
    expect(situation(use(false, true, false))[0]?.[1]).toBe("The crack has run on more often than the record knows: topology 124 of it answers.");
    expect(situation(use(false, false, true)).map(([id]) => id)).toEqual(["record-point"]);
  });

  it("name the pieces, the limit of the device, and who has the hand", () => {
    expect(situation((state) => void (state.pieces = 3))[0]?.[1]).toContain("in 3 pieces");
    const limited = situation((state) => {
      state.held = state.limited = true;
      state.bodyForce = new wire.Vec3T(0, 0, 12.5);
    });
    expect(limited[0]?.[1]).toBe("The force is cut to 8.9 N: the body itself pulls with 12.500 N.");
    expect(situation(() => undefined, new wire.RoleT(false, true, 2))[0]?.[1]).toContain("Another page has the hand");
    expect(situation(() => undefined, new wire.RoleT(false, false, 2))[0]?.[1]).toContain("Nobody has the hand");
    expect(situation(() => undefined, new wire.RoleT(false, true, 2), true)).toEqual([]);
  });
});
