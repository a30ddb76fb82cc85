// Cells of order p: which nodes their edges and faces have, and places in between.
import { kFaceCorners } from "./worker/topology";

/** Corners of the twelve edges of a cell, in VTK's numbering. */
export const kCellEdges = [
  0, 1, 1, 2, 3, 2, 0, 3, 4, 5, 5, 6, 7, 6, 4, 7, 0, 4, 1, 5, 3, 7, 2, 6,
] as const;

const kCornerPlaces = [
  [0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1],
] as const;

/** What a drawn mesh of any order needs; `nodes` is empty for order 1. */
export interface CurvedCells {
  order: number;
  cells: Uint32Array;
  /** Per cell the nodes on its faces without its corners, as src/view/mesh_tables.hpp says. */
  nodes: Uint32Array;
  /** Four numbers per vertex or node, of which the first three are its position. */
  positions: Float32Array;
}

/** Numbers of nodes in the row of a cell: 0 to 7 are its corners, from 8 on entries of `nodes`. */
export class NodeTable {
  readonly perCell: number;
  private readonly places: Int32Array;

  constructor(readonly order: number) {
    const n = order + 1;
    this.places = new Int32Array(n ** 3).fill(-1);
    kCornerPlaces.forEach(([x, y, z], corner) => {
      this.places[(x + n * (y + n * z)) * order] = corner;
    });
    let next = 8;
    for (let place = 0; place < n ** 3; ++place) {
      const indices = [place % n, Math.floor(place / n) % n, Math.floor(place / n ** 2)];
      const onFace = indices.some((index) => index === 0 || index === order);
      if (onFace && this.places[place]! < 0) this.places[place] = next++;
    }
    this.perCell = next - 8;
  }

  /** The nodes from corner `from` to corner `to`, both included. */
  edge(from: number, to: number): number[] {
    return Array.from({ length: this.order + 1 }, (_, t) => this.at(from, from, to, 0, t));
  }

  /** The nodes of a face, row by row: from its corner 0 to 1, and with rows on to its corner 3. */
  face(face: number): number[] {
    const [origin, right, , up] = [0, 1, 2, 3].map((i) => kFaceCorners[4 * face + i]!);
    const n = this.order + 1;
    return Array.from({ length: n * n }, (_, i) =>
      this.at(origin!, right!, up!, i % n, Math.floor(i / n)));
  }

  /** `a` steps from a corner to a second one, and `b` steps towards a third. */
  private at(origin: number, second: number, third: number, a: number, b: number): number {
    const n = this.order + 1;
    const place = [0, 1, 2].map((axis) => {
      const begin = kCornerPlaces[origin]![axis]!;
      const right = kCornerPlaces[second]![axis]! - begin;
      const up = kCornerPlaces[third]![axis]! - begin;
      return begin * this.order + a * right + b * up;
    });
    return this.places[place[0]! + n * (place[1]! + n * place[2]!)]!;
  }
}

/** The vertex or node that an entry of NodeTable means in a cell. */
export function nodeOf(mesh: CurvedCells, perCell: number, cell: number, entry: number): number {
  return entry < 8 ? mesh.cells[8 * cell + entry]! : mesh.nodes[perCell * cell + entry - 8]!;
}

/** Lagrange's polynomials of equidistant nodes at `pieces` + 1 places: a row of weights for each. */
export function weightsAt(order: number, pieces: number): Float64Array[] {
  return Array.from({ length: pieces + 1 }, (_, place) => {
    const x = (place / pieces) * order;
    return Float64Array.from({ length: order + 1 }, (_unused, i) => {
      let weight = 1;
      for (let j = 0; j <= order; ++j) if (j !== i) weight *= (x - j) / (i - j);
      return weight;
    });
  });
}

/** Pieces along an edge that look smooth. */
export function finestPieces(order: number): number {
  return order === 1 ? 1 : Math.min(2 * order, 10);
}

/** Edges between vertices as curves. */
export class EdgeCurves {
  readonly pieces: number;
  private readonly table: NodeTable;
  private readonly weights: Float64Array[];
  /** Per edge that can be asked for: 12 * cell + its number there. */
  private readonly places = new Map<number, number>();

  constructor(private readonly mesh: CurvedCells) {
    this.table = new NodeTable(mesh.order);
    this.pieces = finestPieces(mesh.order);
    this.weights = weightsAt(mesh.order, this.pieces);
  }

  /** Finds the cells of edges, given by two vertices each, so that they can be asked for. */
  find(vertices: ArrayLike<number>): void {
    const { cells, positions } = this.mesh;
    const wanted = new Uint8Array(positions.length / 4);
    const missing = new Set<number>();
    for (let i = 0; i < vertices.length; i += 2) {
      const key = keyOf(vertices[i]!, vertices[i + 1]!);
      if (this.places.has(key)) continue;
      missing.add(key);
      wanted[vertices[i]!] = wanted[vertices[i + 1]!] = 1;
    }
    for (let cell = 0; cell < cells.length / 8 && missing.size > 0; ++cell) {
      for (let edge = 0; edge < 12; ++edge) {
        const a = cells[8 * cell + kCellEdges[2 * edge]!]!;
        const b = cells[8 * cell + kCellEdges[2 * edge + 1]!]!;
        if (wanted[a] === 0 || wanted[b] === 0) continue;
        const key = keyOf(a, b);
        if (missing.delete(key)) this.places.set(key, 12 * cell + edge);
      }
    }
  }

  /** Writes the points of an edge, three numbers each, `pieces` + 1 of them. */
  write(from: number, to: number, points: Float32Array, at: number): void {
    const { cells, positions } = this.mesh;
    const place = this.places.get(keyOf(from, to));
    // A tagged edge may be none of any cell; it is straight.
    const cell = place === undefined ? 0 : Math.floor(place / 12);
    const edge = place === undefined ? 0 : place % 12;
    let entries = this.table.edge(kCellEdges[2 * edge]!, kCellEdges[2 * edge + 1]!);
    if (cells[8 * cell + entries[0]!] !== from) entries = entries.reverse();
    const nodes = entries.map((entry) => nodeOf(this.mesh, this.table.perCell, cell, entry));
    this.weights.forEach((weights, i) => {
      for (let axis = 0; axis < 3; ++axis) {
        let sum = 0;
        if (place === undefined) {
          const t = i / this.pieces;
          sum = (1 - t) * positions[4 * from + axis]! + t * positions[4 * to + axis]!;
        } else {
          for (let k = 0; k < nodes.length; ++k) sum += weights[k]! * positions[4 * nodes[k]! + axis]!;
        }
        points[at + 3 * i + axis] = sum;
      }
    });
  }
}

/** Vertices are fewer than 2^24, so this is exact. */
function keyOf(a: number, b: number): number {
  return Math.min(a, b) * 2 ** 24 + Math.max(a, b);
}
