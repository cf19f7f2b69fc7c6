import { Field } from "../wire/rhexis_generated";
import { diverging, sequential, type Ramp } from "./ramp";

/** A field that can be shown as colours. */
export interface FieldKind {
  readonly field: Field;
  readonly name: string;
  readonly unit: "Pa" | "m";
  readonly signed: boolean;
}

/**
 * The maximum principal stress counts as unsigned: it is what opens a body, and where it is compression nothing is to be
 * told apart.
 */
export const kFields: readonly FieldKind[] = [
  { field: Field.displacement, name: "Displacement", unit: "m", signed: false },
  { field: Field.von_mises, name: "Von Mises stress", unit: "Pa", signed: false },
  { field: Field.principal_max, name: "Maximum principal stress", unit: "Pa", signed: false },
  { field: Field.mean_stress, name: "Mean stress (lambda)", unit: "Pa", signed: true },
];

export const fieldKind = (field: Field): FieldKind | undefined => kFields.find((kind) => kind.field === field);
export const rampOf = (kind: FieldKind): Ramp => (kind.signed ? diverging : sequential);

/** Part of the values that the colours have to tell apart: at a crack's tip a few are far above all others. */
const kShare = 0.98;
/** The scale shrinks only when the values use less of it than this, so that it does not flicker. */
const kRoom = 0.35;

/** The least of 1, 1.5, 2, 3, 5, 7 times a power of ten that is at least `value`; 0 for 0. */
export function niceAbove(value: number): number {
  if (!(value > 0) || !Number.isFinite(value)) return 0;
  const power = 10 ** Math.floor(Math.log10(value));
  for (const step of [1, 1.5, 2, 3, 5, 7]) if (step * power >= value * (1 - 1e-12)) return step * power;
  return 10 * power;
}

/** What colours mean: 0 (or -top, of a signed field) to top, in SI. `least`, `most`: of all values. */
export interface Scale {
  readonly top: number;
  readonly least: number;
  readonly most: number;
}

/** From a value to the place of its colour in the ramp: (value - first) * perUnit. */
export interface Mapping {
  readonly first: number;
  readonly perUnit: number;
}

/** Where nothing has a value every width of the scale is as good: zero has the colour of zero. */
export function mappingOf(kind: FieldKind, scale: Scale): Mapping {
  const top = scale.top > 0 ? scale.top : 1;
  return kind.signed ? { first: -top, perUnit: 1 / (2 * top) } : { first: 0, perUnit: 1 / top };
}

export const kEmptyScale: Scale = { top: 0, least: 0, most: 0 };

/** `before`: of the same field a moment ago, or kEmptyScale. */
export function scaleFor(kind: FieldKind, values: Float32Array, before: Scale): Scale {
  if (values.length === 0) return kEmptyScale;
  const sorted = kind.signed ? values.map(Math.abs).sort() : values.slice().sort();
  let least = Infinity;
  let most = -Infinity;
  for (const value of values) {
    least = Math.min(least, value);
    most = Math.max(most, value);
  }
  const typical = Math.max(0, sorted[Math.floor(kShare * (sorted.length - 1))] ?? 0);
  const fits = typical <= before.top && typical >= kRoom * before.top;
  return { top: fits ? before.top : niceAbove(typical), least, most };
}
