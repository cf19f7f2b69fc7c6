import * as THREE from "three";

import type { Vec3 } from "../base/vec3";
import type { Ray } from "../body/pick";
import { kEmptyScale, fieldKind, scaleFor, type FieldKind, type Scale } from "../colour/scale";
import type { Store } from "../session/store";
import { ForceArrow } from "./arrow";
import { BodyView } from "./body_view";
import { CameraRig, kFieldOfView } from "./camera_rig";
import { Marks } from "./marks";
import type { Palette } from "./palette";

/** The three-dimensional picture. It is drawn when something in it has changed, and not otherwise. */
export class Stage {
  readonly rig = new CameraRig();
  readonly renderer: THREE.WebGLRenderer;
  readonly scene = new THREE.Scene();
  /** Holds all that is in the scene's frame; a headset moves and scales it into the room. */
  readonly room = new THREE.Group();
  readonly marks = new Marks();
  scale: Scale = kEmptyScale;
  kind: FieldKind | undefined;
  private readonly camera = new THREE.PerspectiveCamera(kFieldOfView, 1, 0.01, 10);
  private readonly body = new BodyView();
  private readonly arrow = new ForceArrow();
  /** Where an experiment has the body held and pulled. */
  private readonly guide = new ForceArrow();
  private isDue = false;
  private epoch = -1;
  private size = 1; // m, diagonal of the body's box
  private drawn: (() => void) | null = null;

  /** Throws where the browser gives no WebGL. */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly store: Store,
  ) {
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
    this.renderer.setPixelRatio(Math.min(2, devicePixelRatio));
    // The shaders and materials name colours of the screen; nothing is converted on the way.
    this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
    THREE.ColorManagement.enabled = false;
    this.camera.up.set(0, 0, 1);
    this.room.add(this.body.group, this.marks.group, this.arrow.group, this.guide.group);
    this.scene.add(this.room);
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.resize();
  }

  /** Called after each picture. */
  set onDrawn(drawn: () => void) {
    this.drawn = drawn;
  }

  set showsLines(on: boolean) {
    this.body.showsLines = on;
    this.requestDraw();
  }

  paint(palette: Palette): void {
    this.renderer.setClearColor(palette.background);
    this.body.paint(palette);
    this.marks.paint(palette);
    this.arrow.paint(palette.force);
    this.guide.paint(palette.cursor);
    this.requestDraw();
  }

  fit(): void {
    const box = this.store.surface.box();
    if (box !== null) this.rig.fit(...box);
    this.requestDraw();
  }

  requestDraw(): void {
    if (this.isDue || this.renderer.xr.isPresenting) return;
    this.isDue = true;
    requestAnimationFrame(() => {
      this.isDue = false;
      this.draw();
    });
  }

  /** Brings the picture up to the store, without drawing it. */
  follow(): void {
    const { surface, state, body, trial } = this.store;
    if (body !== null && body.epoch !== this.epoch) this.meet(body.epoch);
    const kind = state === null ? undefined : fieldKind(state.field);
    if (kind !== this.kind) this.scale = kEmptyScale;
    this.kind = kind;
    if (kind !== undefined) this.scale = scaleFor(kind, surface.values, this.scale);
    this.body.follow(surface, kind, this.scale);
    this.marks.follow(surface);
    const held = state?.held ? surface.pointOn(state.heldFace, state.heldWeights) : null;
    this.marks.showHand(held);
    const isFelt = trial !== null && !trial.showsForce;
    if (state !== null && held !== null && !isFelt) this.arrow.show(held, state.force, this.size, body?.maxForce || 8.9);
    else this.arrow.hide();
    if (trial !== null && !trial.finished && held === null) this.guide.show(trial.point, trial.direction, this.size, 1);
    else this.guide.hide();
  }

  draw(): void {
    this.follow();
    const { rig, camera } = this;
    if (!this.renderer.xr.isPresenting) {
      camera.position.set(...rig.eye());
      camera.lookAt(...rig.target);
      [camera.near, camera.far] = rig.bounds();
      camera.updateProjectionMatrix();
      camera.updateMatrixWorld();
      this.body.light(new THREE.Vector3(0, 0, 1).transformDirection(camera.matrixWorldInverse));
    }
    this.renderer.render(this.scene, camera);
    this.drawn?.();
  }

  /** Through a point of the page, in pixels of it. */
  rayAt(clientX: number, clientY: number): Ray {
    const box = this.canvas.getBoundingClientRect();
    return this.rig.ray((2 * (clientX - box.left)) / box.width - 1, 1 - (2 * (clientY - box.top)) / box.height);
  }

  /** Where on the page a point of the scene is seen; null behind the eye. */
  pixelOf(point: Vec3): readonly [number, number] | null {
    const seen = this.rig.seenAt(point);
    if (seen === null) return null;
    const box = this.canvas.getBoundingClientRect();
    return [box.left + ((seen[0] + 1) / 2) * box.width, box.top + ((1 - seen[1]) / 2) * box.height];
  }

  /** Where a point of the scene is in the world of a headset. */
  worldOf(point: Vec3): Vec3 {
    const there = new THREE.Vector3(...point).applyMatrix4(this.room.matrixWorld);
    return [there.x, there.y, there.z];
  }

  private meet(epoch: number): void {
    this.epoch = epoch;
    const box = this.store.surface.box();
    if (box === null) return;
    const size = Math.hypot(...box[1].map((high, c) => high - (box[0][c] ?? 0)));
    // A body that was only made anew (a reset, a value) stays where the user has turned it to.
    const isAnother = Math.abs(size - this.size) > 0.02 * this.size;
    this.size = size;
    this.marks.bodySize = size;
    if (isAnother) this.rig.fit(...box);
  }

  private resize(): void {
    const width = Math.max(1, this.canvas.clientWidth);
    const height = Math.max(1, this.canvas.clientHeight);
    if (!this.renderer.xr.isPresenting) this.renderer.setSize(width, height, false);
    const before = this.rig.aspect;
    this.rig.aspect = this.camera.aspect = width / height;
    // What fitted in the picture still does when it gets narrower.
    this.rig.distance *= Math.min(1, before) / Math.min(1, this.rig.aspect);
    this.requestDraw();
  }
}
