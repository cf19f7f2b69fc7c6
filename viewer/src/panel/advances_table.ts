import { fixed } from "../base/format";
import { length } from "../base/vec3";
import type { Advance } from "../protocol/messages";
import { byId, make, setText } from "./dom";

/** Rows that are kept on the page; what went before is in the recording. */
const kRows = 200;
const kColumns: readonly (readonly [string, string])[] = [
  ["#", "number of the topology"],
  ["s", "time, seconds"],
  ["mm", "length, millimetres"],
  ["°", "angle, degrees from +x in the x-y plane"],
  ["tets", "tetrahedra removed"],
  ["pcs", "pieces of the body after it"],
  ["ms", "re-meshing, local object and response, milliseconds"],
  ["N", "force on the hand before and after it, newtons"],
];

/** All that the crack has done, the last first. */
export class AdvancesTable {
  private readonly frame = byId("advances", HTMLDivElement);
  private readonly count = byId("advance-count", HTMLSpanElement);
  private readonly rows = make("tbody");
  private shown: readonly Advance[] = [];

  constructor() {
    const heads = kColumns.map(([name, title]) => make("th", { scope: "col", textContent: name, title }));
    this.frame.append(make("table", {}, make("thead", {}, make("tr", {}, ...heads)), this.rows));
  }

  show(advances: readonly Advance[]): void {
    if (advances === this.shown) return;
    const isLonger = this.shown.length > 0 && advances[this.shown.length - 1] === this.shown[this.shown.length - 1];
    if (!isLonger) this.rows.replaceChildren();
    for (const advance of advances.slice(isLonger ? this.shown.length : 0)) this.rows.prepend(rowOf(advance));
    while (this.rows.children.length > kRows) this.rows.lastElementChild?.remove();
    this.shown = advances;
    setText(this.count, String(advances.length));
    this.frame.hidden = advances.length === 0;
  }
}

function rowOf(advance: Advance): HTMLTableRowElement {
  const force = `${fixed(length(advance.forceBefore), 2)} → ${fixed(length(advance.forceAfter), 2)}`;
  const cells = [
    String(advance.topology),
    fixed(advance.time, 2),
    fixed(1000 * advance.length, 2),
    fixed(advance.angle, 0),
    String(advance.tetsRemoved),
    String(advance.pieces),
    fixed(advance.milliseconds, 1),
    force,
  ];
  const row = make("tr", {}, ...cells.map((text) => make("td", { textContent: text })));
  if (advance.started) row.title = "a crack begins here";
  row.classList.toggle("started", advance.started);
  return row;
}
