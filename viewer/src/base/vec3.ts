/** Three numbers of space, in metres or newtons as the user of it says. */
export type Vec3 = readonly [number, number, number];

export const kZero: Vec3 = [0, 0, 0];

export const add = (a: Vec3, b: Vec3): Vec3 => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const subtract = (a: Vec3, b: Vec3): Vec3 => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scale = (a: Vec3, s: number): Vec3 => [a[0] * s, a[1] * s, a[2] * s];
export const dot = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a: Vec3, b: Vec3): Vec3 => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
export const length = (a: Vec3): number => Math.hypot(a[0], a[1], a[2]);

/** Zero for zero. */
export function normalised(a: Vec3): Vec3 {
  const size = length(a);
  return size > 0 ? scale(a, 1 / size) : kZero;
}

/** The k-th of the vectors that lie in `values` one behind the other. */
export function vectorAt(values: ArrayLike<number>, k: number): Vec3 {
  return [values[3 * k] ?? 0, values[3 * k + 1] ?? 0, values[3 * k + 2] ?? 0];
}
