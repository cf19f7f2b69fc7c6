/** Numbers as people read them: a fixed number of digits, so that they do not dance while they change. */

const kMinus = "\u2212";
const kThinSpace = "\u2009";

/** Decimals of a force in newtons, everywhere on the page. */
export const kForceDecimals = 3;

export function fixed(value: number, decimals: number): string {
  if (!Number.isFinite(value)) return "\u2013";
  const text = value.toFixed(decimals);
  // What rounds to zero has no sign.
  if (Number(text) === 0) return (0).toFixed(decimals);
  return text.replace("-", kMinus);
}

export const forceText = (newtons: number): string => fixed(newtons, kForceDecimals);

/** A unit, and what a value in SI is multiplied by to be given in it. */
export interface Unit {
  readonly name: string;
  readonly factor: number;
}

const kPascals: readonly Unit[] = [
  { name: "Pa", factor: 1 },
  { name: "kPa", factor: 1e-3 },
  { name: "MPa", factor: 1e-6 },
  { name: "GPa", factor: 1e-9 },
];
const kMetres: readonly Unit[] = [
  { name: "\u00b5m", factor: 1e6 },
  { name: "mm", factor: 1e3 },
  { name: "m", factor: 1 },
];

/** The largest unit in which `size`, in SI, is at least one. */
export function unitFor(si: "Pa" | "m", size: number): Unit {
  const units = si === "Pa" ? kPascals : kMetres;
  let best = units[0] ?? { name: si, factor: 1 };
  for (const unit of units) if (Math.abs(size) * unit.factor >= 1) best = unit;
  return best;
}

/** `digits` significant ones, without an exponent where a person would write none. */
export function significant(value: number, digits = 3): string {
  if (!Number.isFinite(value)) return "\u2013";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-4) return value.toExponential(digits - 1).replace("-", kMinus);
  const decimals = Math.max(0, digits - 1 - Math.floor(Math.log10(size)));
  return fixed(value, decimals);
}

/** "1:07.3" */
export function clock(seconds: number): string {
  const tenths = Math.max(0, Math.round(seconds * 10));
  const minutes = Math.floor(tenths / 600);
  return `${minutes}:${((tenths % 600) / 10).toFixed(1).padStart(4, "0")}`;
}

export function bytes(count: number): string {
  const units = ["bytes", "kB", "MB", "GB"] as const;
  let size = count;
  let k = 0;
  while (size >= 1000 && k < units.length - 1) {
    size /= 1000;
    k += 1;
  }
  return `${k === 0 ? size : size.toFixed(1)}${kThinSpace}${units[k]}`;
}

/** "1 piece", "2 pieces" */
export const counted = (count: number, one: string, many = `${one}s`): string => `${count} ${count === 1 ? one : many}`;
