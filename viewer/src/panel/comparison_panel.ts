import { fixed, forceText } from "../base/format";
import { length, type Vec3 } from "../base/vec3";
import type { Body, Command, State } from "../protocol/messages";
import { byId, make, setText } from "./dom";

/** The switch for the force of the other response, and the two forces side by side. */
export class ComparisonPanel {
  private readonly row = byId("compare-row", HTMLLabelElement);
  private readonly box = byId("compare", HTMLInputElement);
  private readonly name = byId("compare-name", HTMLSpanElement);
  private readonly legend = byId("force-legend", HTMLUListElement);
  private readonly own = make("span");
  private readonly other = make("span");
  private readonly difference = make("li", { className: "difference" });
  /** What was asked for, until a State says so, or something is refused. */
  private wanted: boolean | null = null;

  constructor(send: (command: Command) => void) {
    this.legend.append(make("li", { className: "own" }, this.own), make("li", { className: "other" }, this.other), this.difference);
    this.box.addEventListener("change", () => {
      this.wanted = this.box.checked;
      send({ kind: "compare", on: this.box.checked });
    });
  }

  /** `mayAct`: connected, with the hand, and not a replay. */
  show(body: Body | null, state: State | null, mayAct: boolean, isReplay: boolean): void {
    const isRecorded = body?.response === "recorded";
    const compared = state?.comparedForce ?? null;
    this.row.hidden = isReplay || body === null || (!isRecorded && !body.hasRecord);
    this.box.disabled = !mayAct;
    if (this.wanted === (compared !== null)) this.wanted = null;
    this.box.checked = this.wanted ?? compared !== null;
    setText(this.name, isRecorded ? "Exact force beside it" : "Recorded force beside it");
    this.legend.hidden = compared === null;
    if (state === null || compared === null) return;
    setText(this.own, `${isRecorded ? "Recorded" : "Exact"} ${forceText(length(state.bodyForce))} N`);
    setText(this.other, `${isRecorded ? "Exact" : "Recorded"} ${forceText(length(compared))} N`);
    setText(this.difference, `Difference ${percent(isRecorded ? state.bodyForce : compared, isRecorded ? compared : state.bodyForce)}`);
    this.legend.dataset["tick"] = String(state.tick);
  }

  /** Something was refused. */
  restore(): void {
    this.wanted = null;
  }
}

/** Of the length of their difference in that of the exact one; a dash where there is no force. */
export function percent(recorded: Vec3, exact: Vec3): string {
  const off = length([recorded[0] - exact[0], recorded[1] - exact[1], recorded[2] - exact[2]]);
  const size = length(exact);
  return size > 1e-9 ? `${fixed((100 * off) / size, 2)} %` : "\u2013";
}
