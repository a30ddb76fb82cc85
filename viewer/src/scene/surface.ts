// The faces that one sees, one instance of a square per quad. Positions and values of cells are in
// textures: what the worker sends per quad are numbers of vertices and of the cell, nothing else,
// and another colour needs no new geometry.
import {
  BufferGeometry,
  DataTexture,
  DoubleSide,
  FloatType,
  GLSL3,
  InstancedBufferGeometry,
  InstancedInterleavedBuffer,
  InterleavedBufferAttribute,
  Mesh,
  NearestFilter,
  RawShaderMaterial,
  RedFormat,
  RGBAFormat,
  UnsignedByteType,
  Vector2,
} from "three";
import { featureColour, kBadColour, kGeneratorColours, kPlainColour, rgbOf, viridis } from "../colours";
import { kQualitySteps } from "../format";
import { kTextureWidth } from "../scene_box";
import type { CurvedFaces } from "../worker/curved_faces";
import type { LoadedMesh } from "../worker/messages";

export const kColourModes = ["quality", "generator", "feature", "layer", "plain", "region"] as const;
export type ColourMode = (typeof kColourModes)[number];

const kVertexShader = /* glsl */ `
precision highp float;
precision highp int;
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
uniform highp sampler2D positions;
uniform highp sampler2D cellValues;
uniform highp sampler2D surface;
/** Squares along a side of a face; 0: straight, from corner to corner. */
uniform int pieces;
in uvec4 corners;
in uvec2 cell;
out vec3 vNormal;
flat out float vQuality;
flat out uvec2 vCell;
flat out vec4 vKinds;
out vec2 vSquare;

ivec2 texel(uint index) {
  return ivec2(int(index % ${kTextureWidth}u), int(index / ${kTextureWidth}u));
}

/** A point of the curved face that this instance is. */
vec3 curvedPoint(ivec2 at) {
  at = clamp(at, ivec2(0), ivec2(pieces));
  int side = pieces + 1;
  return texelFetch(surface, texel(uint(gl_InstanceID * side * side + at.y * side + at.x)), 0).xyz;
}

void main() {
  vec4 p[4];
  for (int i = 0; i < 4; ++i) p[i] = texelFetch(positions, texel(corners[i]), 0);
  int side = max(pieces, 1) + 1;
  ivec2 at = ivec2(gl_VertexID % side, gl_VertexID / side);
  vSquare = vec2(at) / float(side - 1);
  vec3 place;
  vec3 normal;
  if (pieces > 0) {
    place = curvedPoint(at);
    normal = cross(curvedPoint(at + ivec2(1, 0)) - curvedPoint(at - ivec2(1, 0)),
                   curvedPoint(at + ivec2(0, 1)) - curvedPoint(at - ivec2(0, 1)));
    // Long ones would outweigh short ones in between.
    normal /= max(length(normal), 1e-30);
  } else {
    place = p[at.y == 0 ? at.x : 3 - at.x].xyz;
    normal = cross(p[2].xyz - p[0].xyz, p[3].xyz - p[1].xyz);
  }
  vNormal = mat3(modelViewMatrix) * normal;
  vQuality = texelFetch(cellValues, texel(cell.x), 0).r;
  vCell = cell;
  vKinds = vec4(p[0].w, p[1].w, p[2].w, p[3].w);
  gl_Position = projectionMatrix * modelViewMatrix * vec4(place, 1.0);
}`;

const kFragmentShader = /* glsl */ `
precision highp float;
precision highp int;
uniform highp sampler2D colours;
uniform highp sampler2D cellLayers;
uniform highp sampler2D cellRegions;
uniform int mode;
uniform vec2 range;
uniform float deepestLayer;
uniform uint picked;
uniform bool showGrid;
in vec3 vNormal;
flat in float vQuality;
flat in uvec2 vCell;
flat in vec4 vKinds;
in vec2 vSquare;
out vec4 colour;

/** Rows of the texture: 0 viridis, 1 kinds of generators, 2 features, 3 single colours. */
vec3 look(int row, int column) { return texelFetch(colours, ivec2(column, row), 0).rgb; }

vec3 scaled(float share) { return look(0, int(clamp(share, 0.0, 1.0) * 255.0 + 0.5)); }

vec3 base() {
  if (mode == 0) {
    if (vQuality <= 0.0) return look(3, 1);
    return scaled((vQuality - range.x) / max(range.y - range.x, 1e-6));
  }
  if (mode == 1) {
    // The quarter of the quad at a vertex has its colour.
    int corner = vSquare.y < 0.5 ? (vSquare.x < 0.5 ? 0 : 1) : (vSquare.x < 0.5 ? 3 : 2);
    return look(1, int(vKinds[corner] + 0.5));
  }
  if (mode == 2 && vCell.y > 0u) return look(2, int((vCell.y - 1u) % 256u));
  int index = int(vCell.x);
  ivec2 at = ivec2(index % ${kTextureWidth}, index / ${kTextureWidth});
  if (mode == 5) return look(2, int(texelFetch(cellRegions, at, 0).r + 0.5) % 256);
  if (mode == 3) {
    return scaled(texelFetch(cellLayers, at, 0).r / max(deepestLayer, 1.0));
  }
  return look(3, 0);
}

void main() {
#ifdef PICK
  uint id = vCell.x + 1u;
  colour = vec4(float(id & 255u), float(id >> 8 & 255u), float(id >> 16 & 255u),
                float(id >> 24 & 255u)) / 255.0;
#else
  // A face without area has no direction.
  vec3 normal = vNormal / max(length(vNormal), 1e-30);
  float light = 0.45 + 0.55 * abs(normal.z);
  vec3 shaded = base() * light;
  if (vCell.x == picked) shaded = mix(shaded, vec3(1.0, 1.0, 1.0), 0.45);
  if (showGrid) {
    vec2 width = fwidth(vSquare);
    vec2 inside = min(vSquare, 1.0 - vSquare) / max(width, vec2(1e-6));
    float line = 1.0 - smoothstep(0.4, 1.3, min(inside.x, inside.y));
    // Cells of few pixels would be nothing but lines.
    float fade = clamp(1.25 - 2.5 * max(width.x, width.y), 0.0, 1.0);
    shaded = mix(shaded, vec3(0.05, 0.07, 0.1), 0.75 * line * fade);
  }
  colour = vec4(shaded, 1.0);
#endif
}`;

function colourTexture(): DataTexture {
  const data = new Uint8Array(256 * 4 * 4);
  const put = (row: number, column: number, rgb: number[]) =>
    data.set([...rgb, 255], 4 * (256 * row + column));
  for (let i = 0; i < 256; ++i) {
    put(0, i, viridis(i / 255));
    put(2, i, rgbOf(featureColour(i)));
  }
  kGeneratorColours.forEach((hex, i) => put(1, i, rgbOf(hex)));
  put(3, 0, rgbOf(kPlainColour));
  put(3, 1, rgbOf(kBadColour));
  const texture = new DataTexture(data, 256, 4, RGBAFormat, UnsignedByteType);
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

export class Surface {
  readonly mesh: Mesh;
  /** The same, drawn with numbers of cells instead of colours. */
  readonly pickMesh: Mesh;
  private readonly material: RawShaderMaterial;
  private curvedTexture: DataTexture | null = null;

  constructor(loaded: LoadedMesh) {
    const rows = loaded.positions.length / 4 / kTextureWidth;
    const uniforms = {
      positions: { value: valueTexture(loaded.positions, rows, true) },
      cellValues: { value: cellTexture(loaded.quality, (q) => (q / kQualitySteps) * 2 - 1) },
      cellLayers: { value: cellTexture(loaded.layers, (layer) => layer) },
      cellRegions: { value: cellTexture(loaded.regions, (place) => place - 1) },
      surface: { value: noTexture() },
      pieces: { value: 0 },
      colours: { value: colourTexture() },
      mode: { value: 0 },
      range: { value: new Vector2(0, 1) },
      deepestLayer: { value: loaded.deepestLayer },
      picked: { value: 0xffffffff },
      showGrid: { value: true },
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
    this.mesh = new Mesh(new BufferGeometry(), this.material);
    this.pickMesh = new Mesh(this.mesh.geometry, pick);
    this.mesh.frustumCulled = false;
    this.pickMesh.frustumCulled = false;
  }

  /** @param quads  six numbers each, as in Visible; curved: their points, or null for straight ones */
  setQuads(quads: Uint32Array, curved: CurvedFaces | null): void {
    const geometry = new InstancedBufferGeometry();
    geometry.setIndex(squares(curved?.pieces ?? 1));
    this.setCurved(curved);
    const buffer = new InstancedInterleavedBuffer(quads, 6);
    geometry.setAttribute("corners", new InterleavedBufferAttribute(buffer, 4, 0));
    geometry.setAttribute("cell", new InterleavedBufferAttribute(buffer, 2, 4));
    geometry.instanceCount = quads.length / 6;
    this.mesh.geometry.dispose();
    this.mesh.geometry = geometry;
    this.pickMesh.geometry = geometry;
    this.mesh.visible = quads.length > 0;
    this.pickMesh.visible = quads.length > 0;
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

  setColouring(mode: ColourMode, range: [number, number]): void {
    this.material.uniforms.mode!.value = kColourModes.indexOf(mode);
    (this.material.uniforms.range!.value as Vector2).set(...range);
  }

  setPicked(cell: number | null): void {
    this.material.uniforms.picked!.value = cell ?? 0xffffffff;
  }

  showGrid(on: boolean): void {
    this.material.uniforms.showGrid!.value = on;
  }
}
