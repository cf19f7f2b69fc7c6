import * as THREE from "three";

import { bytesOf } from "../colour/ramp";
import { mappingOf, rampOf, type FieldKind, type Scale } from "../colour/scale";
import { cornerNormals, faceNormals, listCorners, type CornerLists } from "../body/normals";
import type { Surface } from "../body/surface";
import type { Palette } from "./palette";

const kRampColours = 256;

const kVertexShader = /* glsl */ `
  attribute float value;
  attribute float isLocal;
  varying float vValue;
  varying float vLocal;
  varying vec3 vNormal;
  varying vec3 vEye;
  void main() {
    vec4 place = modelViewMatrix * vec4(position, 1.0);
    vValue = value;
    vLocal = isLocal;
    vNormal = normalMatrix * normal;
    vEye = -place.xyz;
    gl_Position = projectionMatrix * place;
  }
`;

// Colours are those of the screen (sRGB), mixed as they are: a colour of the legend has to be that colour on the body,
// so light only dims it, and nothing shines.
const kFragmentShader = /* glsl */ `
  uniform vec3 restColour;
  uniform vec3 localColour;
  uniform sampler2D ramp;
  uniform bool showsField;
  uniform vec2 scale; // value of the first colour, and one over the span to the last
  uniform vec3 up;
  varying float vValue;
  varying float vLocal;
  varying vec3 vNormal;
  varying vec3 vEye;
  void main() {
    vec3 colour = mix(restColour, localColour, step(0.5, vLocal));
    if (showsField) {
      float t = clamp((vValue - scale.x) * scale.y, 0.0, 1.0);
      colour = texture2D(ramp, vec2((t * ${kRampColours - 1}.0 + 0.5) / ${kRampColours}.0, 0.5)).rgb;
    }
    vec3 n = normalize(vNormal) * (gl_FrontFacing ? 1.0 : -1.0);
    float facing = max(dot(n, normalize(vEye)), 0.0);
    float sky = 0.5 + 0.5 * dot(n, up);
    float light = showsField ? 0.70 + 0.18 * facing + 0.12 * sky : 0.42 + 0.34 * facing + 0.24 * sky;
    if (!gl_FrontFacing) light *= 0.75;
    gl_FragColor = vec4(colour * light, 1.0);
  }
`;

/** Draws the surface: faces that are lit, and the lines between them. */
export class BodyView {
  readonly group = new THREE.Group();
  private readonly geometry = new THREE.BufferGeometry();
  private readonly lineGeometry = new THREE.BufferGeometry();
  private readonly ramp = new THREE.DataTexture(new Uint8Array(4 * kRampColours), kRampColours, 1);
  private readonly material = new THREE.ShaderMaterial({
    vertexShader: kVertexShader,
    fragmentShader: kFragmentShader,
    side: THREE.DoubleSide,
    polygonOffset: true, // the lines of the mesh lie on the faces
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
    uniforms: {
      restColour: { value: new THREE.Vector3() },
      localColour: { value: new THREE.Vector3() },
      ramp: { value: this.ramp },
      showsField: { value: false },
      scale: { value: new THREE.Vector2(0, 1) },
      up: { value: new THREE.Vector3(0, 1, 0) },
    },
  });
  private readonly lineMaterial = new THREE.LineBasicMaterial({ transparent: true, opacity: 0.22 });
  private readonly lines = new THREE.LineSegments(this.lineGeometry, this.lineMaterial);
  private corners: CornerLists = { first: new Uint32Array(1), corners: new Uint32Array(0) };
  private faceNormal = new Float32Array(0);
  private shapeVersion = -1;
  private stateVersion = -1;
  private rampKind: FieldKind | null = null;

  constructor() {
    this.ramp.magFilter = THREE.LinearFilter;
    const mesh = new THREE.Mesh(this.geometry, this.material);
    // The bounds change with every frame, and the body is nearly always in the picture.
    mesh.frustumCulled = false;
    this.lines.frustumCulled = false;
    this.group.add(mesh, this.lines);
  }

  set showsLines(on: boolean) {
    this.lines.visible = on;
  }

  paint(palette: Palette): void {
    const components = (hex: number): THREE.Vector3 => new THREE.Vector3((hex >> 16) & 255, (hex >> 8) & 255, hex & 255).divideScalar(255);
    this.material.uniforms["restColour"]!.value = components(palette.rest);
    this.material.uniforms["localColour"]!.value = components(palette.local);
    this.lineMaterial.color.setHex(palette.meshLine);
  }

  /** `up`: in the frame of the eye, where light comes from. */
  light(up: THREE.Vector3): void {
    (this.material.uniforms["up"]!.value as THREE.Vector3).copy(up);
  }

  follow(surface: Surface, kind: FieldKind | undefined, scale: Scale): void {
    if (surface.shapeVersion !== this.shapeVersion) this.shape(surface);
    if (surface.stateVersion !== this.stateVersion) this.deform(surface);
    this.shapeVersion = surface.shapeVersion;
    this.stateVersion = surface.stateVersion;
    const shown = kind !== undefined && surface.values.length > 0;
    this.material.uniforms["showsField"]!.value = shown;
    if (!shown) return;
    if (this.rampKind !== kind) {
      (this.ramp.image.data as Uint8Array).set(bytesOf(rampOf(kind), kRampColours));
      this.ramp.needsUpdate = true;
      this.rampKind = kind;
    }
    const { first, perUnit } = mappingOf(kind, scale);
    (this.material.uniforms["scale"]!.value as THREE.Vector2).set(first, perUnit);
  }

  private shape(surface: Surface): void {
    this.corners = listCorners(surface);
    this.faceNormal = new Float32Array(3 * surface.slotCount);
    const floats = (perSlot: number, size: number) => new THREE.BufferAttribute(new Float32Array(perSlot * surface.slotCount), size);
    this.geometry.setAttribute("position", floats(9, 3));
    this.geometry.setAttribute("normal", floats(9, 3));
    this.geometry.setAttribute("value", floats(3, 1));
    const local = floats(3, 1);
    for (let k = 0; k < 3 * surface.slotCount; ++k) local.array[k] = surface.local[Math.floor(k / 3)] ?? 0;
    this.geometry.setAttribute("isLocal", local);
    this.lineGeometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * surface.vertexCount), 3));
    this.lineGeometry.setIndex(new THREE.BufferAttribute(edgesOf(surface), 1));
    this.stateVersion = -1;
  }

  private deform(surface: Surface): void {
    const attribute = (name: string) => this.geometry.getAttribute(name) as THREE.BufferAttribute;
    const position = attribute("position");
    const value = attribute("value");
    for (let corner = 0; corner < 3 * surface.slotCount; ++corner) {
      const vertex = surface.faces[corner]!;
      for (let c = 0; c < 3; ++c) position.array[3 * corner + c] = surface.position[3 * vertex + c]!;
      value.array[corner] = surface.values[vertex] ?? 0;
    }
    faceNormals(surface, this.faceNormal);
    const normal = attribute("normal");
    cornerNormals(surface, this.corners, this.faceNormal, normal.array as Float32Array);
    for (const changed of [position, value, normal]) changed.needsUpdate = true;
    const line = this.lineGeometry.getAttribute("position") as THREE.BufferAttribute;
    line.array.set(surface.position.subarray(0, 3 * surface.vertexCount));
    line.needsUpdate = true;
  }
}

/** Pairs of vertices, each edge of the surface once. */
export function edgesOf(surface: Surface): Uint32Array {
  const pairs: number[] = [];
  const seen = new Set<number>();
  for (let slot = 0; slot < surface.slotCount; ++slot) {
    if (surface.isEmpty(slot)) continue;
    const corners = surface.corners(slot);
    corners.forEach((a, k) => {
      const b = corners[(k + 1) % 3] ?? a;
      const edge = Math.min(a, b) * surface.vertexCount + Math.max(a, b);
      if (seen.has(edge)) return;
      seen.add(edge);
      pairs.push(a, b);
    });
  }
  return new Uint32Array(pairs);
}
