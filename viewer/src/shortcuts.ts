import { byId } from "./panel/dom";

/** What single keys do, wherever the focus is, unless it is where one types or presses. */
export class Shortcuts {
  private readonly enabled = byId("single-keys", HTMLInputElement);

  constructor(private readonly actions: Readonly<Record<string, () => void>>) {
    addEventListener("keydown", (event) => this.press(event));
  }

  private press(event: KeyboardEvent): void {
    if (event.defaultPrevented || event.repeat || event.ctrlKey || event.metaKey || event.altKey) return;
    const key = event.key.toLowerCase();
    const action = this.actions[key];
    if (action === undefined || isBusy(event.target, key)) return;
    // Someone who speaks to the machine may turn these off; on the body itself they go on.
    const isOnBody = event.target instanceof HTMLCanvasElement;
    if (!this.enabled.checked && !isOnBody) return;
    event.preventDefault();
    action();
  }
}

/** The element itself wants this key. */
function isBusy(target: EventTarget | null, key: string): boolean {
  if (!(target instanceof HTMLElement)) return false;
  if (target.closest("dialog[open]") !== null) return true;
  if (target instanceof HTMLInputElement) return !["checkbox", "range"].includes(target.type) || key === " ";
  if (target instanceof HTMLSelectElement || target instanceof HTMLTextAreaElement) return true;
  return key === " " && target.closest("button, a, summary") !== null;
}
