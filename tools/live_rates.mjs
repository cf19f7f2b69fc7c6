// Rates of a live body with the page attached, as a table of docs/live-models.md: each model on a soft rod of three sizes, led on a circle by the mouse.
//
//   make viewer build && node tools/live_rates.mjs [--seconds 10] [--nodes 300,2100,10000] [--models linear,hyperelastic]
//
// Needs Chromium, which draws the page without a graphics card, on the same cores. Rod, circle and speed are those of `rhexis study live-models`; the rod has a cut, judged in every frame, that does not run on.
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { parseArgs } from "node:util";

const repository = new URL("..", import.meta.url).pathname;
const { chromium } = createRequire(join(repository, "viewer/package.json"))("playwright-core");
const { values: options } = parseArgs({
  options: {
    seconds: { type: "string", default: "10" },
    speed: { type: "string", default: "0.05" }, // m/s, of the hand
    nodes: { type: "string", default: "300,2100,10000" },
    models: { type: "string", default: "linear,corotated,geometrically-nonlinear,hyperelastic" },
    command: { type: "string", default: join(repository, "build/release/bin/rhexis") },
  },
});
const kSettle = 2000; // ms, after the hand has set out: the page is drawn, the rates are those of the motion
const kRadius = 0.006; // m, of the circle
const kSides = [[0.01, 0.0, 0.05], [-0.01, 0.0, 0.05]]; // m; the hand takes hold half way between where they are seen
const kMeasured = 40; // px, moved aside to learn what a pixel is
const kEvery = 8; // ms, between two moves of the mouse

const rod = `title = "Soft rod"
[mesh]
generate = "tube"
radius = 0.01
length = 0.06
nodes = 300
[material]
density = 1000.0
young = 1.0e5
poisson = 0.49
[model]
kind = "linear"
[[support]]
set = "bottom"
x = 0.0
y = 0.0
z = 0.0
[fracture]
criterion = "maximum-hoop"
strength = 1.0e15
incision = "split"
[[crack]]
from = [0.015, 0.0, 0.03]
to = [0.0, 0.0, 0.03]
through = [0.0, 1.0, 0.0]
`;

/** Starts the program; `url` is the page's, once it can be had, and `ended` comes after the program, however it ends. */
function start(command, args) {
  const child = spawn(command, [...args, "--port", "0", "--no-browser"], { cwd: repository, stdio: ["ignore", "pipe", "inherit"] });
  const ended = new Promise((done) => child.once("exit", done).once("error", done));
  const url = new Promise((found, fail) => {
    let said = "";
    child.stdout.on("data", (text) => {
      said += text;
      const page = /^page +(http\S+)$/m.exec(said);
      if (page !== null) found(page[1]);
    });
    child.once("error", fail);
    child.once("exit", () => fail(new Error("the program ended before it had a page")));
  });
  return { child, url, ended };
}

/** Takes hold of the front of the rod; gives the pixel, and pixels a metre of the hand's plane. */
async function takeHold(page) {
  const [x, y] = await page.evaluate((sides) => {
    const [one, other] = sides.map((side) => window.rhexis.pixelOf(side));
    return one.map((at, c) => (at + other[c]) / 2);
  }, kSides);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.waitForFunction(() => window.rhexis.state.held);
  await page.mouse.move(x + kMeasured, y);
  await page.waitForTimeout(1000);
  const moved = await page.evaluate(() => window.rhexis.state.hand);
  return { x, y, perMetre: kMeasured / Math.hypot(...moved) };
}

/** Leads the hand on the circle until `isOver`; gives the speed of the mouse in m/s. */
async function lead(page, { x, y, perMetre }, speed, isOver) {
  const radius = kRadius * perMetre;
  const from = performance.now();
  let way = 0;
  let before = 0;
  while (!isOver()) {
    const angle = (speed * (performance.now() - from)) / 1000 / kRadius;
    await page.mouse.move(x + radius * (1 - Math.cos(angle)), y - radius * Math.sin(angle));
    way += 2 * kRadius * Math.abs(Math.sin((angle - before) / 2));
    before = angle;
    await new Promise((done) => setTimeout(done, kEvery));
  }
  return (1000 * way) / (performance.now() - from);
}

const read = (page) =>
  page.evaluate(() => {
    const { body, state, pictures } = window.rhexis;
    const { physicsHz, physicsWorstMs, hapticMissed, hapticWorstUs, snapshotAgeMs, realtime } = state.rates;
    return { tick: Number(state.tick), missed: Number(hapticMissed), physicsHz, physicsWorstMs, hapticWorstUs, snapshotAgeMs, realtime, pictures, tets: body.tets, held: state.held };
  });

async function measure(browser, scene, nodes, model, seconds, speed) {
  const program = start(options.command, ["play", scene, "--set", `mesh.nodes=${nodes}`, "--set", `model.kind=${model}`]);
  const url = await program.url;  // before there is a page, which would take the core that the body is prepared on
  const page = await browser.newPage({ viewport: { width: 800, height: 600 } });
  let isOver = false;
  let led = Promise.resolve(0);
  try {
    await page.goto(url);
    await page.waitForFunction(() => window.rhexis?.state != null);
    led = lead(page, await takeHold(page), speed, () => isOver);
    await page.waitForTimeout(kSettle);
    const first = await read(page);
    const each = [];
    for (let k = 0; k < seconds; ++k) {
      await page.waitForTimeout(1000);
      each.push(await read(page));
    }
    const last = each[each.length - 1];
    isOver = true;
    const reached = await led;
    if (!last.held) throw new Error("the hand was let go");
    const ticks = last.tick - first.tick;
    const sorted = each.map((now) => now.physicsHz).sort((a, b) => a - b);
    return {
      frames: sorted[Math.floor(sorted.length / 2)],
      least: sorted[0],
      kept: 1 - (last.missed - first.missed) / ticks,
      tets: last.tets,
      late: Math.max(...each.map((now) => now.hapticWorstUs)) / 1000,
      age: Math.max(...each.map((now) => now.snapshotAgeMs)),
      pictures: (1000 * (last.pictures - first.pictures)) / ticks,
      realtime: last.realtime,
      speed: reached,
    };
  } finally {
    isOver = true;
    await led.catch(() => 0);  // what went wrong is on its way already
    await page.close();
    program.child.kill("SIGINT");
    await program.ended;
  }
}

const seconds = Number(options.seconds);
const speed = Number(options.speed);
if (!(seconds >= 1) || !(speed > 0)) {
  console.error("live_rates: --seconds is 1 or more, --speed (m/s) more than 0");
  process.exit(2);
}
const folder = mkdtempSync(join(tmpdir(), "rhexis-"));
const scene = join(folder, "rod.toml");
writeFileSync(scene, rod);
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--disable-dev-shm-usage", "--enable-unsafe-swiftshader", "--disable-background-networking"],
});
try {
  console.log("| tets | model | frames/s, median | worst second | haptic ticks within 1 ms | latest tick, ms | oldest law, ms | pictures/s of the page | hand, mm/s |");
  console.log("| ---: | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
  for (const nodes of options.nodes.split(",")) {
    for (const model of options.models.split(",")) {
      const found = await measure(browser, scene, nodes, model, seconds, speed).catch((error) => console.error(`live_rates: ${model}, ${nodes} nodes: ${error.message}`));
      if (!found) {
        process.exitCode = 1;
        continue;
      }
      console.log(
        `| ${found.tets} | ${model} | ${found.frames.toFixed(0)} | ${found.least.toFixed(0)} | ${(100 * found.kept).toFixed(2)}%${found.realtime ? "" : " (no real-time priority)"} ` +
          `| ${found.late.toFixed(1)} | ${found.age.toFixed(0)} | ${found.pictures.toFixed(0)} | ${(1000 * found.speed).toFixed(0)} |`,
      );
    }
  }
} finally {
  await browser.close();
  rmSync(folder, { recursive: true });
}
