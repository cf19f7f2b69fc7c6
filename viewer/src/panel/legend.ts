import { significant, unitFor } from "../base/format";
import { gradientOf } from "../colour/ramp";
import { rampOf, type FieldKind, type Scale } from "../colour/scale";
import { byId, make, setText } from "./dom";

/** What the colours mean: name and unit of the field, the values at both ends and in the middle. */
export class Legend {
  private readonly box = byId("legend", HTMLDivElement);
  private readonly name = make("p", { className: "legend-name" });
  private readonly bar = make("div", { className: "legend-bar" });
  private readonly ticks = [make("span"), make("span"), make("span")] as const;
  private readonly extremes = make("p", { className: "legend-extremes" });
  private shown: FieldKind | undefined;

  constructor() {
    this.box.append(this.name, this.bar, make("div", { className: "legend-ticks" }, ...this.ticks), this.extremes);
  }

  show(kind: FieldKind | undefined, scale: Scale): void {
    this.box.hidden = kind === undefined;
    if (kind === undefined) return;
    const unit = unitFor(kind.unit, scale.top);
    if (kind !== this.shown) this.bar.style.background = gradientOf(rampOf(kind));
    this.shown = kind;
    setText(this.name, `${kind.name}, ${unit.name}`);
    const first = kind.signed ? -scale.top : 0;
    [first, (first + scale.top) / 2, scale.top].forEach((value, k) => {
      const isCut = (k === 2 && scale.most > scale.top) || (k === 0 && scale.least < first);
      const sign = isCut ? (k === 2 ? "≥ " : "≤ ") : "";
      const tick = this.ticks[k];
      // A scale without a width has one value.
      const text = scale.top > 0 || k === (kind.signed ? 1 : 0) ? significant(value * unit.factor, 2) : "";
      if (tick !== undefined) setText(tick, sign + text);
    });
    if (scale.least === 0 && scale.most === 0) setText(this.extremes, "zero everywhere");
    else setText(this.extremes, `in all ${significant(scale.least * unit.factor)} to ${significant(scale.most * unit.factor)}`);
  }
}
