// The worker: decodes the mesh, and finds the faces to draw while the page stays fluid.
import type { CurvedCells } from "../curves";
import { decodeBase64, decodeChunk, inflate, type MeshInfo, type TableInfo } from "../format";
import { type Moment, Moments } from "../moments";
import { kTextureWidth, sceneOf } from "../scene_box";
import { curvedFaces } from "./curved_faces";
import type { FromWorker, LoadedMesh, ToWorker, Wanted } from "./messages";
import { carriedLight, Occlusion } from "./occlusion";
import { findCreases, findLayers, findNeighbours, kFaceCorners } from "./topology";
import { findVisible, findWhole, type Inside, keepsAll, type Mesh } from "./visible";

// The library for pages types `self` as a window; this is all that is used of it.
const worker = self as unknown as {
  onmessage: ((event: MessageEvent<ToWorker>) => void) | null;
  postMessage(message: FromWorker, transfer?: Transferable[]): void;
};

let info: MeshInfo;
const tables = new Map<string, Uint32Array<ArrayBuffer>>();
let pending: Promise<void> = Promise.resolve();
let received = 0;
let mesh: Mesh;
let moments: Moments;
/** Found when it is needed, or when there is nothing else to do. */
let inside: Inside | null = null;
let kept: Uint8Array;
let curvedCells: CurvedCells;
/** What is on the screen, and what is known of its light. */
let lit = { quads: new Uint32Array(0), light: new Uint8Array(0) };

/** Milliseconds of work after which the worker listens again. */
const kPieceOfWork = 30;

function tell(message: FromWorker, transfer: Transferable[] = []): void {
  worker.postMessage(message, transfer);
}

function tableInfo(name: string): TableInfo | undefined {
  return info.tables.find((table) => table.name === name);
}

/** The numbers of a table; without elements if the page does not have it. */
function takeTable(name: string): Uint32Array<ArrayBuffer> {
  const table = tables.get(name) ?? new Uint32Array(0);
  tables.delete(name);
  return table;
}

async function decode(name: string, chunk: number, data: string): Promise<void> {
  const table = tableInfo(name)!;
  const packed = decodeBase64(data);
  if (packed.length !== table.chunkBytes[chunk]) throw new Error("The page is incomplete.");
  const first = chunk * table.rowsPerChunk;
  const rows = Math.min(table.rowsPerChunk, table.rows - first);
  decodeChunk(await inflate(packed), rows, table, tables.get(name)!, first);
  const total = info.tables.reduce((sum, each) => sum + each.chunkBytes.length, 0);
  tell({ kind: "progress", what: "Unpacking", share: ++received / total });
}

function decodePositions(stored: Uint32Array, kinds: Uint32Array): Float32Array<ArrayBuffer> {
  const { scale, centre } = sceneOf(info);
  // Rows of the texture are full.
  const positions = new Float32Array(4 * kTextureWidth * Math.ceil(info.points / kTextureWidth));
  for (let v = 0; v < info.points; ++v) {
    for (let axis = 0; axis < 3; ++axis) {
      const place = info.lower[axis]! + stored[3 * v + axis]! * info.step;
      positions[4 * v + axis] = (place - centre[axis]!) * scale;
    }
    positions[4 * v + 3] = v < kinds.length ? kinds[v]! : 0;
  }
  return positions;
}

/** @param suffix  of the names of its tables */
function decodeMoment(stored: Uint32Array, kinds: Uint32Array, suffix: string): Moment {
  return {
    positions: decodePositions(stored, kinds),
    quality: Uint16Array.from(takeTable(`quality${suffix}`)),
    notPositive: takeTable(`not_positive${suffix}`),
  };
}

function decodeMoments(): { after: Moment; before: Moment | null } {
  const stored = takeTable("points");
  const kinds = takeTable("generator_kinds");
  const after = decodeMoment(stored, kinds, "");
  if (!info.before) return { after, before: null };
  const added = takeTable("points_before");
  // Sums modulo 2^32.
  for (let i = 0; i < stored.length; ++i) stored[i] = stored[i]! + added[i]!;
  return { after, before: decodeMoment(stored, kinds, "_before") };
}

function findCentres(cells: Uint32Array, positions: Float32Array): Float32Array {
  const centres = new Float32Array((cells.length / 8) * 3);
  for (let cell = 0; cell < cells.length / 8; ++cell) {
    for (let axis = 0; axis < 3; ++axis) {
      let sum = 0;
      for (let k = 0; k < 8; ++k) sum += positions[4 * cells[8 * cell + k]! + axis]!;
      centres[3 * cell + axis] = sum / 8;
    }
  }
  return centres;
}

/** The tagged quads as numbers of features at the faces of the cells. */
function placeQuadFeatures(cells: Uint32Array): { places: Uint16Array | null; tags: number[] } {
  const stored = takeTable("feature_quads");
  if (stored.length === 0) return { places: null, tags: [] };
  const signed = Int32Array.from(stored);
  const tags: number[] = [];
  const numbers = new Map<number, number>();
  const byVertices = new Map<string, number>();
  const keyOf = (vertices: number[]) => vertices.sort((a, b) => a - b).join();
  for (let i = 0; i < stored.length; i += 5) {
    const tag = signed[i + 4]!;
    if (!numbers.has(tag)) numbers.set(tag, tags.push(tag));
    byVertices.set(keyOf([...stored.subarray(i, i + 4)]), numbers.get(tag)!);
  }
  // Only faces whose vertices all belong to tagged quads need the slow look-up.
  const tagged = new Uint8Array(info.vertices);
  for (let i = 0; i < stored.length; ++i) if (i % 5 < 4) tagged[stored[i]!] = 1;
  const places = new Uint16Array((cells.length / 8) * 6);
  for (let face = 0; face < places.length; ++face) {
    const base = Math.floor(face / 6) * 8;
    const vertices = [0, 1, 2, 3].map((i) => cells[base + kFaceCorners[(face % 6) * 4 + i]!]!);
    if (vertices.some((vertex) => tagged[vertex] === 0)) continue;
    places[face] = byVertices.get(keyOf(vertices)) ?? 0;
  }
  return { places, tags };
}

/** The regions of cells as places in a list of their numbers. */
function numberRegions(): { places: Uint32Array<ArrayBuffer>; tags: number[] } {
  const stored = takeTable("regions");
  const signed = Int32Array.from(stored);
  const tags = [...new Set(signed)].sort((a, b) => a - b);
  const numbers = new Map(tags.map((tag, i) => [tag, i + 1]));
  return { places: stored.map((_, cell) => numbers.get(signed[cell]!)!), tags };
}

function finish(): void {
  const cells = takeTable("cells");
  const ends = decodeMoments();
  moments = new Moments(ends.after, ends.before);
  const nodes = takeTable("nodes");
  const regions = numberRegions();
  const features = placeQuadFeatures(cells);
  mesh = { cells, quality: moments.quality, skin: takeTable("skin"),
    skinPatches: takeTable("skin_patches"), quadFeatures: features.places };
  kept = new Uint8Array(info.cells);
  curvedCells = { order: info.order, cells, nodes, positions: moments.positions };
  const loaded: LoadedMesh = {
    ...ends,
    cells,
    order: info.order,
    nodes,
    regions: regions.places,
    regionTags: regions.tags,
    creases: findCreases(cells, mesh.skin, moments.positions),
    singularEdges: takeTable("singular_edges"),
    featureEdges: takeTable("feature_edges"),
    quadTags: features.tags,
  };
  tell({ kind: "loaded", mesh: loaded }, [
    loaded.creases.buffer,
    loaded.singularEdges.buffer,
    loaded.featureEdges.buffer,
    loaded.regions.buffer,
  ]);
}

function handle(message: ToWorker): void | Promise<void> {
  switch (message.kind) {
    case "begin":
      info = message.info;
      for (const table of info.tables) {
        tables.set(table.name, new Uint32Array(table.rows * table.columns));
      }
      return;
    case "chunk":
      return decode(message.table, message.chunk, message.data);
    case "end":
      return finish();
    case "show":
      return show(message);
  }
}

/** Who touches whom, and where: what every filter needs. */
function lookInside(): Inside {
  if (inside) return inside;
  const neighbours = findNeighbours(mesh.cells, info.vertices);
  const layers = findLayers(neighbours);
  const centres = findCentres(mesh.cells, curvedCells.positions);
  inside = { neighbours, centres, layers: layers.ofCells };
  tell({ kind: "layers", layers });
  return inside;
}

function show({ filter, curved: curvedWanted, moment }: Wanted): void {
  const begin = performance.now();
  if (moments.show(moment)) {
    mesh.quality = moments.quality;
    if (inside) inside.centres = findCentres(mesh.cells, curvedCells.positions);
  }
  const visible = keepsAll(filter) ? findWhole(mesh) : findVisible(mesh, lookInside(), filter, kept);
  const curved = curvedWanted ? curvedFaces(curvedCells, visible.quads) : null;
  visible.light = carriedLight(lit.quads, lit.light, visible.quads);
  lit = { quads: visible.quads.slice(), light: visible.light.slice() };
  const buffers = [visible.quads.buffer, visible.ghost.buffer, visible.light.buffer];
  if (curved) buffers.push(curved.points.buffer);
  tell({ kind: "visible", visible, curved, milliseconds: performance.now() - begin }, buffers);
  light(new Occlusion(lit.quads, curvedCells.positions));
}

/** Finds the light in pieces, and gives up when something else is to be shown. */
function light(occlusion: Occlusion): void {
  if (occlusion.quads !== lit.quads) return;
  occlusion.work(kPieceOfWork);
  if (!occlusion.finished) {
    setTimeout(() => light(occlusion));
    return;
  }
  lit.light = occlusion.shares;
  tell({ kind: "lit", light: occlusion.shares });
  setTimeout(lookInside);
}

worker.onmessage = (event) => {
  // One after the other, although unpacking is asynchronous.
  pending = pending
    .then(() => handle(event.data))
    .catch((error: unknown) => tell({ kind: "failed", message: String(error) }));
};
