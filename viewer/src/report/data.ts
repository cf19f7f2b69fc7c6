/** What `rhexis study` puts into a report beside a picture (src/studies/report.cpp). */
interface Sent {
  readonly reference: string;
  readonly faces: string;
  readonly field: string;
  readonly unit: string;
  readonly signed: boolean;
  readonly top: number;
  readonly panels: readonly { readonly title: string; readonly displacement: string; readonly values: string }[];
}

export interface Panel {
  readonly title: string;
  readonly displacement: Float32Array; // m, 3 a vertex
  readonly values: Float32Array; // one a vertex; empty: not coloured
}

/** Bodies of one figure: the same surface, deformed in different ways. */
export interface Shapes {
  readonly reference: Float32Array; // m, 3 a vertex
  readonly faces: Uint32Array; // 3 vertices a face
  readonly field: string;
  readonly unit: "Pa" | "m";
  readonly signed: boolean;
  readonly top: number;
  readonly panels: readonly Panel[];
}

function bytesOf(base64: string): ArrayBuffer {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let k = 0; k < text.length; ++k) bytes[k] = text.charCodeAt(k);
  return bytes.buffer;
}

/**
 * Values are one a face, and a face has one colour: where lambda jumps from tet to tet it has to be seen. So each face
 * gets three vertices of its own.
 */
export function readShapes(json: string): Shapes {
  const sent = JSON.parse(json) as Sent;
  const corners = new Uint32Array(bytesOf(sent.faces));
  const apart = (base64: string): Float32Array => {
    const values = new Float32Array(bytesOf(base64));
    const out = new Float32Array(3 * corners.length);
    corners.forEach((vertex, k) => out.set(values.subarray(3 * vertex, 3 * vertex + 3), 3 * k));
    return out;
  };
  return {
    reference: apart(sent.reference),
    faces: Uint32Array.from(corners, (_, k) => k),
    field: sent.field,
    unit: sent.unit === "m" ? "m" : "Pa",
    signed: sent.signed,
    top: sent.top,
    panels: sent.panels.map((panel) => {
      const values = new Float32Array(bytesOf(panel.values));
      const spread = Float32Array.from({ length: 3 * values.length }, (_, k) => values[Math.floor(k / 3)] ?? 0);
      return { title: panel.title, displacement: apart(panel.displacement), values: spread };
    }),
  };
}
