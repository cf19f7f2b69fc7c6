import type { Command, Trial } from "../protocol/messages";
import { Presented } from "../wire/rhexis_generated";
import { byId, make, setText } from "./dom";

interface Choice {
  readonly button: HTMLButtonElement;
  readonly presented: Presented;
}

/** An experiment: which of three plates the hand feels, and the answer. */
export class TrialPanel {
  private readonly card = byId("experiment", HTMLElement);
  private readonly trial = byId("trial", HTMLParagraphElement);
  private readonly question = byId("trial-question", HTMLParagraphElement);
  private readonly hint = byId("trial-hint", HTMLParagraphElement);
  private readonly feels = byId("feel", HTMLDivElement);
  private readonly answers = byId("answer", HTMLDivElement);
  private readonly feeling: readonly Choice[] = [
    this.add(this.feels, "feel-sample", "Sample", "1", Presented.sample, () => this.feel(Presented.sample)),
    this.add(this.feels, "feel-a", "A", "2", Presented.a, () => this.feel(Presented.a)),
    this.add(this.feels, "feel-b", "B", "3", Presented.b, () => this.feel(Presented.b)),
  ];
  private readonly answering: readonly Choice[] = [
    this.add(this.answers, "answer-a", "A is like it", "A", Presented.a, () => this.answer(Presented.a)),
    this.add(this.answers, "answer-b", "B is like it", "B", Presented.b, () => this.answer(Presented.b)),
  ];

  /** `trial`: the newest, which a key that follows on another has to go by. */
  constructor(
    private readonly send: (command: Command) => void,
    private readonly current: () => Trial | null,
  ) {}

  /** `mayAct`: connected, and this page has the hand. */
  show(mayAct: boolean): void {
    const trial = this.current();
    this.card.hidden = trial === null;
    if (trial === null) return;
    document.body.dataset["experiment"] = trial.showsForce ? "shown" : "felt";
    setText(this.trial, trial.finished ? "Done" : `Trial ${trial.number}`);
    this.feels.hidden = this.answers.hidden = this.question.hidden = trial.finished;
    for (const { button, presented } of this.feeling) {
      button.disabled = !mayAct;
      button.classList.toggle("on", presented === trial.presented);
      button.classList.toggle("felt", trial.felt[presented]);
      button.setAttribute("aria-pressed", String(presented === trial.presented));
    }
    for (const { button } of this.answering) button.disabled = !mayAct || !isAllFelt(trial);
    setText(this.hint, hintFor(trial));
  }

  feel(presented: Presented): void {
    if (this.isOpen()) this.send({ kind: "feel", presented });
  }

  answer(same: Presented): void {
    const trial = this.current();
    if (trial !== null && this.isOpen() && isAllFelt(trial)) this.send({ kind: "answer", same });
  }

  private isOpen(): boolean {
    return this.current()?.finished === false;
  }

  private add(bar: HTMLElement, id: string, text: string, key: string, presented: Presented, act: () => void): Choice {
    const button = make("button", { type: "button", id }, make("span", { textContent: text }), make("kbd", { textContent: key, ariaHidden: "true" }));
    button.setAttribute("aria-keyshortcuts", key);
    button.addEventListener("click", act);
    bar.append(button);
    return { button, presented };
  }
}

const isAllFelt = (trial: Trial): boolean => Object.values(trial.felt).every(Boolean);

function hintFor(trial: Trial): string {
  if (trial.finished) return `That was the last trial. Thank you. The answers are in ${trial.file}`;
  const runs = `${trial.runsDone} of ${trial.runs} runs done.`;
  if (isAllFelt(trial)) return `${runs} Feel them as often as you like, then answer`;
  return `${runs} Take hold of the plate anywhere and pull along the arrow: the sample, A and B, one after the other`;
}
