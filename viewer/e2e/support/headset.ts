import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join } from "node:path";

import type { Browser, Page } from "playwright-core";

import { open, pictures } from "./browser";

/** What of the emulated device the tests move. */
interface EmulatedDevice {
  readonly controllers: {
    readonly right?: {
      readonly position: { set(x: number, y: number, z: number): void };
      readonly quaternion: { set(x: number, y: number, z: number, w: number): void };
      updateButtonValue(name: string, value: number): void;
    };
  };
}
declare global {
  interface Window {
    emulatedHeadset?: EmulatedDevice;
  }
}

const kInstall = `
  window.emulatedHeadset = new IWER.XRDevice(IWER.metaQuest3);
  window.emulatedHeadset.installRuntime({ forceInstall: true }); // Chromium has a runtime, without a device
  window.emulatedHeadset.controllers.right.position.set(0.1, 1.2, -0.1);
`;

/** A page in a browser that believes to have a headset. */
export function openWithHeadset(browser: Browser, url: string): Promise<{ page: Page; errors: string[] }> {
  const entry = createRequire(import.meta.url).resolve("iwer"); // iwer/lib/index.js
  const source = readFileSync(join(dirname(entry), "../build/iwer.min.js"), "utf8");
  return open(browser, url, { before: source + kInstall });
}

export async function enterHeadset(page: Page): Promise<void> {
  await page.click("#headset-button");
  await page.waitForFunction(() => window.rhexis?.isInHeadset === true);
  // The controllers are there once the session has drawn.
  await pictures(page, 2);
}

export async function leaveHeadset(page: Page): Promise<void> {
  // The emulated headset lays its picture over the page, where a mouse would hit that.
  await page.evaluate(() => document.getElementById("headset-button")?.click());
  await page.waitForFunction(() => window.rhexis?.isInHeadset === false);
}

/** Points the right controller at a reference point of the scene from 0.35 m before it, then shifts it by `by` (m). */
export async function aim(page: Page, at: readonly [number, number, number], by: readonly [number, number, number]): Promise<void> {
  await page.evaluate(
    ([point, shift]) => {
      const controller = window.emulatedHeadset?.controllers.right;
      const there = window.aimedAt ?? window.rhexis?.placeOf(point);
      if (controller === undefined || there === undefined) throw new Error("no controller");
      window.aimedAt = there;
      // Straight along -z of the room: the controller's own axis, not turned.
      controller.position.set(there[0] + shift[0], there[1] + shift[1], there[2] + 0.35 + shift[2]);
      controller.quaternion.set(0, 0, 0, 1);
    },
    [at, by] as const,
  );
  // A trigger takes hold where the picture before it has seen the controller.
  await pictures(page, 2);
}

declare global {
  interface Window {
    /** m in the room: where the controller was first aimed at, which the body leaves while it is pulled. */
    aimedAt?: readonly [number, number, number];
  }
}

export async function trigger(page: Page, on: boolean): Promise<void> {
  await page.evaluate((value) => window.emulatedHeadset?.controllers.right?.updateButtonValue("trigger", value), on ? 1 : 0);
}
