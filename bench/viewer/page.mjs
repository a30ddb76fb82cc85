// See run. A drag over the canvas turns the mesh; each frame that the browser has drawn meanwhile counts.
import { statSync } from "node:fs";
import { resolve } from "node:path";
import { launch } from "../browser.mjs";

const [packages, page] = process.argv.slice(2).map((path) => resolve(path));
const kSeconds = 5;

const browser = await launch(packages);
const tab = await browser.newPage({ viewport: { width: 1280, height: 800 } });
tab.setDefaultTimeout(300_000);
const begin = performance.now();
await tab.goto(`file://${page}`);
const question = tab.locator("#load-anyway");
if (await question.isVisible()) await question.click();  // beyond five million cells
const shown = 'body[data-loaded="true"]';
await tab.waitForSelector(shown);
const usable = (performance.now() - begin) / 1000;
await tab.waitForSelector(`${shown}[data-busy="false"]`);
const settled = (performance.now() - begin) / 1000;
const cells = await tab.locator("#kept-cells").textContent();
const megabytes = statSync(page).size / 1e6;
console.log(`${cells} cells, ${megabytes.toFixed(1)} MB`);
console.log(`${usable.toFixed(1)} s until they are shown, ${settled.toFixed(1)} s until all is there`);

await tab.evaluate(() => {
  window.frames_ = 0;
  const count = () => {
    ++window.frames_;
    requestAnimationFrame(count);
  };
  requestAnimationFrame(count);
});
await tab.mouse.move(500, 400);
await tab.mouse.down();
const start = performance.now();
for (let i = 0; performance.now() - start < 1000 * kSeconds; ++i) {
  await tab.mouse.move(500 + (i % 200), 400 + (i % 70));
}
const frames = await tab.evaluate(() => window.frames_);
console.log(`${(frames / ((performance.now() - start) / 1000)).toFixed(1)} frames per second while turned`);
await tab.mouse.up();
await browser.close();
