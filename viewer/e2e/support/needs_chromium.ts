import { existsSync } from "node:fs";

import { kChromium } from "./browser";

/** Before any test: one line where otherwise each would fail with a page of its own. */
export default function needsChromium(): void {
  if (!existsSync(kChromium)) throw new Error(`there is no ${kChromium} (tools/install test installs it; CHROMIUM names another)`);
}
