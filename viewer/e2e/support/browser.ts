import { mkdirSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

import { chromium, type Browser, type Page } from "playwright-core";

import type { DebugHandle } from "../../src/debug";

const kRoot = join(dirname(fileURLToPath(import.meta.url)), "../../..");
/** The page as built by `npm run build`. */
export const kPage = process.env["RHEXIS_PAGE"] ?? join(kRoot, "build/release/share/rhexis/page");
/** Where screenshots are kept. */
export const kArtefacts = process.env["RHEXIS_ARTEFACTS"] ?? join(kRoot, "build/e2e");
export const kRepository = kRoot;

/** Debian's Chromium, drawing without a graphics card and asking nobody outside of this machine for anything. */
export function launch(): Promise<Browser> {
  return chromium.launch({
    executablePath: process.env["CHROMIUM"] ?? "/usr/bin/chromium",
    args: [
      "--no-sandbox", // as root, as CI often is, Chromium starts no other way
      "--use-angle=swiftshader",
      "--enable-unsafe-swiftshader",
      "--ignore-gpu-blocklist",
      "--disable-quic",
      "--no-first-run",
      "--disable-background-networking",
      "--disable-component-update",
      "--disable-sync",
    ],
  });
}

export interface Look {
  readonly width?: number;
  readonly height?: number;
  readonly dark?: boolean;
  readonly reducedMotion?: boolean;
  /** Runs in the page before its own scripts. */
  readonly before?: string;
}

/** A page at `url` that has a body and a state of it. `errors` collects what it throws or logs as an error. */
export async function open(browser: Browser, url: string, look: Look = {}): Promise<{ page: Page; errors: string[] }> {
  const page = await browser.newPage({
    viewport: { width: look.width ?? 1280, height: look.height ?? 800 },
    colorScheme: look.dark ? "dark" : "light",
    reducedMotion: look.reducedMotion ? "reduce" : "no-preference",
  });
  const errors: string[] = [];
  page.on("pageerror", (error) => errors.push(String(error)));
  page.on("console", (message) => {
    // That a server which is down cannot be reached is the browser's to say, and part of some tests.
    if (message.type() === "error" && !/WebSocket|ERR_CONNECTION/.test(message.text())) errors.push(message.text());
  });
  if (look.before !== undefined) await page.addInitScript(look.before);
  await page.goto(url);
  await page.waitForFunction(() => window.rhexis?.state != null);
  // One picture later the view fits the body, and points of it are where they are said to be.
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  return { page, errors };
}

/** Waits until what `read` makes of the page's knowledge is true. */
export async function until(page: Page, read: (handle: DebugHandle) => boolean, timeout = 30_000): Promise<void> {
  // As a function, which the page's policy lets a debugger bring in; a text would have to be evaluated by the page itself.
  const isSo = new Function(`return (${read.toString()})(window.rhexis)`) as () => boolean;
  await page.waitForFunction(isSo, undefined, { timeout });
}

export async function pixelOf(page: Page, point: readonly [number, number, number]): Promise<readonly [number, number]> {
  const pixel = await page.evaluate((at) => window.rhexis?.pixelOf(at) ?? null, point);
  if (pixel === null) throw new Error(`${point.join(", ")} is not in the picture`);
  return pixel;
}

export async function shoot(page: Page, name: string, fullPage = false): Promise<void> {
  mkdirSync(kArtefacts, { recursive: true });
  await page.screenshot({ path: join(kArtefacts, `${name}.png`), fullPage });
}

export const textOf = async (page: Page, selector: string): Promise<string> => (await page.textContent(selector))?.trim() ?? "";
