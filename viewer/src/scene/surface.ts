// The faces that one sees, one instance of a square per quad. Positions and values of cells are in
// textures: what the worker sends per quad are numbers of vertices and of the cell, nothing else,
// and another colour needs no new geometry.
import {
  BufferGeometry,
  DataTexture,
  DoubleSide,
  FloatType,
  GLSL3,
  InstancedBufferAttribute,
  InstancedBufferGeometry,
  InstancedInterleavedBuffer,
  InterleavedBufferAttribute,
  Mesh,
  NearestFilter,
  RawShaderMaterial,
  RedFormat,
  RGBAFormat,
  UnsignedByteType,
  Vector3,
} from "three";
import {
  featureColour, insideQuality, kBadColour, kGeneratorColours, kInsideColour, kSkinColour, rgbOf,
  skinQuality, viridis,
} from "../colours";
import { qualityOf } from "../format";
import type { Moments } from "../moments";
import { kTextureWidth } from "../scene_box";
import type { CurvedFaces } from "../worker/curved_faces";
import type { LoadedMesh } from "../worker/messages";
import type { Layers } from "../worker/topology";
import type { Visible } from "../worker/visible";
import {
  kColourRows, kFragmentShader, kGhostFragmentShader, kGhostVertexShader, kVertexShader,
} from "./shaders";

export const kColourModes = ["quality", "generator", "feature", "layer", "plain", "region", "patch"] as const;
export type ColourMode = (typeof kColourModes)[number];

const kGhostTint = new Vector3(...rgbOf(0x5f7288).map((channel) => channel / 255));

function colourTexture(): DataTexture {
  const rows = Object.keys(kColourRows).length;
  const data = new Uint8Array(256 * 4 * rows);
  const put = (row: number, column: number, rgb: number[]) =>
    data.set([...rgb, 255], 4 * (256 * row + column));
  for (let i = 0; i < 256; ++i) {
    put(kColourRows.layers, i, viridis(i / 255));
    put(kColourRows.categories, i, rgbOf(featureColour(i)));
    put(kColourRows.skin, i, skinQuality(i / 255));
    put(kColourRows.inside, i, insideQuality(i / 255));
  }
  kGeneratorColours.forEach((hex, i) => put(kColourRows.generators, i, rgbOf(hex)));
  [kSkinColour, kInsideColour, kBadColour].forEach((hex, i) => put(kColourRows.plain, i, rgbOf(hex)));
  const texture = new DataTexture(data, 256, rows, RGBAFormat, UnsignedByteType);
  texture.needsUpdate = true;
  return texture;
}

/** One number per cell. */
function cellTexture(values: ArrayLike<number>, valueOf: (stored: number) => number): DataTexture {
  const rows = Math.ceil(values.length / kTextureWidth) || 1;
  const data = new Float32Array(kTextureWidth * rows);
  for (let i = 0; i < values.length; ++i) data[i] = valueOf(values[i]!);
  return valueTexture(data, rows, false);
}

function valueTexture(data: Float32Array<ArrayBuffer>, rows: number, four: boolean): DataTexture {
  const format = four ? RGBAFormat : RedFormat;
  const texture = new DataTexture(data, kTextureWidth, rows, format, FloatType);
  texture.minFilter = NearestFilter;
  texture.magFilter = NearestFilter;
  texture.needsUpdate = true;
  return texture;
}

/** Scaled Jacobians. Cells that are positive at their corners, but not everywhere, are not positive. */
function valuesOf({ quality, notPositive }: Moments): DataTexture {
  const texture = cellTexture(quality, qualityOf);
  const values = texture.image.data as Float32Array;
  for (const cell of notPositive) values[cell] = Math.min(values[cell]!, 0);
  return texture;
}

let emptyTexture: DataTexture | null = null;

/** Stands where no texture is needed. */
function noTexture(): DataTexture {
  emptyTexture ??= valueTexture(new Float32Array(4 * kTextureWidth), 1, true);
  return emptyTexture;
}

/** Two triangles for each small square of a face of `pieces` times `pieces`. */
function squares(pieces: number): number[] {
  const side = pieces + 1;
  const index: number[] = [];
  for (let i = 0; i < pieces * pieces; ++i) {
    const a = Math.floor(i / pieces) * side + (i % pieces);
    index.push(a, a + 1, a + side + 1, a, a + side + 1, a + side);
  }
  return index;
}

/** Where instances of quads come from: six numbers each, as in Visible. */
function quadGeometry(quads: Uint32Array, pieces: number): InstancedBufferGeometry {
  const geometry = new InstancedBufferGeometry();
  geometry.setIndex(squares(pieces));
  const buffer = new InstancedInterleavedBuffer(quads, 6);
  geometry.setAttribute("corners", new InterleavedBufferAttribute(buffer, 4, 0));
  geometry.setAttribute("cell", new InterleavedBufferAttribute(buffer, 2, 4));
  geometry.instanceCount = quads.length / 6;
  return geometry;
}

export class Surface {
  readonly mesh: Mesh;
  /** The same, drawn with numbers of cells instead of colours. */
  readonly pickMesh: Mesh;
  /** What is not kept, as if of glass. */
  readonly ghost: Mesh;
  private readonly material: RawShaderMaterial;
  private readonly ghostMaterial: RawShaderMaterial;
  private curvedTexture: DataTexture | null = null;
  private ghostWanted = true;
  private readonly pixelRatio = { value: 1 };

  private readonly positions: DataTexture;
  private drawnQuality: Uint16Array;

  constructor(loaded: LoadedMesh, private readonly moments: Moments) {
    const rows = moments.positions.length / 4 / kTextureWidth;
    this.positions = valueTexture(moments.positions, rows, true);
    this.drawnQuality = moments.quality;
    const positions = { value: this.positions };
    const uniforms = {
      positions,
      cellValues: { value: valuesOf(moments) },
      cellLayers: { value: noTexture() },
      cellRegions: { value: cellTexture(loaded.regions, (place) => place - 1) },
      surface: { value: noTexture() },
      pieces: { value: 0 },
      colours: { value: colourTexture() },
      mode: { value: 0 },
      deepestLayer: { value: 1 },
      picked: { value: 0xffffffff },
      showGrid: { value: true },
      rounded: { value: false },
      pixelRatio: this.pixelRatio,
    };
    const options = {
      glslVersion: GLSL3,
      vertexShader: kVertexShader,
      fragmentShader: kFragmentShader,
      uniforms,
      side: DoubleSide,
      // Lines lie in front of the faces that they bound.
      polygonOffset: true,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 1,
    };
    this.material = new RawShaderMaterial(options);
    const pick = new RawShaderMaterial({ ...options, defines: { PICK: "" } });
    this.ghostMaterial = new RawShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: kGhostVertexShader,
      fragmentShader: kGhostFragmentShader,
      uniforms: { positions, tint: { value: kGhostTint }, grid: { value: 0 }, pixelRatio: this.pixelRatio },
      side: DoubleSide,
      transparent: true,
      depthWrite: false,
    });
    this.mesh = new Mesh(new BufferGeometry(), this.material);
    this.pickMesh = new Mesh(this.mesh.geometry, pick);
    this.ghost = new Mesh(new BufferGeometry(), this.ghostMaterial);
    for (const mesh of [this.mesh, this.pickMesh, this.ghost]) mesh.frustumCulled = false;
  }

  /** Draws the positions and values that the moments show now. */
  showMoment(): void {
    this.positions.needsUpdate = true;
    if (this.moments.quality === this.drawnQuality) return;
    this.drawnQuality = this.moments.quality;
    const { cellValues } = this.material.uniforms;
    (cellValues!.value as DataTexture).dispose();
    cellValues!.value = valuesOf(this.moments);
  }

  /** @param curved  points of the faces that are drawn, or null for straight ones */
  setQuads({ quads, ghost, light }: Visible, curved: CurvedFaces | null): void {
    this.setCurved(curved);
    this.mesh.geometry.dispose();
    this.mesh.geometry = quadGeometry(quads, curved?.pieces ?? 1);
    this.pickMesh.geometry = this.mesh.geometry;
    this.mesh.visible = quads.length > 0;
    this.pickMesh.visible = quads.length > 0;
    this.setLight(light);
    this.ghost.geometry.dispose();
    this.ghost.geometry = quadGeometry(ghost, 1);
    this.showGhost(this.ghostWanted);
  }

  /** @param light  as in Occlusion, for the quads that are drawn */
  setLight(light: Uint8Array<ArrayBuffer>): void {
    this.mesh.geometry.setAttribute("light", new InstancedBufferAttribute(light, 4, true));
  }

  private setCurved(curved: CurvedFaces | null): void {
    const { surface, pieces } = this.material.uniforms;
    pieces!.value = curved?.pieces ?? 0;
    this.curvedTexture?.dispose();
    this.curvedTexture = curved
      ? valueTexture(curved.points, curved.points.length / 4 / kTextureWidth, true)
      : null;
    surface!.value = this.curvedTexture ?? noTexture();
  }

  setColouring(mode: ColourMode): void {
    this.material.uniforms.mode!.value = kColourModes.indexOf(mode);
  }

  setLayers({ ofCells, deepest }: Layers): void {
    this.material.uniforms.cellLayers!.value = cellTexture(ofCells, (layer) => layer);
    this.material.uniforms.deepestLayer!.value = deepest;
  }

  setPicked(cell: number | null): void {
    this.material.uniforms.picked!.value = cell ?? 0xffffffff;
  }

  /** @param ratio  pixels of the picture per pixel of the page */
  setPixelRatio(ratio: number): void {
    this.pixelRatio.value = ratio;
  }

  showGrid(on: boolean): void {
    this.material.uniforms.showGrid!.value = on;
  }

  showRounded(on: boolean): void {
    this.material.uniforms.rounded!.value = on;
  }

  /** @param grid  whether edges of the ghost's cells are drawn, too */
  showGhost(on: boolean, grid = this.ghostMaterial.uniforms.grid!.value > 0): void {
    this.ghostWanted = on;
    this.ghostMaterial.uniforms.grid!.value = grid ? 0.35 : 0;
    const { instanceCount } = this.ghost.geometry as InstancedBufferGeometry;
    this.ghost.visible = on && instanceCount > 0;
  }
}
