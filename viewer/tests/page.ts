// What the tests do with a page: open it, watch it, read its panel.
import { type Page, test as base, expect } from "@playwright/test";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { kPages } from "./make_pages";

/** Messages and requests of a page that shall not be. */
const complaints = new WeakMap<Page, string[]>();

/** Every test fails if the console says anything, or the page asks for anything but itself. */
export const test = base.extend<{ page: Page }>({
  page: async ({ page }, use) => {
    const seen: string[] = [];
    complaints.set(page, seen);
    page.on("console", (message) => {
      // Software drawing is slow at reading back, and says so: a property of this test alone.
      if (/GPU stall due to ReadPixels/.test(message.text())) return;
      seen.push(`${message.type()}: ${message.text()}`);
    });
    page.on("pageerror", (error) => seen.push(`error: ${error.message}`));
    page.on("request", (request) => {
      const url = request.url();
      // A worker from the page's own text is no request to anyone.
      if (url.startsWith("blob:") || url.startsWith("data:")) return;
      if (request.isNavigationRequest()) return;
      seen.push(`request: ${url}`);
    });
    await use(page);
    expect(seen).toEqual([]);
  },
});

export const complaintsOf = (page: Page) => complaints.get(page)!;

/** Waits until the worker has answered and the answer is on the canvas. */
export async function settle(page: Page): Promise<void> {
  await page.waitForSelector('body[data-loaded="true"][data-busy="false"]');
  await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
}

export async function open(page: Page, name: string, fragment = ""): Promise<void> {
  await page.goto(`file://${join(kPages, name)}${fragment}`);
  await settle(page);
}

async function count(page: Page, id: string): Promise<number> {
  return Number((await page.locator(id).textContent())!.replaceAll(",", ""));
}

export const kept = (page: Page) => count(page, "#kept-cells");
export const quads = (page: Page) => count(page, "#drawn-quads");

export async function press(page: Page, keys: string): Promise<void> {
  for (const key of keys) {
    await page.keyboard.press(key);
    await settle(page);
  }
}

/** Of a picture: the number of different colours, 1 if nothing is drawn; of pixels that are not as the one
 * in the corner; and red, green, blue and opacity there and in the middle. */
async function lookAt(page: Page, png: Buffer) {
  return page.evaluate(async (base64) => {
    const image = new Image();
    image.src = `data:image/png;base64,${base64}`;
    await image.decode();
    const canvas = document.createElement("canvas");
    canvas.width = image.width;
    canvas.height = image.height;
    const context = canvas.getContext("2d")!;
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, canvas.width, canvas.height);
    const pixels = new Uint32Array(data.buffer);
    const middle = 4 * (Math.floor(image.height / 2) * image.width + Math.floor(image.width / 2));
    // A body that runs off the canvas is cut off at both sides.
    const isBody = (column: number) =>
      Array.from({ length: image.height }, (_, row) => pixels[row * image.width + column] !== pixels[0]).some(Boolean);
    return {
      runsOff: isBody(0) || isBody(image.width - 1),
      share: pixels.reduce((sum, pixel) => sum + Number(pixel !== pixels[0]), 0) / pixels.length,
      colours: new Set(pixels).size,
      covered: pixels.reduce((sum, pixel) => sum + Number(pixel !== pixels[0]), 0),
      corner: [...data.slice(0, 4)],
      middle: [...data.slice(middle, middle + 4)],
    };
  }, png.toString("base64"));
}

/** A picture of the canvas, once two in a row are the same: a busy machine shows the last frame late. */
export async function shotOfCanvas(page: Page): Promise<Buffer> {
  const shoot = () => page.locator("#canvas").screenshot();
  let last = await shoot();
  for (let next = await shoot(); !next.equals(last); next = await shoot()) last = next;
  return last;
}

export const lookAtCanvas = async (page: Page) => lookAt(page, await shotOfCanvas(page));
export const coloursOnCanvas = async (page: Page) => (await lookAtCanvas(page)).colours;
export const colourInTheMiddle = async (page: Page) => (await lookAtCanvas(page)).middle;
export const pixelsOfPng = (page: Page, path: string) => lookAt(page, readFileSync(path));

/** Saves a picture as the panel does. @return  where it is */
export async function savePicture(
  page: Page,
  { width, height, legend }: { width: number; height: number; legend: boolean },
): Promise<string> {
  await page.locator("#picture-width").fill(String(width));
  await page.locator("#picture-height").fill(String(height));
  await page.locator("#picture-legend").setChecked(legend);
  const [download] = await Promise.all([page.waitForEvent("download"), page.locator("#picture").click()]);
  return download.path();
}

/** Width and height, from the file's header; throws if it is no PNG. */
export function sizeOfPng(path: string): [number, number] {
  const bytes = readFileSync(path);
  expect(bytes.subarray(1, 4).toString()).toBe("PNG");
  return [bytes.readUInt32BE(16), bytes.readUInt32BE(20)];
}

export { expect };
