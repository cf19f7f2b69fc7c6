import { counted } from "../base/format";
import type { Link } from "../protocol/connection";
import type { Command, Hello, Role } from "../protocol/messages";
import { byId, setText } from "./dom";

/** At the top: whether the page is connected, who has the hand. */
export class StatusBar {
  private readonly link = byId("link-state", HTMLSpanElement);
  private readonly retry = byId("retry-button", HTMLButtonElement);
  private readonly hand = byId("hand-state", HTMLSpanElement);
  private readonly button = byId("hand-button", HTMLButtonElement);
  private role: Role | null = null;

  constructor(send: (command: Command) => void, tryNow: () => void) {
    this.retry.addEventListener("click", tryNow);
    this.button.addEventListener("click", () => send({ kind: this.role?.hand ? "giveHand" : "takeHand" }));
  }

  showLink(link: Link): void {
    const words: Readonly<Record<Link["kind"], string>> = { open: "Connected", connecting: "Connecting", waiting: "Not connected" };
    this.link.dataset["state"] = link.kind;
    setText(this.link, words[link.kind]);
    this.retry.hidden = link.kind !== "waiting";
  }

  showRole(role: Role | null, hello: Hello | null): void {
    this.role = role;
    this.hand.hidden = this.button.hidden = role === null;
    if (role === null) return;
    const viewers = counted(role.clients, "viewer");
    const what = hello?.replay ? "the controls" : "the hand";
    const who = role.hand ? `You have ${what}` : role.handTaken ? `Another page has ${what}` : `Nobody has ${what}`;
    setText(this.hand, `${who} · ${viewers}`);
    setText(this.button, role.hand ? "Give it" : role.handTaken ? "Ask for it" : "Take it");
    this.button.title = role.hand ? "Another page that asked for it gets it" : "";
    // Alone there is nobody to give it to.
    this.button.hidden = role.hand && role.clients < 2;
  }
}
