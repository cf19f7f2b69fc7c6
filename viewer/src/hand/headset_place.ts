import * as THREE from "three";

import { scale, subtract, type Vec3 } from "../base/vec3";
import type { Ray } from "../body/pick";

/** m: where a body hangs in front of a person who stands, and how large it then is. */
const kBefore: Vec3 = [0, 1.35, -0.6];
const kSize = 0.45;

/** Places a box of the scene, in which z is up, in a room in which y is. */
export function placeInRoom(low: Vec3, high: Vec3): THREE.Matrix4 {
  const extent = subtract(high, low);
  const factor = kSize / Math.max(Math.hypot(...extent), 1e-9);
  const middle = scale([low[0] + high[0], low[1] + high[1], low[2] + high[2]], 0.5);
  const upright = new THREE.Matrix4().makeRotationX(-Math.PI / 2);
  // A sheet that lies flat is seen from its edge; it is tipped towards the eye.
  const isFlat = extent[2] < 0.3 * Math.max(extent[0], extent[1]);
  const tip = new THREE.Matrix4().makeRotationX(isFlat ? Math.PI / 3 : 0);
  return new THREE.Matrix4()
    .makeTranslation(...kBefore)
    .multiply(tip)
    .multiply(upright)
    .multiply(new THREE.Matrix4().makeScale(factor, factor, factor))
    .multiply(new THREE.Matrix4().makeTranslation(-middle[0], -middle[1], -middle[2]));
}

const vec3 = (v: THREE.Vector3): Vec3 => [v.x, v.y, v.z];

/** Where a controller points, in the scene. `controller`, `room`: their places in the world. */
export function rayOf(controller: THREE.Matrix4, room: THREE.Matrix4): Ray {
  const toScene = room.clone().invert();
  const origin = new THREE.Vector3().setFromMatrixPosition(controller).applyMatrix4(toScene);
  const direction = new THREE.Vector3(0, 0, -1).transformDirection(controller).transformDirection(toScene);
  return { origin: vec3(origin), direction: vec3(direction) };
}

/** A point of the scene as if it were fixed to a controller: given in the controller's frame, and back. */
export function fixTo(controller: THREE.Matrix4, room: THREE.Matrix4, point: Vec3): Vec3 {
  return vec3(new THREE.Vector3(...point).applyMatrix4(room).applyMatrix4(controller.clone().invert()));
}
export function fixedPoint(controller: THREE.Matrix4, room: THREE.Matrix4, inController: Vec3): Vec3 {
  return vec3(new THREE.Vector3(...inController).applyMatrix4(controller).applyMatrix4(room.clone().invert()));
}
