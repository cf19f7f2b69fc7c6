import { describe, expect, it } from "vitest";

import { add, dot, length, scale, subtract, type Vec3 } from "../src/base/vec3";
import { meetPlane, pick } from "../src/body/pick";
import { Surface } from "../src/body/surface";
import { decode } from "../src/protocol/decode";
import { CameraRig } from "../src/view/camera_rig";
import * as wire from "../src/wire/rhexis_generated";
import { Plate, frameOf } from "./support/plate";

function plateSurface(): Surface {
  const surface = new Surface();
  const frame = decode(frameOf(wire.Payload.Body, new Plate().body(1, 0, "")));
  if (frame.kind === "body") surface.setBody(frame.body);
  return surface;
}

describe("Picking", () => {
  const surface = plateSurface();
  const down: Vec3 = [0, 0, -1];

  it("gives the nearest point of the surface and its area coordinates", () => {
    const hit = pick(surface, { origin: [0.05, 0.07, 1], direction: down });
    if (hit === null) throw new Error("missed");
    expect(hit.distance).toBeCloseTo(0.99, 6);
    expect(hit.point[0]).toBeCloseTo(0.05, 6);
    expect(hit.point[1]).toBeCloseTo(0.07, 6);
    expect(hit.weights[0] + hit.weights[1] + hit.weights[2]).toBeCloseTo(1, 12);
    const again = surface.pointOn(hit.face, hit.weights);
    expect(length(subtract(again, hit.point))).toBe(0);
  });

  it("misses beside the body and behind the eye", () => {
    expect(pick(surface, { origin: [0.3, 0.1, 1], direction: down })).toBe(null);
    expect(pick(surface, { origin: [0.05, 0.07, 1], direction: [0, 0, 1] })).toBe(null);
  });

  it("lets no ray through between two faces", () => {
    for (let k = 1; k < 40; ++k) {
      const x = (0.24 * k) / 40;
      expect(pick(surface, { origin: [x, x, 1], direction: down })).not.toBe(null); // along the diagonals of the cells
      expect(pick(surface, { origin: [0.09, x, 1], direction: down })).not.toBe(null); // along their edges
    }
  });

  it("does not meet slots that are empty", () => {
    const torn = plateSurface();
    torn.faces.fill(0);
    expect(pick(torn, { origin: [0.05, 0.07, 1], direction: down })).toBe(null);
  });
});

describe("A ray and a plane", () => {
  it("meet where both are", () => {
    const point = meetPlane({ origin: [0, 0, 2], direction: [0.6, 0, -0.8] }, [5, 5, 0], [0, 0, 1]);
    expect(point?.map((x) => Math.round(x * 1e9) / 1e9)).toEqual([1.5, 0, 0]);
  });
  it("do not meet when it runs along it or away", () => {
    expect(meetPlane({ origin: [0, 0, 2], direction: [1, 0, 0] }, [0, 0, 0], [0, 0, 1])).toBe(null);
    expect(meetPlane({ origin: [0, 0, 2], direction: [0, 0, 1] }, [0, 0, 0], [0, 0, 1])).toBe(null);
  });
});

describe("The camera", () => {
  const rig = (): CameraRig => {
    const made = new CameraRig();
    made.aspect = 1.5;
    made.fit([0, 0, 0], [0.24, 0.24, 0.01]);
    return made;
  };

  it("sees the whole of what it is fitted to, in a wide and in a narrow picture", () => {
    for (const aspect of [0.5, 1, 2]) {
      const camera = new CameraRig();
      camera.aspect = aspect;
      camera.fit([0, 0, 0], [0.24, 0.24, 0.01]);
      for (const corner of [[0, 0, 0], [0.24, 0, 0], [0, 0.24, 0], [0.24, 0.24, 0.01]] as const) {
        const seen = camera.seenAt(corner);
        expect(Math.max(...(seen ?? [9, 9]).map(Math.abs))).toBeLessThan(1);
      }
    }
  });

  it("sends its rays through what it sees there", () => {
    const camera = rig();
    const point: Vec3 = [0.05, 0.2, 0.01];
    const seen = camera.seenAt(point);
    if (seen === null) throw new Error("behind");
    const ray = camera.ray(...seen);
    const along = dot(subtract(point, ray.origin), ray.direction);
    expect(length(subtract(add(ray.origin, scale(ray.direction, along)), point))).toBeLessThan(1e-12);
    expect(camera.seenAt(subtract(camera.eye(), camera.forward()))).toBe(null);
  });

  it("keeps its axes upright and at right angles however it is turned", () => {
    const camera = rig();
    camera.turn(500, 4000);
    expect(camera.pitch).toBe(89);
    const axes = [camera.right(), camera.up(), camera.forward()] as const;
    expect(Math.abs(dot(axes[0], axes[1])) + Math.abs(dot(axes[1], axes[2])) + Math.abs(dot(axes[0], axes[2]))).toBeLessThan(1e-12);
    expect(axes[1][2]).toBeGreaterThan(0);
  });

  it("pans so that the target follows the cursor", () => {
    const camera = rig();
    const target = camera.target;
    camera.pan(120, -60, 600);
    const seen = camera.seenAt(target);
    expect(seen?.[0]).toBeCloseTo(120 / 450, 6);
    expect(seen?.[1]).toBeCloseTo(60 / 300, 6);
  });

  it("zooms within bounds", () => {
    const camera = rig();
    camera.zoom(1e-9);
    const near = camera.distance;
    camera.zoom(1e12);
    expect(near).toBeGreaterThan(0.01);
    expect(camera.distance).toBeLessThan(10);
  });
});
