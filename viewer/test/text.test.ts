import { describe, expect, it } from "vitest";

import { bytes, clock, counted, fixed, forceText, significant, unitFor } from "../src/base/format";
import {
  bySection,
  complaint,
  formOf,
  hasSlider,
  labelOf,
  rangeText,
  readDeclarations,
  readValues,
  type Declaration,
} from "../src/session/declarations";
import { kDeclarations } from "./support/plate";

describe("Numbers", () => {
  it("have a fixed number of digits and no sign when they are zero", () => {
    expect(forceText(3.14159)).toBe("3.142");
    expect(fixed(-0.0004, 3)).toBe("0.000");
    expect(fixed(-1.5, 1)).toBe("−1.5");
    expect(fixed(NaN, 2)).toBe("–");
  });
  it("are given in the unit that suits their size", () => {
    expect(unitFor("Pa", 312_345)).toEqual({ name: "kPa", factor: 1e-3 });
    expect(unitFor("m", 0.0123).name).toBe("mm");
    expect(unitFor("Pa", -2.5e6).name).toBe("MPa");
    expect(unitFor("m", 0).name).toBe("µm");
  });
  it("keep their significant digits", () => {
    expect(significant(0.012345)).toBe("0.0123");
    expect(significant(1e15)).toBe("1.00e+15");
    expect(significant(0)).toBe("0");
    expect(significant(-999.6)).toBe("−1000");
  });
  it("of time, memory and things", () => {
    expect(clock(67.34)).toBe("1:07.3");
    expect(clock(59.97)).toBe("1:00.0");
    expect(bytes(1_234_000)).toBe("1.2\u2009MB");
    expect(counted(1, "piece")).toBe("1 piece");
    expect(counted(2, "piece")).toBe("2 pieces");
  });
});

describe("Declarations", () => {
  const declarations = readDeclarations(kDeclarations);
  const named = (key: string): Declaration => {
    const found = declarations.find((declaration) => declaration.key === key);
    if (found === undefined) throw new Error(key);
    return found;
  };

  it("become forms of their kind", () => {
    expect(declarations.map(formOf)).toEqual(["choice", "number", "number", "choice"]);
    expect(formOf({ ...named("material.young"), kind: "boolean" })).toBe("switch");
    expect(formOf({ ...named("material.young"), kind: "number_or_auto" })).toBe("text");
    expect([...bySection(declarations).keys()]).toEqual(["model", "material", "fracture"]);
    expect(labelOf({ ...named("material.young"), key: "fracture.advance_threshold" })).toBe("advance threshold");
  });

  it("have a slider where its steps mean something", () => {
    expect(hasSlider(named("material.poisson"))).toBe(true);
    expect(hasSlider(named("material.young"))).toBe(false);
    expect(hasSlider(named("model.kind"))).toBe(false);
  });

  it("say their range, and what is wrong with a value", () => {
    expect(rangeText(named("material.poisson"))).toBe("−0.900 to 0.499");
    expect(rangeText({ ...named("material.young"), max: Infinity, min: 3 })).toBe("at least 3.00 Pa");
    expect(complaint(named("material.poisson"), "0.45")).toBe("");
    expect(complaint(named("material.poisson"), "0.5")).toBe("it has to be −0.900 to 0.499");
    expect(complaint(named("material.young"), "stiff")).toBe("a number is needed");
    expect(complaint(named("material.young"), " ")).toBe("");
    expect(complaint({ ...named("material.young"), kind: "number_or_auto" }, "auto")).toBe("");
    expect(complaint({ ...named("material.young"), kind: "integer" }, "1.5")).toBe("a whole number is needed");
    expect(complaint(named("model.kind"), "linear")).toBe("");
  });

  it("that are none are left out", () => {
    expect(readDeclarations("no JSON")).toEqual([]);
    expect(readDeclarations('[1, {"kind": "number"}, {"key": "a"}]')).toMatchObject([{ key: "a", kind: "text", min: -Infinity }]);
  });

  it("come with values as one types them", () => {
    const values = readValues('{"a": 1e6, "b": "auto", "c": true, "d": null, "e": [0, 1], "f": 0.4, "g": 2000, "h": 0.0002}');
    expect([...values]).toEqual([["a", "1e6"], ["b", "auto"], ["c", "true"], ["d", ""], ["e", "[0,1]"], ["f", "0.4"], ["g", "2000"], ["h", "2e-4"]]);
    expect(readValues("[]").size).toBe(0);
  });
});
