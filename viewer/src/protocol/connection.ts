/**
 * How the page stays connected, without a socket in it: what happens goes in, what is to be done comes out. A program
 * that is started again is found again; a page that nobody looks at does not knock forever at a high rate.
 */

/** s, to wait before each further attempt; the last goes on. */
const kBackOff = [0.5, 1, 2, 4, 8] as const;
/** s without any frame, Pong included, after which a connection that looks open is dead. */
export const kSilence = 6;
/** s between two Pings. */
export const kPingEvery = 2;

export type Link =
  | { readonly kind: "connecting"; readonly attempt: number; readonly wasOpen: boolean }
  | { readonly kind: "open" }
  | { readonly kind: "waiting"; readonly attempt: number; readonly seconds: number; readonly wasOpen: boolean; readonly why: string };

export type LinkEvent =
  | { readonly kind: "opened" }
  | { readonly kind: "closed"; readonly why: string }
  | { readonly kind: "waited" }
  | { readonly kind: "try now" };

/** What the socket's keeper does next: `connect` opens one, `wait` sets a timer of `Link.seconds`. */
export type LinkAction = "connect" | "wait" | "nothing";

export const kFirstLink: Link = { kind: "connecting", attempt: 0, wasOpen: false };

export function follow(link: Link, event: LinkEvent): readonly [Link, LinkAction] {
  switch (event.kind) {
    case "opened":
      return [{ kind: "open" }, "nothing"];
    case "closed": {
      if (link.kind === "waiting") return [link, "nothing"];
      const attempt = link.kind === "open" ? 0 : link.attempt + 1;
      const seconds = kBackOff[Math.min(attempt, kBackOff.length - 1)] ?? 8;
      const wasOpen = link.kind === "open" || link.wasOpen;
      return [{ kind: "waiting", attempt, seconds, wasOpen, why: event.why }, "wait"];
    }
    case "waited":
    case "try now":
      if (link.kind !== "waiting") return [link, "nothing"];
      return [{ kind: "connecting", attempt: link.attempt, wasOpen: link.wasOpen }, "connect"];
  }
}

/** In words; empty where all is well. */
export function describe(link: Link): string {
  if (link.kind === "open") return "";
  if (link.kind === "connecting") return link.wasOpen ? "Connection lost. Connecting again …" : "Connecting …";
  const what = link.wasOpen ? "Connection lost" : "No connection";
  const why = link.why === "" ? "" : `: ${link.why}`;
  const advice = link.wasOpen
    ? "Is the program still running?"
    : "Is the program running, and is this the address that it printed?";
  return `${what}${why}. ${advice}`;
}

/** `left`: s until the next attempt. */
export const describeWait = (link: Link, left: number): string =>
  link.kind === "waiting" ? `Next attempt in ${Math.max(0, Math.ceil(left))} s.` : "";

/** Of the WebSocket that belongs to a page at `location`, which hands on the token that it was opened with. */
export function liveAddress(location: { readonly href: string }): string {
  const page = new URL(location.href);
  const live = new URL("live", page);
  live.protocol = page.protocol === "https:" ? "wss:" : "ws:";
  const token = page.searchParams.get("token");
  live.search = token === null ? "" : new URLSearchParams({ token }).toString();
  return live.href;
}
