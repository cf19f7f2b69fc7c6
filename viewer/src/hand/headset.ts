import * as THREE from "three";

import type { Vec3 } from "../base/vec3";
import { pick } from "../body/pick";
import type { Surface } from "../body/surface";
import type { Stage } from "../view/stage";
import type { Grip } from "./grip";
import { fixTo, fixedPoint, placeInRoom, rayOf } from "./headset_place";

/** m, of the line that shows where a controller points. */
const kPointer = 1.5;

/** A headset: the body hangs in the room, the trigger of either controller holds and pulls what it points at. */
export class Headset {
  private holding: { readonly controller: THREE.XRTargetRaySpace; readonly point: Vec3 } | null = null;
  private session: XRSession | null = null;

  constructor(
    private readonly stage: Stage,
    private readonly surface: Surface,
    private readonly grip: Grip,
    private readonly mayHold: () => boolean,
    private readonly changed: (isOn: boolean) => void,
  ) {
    for (const k of [0, 1]) this.addController(stage.renderer.xr.getController(k));
  }

  static async isThere(): Promise<boolean> {
    try {
      return (await navigator.xr?.isSessionSupported("immersive-vr")) ?? false;
    } catch {
      return false; // forbidden by the browser's settings, which is as good as none
    }
  }

  get isOn(): boolean {
    return this.session !== null;
  }

  /** Rejects, in the browser's words, when the headset refuses. */
  async enter(): Promise<void> {
    const { renderer } = this.stage;
    if (navigator.xr === undefined || this.isOn) return;
    const session = await navigator.xr.requestSession("immersive-vr", { optionalFeatures: ["local-floor"] });
    this.session = session;
    session.addEventListener("end", () => this.leave());
    renderer.xr.enabled = true;
    renderer.xr.setReferenceSpaceType("local-floor");
    await renderer.xr.setSession(session);
    this.placeBody();
    renderer.setAnimationLoop(() => this.draw());
    this.changed(true);
  }

  async exit(): Promise<void> {
    await this.session?.end();
  }

  /** Another body may be of another size. */
  placeBody(): void {
    const box = this.surface.box();
    const place = this.isOn && box !== null ? placeInRoom(...box) : new THREE.Matrix4();
    place.decompose(this.stage.room.position, this.stage.room.quaternion, this.stage.room.scale);
    this.stage.room.updateMatrixWorld(true);
  }

  private leave(): void {
    const { renderer } = this.stage;
    if (this.holding !== null) this.grip.letGo();
    this.holding = null;
    this.session = null;
    renderer.setAnimationLoop(null);
    renderer.xr.enabled = false;
    this.placeBody();
    this.changed(false);
    this.stage.requestDraw();
  }

  private draw(): void {
    if (this.holding !== null) {
      const { controller, point } = this.holding;
      if (this.grip.isHolding) this.grip.moveTo(fixedPoint(controller.matrixWorld, this.stage.room.matrixWorld, point));
      else this.holding = null;
    }
    this.stage.draw();
  }

  private addController(controller: THREE.XRTargetRaySpace): void {
    const line = new THREE.BufferGeometry().setFromPoints([new THREE.Vector3(), new THREE.Vector3(0, 0, -kPointer)]);
    controller.add(new THREE.Line(line, new THREE.LineBasicMaterial({ color: 0x808890 })));
    this.stage.scene.add(controller);
    controller.addEventListener("selectstart", () => this.take(controller));
    controller.addEventListener("selectend", () => {
      if (this.holding?.controller !== controller) return;
      this.grip.letGo();
      this.holding = null;
    });
  }

  private take(controller: THREE.XRTargetRaySpace): void {
    if (!this.mayHold()) return;
    const room = this.stage.room.matrixWorld;
    const hit = pick(this.surface, rayOf(controller.matrixWorld, room));
    if (hit === null) return;
    this.grip.take(hit, false);
    this.holding = { controller, point: fixTo(controller.matrixWorld, room, hit.point) };
  }
}
