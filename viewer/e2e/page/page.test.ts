import type { Browser, Page } from "playwright-core";
import { afterAll, afterEach, beforeAll, beforeEach, describe, expect, it } from "vitest";

import * as wire from "../../src/wire/rhexis_generated";
import { kPage, launch, open, pixelOf, shoot, textOf, until, type Look } from "../support/browser";
import { FakeProgram } from "../support/fake_program";

/** The page by itself, against a program that does what a test needs. */
let browser: Browser;
let program: FakeProgram;
let port: number;
const pages: { page: Page; errors: string[] }[] = [];

beforeAll(async () => {
  browser = await launch();
});
afterAll(async () => browser.close());
beforeEach(async () => {
  program = new FakeProgram(kPage);
  port = await program.start();
});
afterEach(async () => {
  const errors = pages.flatMap((opened) => opened.errors);
  for (const { page } of pages.splice(0)) await page.close();
  await program.stop();
  expect(errors).toEqual([]);
});

async function visit(look: Look = {}): Promise<Page> {
  const opened = await open(browser, `http://127.0.0.1:${port}/`, look);
  pages.push(opened);
  return opened.page;
}

/** Left of the crack, on the top face. */
const kBeside = [0.09, 0.03, 0.01] as const;

async function pullLeft(page: Page, pixels: number): Promise<void> {
  const [x, y] = await pixelOf(page, kBeside);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x - pixels, y, { steps: 12 });
}

describe("The page", () => {
  it("draws the body, lets it be pulled until it tears, and counts the advances", async () => {
    const page = await visit();
    await pullLeft(page, 220);
    await until(page, (handle) => handle.advances >= 2 && handle.state?.held === true);
    expect(program.heard[0]).toBe(wire.Payload.Grasp);
    await until(page, (handle) => document.querySelector("#advance-count")?.textContent === String(handle.advances));
    await shoot(page, "page-torn-light");
    await page.mouse.up();
    await until(page, (handle) => handle.state?.held === false);
    expect(program.heard[program.heard.length - 1]).toBe(wire.Payload.LetGo);
    await expect.poll(() => page.locator("#advances tbody tr").count()).toBeGreaterThanOrEqual(2);
  });

  it("turns, pans and zooms the view without touching the body", async () => {
    const page = await visit();
    const shiftFrom = async (from: readonly [number, number]): Promise<number> => {
      const [x, y] = await pixelOf(page, kBeside);
      return Math.hypot(x - from[0], y - from[1]);
    };
    const before = await pixelOf(page, kBeside);
    await page.mouse.move(60, 700);
    await page.mouse.down();
    await page.mouse.move(160, 660, { steps: 5 });
    await page.mouse.up();
    await expect.poll(() => shiftFrom(before)).toBeGreaterThan(5);
    const turned = await pixelOf(page, kBeside);
    await page.mouse.down({ button: "right" });
    await page.mouse.move(190, 660, { steps: 3 });
    await page.mouse.up({ button: "right" });
    await expect.poll(async () => (await pixelOf(page, kBeside))[0] - turned[0]).toBeGreaterThan(15);
    const panned = await pixelOf(page, kBeside);
    await page.mouse.wheel(0, -400);
    await expect.poll(() => shiftFrom(panned)).toBeGreaterThan(3);
    expect(program.heard).toEqual([]);
  });

  it("shows a field as colours with a legend and a unit", async () => {
    const page = await visit({ dark: true });
    expect(await page.isVisible("#legend")).toBe(false);
    await page.selectOption("#field", String(wire.Field.von_mises));
    await pullLeft(page, 120);
    await page.waitForSelector("#legend:visible");
    await until(page, (handle) => (handle.state?.advances ?? 0) > 0);
    await page.waitForFunction(() => /kPa/.test(document.querySelector("#legend")?.textContent ?? ""));
    await shoot(page, "page-field-dark");
    await page.mouse.up();
  });

  it("does what its keys say", async () => {
    const page = await visit();
    const pressed: (readonly [string, wire.Payload])[] = [
      [" ", wire.Payload.Script],
      ["p", wire.Payload.Pause],
      ["s", wire.Payload.Step],
      ["u", wire.Payload.Undo],
      ["r", wire.Payload.Reset],
    ];
    for (const [key, kind] of pressed) {
      await page.keyboard.press(key);
      await expect.poll(() => program.heard).toContain(kind);
      if (key === "p") await until(page, (handle) => handle.state?.paused === true);
    }
  });

  it("leaves the keys alone where one types, and where they are switched off", async () => {
    const page = await visit();
    await page.click("#parameters summary");
    await page.focus('[id="value-material.young"]');
    await page.keyboard.type("rp");
    await page.click("#help-button");
    await page.uncheck("#single-keys");
    await page.keyboard.press("Escape");
    await page.keyboard.press("r");
    await page.click("#do-pause");
    // Commands come in their order: nothing was sent before the button's.
    await expect.poll(() => program.heard).toContain(wire.Payload.Pause);
    expect(program.heard).toEqual([wire.Payload.Pause]);
  });

  it("holds and pulls by the keyboard alone", async () => {
    const page = await visit();
    for (let k = 0; k < 40; ++k) {
      await page.keyboard.press("Tab");
      if (await page.evaluate(() => document.activeElement?.id === "picture")) break;
    }
    await page.keyboard.press("ArrowUp");
    await page.keyboard.press("Enter");
    await until(page, (handle) => handle.state?.held === true);
    for (let k = 0; k < 8; ++k) await page.keyboard.press("ArrowLeft");
    await until(page, (handle) => Math.hypot(...(handle.state?.hand ?? [0])) > 0.02);
    await expect.poll(() => textOf(page, "#spoken")).toContain("Pulled");
    await shoot(page, "page-keyboard");
    await page.keyboard.press("Escape");
    await until(page, (handle) => handle.state?.held === false);
  });

  it("sends a value that is right and complains of one that is not", async () => {
    const page = await visit();
    await page.click("#parameters summary");
    const poisson = page.locator('[id="value-material.poisson"]');
    expect(await poisson.inputValue()).toBe("0.4");
    await poisson.fill("0.7");
    await poisson.press("Tab");
    await expect.poll(() => textOf(page, '[id="value-material.poisson-complaint"]')).toBe("it has to be −0.900 to 0.499");
    expect(program.heard).toEqual([]);
    await poisson.fill("0.45");
    await poisson.press("Tab");
    await expect.poll(() => program.said.find((said) => said instanceof wire.SetValueT)).toMatchObject({ key: "material.poisson", value: "0.45" });
    await shoot(page, "page-parameters");
  });

  it("opens another scene", async () => {
    const page = await visit();
    await page.selectOption("#scene", "scenes/bar-tear.toml");
    await page.click("#open-scene");
    await expect.poll(() => program.said[0]).toMatchObject({ file: "scenes/bar-tear.toml" });
  });

  it("offers a recording for download", async () => {
    const page = await visit();
    program.send(wire.Payload.Recorded, new wire.RecordedT("2026-01-02.h5", 1_300_000n, 9.5));
    const link = page.locator("#recordings a");
    await link.waitFor();
    expect(await link.evaluate((a) => (a as HTMLAnchorElement).href)).toBe(`http://127.0.0.1:${port}/recordings/2026-01-02.h5`);
  });

  it("says in words what is wrong", async () => {
    const page = await visit();
    program.change = (state) => {
      state.pieces = 2;
      state.rates = new wire.RatesT(5, 210, 998, 1800, 12n, 180, false);
    };
    await page.waitForSelector('[data-trouble="pieces"]');
    await expect.poll(() => textOf(page, '[data-trouble="late"]')).toBe("The physics is late: the force is that of the body 180 ms ago.");
    await shoot(page, "page-troubles");
    program.change = () => undefined;
    await page.waitForSelector('[data-trouble="late"]', { state: "detached" });
    program.setRole(new wire.RoleT(false, true, 2));
    await page.waitForSelector('[data-trouble="hand"]');
    await page.waitForSelector("#do-reset:disabled");
    await page.click("#hand-button");
    await expect.poll(() => program.heard).toContain(wire.Payload.TakeHand);
  });

  it("notices when the program lets go", async () => {
    const page = await visit();
    await pullLeft(page, 30);
    await until(page, (handle) => handle.state?.held === true);
    program.letGo();
    await page.waitForFunction(() => /The hand was let go/.test(document.querySelector("#messages")?.textContent ?? ""));
    await page.mouse.up();
  });

  it("loses the connection, says so, and finds it again by itself", async () => {
    const page = await visit();
    await program.stop();
    await page.waitForSelector('[data-trouble="link"]');
    expect(await textOf(page, '[data-trouble="link"]')).toContain("Connection lost");
    await page.waitForSelector("#do-reset:disabled");
    await page.waitForTimeout(700);
    await shoot(page, "page-connection-lost");
    program = new FakeProgram(kPage);
    await program.start(port);
    await until(page, (handle) => handle.link === "open" && handle.state !== null);
    await page.waitForSelector('[data-trouble="link"]', { state: "detached" });
    await expect.poll(() => textOf(page, "#messages")).toContain("Connected again");
    await page.waitForSelector("#do-reset:enabled");
  });

  it("plays a recording: its clock, its marks, and no hand", async () => {
    await program.stop();
    program = new FakeProgram(kPage);
    program.replay = true;
    port = await program.start();
    const page = await visit();
    expect(await page.isVisible("#timeline")).toBe(true);
    expect(await page.isVisible("#transport")).toBe(false);
    await expect.poll(() => page.locator("#timeline .marks i").count()).toBe(4);
    await page.focus("#replay-time");
    await page.keyboard.press("End");
    await expect.poll(() => program.said.find((said) => said instanceof wire.SeekT)).toMatchObject({ time: 12 });
    await page.selectOption("#replay-speed", "0.5");
    await expect.poll(() => program.said.find((said) => said instanceof wire.PlayT)).toMatchObject({ on: true, speed: 0.5 });
    await shoot(page, "page-replay");
  });

  it("fits a telephone, and its theme can be chosen", async () => {
    const page = await visit({ width: 390, height: 844, reducedMotion: true });
    expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBeLessThanOrEqual(390);
    await shoot(page, "page-narrow-light", true);
    await page.click("#theme-button");
    await page.click("#theme-button");
    expect(await page.evaluate(() => document.documentElement.dataset["theme"])).toBe("dark");
    await page.waitForTimeout(200);
    await shoot(page, "page-narrow-dark", true);
  });

  it("explains itself", async () => {
    const page = await visit({ dark: true });
    await page.click("#help-button");
    await shoot(page, "page-help");
    await page.click("#help form button");
    expect(await page.isVisible("#help")).toBe(false);
    await page.click("#help-button");
    await page.keyboard.press("Escape");
    expect(await page.isVisible("#help")).toBe(false);
  });

  it("names every control, for those who hear the page", async () => {
    const page = await visit();
    const unnamed = await page.evaluate(() =>
      [...document.querySelectorAll<HTMLElement>("button, input, select, a, canvas[tabindex]")]
        .filter((element) => element.checkVisibility())
        .filter((element) => {
          const labels = "labels" in element ? (element as HTMLInputElement).labels : null;
          return !(element.getAttribute("aria-label") ?? "") && !(element.textContent ?? "").trim() && (labels?.length ?? 0) === 0;
        })
        .map((element) => element.id || element.outerHTML),
    );
    expect(unnamed).toEqual([]);
  });
});
