// Colours that people with colour-blindness can tell apart.

/** Viridis (Smith and van der Walt), sampled evenly; linear in between. */
const kViridis = [
  0x440154, 0x482475, 0x414487, 0x355f8d, 0x2a788e, 0x21918c, 0x22a884, 0x44bf70, 0x7ad151,
  0xbddf26, 0xfde725,
];

/** For cells that are not positive: no other colour of a cell is near it. */
export const kBadColour = 0xc2006f;

/** Around the picked cell. */
export const kPickedColour = 0x0b63b5;

/** What is outside of the mesh is cool, what a cut shows is warm. */
export const kSkinColour = 0xc9d6e6;
export const kInsideColour = 0xfcecc3;

/**
 * Scaled Jacobians from 0 to 1: good cells are calm, bad ones glow. Both ramps grow lighter all the
 * way, so grey printers and people with colour-blindness can read them.
 */
const kSkinRamp = [
  0xb5131f, 0xd03327, 0xe46845, 0xe6a07c, 0xdec3b2, 0xd3cfd0, 0xcbd4de, 0xc9d6e6, 0xc9d6e6, 0xc9d6e6, 0xc9d6e6,
];
const kInsideRamp = [
  0xb5131f, 0xd03327, 0xe66540, 0xf19a5e, 0xf5c285, 0xf9dba4, 0xfbe7b8, 0xfcecc3, 0xfcecc3, 0xfcecc3, 0xfcecc3,
];

export type Rgb = [number, number, number];

export function rgbOf(hex: number): Rgb {
  return [(hex >> 16) & 255, (hex >> 8) & 255, hex & 255];
}

export function cssOf(hex: number): string {
  return `#${hex.toString(16).padStart(6, "0")}`;
}

/** Linear between evenly spaced colours. @param share  in [0, 1] */
function ramp(colours: readonly number[], share: number): Rgb {
  const place = Math.min(Math.max(share, 0), 1) * (colours.length - 1);
  const i = Math.min(Math.floor(place), colours.length - 2);
  const from = rgbOf(colours[i]!);
  const to = rgbOf(colours[i + 1]!);
  const t = place - i;
  return [0, 1, 2].map((c) => Math.round(from[c]! + t * (to[c]! - from[c]!))) as Rgb;
}

export const viridis = (share: number): Rgb => ramp(kViridis, share);
export const skinQuality = (share: number): Rgb => ramp(kSkinRamp, share);
export const insideQuality = (share: number): Rgb => ramp(kInsideRamp, share);

/** Okabe and Ito's palette, for categories. */
export const kCategories = [
  0xe69f00, 0x56b4e9, 0x009e73, 0xf0e442, 0x0072b2, 0xd55e00, 0xcc79a7, 0x8d6e63,
];

/** For what has no category. */
export const kNoCategory = 0xb9c3cc;

/** By kind: vertex, edge, face, cell of the tets. */
export const kGeneratorColours = [0xd55e00, 0xe69f00, 0x56b4e9, 0xdfe5ea];
export const kGeneratorNames = ["vertex", "edge", "face", "cell"];

export function featureColour(index: number): number {
  return kCategories[index % kCategories.length]!;
}

/** Of a singular edge. Valences 3 and 5 are by far the most frequent ones inside. */
export function valenceColour(valence: number, boundary: boolean): number {
  if (boundary) return [0x8d6e63, 0x8d6e63, 0x8d6e63, 0x009e73, 0xcc79a7][valence] ?? 0x999999;
  return [0x999999, 0xcc79a7, 0xcc79a7, 0xd55e00, 0x999999, 0x0072b2, 0x56b4e9][valence] ?? 0xe69f00;
}
