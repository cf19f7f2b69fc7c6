import type { Command, State } from "../protocol/messages";
import { byId, make, setText } from "./dom";

interface Control {
  readonly button: HTMLButtonElement;
  readonly label: HTMLElement;
}

/** Ticks of a step: 10 ms, so that one sees something move. */
const kStepTicks = 10;

/** The buttons below the picture, and what the keys of the same meaning do. */
export class Transport {
  private readonly bar = byId("transport", HTMLDivElement);
  private hasScript = false;
  private readonly script = this.add("script", "Run script", "Space", () => this.toggleScript());
  private readonly pause = this.add("pause", "Pause", "P", () => this.togglePause());
  private readonly step = this.add("step", "Step", "S", () => this.stepOn());
  private readonly undo = this.add("undo", "Undo tear", "U", () => this.send({ kind: "undo" }));
  private readonly reset = this.add("reset", "Reset", "R", () => this.send({ kind: "reset" }));
  private readonly record = this.add("record", "Record", "", () => this.toggleRecord());

  /** `state`: the newest, which a key that follows on another has to go by; what is drawn comes a picture later. */
  constructor(
    private readonly send: (command: Command) => void,
    private readonly state: () => State | null,
  ) {}

  /** `mayAct`: connected, and this page has the hand. `script`: the scene has pulls. `mayUndo`: something has torn. */
  show(mayAct: boolean, script: boolean, mayUndo: boolean): void {
    const state = this.state();
    this.hasScript = script;
    const isPaused = state?.paused ?? false;
    setText(this.script.label, state?.scripted ? "Stop script" : "Run script");
    setText(this.pause.label, isPaused ? "Go on" : "Pause");
    setText(this.record.label, state?.recording ? "Stop recording" : "Record");
    press(this.script, state?.scripted ?? false);
    press(this.pause, isPaused);
    press(this.record, state?.recording ?? false);
    for (const control of [this.pause, this.undo, this.reset, this.record]) control.button.disabled = !mayAct;
    this.script.button.disabled = !mayAct || !script;
    this.step.button.disabled = !mayAct || !isPaused;
    this.undo.button.disabled = !mayAct || !mayUndo;
  }

  set isHidden(on: boolean) {
    this.bar.hidden = on;
  }

  toggleScript(): void {
    if (this.hasScript) this.send({ kind: "script", on: !(this.state()?.scripted ?? false) });
  }

  togglePause(): void {
    this.send({ kind: "pause", on: !(this.state()?.paused ?? false) });
  }

  stepOn(): void {
    if (this.state()?.paused) this.send({ kind: "step", ticks: kStepTicks });
  }

  private toggleRecord(): void {
    this.send({ kind: "record", on: !(this.state()?.recording ?? false) });
  }

  private add(name: string, text: string, key: string, act: () => void): Control {
    const label = make("span", { textContent: text });
    const button = make("button", { type: "button", id: `do-${name}` }, label);
    if (key !== "") {
      button.append(make("kbd", { textContent: key, ariaHidden: "true" }));
      button.setAttribute("aria-keyshortcuts", key);
    }
    button.addEventListener("click", act);
    this.bar.append(button);
    return { button, label };
  }
}

/** The label says what a press does, so a pressed state would say it twice; it is for the eye alone. */
function press(control: Control, on: boolean): void {
  control.button.classList.toggle("on", on);
}
