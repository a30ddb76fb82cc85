// Makes the pages that the tests look at, with the command under test.
import { execFileSync } from "node:child_process";
import { mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";

export const kPages = process.env.HEXHEX_VIEWER_PAGES ?? join(import.meta.dirname, "../pages");

export function hexhex(...args: string[]): string {
  const command = process.env.HEXHEX_COMMAND;
  if (!command) throw new Error("HEXHEX_COMMAND shall name the hexhex command");
  return execFileSync(command, args, { cwd: kPages, encoding: "utf8" });
}

/** Turns a cell of a MEDIT mesh inside out: its first two corners change places. */
function invertCell(file: string, cell: number): void {
  const lines = readFileSync(join(kPages, file), "utf8").split("\n");
  const first = lines.indexOf("Hexahedra") + 2;
  const numbers = lines[first + cell]!.split(" ");
  [numbers[0], numbers[1]] = [numbers[1]!, numbers[0]!];
  lines[first + cell] = numbers.join(" ");
  writeFileSync(join(kPages, file), lines.join("\n"));
}

export default function makePages(): void {
  rmSync(kPages, { recursive: true, force: true });
  mkdirSync(kPages, { recursive: true });
  hexhex("generate", "sphere", "--cells", "4", "--refine", "2", "--jitter", "0.05", "--seed", "1",
    "-o", "sphere.hexex", "--quiet");
  hexhex("extract", "sphere.hexex", "-o", "sphere.vtu", "--scale", "2", "--quiet");
  hexhex("view", "sphere.vtu", "--map", "sphere.hexex", "--scale", "2", "--quiet");

  // A cube of 4^3 cells (2^3 blocks), where everything can be counted by hand.
  hexhex("generate", "box", "--cells", "2", "--refine", "1", "-o", "box.hexex", "--quiet");
  hexhex("extract", "box.hexex", "-o", "box.mesh", "--quiet");
  hexhex("view", "box.mesh", "--quiet");

  // The same with one cell broken.
  hexhex("extract", "box.hexex", "-o", "broken.mesh", "--quiet");
  invertCell("broken.mesh", 21);
  hexhex("view", "broken.mesh", "--quiet");

  // A mesh that has tagged edges and faces.
  hexhex("generate", "cylinder", "--cells", "4", "--refine", "2", "--features", "-o",
    "tagged.ovmb", "--quiet");
  hexhex("extract", "tagged.ovmb", "-o", "features.ovmb", "--quiet");
  hexhex("view", "features.ovmb", "--quiet");
}
