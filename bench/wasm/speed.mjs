// See run. Extraction alone, from arrays to arrays, as both measure it themselves; the least time of
// several, in turns.
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";

const { load } = await import(join(process.env.HEXHEX_JS, "dist/index.js"));
const repetitions = Number(process.argv[2] ?? 3);
const command = process.env.HEXHEX_COMMAND;
const folder = mkdtempSync(join(tmpdir(), "hexhex-"));
const real = join(process.env.HEXHEX_TEST_DATA, "maps");
const run = (...args) => execFileSync(command, args, { cwd: folder, maxBuffer: 1 << 28 });

/** About 100 hexahedra per tet, and about a million tets. */
function makeMaps() {
  const maps = ["s17c_sphere_r100.hexex", "fandisk_r100.hexex"]
    .map((name) => join(real, name)).filter((file) => existsSync(file));
  run("generate", "sphere", "--cells", "64", "--refine", "6", "--charts", "random", "-o", "dense.ovmb", "--quiet");
  run("generate", "sphere", "--cells", "23", "--refine", "23", "--charts", "scattered", "-o", "million.ovmb", "--quiet");
  return [...maps, join(folder, "dense.ovmb"), join(folder, "million.ovmb")];
}

function native(file) {
  const report = join(folder, "report.json");
  run("extract", file, "-o", "mesh.ovmb", "--threads", "1", "--quiet", "--no-verify", "--report", report);
  return JSON.parse(readFileSync(report, "utf8"));
}

async function inNode(file) {
  const hexhex = await load();
  const mesh = hexhex.extract(hexhex.readMap(readFileSync(file), basename(file)));
  return { seconds: mesh.seconds, memory: hexhex.memoryBytes };
}

console.log("| map | tets | cells | native | wasm | ratio | wasm memory |\n|---|---|---|---|---|---|---|");
for (const file of makeMaps()) {
  let [theirs, ours, memory, report] = [Infinity, Infinity, 0, null];
  for (let i = 0; i < repetitions; ++i) {
    report = native(file);
    theirs = Math.min(theirs, report.extract_seconds);
    const result = await inNode(file);
    ours = Math.min(ours, result.seconds);
    memory = result.memory;
  }
  const cells = [basename(file), report.tets.toLocaleString("en"), report.cells.toLocaleString("en"),
    `${theirs.toFixed(2)} s`, `${ours.toFixed(2)} s`, (ours / theirs).toFixed(2), `${Math.round(memory / 2 ** 20)} MiB`];
  console.log(`| ${cells.join(" | ")} |`);
}
rmSync(folder, { recursive: true });
