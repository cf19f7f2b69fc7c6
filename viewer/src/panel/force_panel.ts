import { fixed, forceText } from "../base/format";
import { length } from "../base/vec3";
import type { State } from "../protocol/messages";
import { Facts, byId, setText } from "./dom";

/** The reaction force in newtons, its components, and the work of the hand. */
export class ForcePanel {
  private readonly force = byId("force", HTMLOutputElement);
  private readonly parts = byId("force-parts", HTMLParagraphElement);
  private readonly energies = new Facts(byId("energies", HTMLDListElement));

  show(state: State | null): void {
    const force = state?.force ?? [0, 0, 0];
    setText(this.force, forceText(length(force)));
    // Which State it is of, so that a test can hold the text against the program's own number.
    this.force.dataset["tick"] = String(state?.tick ?? 0);
    this.force.classList.toggle("limited", state?.limited ?? false);
    setText(this.parts, `x ${forceText(force[0])}   y ${forceText(force[1])}   z ${forceText(force[2])}`);
    this.energies.set("Hand work", `${fixed(state?.handWork ?? 0, 4)} J`);
    this.energies.set("Stored", `${fixed(state?.storedEnergy ?? 0, 4)} J`);
    this.energies.set("Torn", `${fixed(1e6 * (state?.crackArea ?? 0), 1)} mm²`);
    this.energies.set("Pulled", `${fixed(1000 * (state?.held ? length(state.hand) : 0), 1)} mm`);
  }
}
