// The programs that draw faces: what is kept, and the ghost of what is not.
import { kTextureWidth } from "../scene_box";

/** Rows of the texture of colours. */
export const kColourRows = { layers: 0, generators: 1, categories: 2, plain: 3, skin: 4, inside: 5 } as const;

const kHead = /* glsl */ `
precision highp float;
precision highp int;
`;

const kQuad = /* glsl */ `${kHead}
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
uniform highp sampler2D positions;
in uvec4 corners;
in uvec2 cell;

ivec2 texel(uint index) {
  return ivec2(int(index % ${kTextureWidth}u), int(index / ${kTextureWidth}u));
}
`;

/** Lines along the borders of squares, and the light: for faces and ghosts alike. */
const kLook = /* glsl */ `
/** Pixels of the picture per pixel of the page. */
uniform float pixelRatio;

/**
 * How much of a pixel the borders of the square cover: lines of a width in pixels of the page that fade
 * where they would take too much of the square, however they lie.
 */
float borders(vec2 square, float wide) {
  vec2 pixel = max(fwidth(square) * pixelRatio, vec2(1e-6));
  vec2 away = min(square, 1.0 - square) / pixel;
  float soft = 0.5 / pixelRatio;
  vec2 cover = 1.0 - smoothstep(0.5 * wide - soft, 0.5 * wide + soft, away);
  cover *= min(vec2(1.0), 0.07 / pixel);
  return 1.0 - (1.0 - cover.x) * (1.0 - cover.y);
}

/** Towards the eye, whichever side of the face that is. */
vec3 facing(vec3 normal, vec3 place) {
  // A face without area has no direction.
  vec3 unit = normal / max(length(normal), 1e-30);
  return dot(unit, place) > 0.0 ? -unit : unit;
}
`;

export const kVertexShader = /* glsl */ `${kQuad}
uniform highp sampler2D cellValues;
uniform highp sampler2D surface;
/** Squares along a side of a face; 0: straight, from corner to corner. */
uniform int pieces;
in vec4 light;
out vec3 vNormal;
out vec3 vPlace;
out vec3 vRight;
out vec3 vUp;
flat out float vQuality;
flat out uvec2 vCell;
flat out vec4 vKinds;
flat out vec4 vLight;
out vec2 vSquare;

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
  vec3 place, right, up, normal;
  if (pieces > 0) {
    place = curvedPoint(at);
    right = curvedPoint(at + ivec2(1, 0)) - curvedPoint(at - ivec2(1, 0));
    up = curvedPoint(at + ivec2(0, 1)) - curvedPoint(at - ivec2(0, 1));
    normal = cross(right, up);
    // Long ones would outweigh short ones in between.
    normal /= max(length(normal), 1e-30);
  } else {
    place = p[at.y == 0 ? at.x : 3 - at.x].xyz;
    right = p[1].xyz - p[0].xyz + p[2].xyz - p[3].xyz;
    up = p[3].xyz - p[0].xyz + p[2].xyz - p[1].xyz;
    normal = cross(p[2].xyz - p[0].xyz, p[3].xyz - p[1].xyz);
  }
  mat3 turn = mat3(modelViewMatrix);
  vNormal = turn * normal;
  vRight = turn * right / max(length(right), 1e-30);
  vUp = turn * up / max(length(up), 1e-30);
  vQuality = texelFetch(cellValues, texel(cell.x), 0).r;
  vCell = cell;
  vKinds = vec4(p[0].w, p[1].w, p[2].w, p[3].w);
  vLight = light;
  vec4 seen = modelViewMatrix * vec4(place, 1.0);
  vPlace = seen.xyz;
  gl_Position = projectionMatrix * seen;
}`;

export const kFragmentShader = /* glsl */ `${kHead}
uniform highp sampler2D colours;
uniform highp sampler2D cellLayers;
uniform highp sampler2D cellRegions;
uniform int mode;
uniform float deepestLayer;
uniform uint picked;
uniform bool showGrid;
uniform bool rounded;
in vec3 vNormal;
in vec3 vPlace;
in vec3 vRight;
in vec3 vUp;
flat in float vQuality;
flat in uvec2 vCell;
flat in vec4 vKinds;
flat in vec4 vLight;
in vec2 vSquare;
out vec4 colour;
${kLook}
vec3 look(int row, int column) { return texelFetch(colours, ivec2(column, row), 0).rgb; }

vec3 scaled(int row, float share) { return look(row, int(clamp(share, 0.0, 1.0) * 255.0 + 0.5)); }

vec3 base(bool inside) {
  if (mode == 0) {
    if (vQuality <= 0.0) return look(${kColourRows.plain}, 2);
    return scaled(inside ? ${kColourRows.inside} : ${kColourRows.skin}, vQuality);
  }
  if (mode == 1) {
    // The quarter of the quad at a vertex has its colour.
    int corner = vSquare.y < 0.5 ? (vSquare.x < 0.5 ? 0 : 1) : (vSquare.x < 0.5 ? 3 : 2);
    return look(${kColourRows.generators}, int(vKinds[corner] + 0.5));
  }
  uint feature = vCell.y >> 1 & 0xffffu;
  if (mode == 6 && !inside) return look(${kColourRows.categories}, int((vCell.y >> 17) % 256u));
  if (mode == 2 && feature > 0u) return look(${kColourRows.categories}, int((feature - 1u) % 256u));
  int index = int(vCell.x);
  ivec2 at = ivec2(index % ${kTextureWidth}, index / ${kTextureWidth});
  if (mode == 5) {
    return look(${kColourRows.categories}, int(texelFetch(cellRegions, at, 0).r + 0.5) % 256);
  }
  if (mode == 3) {
    return scaled(${kColourRows.layers}, texelFetch(cellLayers, at, 0).r / max(deepestLayer, 1.0));
  }
  return look(${kColourRows.plain}, int(inside));
}

/** Where the cell is rounded: 0 inside of its face, 1 at an edge. */
vec2 rounding() {
  return rounded ? smoothstep(vec2(0.28), vec2(0.5), abs(vSquare - 0.5)) : vec2(0.0);
}

vec3 normalHere() {
  vec3 normal = facing(vNormal, vPlace);
  vec2 tilt = rounding() * sign(vSquare - 0.5);
  return normalize(normal + 1.2 * (tilt.x * normalize(vRight) + tilt.y * normalize(vUp)));
}

void main() {
#ifdef PICK
  uint id = vCell.x + 1u;
  colour = vec4(float(id & 255u), float(id >> 8 & 255u), float(id >> 16 & 255u),
                float(id >> 24 & 255u)) / 255.0;
#else
  bool inside = (vCell.y & 1u) == 1u;
  vec3 flatColour = base(inside);
  // A broad light from over the left shoulder, in two tones; what the sky does not reach is darker.
  float tone = smoothstep(0.1, 0.9, 0.5 + 0.5 * dot(normalHere(), normalize(vec3(-0.4, 0.6, 0.8))));
  float open = mix(mix(vLight.x, vLight.y, vSquare.x), mix(vLight.w, vLight.z, vSquare.x), vSquare.y);
  float lit = mix(0.55, 1.0, tone) * mix(0.15, 1.0, open * sqrt(open));
  // What is bad glows in the shade.
  if (mode == 0) lit = mix(1.0, lit, smoothstep(0.0, 0.4, vQuality) * 0.4 + 0.6);
  // Shade keeps the hue: it deepens a colour more than it greys it.
  vec3 shaded = pow(flatColour, vec3(2.1 - 1.1 * lit)) * mix(vec3(0.60, 0.58, 0.62), vec3(1.02), lit);
  vec2 groove = rounding();
  shaded *= 1.0 - 0.35 * max(groove.x * groove.x, groove.y * groove.y);
  if (vCell.x == picked) shaded = mix(shaded, vec3(1.0), 0.45);
  if (showGrid) shaded = mix(shaded, 0.35 * shaded, 0.75 * borders(vSquare, 1.0));
  colour = vec4(min(shaded, 1.0), 1.0);
#endif
}`;

export const kGhostVertexShader = /* glsl */ `${kQuad}
out vec3 vNormal;
out vec3 vPlace;
out vec2 vSquare;

void main() {
  vec3 p[4];
  for (int i = 0; i < 4; ++i) p[i] = texelFetch(positions, texel(corners[i]), 0).xyz;
  ivec2 at = ivec2(gl_VertexID % 2, gl_VertexID / 2);
  vSquare = vec2(at);
  vNormal = mat3(modelViewMatrix) * cross(p[2] - p[0], p[3] - p[1]);
  vec4 seen = modelViewMatrix * vec4(p[at.y == 0 ? at.x : 3 - at.x], 1.0);
  vPlace = seen.xyz;
  gl_Position = projectionMatrix * seen;
}`;

/** Glass: to be seen where one looks along it, and hardly elsewhere. */
export const kGhostFragmentShader = /* glsl */ `${kHead}
uniform vec3 tint;
uniform float grid;
in vec3 vNormal;
in vec3 vPlace;
in vec2 vSquare;
out vec4 colour;
${kLook}
void main() {
  float along = 1.0 - abs(dot(facing(vNormal, vPlace), normalize(vPlace)));
  float dense = 0.025 + 0.25 * along * along * along * along;
  colour = vec4(tint, max(dense, grid * borders(vSquare, 1.0)));
}`;
