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
/** Debian's, unless another is named. */
export const kChromium = process.env["CHROMIUM"] ?? "/usr/bin/chromium";
/** ms that a page has to come to what a test waits for: long, since it draws without a graphics card on a busy machine. */
const kPatience = 60_000;

/** Chromium, drawing without a graphics card and asking nobody outside of this machine for anything. */
export function launch(): Promise<Browser> {
  return chromium.launch({
    executablePath: kChromium,
    args: [
      "--no-sandbox", // as root, as CI often is, Chromium starts no other way
      "--disable-dev-shm-usage", // 64 MiB in a container: too little for a picture
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
  page.setDefaultTimeout(kPatience);
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
  await pictures(page, 1);
  return { page, errors };
}

/** Waits until what `read` makes of the page's knowledge is true. */
export async function until(page: Page, read: (handle: DebugHandle) => boolean): Promise<void> {
  // As a function, which the page's policy lets a debugger bring in; a text would have to be evaluated by the page itself.
  const isSo = new Function(`return (${read.toString()})(window.rhexis)`) as () => boolean;
  await page.waitForFunction(isSo);
}

/** Waits until `count` more pictures have been drawn from beginning to end. */
export async function pictures(page: Page, count: number): Promise<void> {
  const before = await page.evaluate(() => window.rhexis?.pictures ?? 0);
  await page.waitForFunction((wanted) => (window.rhexis?.pictures ?? 0) >= wanted, before + count);
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
