// What the package promises, in Node.
import assert from "node:assert/strict";
import { test } from "node:test";
import { HexhexError, HexMesh, load, TetMap } from "../dist/index.js";

const hexhex = await load();

test("arrays of a mesh are views that hold the mesh", () => {
  const map = hexhex.generate("box", { cells: 2, refine: 1 });
  const mesh = hexhex.extract(map);
  assert.equal(mesh.cells.length, 8 * 64);
  assert.equal(mesh.points.length, 3 * 125);
  assert.equal(mesh.generatorTet.length, 125);
  assert.equal(mesh.points.buffer, mesh.cells.buffer);  // no copies
  for (const vertex of mesh.cells) assert.ok(vertex < 125);
  assert.equal(mesh.scaledJacobians.length, 0);
  const { quality, validity } = hexhex.certify(mesh);
  assert.equal(validity.positive, 64);
  assert.equal(Math.min(...mesh.scaledJacobians), quality.minimum);
});

test("a map of arrays is the map whose arrays they are", () => {
  const map = hexhex.generate("star", { valence: 7, charts: "random" });
  const [points, tets, parameters] = [map.points.slice(), map.tets.slice(), map.parameters.slice()];
  const again = hexhex.makeMap(points, tets, parameters);
  assert.deepEqual(hexhex.check(again), hexhex.check(map));
  assert.deepEqual(hexhex.writeMesh(hexhex.extract(again), "a.ovmb"), hexhex.writeMesh(hexhex.extract(map), "a.ovmb"));
  assert.throws(() => hexhex.makeMap(points, tets, points), RangeError);
});

test("verification fails for another mesh", () => {
  const map = hexhex.generate("sphere");
  const mesh = hexhex.extract(map, { scale: 2 });
  assert.ok(hexhex.verify(mesh, map, { scale: 2 }).passed);
  assert.ok(!hexhex.verify(mesh, map).passed);
  mesh.points[0] += 1;
  assert.ok(!hexhex.verify(mesh, map, { scale: 2 }).passed);
});

test("files are what their content says", () => {
  const map = hexhex.generate("torus");
  const file = hexhex.writeMap(map, "torus.ovm");
  const read = hexhex.read(file, "torus.ovm");
  assert.ok(read instanceof TetMap);
  assert.deepEqual(read.parameters, map.parameters);
  const mesh = hexhex.read(hexhex.writeMesh(hexhex.extract(map), "torus.msh"), "torus.msh");
  assert.ok(mesh instanceof HexMesh);
  assert.ok(hexhex.verify(mesh, map).passed);
  const packed = hexhex.writeMesh(mesh, "torus.vtu", { compress: true });
  assert.ok(packed.length < hexhex.writeMesh(mesh, "torus.vtu").length);
  assert.deepEqual(hexhex.readMesh(packed, "torus.vtu").points, mesh.points);
});

test("a seamless map is told apart, and quantized", () => {
  const map = hexhex.generate("cylinder", { stretch: 0.3 });
  const report = hexhex.check(map);
  assert.equal(report.valid, false);
  assert.equal(report.kind, hexhex.canQuantize ? "seamless" : "neither");
  const quantized = hexhex.quantize(map, { cells: 500 });
  assert.equal(quantized.report.integers_by, "rounding");
  assert.ok(hexhex.check(quantized.map).valid);
  assert.ok(hexhex.verify(hexhex.extract(quantized.map), quantized.map).passed);
});

test("tets without a map become a mesh", () => {
  const solid = hexhex.generate("cylinder");
  const tets = hexhex.makeMap(solid.points, solid.tets);
  assert.equal(tets.parameters.length, 0);
  assert.throws(() => hexhex.extract(tets), (error) => error instanceof HexhexError);
  const volume = volumeOf(solid.points, solid.tets, [[0, 1, 2, 3]]);
  for (const method of ["frames", "polycube"]) {
    const { mesh, map, report } = hexhex.mesh(tets, { cells: 300, method });
    assert.equal(report.map.method, method);
    assert.equal(report.quantization.integers_by, "rounding");  // HiGHS is not built in
    assert.equal(report.quantization.cells_wanted, 300);
    const cells = report.quantization.cells + report.improvement.added_cells;
    assert.equal(mesh.cells.length, 8 * cells);
    assert.ok(report.verification.passed);
    // Certified: by the improvement, and once more, of the file that it was written to.
    assert.equal(report.improvement.not_positive.length, 0);
    assert.equal(mesh.scaledJacobians.length, cells);
    assert.deepEqual(hexhex.certify(mesh), report.improvement.after);
    const again = hexhex.readMesh(hexhex.writeMesh(mesh, "c.vtu"), "c.vtu");
    assert.equal(hexhex.certify(again).validity.positive, cells);
    // It fills the solid, and its cells are those of its map, but for layers that were added.
    const six = [[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]];
    assert.ok(Math.abs(volumeOf(mesh.points, mesh.cells, six, 8) / volume - 1) < 0.03);
    assert.ok(hexhex.check(map).valid);
    const ofMap = hexhex.extract(map).cells;
    assert.equal(ofMap.length, 8 * report.quantization.cells);
    if (report.improvement.added_cells === 0) assert.deepEqual(ofMap, mesh.cells);
  }
  for (const options of [{}, { cells: 9, edgeLength: 1 }, { cells: -1 }, { cells: 9, method: "magic" }]) {
    assert.throws(() => hexhex.mesh(tets, options), (error) => error.code === "InvalidArgument");
  }
});

/** Of cells of `size` vertices, each cut into tets. */
function volumeOf(points, cells, tets, size = 4) {
  let sum = 0;
  for (let cell = 0; cell < cells.length; cell += size) {
    for (const corners of tets) {
      const [o, a, b, c] = corners.map((k) => points.subarray(3 * cells[cell + k], 3 * cells[cell + k] + 3));
      const [u, v, w] = [a, b, c].map((p) => p.map((x, axis) => x - o[axis]));
      sum += u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) + u[2] * (v[0] * w[1] - v[1] * w[0]);
    }
  }
  return Math.abs(sum) / 6;
}

test("tets are read from files that hold no map", () => {
  const solid = hexhex.generate("box", { refine: 2 });
  // Medit's format, as tet meshers write it.
  const rows = (array, size, last, add) => Array.from({ length: array.length / size }, (_, i) =>
    [...array.subarray(size * i, size * (i + 1))].map((x) => x + add).join(" ") + last).join("\n");
  const file = new TextEncoder().encode(`MeshVersionFormatted 2\nDimension 3\nVertices\n${solid.points.length / 3}\n` +
    `${rows(solid.points, 3, " 0", 0)}\nTetrahedra\n${solid.tets.length / 4}\n${rows(solid.tets, 4, " 0", 1)}\nEnd\n`);
  assert.throws(() => hexhex.readMap(file, "box.mesh"), HexhexError);
  const tets = hexhex.readTets(file, "box.mesh");
  assert.deepEqual(tets.tets, solid.tets);
  assert.deepEqual(tets.points, solid.points);
  const { mesh, report } = hexhex.mesh(tets, { cells: 64, pillow: "always" });
  assert.equal(mesh.cells.length, 8 * (64 + 6 * 16));
  assert.equal(report.improvement.added_cells, 6 * 16);
});

test("errors have a code, a sentence and a place", () => {
  const broken = hexhex.generate("sphere", { defects: 3 });
  assert.throws(() => hexhex.extract(broken), (error) =>
    error instanceof HexhexError && error.code === "FlippedTet" && error.place.kind === "tet");
  const text = new TextEncoder().encode("2\n0 0 0\nnonsense\n0\n");
  assert.throws(() => hexhex.readMap(text, "a.hexex"), (error) =>
    error.code === "FileSyntax" && error.place.kind === "line" && error.place.index === 3 && error.message.startsWith("a.hexex"));
  assert.throws(() => hexhex.readMap(text, "a.txt"), (error) => error.code === "FileUnsupported");
  assert.throws(() => hexhex.readMap(new Uint8Array(0), "a.hexex"), (error) => error.code === "FileSyntax");
  assert.throws(() => hexhex.generate("cow"), (error) => error.code === "InvalidArgument");
  assert.throws(() => hexhex.generate("box", { cells: "many" }), (error) => error.code === "InvalidArgument");
  for (const scale of [0, 1.5, 2 ** 31, 2 ** 32 + 1, -(2 ** 32) + 1, "2", NaN]) {
    assert.throws(() => hexhex.extract(hexhex.generate("box"), { scale }), (error) => error.code === "InvalidArgument");
  }
});

test("sizes that files tell may have more than 32 bits", () => {
  const text = (line) => new TextEncoder().encode(line);
  const binary = (...values) => new Uint8Array(new Int32Array(values).buffer);
  // 1 + tags + nodes integers of four bytes: 2^32 in all.
  const file = Buffer.concat([text("$MeshFormat\n2.2 1 8\n"), binary(1), text("\n$EndMeshFormat\n$Nodes\n1\n"),
    new Uint8Array(28).fill(1, 0, 1), text("\n$EndNodes\n$Elements\n1\n"), binary(5, 1, 2 ** 30 - 9, 0),
    text("\n$EndElements\n")]);
  assert.throws(() => hexhex.readMesh(file, "a.msh"), (error) => error.code === "FileSyntax" && /room/.test(error.message));
});

test("what was freed cannot be used", () => {
  const map = hexhex.generate("box");
  map.free();
  map.free();
  assert.throws(() => hexhex.check(map), (error) => error.code === "InvalidArgument");
});

test("memory that does not suffice is an error, and the library lives on", () => {
  const map = hexhex.generate("box", { cells: 10 });
  assert.throws(() => hexhex.extract(map, { scale: 70 }), (error) =>
    error.code === "OutOfMemory" || error.code === "TooLarge");
  assert.ok(hexhex.verify(hexhex.extract(map), map).passed);
});

test("progress is told", () => {
  const stages = new Set();
  hexhex.onProgress = (stage, share) => {
    assert.ok(share >= 0 && share <= 1);
    stages.add(stage);
  };
  hexhex.extract(hexhex.generate("sphere"), { scale: 3 });
  hexhex.onProgress = undefined;
  assert.ok(stages.size > 2, [...stages].join());
});

test("the page of `hexhex view`", () => {
  const mesh = hexhex.extract(hexhex.generate("box"));
  const page = new TextDecoder().decode(hexhex.writePage(mesh, { title: "<b>box</b>" }));
  assert.ok(page.startsWith("<!doctype html>"));
  assert.ok(!page.includes("<b>box</b>"));
});
