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
