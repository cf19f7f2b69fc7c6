import * as THREE from "three";

import { length, normalised, type Vec3 } from "../base/vec3";

/** Parts of the arrow's own length 1; it is scaled along and across by itself. */
const kHead = 0.5;
const kShaftRadius = 0.024;
const kHeadRadius = 0.085;
/** Part of the body's size that the arrow has at the largest force. */
const kReach = 0.28;
/** N; below it there is nothing to point at. */
const kLeast = 1e-3;

/** A force at a point, its length the part of the largest force that it is. */
export class ForceArrow {
  readonly group = new THREE.Group();
  private readonly material = new THREE.MeshBasicMaterial({ depthTest: false, transparent: true });
  private readonly shaft: THREE.Mesh;
  private readonly head: THREE.Mesh;

  constructor() {
    this.shaft = new THREE.Mesh(new THREE.CylinderGeometry(1, 1, 1, 16).translate(0, 0.5, 0), this.material);
    this.head = new THREE.Mesh(new THREE.ConeGeometry(1, 1, 20).translate(0, 0.5, 0), this.material);
    this.group.add(this.shaft, this.head);
    this.group.renderOrder = 3;
    for (const part of [this.shaft, this.head]) part.renderOrder = 3;
    this.group.visible = false;
  }

  paint(colour: number): void {
    this.material.color.setHex(colour);
  }

  hide(): void {
    this.group.visible = false;
  }

  /** `size`: m, of the body; `most`: N, what the device can give. */
  show(at: Vec3, force: Vec3, size: number, most: number): void {
    const newtons = length(force);
    this.group.visible = newtons > kLeast && most > 0;
    if (!this.group.visible) return;
    const reach = kReach * size * Math.min(1.5, newtons / most);
    // A short arrow keeps its head, which tells the direction.
    const head = Math.min(reach, kHead * kReach * size * 0.5);
    const width = kReach * size;
    this.group.position.set(...at);
    this.group.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), new THREE.Vector3(...normalised(force)));
    this.shaft.scale.set(kShaftRadius * width * 0.5, Math.max(reach - head, 1e-9), kShaftRadius * width * 0.5);
    this.head.position.set(0, reach - head, 0);
    this.head.scale.set(kHeadRadius * width * 0.5, Math.max(head, 1e-9), kHeadRadius * width * 0.5);
  }
}
