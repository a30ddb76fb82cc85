// Scene coordinates: the mesh around the origin, with 1 as the longest side of its box.
import type { MeshInfo } from "./format";

/** Width of the textures that hold one texel per vertex or cell; what phones have, too. */
export const kTextureWidth = 4096;

export interface SceneBox {
  centre: [number, number, number];
  scale: number;
  /** Half the sides of the box, in scene coordinates. */
  half: [number, number, number];
}

export function sceneOf(info: MeshInfo): SceneBox {
  const sides = [0, 1, 2].map((axis) => info.upper[axis]! - info.lower[axis]!);
  const longest = Math.max(...sides) || 1;
  const centre = [0, 1, 2].map((axis) => info.upper[axis]! / 2 + info.lower[axis]! / 2);
  return {
    centre: centre as [number, number, number],
    scale: 1 / longest,
    half: sides.map((side) => side / longest / 2) as [number, number, number],
  };
}
