// From a map to what is drawn of it: its boundary, and the places of its defects.
import type { CheckReport, Place } from "../src/types.js";
import type { MapShape } from "./messages.js";

/** Corners of a tet around the face opposite each corner, seen from outside. */
const kFaces = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]] as const;

/** Corners at the ends of a tet's edges. */
const kEdges = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]] as const;

function faceOf(tets: Uint32Array, face: number): [number, number, number] {
  const corners = kFaces[face & 3]!;
  const at = face - (face & 3);
  return [tets[at + corners[0]]!, tets[at + corners[1]]!, tets[at + corners[2]]!];
}

function smallestVertex(tets: Uint32Array, face: number): number {
  const corners = kFaces[face & 3]!;
  const at = face - (face & 3);
  return Math.min(tets[at + corners[0]]!, tets[at + corners[1]]!, tets[at + corners[2]]!);
}

/** Triangles that one tet alone has. Linear time: faces are sorted by their smallest vertex. */
export function boundaryTriangles(tets: Uint32Array, pointCount: number): Uint32Array<ArrayBuffer> {
  const ends = new Uint32Array(pointCount + 1);
  const smallest = (face: number) => smallestVertex(tets, face);
  for (let face = 0; face < tets.length; ++face) ++ends[smallest(face)]!;
  let sum = 0;
  for (let v = 0; v <= pointCount; ++v) {
    const count = ends[v]!;
    ends[v] = sum;
    sum += count;
  }
  const faces = new Uint32Array(tets.length);
  for (let face = 0; face < tets.length; ++face) faces[ends[smallest(face)]!++] = face;

  const boundary: number[] = [];
  let begin = 0;
  for (let v = 0; v < pointCount; ++v) {
    // By the other two vertices; -1 for a face that has been met again.
    const met = new Map<number, number>();
    for (let i = begin; i < ends[v]!; ++i) {
      const [a, b, c] = faceOf(tets, faces[i]!);
      const key = Math.max(a, b, c) * pointCount + (a + b + c - v - Math.max(a, b, c));
      met.set(key, met.has(key) ? -1 : faces[i]!);
    }
    for (const face of met.values()) if (face >= 0) boundary.push(...faceOf(tets, face));
    begin = ends[v]!;
  }
  return new Uint32Array(boundary);
}

/** Positions in the box of the scene. What is not finite is at the origin. */
function scenePositions(points: Float64Array): Float32Array<ArrayBuffer> {
  const lower = [Infinity, Infinity, Infinity];
  const upper = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < points.length; ++i) {
    const value = points[i]!;
    if (!Number.isFinite(value)) continue;
    lower[i % 3] = Math.min(lower[i % 3]!, value);
    upper[i % 3] = Math.max(upper[i % 3]!, value);
  }
  const longest = Math.max(...upper.map((value, axis) => value - lower[axis]!)) || 1;
  const positions = new Float32Array((points.length / 3) * 4);
  for (let i = 0; i < points.length; ++i) {
    const axis = i % 3;
    const value = (points[i]! - (lower[axis]! + upper[axis]!) / 2) / longest;
    positions[4 * Math.floor(i / 3) + axis] = Number.isFinite(value) ? value : 0;
  }
  return positions;
}

/** The edges of a place, two vertices each; a vertex twice if it is one. */
function edgesOf(place: Place, tets: Uint32Array): number[] {
  const at = 4 * place.index;
  switch (place.kind) {
    case "tet":
      return kEdges.flatMap(([a, b]) => [tets[at + a]!, tets[at + b]!]);
    case "face": {
      const [a, b, c] = faceOf(tets, at + place.second);
      return [a, b, b, c, c, a];
    }
    case "edge":
      return [place.index, place.second];
    case "vertex":
      return [place.index, place.index];
    default:
      return [];
  }
}

export function shapeOf(points: Float64Array, tets: Uint32Array, report: Pick<CheckReport, "defects">): MapShape {
  const positions = scenePositions(points);
  const pointCount = points.length / 3;
  // A map whose tets name vertices that do not exist has no surface to show.
  const sound = tets.every((vertex) => vertex < pointCount);
  const places = report.defects.map((defect) =>
    defect.worst.map(({ place }) => {
      const edges = edgesOf(place, tets).filter((vertex) => vertex < pointCount);
      const centre: [number, number, number] = [0, 0, 0];
      for (const vertex of edges) {
        for (let axis = 0; axis < 3; ++axis) {
          centre[axis]! += positions[4 * vertex + axis]! / edges.length;
        }
      }
      return { edges: edges.length % 2 === 0 ? edges : [], centre };
    }));
  return {
    positions,
    triangles: sound ? boundaryTriangles(tets, pointCount) : new Uint32Array(0),
    places,
  };
}
