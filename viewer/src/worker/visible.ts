// Which cells are kept, and the faces by which one sees them.
import { kQualitySteps } from "../format";
import { kFaceCorners, kNone } from "./topology";

/** What is kept: cells that fulfil all of it. */
export interface Filter {
  /** The side of the plane with normal . centre <= offset, in scene coordinates; null: both. */
  plane: { normal: [number, number, number]; offset: number } | null;
  /** Cells from this layer on; layer 0 touches the boundary. */
  firstLayer: number;
  /** Scaled Jacobian, as stored, from and to, both included. */
  quality: [number, number];
  /** Cells that were taken away one by one. */
  dug: number[];
  /** The only cell to keep, whatever else is asked for, or null. */
  isolated: number | null;
}

export const kHistogramBins = 64;

export interface Visible {
  /**
   * Six numbers per quad: four vertices, the cell, and whether the quad is inside of the mesh (bit 0), its
   * feature (bits 1 to 16, 0: none), and on the boundary its patch (bits 17 to 31).
   */
  quads: Uint32Array<ArrayBuffer>;
  /** The same for the outline of what is not kept: the boundary, or the cells around a single one. */
  ghost: Uint32Array<ArrayBuffer>;
  /** What is known of the light on the quads at once, as in Occlusion. */
  light: Uint8Array<ArrayBuffer>;
  kept: number;
  /** Kept cells by quality, and all cells that fulfil the rest of the filter. */
  histogramKept: Uint32Array<ArrayBuffer>;
  histogramCandidates: Uint32Array<ArrayBuffer>;
}

/** What tells which faces are between kept cells and others: only the whole mesh needs none of it. */
export interface Inside {
  centres: Float32Array;
  layers: Uint16Array<ArrayBuffer>;
  neighbours: Uint32Array;
}

export interface Mesh {
  cells: Uint32Array<ArrayBuffer>;
  quality: Uint16Array<ArrayBuffer>;
  /** The faces of the boundary: 6 * cell + face. */
  skin: Uint32Array;
  /** Of each of these the patch; empty: not known. */
  skinPatches: Uint32Array;
  /** Per face of a cell the feature of its quad, 1 and up; null if the mesh has none. */
  quadFeatures: Uint16Array | null;
}

const binOf = (quality: number) => (quality * kHistogramBins) >>> 16;

function markKept(mesh: Mesh, inside: Inside, filter: Filter, kept: Uint8Array, result: Visible): void {
  const { quality } = mesh;
  const { centres, layers } = inside;
  const [from, to] = filter.quality;
  const plane = filter.plane;
  const [x, y, z] = plane ? plane.normal : [0, 0, 0];
  const offset = plane ? plane.offset : 0;
  let count = 0;
  for (let cell = 0; cell < kept.length; ++cell) {
    kept[cell] = 0;
    if (layers[cell]! < filter.firstLayer) continue;
    const at = 3 * cell;
    if (x * centres[at]! + y * centres[at + 1]! + z * centres[at + 2]! > offset) continue;
    const value = quality[cell]!;
    const bin = binOf(value);
    ++result.histogramCandidates[bin]!;
    if (value < from || value > to) continue;
    ++result.histogramKept[bin]!;
    kept[cell] = 1;
    ++count;
  }
  for (const cell of filter.dug) {
    if (kept[cell] !== 1) continue;
    kept[cell] = 0;
    --count;
    --result.histogramKept[binOf(quality[cell]!)]!;
  }
  if (filter.isolated !== null) {
    kept.fill(0);
    kept[filter.isolated] = count = 1;
  }
  result.kept = count;
}

/** Where a face is in the skin, which is sorted. */
function placeInSkin(skin: Uint32Array, face: number): number {
  let from = 0;
  for (let to = skin.length; from < to;) {
    const middle = (from + to) >> 1;
    if (skin[middle]! < face) from = middle + 1;
    else to = middle;
  }
  return from;
}

/** @param inside  null: the faces are those of the skin */
function quadsOf(mesh: Mesh, inside: Inside | null, faces: ArrayLike<number>): Uint32Array<ArrayBuffer> {
  const quads = new Uint32Array(6 * faces.length);
  let next = 0;
  for (let i = 0; i < faces.length; ++i) {
    const face = faces[i]!;
    const cell = Math.floor(face / 6);
    const corner = 4 * (face - 6 * cell);
    for (let k = 0; k < 4; ++k) quads[next++] = mesh.cells[8 * cell + kFaceCorners[corner + k]!]!;
    quads[next++] = cell;
    const feature = mesh.quadFeatures ? mesh.quadFeatures[face]! : 0;
    const isInside = inside !== null && inside.neighbours[face] !== kNone;
    const patch = isInside || mesh.skinPatches.length === 0
      ? 0
      : mesh.skinPatches[inside === null ? i : placeInSkin(mesh.skin, face)]!;
    quads[next++] = (patch << 17) | (feature << 1) | Number(isInside);
  }
  return quads;
}

/** The faces between marked cells and others. */
function facesAround({ neighbours }: Inside, marked: Uint8Array): number[] {
  const faces: number[] = [];
  for (let cell = 0; cell < marked.length; ++cell) {
    if (marked[cell] === 0) continue;
    for (let face = 6 * cell; face < 6 * cell + 6; ++face) {
      const neighbour = neighbours[face]!;
      if (neighbour === kNone || marked[neighbour] === 0) faces.push(face);
    }
  }
  return faces;
}

/** The outline of all cells that have a vertex of this cell. */
function facesAroundRing(mesh: Mesh, inside: Inside, cell: number): number[] {
  const corners = mesh.cells.subarray(8 * cell, 8 * cell + 8);
  const ring = new Uint8Array(mesh.cells.length / 8);
  for (let i = 0; i < mesh.cells.length; ++i) {
    if (corners.includes(mesh.cells[i]!)) ring[i >>> 3] = 1;
  }
  return facesAround(inside, ring);
}

function nothingVisible(): Visible {
  return {
    quads: new Uint32Array(0),
    ghost: new Uint32Array(0),
    light: new Uint8Array(0),
    kept: 0,
    histogramKept: new Uint32Array(kHistogramBins),
    histogramCandidates: new Uint32Array(kHistogramBins),
  };
}

export function keepsAll({ plane, firstLayer, quality, dug, isolated }: Filter): boolean {
  const [from, to] = quality;
  return plane === null && firstLayer === 0 && from <= 0 && to >= kQualitySteps && dug.length === 0 &&
    isolated === null;
}

/** The same as findVisible() where all cells are kept. */
export function findWhole(mesh: Mesh): Visible {
  const result = nothingVisible();
  for (const value of mesh.quality) ++result.histogramKept[binOf(value)]!;
  result.histogramCandidates.set(result.histogramKept);
  result.kept = mesh.quality.length;
  result.quads = quadsOf(mesh, null, mesh.skin);
  return result;
}

/** Finds the faces between kept cells and all else. @param kept  room for one byte per cell */
export function findVisible(mesh: Mesh, inside: Inside, filter: Filter, kept: Uint8Array): Visible {
  const result = nothingVisible();
  markKept(mesh, inside, filter, kept, result);
  result.quads = quadsOf(mesh, inside, facesAround(inside, kept));
  const ghost = filter.isolated === null
    ? mesh.skin.filter((face) => kept[Math.floor(face / 6)] === 0)
    : facesAroundRing(mesh, inside, filter.isolated);
  result.ghost = quadsOf(mesh, inside, ghost);
  return result;
}
