import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";

import type { Browser, Page } from "playwright-core";
import { afterAll, beforeAll, describe, expect, it } from "vitest";

import { Presented } from "../../src/wire/rhexis_generated";
import { launch, open, pixelOf, shoot, textOf, until } from "../support/browser";
import { Program, freePort, kScratch } from "../support/program";

/** A person at the page, by keys alone: `rhexis study angle-perception --with person`. */
describe("an experiment", () => {
  const out = join(kScratch, "angle");
  const file = join(kScratch, "short.toml");
  let browser: Browser;
  let program: Program;
  let page: Page;
  let errors: string[] = [];

  beforeAll(async () => {
    writeFileSync(file, 'title = "Short"\nrepeats = 1\n[rule]\nsteps = 2\n[[point]]\nat = [0.10, 0.0, 0.005]\n[[direction]]\nalong = [-1.0, 0.0, 0.0]\n');
    browser = await launch();
    program = await Program.start(["study", "angle-perception", "--with", "person", "--experiment", file, "--out", out], await freePort());
    ({ page, errors } = await open(browser, program.url));
    await until(page, (handle) => handle.trial !== null && handle.role?.hand === true);
  });
  afterAll(async () => {
    await browser.close();
    await program.kill();
  });

  const lines = (): Record<string, unknown>[] =>
    readFileSync(join(out, "trials.jsonl"), "utf8").trim().split("\n").map((line) => JSON.parse(line) as Record<string, unknown>);

  /** One of the three, by keys: takes hold, pulls to the left, lets go. */
  async function feel(key: string, presented: Presented): Promise<number> {
    await page.keyboard.press(key);
    await page.waitForFunction((wanted) => window.rhexis?.trial?.presented === wanted, presented);
    await page.focus("#picture");
    await page.keyboard.press("Enter");
    await until(page, (handle) => handle.state?.held === true);
    for (let k = 0; k < 4; ++k) await page.keyboard.press("ArrowLeft");
    await until(page, (handle) => (handle.state?.hand[0] ?? 0) < -0.004 && Math.hypot(...(handle.state?.force ?? [0])) > 0.01);
    const hand = await page.evaluate(() => window.rhexis?.state?.hand ?? [1, 1, 1]);
    expect(Math.hypot(hand[1]!, hand[2]!)).toBeLessThan(1e-12); // along the experiment's direction alone
    const force = await page.evaluate(() => Math.hypot(...(window.rhexis?.state?.force ?? [0])) / Math.hypot(...(window.rhexis?.state?.hand ?? [1])));
    await page.keyboard.press("Escape");
    await until(page, (handle) => handle.state?.held === false);
    return force;
  }

  it("asks, and shows nothing but what belongs to it", async () => {
    expect(await textOf(page, "#trial")).toBe("Trial 1");
    expect(await page.isVisible("#transport")).toBe(false);
    expect(await page.isVisible("#scene-heading")).toBe(false);
    expect(await page.isDisabled("#answer-a")).toBe(true);
    await shoot(page, "experiment-light");
  });

  it("lets each plate be felt, takes an answer by key, and saves it at once", async () => {
    const stiffness = [await feel("1", Presented.sample), await feel("2", Presented.a), await feel("3", Presented.b)] as const;
    const isA = Math.abs(stiffness[1] - stiffness[0]) < Math.abs(stiffness[2] - stiffness[0]);
    expect(Math.abs(stiffness[1] - stiffness[2]) / stiffness[0]).toBeGreaterThan(0.005);
    await page.emulateMedia({ colorScheme: "dark" });
    await until(page, () => !document.querySelector<HTMLButtonElement>("#answer-a")?.disabled);
    await shoot(page, "experiment-dark");
    await page.emulateMedia({ colorScheme: "light" });
    await page.keyboard.press(isA ? "a" : "b");
    await until(page, (handle) => handle.trial?.number === 2);
    expect(lines().length).toBe(2);
    expect(lines()[1]).toMatchObject({ trial: 1, difference: 45, answer: isA ? "A" : "B", right: true });
  });

  it("follows the mouse too, ends after the last answer, and leaves its report", async () => {
    await feel("1", Presented.sample);
    await feel("2", Presented.a);
    await page.click("#feel-b");
    await until(page, (handle) => handle.trial?.presented === 2);
    const [x, y] = await pixelOf(page, [0.06, 0.12, 0.01]);
    await page.mouse.move(x, y);
    await page.mouse.down();
    await until(page, (handle) => handle.state?.held === true);
    await page.mouse.move(x - 40, y + 30, { steps: 4 });
    await until(page, (handle) => (handle.state?.hand[0] ?? 0) < -0.004);
    expect(await page.evaluate(() => window.rhexis?.state?.hand[1])).toBeCloseTo(0, 12);
    await shoot(page, "experiment-held");
    await page.mouse.up();
    await until(page, () => !document.querySelector<HTMLButtonElement>("#answer-b")?.disabled);
    await page.click("#answer-b");
    await until(page, (handle) => handle.trial?.finished === true);
    await expect.poll(() => textOf(page, "#trial")).toBe("Done");
    expect(await program.ended()).toBe(0);
    await shoot(page, "experiment-done");
    expect(await textOf(page, "#troubles")).toBe("");
    expect(lines().length).toBe(3);
    const about = JSON.parse(readFileSync(join(out, "study.json"), "utf8")) as { tables: string[] };
    expect(about.tables).toContain("angle-perception-trials");
    expect(errors).toEqual([]);
  });
});
