/** Colours of the three-dimensional picture; those of the page stand in style.css. */
export interface Palette {
  readonly background: number;
  readonly rest: number; // of the body outside of the local objects
  readonly local: number;
  readonly meshLine: number;
  readonly front: number;
  readonly support: number;
  readonly force: number;
  readonly hand: number;
  readonly cursor: number;
}

export const kLight: Palette = {
  background: 0xe4e7eb,
  rest: 0x98a0aa,
  local: 0xffffff,
  meshLine: 0x3c444e,
  front: 0xd1242f,
  support: 0x1f5fa8,
  force: 0xc05600,
  hand: 0x13171c,
  cursor: 0x0b5fd0,
};

export const kDark: Palette = {
  background: 0x14181d,
  rest: 0x6d7680,
  local: 0xf4f6f8,
  meshLine: 0x0c0f12,
  front: 0xff5c61,
  support: 0x6cb0ff,
  force: 0xffa04d,
  hand: 0xffffff,
  cursor: 0x7cc0ff,
};
