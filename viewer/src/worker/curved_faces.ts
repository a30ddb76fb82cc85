// Faces of cells of order p, cut into small squares.
import { type CurvedCells, finestPieces, NodeTable, nodeOf, weightsAt } from "../curves";
import { kTextureWidth } from "../scene_box";
import { kFaceCorners } from "./topology";

/** Points of all faces that are drawn: 32 megabytes. Where there are more faces, each has fewer. */
const kMostPoints = 2 ** 21;

export interface CurvedFaces {
  /** Squares along a side of a face. */
  pieces: number;
  /** Per face (pieces + 1)^2 points of four numbers each, row by row; rows of a texture are full. */
  points: Float32Array<ArrayBuffer>;
}

/** As many pieces as look smooth, or as many as there is room for. */
function piecesFor(order: number, faces: number): number {
  const room = Math.floor(Math.sqrt(kMostPoints / Math.max(faces, 1))) - 1;
  return Math.min(Math.max(room, 1), finestPieces(order));
}

/** Which face of a cell begins with these two corners. */
function faceOf(cells: Uint32Array, cell: number, quads: Uint32Array, at: number): number {
  for (let face = 0; face < 6; ++face) {
    let same = true;
    for (let i = 0; i < 4 && same; ++i) {
      same = cells[8 * cell + kFaceCorners[4 * face + i]!] === quads[at + i];
    }
    if (same) return face;
  }
  throw new Error("A face is none of its cell.");
}

/** @param quads  as in Visible */
export function curvedFaces(mesh: CurvedCells, quads: Uint32Array): CurvedFaces {
  const { order, cells, positions } = mesh;
  const count = quads.length / 6;
  const pieces = piecesFor(order, count);
  const side = pieces + 1;
  const n = order + 1;
  const table = new NodeTable(order);
  const faces = [0, 1, 2, 3, 4, 5].map((face) => table.face(face));
  const weights = weightsAt(order, pieces);
  const rows = Math.max(1, Math.ceil((count * side * side) / kTextureWidth));
  const points = new Float32Array(4 * kTextureWidth * rows);
  // First along the rows of nodes, then across them.
  const along = new Float64Array(n * side * 3);
  let to = 0;
  for (let quad = 0; quad < count; ++quad) {
    const cell = quads[6 * quad + 4]!;
    const entries = faces[faceOf(cells, cell, quads, 6 * quad)]!;
    along.fill(0);
    for (let i = 0; i < n * n; ++i) {
      const node = 4 * nodeOf(mesh, table.perCell, cell, entries[i]!);
      const row = Math.floor(i / n) * side;
      for (let a = 0; a < side; ++a) {
        const weight = weights[a]![i % n]!;
        for (let axis = 0; axis < 3; ++axis) {
          along[3 * (row + a) + axis]! += weight * positions[node + axis]!;
        }
      }
    }
    for (let b = 0; b < side; ++b) {
      for (let a = 0; a < side; ++a, to += 4) {
        for (let axis = 0; axis < 3; ++axis) {
          let sum = 0;
          for (let row = 0; row < n; ++row) sum += weights[b]![row]! * along[3 * (row * side + a) + axis]!;
          points[to + axis] = sum;
        }
      }
    }
  }
  return { pieces, points };
}
