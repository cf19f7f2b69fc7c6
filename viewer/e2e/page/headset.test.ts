import type { Browser } from "playwright-core";
import { afterAll, beforeAll, expect, it } from "vitest";

import * as wire from "../../src/wire/rhexis_generated";
import { kPage, launch, shoot } from "../support/browser";
import { FakeProgram } from "../support/fake_program";
import { aim, enterHeadset, leaveHeadset, openWithHeadset, trigger } from "../support/headset";

let browser: Browser;
const program = new FakeProgram(kPage);
let port: number;

beforeAll(async () => {
  browser = await launch();
  port = await program.start();
});
afterAll(async () => {
  await browser.close();
  await program.stop();
});

it("A controller of a headset holds what it points at and pulls it until it tears", async () => {
  const { page, errors } = await openWithHeadset(browser, `http://127.0.0.1:${port}/`);
  await enterHeadset(page);
  await aim(page, [0.09, 0.03, 0.01], [0, 0, 0]);
  await trigger(page, true);
  await page.waitForFunction(() => window.rhexis?.state?.held === true);
  await aim(page, [0.09, 0.03, 0.01], [-0.25, 0, 0.05]);
  await page.waitForFunction(() => (window.rhexis?.advances ?? 0) >= 2);
  await shoot(page, "page-headset");
  await trigger(page, false);
  await page.waitForFunction(() => window.rhexis?.state?.held === false);
  expect(program.heard[0]).toBe(wire.Payload.Grasp);
  expect(program.heard[program.heard.length - 1]).toBe(wire.Payload.LetGo);
  await leaveHeadset(page);
  expect(errors).toEqual([]);
  await page.close();
});
