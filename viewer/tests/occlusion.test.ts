// How much light faces get, where that is known.
import { expect, test } from "@playwright/test";
import { carriedLight, Occlusion } from "../src/worker/occlusion";

/** Squares in a row of rows: places of their corners, by steps from 0 to n along two sides. */
function plate(n: number, at: (i: number, j: number) => [number, number, number]) {
  const positions: number[] = [];
  const quads: number[] = [];
  for (let j = 0; j <= n; ++j) for (let i = 0; i <= n; ++i) positions.push(...at(i / n, j / n), 0);
  for (let j = 0; j < n; ++j) {
    for (let i = 0; i < n; ++i) {
      const a = j * (n + 1) + i;
      quads.push(a, a + 1, a + n + 2, a + n + 1, j * n + i, 0);
    }
  }
  return { positions, quads };
}

/** The same from the other side: walls of bodies have two. */
const behind = (one: ReturnType<typeof plate>) => ({
  positions: one.positions,
  quads: one.quads.map((_, i) => one.quads[i % 6 < 4 ? i - (i % 6) + 3 - (i % 6) : i]!),
});

function lightOn(...plates: ReturnType<typeof plate>[]): Uint8Array {
  const positions: number[] = [];
  const quads: number[] = [];
  for (const each of plates) {
    const first = positions.length / 4;
    quads.push(...each.quads.map((number, i) => (i % 6 < 4 ? number + first : number)));
    positions.push(...each.positions);
  }
  const occlusion = new Occlusion(new Uint32Array(quads), new Float32Array(positions));
  while (!occlusion.finished) occlusion.work(1);
  return occlusion.shares;
}

const n = 8;
const floor = () => plate(n, (i, j) => [0.6 * i - 0.3, 0.6 * j - 0.3, 0]);

test("a face with nothing in front sees all of the sky", () => {
  expect(Math.min(...lightOn(floor()))).toBe(255);
});

test("a wall takes about half of the sky from where it stands, and less further away", () => {
  // Its inner side looks along +x.
  const wall = plate(n, (i, j) => [-0.3, 0.6 * i - 0.3, 0.6 * j]);
  const light = lightOn(floor(), wall, behind(wall));
  const middle = n / 2;
  const along = Array.from({ length: n }, (_, i) => light[4 * (middle * n + i)]! / 255);
  expect(along[0]).toBeGreaterThan(0.4);
  expect(along[0]).toBeLessThan(0.6);
  expect(along[n - 1]).toBeGreaterThan(0.9);
  for (let i = 1; i < n; ++i) expect(along[i]).toBeGreaterThan(along[i - 1]! - 0.03);
});

test("a lid takes all of it", () => {
  const lid = plate(n, (i, j) => [0.6 * i - 0.3, 0.3 - 0.6 * j, 0.02]);
  expect(lightOn(floor(), lid, behind(lid))[4 * ((n / 2) * n + n / 2)]).toBeLessThan(20);
});

test("light is carried to the same faces of the next picture, and to no others", () => {
  const quads = new Uint32Array([1, 2, 3, 4, 0, 0, 5, 6, 7, 8, 0, 1, 1, 2, 6, 5, 7, 0]);
  const light = new Uint8Array([1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12]);
  const next = new Uint32Array([5, 6, 7, 8, 0, 1, 9, 10, 11, 12, 3, 0, 1, 2, 6, 5, 7, 0]);
  const carried = carriedLight(quads, light, next);
  expect([...carried.slice(0, 4)]).toEqual([5, 6, 7, 8]);
  expect(new Set(carried.slice(4, 8)).size).toBe(1);
  expect([...carried.slice(8)]).toEqual([9, 10, 11, 12]);
});
