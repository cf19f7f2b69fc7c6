import type { Body, Command, Hello } from "../protocol/messages";
import { readDeclarations, readValues } from "../session/declarations";
import { Facts, byId, make, setText } from "./dom";
import { ParameterForm } from "./parameter_form";

/** Which scene, what body it made, and its values. */
export class ScenePanel {
  private readonly title = byId("title", HTMLSpanElement);
  private readonly chooser = byId("scene-chooser", HTMLDivElement);
  private readonly scene = byId("scene", HTMLSelectElement);
  private readonly open = byId("open-scene", HTMLButtonElement);
  private readonly facts = new Facts(byId("body-facts", HTMLDListElement));
  private readonly parameters = byId("parameters", HTMLDetailsElement);
  private readonly form: ParameterForm;

  constructor(send: (command: Command) => void) {
    this.form = new ParameterForm((key, value) => send({ kind: "setValue", key, value }));
    this.open.addEventListener("click", () => send({ kind: "openScene", file: this.scene.value }));
  }

  hear(hello: Hello): void {
    const names = hello.scenes.map((file) => make("option", { value: file, textContent: nameOf(file) }));
    this.scene.replaceChildren(...names);
    this.chooser.hidden = hello.replay || hello.scenes.length === 0;
    const declarations = readDeclarations(hello.declarations);
    this.parameters.hidden = declarations.length === 0;
    this.form.declare(declarations);
  }

  show(body: Body): void {
    setText(this.title, body.title === "" ? nameOf(body.scene) : body.title);
    document.title = `${body.title === "" ? nameOf(body.scene) : body.title} – Rhexis`;
    for (const option of this.scene.options)
      if (option.value === body.scene || nameOf(option.value) === nameOf(body.scene)) option.selected = true;
    this.facts.set("Model", body.model);
    this.facts.set("Nodes", body.nodes.toLocaleString("en"));
    this.facts.set("Tets", body.tets.toLocaleString("en"));
    this.facts.set("Mean edge", `${(1000 * body.meanEdge).toFixed(1)} mm`);
    this.form.show(readValues(body.values));
  }

  /** Something was refused. */
  restore(): void {
    this.form.restore();
  }

  set isEnabled(on: boolean) {
    this.scene.disabled = !on;
    this.open.disabled = !on;
    this.form.isEnabled = on;
  }
}

const nameOf = (file: string): string => file.slice(file.lastIndexOf("/") + 1);
