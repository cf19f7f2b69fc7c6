import * as THREE from "three";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";

import { vectorAt, type Vec3 } from "../base/vec3";
import { FrontLines } from "../body/followers";
import type { Surface } from "../body/surface";
import type { Palette } from "./palette";

/** What is drawn onto the body: crack fronts, supports, the point that is held, the cursor of the keyboard. */
export class Marks {
  readonly group = new THREE.Group();
  private readonly frontMaterial = new LineMaterial({ linewidth: 4, depthTest: false, transparent: true });
  private fronts: LineSegments2 | null = null;
  private readonly supportGeometry = new THREE.BufferGeometry();
  private readonly supportMaterial = new THREE.PointsMaterial({ size: 7, sizeAttenuation: false, map: discTexture(), alphaTest: 0.5 });
  private readonly hand = bead();
  private readonly cursor = bead();
  private lines: FrontLines | null = null;
  private shapeVersion = -1;
  private stateVersion = -1;
  private size = 1;

  constructor() {
    // A little towards the eye, so that the faces which meet at a vertex do not cut its mark in half.
    this.supportMaterial.onBeforeCompile = (shader) => {
      shader.vertexShader = shader.vertexShader.replace("#include <fog_vertex>", "gl_Position.z -= 2e-3 * gl_Position.w;");
    };
    const supports = new THREE.Points(this.supportGeometry, this.supportMaterial);
    supports.frustumCulled = false;
    this.group.add(supports, this.hand, this.cursor);
  }

  paint(palette: Palette): void {
    this.frontMaterial.color.setHex(palette.front);
    this.supportMaterial.color.setHex(palette.support);
    (this.hand.material as THREE.MeshBasicMaterial).color.setHex(palette.hand);
    (this.cursor.material as THREE.MeshBasicMaterial).color.setHex(palette.cursor);
  }

  /** m, of the body: what beads are sized by. */
  set bodySize(size: number) {
    this.size = size;
  }

  follow(surface: Surface): void {
    if (surface.shapeVersion !== this.shapeVersion) {
      this.lines = new FrontLines(surface);
      this.supportGeometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * surface.held.length), 3));
      this.stateVersion = -1;
    }
    if (surface.stateVersion !== this.stateVersion) this.deform(surface);
    this.shapeVersion = surface.shapeVersion;
    this.stateVersion = surface.stateVersion;
  }

  /** null: nothing is held. */
  showHand(at: Vec3 | null): void {
    place(this.hand, at, 0.009 * this.size);
  }

  showCursor(at: Vec3 | null): void {
    place(this.cursor, at, 0.014 * this.size);
  }

  private deform(surface: Surface): void {
    const support = this.supportGeometry.getAttribute("position") as THREE.BufferAttribute;
    surface.held.forEach((vertex, k) => support.setXYZ(k, ...vectorAt(surface.position, vertex)));
    support.needsUpdate = true;
    const ends = this.lines?.segments() ?? new Float32Array(0);
    if (this.fronts !== null) {
      this.group.remove(this.fronts);
      this.fronts.geometry.dispose();
      this.fronts = null;
    }
    if (ends.length === 0) return;
    this.fronts = new LineSegments2(new LineSegmentsGeometry().setPositions(ends), this.frontMaterial);
    this.fronts.frustumCulled = false;
    this.fronts.renderOrder = 2;
    this.group.add(this.fronts);
  }
}

function bead(): THREE.Mesh {
  const mesh = new THREE.Mesh(new THREE.SphereGeometry(1, 20, 14), new THREE.MeshBasicMaterial({ depthTest: false, transparent: true }));
  mesh.visible = false;
  mesh.renderOrder = 4;
  return mesh;
}

function place(mesh: THREE.Mesh, at: Vec3 | null, radius: number): void {
  mesh.visible = at !== null;
  if (at === null) return;
  mesh.position.set(...at);
  mesh.scale.setScalar(radius);
}

/** White, so that the material colours it. */
function discTexture(): THREE.CanvasTexture {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 32;
  const pen = canvas.getContext("2d");
  if (pen !== null) {
    pen.fillStyle = "white";
    pen.arc(16, 16, 14, 0, 2 * Math.PI);
    pen.fill();
  }
  return new THREE.CanvasTexture(canvas);
}
