import { add, length, scale, type Vec3 } from "../base/vec3";
import { fixed } from "../base/format";
import { pick, type Hit } from "../body/pick";
import type { Surface } from "../body/surface";
import type { CameraRig } from "../view/camera_rig";
import type { Grip } from "./grip";

/** Part of the picture's height that a press of an arrow key moves the cursor by; with Shift a fourth of it. */
const kCursorStep = 0.04;
/** Part of the distance of the eye that a press pulls by; with Shift a fourth of it. */
const kPullStep = 0.01;
const kTurnStep = 30; // px of a drag that a press of an arrow key with Alt turns the view by

export interface KeyboardScene {
  readonly rig: CameraRig;
  readonly surface: Surface;
  readonly grip: Grip;
  mayHold(): boolean;
  showCursor(at: Vec3 | null): void;
  requestDraw(): void;
  fit(): void;
  /** To be read out. */
  say(text: string): void;
}

const kArrows: Readonly<Record<string, readonly [number, number, number]>> = {
  ArrowLeft: [-1, 0, 0],
  ArrowRight: [1, 0, 0],
  ArrowUp: [0, 1, 0],
  ArrowDown: [0, -1, 0],
  PageUp: [0, 0, 1], // away from the eye
  PageDown: [0, 0, -1],
};

/**
 * The body by keys alone, while the picture has the focus: arrows move a cursor over it, Enter takes hold, arrows pull,
 * Escape lets go.
 */
export class Keyboard {
  private cursor: readonly [number, number] = [0, 0]; // in the picture, as CameraRig.ray() takes it
  private hit: Hit | null = null;
  private pulled: Vec3 = [0, 0, 0]; // m

  constructor(private readonly scene: KeyboardScene) {}

  /** True: the key was for the body. */
  press(key: string, shift: boolean, alt: boolean): boolean {
    const arrow = kArrows[key];
    if (arrow !== undefined && alt) return this.turn(arrow);
    if (arrow !== undefined) return this.scene.grip.isHolding ? this.pull(arrow, shift) : this.move(arrow, shift);
    switch (key) {
      case "Enter":
        return this.scene.grip.isHolding ? this.letGo() : this.take(shift);
      case "Escape":
        return this.scene.grip.isHolding && this.letGo();
      case "Home":
        this.scene.fit();
        return true;
      case "+":
      case "-":
        this.scene.rig.zoom(key === "+" ? 0.9 : 1 / 0.9);
        this.scene.requestDraw();
        return true;
      default:
        return false;
    }
  }

  /** When the picture gets the focus by the keyboard. */
  begin(): void {
    this.aim();
  }

  /** When the picture loses it. What is held is let go: no key would reach it. */
  end(): void {
    this.hit = null;
    if (this.scene.grip.isHolding) this.scene.grip.letGo();
    this.scene.showCursor(null);
  }

  private turn(arrow: readonly [number, number, number]): boolean {
    this.scene.rig.turn(arrow[0] * kTurnStep, -arrow[1] * kTurnStep);
    this.scene.requestDraw();
    return true;
  }

  private move(arrow: readonly [number, number, number], shift: boolean): boolean {
    const step = 2 * kCursorStep * (shift ? 0.25 : 1);
    const within = (x: number): number => Math.max(-1, Math.min(1, x));
    this.cursor = [within(this.cursor[0] + (arrow[0] * step) / this.scene.rig.aspect), within(this.cursor[1] + arrow[1] * step)];
    this.aim();
    return true;
  }

  private aim(): void {
    const ray = this.scene.rig.ray(...this.cursor);
    this.hit = pick(this.scene.surface, ray);
    // Beside the body the cursor hangs in the air, so that one sees where it is.
    this.scene.showCursor(this.hit?.point ?? add(ray.origin, scale(ray.direction, this.scene.rig.distance)));
    this.scene.requestDraw();
    if (this.hit === null) return this.scene.say("Beside the body");
    const millimetres = this.hit.point.map((x) => fixed(1000 * x, 1)).join(", ");
    this.scene.say(`On the body at ${millimetres} millimetres`);
  }

  private take(push: boolean): boolean {
    this.aim();
    if (this.hit === null || !this.scene.mayHold()) return true;
    this.pulled = [0, 0, 0];
    this.scene.grip.take(this.hit, push);
    this.scene.showCursor(null);
    this.scene.say("Held. Arrow keys pull, Escape lets go");
    return true;
  }

  private pull(arrow: readonly [number, number, number], shift: boolean): boolean {
    const { rig, grip } = this.scene;
    const step = kPullStep * rig.distance * (shift ? 0.25 : 1);
    const axes = [rig.right(), rig.up(), rig.forward()] as const;
    for (const k of [0, 1, 2] as const) this.pulled = add(this.pulled, scale(axes[k], arrow[k] * step));
    grip.moveBy(this.pulled);
    this.scene.say(`Pulled ${fixed(1000 * length(this.pulled), 1)} millimetres`);
    return true;
  }

  private letGo(): boolean {
    this.scene.grip.letGo();
    this.aim();
    return true;
  }
}
