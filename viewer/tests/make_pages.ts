// Makes the pages that the tests look at, with the command under test.
import { execFileSync } from "node:child_process";
import { copyFileSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";

export const kPages = process.env.HEXHEX_VIEWER_PAGES ?? join(import.meta.dirname, "../pages");

/** Would run if it got into the page as HTML, as a script, or as JSON that ends its element. */
export const kHostileName = `"'<img src=x onerror=stolen=1><!--&lt;\u2028.html`;

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

  // Few cells over many tets, so that they are curved; read from a file, and made from a map.
  hexhex("generate", "sphere", "--cells", "2", "--refine", "6", "--features", "-o", "ball.ovmb",
    "--quiet");
  hexhex("extract", "ball.ovmb", "-o", "curved.vtu", "--order", "3", "--quiet");
  hexhex("view", "curved.vtu", "--quiet");
  hexhex("view", "ball.ovmb", "--order", "2", "-o", "map.html", "--quiet");

  // A mesh with many cells that are not positive, and what an improvement makes of it; curved, too.
  hexhex("generate", "sphere", "--cells", "6", "--refine", "3", "--jitter", "0.3", "--seed", "3", "-o",
    "rough.hexex", "--quiet");
  hexhex("extract", "rough.hexex", "-o", "rough.vtu", "--quiet");
  hexhex("improve", "rough.vtu", "--map", "rough.hexex", "-o", "improved.vtu", "--view", "improved.html", "--quiet");
  hexhex("view", "improved.vtu", "-o", "after.html", "--quiet");
  hexhex("generate", "sphere", "--cells", "2", "--jitter", "0.9", "-o", "rough-ball.hexex", "--quiet");
  hexhex("extract", "rough-ball.hexex", "--order", "2", "--curved", "exact", "-o", "improved-ball.vtu", "--improve", "--passes", "1",
    "--view", "improved-curved.html", "--quiet");

  // One cell, in a file that somebody has named who means harm.
  const mesh = kHostileName.replace(/html$/, "mesh");
  const corners = ["0 0 0", "1 0 0", "1 1 0", "0 1 0", "0 0 1", "1 0 1", "1 1 1", "0 1 1"];
  writeFileSync(join(kPages, mesh), ["MeshVersionFormatted 2", "Dimension 3", "Vertices", "8",
    ...corners.map((corner) => `${corner} 0`), "Hexahedra", "1", "1 2 3 4 5 6 7 8 0", "End", ""]
    .join("\n"));
  hexhex("view", mesh, "--quiet");

  // A map whose name means harm, too.
  const map = kHostileName.replace(/html$/, "hexex");
  copyFileSync(join(kPages, "box.hexex"), join(kPages, map));
  hexhex("view", "box.mesh", "--map", map, "-o", "hostile-map.html", "--quiet");

  // A mesh that has tagged edges and faces.
  hexhex("generate", "cylinder", "--cells", "4", "--refine", "2", "--features", "-o",
    "tagged.ovmb", "--quiet");
  hexhex("extract", "tagged.ovmb", "-o", "features.ovmb", "--quiet");
  hexhex("view", "features.ovmb", "--quiet");

  // A part that has no mesh along frames: a tet with a long spike on each face.
  const points = ["0 0 0", "1 0 0", "0 1 0", "0 0 1", "1 1 -2", "1 -2 1", "1 1 1", "-2 1 1"];
  const tets = ["0 1 2 3", "0 2 1 4", "0 1 3 5", "1 2 3 6", "0 3 2 7"];
  const numbered = (rows: string[]) => rows.map((row, i) => `${i} ${row}\n`).join("");
  writeFileSync(join(kPages, "star.node"), `${points.length} 3 0 0\n${numbered(points)}`);
  writeFileSync(join(kPages, "star.ele"), `${tets.length} 4 0\n${numbered(tets)}`);
  const part = ["star.ele", "-o", "star.vtu", "--cells", "100", "--method", "frames", "--view", "star.html"];
  try {
    hexhex("mesh", ...part, "--quiet");
  } catch {
    // The page says where.
  }
}
