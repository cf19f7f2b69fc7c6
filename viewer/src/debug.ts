import type { Vec3 } from "./base/vec3";
import { vectorAt } from "./base/vec3";
import type { Link } from "./protocol/connection";
import type { Body, Hello, Role, State, Timeline, Trial } from "./protocol/messages";
import type { Store } from "./session/store";
import type { Stage } from "./view/stage";

/**
 * `window.rhexis`: what the page knows, to be read by tests and by people at the browser's console. Nothing can be done
 * to the interaction through it (docs/page.md).
 */
export interface DebugHandle {
  readonly link: Link["kind"];
  readonly hello: Hello | null;
  readonly role: Role | null;
  readonly body: Body | null;
  readonly state: State | null;
  readonly timeline: Timeline | null;
  readonly trial: Trial | null;
  readonly frames: number;
  readonly surface: { readonly vertices: number; readonly faces: number; readonly topology: number };
  readonly advances: number;
  readonly pictures: number;
  readonly isInHeadset: boolean;
  /** px of the page at which the vertex nearest to a reference point (m) is seen; null behind the eye. */
  pixelOf(reference: Vec3): readonly [number, number] | null;
  /** m in the world of a headset, of the same vertex. */
  placeOf(reference: Vec3): Vec3;
}

declare global {
  interface Window {
    readonly rhexis?: DebugHandle;
  }
}

export function exposeDebugHandle(store: Store, stage: Stage, link: () => Link, pictures: () => number): void {
  const nearest = (reference: Vec3): Vec3 => {
    const { surface } = store;
    let best = 0;
    let least = Infinity;
    for (let v = 0; v < surface.vertexCount; ++v) {
      const distance = Math.hypot(...vectorAt(surface.reference, v).map((x, c) => x - (reference[c] ?? 0)));
      if (distance >= least) continue;
      least = distance;
      best = v;
    }
    return vectorAt(surface.position, best);
  };
  const handle: DebugHandle = {
    get link() {
      return link().kind;
    },
    get hello() {
      return store.hello;
    },
    get role() {
      return store.role;
    },
    get body() {
      return store.body;
    },
    get state() {
      return store.state;
    },
    get timeline() {
      return store.timeline;
    },
    get trial() {
      return store.trial;
    },
    get frames() {
      return store.frames;
    },
    get surface() {
      const { surface } = store;
      let faces = 0;
      for (let slot = 0; slot < surface.slotCount; ++slot) faces += surface.isEmpty(slot) ? 0 : 1;
      return { vertices: surface.vertexCount, faces, topology: surface.topology };
    },
    get advances() {
      return store.advances.length;
    },
    get pictures() {
      return pictures();
    },
    get isInHeadset() {
      return stage.renderer.xr.isPresenting;
    },
    pixelOf: (reference) => stage.pixelOf(nearest(reference)),
    placeOf: (reference) => stage.worldOf(nearest(reference)),
  };
  Object.defineProperty(window, "rhexis", { value: Object.freeze(handle), writable: false });
}
