import type { Vec3 } from "../base/vec3";
import type { Body, Edit, Front, State } from "../protocol/messages";

/** A list that grows: `data` has room for more than the `length` that counts. */
function grown<T extends Float32Array | Uint32Array | Uint8Array>(data: T, length: number, make: (n: number) => T): T {
  if (length <= data.length) return data;
  const larger = make(Math.max(length, 2 * data.length));
  larger.set(data);
  return larger;
}

/**
 * The surface of the body as the frames leave it: vertices in slots, faces in slots of which some are empty. Frames of
 * another body than the present one are refused, since the order of frames on the wire makes them stale ones.
 */
export class Surface {
  epoch = 0;
  topology = 0;
  vertexCount = 0;
  /** Face slots, the empty ones too. */
  slotCount = 0;
  /** m, 3 a vertex, of the reference configuration. */
  reference = new Float32Array(0);
  /** m, 3 a vertex, reference and displacement. */
  position = new Float32Array(0);
  /** Number of each vertex's node in the mesh file. */
  node = new Uint32Array(0);
  /** 3 vertices a slot; three times the same: empty. */
  faces = new Uint32Array(0);
  /** 1 for a slot of a local object, 0 for the rest. */
  local = new Uint8Array(0);
  /** Vertices that a support holds. */
  held = new Uint32Array(0);
  fronts: readonly Front[] = [];
  /** Of the field shown, one a vertex; empty where none is shown. */
  values: Float32Array = new Float32Array(0);
  /** Counts changes of what is connected with what, of reference positions and of marks. */
  shapeVersion = 0;
  /** Counts changes of positions and values. */
  stateVersion = 0;

  private displacement = new Float32Array(0);

  setBody(body: Body): void {
    this.epoch = body.epoch;
    this.topology = body.topology;
    this.vertexCount = Math.floor(body.positions.length / 3);
    this.slotCount = Math.floor(body.faces.length / 3);
    this.reference = body.positions.slice();
    this.node = body.node.slice();
    this.faces = body.faces.slice();
    this.held = body.held.slice();
    this.displacement = new Float32Array(3 * this.vertexCount);
    this.position = body.positions.slice();
    this.values = new Float32Array(0);
    this.markLocal(body.local);
    this.fronts = body.fronts;
    this.shapeVersion += 1;
    this.stateVersion += 1;
  }

  /** False: it is of another body, or out of order. */
  applyEdit(edit: Edit): boolean {
    if (edit.epoch !== this.epoch || edit.topology <= this.topology) return false;
    this.topology = edit.topology;
    this.addVertices(edit.newPositions, edit.newNode);
    edit.moved.forEach((vertex, k) => {
      if (vertex >= this.vertexCount) return;
      for (let c = 0; c < 3; ++c) this.reference[3 * vertex + c] = edit.movedTo[3 * k + c] ?? 0;
    });
    for (const slot of edit.gone) if (slot < this.slotCount) this.faces.fill(0, 3 * slot, 3 * slot + 3);
    this.fillSlots(edit.slots, edit.faces);
    this.markLocal(edit.local);
    this.fronts = edit.fronts;
    this.follow();
    this.shapeVersion += 1;
    return true;
  }

  /** False: it is of another body or topology than what is known here. */
  applyState(state: State): boolean {
    if (state.epoch !== this.epoch || state.topology !== this.topology) return false;
    if (state.displacement.length !== 3 * this.vertexCount) return false;
    this.displacement.set(state.displacement);
    this.values = state.values.length === this.vertexCount ? state.values : new Float32Array(0);
    this.follow();
    return true;
  }

  isEmpty(slot: number): boolean {
    return this.faces[3 * slot] === this.faces[3 * slot + 1];
  }

  /** Of the vertices of a slot. */
  corners(slot: number): readonly [number, number, number] {
    return [this.faces[3 * slot] ?? 0, this.faces[3 * slot + 1] ?? 0, this.faces[3 * slot + 2] ?? 0];
  }

  /** Where a point of a face is now, by area coordinates. */
  pointOn(slot: number, weights: Vec3): Vec3 {
    const [a, b, c] = this.corners(slot);
    const along = (k: number): number =>
      weights[0] * (this.position[3 * a + k] ?? 0) +
      weights[1] * (this.position[3 * b + k] ?? 0) +
      weights[2] * (this.position[3 * c + k] ?? 0);
    return [along(0), along(1), along(2)];
  }

  displacementOf(vertex: number): Vec3 {
    return [0, 1, 2].map((c) => this.displacement[3 * vertex + c] ?? 0) as unknown as Vec3;
  }

  /** Least and greatest corner of the box around the reference configuration; null for a body without vertices. */
  box(): readonly [Vec3, Vec3] | null {
    if (this.vertexCount === 0) return null;
    const low = [Infinity, Infinity, Infinity];
    const high = [-Infinity, -Infinity, -Infinity];
    for (let k = 0; k < 3 * this.vertexCount; ++k) {
      const value = this.reference[k] ?? 0;
      const c = k % 3;
      low[c] = Math.min(low[c] ?? 0, value);
      high[c] = Math.max(high[c] ?? 0, value);
    }
    return [low as unknown as Vec3, high as unknown as Vec3];
  }

  private addVertices(positions: Float32Array, nodes: Uint32Array): void {
    const first = this.vertexCount;
    const count = Math.floor(positions.length / 3);
    this.vertexCount = first + count;
    const floats = (n: number) => new Float32Array(n);
    this.reference = grown(this.reference, 3 * this.vertexCount, floats);
    this.displacement = grown(this.displacement, 3 * this.vertexCount, floats);
    this.position = grown(this.position, 3 * this.vertexCount, floats);
    this.node = grown(this.node, this.vertexCount, (n) => new Uint32Array(n));
    this.reference.set(positions.subarray(0, 3 * count), 3 * first);
    this.node.set(nodes.subarray(0, count), first);
    // Until the next State the new vertices go where the nodes went that they were copied from.
    const known = new Map<number, number>();
    if (count > 0) for (let v = 0; v < first; ++v) known.set(this.node[v] ?? 0, v);
    for (let v = first; v < this.vertexCount; ++v) {
      const twin = known.get(this.node[v] ?? 0);
      if (twin !== undefined) this.displacement.copyWithin(3 * v, 3 * twin, 3 * twin + 3);
    }
  }

  private fillSlots(slots: Uint32Array, faces: Uint32Array): void {
    let last = this.slotCount;
    for (const slot of slots) last = Math.max(last, slot + 1);
    this.faces = grown(this.faces, 3 * last, (n) => new Uint32Array(n));
    this.slotCount = last;
    slots.forEach((slot, k) => {
      const face = faces.subarray(3 * k, 3 * k + 3);
      if (face.length === 3 && face.every((vertex) => vertex < this.vertexCount)) this.faces.set(face, 3 * slot);
    });
  }

  private markLocal(slots: Uint32Array): void {
    this.local = new Uint8Array(this.slotCount);
    for (const slot of slots) if (slot < this.slotCount) this.local[slot] = 1;
  }

  private follow(): void {
    for (let k = 0; k < 3 * this.vertexCount; ++k)
      this.position[k] = (this.reference[k] ?? 0) + (this.displacement[k] ?? 0);
    this.stateVersion += 1;
  }
}
