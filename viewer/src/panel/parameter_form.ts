import {
  bySection,
  complaint,
  formOf,
  hasSlider,
  labelOf,
  rangeText,
  unitText,
  type Declaration,
} from "../session/declarations";
import { byId, make, setText } from "./dom";

interface Entry {
  readonly declaration: Declaration;
  readonly input: HTMLInputElement | HTMLSelectElement;
  readonly slider: HTMLInputElement | null;
  readonly complaint: HTMLElement;
  readonly row: HTMLElement;
}

/** Model and parameters, made of what the scene's own declarations say. */
export class ParameterForm {
  private readonly frame = byId("parameter-form", HTMLDivElement);
  private readonly entries = new Map<string, Entry>();
  private values: ReadonlyMap<string, string> = new Map();

  /** `commit`: a key gets a value that the page finds nothing wrong with. */
  constructor(private readonly commit: (key: string, value: string) => void) {}

  declare(declarations: readonly Declaration[]): void {
    this.entries.clear();
    this.frame.replaceChildren(
      ...[...bySection(declarations)].map(([section, keys]) =>
        make("fieldset", {}, make("legend", { textContent: section }), ...keys.map((key) => this.add(key))),
      ),
    );
  }

  /** Of the present body. Keys that it has no value for are shown empty. */
  show(values: ReadonlyMap<string, string>): void {
    this.values = values;
    for (const entry of this.entries.values()) this.fill(entry);
  }

  /** Back to the body's own values, after something was refused. */
  restore(): void {
    this.show(this.values);
  }

  set isEnabled(on: boolean) {
    for (const { input, slider } of this.entries.values()) {
      input.disabled = !on;
      if (slider !== null) slider.disabled = !on;
    }
  }

  private add(declaration: Declaration): HTMLElement {
    const id = `value-${declaration.key}`;
    const input = inputFor(declaration);
    input.id = id;
    const wrong = make("p", { className: "complaint", id: `${id}-complaint` });
    wrong.setAttribute("role", "alert");
    input.setAttribute("aria-describedby", wrong.id);
    const range = rangeText(declaration);
    const title = [declaration.doc.replaceAll("`", ""), range === "" ? "" : `Range: ${range}.`].filter((text) => text !== "").join(" ");
    const label = make("label", { htmlFor: id, textContent: labelOf(declaration), title });
    const unit = make("span", { className: "unit", textContent: unitText(declaration.unit) });
    const row = make("div", { className: "parameter", title }, label, input, unit);
    const slider = hasSlider(declaration) ? sliderFor(declaration) : null;
    if (slider !== null) row.append(slider);
    row.append(wrong);
    const entry: Entry = { declaration, input, slider, complaint: wrong, row };
    input.addEventListener("change", () => this.submit(entry, valueOf(input)));
    slider?.addEventListener("input", () => (input.value = slider.value));
    slider?.addEventListener("change", () => this.submit(entry, slider.value));
    this.entries.set(declaration.key, entry);
    return row;
  }

  private submit(entry: Entry, value: string): void {
    const wrong = complaint(entry.declaration, value);
    setText(entry.complaint, wrong);
    entry.input.setAttribute("aria-invalid", String(wrong !== ""));
    if (wrong !== "" || value === this.values.get(entry.declaration.key)) return;
    entry.row.classList.add("pending");
    this.commit(entry.declaration.key, value.trim());
  }

  private fill({ declaration, input, slider, complaint: wrong, row }: Entry): void {
    const value = this.values.get(declaration.key) ?? "";
    row.classList.remove("pending");
    setText(wrong, "");
    input.setAttribute("aria-invalid", "false");
    if (input instanceof HTMLInputElement && input.type === "checkbox") input.checked = value === "true";
    // What someone is typing is not taken from under the fingers.
    else if (document.activeElement !== input || input instanceof HTMLSelectElement || value !== "") input.value = value;
    if (slider !== null) slider.value = value;
  }
}

function inputFor(declaration: Declaration): HTMLInputElement | HTMLSelectElement {
  switch (formOf(declaration)) {
    case "choice": {
      const options = declaration.choices.map((choice) => make("option", { value: choice, textContent: choice }));
      return make("select", {}, ...options);
    }
    case "switch":
      return make("input", { type: "checkbox" });
    case "number":
      // Text, since a number's own input hides what it does not understand, and "1e6" is how moduli are typed.
      return make("input", { type: "text", inputMode: "decimal", autocomplete: "off", spellcheck: false });
    case "text":
      return make("input", { type: "text", autocomplete: "off", spellcheck: false });
  }
}

function sliderFor(declaration: Declaration): HTMLInputElement {
  const slider = make("input", { type: "range", min: String(declaration.min), max: String(declaration.max) });
  slider.step = declaration.kind === "integer" ? "1" : String((declaration.max - declaration.min) / 200);
  slider.setAttribute("aria-label", `${labelOf(declaration)}, slider`);
  return slider;
}

const valueOf = (input: HTMLInputElement | HTMLSelectElement): string =>
  input instanceof HTMLInputElement && input.type === "checkbox" ? String(input.checked) : input.value;
