import type { Surface } from "./surface";

/**
 * Cosine of the angle between two faces up to which light passes smoothly over their edge. Beyond, it is an edge of the
 * body or a flank of a crack, and is to be seen.
 */
const kCrease = Math.cos((35 * Math.PI) / 180);

/** Which corners meet at each vertex: of vertex v `corners[first[v]] ... corners[first[v + 1] - 1]`, as 3 slot + corner. */
export interface CornerLists {
  readonly first: Uint32Array;
  readonly corners: Uint32Array;
}

export function listCorners(surface: Surface): CornerLists {
  const first = new Uint32Array(surface.vertexCount + 1);
  for (let slot = 0; slot < surface.slotCount; ++slot) {
    if (surface.isEmpty(slot)) continue;
    for (const vertex of surface.corners(slot)) first[vertex + 1] = (first[vertex + 1] ?? 0) + 1;
  }
  for (let v = 0; v < surface.vertexCount; ++v) first[v + 1] = (first[v + 1] ?? 0) + (first[v] ?? 0);
  const corners = new Uint32Array(first[surface.vertexCount] ?? 0);
  const next = first.slice();
  for (let slot = 0; slot < surface.slotCount; ++slot) {
    if (surface.isEmpty(slot)) continue;
    surface.corners(slot).forEach((vertex, k) => {
      const at = next[vertex] ?? 0;
      corners[at] = 3 * slot + k;
      next[vertex] = at + 1;
    });
  }
  return { first, corners };
}

/** Twice the area of each slot's face times its unit normal, of the deformed surface; zero for an empty one. */
export function faceNormals(surface: Surface, out: Float32Array): void {
  const p = surface.position;
  for (let slot = 0; slot < surface.slotCount; ++slot) {
    const a = 3 * (surface.faces[3 * slot] ?? 0);
    const b = 3 * (surface.faces[3 * slot + 1] ?? 0);
    const c = 3 * (surface.faces[3 * slot + 2] ?? 0);
    const ux = p[b]! - p[a]!, uy = p[b + 1]! - p[a + 1]!, uz = p[b + 2]! - p[a + 2]!;
    const vx = p[c]! - p[a]!, vy = p[c + 1]! - p[a + 1]!, vz = p[c + 2]! - p[a + 2]!;
    out[3 * slot] = uy * vz - uz * vy;
    out[3 * slot + 1] = uz * vx - ux * vz;
    out[3 * slot + 2] = ux * vy - uy * vx;
  }
}

/**
 * Unit normals, 3 numbers for each of the 3 corners of each slot: area-weighted means over the faces around the corner
 * that bend less than kCrease. `faces`: of faceNormals().
 */
export function cornerNormals(surface: Surface, lists: CornerLists, faces: Float32Array, out: Float32Array): void {
  const lengths = new Float32Array(surface.slotCount);
  for (let s = 0; s < surface.slotCount; ++s) lengths[s] = Math.hypot(faces[3 * s]!, faces[3 * s + 1]!, faces[3 * s + 2]!);
  for (let slot = 0; slot < surface.slotCount; ++slot) {
    const fx = faces[3 * slot]!, fy = faces[3 * slot + 1]!, fz = faces[3 * slot + 2]!;
    const own = lengths[slot]! * kCrease;
    for (let k = 0; k < 3; ++k) {
      const vertex = surface.faces[3 * slot + k]!;
      let x = 0, y = 0, z = 0;
      const last = lists.first[vertex + 1] ?? 0;
      for (let i = lists.first[vertex] ?? 0; i < last; ++i) {
        const other = Math.floor(lists.corners[i]! / 3);
        const ox = faces[3 * other]!, oy = faces[3 * other + 1]!, oz = faces[3 * other + 2]!;
        if (ox * fx + oy * fy + oz * fz < own * lengths[other]!) continue;
        x += ox;
        y += oy;
        z += oz;
      }
      const size = Math.hypot(x, y, z);
      const at = 9 * slot + 3 * k;
      out[at] = size > 0 ? x / size : 0;
      out[at + 1] = size > 0 ? y / size : 0;
      out[at + 2] = size > 0 ? z / size : 0;
    }
  }
}
