import { length, subtract, vectorAt, type Vec3 } from "../base/vec3";
import type { Surface } from "./surface";

/** Vertices that a follower is moved by. */
const kNeighbours = 4;

/** A point in the body that is no vertex of its surface, and what moves it: a front runs through the inside. */
interface Follower {
  readonly reference: Vec3;
  readonly vertices: readonly number[];
  readonly weights: readonly number[];
}

/** Weights that fall steeply with the distance: a point at a crack's tip must not be torn between its two flanks. */
function follower(surface: Surface, point: Vec3): Follower {
  const near: { vertex: number; distance: number }[] = [];
  for (let vertex = 0; vertex < surface.vertexCount; ++vertex) {
    const distance = length(subtract(vectorAt(surface.reference, vertex), point));
    if (near.length === kNeighbours && distance >= (near[kNeighbours - 1]?.distance ?? 0)) continue;
    near.push({ vertex, distance });
    near.sort((a, b) => a.distance - b.distance);
    near.length = Math.min(near.length, kNeighbours);
  }
  const first = near[0];
  if (first === undefined) return { reference: point, vertices: [], weights: [] };
  if (first.distance === 0) return { reference: point, vertices: [first.vertex], weights: [1] };
  const weights = near.map(({ distance }) => (first.distance / distance) ** 4);
  const sum = weights.reduce((a, b) => a + b, 0);
  return { reference: point, vertices: near.map(({ vertex }) => vertex), weights: weights.map((w) => w / sum) };
}

/** The lines of the fronts, deformed with the body. */
export class FrontLines {
  private readonly lines: readonly (readonly Follower[])[];

  constructor(private readonly surface: Surface) {
    this.lines = surface.fronts
      .filter((front) => !front.finished)
      .map((front) => front.points.map((point) => follower(surface, point)));
  }

  /** m, ends of segments: 6 numbers each. */
  segments(): Float32Array {
    const ends: number[] = [];
    for (const line of this.lines) {
      const now = line.map((point) => this.moved(point));
      for (let k = 1; k < now.length; ++k) ends.push(...(now[k - 1] ?? []), ...(now[k] ?? []));
    }
    return new Float32Array(ends);
  }

  private moved(point: Follower): Vec3 {
    const sum = [...point.reference];
    point.vertices.forEach((vertex, k) => {
      const by = this.surface.displacementOf(vertex);
      for (let c = 0; c < 3; ++c) sum[c] = (sum[c] ?? 0) + (point.weights[k] ?? 0) * (by[c] ?? 0);
    });
    return sum as unknown as Vec3;
  }
}
