import { describe, expect, it } from "vitest";

import { vectorAt } from "../src/base/vec3";
import { FrontLines } from "../src/body/followers";
import { cornerNormals, faceNormals, listCorners } from "../src/body/normals";
import { Surface } from "../src/body/surface";
import { decode } from "../src/protocol/decode";
import type { Body, Edit, State } from "../src/protocol/messages";
import * as wire from "../src/wire/rhexis_generated";
import { Plate, frameOf, restingState } from "./support/plate";

const bodyOf = (sent: wire.BodyT): Body => {
  const frame = decode(frameOf(wire.Payload.Body, sent));
  if (frame.kind !== "body") throw new Error(frame.kind);
  return frame.body;
};
const editOf = (sent: wire.EditT): Edit => {
  const frame = decode(frameOf(wire.Payload.Edit, sent));
  if (frame.kind !== "edit") throw new Error(frame.kind);
  return frame.edit;
};
const stateOf = (sent: wire.StateT): State => {
  const frame = decode(frameOf(wire.Payload.State, sent));
  if (frame.kind !== "state") throw new Error(frame.kind);
  return frame.state;
};
function surfaceOf(plate: Plate): Surface {
  const surface = new Surface();
  surface.setBody(bodyOf(plate.body(1, 0, "")));
  return surface;
}
const used = <T extends Float32Array | Uint32Array>(list: T, count: number): number[] => [...list.subarray(0, count)];

describe("The surface", () => {
  it("after edits is what a body of that topology would be", () => {
    const plate = new Plate();
    const edited = surfaceOf(plate);
    for (let k = 1; k <= 5; ++k) expect(edited.applyEdit(editOf(plate.tear(1, k, k)))).toBe(true);
    const whole = surfaceOf(plate);
    expect(edited.vertexCount).toBe(whole.vertexCount);
    expect(edited.vertexCount).toBe(162 + 10);
    expect(used(edited.faces, 3 * edited.slotCount)).toEqual(used(whole.faces, 3 * whole.slotCount));
    expect(used(edited.reference, 3 * edited.vertexCount)).toEqual(used(whole.reference, 3 * whole.vertexCount));
    expect([...edited.local]).toEqual([...whole.local]);
    expect(edited.fronts).toEqual(whole.fronts);
    expect(edited.local.some((flag) => flag === 1)).toBe(true);
  });

  it("refuses edits of another body, and those it has had", () => {
    const plate = new Plate();
    const surface = surfaceOf(plate);
    const edit = editOf(plate.tear(1, 1, 0));
    expect(surface.applyEdit({ ...edit, epoch: 2 })).toBe(false);
    expect(surface.vertexCount).toBe(162);
    expect(surface.applyEdit(edit)).toBe(true);
    expect(surface.applyEdit(edit)).toBe(false);
    expect(surface.vertexCount).toBe(164);
  });

  it("moves as a state says, and only one of its own topology", () => {
    const plate = new Plate();
    const surface = surfaceOf(plate);
    const sent = restingState(plate, 1, 0, 5);
    sent.displacement[3 * 40] = 0.5;
    expect(surface.applyState(stateOf(sent))).toBe(true);
    expect(vectorAt(surface.position, 40)[0]).toBeCloseTo((surface.reference[120] ?? 0) + 0.5, 6);
    expect(surface.applyState({ ...stateOf(sent), topology: 1 })).toBe(false);
    expect(surface.applyState({ ...stateOf(sent), epoch: 2 })).toBe(false);
    sent.displacement.pop();
    expect(surface.applyState(stateOf(sent))).toBe(false);
  });

  it("places copied vertices where their node is until they are told where to go", () => {
    const plate = new Plate();
    const surface = surfaceOf(plate);
    const sent = restingState(plate, 1, 0, 5);
    sent.displacement = plate.displacement([0.12, 0, 0.01], [0, 0, 0.1]);
    surface.applyState(stateOf(sent));
    surface.applyEdit(editOf(plate.tear(1, 1, 0)));
    expect(vectorAt(surface.position, 162)).toEqual(vectorAt(surface.position, 4));
    expect(vectorAt(surface.position, 162)[2]).toBeGreaterThan(0.05);
  });

  it("empties slots and moves vertices of the reference", () => {
    const plate = new Plate();
    const surface = surfaceOf(plate);
    const edit = new wire.EditT(1, 1, [3], [9, 8, 7], [], [], [0, 5]);
    surface.applyEdit(editOf(edit));
    expect([0, 1, 5].map((slot) => surface.isEmpty(slot))).toEqual([true, false, true]);
    expect(vectorAt(surface.reference, 3)).toEqual([9, 8, 7]);
    expect(vectorAt(surface.position, 3)).toEqual([9, 8, 7]);
  });

  it("does not trip over slots and vertices that are not there", () => {
    const surface = surfaceOf(new Plate());
    const edit = new wire.EditT(1, 1, [4000], [1, 1, 1], [], [], [9000], [400], [1, 2, 70000], [8000]);
    expect(surface.applyEdit(editOf(edit))).toBe(true);
    expect(surface.isEmpty(400)).toBe(true);
  });
});

describe("Normals", () => {
  const normalsOf = (surface: Surface): Float32Array => {
    const faces = new Float32Array(3 * surface.slotCount);
    const corners = new Float32Array(9 * surface.slotCount);
    faceNormals(surface, faces);
    cornerNormals(surface, listCorners(surface), faces, corners);
    return corners;
  };

  it("of a flat top point up to its very edge, and down below", () => {
    const normals = normalsOf(surfaceOf(new Plate()));
    for (let corner = 0; corner < 6; ++corner) expect(vectorAt(normals, corner)).toEqual([0, 0, 1]);
    for (let corner = 6; corner < 12; ++corner) expect(vectorAt(normals, corner)[2]).toBe(-1);
  });

  it("are smooth over a gentle bend and unit long", () => {
    const plate = new Plate();
    const surface = surfaceOf(plate);
    const sent = restingState(plate, 1, 0, 1);
    for (let v = 0; v < plate.positions.length / 3; ++v) sent.displacement[3 * v + 2] = 2 * ((plate.positions[3 * v] ?? 0) - 0.12) ** 2;
    surface.applyState(stateOf(sent));
    const normals = normalsOf(surface);
    const at = (vertex: number): number[][] =>
      [...Array(3 * surface.slotCount).keys()]
        .filter((corner) => surface.faces[corner] === vertex && (normals[3 * corner + 2] ?? 0) > 0.5)
        .map((corner) => [...vectorAt(normals, corner)]);
    const inner = at(plate.vertex(3, 3, 1));
    expect(inner.length).toBeGreaterThan(3);
    for (const normal of inner) {
      expect(normal).toEqual(inner[0]);
      expect(Math.hypot(...normal)).toBeCloseTo(1, 6);
    }
    expect(Math.abs(inner[0]?.[0] ?? 0)).toBeGreaterThan(0.05);
  });
});

describe("Front lines", () => {
  it("go with the body", () => {
    const plate = new Plate();
    plate.tear(1, 1, 0);
    const surface = surfaceOf(plate);
    const before = new FrontLines(surface).segments();
    const sent = restingState(plate, 1, 0, 1);
    for (let k = 2; k < sent.displacement.length; k += 3) sent.displacement[k] = 0.25;
    surface.applyState(stateOf(sent));
    const after = new FrontLines(surface).segments();
    expect(after.length).toBe(12);
    after.forEach((x, k) => expect(x - (before[k] ?? 0)).toBeCloseTo(k % 3 === 2 ? 0.25 : 0, 6));
  });

  it("of cracks that are finished are not there", () => {
    const plate = new Plate();
    for (let k = 0; k < plate.cells; ++k) plate.tear(1, k, 0);
    expect(new FrontLines(surfaceOf(plate)).segments().length).toBe(0);
  });
});
