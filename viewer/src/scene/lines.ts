// Edges: singular ones by valence, tagged ones, the outline of the whole mesh, a picked cell.
import { BufferGeometry, BufferAttribute, Group, LineBasicMaterial, LineSegments } from "three";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
import { rgbOf } from "../colours";
import type { EdgeCurves } from "../curves";

/** Segments between vertices, each with a colour. */
export interface Segments {
  vertices: number[];
  colours: number[];
}

/** Ends of segments: one per edge, or as many as a curve has pieces. */
function pointsOf(vertices: ArrayLike<number>, positions: Float32Array, curves: EdgeCurves | null): Float32Array {
  if (curves) return curvedPointsOf(vertices, curves);
  const points = new Float32Array(3 * vertices.length);
  for (let i = 0; i < vertices.length; ++i) {
    const at = 4 * vertices[i]!;
    points.set(positions.subarray(at, at + 3), 3 * i);
  }
  return points;
}

function curvedPointsOf(vertices: ArrayLike<number>, curves: EdgeCurves): Float32Array {
  curves.find(vertices);
  const { pieces } = curves;
  const curve = new Float32Array(3 * (pieces + 1));
  const points = new Float32Array(3 * pieces * vertices.length);
  let to = 0;
  for (let i = 0; i < vertices.length; i += 2) {
    curves.write(vertices[i]!, vertices[i + 1]!, curve, 0);
    for (let piece = 0; piece < pieces; ++piece, to += 6) {
      points.set(curve.subarray(3 * piece, 3 * piece + 6), to);
    }
  }
  return points;
}

/** Wide lines; what lies behind the surface shines through faintly. */
export function wideLines(
  segments: Segments,
  positions: Float32Array,
  curves: EdgeCurves | null,
  width: number,
): Group {
  const group = new Group();
  if (segments.vertices.length === 0) return group;
  const geometry = new LineSegmentsGeometry();
  const points = pointsOf(segments.vertices, positions, curves);
  geometry.setPositions(points);
  const pieces = curves?.pieces ?? 1;
  const colours = new Float32Array(points.length);
  segments.colours.forEach((hex, i) => {
    const rgb = rgbOf(hex).map((channel) => channel / 255);
    for (let end = 0; end < 2 * pieces; ++end) colours.set(rgb, 6 * pieces * i + 3 * end);
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
export function thinLines(
  vertices: Uint32Array,
  positions: Float32Array,
  curves: EdgeCurves | null,
): LineSegments {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(pointsOf(vertices, positions, curves), 3));
  const material = new LineBasicMaterial({ color: 0x8899aa, transparent: true, opacity: 0.35 });
  return new LineSegments(geometry, material);
}
