import { defineConfig } from "vitest/config";

/** The time that only a test which hangs takes: a busy machine draws a picture a second. */
const kInChromium = {
  globalSetup: "e2e/support/needs_chromium.ts",
  testTimeout: 240_000,
  hookTimeout: 120_000,
  expect: { poll: { timeout: 60_000 } },
};

export default defineConfig({
  // The program serves the page at its root; relative addresses let it stand anywhere.
  base: "./",
  build: {
    outDir: process.env["RHEXIS_PAGE"] ?? "../build/release/share/rhexis/page",
    emptyOutDir: true,
    target: "es2022",
    // three.js alone is larger than the bound that Vite warns at, and comes from this machine.
    chunkSizeWarningLimit: 1200,
  },
  server: { proxy: { "/live": { target: "ws://127.0.0.1:8080", ws: true }, "/recordings": "http://127.0.0.1:8080" } },
  test: {
    // One browser at a time: the machines that test have two cores, and it draws without a graphics card.
    fileParallelism: false,
    projects: [
      { test: { name: "unit", include: ["test/**/*.test.ts"] } },
      { test: { name: "page", include: ["e2e/page/*.test.ts"], ...kInChromium } },
      { test: { name: "play", include: ["e2e/play/*.test.ts"], ...kInChromium } },
    ],
  },
});
