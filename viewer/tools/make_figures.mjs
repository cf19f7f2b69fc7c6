// Makes docs/figures/page.png and docs/figures/tear.png (animated) from the page: `npm run figures`, after `make viewer build`.
import { spawn } from "node:child_process";
import { mkdirSync, mkdtempSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

import { chromium } from "playwright-core";

const root = join(dirname(fileURLToPath(import.meta.url)), "../..");
const command = process.env.RHEXIS_COMMAND ?? join(root, "build/release/bin/rhexis");
const page_folder = join(root, "build/release/share/rhexis/page");
const figures = join(root, "docs/figures");
const port = 8471;
const kFrames = 24;
const kFrameTime = 100; // ms
const kLarge = { width: 1280, height: 800 };
const kSmall = { width: 900, height: 520 }; // of the animation, which a reader has to fetch whole

const program = spawn(
  command,
  ["play", "scenes/plate-tear.toml", "--port", String(port), "--page", page_folder, "--recordings", mkdtempSync(join(tmpdir(), "rhexis-")), "--no-browser"],
  { cwd: root, stdio: "inherit" },
);
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-background-networking"],
});
try {
  mkdirSync(figures, { recursive: true });
  const page = await browser.newPage({ viewport: kLarge });
  while (!(await fetch(`http://127.0.0.1:${port}/`).catch(() => null))) await new Promise((done) => setTimeout(done, 100));
  await page.goto(`http://127.0.0.1:${port}/`);
  await page.waitForFunction(() => window.rhexis?.state != null);
  // Paused and stepped, so that the animation runs evenly however slowly this machine draws.
  await page.keyboard.press("p");
  await page.waitForFunction(() => window.rhexis.state.paused);
  await page.keyboard.press("Space");
  await page.mouse.move(400, 400);
  await page.mouse.wheel(0, 160); // room for what is pulled out
  await page.setViewportSize(kSmall);
  await page.waitForTimeout(200);
  const box = await page.locator(".picture-frame").boundingBox();
  const clip = { x: box.x, y: box.y, width: box.width, height: box.height };
  await page.addStyleTag({ content: "@media (max-width: 900px) { .troubles, .hint { visibility: hidden; } }" });
  const frames = [];
  for (let k = 0; k < kFrames; ++k) {
    for (let step = 0; step < 9; ++step) {
      await page.keyboard.press("s");
      await page.waitForTimeout(40);
    }
    await page.waitForTimeout(200);
    frames.push(await page.screenshot({ clip }));
    if (k === Math.floor(kFrames * 0.7)) await shootPage(page);
  }
  writeFileSync(join(figures, "tear.png"), animated(frames));
} finally {
  await browser.close();
  program.kill("SIGINT");
}

/** The whole page as a person sees it, with stress. */
async function shootPage(page) {
  await page.setViewportSize(kLarge);
  await page.selectOption("#field", "3"); // maximum principal stress
  await page.waitForTimeout(500);
  await page.screenshot({ path: join(figures, "page.png") });
  await page.selectOption("#field", "0");
  await page.setViewportSize(kSmall);
  await page.waitForTimeout(500);
}

/** PNGs of one size as one animated PNG: the image data of each becomes a frame of it (PNG, third edition, 11.3.6). */
function animated(pngs) {
  const chunks = [];
  let sequence = 0;
  const first = chunksOf(pngs[0]);
  const header = first.find(({ type }) => type === "IHDR").data;
  chunks.push(chunk("IHDR", header), chunk("acTL", words(pngs.length, 0)));
  pngs.forEach((png, k) => {
    const delay = k === pngs.length - 1 ? 1500 : kFrameTime;
    const control = Buffer.alloc(26);
    words(sequence++).copy(control, 0);
    header.copy(control, 4, 0, 8);
    control.writeUInt16BE(delay, 20);
    control.writeUInt16BE(1000, 22);
    chunks.push(chunk("fcTL", control));
    for (const { type, data } of chunksOf(png)) {
      if (type !== "IDAT") continue;
      chunks.push(k === 0 ? chunk("IDAT", data) : chunk("fdAT", Buffer.concat([words(sequence++), data])));
    }
  });
  chunks.push(chunk("IEND", Buffer.alloc(0)));
  return Buffer.concat([pngs[0].subarray(0, 8), ...chunks]);
}

function words(...numbers) {
  const out = Buffer.alloc(4 * numbers.length);
  numbers.forEach((number, k) => out.writeUInt32BE(number, 4 * k));
  return out;
}

function chunksOf(png) {
  const out = [];
  for (let at = 8; at < png.length; ) {
    const length = png.readUInt32BE(at);
    out.push({ type: png.toString("latin1", at + 4, at + 8), data: png.subarray(at + 8, at + 8 + length) });
    at += 12 + length;
  }
  return out;
}

function chunk(type, data) {
  const body = Buffer.concat([Buffer.from(type, "latin1"), data]);
  return Buffer.concat([words(data.length), body, words(crc32(body))]);
}

/** Of PNG, annex D; Node's own came with 20.15. */
function crc32(bytes) {
  let crc = 0xffffffff;
  for (const byte of bytes) {
    crc ^= byte;
    for (let bit = 0; bit < 8; ++bit) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return (crc ^ 0xffffffff) >>> 0;
}
