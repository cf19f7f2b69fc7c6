import { execFileSync } from "node:child_process";
import { writeFileSync } from "node:fs";
import { join } from "node:path";

import type { Browser, Page } from "playwright-core";
import { afterAll, afterEach, beforeAll, describe, expect, it } from "vitest";

import { forceText } from "../../src/base/format";
import { length } from "../../src/base/vec3";
import { Field } from "../../src/wire/rhexis_generated";
import { kRepository, launch, open, pixelOf, shoot, textOf, until, type Look } from "../support/browser";
import { aim, enterHeadset, leaveHeadset, openWithHeadset, trigger } from "../support/headset";
import { Listener } from "../support/listener";
import { Program, freePort, kCommand, kScratch } from "../support/program";

/** The page and the program together: what a person does with `make play`. */
let browser: Browser;
let program: Program;
let page: Page;
let errors: string[] = [];
let recording = "";
const listeners: Listener[] = [];
const kPlate = "scenes/plate-tear.toml";
/** Where the plate's script takes hold: left of the crack. */
const kBeside = [0.1, 0.0, 0.01] as const;

beforeAll(async () => {
  browser = await launch();
  program = await Program.start(["play", kPlate], await freePort());
  await visit();
});
afterAll(async () => {
  await browser.close();
  await program.kill();
});
// A test that fails leaves nothing held, and nobody watching, to the next.
afterEach(async () => {
  for (const listener of listeners.splice(0)) listener.close();
  if (!page.isClosed()) await page.mouse.up();
  expect(errors.splice(0)).toEqual([]);
});

async function visit(look: Look = {}): Promise<void> {
  await page?.close();
  ({ page, errors } = await open(browser, program.url, look));
  await takeHand();
}

/** A page that comes before the last one is seen to be gone has to ask. */
async function takeHand(): Promise<void> {
  await until(page, (handle) => handle.role !== null);
  if (await page.evaluate(() => !window.rhexis?.role?.hand)) await page.click("#hand-button");
  await until(page, (handle) => handle.role?.hand === true);
}

async function reset(): Promise<void> {
  const epoch = await page.evaluate(() => window.rhexis?.body?.epoch ?? 0);
  await page.keyboard.press("r");
  await page.waitForFunction((before) => window.rhexis?.state != null && window.rhexis.state.epoch > before, epoch);
}

/**
 * Takes the plate beside its crack and pulls it to the left until it has torn `advances` times. The button stays down.
 * However slow the machine is, the hand goes no further than the body has followed it.
 */
async function tear(advances: number): Promise<void> {
  const [x, y] = await pixelOf(page, kBeside);
  await page.mouse.move(x + 2, y - 3);
  await page.mouse.down();
  await until(page, (handle) => handle.state?.held === true);
  const before = await page.evaluate(() => window.rhexis?.advances ?? 0);
  for (let k = 1; k <= 80; ++k) {
    const tick = await page.evaluate(() => window.rhexis?.state?.tick ?? 0);
    await page.mouse.move(x - 4 * k, y - 3);
    await page.waitForFunction((before) => (window.rhexis?.state?.tick ?? 0) > before + 20, tick);
    if ((await page.evaluate(() => window.rhexis?.advances ?? 0)) >= before + advances) return;
  }
  throw new Error(`the plate did not tear ${advances} times`);
}

describe("rhexis play", () => {
  it("shows the plate of the scene, and hands over the hand", async () => {
    expect(await page.evaluate(() => window.rhexis?.body?.nodes)).toBeGreaterThan(400);
    expect(await textOf(page, "#title")).toBe("Plate, torn from the middle of an edge");
    expect(await textOf(page, "#hand-state")).toContain("You have the hand");
    expect(await page.evaluate(() => window.rhexis?.body?.held.length)).toBeGreaterThan(10);
    await shoot(page, "play-start-light");
  });

  it("tears under the pointer, counts the advances, and shows the session's force to the last digit", async () => {
    const listener = new Listener(program.port);
    listeners.push(listener);
    await listener.ready();
    await tear(2);
    await until(page, (handle) => document.querySelector("#advance-count")?.textContent === String(handle.advances));
    await until(page, (handle) => handle.state?.advances === handle.advances);
    await shoot(page, "play-torn-light");
    let compared = 0;
    let largest = 0;
    for (let k = 0; k < 600 && compared < 12; ++k) {
      const shown = await page.evaluate(() => {
        const force = document.querySelector<HTMLElement>("#force");
        return { text: force?.textContent ?? "", tick: Number(force?.dataset["tick"]) };
      });
      await page.waitForTimeout(40);
      const state = listener.states.get(shown.tick); // a State may have been dropped for either of the two
      if (state === undefined) continue;
      expect(shown.text).toBe(forceText(length(state.force)));
      largest = Math.max(largest, length(state.force));
      compared += 1;
    }
    expect(compared).toBe(12);
    expect(largest).toBeGreaterThan(0.01);
    await page.mouse.up();
    await until(page, (handle) => handle.state?.held === false);
    // What is let go of tears no further: from here on both have to count the same.
    const advances = (): Promise<number> => page.evaluate(() => window.rhexis?.advances ?? 0);
    await expect.poll(async () => (await advances()) - listener.advances).toBe(0);
  });

  it("takes a tear back, and resets", async () => {
    const before = await page.evaluate(() => window.rhexis?.advances ?? 0);
    await page.click("#do-undo");
    await page.waitForFunction((advances) => (window.rhexis?.advances ?? advances) < advances, before);
    await reset();
    expect(await page.evaluate(() => window.rhexis?.state?.held)).toBe(false);
    await expect.poll(() => textOf(page, "#force")).toBe("0.000");
    // The crack that the scene begins with is all that is left.
    await until(page, (handle) => handle.advances === 1 && handle.state?.advances === 1);
  });

  it("pauses and steps", async () => {
    await page.keyboard.press("p");
    await until(page, (handle) => handle.state?.paused === true);
    await page.waitForSelector("#do-step:enabled");
    await page.keyboard.press("s");
    await page.keyboard.press("p");
    await until(page, (handle) => handle.state?.paused === false);
  });

  it("records, while Space runs the script, and hands the recording out", async () => {
    await reset();
    const started = await page.evaluate(() => window.rhexis?.advances ?? 0);
    await page.click("#do-record");
    await until(page, (handle) => handle.state?.recording === true);
    await page.focus("#picture");
    await page.keyboard.press("Space");
    await page.waitForFunction((before) => (window.rhexis?.advances ?? 0) >= before + 2, started);
    await shoot(page, "play-script-light");
    await page.keyboard.press("Space");
    await page.click("#do-record");
    const link = page.locator("#recordings a").first();
    await link.waitFor();
    const address = await link.evaluate((a) => (a as HTMLAnchorElement).href);
    const answer = await fetch(address);
    expect(answer.status).toBe(200);
    const content = Buffer.from(await answer.arrayBuffer());
    expect(content.subarray(1, 4).toString()).toBe("HDF"); // it is an HDF5 file, whole
    recording = join(kScratch, "downloaded.h5");
    writeFileSync(recording, content);
  });

  it("shows every field with its legend, in the dark too", async () => {
    await visit({ dark: true });
    await reset();
    await tear(1);
    for (const field of [Field.displacement, Field.von_mises, Field.principal_max, Field.mean_stress]) {
      await page.selectOption("#field", String(field));
      await page.waitForFunction((wanted) => window.rhexis?.state?.field === wanted, field);
      await page.waitForSelector("#legend:visible");
    }
    await page.selectOption("#field", String(Field.principal_max));
    await page.waitForFunction(() => /Maximum principal stress, k?Pa|MPa/.test(document.querySelector("#legend")?.textContent ?? ""));
    await shoot(page, "play-stress-dark");
    await page.mouse.up();
    await page.selectOption("#field", "0");
  });

  it("opens another scene, and takes another value", async () => {
    const scenes = await page.evaluate(() => window.rhexis?.hello?.scenes ?? []);
    const bar = scenes.find((scene) => scene.includes("bar-tear"));
    if (bar === undefined) throw new Error(`no bar among ${scenes.join(", ")}`);
    await page.selectOption("#scene", bar);
    await page.click("#open-scene");
    await until(page, (handle) => handle.body?.title === "Bar, torn across from a notch" && handle.state !== null);
    await shoot(page, "play-bar-dark");
    await page.click("#parameters summary");
    const young = page.locator('[id="value-material.young"]');
    await young.fill("2e6");
    await young.press("Enter");
    await until(page, (handle) => JSON.parse(handle.body?.values ?? "{}")["material.young"] == 2e6 && handle.state !== null);
    await page.evaluate(() => document.querySelector("#parameters")?.scrollIntoView());
    await shoot(page, "play-parameters-dark");
    await expect.poll(() => young.inputValue()).toMatch(/^(2e6|2000000(\.0)?)$/);
  });

  it("gives the hand to another page that asked for it", async () => {
    const second = await open(browser, program.url);
    await second.page.waitForSelector('[data-trouble="hand"]');
    await second.page.waitForSelector("#do-reset:disabled");
    await second.page.click("#hand-button");
    await expect.poll(() => textOf(second.page, "#messages")).toContain("it is yours when it is given back");
    await page.click("#hand-button");
    await until(second.page, (handle) => handle.role?.hand === true);
    await page.waitForSelector('[data-trouble="hand"]');
    await second.page.close(); // and the hand is free again
    await until(page, (handle) => handle.role?.clients === 1);
    await page.click("#hand-button");
    await until(page, (handle) => handle.role?.hand === true);
  });

  it("loses the program, says so, and finds it again when it runs again", async () => {
    await program.kill();
    await page.waitForSelector('[data-trouble="link"]');
    program = await Program.start(["play", kPlate], program.port);
    await until(page, (handle) => handle.link === "open" && handle.state !== null && handle.body?.title.startsWith("Plate") === true);
    await expect.poll(() => textOf(page, "#messages")).toContain("Connected again");
    await tear(1);
    await page.mouse.up();
  });

  it("is held by the controller of an emulated headset", async () => {
    await page.close();
    ({ page, errors } = await openWithHeadset(browser, program.url));
    await takeHand();
    await reset();
    await enterHeadset(page);
    const before = await page.evaluate(() => window.rhexis?.advances ?? 0);
    await aim(page, [0.09, 0.02, 0.01], [0, 0, 0]);
    await trigger(page, true);
    await until(page, (handle) => handle.state?.held === true);
    for (let k = 1; k <= 12; ++k) await aim(page, [0.09, 0.02, 0.01], [-0.02 * k, 0, 0]);
    await page.waitForFunction((advances) => (window.rhexis?.advances ?? 0) > advances, before);
    await trigger(page, false);
    await until(page, (handle) => handle.state?.held === false);
    await leaveHeadset(page);
  });

  it("ends when it is asked to", async () => {
    await page.close();
    expect(await program.stop()).toBe(0);
  });
});

describe("rhexis replay", () => {
  it("plays what was recorded, and can be scrubbed", async () => {
    program = await Program.start(["replay", recording], await freePort());
    ({ page, errors } = await open(browser, program.url));
    await page.waitForSelector("#timeline:visible");
    expect(await page.isVisible("#transport")).toBe(false);
    await until(page, (handle) => (handle.timeline?.marks.length ?? 0) >= 2);
    const seek = async (key: string): Promise<void> => {
      await page.focus("#replay-time");
      await page.keyboard.press(key);
    };
    await seek("End");
    await until(page, (handle) => handle.advances >= 2);
    const torn = await page.evaluate(() => window.rhexis?.surface.topology ?? 0);
    await seek("Home");
    await page.waitForFunction((topology) => (window.rhexis?.surface.topology ?? topology) < topology, torn);
    await page.selectOption("#replay-speed", "5");
    if ((await textOf(page, "#replay-play")) === "Play") await page.click("#replay-play");
    await page.waitForFunction((topology) => window.rhexis?.surface.topology === topology, torn);
    await shoot(page, "replay-light");
  });
});

describe("rhexis play with a record", () => {
  const kRecorded = "scenes/plate-recorded.toml";
  const percentShown = async (): Promise<number> => parseFloat((await textOf(page, "#force-legend .difference")).replace("Difference", ""));

  it("shows the exact force beside the recorded one, and says where the record ends", async () => {
    await page.close();
    await program.kill();
    const record = join(kScratch, "plate-record.h5");
    execFileSync(kCommand, ["precompute", kRecorded, "--quiet", "--out", record], { cwd: kRepository, stdio: "ignore" });
    program = await Program.start(["play", kRecorded, "--set", `interaction.record=${record}`], await freePort());
    await visit();
    await until(page, (handle) => handle.body?.response === "recorded" && handle.state?.record?.topology === 0);
    expect(await textOf(page, "#compare-row")).toContain("Exact force beside it");
    expect(await page.isVisible("#force-legend")).toBe(false);
    await page.click("#compare");
    await until(page, (handle) => handle.state?.comparedForce != null);
    await page.waitForSelector("#force-legend:visible");
    expect(await page.isChecked("#compare")).toBe(true);
    expect(await textOf(page, "#force-legend .own")).toMatch(/^Recorded [\d.]+ N$/);
    expect(await textOf(page, "#force-legend .other")).toMatch(/^Exact [\d.]+ N$/);

    // Before it tears the two are one: the record has that body.
    const [x, y] = await pixelOf(page, kBeside);
    await page.mouse.move(x + 2, y - 3);
    await page.mouse.down();
    await until(page, (handle) => handle.state?.held === true);
    await page.mouse.move(x - 2, y - 3, { steps: 4 });
    await until(page, (handle) => Math.hypot(...(handle.state?.bodyForce ?? [0])) > 0.1);
    await expect.poll(percentShown).toBeCloseTo(0, 2);
    expect(await page.evaluate(() => window.rhexis?.state?.advances)).toBe(1);
    await page.mouse.up();
    await until(page, (handle) => handle.state?.held === false);

    await tear(3);
    await expect.poll(percentShown).toBeGreaterThan(0.01);
    await page.waitForSelector('[data-trouble="record"]');
    await expect.poll(() => textOf(page, "#messages")).toContain("more often than the record knows");
    await shoot(page, "play-recorded-light");
    await page.mouse.up();
    await page.click("#compare");
    await until(page, (handle) => handle.state !== null && handle.state.comparedForce === null);
    await page.waitForSelector("#force-legend", { state: "hidden" });
  });

  it("has nothing to compare in a scene without a record", async () => {
    await page.selectOption("#scene", kPlate);
    await page.click("#open-scene");
    await until(page, (handle) => handle.body?.response === "exact" && handle.state !== null);
    await page.waitForSelector("#compare-row", { state: "hidden" });
  });
});
