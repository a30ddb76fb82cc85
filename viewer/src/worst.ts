// The worst of the cells that a filter keeps, and where it is.
import type { Moments } from "./moments";
import type { Layers } from "./worker/topology";
import type { Filter } from "./worker/visible";

type Triple = [number, number, number];

function centreOf(cells: Uint32Array, { positions }: Moments, cell: number): Triple {
  const sum: Triple = [0, 0, 0];
  for (let k = 0; k < 8; ++k) {
    const at = 4 * cells[8 * cell + k]!;
    for (let axis = 0; axis < 3; ++axis) sum[axis]! += positions[at + axis]! / 8;
  }
  return sum;
}

/** A ball around the centre of a cell that holds its corners. */
export function ballAround(cells: Uint32Array, moments: Moments, cell: number): { centre: Triple; radius: number } {
  const centre = centreOf(cells, moments, cell);
  let radius = 0;
  for (let k = 0; k < 8; ++k) {
    const at = 4 * cells[8 * cell + k]!;
    radius = Math.max(radius, Math.hypot(...centre.map((x, axis) => moments.positions[at + axis]! - x)));
  }
  return { centre, radius };
}

/** @param layers  null if they are not known yet: all are kept then */
export function worstKept(
  cells: Uint32Array,
  moments: Moments,
  layers: Layers | null,
  { plane, firstLayer, quality: [from, to], dug }: Filter,
): number | null {
  const { quality } = moments;
  const gone = new Set(dug);
  let worst: number | null = null;
  for (let cell = 0; cell < quality.length; ++cell) {
    const value = quality[cell]!;
    if (value < from || value > to || (layers && layers.ofCells[cell]! < firstLayer)) continue;
    if ((worst !== null && value >= quality[worst]!) || gone.has(cell)) continue;
    if (plane) {
      const [x, y, z] = centreOf(cells, moments, cell);
      const along = plane.normal[0] * x + plane.normal[1] * y + plane.normal[2] * z;
      if (along > plane.offset) continue;
    }
    worst = cell;
  }
  return worst;
}
