import { encodePayload } from "../../src/protocol/encode";
import * as wire from "../../src/wire/rhexis_generated";

/**
 * A sheet with a crack from the middle of an edge, as the program would send it, but without mechanics: points follow
 * the hand the less the further they are from it. For the tests of the page alone.
 */
export class Plate {
  readonly cells = 8;
  readonly width = 0.24; // m
  readonly thickness = 0.01;
  readonly positions: number[] = [];
  readonly node: number[] = [];
  readonly faces: number[] = [];
  /** Rows from the edge y = 0 that the crack has parted. */
  open = 0;
  private readonly copies = new Map<number, number>(); // vertex -> its copy on the right flank
  private readonly rightFaces: { readonly slot: number; readonly corners: readonly number[] }[] = [];

  constructor() {
    const n = this.cells + 1;
    for (const z of [0, this.thickness])
      for (let j = 0; j < n; ++j) for (let i = 0; i < n; ++i) this.positions.push((i * this.width) / this.cells, (j * this.width) / this.cells, z);
    for (let v = 0; v < this.positions.length / 3; ++v) this.node.push(v);
    for (let j = 0; j < this.cells; ++j) for (let i = 0; i < this.cells; ++i) this.addCell(i, j);
    for (let k = 0; k < this.cells; ++k) this.addSides(k);
  }

  vertex(i: number, j: number, layer: number): number {
    const n = this.cells + 1;
    return layer * n * n + j * n + i;
  }

  private get middle(): number {
    return this.cells / 2;
  }

  private add(corners: readonly number[], right: boolean): void {
    if (right) this.rightFaces.push({ slot: this.faces.length / 3, corners });
    this.faces.push(...corners);
  }

  private addQuad(a: number, b: number, c: number, d: number, right: boolean): void {
    this.add([a, b, c], right);
    this.add([a, c, d], right);
  }

  private addCell(i: number, j: number): void {
    const at = (di: number, dj: number, layer: number): number => this.vertex(i + di, j + dj, layer);
    const right = i >= this.middle;
    this.addQuad(at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1), right);
    this.addQuad(at(0, 0, 0), at(0, 1, 0), at(1, 1, 0), at(1, 0, 0), right);
  }

  private addSides(k: number): void {
    const n = this.cells;
    const side = (i: number, j: number, di: number, dj: number): void =>
      this.addQuad(this.vertex(i, j, 0), this.vertex(i + di, j + dj, 0), this.vertex(i + di, j + dj, 1), this.vertex(i, j, 1), i >= this.middle && i + di > this.middle);
    side(k, 0, 1, 0);
    side(n, k, 0, 1);
    this.addQuad(this.vertex(n - k, n, 0), this.vertex(n - k - 1, n, 0), this.vertex(n - k - 1, n, 1), this.vertex(n - k, n, 1), false);
    this.addQuad(this.vertex(0, n - k, 0), this.vertex(0, n - k - 1, 0), this.vertex(0, n - k - 1, 1), this.vertex(0, n - k, 1), false);
  }

  /** Parts one row more. What changed, as an Edit says it. */
  tear(epoch: number, topology: number, time: number): wire.EditT {
    const row = this.open;
    this.open += 1;
    const edit = new wire.EditT(epoch, topology);
    for (const layer of [0, 1]) {
      const old = this.vertex(this.middle, row, layer);
      const copy = this.positions.length / 3;
      this.copies.set(old, copy);
      const place = this.positions.slice(3 * old, 3 * old + 3);
      this.positions.push(...place);
      this.node.push(old);
      edit.newPositions.push(...place);
      edit.newNode.push(old);
    }
    for (const { slot, corners } of this.rightFaces) {
      const now = corners.map((vertex) => this.copies.get(vertex) ?? vertex);
      const before = this.faces.slice(3 * slot, 3 * slot + 3);
      if (now.every((vertex, k) => vertex === before[k])) continue;
      now.forEach((vertex, k) => (this.faces[3 * slot + k] = vertex));
      edit.slots.push(slot);
      edit.faces.push(...now);
    }
    edit.local = this.local();
    edit.fronts = [this.front()];
    edit.advance = this.advance(topology, time);
    return edit;
  }

  private advance(topology: number, time: number): wire.AdvanceT {
    const pitch = this.width / this.cells;
    return new wire.AdvanceT(topology, time, false, pitch, 90, 4, 1, 1e-9, 2.5, new wire.Vec3T(4, 0, 0), new wire.Vec3T(3, 0, 0));
  }

  front(): wire.FrontT {
    const tip = (this.open * this.width) / this.cells;
    const points = [0, this.thickness / 2, this.thickness].map((z) => new wire.Vec3T(this.width / 2, tip, z));
    return new wire.FrontT(points, this.open >= this.cells);
  }

  local(): number[] {
    const slots: number[] = [];
    for (let slot = 0; slot < this.faces.length / 3; ++slot) {
      const v = this.faces[3 * slot] ?? 0;
      const x = (this.positions[3 * v] ?? 0) - this.width / 2;
      const y = (this.positions[3 * v + 1] ?? 0) - (this.open * this.width) / this.cells;
      if (Math.hypot(x, y) < 0.05) slots.push(slot);
    }
    return slots;
  }

  body(epoch: number, topology: number, scene: string): wire.BodyT {
    const held = [0, 1].flatMap((layer) => Array.from({ length: this.cells + 1 }, (_, j) => this.vertex(this.cells, j, layer)));
    const values = JSON.stringify({ "material.young": 1e6, "material.poisson": 0.4, "model.kind": "linear", "fracture.incision": "keep-nodes" });
    return new wire.BodyT(
      scene, "A plate without mechanics", "linear", epoch, topology, 162, 384, [...this.positions], [...this.node], [...this.faces],
      this.local(), held, [this.front()], [], this.width / this.cells, 8.9, values, 2,
    );
  }

  /** m, 3 a vertex, when the point at `at` is pulled by `by`; the side x = width does not move, nor what is beyond the crack. */
  displacement(at: readonly number[], by: readonly number[]): number[] {
    const out: number[] = [];
    const isCopy = new Set(this.copies.values());
    for (let v = 0; v < this.positions.length / 3; ++v) {
      const [x, y, z] = [0, 1, 2].map((c) => this.positions[3 * v + c] ?? 0) as [number, number, number];
      const distance = Math.hypot(x - (at[0] ?? 0), y - (at[1] ?? 0), z - (at[2] ?? 0));
      const tip = (this.open * this.width) / this.cells;
      const beyond = (x > this.width / 2 || isCopy.has(v)) && y < tip ? 0.1 : 1;
      const share = Math.exp(-((distance / 0.09) ** 2)) * Math.min(1, (this.width - x) / 0.1) * beyond;
      out.push(...by.map((b) => b * share));
    }
    return out;
  }
}

export const frameOf = (kind: wire.Payload, payload: wire.FrameT["payload"]): Uint8Array => encodePayload([kind, payload]);

export const kDeclarations = JSON.stringify([
  { key: "model.kind", kind: "choice", unit: "", choices: ["linear", "corotated"], doc: "The deformation model." },
  { key: "material.young", kind: "number", unit: "Pa", min: 1e-3, max: 1e15, doc: "Young's modulus." },
  { key: "material.poisson", kind: "number", unit: "", min: -0.9, max: 0.499, doc: "Poisson's ratio." },
  { key: "fracture.incision", kind: "choice", unit: "", choices: ["keep-nodes", "split"], doc: "How a crack parts tets." },
]);

/** A State in which nothing is held. */
export function restingState(plate: Plate, epoch: number, topology: number, tick: number): wire.StateT {
  const state = new wire.StateT(epoch, topology, BigInt(tick), tick / 1000);
  state.displacement = new Array<number>(plate.positions.length).fill(0);
  state.heldWeights = new wire.Vec3T();
  state.hand = new wire.Vec3T();
  state.force = new wire.Vec3T();
  state.bodyForce = new wire.Vec3T();
  state.pieces = 1;
  state.rates = new wire.RatesT(480, 3.1, 1000, 42, 0n, 2.2, true);
  return state;
}
