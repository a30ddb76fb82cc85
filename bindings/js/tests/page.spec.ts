// The page hexhex.html, from file://, with files that are really dragged onto it.
import { type Page, test as base, expect } from "@playwright/test";
import { execFileSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, truncateSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

/** Every test fails if the console says anything, or the page asks for anything but itself. */
const test = base.extend<{ page: Page }>({
  page: async ({ page }, use) => {
    const seen: string[] = [];
    page.on("console", (message) => {
      if (!/GPU stall due to ReadPixels|example\.org/.test(message.text())) seen.push(message.text());
    });
    page.on("pageerror", (error) => seen.push(error.message));
    page.on("request", (request) => {
      if (!/^(blob|data):/.test(request.url()) && request.url() !== address) seen.push(request.url());
    });
    await page.goto(address);
    await page.waitForSelector('body[data-ready="true"]');
    await use(page);
    expect(seen).toEqual([]);
  },
});

const address = `file://${process.env.HEXHEX_PAGE}`;
const folder = mkdtempSync(join(tmpdir(), "hexhex-page-"));
const at = (name: string) => join(folder, name);
const hexhex = (...args: string[]) =>
  execFileSync(process.env.HEXHEX_COMMAND!, args, { cwd: folder, encoding: "utf8", stdio: "pipe" });

test.beforeAll(() => {
  hexhex("generate", "sphere", "--cells", "4", "--refine", "2", "--charts", "random", "-o", "sphere.hexex");
  hexhex("extract", "sphere.hexex", "--scale", "2", "-o", "two.mesh", "--quiet");
  hexhex("generate", "torus", "--cells", "3", "--refine", "2", "-o", "torus.ovm");
  hexhex("generate", "sphere", "--cells", "6", "--refine", "3", "--defects", "4", "-o", "damaged.hexex");
  hexhex("generate", "cylinder", "--cells", "4", "--refine", "3", "--stretch", "0.3", "-o", "seamless.hexex");
});
test.afterAll(() => rmSync(folder, { recursive: true }));

/**
 * Drags files from outside of the browser onto the page, and lets them fall.
 *
 * Until Chromium has drawn the page without the frame of a mesh, it still sends a drag there, and never
 * answers: then the drag enters again.
 */
async function drop(page: Page, ...names: string[]): Promise<void> {
  const session = await page.context().newCDPSession(page);
  const data = { items: [], files: names.map(at), dragOperationsMask: 1 };
  const send = (type: "dragEnter" | "dragOver" | "drop") =>
    session.send("Input.dispatchDragEvent", { type, x: 300, y: 300, data });
  await page.evaluate(() => new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn))));
  await expect(async () => {
    const entered = send("dragEnter").then(() => true, () => false);
    expect(await Promise.race([entered, page.waitForTimeout(5000)])).toBe(true);
  }).toPass();
  await send("dragOver");
  await send("drop");
  await session.detach();
}

const idle = (page: Page) => page.waitForSelector('body[data-working="false"]');
async function dropAndWait(page: Page, ...names: string[]): Promise<void> {
  const before = await page.locator("body").getAttribute("data-done");
  const isDone = `body:not([data-done="${before}"])`;
  // What Chromium sends to a frame that has gone is lost.
  await expect(async () => {
    await drop(page, ...names);
    await page.waitForSelector(`body[data-working="true"], ${isDone}`, { timeout: 15_000 });
  }).toPass();
  await page.waitForSelector(isDone);
}
async function click(page: Page, id: string): Promise<void> {
  await page.locator(id).click();
  await idle(page);
}
const text = (page: Page, id: string) => page.locator(id).textContent();
const problem = (page: Page) => page.locator("#problem");

async function setScale(page: Page, scale: number): Promise<void> {
  await page.locator("#scale").fill(String(scale));
}

/** The viewer's page inside of the page, when its mesh is there. */
async function meshView(page: Page) {
  const frame = page.frameLocator("#mesh-view");
  await frame.locator('body[data-loaded="true"]').waitFor();
  return frame;
}

async function saved(page: Page, extension: string): Promise<Buffer> {
  const [download] = await Promise.all([
    page.waitForEvent("download"),
    page.locator("#downloads button", { hasText: new RegExp(`^${extension}$`) }).click(),
  ]);
  await idle(page);
  return readFileSync(await download.path());
}

test("a good map becomes the mesh that the command makes", async ({ page }) => {
  await dropAndWait(page, "sphere.hexex");
  await expect(page.locator("#verdict")).toHaveText("The map is valid.");
  expect(await text(page, "#cells")).toBe("448");
  await setScale(page, 2);
  expect(await text(page, "#cells")).toBe("3,584");
  await click(page, "#extract");
  expect(await text(page, "#verification")).toContain("Verified");
  expect(await text(page, "#valid-cells")).toBe("all cells, proven");
  const frame = await meshView(page);
  await expect(frame.locator("#all-cells")).toHaveText("3,584");
  await expect(frame.locator("#verification")).toContainText("sphere.hexex");
  // As docs/user/browser.md shows it.
  await page.screenshot({ path: `${process.env.HEXHEX_PAGE_PICTURES ?? "test-results"}/browser.png` });
  for (const extension of [".vtu", ".mesh", ".msh", ".vtk", ".ovm"]) {
    hexhex("extract", "sphere.hexex", "--scale", "2", "-o", `sphere-2${extension}`, "--quiet");
    expect((await saved(page, extension)).equals(readFileSync(at(`sphere-2${extension}`)))).toBe(true);
  }
});

test("defects of a map are places on the object", async ({ page }) => {
  await dropAndWait(page, "damaged.hexex");
  await expect(page.locator("#verdict")).toHaveText("The map is not valid:");
  await expect(page.locator("#defects .bad").first()).toContainText("FlippedTet");
  const before = await page.locator("#canvas").screenshot();
  await page.locator("#defects button").first().click();
  await expect(page.locator("#extracting")).toBeHidden();
  expect((await page.locator("#canvas").screenshot()).equals(before)).toBe(false);
});

test("a seamless map is quantized", async ({ page }) => {
  await dropAndWait(page, "seamless.hexex");
  await expect(page.locator("#quantize-hint")).toContainText("The map is seamless");
  const tets = await text(page, "#map-tets");
  await page.locator("#wanted").fill("500");
  await click(page, "#quantize");
  await expect(page.locator("#verdict")).toHaveText("The map is valid.");
  expect(await text(page, "#map-tets")).toBe(tets);  // of this map, none is split
  const cells = Number(await text(page, "#cells"));
  expect(cells).toBeGreaterThan(250);
  expect(cells).toBeLessThan(1000);
  await click(page, "#extract");
  expect(await text(page, "#verification")).toContain("Verified");
  expect(await text(page, "#mesh-cells")).toBe(String(cells));
});

test("tets without a map are meshed, and as often as one likes", async ({ page }) => {
  // As tet meshers write it: Medit's format.
  hexhex("generate", "cylinder", "--cells", "2", "--refine", "2", "-o", "cylinder.hexex");
  writeFileSync(at("part.mesh"), meditOf(readFileSync(at("cylinder.hexex"), "utf8")));
  await dropAndWait(page, "part.mesh");
  await expect(page.locator("#verdict")).toHaveText("There is no map on these tets.");
  await expect(page.locator("#part-hint")).toContainText("part.mesh");
  await expect(problem(page)).toBeHidden();
  const tets = await text(page, "#map-tets");
  await page.locator("#part-cells").fill("300");
  for (const method of ["frames", "polycube", "auto"]) {
    await page.locator("#method").selectOption(method);
    await click(page, "#mesh-part");
    expect(await text(page, "#verification")).toBe("Verified: it is the mesh of the map of part.mesh at scale 1.");
    expect(await text(page, "#valid-cells")).toBe("all cells, proven");
    expect(await text(page, "#why")).toMatch(method === "auto" ? /^Kept: / : /^$/);
    await expect(page.locator("#extracting")).toBeHidden();
  }
  const cells = await text(page, "#mesh-cells");
  const frame = await meshView(page);
  await expect(frame.locator("#all-cells")).toHaveText(cells!);
  writeFileSync(at("part.vtu"), await saved(page, ".vtu"));
  const info = JSON.parse(hexhex("info", "part.vtu", "--json"));
  expect(info.validity.positive).toBe(Number(cells));
  // What was cancelled leaves the tets.
  await page.locator("#part-cells").fill("20000000");
  await page.locator("#mesh-part").click();
  await expect(page.locator("#progress")).toContainText("%");
  await page.locator("#cancel").click();
  await idle(page);
  await expect(problem(page)).toBeHidden();
  expect(await text(page, "#map-tets")).toBe(tets);
  await page.locator("#part-cells").fill("300");
  await click(page, "#mesh-part");
  expect(await text(page, "#mesh-cells")).toBe(cells);
  await page.locator("#samples").selectOption({ label: "cylinder, without a map" });
  await page.waitForSelector("#meshing:not([hidden])");
  await idle(page);
});

/** The tets of a .hexex file as a .mesh file. */
function meditOf(hexex: string): string {
  const lines = hexex.trim().split("\n");
  const points = lines.slice(1, 1 + Number(lines[0]));
  const tets = lines.slice(2 + points.length, 2 + points.length + Number(lines[1 + points.length]))
    .map((line) => line.trim().split(/\s+/).slice(0, 4).map((v) => Number(v) + 1).join(" "));
  const section = (name: string, rows: string[]) => `${name}\n${rows.length}\n${rows.map((row) => `${row} 0`).join("\n")}\n`;
  return `MeshVersionFormatted 2\nDimension 3\n${section("Vertices", points)}${section("Tetrahedra", tets)}End\n`;
}

test("a mesh is viewed, and verified if its map is there", async ({ page }) => {
  await dropAndWait(page, "two.mesh");
  expect(await text(page, "#verification")).toContain("no valid map");
  await expect((await meshView(page)).locator("#all-cells")).toHaveText("3,584");
  await dropAndWait(page, "two.mesh", "sphere.hexex");
  expect(await text(page, "#verification")).toBe("Verified: it is the mesh of sphere.hexex at scale 2.");
  await dropAndWait(page, "two.mesh", "torus.ovm");
  expect(await text(page, "#verification")).toContain("It is not the mesh of torus.ovm");
});

test("wrong and empty files get a sentence", async ({ page }) => {
  const hostile = `<img src=x onerror="document.title='stolen'">.hexex`;
  writeFileSync(at(hostile), "no map at all");
  writeFileSync(at("empty.hexex"), "");
  writeFileSync(at("letter.txt"), "Dear reader");
  await dropAndWait(page, hostile);
  await expect(problem(page)).toContainText(hostile.slice(0, 4));
  await expect(problem(page)).toContainText("line 1");
  expect(await page.locator("main img").count()).toBe(0);
  await dropAndWait(page, "empty.hexex");
  await expect(problem(page)).toContainText("empty.hexex");
  await dropAndWait(page, "letter.txt");
  await expect(problem(page)).toContainText("letter.txt");
  mkdirSync(at("folder.hexex"));
  await dropAndWait(page, "folder.hexex");
  await expect(problem(page)).toContainText("folder.hexex cannot be read: it is a folder");
  await dropAndWait(page, "sphere.hexex", "torus.ovm");
  await expect(problem(page)).toContainText("two of a kind");
  await dropAndWait(page, "sphere.hexex");
  await expect(problem(page)).toBeHidden();
  expect(await page.title()).toBe("hexhex");
});

test("names of files and arrays are text", async ({ page }) => {
  const hostile = `"'<img src=x onerror=alert(1)><!--&lt;`;
  writeFileSync(at(`${hostile}.hexex`), readFileSync(at("sphere.hexex")));
  await dropAndWait(page, `${hostile}.hexex`);
  expect(await text(page, "#map-name")).toBe(`${hostile}.hexex`);
  hexhex("generate", "torus", "--cells", "2", "--refine", "1", "-o", "torus.vtk");
  const file = readFileSync(at("torus.vtk"), "latin1");
  writeFileSync(at("torus.vtk"), file.replace("\nigm ", "\n<img/src=x> "), "latin1");
  await dropAndWait(page, "torus.vtk");
  await expect(page.locator("#part-hint")).toContainText("<img/src=x>");
  writeFileSync(at(`${hostile}.mesh`), readFileSync(at("two.mesh")));
  await dropAndWait(page, `${hostile}.mesh`);
  expect(await text(page, "#mesh-name")).toBe(`${hostile}.mesh`);
  const frame = await meshView(page);
  await expect(frame.locator("#title")).toHaveText(`${hostile}.mesh`);
  for (const images of [page.locator("img"), frame.locator("img")]) expect(await images.count()).toBe(0);
});

test("500 MB of zeros are no map, and the page goes on", async ({ page }) => {
  writeFileSync(at("zeros.hexex"), "");
  truncateSync(at("zeros.hexex"), 500e6);
  await dropAndWait(page, "zeros.hexex");
  await expect(problem(page)).toContainText("zeros.hexex");
  await dropAndWait(page, "sphere.hexex");
  await click(page, "#extract");
  expect(await text(page, "#verification")).toContain("Verified");
});

test("work can be cancelled in the middle, and done again", async ({ page }) => {
  await dropAndWait(page, "sphere.hexex");
  await setScale(page, 30);
  await page.locator("#extract").click();
  // Some stage has begun.
  await expect(page.locator("#progress")).toContainText("%");
  await page.locator("#cancel").click();
  await idle(page);
  await expect(problem(page)).toBeHidden();
  await expect(page.locator("#mesh")).toBeHidden();
  await setScale(page, 2);
  await click(page, "#extract");
  expect(await text(page, "#mesh-cells")).toBe("3,584");
});

test("a second map has the memory of the first", async ({ page }) => {
  const megabytes = async () => Number.parseInt((await text(page, "#memory"))!);
  await dropAndWait(page, "sphere.hexex");
  await setScale(page, 12);
  await click(page, "#extract");
  expect(await megabytes()).toBeGreaterThan(100);
  await page.locator("#show-map").click();
  const workers = page.workers().length;
  for (const name of ["torus.ovm", "sphere.hexex", "torus.ovm"]) {
    await dropAndWait(page, name);
    // The worker is another one, which began with an empty memory.
    expect(await megabytes()).toBeLessThan(50);
  }
  expect(page.workers().length).toBeLessThanOrEqual(workers);
});

test("an old browser gets a sentence", async ({ browser }) => {
  const page = await browser.newPage();
  await page.addInitScript(() => Reflect.deleteProperty(window, "DecompressionStream"));
  await page.goto(address);
  await expect(problem(page)).toContainText("This page needs a newer browser");
  await page.close();
});

test("without WebGL, nothing is drawn, but all else works", async ({ browser }) => {
  const page = await browser.newPage({ acceptDownloads: true });
  await page.addInitScript(() => (HTMLCanvasElement.prototype.getContext = () => null));
  await page.goto(address);
  await page.waitForSelector('body[data-ready="true"]');
  await dropAndWait(page, "sphere.hexex", "two.mesh");
  await expect(problem(page)).toContainText("The map cannot be drawn");
  expect(await text(page, "#verification")).toContain("Verified");
  expect((await saved(page, ".mesh")).equals(readFileSync(at("two.mesh")))).toBe(true);
  await page.close();
});

test("samples are in a menu, and nothing reaches the network", async ({ page }) => {
  await page.locator("#samples").selectOption({ label: "cylinder, seamless" });
  await page.waitForSelector("#quantizing:not([hidden])");
  await idle(page);
  const refused = await page.evaluate(() => fetch("https://example.org").then(() => "reached", () => "refused"))
    .catch(() => "refused");
  expect(refused).toBe("refused");
  const policy = await page.locator("meta[http-equiv]").getAttribute("content");
  expect(policy).toContain("default-src 'none'");
  expect(policy).not.toContain("connect-src");
});
