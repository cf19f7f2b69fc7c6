import { bytes, clock } from "../base/format";
import type { Recorded } from "../protocol/messages";
import type { Event } from "../session/store";
import type { Trouble } from "../session/troubles";
import { Level } from "../wire/rhexis_generated";
import { byId, make, setText } from "./dom";

const kKept = 60; // messages
const kLevelName: Readonly<Record<Level, string>> = { [Level.info]: "info", [Level.warning]: "warning", [Level.error]: "error" };

/** In words: what has happened, as a list; what is wrong while it lasts, over the picture. */
export class Messages {
  private readonly log = byId("messages", HTMLOListElement);
  private readonly banner = byId("troubles", HTMLDivElement);
  private readonly spoken = byId("spoken", HTMLDivElement);
  private readonly recordings = byId("recordings", HTMLUListElement);
  private readonly shown = new Map<string, HTMLElement>();
  private last = "";

  tell(event: Event): void {
    const line = make("li", { className: kLevelName[event.level] });
    const time = make("time", { textContent: new Date().toLocaleTimeString([], { hour12: false }) });
    const times = this.log.firstElementChild?.querySelector(".times");
    if (this.last === event.text && times) {
      // Said again: counted, not listed again.
      setText(times, `×${Number((times.textContent ?? "").slice(1) || 1) + 1}`);
      return;
    }
    this.last = event.text;
    line.append(time, make("span", { textContent: event.text }), make("span", { className: "times" }));
    this.log.prepend(line);
    while (this.log.children.length > kKept) this.log.lastElementChild?.remove();
  }

  /** To be read out, and not to be listed. */
  say(text: string): void {
    setText(this.spoken, text);
  }

  /** Elements stay while their trouble lasts, so that a screen reader hears of each once. */
  showTroubles(troubles: readonly Trouble[]): void {
    const ids = new Set(troubles.map((trouble) => trouble.id));
    for (const [id, element] of this.shown) {
      if (ids.has(id)) continue;
      element.remove();
      this.shown.delete(id);
    }
    for (const trouble of troubles) {
      let element = this.shown.get(trouble.id);
      if (element === undefined) {
        element = make("p", {}, make("span"), make("span", { ariaHidden: "true" }));
        element.dataset["trouble"] = trouble.id;
        this.shown.set(trouble.id, element);
        this.banner.append(element);
      }
      element.className = `trouble ${kLevelName[trouble.level]}`;
      const [text, detail] = element.children;
      if (text !== undefined) setText(text, trouble.text);
      if (detail !== undefined) setText(detail, trouble.detail === "" ? "" : ` ${trouble.detail}`);
    }
  }

  showRecordings(recordings: readonly Recorded[]): void {
    this.recordings.replaceChildren(
      ...recordings.map((recorded) => {
        const name = recorded.file.slice(recorded.file.lastIndexOf("/") + 1);
        const link = make("a", { href: `recordings/${encodeURIComponent(name)}`, download: name, textContent: name });
        return make("li", {}, link, ` ${clock(recorded.seconds)}, ${bytes(recorded.bytes)}`);
      }),
    );
  }
}
