/**
 * Oklab, a space in which equal steps look equally large (B. Ottosson, 2020), from its definition: sRGB, linear light,
 * the responses of three cones, their cube roots, and a rotation.
 */

/** Components of sRGB, 0 to 1. */
export type Rgb = readonly [number, number, number];
/** Lightness 0 to 1, chroma, hue in degrees. */
export type Lch = readonly [number, number, number];

type Row = readonly [number, number, number];
type Matrix = readonly [Row, Row, Row];

const kConesOfLab: Matrix = [
  [1, 0.3963377774, 0.2158037573],
  [1, -0.1055613458, -0.0638541728],
  [1, -0.0894841775, -1.291485548],
];
const kRgbOfCones: Matrix = [
  [4.0767416621, -3.3077115913, 0.2309699292],
  [-1.2684380046, 2.6097574011, -0.3413193965],
  [-0.0041960863, -0.7034186147, 1.707614701],
];

const times = (m: Matrix, v: Row): Row => [
  m[0][0] * v[0] + m[0][1] * v[1] + m[0][2] * v[2],
  m[1][0] * v[0] + m[1][1] * v[1] + m[1][2] * v[2],
  m[2][0] * v[0] + m[2][1] * v[1] + m[2][2] * v[2],
];

/** The transfer curve of sRGB. */
const encoded = (light: number): number => (light <= 0.0031308 ? 12.92 * light : 1.055 * light ** (1 / 2.4) - 0.055);

/** Linear light; outside 0 to 1 the screen has no such colour. */
function lightOf([lightness, chroma, hue]: Lch): Row {
  const angle = (hue * Math.PI) / 180;
  const cones = times(kConesOfLab, [lightness, chroma * Math.cos(angle), chroma * Math.sin(angle)]);
  return times(kRgbOfCones, [cones[0] ** 3, cones[1] ** 3, cones[2] ** 3]);
}

export const isShown = (colour: Lch): boolean => lightOf(colour).every((c) => c >= -1e-6 && c <= 1 + 1e-6);

/** Where the screen has no such colour, the most colourful that it has of this lightness and hue. */
export function rgbOf(colour: Lch): Rgb {
  const [lightness, chroma, hue] = colour;
  let least = 0;
  let most = chroma;
  if (!isShown(colour)) {
    for (let k = 0; k < 24; ++k) {
      const middle = (least + most) / 2;
      if (isShown([lightness, middle, hue])) least = middle;
      else most = middle;
    }
    most = least;
  }
  const light = lightOf([lightness, most, hue]);
  const component = (c: number): number => encoded(Math.min(1, Math.max(0, c)));
  return [component(light[0]), component(light[1]), component(light[2])];
}

/** Lightness of a colour of the screen: what of it is left in a black and white print. */
export function lightnessOf(rgb: Rgb): number {
  const linear = rgb.map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4)) as unknown as Row;
  const cones = times(inverse(kRgbOfCones), linear);
  const roots = cones.map(Math.cbrt) as unknown as Row;
  return times(inverse(kConesOfLab), roots)[0];
}

function inverse(m: Matrix): Matrix {
  const cofactor = (r: number, c: number): number => {
    const rows = [0, 1, 2].filter((k) => k !== r);
    const columns = [0, 1, 2].filter((k) => k !== c);
    const at = (i: number, j: number): number => m[rows[i] ?? 0]?.[columns[j] ?? 0] ?? 0;
    return ((r + c) % 2 === 0 ? 1 : -1) * (at(0, 0) * at(1, 1) - at(0, 1) * at(1, 0));
  };
  const determinant = m[0][0] * cofactor(0, 0) + m[0][1] * cofactor(0, 1) + m[0][2] * cofactor(0, 2);
  const row = (r: number): Row => [cofactor(0, r) / determinant, cofactor(1, r) / determinant, cofactor(2, r) / determinant];
  return [row(0), row(1), row(2)];
}
