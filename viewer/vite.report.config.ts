import { defineConfig } from "vite";

/** One script with all that it needs, for `rhexis study` to put into its reports. */
export default defineConfig({
  publicDir: false,
  build: {
    outDir: process.env["RHEXIS_REPORT"] ?? "../build/release/share/rhexis/report",
    emptyOutDir: true,
    target: "es2022",
    chunkSizeWarningLimit: 1200, // three.js is most of it
    lib: { entry: "src/report/main.ts", formats: ["iife"], name: "rhexisReport", fileName: () => "report.js" },
  },
});
