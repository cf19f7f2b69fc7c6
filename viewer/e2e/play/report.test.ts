import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

import type { Browser, Page } from "playwright-core";
import { afterAll, beforeAll, describe, expect, it } from "vitest";

import { kRepository, launch, shoot } from "../support/browser";

const kCommand = process.env["RHEXIS_COMMAND"] ?? join(kRepository, "build/release/bin/rhexis");

describe.skipIf(!existsSync(kCommand))("a study's report", () => {
  const folder = mkdtempSync(join(tmpdir(), "rhexis-report-"));
  let browser: Browser;
  const asked: string[] = [];
  const errors: string[] = [];

  beforeAll(async () => {
    execFileSync(kCommand, ["--quiet", "study", "identification", "--nodes", "120", "--shared", "none", "--out", folder]);
    browser = await launch();
  });
  afterAll(async () => {
    await browser.close();
    rmSync(folder, { recursive: true });
  });

  async function open(look: { dark?: boolean } = {}): Promise<Page> {
    const page = await browser.newPage({ viewport: { width: 1100, height: 900 }, colorScheme: look.dark ? "dark" : "light" });
    page.on("request", (request) => asked.push(request.url()));
    page.on("pageerror", (error) => errors.push(String(error)));
    page.on("console", (message) => (message.type() === "error" ? errors.push(message.text()) : undefined));
    await page.goto(`file://${join(folder, "report.html")}`);
    await page.waitForFunction(() => document.querySelector("figure.shapes.live canvas") !== null);
    return page;
  }
  const pictureOf = (page: Page): Promise<string> =>
    page.evaluate(() => new Promise<string>((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(document.querySelector("canvas")?.toDataURL() ?? "")))));

  it.each([false, true])("shows its shapes, dark: %s", async (dark) => {
    const page = await open({ dark });
    await page.locator("canvas").first().scrollIntoViewIfNeeded();
    const before = await pictureOf(page);
    expect(before.length).toBeGreaterThan(2000); // an empty picture packs to a few hundred
    const box = (await page.locator("canvas").first().boundingBox())!;
    await page.mouse.move(box.x + 80, box.y + 100);
    await page.mouse.down();
    await page.mouse.move(box.x + 160, box.y + 120, { steps: 4 });
    await page.mouse.up();
    expect(await pictureOf(page)).not.toBe(before);
    await shoot(page, `report-${dark ? "dark" : "light"}`, true);
    await page.close();
  });

  it("prints with the pictures that stand still", async () => {
    const page = await open();
    await page.emulateMedia({ media: "print" });
    expect(await page.locator("figure.shapes .still").first().isVisible()).toBe(true);
    expect(await page.locator("figure.shapes .turned").first().isVisible()).toBe(false);
    await page.close();
  });

  it("asks nobody for anything, and has no errors", () => {
    expect(asked.filter((url) => !url.startsWith("file://") && !url.startsWith("data:") && !url.startsWith("blob:"))).toEqual([]);
    expect(errors).toEqual([]);
  });
});
