// The animation at the head of README: the page of `make play` while the scene's script pulls.
//
//   make viewer && node docs/figures/tear.mjs       writes docs/figures/tear-animated.png; needs Chromium
import { spawn } from "node:child_process";
import { writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { crc32 } from "node:zlib";

const repository = new URL("../..", import.meta.url).pathname;
const { chromium } = createRequire(join(repository, "viewer/package.json"))("playwright-core");
const port = 18734;
const frames = 22;
const frameMs = 120;

function chunk(type, data) {
  const body = Buffer.concat([Buffer.from(type, "latin1"), data]);
  const out = Buffer.alloc(body.length + 8);
  out.writeUInt32BE(data.length, 0);
  body.copy(out, 4);
  out.writeUInt32BE(crc32(body), body.length + 4);
  return out;
}

/** Pictures of one size as an animated PNG (the acTL, fcTL and fdAT chunks of the PNG specification, third edition). */
function animate(pictures, ms) {
  const parts = pictures.map((png) => {
    const out = { header: null, data: [] };
    for (let at = 8; at < png.length; at += 12 + png.readUInt32BE(at)) {
      const type = png.toString("latin1", at + 4, at + 8);
      const data = png.subarray(at + 8, at + 8 + png.readUInt32BE(at));
      if (type === "IHDR") out.header = data;
      if (type === "IDAT") out.data.push(data);
    }
    return out;
  });
  const { header } = parts[0];
  const control = Buffer.alloc(8);
  control.writeUInt32BE(parts.length, 0);
  const chunks = [pictures[0].subarray(0, 8), chunk("IHDR", header), chunk("acTL", control)];
  let sequence = 0;
  parts.forEach(({ data }, k) => {
    const frame = Buffer.alloc(26);
    frame.writeUInt32BE(sequence++, 0);
    header.copy(frame, 4, 0, 8);
    frame.writeUInt16BE(k + 1 === parts.length ? 1500 : ms, 20);
    frame.writeUInt16BE(1000, 22);
    chunks.push(chunk("fcTL", frame));
    if (k === 0) return chunks.push(...data.map((one) => chunk("IDAT", one)));
    const number = Buffer.alloc(4);
    number.writeUInt32BE(sequence++, 0);
    chunks.push(chunk("fdAT", Buffer.concat([number, ...data])));
  });
  return Buffer.concat([...chunks, chunk("IEND", Buffer.alloc(0))]);
}

const program = spawn(join(repository, "build/release/bin/rhexis"), ["play", "scenes/plate-tear.toml", "--set", "pull.0.seconds=8", "--port", `${port}`], {
  cwd: repository,
  stdio: "ignore",
});
const browser = await chromium.launch({
  executablePath: "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});
try {
  const page = await browser.newPage({ viewport: { width: 1280, height: 720 }, deviceScaleFactor: 0.6, colorScheme: "light" });
  for (let tries = 0; ; ++tries) {
    try {
      await page.goto(`http://127.0.0.1:${port}/`);
      break;
    } catch (error) {
      if (tries === 50) throw error;
      await new Promise((resolve) => setTimeout(resolve, 200));
    }
  }
  await page.waitForFunction(() => window.rhexis?.state != null);
  await page.waitForTimeout(1000);
  await page.keyboard.press("Space");
  const begin = Date.now();
  const pictures = [];
  for (let k = 0; k < frames; ++k) {
    await page.waitForTimeout(Math.max(0, begin + k * 400 - Date.now()));
    pictures.push(await page.screenshot());
  }
  writeFileSync(join(repository, "docs/figures/tear-animated.png"), animate(pictures, frameMs));
} finally {
  await browser.close();
  program.kill();
}
