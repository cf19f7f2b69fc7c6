import * as THREE from "three";
import { describe, expect, it } from "vitest";

import type { Vec3 } from "../src/base/vec3";
import type { Hit } from "../src/body/pick";
import { Surface } from "../src/body/surface";
import { Grip } from "../src/hand/grip";
import { fixTo, fixedPoint, placeInRoom, rayOf } from "../src/hand/headset_place";
import { Keyboard } from "../src/hand/keyboard";
import { decode } from "../src/protocol/decode";
import type { Command, State } from "../src/protocol/messages";
import { CameraRig } from "../src/view/camera_rig";
import * as wire from "../src/wire/rhexis_generated";
import { Plate, frameOf, restingState } from "./support/plate";

const kHit: Hit = { face: 4, weights: [1, 0, 0], point: [1, 2, 3], distance: 1 };

function stateWith(held: boolean, paused = false): State {
  const sent = restingState(new Plate(), 1, 0, 1);
  sent.held = held;
  sent.paused = paused;
  const frame = decode(frameOf(wire.Payload.State, sent));
  if (frame.kind !== "state") throw new Error(frame.kind);
  return frame.state;
}

function grip() {
  const sent: Command[] = [];
  const lost: boolean[] = [];
  const clock = { now: 0 };
  return { sent, lost, clock, grip: new Grip((command) => sent.push(command), (wasHeld) => lost.push(wasHeld), () => clock.now) };
}

describe("A grip", () => {
  it("says what the program has to hear", () => {
    const { grip: hand, sent } = grip();
    hand.moveTo([9, 9, 9]);
    hand.take(kHit, true);
    hand.moveTo([1.5, 2, 2]);
    hand.letGo();
    hand.letGo();
    expect(sent).toEqual([
      { kind: "grasp", face: 4, weights: [1, 0, 0], push: true },
      { kind: "move", to: [0.5, 0, -1] },
      { kind: "letGo" },
    ]);
  });

  it("lets go of one point before it takes another", () => {
    const { grip: hand, sent } = grip();
    hand.take(kHit, false);
    hand.take(kHit, false);
    expect(sent.map((command) => command.kind)).toEqual(["grasp", "letGo", "grasp"]);
  });

  it("sends no motion that is not a number", () => {
    const { grip: hand, sent } = grip();
    hand.take(kHit, false);
    hand.moveBy([NaN, 0, 0]);
    expect(sent.length).toBe(1);
  });

  it("notices that the program let go, but not before it had taken hold", () => {
    const { grip: hand, lost, clock } = grip();
    hand.take(kHit, false);
    hand.hear(stateWith(false));
    expect(lost).toEqual([]);
    hand.hear(stateWith(true));
    hand.hear(stateWith(false));
    expect(lost).toEqual([true]);
    expect(hand.isHolding).toBe(false);
    hand.take(kHit, false);
    clock.now = 10_000;
    hand.hear(stateWith(false, true));
    expect(lost.length).toBe(1);
    hand.hear(stateWith(false));
    expect(lost).toEqual([true, false]);
  });
});

describe("The keyboard", () => {
  function keyboard(mayHold = true) {
    const surface = new Surface();
    const frame = decode(frameOf(wire.Payload.Body, new Plate().body(1, 0, "")));
    if (frame.kind === "body") surface.setBody(frame.body);
    const rig = new CameraRig();
    rig.fit([0, 0, 0], [0.24, 0.24, 0.01]);
    const { grip: hand, sent } = grip();
    const said: string[] = [];
    const cursors: (Vec3 | null)[] = [];
    const keys = new Keyboard({
      rig,
      surface,
      grip: hand,
      mayHold: () => mayHold,
      showCursor: (at) => cursors.push(at),
      requestDraw: () => undefined,
      fit: () => undefined,
      say: (text) => said.push(text),
    });
    return { keys, sent, said, cursors, rig };
  }

  it("holds what is under its cursor, pulls it in the plane of the picture, and lets go", () => {
    const { keys, sent, said, rig } = keyboard();
    keys.begin();
    // The middle of the picture is the body's middle, 5 mm below the face that is met, seen from 52 degrees above.
    expect(said[0]).toBe("On the body at 119.0, 116.2, 10.0 millimetres");
    expect(keys.press("Enter", false, false)).toBe(true);
    keys.press("ArrowLeft", false, false);
    keys.press("ArrowLeft", false, false);
    keys.press("PageUp", true, false);
    keys.press("Escape", false, false);
    expect(sent.map((command) => command.kind)).toEqual(["grasp", "move", "move", "move", "letGo"]);
    const second = sent[2];
    if (second?.kind !== "move") throw new Error("no move");
    const right = rig.right();
    for (const c of [0, 1, 2] as const) expect(second.to[c]).toBeCloseTo(-2 * 0.01 * rig.distance * right[c], 12);
  });

  it("moves its cursor off the body, says so, and then holds nothing", () => {
    const { keys, sent, said } = keyboard();
    for (let k = 0; k < 30; ++k) keys.press("ArrowUp", false, false);
    expect(said[said.length - 1]).toBe("Beside the body");
    keys.press("Enter", false, false);
    expect(sent).toEqual([]);
  });

  it("holds nothing without the hand, and leaves other keys alone", () => {
    const { keys, sent } = keyboard(false);
    keys.press("Enter", false, false);
    expect(sent).toEqual([]);
    expect(keys.press("a", false, false)).toBe(false);
    expect(keys.press("Escape", false, false)).toBe(false);
  });

  it("lets go when the focus leaves", () => {
    const { keys, sent, cursors } = keyboard();
    keys.press("Enter", false, false);
    keys.end();
    expect(sent[sent.length - 1]).toEqual({ kind: "letGo" });
    expect(cursors[cursors.length - 1]).toBe(null);
  });
});

describe("In a headset", () => {
  const room = placeInRoom([0, 0, 0], [0.24, 0.24, 0.01]);

  it("the body hangs before the eyes at a size that one can hold", () => {
    const middle = new THREE.Vector3(0.12, 0.12, 0.005).applyMatrix4(room);
    expect(middle.distanceTo(new THREE.Vector3(0, 1.35, -0.6))).toBeLessThan(1e-12);
    const ends = [new THREE.Vector3(0, 0, 0), new THREE.Vector3(0.24, 0.24, 0.01)].map((v) => v.applyMatrix4(room));
    expect(ends[0]?.distanceTo(ends[1] ?? new THREE.Vector3())).toBeCloseTo(0.45, 9);
    const towardsEye = new THREE.Vector3(0, 0, 1).transformDirection(room);
    expect(towardsEye.z).toBeGreaterThan(0.5);
  });

  it("a point goes with the controller that holds it, turned as well as moved", () => {
    const controller = new THREE.Matrix4().makeTranslation(0.1, 1.2, -0.2);
    const point: Vec3 = [0.1, 0.05, 0.01];
    const held = fixTo(controller, room, point);
    fixedPoint(controller, room, held).forEach((x, c) => expect(x).toBeCloseTo(point[c] ?? 0, 9));
    const moved = new THREE.Matrix4().makeTranslation(0.1 + 0.045, 1.2, -0.2);
    const to = fixedPoint(moved, room, held);
    // 45 mm in the room are, at its scale there, this much of the scene, along x.
    expect(to[0] - point[0]).toBeCloseTo((0.045 * Math.hypot(0.24, 0.24, 0.01)) / 0.45, 9);
    expect(to[1]).toBeCloseTo(point[1], 9);
  });

  it("a controller points along its own axis", () => {
    const middle = new THREE.Vector3(0.12, 0.12, 0.005).applyMatrix4(room);
    const controller = new THREE.Matrix4().lookAt(new THREE.Vector3(0, 1.4, 0), middle, new THREE.Vector3(0, 1, 0)).setPosition(0, 1.4, 0);
    const ray = rayOf(controller, room);
    const t = (0.12 - ray.origin[0]) / (ray.direction[0] || 1e-12);
    const along = Math.abs(ray.direction[0]) < 1e-9 ? (0.12 - ray.origin[1]) / ray.direction[1] : t;
    expect(ray.origin[1] + along * ray.direction[1]).toBeCloseTo(0.12, 6);
    expect(ray.origin[2] + along * ray.direction[2]).toBeCloseTo(0.005, 6);
  });
});
