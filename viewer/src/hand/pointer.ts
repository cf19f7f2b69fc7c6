import type { Vec3 } from "../base/vec3";
import { meetPlane, pick } from "../body/pick";
import type { Surface } from "../body/surface";
import type { Stage } from "../view/stage";
import type { Grip } from "./grip";

/** px of a wheel's turn that bring the body nearer by a factor e. */
const kWheel = 900;

type Drag =
  | { readonly kind: "hold"; readonly id: number; readonly point: Vec3 }
  | { readonly kind: "turn" | "pan"; readonly id: number };

/**
 * Mouse, pen and fingers on the picture: left drag on the body holds and pulls it, with Shift pushes it; left drag
 * beside it turns the view; right drag shifts it; the wheel, and two fingers, bring it nearer.
 */
export class Pointer {
  private drag: Drag | null = null;
  private readonly fingers = new Map<number, readonly [number, number]>();

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly stage: Stage,
    private readonly surface: Surface,
    private readonly grip: Grip,
    private readonly mayHold: () => boolean,
  ) {
    canvas.addEventListener("pointerdown", (event) => this.press(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    for (const end of ["pointerup", "pointercancel", "lostpointercapture"] as const)
      canvas.addEventListener(end, (event) => this.release(event));
    canvas.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  }

  private press(event: PointerEvent): void {
    this.fingers.set(event.pointerId, [event.clientX, event.clientY]);
    this.canvas.setPointerCapture(event.pointerId);
    if (this.fingers.size > 1) {
      // A second finger: both now move the view, and nothing is held by accident.
      if (this.drag?.kind === "hold") this.grip.letGo();
      this.drag = null;
      return;
    }
    const hit = event.button === 0 ? pick(this.surface, this.stage.rayAt(event.clientX, event.clientY)) : null;
    if (hit !== null && this.mayHold()) {
      this.grip.take(hit, event.shiftKey);
      this.drag = { kind: "hold", id: event.pointerId, point: hit.point };
    } else {
      this.drag = { kind: event.button === 2 ? "pan" : "turn", id: event.pointerId };
    }
    this.canvas.classList.toggle("holding", this.drag.kind === "hold");
  }

  private move(event: PointerEvent): void {
    const before = this.fingers.get(event.pointerId);
    if (before === undefined) return this.hover(event);
    const right = event.clientX - before[0];
    const down = event.clientY - before[1];
    if (this.fingers.size === 2) this.pinch(event, right, down);
    this.fingers.set(event.pointerId, [event.clientX, event.clientY]);
    if (this.drag === null || this.drag.id !== event.pointerId) return;
    if (this.drag.kind === "hold") return this.pull(event, this.drag.point);
    if (this.drag.kind === "turn") this.stage.rig.turn(right, down);
    else this.stage.rig.pan(right, down, this.canvas.clientHeight);
    this.stage.requestDraw();
  }

  /** In the plane through the point that faces the eye. */
  private pull(event: PointerEvent, point: Vec3): void {
    const to = meetPlane(this.stage.rayAt(event.clientX, event.clientY), point, this.stage.rig.forward());
    if (to !== null) this.grip.moveTo(to);
  }

  private release(event: PointerEvent): void {
    this.fingers.delete(event.pointerId);
    if (this.drag?.id !== event.pointerId) return;
    if (this.drag.kind === "hold") this.grip.letGo();
    this.drag = null;
    this.canvas.classList.remove("holding");
  }

  private pinch(event: PointerEvent, right: number, down: number): void {
    const other = [...this.fingers].find(([id]) => id !== event.pointerId)?.[1];
    const own = this.fingers.get(event.pointerId);
    if (other === undefined || own === undefined) return;
    const before = Math.hypot(own[0] - other[0], own[1] - other[1]);
    const after = Math.hypot(event.clientX - other[0], event.clientY - other[1]);
    if (before > 0 && after > 0) this.stage.rig.zoom(before / after);
    this.stage.rig.pan(right / 2, down / 2, this.canvas.clientHeight);
    this.stage.requestDraw();
  }

  private wheel(event: WheelEvent): void {
    event.preventDefault();
    const pixels = event.deltaY * (event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 16 : 1);
    this.stage.rig.zoom(Math.exp(pixels / kWheel));
    this.stage.requestDraw();
  }

  /** The cursor tells what a press would do. */
  private hover(event: PointerEvent): void {
    if (event.pointerType !== "mouse" || event.buttons !== 0) return;
    const over = this.mayHold() && pick(this.surface, this.stage.rayAt(event.clientX, event.clientY)) !== null;
    this.canvas.classList.toggle("over-body", over);
  }
}
