// Who touches whom: the cell across each face, and how deep inside each cell lies.

/** Corners of the faces of a cell, counter-clockwise seen from outside, in VTK's order. */
export const kFaceCorners = [
  0, 4, 7, 3, 1, 2, 6, 5, 0, 1, 5, 4, 3, 7, 6, 2, 0, 3, 2, 1, 4, 5, 6, 7,
] as const;

export const kNone = 0xffffffff;

/** Corner numbers of the smallest vertex of a face, of the next, the opposite and the previous. */
function smallestCorner(cells: Uint32Array, face: number): number {
  const cell = Math.floor(face / 6) * 8;
  const corners = (face % 6) * 4;
  let best = 0;
  let smallest = cells[cell + kFaceCorners[corners]!]!;
  for (let i = 1; i < 4; ++i) {
    const vertex = cells[cell + kFaceCorners[corners + i]!]!;
    if (vertex < smallest) {
      smallest = vertex;
      best = i;
    }
  }
  return best;
}

function faceVertex(cells: Uint32Array, face: number, i: number): number {
  return cells[Math.floor(face / 6) * 8 + kFaceCorners[(face % 6) * 4 + (i & 3)]!]!;
}

/** Whether two faces with the same smallest vertex have the same vertices. */
function sameFace(cells: Uint32Array, a: number, b: number): boolean {
  const i = smallestCorner(cells, a);
  const j = smallestCorner(cells, b);
  if (faceVertex(cells, a, i + 2) !== faceVertex(cells, b, j + 2)) return false;
  const next = faceVertex(cells, a, i + 1);
  const previous = faceVertex(cells, a, i + 3);
  const otherNext = faceVertex(cells, b, j + 1);
  const otherPrevious = faceVertex(cells, b, j + 3);
  return (
    (next === otherPrevious && previous === otherNext) ||
    (next === otherNext && previous === otherPrevious)
  );
}

/**
 * The neighbour of each cell across each face (6 per cell), kNone on the boundary. Linear time:
 * equal faces have the same smallest vertex, and few faces share it.
 */
export function findNeighbours(cells: Uint32Array, vertexCount: number): Uint32Array {
  const faceCount = (cells.length / 8) * 6;
  const neighbours = new Uint32Array(faceCount).fill(kNone);
  const ends = new Uint32Array(vertexCount + 1);
  const keyOf = (face: number) => faceVertex(cells, face, smallestCorner(cells, face));
  for (let face = 0; face < faceCount; ++face) ++ends[keyOf(face)]!;
  let sum = 0;
  for (let v = 0; v <= vertexCount; ++v) {
    const count = ends[v]!;
    ends[v] = sum;
    sum += count;
  }
  const faces = new Uint32Array(faceCount);
  for (let face = 0; face < faceCount; ++face) faces[ends[keyOf(face)]!++] = face;

  let begin = 0;
  for (let v = 0; v < vertexCount; ++v) {
    const end = ends[v]!;
    for (let i = begin; i < end; ++i) {
      const face = faces[i]!;
      if (neighbours[face] !== kNone) continue;
      for (let j = i + 1; j < end; ++j) {
        const other = faces[j]!;
        if (neighbours[other] !== kNone || !sameFace(cells, face, other)) continue;
        neighbours[face] = Math.floor(other / 6);
        neighbours[other] = Math.floor(face / 6);
        break;
      }
    }
    begin = end;
  }
  return neighbours;
}

export interface Layers {
  /** Of each cell: 0 at the boundary, otherwise one more than its outermost neighbour's. */
  ofCells: Uint16Array<ArrayBuffer>;
  deepest: number;
}

export function findLayers(neighbours: Uint32Array): Layers {
  const cellCount = neighbours.length / 6;
  const layers = new Uint16Array(cellCount).fill(0xffff);
  const queue = new Uint32Array(cellCount);
  let queued = 0;
  for (let cell = 0; cell < cellCount; ++cell) {
    for (let f = 0; f < 6; ++f) {
      if (neighbours[cell * 6 + f] !== kNone) continue;
      layers[cell] = 0;
      queue[queued++] = cell;
      break;
    }
  }
  let deepest = 0;
  for (let i = 0; i < queued; ++i) {
    const cell = queue[i]!;
    deepest = layers[cell]!;
    for (let f = 0; f < 6; ++f) {
      const next = neighbours[cell * 6 + f]!;
      if (next === kNone || layers[next] !== 0xffff) continue;
      layers[next] = deepest + 1;
      queue[queued++] = next;
    }
  }
  return { ofCells: layers, deepest };
}

/** The cosine of the angle from which on an edge of the boundary is sharp: 40 degrees. */
const kSharp = 0.77;

/**
 * The sharp edges of the boundary, two vertices each. Neighbouring quads run through their common
 * edge in opposite directions.
 */
export function findCreases(
  cells: Uint32Array,
  skin: Uint32Array,
  positions: Float32Array,
): Uint32Array<ArrayBuffer> {
  const edges: number[] = [];
  const normals = new Float32Array(3 * skin.length);
  const open = new Map<number, number>();
  skin.forEach((face, place) => {
    const at = [0, 1, 2, 3].map((i) => 4 * faceVertex(cells, face, i));
    const [ax, ay, az] = [0, 1, 2].map((k) => positions[at[2]! + k]! - positions[at[0]! + k]!);
    const [bx, by, bz] = [0, 1, 2].map((k) => positions[at[3]! + k]! - positions[at[1]! + k]!);
    const normal = [ay! * bz! - az! * by!, az! * bx! - ax! * bz!, ax! * by! - ay! * bx!];
    const length = Math.hypot(...normal) || 1;
    normal.forEach((n, k) => (normals[3 * place + k] = n / length));
    for (let i = 0; i < 4; ++i) {
      const a = at[i]! / 4;
      const b = at[(i + 1) & 3]! / 4;
      const other = open.get(b * 2 ** 24 + a);
      if (other === undefined) {
        open.set(a * 2 ** 24 + b, place);
        continue;
      }
      open.delete(b * 2 ** 24 + a);
      let cosine = 0;
      for (let k = 0; k < 3; ++k) cosine += normals[3 * place + k]! * normals[3 * other + k]!;
      if (cosine < kSharp) edges.push(a, b);
    }
  });
  return new Uint32Array(edges);
}
