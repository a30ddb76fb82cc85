// How pages look: pictures of fixed size from fixed places, against those in tests/pictures. After a change
// of the looks: npx playwright test pictures --update-snapshots, and look at what has come out.
import { readFileSync } from "node:fs";
import { expect, open, press, savePicture, test } from "./page";

const kFrom = "camera=1.5,-2.5,1.45,0,0,0&inner=0";

const kViews: [name: string, page: string, fragment: string, keys: string][] = [
  ["boundary", "sphere.html", kFrom, ""],
  ["cut", "sphere.html", kFrom, "x"],
  ["peeled-rounded", "sphere.html", `${kFrom}&peel=2`, "r"],
  ["dug", "box.html", `${kFrom}&dug=63,62,61,46,47,42`, ""],
  ["worst-alone", "broken.html", kFrom, "w"],
  ["not-positive", "broken.html", kFrom, ""],
  ["curved", "curved.html", kFrom, "ye"],
  ["features", "features.html", `${kFrom}&colour=feature`, ""],
  ["patches", "features.html", `${kFrom}&colour=patch`, ""],
  ["generators-dark", "sphere.html", `${kFrom}&colour=generator&theme=dark`, "z"],
];

for (const [name, file, fragment, keys] of kViews) {
  test(`looks as it shall: ${name}`, async ({ page }) => {
    await open(page, file, `#${fragment}`);
    await press(page, keys);
    const path = await savePicture(page, { width: 240, height: 180, legend: false });
    // Other browsers round a little differently; lines, lights and colours are as they are.
    expect(readFileSync(path)).toMatchSnapshot(`${name}.png`, { threshold: 0.1, maxDiffPixelRatio: 0.01 });
  });
}
