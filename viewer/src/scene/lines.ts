// Edges: singular ones by valence, tagged ones, the outline of the whole mesh, a picked cell.
import { BufferGeometry, BufferAttribute, Group, LineBasicMaterial, LineSegments } from "three";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
import { rgbOf } from "../colours";

/** Segments between vertices, each with a colour. */
export interface Segments {
  vertices: number[];
  colours: number[];
}

function pointsOf(vertices: ArrayLike<number>, positions: Float32Array): Float32Array {
  const points = new Float32Array(3 * vertices.length);
  for (let i = 0; i < vertices.length; ++i) {
    const at = 4 * vertices[i]!;
    points.set(positions.subarray(at, at + 3), 3 * i);
  }
  return points;
}

/** Wide lines; what lies behind the surface shines through faintly. */
export function wideLines(segments: Segments, positions: Float32Array, width: number): Group {
  const group = new Group();
  if (segments.vertices.length === 0) return group;
  const geometry = new LineSegmentsGeometry();
  geometry.setPositions(pointsOf(segments.vertices, positions));
  const colours = new Float32Array(3 * segments.vertices.length);
  segments.colours.forEach((hex, i) => {
    const rgb = rgbOf(hex).map((channel) => channel / 255);
    colours.set([...rgb, ...rgb], 6 * i);
  });
  geometry.setColors(colours);
  const behind = new LineMaterial({
    linewidth: width,
    vertexColors: true,
    transparent: true,
    opacity: 0.28,
    depthTest: false,
    depthWrite: false,
  });
  const front = new LineMaterial({ linewidth: width, vertexColors: true });
  for (const material of [behind, front]) {
    // Written as they are, like the colours of the surface.
    material.toneMapped = false;
    group.add(new LineSegments2(geometry, material));
  }
  return group;
}

/** Thin lines of one colour. */
export function thinLines(vertices: Uint32Array, positions: Float32Array): LineSegments {
  const geometry = new BufferGeometry();
  // The vertices are numbers into all positions: no copy of those that are not on any line.
  geometry.setAttribute("position", new BufferAttribute(pointsOf(vertices, positions), 3));
  const material = new LineBasicMaterial({ color: 0x8899aa, transparent: true, opacity: 0.35 });
  return new LineSegments(geometry, material);
}

export const kCellEdges = [
  0, 1, 1, 2, 3, 2, 0, 3, 4, 5, 5, 6, 7, 6, 4, 7, 0, 4, 1, 5, 3, 7, 2, 6,
] as const;
