import { add, cross, normalised, scale, subtract, type Vec3 } from "../base/vec3";
import type { Ray } from "../body/pick";

/** Degrees, from the lower to the upper edge of the picture: narrow, so that a body keeps its proportions. */
export const kFieldOfView = 28;
const kTurn = 0.3; // degrees a pixel
const kSteepest = 89; // degrees; at 90 there is no right or left
const kSlope = Math.tan((kFieldOfView * Math.PI) / 360);
const radians = (degrees: number): number => (degrees * Math.PI) / 180;

/** The eye turns around a point of the body with z upwards. Places are m in the scene's frame. */
export class CameraRig {
  target: Vec3 = [0, 0, 0];
  yaw = -25; // degrees around z; 0: looks along +y
  pitch = 40; // degrees above the horizon
  distance = 1;
  aspect = 1; // width of the picture over its height
  private size = 1; // m, of what is looked at

  /** Looks at the whole of a box; at a flat one from above, where most of it is seen. */
  fit(low: Vec3, high: Vec3): void {
    const extent = subtract(high, low);
    this.size = Math.max(Math.hypot(...extent), 1e-9);
    this.target = scale(add(low, high), 0.5);
    const isFlat = extent[2] < 0.3 * Math.max(extent[0], extent[1]);
    this.yaw = isFlat ? -15 : -30;
    this.pitch = isFlat ? 52 : 18;
    this.distance = (0.5 * this.size) / (kSlope * Math.min(1, this.aspect));
  }

  turn(right: number, down: number): void {
    this.yaw -= right * kTurn;
    this.pitch = Math.max(-kSteepest, Math.min(kSteepest, this.pitch + down * kTurn));
  }

  /** By pixels of a picture `height` pixels high; what is at the target stays under the cursor. */
  pan(right: number, down: number, height: number): void {
    const metres = (2 * kSlope * this.distance) / Math.max(1, height);
    const by = add(scale(this.right(), -right * metres), scale(this.up(), down * metres));
    this.target = add(this.target, by);
  }

  zoom(factor: number): void {
    this.distance = Math.max(0.05 * this.size, Math.min(20 * this.size, this.distance * factor));
  }

  eye(): Vec3 {
    return subtract(this.target, scale(this.forward(), this.distance));
  }

  forward(): Vec3 {
    const [yaw, pitch] = [radians(this.yaw), radians(this.pitch)];
    return [-Math.sin(yaw) * Math.cos(pitch), Math.cos(yaw) * Math.cos(pitch), -Math.sin(pitch)];
  }

  right(): Vec3 {
    return normalised(cross(this.forward(), [0, 0, 1]));
  }

  up(): Vec3 {
    return cross(this.right(), this.forward());
  }

  /** Through a point of the picture: x from -1 at the left to 1, y from -1 at the bottom to 1. */
  ray(x: number, y: number): Ray {
    const across = scale(this.right(), x * kSlope * this.aspect);
    return { origin: this.eye(), direction: normalised(add(this.forward(), add(across, scale(this.up(), y * kSlope)))) };
  }

  /** Where in the picture a point is seen, as ray() takes it; null behind the eye. */
  seenAt(point: Vec3): readonly [number, number] | null {
    const from = subtract(point, this.eye());
    const along = (axis: Vec3): number => from[0] * axis[0] + from[1] * axis[1] + from[2] * axis[2];
    const depth = along(this.forward());
    if (depth <= 0) return null;
    return [along(this.right()) / (depth * kSlope * this.aspect), along(this.up()) / (depth * kSlope)];
  }

  /** Near and far bound of what can be drawn. */
  bounds(): readonly [number, number] {
    return [Math.max(this.distance - 3 * this.size, 0.01 * this.distance), this.distance + 3 * this.size];
  }
}
