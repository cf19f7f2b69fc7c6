import { length, vectorAt, type Vec3 } from "../base/vec3";

/** s that the trace holds. */
export const kTraceSeconds = 10;
const kTick = 1e-3; // s, of the haptic loop
const kTicks = kTraceSeconds / kTick;
/** Ticks between two States of a machine that keeps up, amply. */
const kHeld = 250;

/** Columns for a plot: s (of the haptic clock), and N; NaN where ticks are missing. */
export interface TraceColumns {
  readonly time: Float64Array;
  readonly size: Float64Array;
  readonly along: readonly [Float64Array, Float64Array, Float64Array];
}

/** Force on the hand in each of the last ticks, in a ring. */
export class ForceTrace {
  private readonly force = new Float32Array(3 * kTicks).fill(Number.NaN);
  /** Tick behind the last that is known. */
  private end = 0;

  clear(): void {
    this.force.fill(Number.NaN);
    this.end = 0;
  }

  /** `forces`: N, 3 a tick, from tick `first` on. Ticks between two calls that nobody gave are gaps. */
  add(first: number, forces: Float32Array): void {
    const count = Math.floor(forces.length / 3);
    if (count === 0) return;
    // A clock that goes back is another interaction's, or a replay that was sought.
    if (first + count < this.end) this.clear();
    if (this.end > 0) for (let tick = Math.max(this.end, first - kTicks); tick < first; ++tick) this.set(tick, [NaN, NaN, NaN]);
    for (let k = 0; k < count; ++k) this.set(first + k, vectorAt(forces, k));
    this.end = first + count;
  }

  /** Tick behind the last that is known. */
  get endTick(): number {
    return this.end;
  }

  /** s, of the last tick; 0 before there is one. */
  get time(): number {
    return this.end * kTick;
  }

  /** A force (N) that holds from the last tick that is known to this one; after a gap of more than that from this one on. */
  holdTo(tick: number, force: Vec3): void {
    const passed = tick + 1 - this.end;
    const count = passed > 0 && passed <= kHeld ? passed : 1;
    const forces = new Float32Array(3 * count);
    for (let k = 0; k < count; ++k) forces.set(force, 3 * k);
    this.add(tick + 1 - count, forces);
  }

  /**
   * `points` of equal length in time, of each the tick with the largest force: a peak of one tick is seen, however
   * coarse the plot. `end`: tick behind the last of them.
   */
  columns(points: number, end = this.end): TraceColumns {
    const time = new Float64Array(points).fill(NaN);
    const size = new Float64Array(points).fill(NaN);
    const along = [0, 1, 2].map(() => new Float64Array(points).fill(NaN)) as [Float64Array, Float64Array, Float64Array];
    const perPoint = kTicks / points;
    // Points begin at whole multiples of their length, so that what a point shows does not change while it moves left.
    const lastPoint = Math.ceil(end / perPoint);
    for (let k = 0; k < points; ++k) {
      const from = Math.round((lastPoint - points + k) * perPoint);
      time[k] = from * kTick;
      let most = -1;
      for (let tick = Math.max(from, this.end - kTicks, 0); tick < Math.min(from + perPoint, this.end); ++tick) {
        const force = vectorAt(this.force, tick % kTicks);
        const newtons = length(force);
        if (!(newtons > most)) continue;
        most = newtons;
        size[k] = newtons;
        for (const c of [0, 1, 2] as const) along[c][k] = force[c];
      }
    }
    return { time, size, along };
  }

  private set(tick: number, force: Vec3): void {
    this.force.set(force, 3 * (tick % kTicks));
  }
}
