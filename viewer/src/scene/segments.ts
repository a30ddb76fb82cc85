// Which edges of a mesh are drawn as lines, and in which colours.
import { featureColour, kBadColour, valenceColour } from "../colours";
import { kCellEdges } from "../curves";
import type { Moments } from "../moments";
import type { Segments } from "./lines";

export function singularSegments(edges: Uint32Array, boundary: boolean): Segments {
  const segments: Segments = { vertices: [], colours: [] };
  for (let i = 0; i < edges.length; i += 3) {
    const code = edges[i + 2]!;
    if ((code & 1) !== Number(boundary)) continue;
    segments.vertices.push(edges[i]!, edges[i + 1]!);
    segments.colours.push(valenceColour(code >> 1, boundary));
  }
  return segments;
}

export function featureSegments(edges: Uint32Array): Segments {
  const tags = new Map<number, number>();
  const segments: Segments = { vertices: [], colours: [] };
  for (let i = 0; i < edges.length; i += 3) {
    const tag = edges[i + 2]!;
    if (!tags.has(tag)) tags.set(tag, tags.size);
    segments.vertices.push(edges[i]!, edges[i + 1]!);
    segments.colours.push(featureColour(tags.get(tag)!));
  }
  return segments;
}

/** Edges of the worst cells that are not positive: of so many that they can still be told apart. */
export function badSegments(cells: Uint32Array, { notPositive, quality }: Moments): Segments {
  const segments: Segments = { vertices: [], colours: [] };
  for (const cell of notPositive.slice().sort((a, b) => quality[a]! - quality[b]!).subarray(0, 100)) {
    for (const corner of kCellEdges) segments.vertices.push(cells[8 * cell + corner]!);
    for (let edge = 0; edge < 12; ++edge) segments.colours.push(kBadColour);
  }
  return segments;
}
