import * as THREE from "three";

import { significant, unitFor } from "../base/format";
import { edgesOf, BodyView } from "../view/body_view";
import { CameraRig, kFieldOfView } from "../view/camera_rig";
import type { Palette } from "../view/palette";
import { Surface } from "../body/surface";
import { gradientOf } from "../colour/ramp";
import { rampOf, type FieldKind } from "../colour/scale";
import type { State } from "../protocol/messages";
import { Field } from "../wire/rhexis_generated";
import type { Panel, Shapes } from "./data";

const kWheel = 1.0015; // of the distance, a pixel of the wheel
const kKeyTurn = 30; // pixels of a drag that an arrow key is worth

/** One body, with the lines of its reference shape. */
class PanelView {
  readonly scene = new THREE.Scene();
  readonly canvas = document.createElement("canvas");
  readonly body = new BodyView();
  private readonly rest = new THREE.LineBasicMaterial({ transparent: true, opacity: 0.18 });
  private readonly surface = new Surface();

  constructor(
    shapes: Shapes,
    private readonly kind: FieldKind,
    panel: Panel,
  ) {
    const empty = { node: new Uint32Array(0), local: new Uint32Array(0), held: new Uint32Array(0), fronts: [], advances: [] };
    const words = { scene: "", title: panel.title, model: "", values: "", response: "", hasRecord: false };
    const counts = { epoch: 1, topology: 0, nodes: 0, tets: 0, meanEdge: 0, maxForce: 0, script: 0 };
    this.surface.setBody({ ...empty, ...words, ...counts, positions: shapes.reference, faces: shapes.faces });
    const lines = new THREE.BufferGeometry();
    lines.setAttribute("position", new THREE.BufferAttribute(shapes.reference, 3));
    lines.setIndex(new THREE.BufferAttribute(edgesOf(this.surface), 1));
    this.surface.applyState({ epoch: 1, topology: 0, displacement: panel.displacement, values: panel.values } as State);
    this.body.follow(this.surface, panel.values.length > 0 ? kind : undefined, { top: shapes.top, least: 0, most: shapes.top });
    this.scene.add(new THREE.LineSegments(lines, this.rest), this.body.group);
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", `${panel.title}, ${this.kind.name}`);
  }

  paint(palette: Palette): void {
    this.body.paint(palette);
    this.rest.color.setHex(palette.meshLine);
    this.scene.background = new THREE.Color(palette.background);
  }

  /** Least and greatest corner of what is drawn, so that nothing is cut off. */
  box(): readonly [THREE.Vector3, THREE.Vector3] {
    const box = new THREE.Box3();
    for (const places of [this.surface.reference, this.surface.position]) box.union(new THREE.Box3().setFromArray(places));
    return [box.min, box.max];
  }
}

/** The bodies of one figure, side by side under one eye. */
export class ShapesFigure {
  private readonly panels: readonly PanelView[];
  private readonly rig = new CameraRig();
  private readonly camera = new THREE.PerspectiveCamera(kFieldOfView, 1, 0.01, 10);
  private isDue = false;

  constructor(
    private readonly renderer: THREE.WebGLRenderer,
    place: Element,
    shapes: Shapes,
  ) {
    const kind: FieldKind = { field: Field.none, name: shapes.field, unit: shapes.unit, signed: shapes.signed };
    this.panels = shapes.panels.map((panel) => new PanelView(shapes, kind, panel));
    this.camera.up.set(0, 0, 1);
    const grid = document.createElement("div");
    grid.className = "panels";
    this.panels.forEach((panel, k) => {
      const cell = document.createElement("div");
      const title = document.createElement("span");
      cell.className = "panel";
      title.textContent = shapes.panels[k]?.title ?? "";
      cell.append(panel.canvas, title);
      grid.append(cell);
      this.listen(panel.canvas);
      new ResizeObserver(() => this.requestDraw()).observe(panel.canvas);
    });
    place.append(grid);
    if (shapes.top > 0) place.append(legendOf(shapes, kind));
    this.fit();
  }

  paint(palette: Palette): void {
    for (const panel of this.panels) panel.paint(palette);
    this.requestDraw();
  }

  private fit(): void {
    const all = new THREE.Box3();
    for (const panel of this.panels) all.union(new THREE.Box3(...panel.box()));
    const first = this.panels[0]?.canvas;
    if (first !== undefined && first.clientHeight > 0) this.rig.aspect = first.clientWidth / first.clientHeight;
    this.rig.fit([all.min.x, all.min.y, all.min.z], [all.max.x, all.max.y, all.max.z]);
    this.requestDraw();
  }

  private listen(canvas: HTMLCanvasElement): void {
    canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
    canvas.addEventListener("pointermove", (event) => {
      if (event.buttons === 0) return;
      this.rig.turn(event.movementX, event.movementY);
      this.requestDraw();
    });
    canvas.addEventListener("dblclick", () => this.fit());
    const turns: Readonly<Record<string, readonly [number, number]>> = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    canvas.addEventListener("keydown", (event) => {
      const turn = turns[event.key];
      if (event.key === "Home") this.fit();
      else if (turn === undefined) return;
      else this.rig.turn(kKeyTurn * turn[0], kKeyTurn * turn[1]);
      event.preventDefault();
      this.requestDraw();
    });
    // The wheel goes on with the page until a shape was chosen.
    const zoom = (event: WheelEvent): void => {
      if (document.activeElement !== canvas) return;
      event.preventDefault();
      this.rig.zoom(kWheel ** event.deltaY);
      this.requestDraw();
    };
    canvas.addEventListener("wheel", zoom, { passive: false });
  }

  private requestDraw(): void {
    if (this.isDue) return;
    this.isDue = true;
    requestAnimationFrame(() => {
      this.isDue = false;
      for (const panel of this.panels) this.draw(panel);
    });
  }

  /** One renderer draws all pictures of a report, which may be more than a browser has contexts for. */
  private draw(panel: PanelView): void {
    const { canvas } = panel;
    const ratio = Math.min(2, devicePixelRatio);
    const width = Math.round(canvas.clientWidth * ratio);
    const height = Math.round(canvas.clientHeight * ratio);
    const picture = canvas.getContext("2d");
    if (width === 0 || height === 0 || picture === null) return;
    canvas.width = width;
    canvas.height = height;
    this.renderer.setSize(width, height, false);
    this.rig.aspect = this.camera.aspect = width / height;
    this.camera.position.set(...this.rig.eye());
    this.camera.lookAt(...this.rig.target);
    [this.camera.near, this.camera.far] = this.rig.bounds();
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
    panel.body.light(new THREE.Vector3(0, 0, 1).transformDirection(this.camera.matrixWorldInverse));
    this.renderer.render(panel.scene, this.camera);
    picture.drawImage(this.renderer.domElement, 0, 0);
  }
}

function legendOf(shapes: Shapes, kind: FieldKind): HTMLElement {
  const unit = unitFor(shapes.unit, shapes.top);
  const text = (value: number): string => significant(value * unit.factor);
  const legend = document.createElement("div");
  const bar = document.createElement("i");
  legend.className = "legend";
  bar.style.background = gradientOf(rampOf(kind));
  legend.append(shapes.signed ? text(-shapes.top) : "0", bar, `${text(shapes.top)} ${unit.name}, ${kind.name}`);
  return legend;
}
