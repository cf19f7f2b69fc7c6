import { rgbOf, type Lch, type Rgb } from "./oklab";

/** Colours for t from 0 to 1. */
export type Ramp = (t: number) => Rgb;

const clamp = (t: number): number => Math.min(1, Math.max(0, Number.isNaN(t) ? 0 : t));
const mix = (a: number, b: number, t: number): number => a + (b - a) * t;

/**
 * For what grows from nothing: lightness rises evenly from dark violet over teal to light yellow, so that more is
 * lighter in grey too, and the hue helps to tell values apart.
 */
export const sequential: Ramp = (t) => {
  const s = clamp(t);
  const colour: Lch = [mix(0.3, 0.93, s), mix(0.13, 0.15, s), mix(300, 100, s)];
  return rgbOf(colour);
};

/** For what has a sign: blue below, red above, and at zero a grey that belongs to neither. */
export const diverging: Ramp = (t) => {
  const s = 2 * clamp(t) - 1;
  const strength = Math.abs(s);
  const colour: Lch = [mix(0.9, 0.42, strength), mix(0, 0.19, strength ** 0.8), s < 0 ? 255 : 28];
  return rgbOf(colour);
};

/** `count` colours of a ramp, 4 bytes each, for a texture. */
export function bytesOf(ramp: Ramp, count: number): Uint8Array {
  const bytes = new Uint8Array(4 * count);
  for (let k = 0; k < count; ++k) {
    const rgb = ramp(k / (count - 1));
    bytes.set([...rgb.map((c) => Math.round(255 * c)), 255], 4 * k);
  }
  return bytes;
}

/** For CSS: a gradient from left to right. */
export function gradientOf(ramp: Ramp, stops = 24): string {
  const colours = Array.from({ length: stops }, (_, k) => {
    const rgb = ramp(k / (stops - 1)).map((c) => Math.round(255 * c));
    return `rgb(${rgb.join(" ")})`;
  });
  return `linear-gradient(to right, ${colours.join(", ")})`;
}
