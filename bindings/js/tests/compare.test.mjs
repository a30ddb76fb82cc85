// The package in Node writes the same bytes as the command:
//   HEXHEX_COMMAND=build/release/hexhex node --test bindings/js/tests/
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readdirSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";
import { after, test } from "node:test";
import { load } from "../dist/index.js";

const command = process.env.HEXHEX_COMMAND;
const maps = process.env.HEXHEX_TEST_DATA ?? join(import.meta.dirname, "../../../../shared/data");
const folder = mkdtempSync(join(tmpdir(), "hexhex-"));
after(() => rmSync(folder, { recursive: true }));

const hexhex = await load();
const run = (...args) => execFileSync(command, args, { cwd: folder, encoding: "utf8" });

/** With the first difference, instead of megabytes in the report. */
function assertSameBytes(ours, file) {
  const theirs = readFileSync(join(folder, file));
  if (theirs.equals(ours)) return;
  const at = theirs.findIndex((byte, i) => byte !== ours[i]);
  assert.fail(`${file}: ${ours.length} and ${theirs.length} bytes, different from byte ${at} on`);
}

/** Extracts with both, and compares files of these extensions. */
function compareMeshes(file, scale, extensions) {
  const map = hexhex.readMap(readFileSync(file), basename(file));
  const mesh = hexhex.extract(map, { scale });
  assert.ok(hexhex.verify(mesh, map, { scale }).passed, "verified");
  hexhex.certify(mesh);
  for (const extension of extensions) {
    const output = `mesh${extension}`;
    run("extract", file, "-o", output, "--scale", String(scale), "--quiet", "--no-verify", "--threads", "1");
    assertSameBytes(hexhex.writeMesh(mesh, output), output);
  }
  mesh.free();
  map.free();
}

for (const { name } of hexhex.samples) {
  for (const options of [
    { cells: 4, refine: 2 },
    { cells: 6, refine: 3, jitter: 0.3, charts: "random", seed: 7, features: true },
  ]) {
    test(`sample ${name}, ${JSON.stringify(options)}`, { skip: !command }, () => {
      const args = Object.entries(options).flatMap(([key, value]) =>
        value === true ? [`--${key}`] : [`--${key}`, String(value)]);
      run("generate", name, ...args, "-o", "sample.hexex", "--quiet");
      const map = hexhex.generate(name, options);
      assertSameBytes(hexhex.writeMap(map, "sample.hexex"), "sample.hexex");
      map.free();
      compareMeshes(join(folder, "sample.hexex"), 2, [".vtu", ".mesh", ".msh", ".vtk", ".ovm"]);
    });
  }
}

const real = existsSync(join(maps, "maps")) ? readdirSync(join(maps, "maps")).sort() : [];
for (const file of real) {
  test(`map ${file}`, { skip: !command }, () => compareMeshes(join(maps, "maps", file), 1, [".vtu"]));
}

test("what check says", { skip: !command || real.length === 0 }, () => {
  for (const file of readdirSync(join(maps, "defective"))) {
    const path = join(maps, "defective", file);
    const map = hexhex.readMap(readFileSync(path), file);
    const ours = hexhex.check(map);
    for (const defect of ours.defects) {
      for (const occurrence of defect.worst) occurrence.place = occurrence.place.text;
    }
    let theirs = "";
    try {
      run("check", path, "--json");
      assert.fail("a defective map is not valid");
    } catch (error) {
      theirs = error.stdout;
    }
    assert.deepEqual(ours, JSON.parse(theirs));
    map.free();
  }
});
