// The canvas with the object of a map: its boundary, and the places of its defects.
import {
  BufferAttribute,
  BufferGeometry,
  Group,
  Mesh,
  MeshNormalMaterial,
  type Object3D,
  Points,
  PointsMaterial,
} from "three";
import { thinLines, wideLines } from "../viewer/scene/lines";
import { Viewport } from "../viewer/scene/viewport";
import type { MapShape } from "./messages";

const kBad = 0xd81b60;
/** Half the sides of the box of the scene. */
const kHalf: [number, number, number] = [0.5, 0.5, 0.5];
/** The corners of that box, four numbers each. */
const kCorners = new Float32Array([-1, 1].flatMap((z) => [-1, 1].flatMap((y) =>
  [-1, 1].flatMap((x) => [x * kHalf[0], y * kHalf[1], z * kHalf[2], 1]))));
/** The radius of what is shown around a place, in that scene. */
const kAround = 0.15;

function surfaceOf(shape: MapShape): Mesh {
  const { positions, triangles } = shape;
  const corners = new Float32Array(3 * triangles.length);
  for (let i = 0; i < triangles.length; ++i) {
    const at = 4 * triangles[i]!;
    corners.set(positions.subarray(at, at + 3), 3 * i);
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(corners, 3));
  geometry.computeVertexNormals();
  return new Mesh(geometry, new MeshNormalMaterial({
    flatShading: true, transparent: true, opacity: 0.55, polygonOffset: true, polygonOffsetFactor: 1,
  }));
}

function edgesOf(triangles: Uint32Array): Uint32Array {
  const edges: number[] = [];
  for (let i = 0; i < triangles.length; i += 3) {
    for (let k = 0; k < 3; ++k) {
      const a = triangles[i + k]!;
      const b = triangles[i + ((k + 1) % 3)]!;
      if (a < b) edges.push(a, b);
    }
  }
  return new Uint32Array(edges);
}

function markersOf(shape: MapShape): Object3D {
  const all = shape.places.flat();
  const edges = all.flatMap((place) => place.edges);
  const geometry = new BufferGeometry();
  const centres = new Float32Array(all.filter(({ edges }) => edges.length > 0).flatMap(({ centre }) => centre));
  geometry.setAttribute("position", new BufferAttribute(centres, 3));
  const group = new Group();
  group.add(
    wideLines({ vertices: edges, colours: edges.filter((_, i) => i % 2 === 0).map(() => kBad) },
      shape.positions, null, 3),
    new Points(geometry, new PointsMaterial({
      color: kBad, size: 9, sizeAttenuation: false, depthTest: false, transparent: true,
    })),
  );
  return group;
}

export class MapScene {
  private readonly viewport: Viewport;
  private objects: Object3D[] = [];

  constructor(canvas: HTMLCanvasElement) {
    this.viewport = new Viewport(canvas, kHalf, kCorners, () => undefined);
    const applyTheme = () =>
      this.viewport.setBackground(getComputedStyle(document.documentElement).getPropertyValue("--back").trim());
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", applyTheme);
    applyTheme();
  }

  show(shape: MapShape): void {
    for (const object of this.objects) this.viewport.remove(object);
    this.objects = [surfaceOf(shape), thinLines(edgesOf(shape.triangles), shape.positions, null), markersOf(shape)];
    for (const object of this.objects) this.viewport.add(object);
    this.viewport.look();
  }

  lookAt(place: [number, number, number]): void {
    this.viewport.approach(place, kAround);
  }
}
