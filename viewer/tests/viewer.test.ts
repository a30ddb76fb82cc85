import { mkdirSync, readFileSync, statSync } from "node:fs";
import { join } from "node:path";
import { hexhex, kHostileName, kPages } from "./make_pages";
import { colourInTheMiddle, coloursOnCanvas, complaintsOf, expect, kept, lookAtCanvas, open, pixelsOfPng, press, quads, settle, shotOfCanvas, sizeOfPng, test } from "./page";

const kPictures = process.env.HEXHEX_VIEWER_PICTURES ?? join(kPages, "../pictures");
mkdirSync(kPictures, { recursive: true });
const shot = (name: string) => ({ path: join(kPictures, `${name}.png`) });

/** 7 blocks of 8^3 cells. */
const kSide = 8;
const kSphereCells = 7 * kSide ** 3;

test("loads and draws", async ({ page }) => {
  await open(page, "sphere.html");
  expect(await kept(page)).toBe(kSphereCells);
  expect(await quads(page)).toBe(6 * kSide ** 2);
  await expect(page.locator("#stat-boundary-quads")).toHaveText(String(6 * kSide ** 2));
  await expect(page.locator("#stat-not-positive")).toHaveText("0");
  await expect(page.locator("#stat-inner")).toHaveText(`${20 * kSide} of valence 3`);
  await expect(page.locator("#stat-verification")).toContainText("agrees with sphere.hexex");
  expect(await coloursOnCanvas(page)).toBeGreaterThan(50);
  await page.screenshot(shot("sphere"));
});

test("slices with whole cells, on either side", async ({ page }) => {
  await open(page, "box.html");
  expect([await kept(page), await quads(page)]).toEqual([64, 96]);
  for (const key of "xyz") {
    await press(page, key);
    expect([await kept(page), await quads(page)]).toEqual([32, 64]);
  }
  await page.locator("#slice-position").fill("250");
  await settle(page);
  expect([await kept(page), await quads(page)]).toEqual([16, 48]);
  await press(page, "f");
  expect(await kept(page)).toBe(48);
  await page.locator('[data-slice="off"]').click();
  await settle(page);
  expect(await kept(page)).toBe(64);
  await press(page, "v");
  const half = await kept(page);
  expect(half).toBeGreaterThan(16);
  expect(half).toBeLessThan(48);
});

test("turns the cut towards the eye, with a ghost of what is gone", async ({ page }) => {
  await open(page, "box.html");
  await page.locator("#show-grid").uncheck();
  await settle(page);
  for (const look of ["0,0,4", "0,4,1", "4,1,0", "0,-4,1", "-4,1,0", "0,1,-4"]) {
    await open(page, "box.html", `#grid=0&camera=${look},0,0,0`);
    const axis = look.split(",").findIndex((part) => part.includes("4"));
    await press(page, "xyz"[axis]!);
    // Inside colours are warm: more red than blue. Nothing but the cut is to be seen in the middle.
    const [red, , blue] = await colourInTheMiddle(page);
    expect(red!).toBeGreaterThan(blue! + 20);
    const withGhost = (await lookAtCanvas(page)).covered;
    await press(page, "o");
    expect((await lookAtCanvas(page)).covered).toBeLessThan(withGhost);
    await press(page, "f");
    const [skinRed, , skinBlue] = await colourInTheMiddle(page);
    expect(skinBlue!).toBeGreaterThan(skinRed!);
  }
});

test("peels layers", async ({ page }) => {
  await open(page, "box.html");
  await expect(page.locator("#peel-most")).toHaveText("1");
  await press(page, "]");
  expect([await kept(page), await quads(page)]).toEqual([8, 24]);
  await press(page, "[");
  expect(await kept(page)).toBe(64);

  await open(page, "sphere.html");
  await page.locator("#peel").fill("2");
  await settle(page);
  expect(await kept(page)).toBe(kSide ** 3 + 6 * kSide ** 2 * (kSide - 2));
  await page.screenshot(shot("peeled"));
});

test("filters by quality with numbers and the brush", async ({ page }) => {
  await open(page, "sphere.html");
  await page.locator("#quality-to").fill("0.8");
  await page.locator("#quality-to").press("Enter");
  await settle(page);
  const below = await kept(page);
  expect(below).toBeGreaterThan(0);
  expect(below).toBeLessThan(kSphereCells);
  await page.locator("#quality-from").fill("0.8");
  await page.locator("#quality-to").fill("1");
  await page.locator("#quality-to").press("Enter");
  await settle(page);
  // Nothing is lost, and only cells of that very value are there twice.
  expect(Math.abs((await kept(page)) + below - kSphereCells)).toBeLessThan(5);
  await page.locator("#quality-all").click();
  await settle(page);
  expect(await kept(page)).toBe(kSphereCells);

  const box = (await page.locator("#histogram").boundingBox())!;
  await page.mouse.move(box.x + 1, box.y + 20);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2, box.y + 20, { steps: 4 });
  await page.mouse.up();
  await settle(page);
  const brushed = await kept(page);
  expect(brushed).toBeGreaterThan(0);
  expect(brushed).toBeLessThan(kSphereCells / 2);
  await page.screenshot(shot("brushed"));
});

test("finds cells that are not positive", async ({ page }) => {
  await open(page, "broken.html");
  await expect(page.locator("#stat-not-positive")).toHaveText("1");
  await expect(page.locator("#legend")).toContainText("not positive");
  await press(page, "w");
  await expect(page.locator("#picked-cell")).toHaveText("21");
  expect(Number(await page.locator("#picked-quality").textContent())).toBeLessThanOrEqual(0);
  await expect(page.locator("#stat-validity")).toContainText("not positive");
  await expect(page.locator("#picked-refuted")).toContainText("-");
  // Alone and close, with the outline of all cells around it: cell 21 is no outer one of the 4^3.
  expect([await kept(page), await quads(page)]).toEqual([1, 6]);
  const alone = await lookAtCanvas(page);
  await page.screenshot(shot("worst"));
  await press(page, "o");
  expect((await lookAtCanvas(page)).covered).toBeLessThan(0.8 * alone.covered);
  await press(page, "oi");
  expect(await kept(page)).toBe(64);
  await page.locator("#quality-to").fill("0");
  await page.locator("#quality-to").press("Enter");
  await settle(page);
  expect(await kept(page)).toBe(1);
});

test("goes back and forth between before and after an improvement", async ({ page }) => {
  await open(page, "improved.html");
  await expect(page.locator("#moments")).toBeVisible();
  const info = await page.evaluate(() => JSON.parse(document.getElementById("mesh-info")!.textContent!));
  const bad = info.before.validity.refuted;
  expect(bad).toBeGreaterThan(10);
  await expect(page.locator("#moment-bad")).toHaveText(`${bad.toLocaleString("en")} → 0`);
  await expect(page.locator("#stat-validity")).toHaveText("certified positive everywhere");
  await expect(page.locator("#legend")).not.toContainText("not positive");
  const after = await lookAtCanvas(page);

  await press(page, "a");
  await expect(page.locator('[data-moment="0"]')).toHaveAttribute("aria-pressed", "true");
  await expect(page.locator("#legend")).toContainText("not positive");
  await expect(page.locator("#stat-validity")).toContainText(`${bad.toLocaleString("en")} not positive`);
  await expect(page.locator("#stat-minimum")).toHaveText(info.before.quality.minimum.toFixed(4));
  const before = await lookAtCanvas(page);
  expect(before.colours).not.toBe(after.colours);
  // The worst cell, and where: those of the mesh before.
  await press(page, "w");
  expect(Number(await page.locator("#picked-quality").textContent())).toBeCloseTo(info.before.quality.minimum, 3);
  const cornerOf = () => page.locator("#picked-corners tbody").innerText();
  const corner = await cornerOf();
  await press(page, "a");
  expect(Number(await page.locator("#picked-quality").textContent())).toBeGreaterThan(0);
  expect(await cornerOf()).not.toBe(corner);
  await page.keyboard.press("Escape");
  await press(page, "h");

  // Filters take the values of what is shown, and cuts its positions.
  await page.locator("#quality-to").fill("0");
  await page.locator("#quality-to").press("Enter");
  await settle(page);
  expect(await kept(page)).toBe(0);
  await page.locator('[data-moment="0"]').click();
  await settle(page);
  expect(await kept(page)).toBe(info.before.quality.notPositive);
  await page.locator("#quality-all").click();
  await press(page, "x");
  const keptBefore = await kept(page);
  await page.locator("#title").scrollIntoViewIfNeeded();
  await page.screenshot(shot("improved-before"));
  await press(page, "a");
  expect(await kept(page)).not.toBe(keptBefore);
  await press(page, "x");
  expect((await lookAtCanvas(page)).covered).toBe(after.covered);

  // In between, positions are on their way; values are those of the nearer end.
  await page.locator("#moment").fill("400");
  await settle(page);
  await expect(page.locator("#legend")).toContainText("not positive");
  const between = await lookAtCanvas(page);
  expect([before.covered, after.covered]).not.toContain(between.covered);
  await page.locator("#share").click();
  expect(page.url()).toContain("moment=0.4");
  await open(page, "improved.html", "#moment=0");
  await expect(page.locator("#legend")).toContainText("not positive");
});

test("has after an improvement what a page of that mesh has", async ({ page }) => {
  await open(page, "after.html", "#camera=1.5,-2.5,1.45,0,0,0");
  await expect(page.locator("#moments")).toBeHidden();
  await press(page, "a");
  const facts = ["#stat-minimum", "#stat-mean", "#stat-validity", "#stat-everywhere", "#kept-cells"];
  const read = () => Promise.all(facts.map((id) => page.locator(id).textContent()));
  const alone = await read();
  await open(page, "improved.html", "#camera=1.5,-2.5,1.45,0,0,0");
  expect(await read()).toEqual(alone);
  // What the page holds beside it are the positions before, and their values.
  const [both, one] = ["improved.html", "after.html"].map((name) => readFileSync(join(kPages, name), "utf8"));
  expect(both).toContain("points_before");
  for (const word of ["points_before-", '"before"', "not_positive-"]) expect(one!.includes(`data-${word}`)).toBe(false);
});

test("shows curved cells before and after an improvement", async ({ page }) => {
  await open(page, "improved-curved.html");
  await expect(page.locator("#moment-bad")).toHaveText("56 → 0");
  const after = await lookAtCanvas(page);
  await press(page, "a");
  const before = await lookAtCanvas(page);
  expect(before.covered).not.toBe(after.covered);
  await page.screenshot(shot("improved-curved-before"));
  await press(page, "a");
  expect((await lookAtCanvas(page)).covered).toBe(after.covered);
});

test("takes single cells away, and puts them back", async ({ page }) => {
  await open(page, "box.html", "#colour=plain&grid=0&camera=0.1,0.1,4,0.1,0.1,0");
  const box = (await page.locator("#canvas").boundingBox())!;
  const middle: [number, number] = [box.x + box.width / 2, box.y + box.height / 2];
  const before = await colourInTheMiddle(page);
  const seen = [];
  await page.locator("#dig").click();
  for (let dug = 1; dug <= 3; ++dug) {
    await page.mouse.click(...middle);
    await settle(page);
    // Of a hole of one cell one sees its walls, too: four more faces for each cell.
    expect([await kept(page), await quads(page)]).toEqual([64 - dug, 96 + 4 * dug]);
    seen.push((await colourInTheMiddle(page))[1]!);
  }
  // Deeper means darker, and inside is warmer than outside.
  expect(seen[1]).toBeLessThan(seen[0]!);
  expect(seen[2]).toBeLessThan(seen[1]!);
  await page.screenshot(shot("dug"));
  await expect(page.locator("#picked")).toBeHidden();
  await page.locator("#share").click();
  expect(page.url()).toMatch(/dug=\d+,\d+,\d+/);
  await page.keyboard.press("Control+z");
  await settle(page);
  await press(page, "k");
  await page.keyboard.press("Backspace");
  await settle(page);
  await page.locator("#undo").click();
  await settle(page);
  await expect(page.locator("#undo")).toBeDisabled();
  expect([await kept(page), await quads(page)]).toEqual([64, 96]);
  expect(await colourInTheMiddle(page)).toEqual(before);
  // Otherwise a click picks, unless Shift is down; the last cell of a column leaves a hole.
  await page.keyboard.down("Shift");
  for (let dug = 1; dug <= 5; ++dug) await page.mouse.click(...middle).then(() => settle(page));
  await page.keyboard.up("Shift");
  expect(await kept(page)).toBe(60);
  await page.mouse.click(...middle);
  await settle(page);
  await expect(page.locator("#picked")).toBeHidden();
});

test("tells about a cell that is clicked", async ({ page }) => {
  await open(page, "box.html");
  await expect(page.locator("#picked")).toBeHidden();
  await page.locator('[data-look="z"]').click();
  await settle(page);
  const box = (await page.locator("#canvas").boundingBox())!;
  // A little beside the middle, where four cells meet: the cell at x, y in [0.5, 0.75].
  await page.mouse.click(box.x + box.width / 2 + 25, box.y + box.height / 2 - 25);
  await settle(page);
  await expect(page.locator("#picked")).toBeVisible();
  await expect(page.locator("#picked-quality")).toHaveText("1.0000");
  const number = Number(await page.locator("#picked-cell").textContent());

  // The corners are those of the file, and the cell is at the top.
  const lines = readFileSync(join(kPages, "box.mesh"), "utf8").split("\n");
  const corners = lines[lines.indexOf("Hexahedra") + 2 + number]!.split(" ").slice(0, 8);
  const rows = await page.locator("#picked-corners tbody tr").allInnerTexts();
  const cells = rows.map((row) => row.split(/\s+/));
  expect(cells.map((row) => Number(row[1]) + 1)).toEqual(corners.map(Number));
  for (const axis of [2, 3, 4]) {
    const values = cells.map((row) => Number(row[axis]));
    const place = lines.indexOf("Vertices") + 2;
    const wanted = corners.map((c) => Number(lines[place + Number(c) - 1]!.split(" ")[axis - 2]));
    values.forEach((value, k) => expect(value).toBeCloseTo(wanted[k]!, 4));
  }
  const highest = Math.max(...cells.map((row) => Number(row[4])));
  expect(highest).toBeCloseTo(Number(await page.evaluate(() =>
    JSON.parse(document.getElementById("mesh-info")!.textContent!).upper[2])), 4);

  await page.mouse.click(box.x + 5, box.y + 5);
  await settle(page);
  await expect(page.locator("#picked")).toBeHidden();
});

test("colours, and says in the legend how", async ({ page }) => {
  await open(page, "sphere.html");
  const legend = page.locator("#legend");
  await expect(legend).toContainText("scaled Jacobian");
  await page.locator("#show-inner").uncheck();
  await expect(legend).not.toContainText("valence");
  await page.locator("#show-inner").check();
  await expect(legend).toContainText(`3 (${20 * kSide})`);
  await page.locator("#colour").selectOption("generator");
  await expect(legend).toContainText("vertex lies in a");
  await settle(page);
  await page.screenshot(shot("generators"));
  await page.locator("#colour").selectOption("layer");
  await expect(legend).toContainText("layer from the boundary");
  // This mesh has no features, so that colouring is not on offer.
  await expect(page.locator('#colour option[value="feature"]')).toBeDisabled();
  await page.locator("#show-inner").uncheck();
  await expect(legend).not.toContainText("valence");
});

test("shows what is tagged", async ({ page }) => {
  await open(page, "features.html");
  await expect(page.locator("#show-features")).toBeVisible();
  const plain = await coloursOnCanvas(page);
  await page.locator("#colour").selectOption("feature");
  await settle(page);
  await expect(page.locator("#legend")).toContainText("tag of the face");
  expect(await page.locator("#legend i:not(.edge)").count()).toBeGreaterThan(2);
  expect(await coloursOnCanvas(page)).not.toBe(plain);
  await page.screenshot(shot("features"));
});

test("shows where a part cannot be meshed", async ({ page }) => {
  await open(page, "star.html");
  await expect(page.locator("#colour")).toHaveValue("region");
  await expect(page.locator("#legend")).toContainText("region of the cell");
  await expect(page.locator("#legend")).not.toContainText("valence");
  await expect(page.locator("#show-features")).toBeVisible();
  await page.locator("#colour").selectOption("quality");
  await expect(page.locator("#legend")).toContainText("scaled Jacobian");
});

test("draws cells of higher order curved or straight", async ({ page }) => {
  await open(page, "curved.html");
  const [cells, side] = [7 * 2 ** 3, 2];
  const boundary = 6 * side ** 2;
  expect([await kept(page), await quads(page)]).toEqual([cells, boundary]);
  await expect(page.locator("#stat-order")).toHaveText("3");
  // Two nodes on each edge, four on each face; Euler's formula counts the edges.
  const vertices = Number(await page.locator("#stat-vertices").textContent());
  const faces = (6 * cells + boundary) / 2;
  const edges = vertices + faces - cells - 1;
  await expect(page.locator("#stat-nodes")).toHaveText((2 * edges + 4 * faces).toLocaleString("en"));
  await expect(page.locator("#drawn-pieces")).toHaveText("36");
  await page.locator("#show-inner").uncheck();
  await settle(page);
  const curved = await lookAtCanvas(page);
  await page.screenshot(shot("curved"));

  await press(page, "u");
  await expect(page.locator("#show-curved")).not.toBeChecked();
  await expect(page.locator("#curved-pieces")).toBeHidden();
  expect([await kept(page), await quads(page)]).toEqual([cells, boundary]);
  // A ball is larger than the polyhedron inside it.
  const straight = await lookAtCanvas(page);
  expect(straight.covered).toBeGreaterThan(0.5 * curved.covered);
  expect(straight.covered).toBeLessThan(0.98 * curved.covered);
  await page.locator("#share").click();
  expect(page.url()).toContain("curved=0");
  await press(page, "u");
  expect((await lookAtCanvas(page)).covered).toBe(curved.covered);

  await press(page, "x");
  expect(await kept(page)).toBe(cells / 2);
  const box = (await page.locator("#canvas").boundingBox())!;
  await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
  await settle(page);
  await expect(page.locator("#picked-cell")).toHaveText(/^\d+$/);
  await press(page, "ebo");
  await page.screenshot(shot("curved-cut"));
});

test("shows the mesh of a map", async ({ page }) => {
  await open(page, "map.html");
  expect(await kept(page)).toBe(56);
  await expect(page.locator("#drawn-pieces")).toHaveText("16");
  await expect(page.locator("#stat-verification")).toContainText("agrees with ball.ovmb");
  await page.locator("#colour").selectOption("region");
  await expect(page.locator("#legend")).toContainText("region of the cell");
  expect(await page.locator("#legend i:not(.edge)").count()).toBe(7);
  await settle(page);
  await page.screenshot(shot("regions"));
  // Straight meshes have nothing to switch.
  await open(page, "box.html");
  await expect(page.locator("#show-curved")).toBeHidden();
});

test("saves a picture", async ({ page }) => {
  await open(page, "sphere.html");
  const download = page.waitForEvent("download");
  await page.locator("#picture").click();
  const file = await download;
  expect(file.suggestedFilename()).toBe("sphere.png");
  const path = join(kPictures, "saved.png");
  await file.saveAs(path);
  const { width, height } = (await page.locator("#canvas").boundingBox())!;
  expect(sizeOfPng(path)).toEqual([width, height]);
  expect(statSync(path).size).toBeGreaterThan(20000);

  // Any size, and nothing behind the mesh.
  const before = await shotOfCanvas(page);
  await page.locator("#picture-width").fill("900");
  await page.locator("#picture-height").fill("1200");
  await page.locator("#picture-transparent").check();
  await page.locator("#picture-legend").uncheck();
  const large = page.waitForEvent("download");
  await page.locator("#picture").click();
  const largePath = join(kPictures, "saved-large.png");
  await (await large).saveAs(largePath);
  expect(sizeOfPng(largePath)).toEqual([900, 1200]);
  const { corner, middle } = await pixelsOfPng(page, largePath);
  expect(corner).toEqual([0, 0, 0, 0]);
  expect(middle[3]).toBe(255);
  await settle(page);
  expect((await shotOfCanvas(page)).equals(before)).toBe(true);
  // No size at all, and one that no browser draws.
  for (const [wide, problem] of [["7", false], ["16000", true]] as const) {
    await page.locator("#picture-width").fill(wide);
    await page.locator("#picture-height").fill(wide);
    await page.locator("#picture").click();
    await expect(page.locator("#problem")).toBeVisible({ visible: problem });
  }
  await expect(page.locator("#problem")).toContainText("16000 by 16000");
});

test("keeps the view in the address", async ({ page, context }) => {
  await open(page, "sphere.html");
  await press(page, "z..]c");
  await page.locator("#share").click();
  const address = page.url();
  expect(address).toContain("slice=z");
  const before = [await kept(page), await quads(page)];

  const other = await context.newPage();
  await other.goto(address);
  await settle(other);
  expect([await kept(other), await quads(other)]).toEqual(before);
  await expect(other.locator("#colour")).toHaveValue("generator");
  expect(other.url()).toBe(address);

  // Nonsense in the address is no reason to fail.
  await open(page, "box.html", "#slice=q,1&peel=900&cell=77777&camera=1,2&quality=a,b");
  expect(await kept(page)).toBe(8);
  await expect(page.locator("#picked")).toBeHidden();
  await open(page, "broken.html", "#camera=0,0,0,0,0,0&slice=x,0,0,0,7&quality=9,-9&colour=__proto__");
  expect(await kept(page)).toBe(64);
  expect(await coloursOnCanvas(page)).toBeGreaterThan(10);
});

test("takes any name, and a mesh of one cell", async ({ page }) => {
  await open(page, encodeURIComponent(kHostileName));
  await expect(page.locator("#title")).toHaveText(kHostileName.replace(/html$/, "mesh"));
  expect(await page.title()).toContain("<img src=x");
  expect(await page.evaluate(() => "stolen" in window)).toBe(false);
  expect([await kept(page), await quads(page)]).toEqual([1, 6]);
  await press(page, "w");
  await expect(page.locator("#picked-cell")).toHaveText("0");
});

test("shows the name of the map as text", async ({ page }) => {
  await open(page, "hostile-map.html");
  await expect(page.locator("#stat-verification")).toContainText(kHostileName.replace(/html$/, "hexex"));
  expect(await page.locator("#panel img, #panel script").count()).toBe(0);
  expect(await page.evaluate(() => "stolen" in window)).toBe(false);
});

test("runs nothing and asks nobody, even if HTML got into it", async ({ page }) => {
  await open(page, "box.html");
  const answered: string[] = [];
  page.on("requestfinished", (request) => answered.push(request.url()));
  const refused = await page.evaluate(async () => {
    const directives: string[] = [];
    document.addEventListener("securitypolicyviolation", (event) => directives.push(event.effectiveDirective));
    const mark = `window["stolen"] = 1`;
    const holder = document.createElement("div");
    holder.innerHTML = `<img src="data:," onerror='${mark}'><a href='javascript:${mark}'></a>
      <img src="https://example.org/a.png"><iframe src="https://example.org"></iframe>
      <form action="https://example.org"></form><p style="color: red"></p>
      <link rel="stylesheet" href="https://example.org/a.css">
      <object data="https://example.org"></object><video src="https://example.org/a.mp4"></video>`;
    document.body.append(holder);
    holder.querySelector("a")!.click();
    holder.querySelector("form")!.submit();
    for (const text of [mark, ""]) {
      const script = document.createElement("script");
      if (text) script.textContent = text;
      else script.src = "https://example.org/a.js";
      document.body.append(script);
    }
    document.head.append(Object.assign(document.createElement("base"), { href: "https://example.org" }));
    await fetch("https://example.org").catch(() => {});
    await fetch(location.href).catch(() => {});
    navigator.sendBeacon("https://example.org", "1");
    try { new WebSocket("wss://example.org"); } catch { /* refused */ }
    try { new Worker("data:text/javascript,1"); } catch { /* refused */ }
    await new Promise((resolve) => setTimeout(resolve, 1000));
    return [...new Set(directives)].sort();
  });
  expect(await page.evaluate(() => "stolen" in window)).toBe(false);
  expect(refused).toEqual(["base-uri", "connect-src", "form-action", "frame-src", "img-src", "media-src",
    "object-src", "script-src-attr", "script-src-elem", "style-src-attr", "style-src-elem",
    "worker-src"]);
  expect(answered).toEqual([]);
  // What the browser says it has refused.
  for (const text of complaintsOf(page)) {
    expect(text).toMatch(/Content Security Policy|^request: https:\/\/example.org\/a\.(png|css|js)$/);
  }
  complaintsOf(page).length = 0;
});

test("lists the keys, and is dark on request", async ({ page }) => {
  await open(page, "sphere.html");
  await press(page, "?");
  await expect(page.locator("#shortcuts")).toBeVisible();
  await expect(page.locator("#shortcut-list dt")).toHaveCount(32);
  await page.keyboard.press("Escape");
  await expect(page.locator("#shortcuts")).toBeHidden();
  const back = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const light = await back();
  await press(page, "d");
  await expect.poll(back).not.toBe(light);
  await press(page, "x");
  await page.screenshot(shot("dark"));
});

test("works on a phone", async ({ browser }) => {
  const context = await browser.newContext({
    viewport: { width: 390, height: 800 },
    hasTouch: true,
    isMobile: true,
    deviceScaleFactor: 2,
  });
  const page = await context.newPage();
  await open(page, "sphere.html");
  const canvas = (await page.locator("#canvas").boundingBox())!;
  const panel = (await page.locator("#panel").boundingBox())!;
  expect(canvas.width).toBe(390);
  expect(panel.y).toBeGreaterThanOrEqual(canvas.y + canvas.height - 1);
  expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBe(390);
  await page.locator('[data-slice="x"]').tap();
  await settle(page);
  expect(await kept(page)).toBe(kSphereCells / 2);
  await page.touchscreen.tap(canvas.x + canvas.width / 2, canvas.y + canvas.height / 2);
  await settle(page);
  await expect(page.locator("#picked-cell")).toHaveText(/^\d+$/);
  await page.screenshot(shot("phone"));
  // The list of keys is longer than the screen, and begins at its top.
  await page.locator("#help").tap();
  expect(await page.locator("#shortcuts").evaluate((list) => [list.scrollTop, list.scrollHeight > list.clientHeight])).toEqual([0, true]);
  await page.keyboard.press("Escape");
  // Without the panel, the canvas is taller, and the mesh still fits.
  await page.locator('[data-slice="off"]').tap();
  await page.locator('[data-look="home"]').tap();
  await settle(page);
  const before = await lookAtCanvas(page);
  await page.locator("#panel-toggle").tap();
  await expect(page.locator("#controls")).toBeHidden();
  await settle(page);
  expect([before.runsOff, (await lookAtCanvas(page)).runsOff]).toEqual([false, false]);
  await context.close();
});

test("the mesh fills the canvas at first, with its singular edges", async ({ page }) => {
  await open(page, "sphere.html");
  const first = await lookAtCanvas(page);
  expect(first.runsOff).toBe(false);
  expect(first.share).toBeGreaterThan(0.55);
  await expect(page.locator("#show-inner")).toBeChecked();
  for (const name of ["Peel", "Dig"]) {
    expect(await page.locator("legend", { hasText: name }).first().getAttribute("title")).toMatch(/ells/);
  }
});

test("names patches, and saves names for the command", async ({ page }) => {
  await open(page, "features.html", "#colour=patch");
  const names = page.locator("#patch-list input");
  await expect(names).toHaveCount(3);
  await expect(page.locator("#legend")).toContainText("surface_2");
  await expect(page.locator("#save-names")).toBeDisabled();
  // Two groups with one name would be one.
  await names.nth(1).fill("Surface_1");
  await names.nth(1).blur();
  await expect(names.nth(1)).toHaveValue("surface_2");
  await names.nth(1).fill("my inlet");
  await names.nth(1).blur();
  await expect(page.locator("#legend")).toContainText("my_inlet");
  const [download] = await Promise.all([page.waitForEvent("download"), page.locator("#save-names").click()]);
  const saved = await download.path();
  expect(readFileSync(saved, "utf8")).toBe("surface_2 my_inlet\n");
  hexhex("convert", "features.ovmb", "named.msh", "--names", saved, "--quiet");
  expect(hexhex("info", "named.msh")).toMatch(/my_inlet +\d/);
  await page.screenshot(shot("patches"));
});

test("says so if its data is damaged", async ({ page }) => {
  // The last character of the first chunk before its padding.
  const html = readFileSync(join(kPages, "box.html"), "utf8");
  await page.setContent(html.replace(/(id="data-cells-0">)(....)/, "$1AAAA"));
  await expect(page.locator("#problem")).toBeVisible();
});
