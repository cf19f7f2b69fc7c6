import { describe, expect, it } from "vitest";

import { lightnessOf, rgbOf } from "../src/colour/oklab";
import { bytesOf, diverging, gradientOf, sequential } from "../src/colour/ramp";
import { kEmptyScale, kFields, fieldKind, mappingOf, niceAbove, scaleFor } from "../src/colour/scale";
import { Field } from "../src/wire/rhexis_generated";

const steps = (n: number): number[] => Array.from({ length: n }, (_, k) => k / (n - 1));

describe("Oklab", () => {
  it("has white, black and the red of the screen where they belong", () => {
    rgbOf([1, 0, 0]).forEach((c) => expect(c).toBeCloseTo(1, 4));
    expect(rgbOf([0, 0, 0])).toEqual([0, 0, 0]);
    // Red is L = 0.628, C = 0.2577, h = 29.23 by Ottosson's definition.
    const red = rgbOf([0.62796, 0.2576, 29.234]);
    expect(red[0]).toBeCloseTo(1, 2);
    expect(red[1]).toBeLessThan(0.02);
  });
  it("gives the lightness of a colour back", () => {
    for (const lightness of [0.2, 0.5, 0.9]) expect(lightnessOf(rgbOf([lightness, 0.05, 200]))).toBeCloseTo(lightness, 5);
  });
  it("keeps lightness where the screen lacks the chroma", () => {
    const rgb = rgbOf([0.9, 0.4, 300]);
    expect(Math.max(...rgb)).toBeLessThanOrEqual(1);
    expect(lightnessOf(rgb)).toBeCloseTo(0.9, 3);
  });
});

describe("The ramps", () => {
  it("for magnitudes rises in lightness by equal steps", () => {
    const lightness = steps(33).map((t) => lightnessOf(sequential(t)));
    const rises = lightness.slice(1).map((l, k) => l - (lightness[k] ?? 0));
    for (const rise of rises) expect(rise).toBeCloseTo(0.63 / 32, 3);
  });
  it("for signed values is lightest in the middle and the same on both sides", () => {
    for (const t of [0.1, 0.25, 0.4]) {
      expect(lightnessOf(diverging(t))).toBeCloseTo(lightnessOf(diverging(1 - t)), 3);
      expect(lightnessOf(diverging(t))).toBeLessThan(lightnessOf(diverging(0.5)));
    }
    const [low, high] = [diverging(0), diverging(1)];
    expect(low[2]).toBeGreaterThan(low[0]);
    expect(high[0]).toBeGreaterThan(high[2]);
  });
  it("clamps, and gives its first colour for what is no number", () => {
    expect(sequential(7)).toEqual(sequential(1));
    expect(sequential(NaN)).toEqual(sequential(0));
  });
  it("becomes a texture and a gradient", () => {
    const bytes = bytesOf(sequential, 16);
    expect(bytes.length).toBe(64);
    expect(bytes[63]).toBe(255);
    expect([...bytes.slice(60, 63)]).toEqual(sequential(1).map((c) => Math.round(255 * c)));
    expect(gradientOf(sequential, 3)).toMatch(/^linear-gradient\(to right, rgb\(\d+ \d+ \d+\), .*\)$/);
  });
});

describe("The scale of colours", () => {
  const stress = fieldKind(Field.von_mises);
  const mean = fieldKind(Field.mean_stress);
  if (stress === undefined || mean === undefined) throw new Error("no such field");

  it("ends at a round number above most values, and says the extremes", () => {
    const values = new Float32Array([...steps(99).map((t) => 1000 * t), 50_000]);
    expect(scaleFor(stress, values, kEmptyScale)).toEqual({ top: 1000, least: 0, most: 50_000 });
    expect([0, 1, 1.01, 2.4, 6, 8, 9500].map(niceAbove)).toEqual([0, 1, 1.5, 3, 7, 10, 10_000]);
  });
  it("is that of the sizes for a field with a sign", () => {
    expect(scaleFor(mean, new Float32Array([-900, -850, 100, 90]), kEmptyScale)).toMatchObject({ top: 1000, least: -900 });
  });
  it("does not flicker while values change a little", () => {
    const before = { top: 1000, least: 0, most: 0 };
    expect(scaleFor(stress, new Float32Array([450]), before).top).toBe(1000);
    expect(scaleFor(stress, new Float32Array([200]), before).top).toBe(200);
    expect(scaleFor(stress, new Float32Array([1100]), before).top).toBe(1500);
  });
  it("gives zero its own colour, where all is zero too", () => {
    const placeOf = (kind: typeof mean, top: number): number => {
      const { first, perUnit } = mappingOf(kind, { ...kEmptyScale, top });
      return (0 - first) * perUnit;
    };
    expect([placeOf(mean, 0), placeOf(mean, 2000)]).toEqual([0.5, 0.5]);
    expect([placeOf(stress, 0), placeOf(stress, 2000)]).toEqual([0, 0]);
  });
  it("is there for every field of the wire but none", () => {
    const all = Object.values(Field).filter((field): field is Field => typeof field === "number" && field !== Field.none);
    expect(kFields.map((kind) => kind.field)).toEqual(all);
  });
});
