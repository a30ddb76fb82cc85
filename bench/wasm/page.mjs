// See run. The time is from the address to the page that takes a map, in a browser that has just begun: the
// median. The largest mesh is what the slider offers for a sample.
import { readFileSync, statSync } from "node:fs";
import { join } from "node:path";
import { gzipSync } from "node:zlib";
import { launch } from "../browser.mjs";

const js = process.env.HEXHEX_JS;
const page = process.env.HEXHEX_PAGE ?? join(js, "../hexhex.html");

/** A tab with the page, ready, in a new browser; and the seconds that it took. */
async function open() {
  const browser = await launch(js);
  const tab = await browser.newPage();
  tab.setDefaultTimeout(1_800_000);
  const begin = performance.now();
  await tab.goto(`file://${page}`);
  await tab.waitForSelector('body[data-ready="true"]');
  return { browser, tab, seconds: (performance.now() - begin) / 1000 };
}

async function largestMesh(tab) {
  const idle = () => tab.waitForSelector('body[data-working="false"]');
  const text = (id) => tab.locator(id).textContent();
  const label = await tab.locator("#samples option", { hasText: /^sphere:/ }).textContent();
  await tab.locator("#samples").selectOption({ label });
  await tab.waitForSelector("#extracting:not([hidden])");
  await idle();
  await tab.locator("#scale").fill(await tab.locator("#scale").getAttribute("max"));
  await tab.locator("#extract").click();
  await idle();
  console.log(`${await text("#mesh-cells")} cells. ${await text("#verification")} ${await text("#memory")}.`);
  const [download] = await Promise.all([
    tab.waitForEvent("download"),
    tab.locator("#downloads button", { hasText: /^\.vtu$/ }).click(),
  ]);
  console.log(`Their .vtu has ${(statSync(await download.path()).size / 1e9).toFixed(2)} GB.`);
}

const bytes = readFileSync(page);
console.log(`${(bytes.length / 1e6).toFixed(2)} MB, ${(gzipSync(bytes, { level: 9 }).length / 1e6).toFixed(2)} MB gzipped`);
const times = [];
for (let i = 0; i < 5; ++i) {
  const { browser, seconds } = await open();
  times.push(seconds);
  await browser.close();
}
console.log(`can be used after ${times.sort((a, b) => a - b)[2].toFixed(2)} s`);
const { browser, tab } = await open();
await largestMesh(tab);
await browser.close();
