import { describe, expect, it } from "vitest";

import { readShapes } from "../src/report/data";

const base64 = (values: Float32Array | Uint32Array): string => Buffer.from(values.buffer).toString("base64");

describe("shapes of a report", () => {
  const json = JSON.stringify({
    reference: base64(new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1])),
    faces: base64(new Uint32Array([0, 1, 2, 2, 1, 3])),
    field: "lambda",
    unit: "Pa",
    signed: true,
    top: 5,
    panels: [{ title: "one", displacement: base64(new Float32Array(12).fill(0.5)), values: base64(new Float32Array([7, 8])) }],
  });
  const shapes = readShapes(json);

  it("gives each face vertices of its own", () => {
    expect([...shapes.faces]).toEqual([0, 1, 2, 3, 4, 5]);
    expect([...shapes.reference.subarray(9, 12)]).toEqual([0, 1, 0]); // vertex 2, first corner of the second face
    expect(shapes.panels[0]?.displacement).toHaveLength(18);
  });
  it("gives each face one value", () => {
    expect([...(shapes.panels[0]?.values ?? [])]).toEqual([7, 7, 7, 8, 8, 8]);
  });
});
