import { fixed } from "../base/format";
import type { Rates } from "../protocol/messages";
import { byId, make, setText } from "./dom";

type Row = readonly [rate: HTMLElement, worst: HTMLElement];

/** How often haptic loop and physics run, and the worst of the last second of each. */
export class LoopsPanel {
  private readonly haptic: Row;
  private readonly physics: Row;
  private readonly more = make("p", { className: "parts" });

  constructor() {
    const rows = make("tbody");
    const add = (name: string): Row => {
      const cells = [make("td"), make("td")] as const;
      rows.append(make("tr", {}, make("th", { scope: "row", textContent: name }), ...cells));
      return cells;
    };
    this.haptic = add("Haptic loop");
    this.physics = add("Physics");
    const heads = ["", "per second", "worst tick"].map((text) => make("th", { scope: "col", textContent: text }));
    byId("loops", HTMLDivElement).append(make("table", {}, make("thead", {}, make("tr", {}, ...heads)), rows), this.more);
  }

  /** `roundTrip`: ms, to the program and back. */
  show(rates: Rates | null, roundTrip: number | null): void {
    const set = (row: Row, rate: string, worst: string): void => {
      setText(row[0], rate);
      setText(row[1], worst);
    };
    if (rates === null) {
      set(this.haptic, "–", "–");
      set(this.physics, "–", "–");
    } else {
      set(this.haptic, fixed(rates.hapticHz, 0), `${fixed(rates.hapticWorstUs, 0)} µs late`);
      set(this.physics, fixed(rates.physicsHz, 0), `${fixed(rates.physicsWorstMs, 1)} ms`);
    }
    const parts = rates === null ? [] : [
      `Force law ${fixed(rates.snapshotAgeMs, 0)} ms old`,
      `${rates.hapticMissed} late ticks`,
      rates.realtime ? "real-time priority" : "no real-time priority",
    ];
    if (roundTrip !== null) parts.push(`page and back ${fixed(roundTrip, 0)} ms`);
    setText(this.more, parts.join(" · "));
  }
}
