import { describe, expect, it } from "vitest";

import { describe as words, describeWait, follow, kFirstLink, liveAddress, type Link, type LinkEvent } from "../src/protocol/connection";

function run(events: readonly LinkEvent[], from: Link = kFirstLink): readonly [Link, string[]] {
  const actions: string[] = [];
  let link = from;
  for (const event of events) {
    const [next, action] = follow(link, event);
    link = next;
    actions.push(action);
  }
  return [link, actions];
}
const closed: LinkEvent = { kind: "closed", why: "" };

describe("A connection", () => {
  it("waits longer after each attempt that fails, up to a bound", () => {
    let link: Link = { kind: "open" };
    const waits: number[] = [];
    for (let k = 0; k < 7; ++k) {
      [link] = run([closed], link);
      if (link.kind === "waiting") waits.push(link.seconds);
      [link] = run([{ kind: "waited" }], link);
    }
    expect(waits).toEqual([0.5, 1, 2, 4, 8, 8, 8]);
  });

  it("starts over from a short wait once it was open", () => {
    const [link] = run([closed, { kind: "waited" }, closed, { kind: "waited" }, { kind: "opened" }, closed]);
    expect(link).toMatchObject({ kind: "waiting", attempt: 0, seconds: 0.5, wasOpen: true });
  });

  it("is tried at once when someone asks, and only while it waits", () => {
    const [waiting] = run([closed]);
    expect(follow(waiting, { kind: "try now" })[1]).toBe("connect");
    expect(follow({ kind: "open" }, { kind: "try now" })[1]).toBe("nothing");
    expect(follow(kFirstLink, { kind: "waited" })[1]).toBe("nothing");
  });

  it("does not wait twice for one loss", () => {
    const [, actions] = run([{ kind: "opened" }, closed, closed]);
    expect(actions).toEqual(["nothing", "wait", "nothing"]);
  });

  it("says in words how it is", () => {
    expect(words({ kind: "open" })).toBe("");
    const [lost] = run([{ kind: "opened" }, { kind: "closed", why: "nothing heard for 6 s" }]);
    expect(words(lost)).toBe("Connection lost: nothing heard for 6 s. Is the program still running?");
    expect(describeWait(lost, 0.4)).toBe("Next attempt in 1 s.");
    expect(describeWait({ kind: "open" }, 0)).toBe("");
    const [never] = run([closed]);
    expect(words(never)).toContain("No connection");
    expect(words({ kind: "connecting", attempt: 1, wasOpen: true })).toContain("Connecting again");
  });

  it("hands the token of the page on, and nothing else", () => {
    expect(liveAddress({ href: "http://127.0.0.1:8080/" })).toBe("ws://127.0.0.1:8080/live");
    expect(liveAddress({ href: "https://lab:1/?token=a%2Bb&x=1#top" })).toBe("wss://lab:1/live?token=a%2Bb");
    expect(liveAddress({ href: "http://lab/play/index.html" })).toBe("ws://lab/play/live");
  });
});
