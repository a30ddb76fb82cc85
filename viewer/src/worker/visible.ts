// Which cells are kept, and the faces by which one sees them.
import { kFaceCorners, kNone } from "./topology";

/** What is kept: cells that fulfil all of it. */
export interface Filter {
  /** The side of the plane with normal . centre <= offset, in scene coordinates; null: both. */
  plane: { normal: [number, number, number]; offset: number } | null;
  /** Cells from this layer on; layer 0 touches the boundary. */
  firstLayer: number;
  /** Scaled Jacobian, as stored, from and to, both included. */
  quality: [number, number];
}

export const kHistogramBins = 64;

export interface Visible {
  /** Six numbers per quad: four vertices, the cell, and the feature of the quad (0: none). */
  quads: Uint32Array<ArrayBuffer>;
  kept: number;
  /** Kept cells by quality, and all cells that fulfil the rest of the filter. */
  histogramKept: Uint32Array<ArrayBuffer>;
  histogramCandidates: Uint32Array<ArrayBuffer>;
}

export interface Mesh {
  cells: Uint32Array<ArrayBuffer>;
  quality: Uint16Array<ArrayBuffer>;
  centres: Float32Array;
  layers: Uint16Array<ArrayBuffer>;
  neighbours: Uint32Array;
  /** Per face of a cell the feature of its quad, 1 and up; null if the mesh has none. */
  quadFeatures: Uint16Array | null;
}

function markKept(mesh: Mesh, filter: Filter, kept: Uint8Array, result: Visible): void {
  const { quality, centres, layers } = mesh;
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
    const bin = (value * kHistogramBins) >>> 16;
    ++result.histogramCandidates[bin]!;
    if (value < from || value > to) continue;
    ++result.histogramKept[bin]!;
    kept[cell] = 1;
    ++count;
  }
  result.kept = count;
}

function isOuter(mesh: Mesh, kept: Uint8Array, face: number): boolean {
  const neighbour = mesh.neighbours[face]!;
  return neighbour === kNone || kept[neighbour] === 0;
}

function countQuads(mesh: Mesh, kept: Uint8Array): number {
  let count = 0;
  for (let cell = 0; cell < kept.length; ++cell) {
    if (kept[cell] === 0) continue;
    for (let face = 6 * cell; face < 6 * cell + 6; ++face) {
      if (isOuter(mesh, kept, face)) ++count;
    }
  }
  return count;
}

/** Finds the faces between kept cells and all else. @param kept  room for one byte per cell */
export function findVisible(mesh: Mesh, filter: Filter, kept: Uint8Array): Visible {
  const result: Visible = {
    quads: new Uint32Array(0),
    kept: 0,
    histogramKept: new Uint32Array(kHistogramBins),
    histogramCandidates: new Uint32Array(kHistogramBins),
  };
  markKept(mesh, filter, kept, result);
  const quads = new Uint32Array(6 * countQuads(mesh, kept));
  let next = 0;
  for (let cell = 0; cell < kept.length; ++cell) {
    if (kept[cell] === 0) continue;
    for (let f = 0; f < 6; ++f) {
      if (!isOuter(mesh, kept, 6 * cell + f)) continue;
      for (let i = 0; i < 4; ++i) quads[next++] = mesh.cells[8 * cell + kFaceCorners[4 * f + i]!]!;
      quads[next++] = cell;
      quads[next++] = mesh.quadFeatures ? mesh.quadFeatures[6 * cell + f]! : 0;
    }
  }
  result.quads = quads;
  return result;
}
