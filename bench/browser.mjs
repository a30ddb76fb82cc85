// The browser in which pages are measured.
import { createRequire } from "node:module";
import { join } from "node:path";

/** A new Chromium, which draws without a graphics card.
 * @param packages  folder of the npm package that has Playwright */
export function launch(packages) {
  const { chromium } = createRequire(join(packages, "package.json"))("@playwright/test");
  return chromium.launch({
    executablePath: process.env.HEXHEX_CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  });
}
