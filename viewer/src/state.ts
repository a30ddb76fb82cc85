// What a view is: everything that the fragment of the page's address can hold.
import type { ColourMode } from "./scene/surface";
import { kColourModes } from "./scene/surface";
import type { CameraState } from "./scene/viewport";

export type SliceDirection = "off" | "x" | "y" | "z" | "view";

export type Normal = [number, number, number];

export interface ViewState {
  slice: SliceDirection;
  /** Outwards normal of the kept side. */
  normal: Normal;
  /** Share of the mesh along the normal that is kept. */
  position: number;
  peel: number;
  quality: [number, number];
  /** From before an improvement (0) to after it (1), if the page shows both. */
  moment: number;
  colour: ColourMode;
  grid: boolean;
  inner: boolean;
  boundary: boolean;
  /** Whether what is cut away is drawn as if of glass. */
  ghost: boolean;
  features: boolean;
  /** Whether cells of higher order are drawn as they are. */
  curved: boolean;
  rounded: boolean;
  /** Cells that were taken away one by one, in this order. */
  dug: number[];
  picked: number | null;
  /** Whether the picked cell is shown alone. */
  isolated: boolean;
  theme: "system" | "dark" | "light";
  camera: CameraState | null;
}

export const kStart: ViewState = {
  slice: "off",
  normal: [1, 0, 0],
  position: 0.5,
  peel: 0,
  quality: [-1, 1],
  moment: 1,
  colour: "quality",
  grid: true,
  inner: true,
  boundary: false,
  ghost: true,
  features: true,
  curved: true,
  rounded: false,
  dug: [],
  picked: null,
  isolated: false,
  theme: "system",
  camera: null,
};

export const kFlags = ["grid", "inner", "boundary", "ghost", "features", "curved", "rounded"] as const;
export type Flag = (typeof kFlags)[number];
const short = (x: number) => String(Number(x.toPrecision(6)));
const list = (numbers: number[]) => numbers.map(short).join(",");

/** Only what differs from the start. */
export function toFragment(state: ViewState): string {
  const parts = new URLSearchParams();
  if (state.slice !== "off") {
    parts.set("slice", `${state.slice},${list([...state.normal, state.position])}`);
  }
  if (state.peel > 0) parts.set("peel", String(state.peel));
  if (state.quality[0] > -1 || state.quality[1] < 1) parts.set("quality", list(state.quality));
  if (state.moment !== kStart.moment) parts.set("moment", short(state.moment));
  if (state.colour !== kStart.colour) parts.set("colour", state.colour);
  for (const flag of kFlags) if (state[flag] !== kStart[flag]) parts.set(flag, state[flag] ? "1" : "0");
  if (state.dug.length > 0) parts.set("dug", list(state.dug));
  if (state.picked !== null) parts.set("cell", String(state.picked));
  if (state.isolated) parts.set("alone", "1");
  if (state.theme !== "system") parts.set("theme", state.theme);
  if (state.camera) parts.set("camera", list([...state.camera.position, ...state.camera.target]));
  return parts.toString().replaceAll("%2C", ",");
}

function numbers(text: string | null, count: number): number[] | null {
  if (!text) return null;
  const values = text.split(",").map(Number);
  return values.length === count && values.every(Number.isFinite) ? values : null;
}

/** Whether a camera looks anywhere, from a place where the mesh can be seen. */
function isCamera(numbers: number[]): boolean {
  const distance = Math.hypot(...[0, 1, 2].map((k) => numbers[k]! - numbers[k + 3]!));
  return distance > 1e-6 && numbers.every((x) => Math.abs(x) < 1000);
}

/** What a fragment says; what it says wrongly is left as it is at the start. */
export function fromFragment(fragment: string): ViewState {
  const state: ViewState = { ...kStart };
  const parts = new URLSearchParams(fragment.replace(/^#/, ""));
  const [direction, ...rest] = (parts.get("slice") ?? "").split(",");
  const plane = numbers(rest.join(","), 4);
  if (plane && ["x", "y", "z", "view"].includes(direction!)) {
    state.slice = direction as SliceDirection;
    state.normal = [plane[0]!, plane[1]!, plane[2]!];
    state.position = Math.min(Math.max(plane[3]!, 0), 1);
  }
  state.peel = Math.max(0, Math.floor(numbers(parts.get("peel"), 1)?.[0] ?? 0));
  const quality = numbers(parts.get("quality"), 2);
  if (quality) {
    const [from, to] = quality.map((value) => Math.min(Math.max(value, -1), 1)).sort((a, b) => a - b);
    state.quality = [from!, to!];
  }
  const moment = numbers(parts.get("moment"), 1)?.[0] ?? kStart.moment;
  state.moment = Math.min(Math.max(moment, 0), 1);
  const colour = kColourModes.find((mode) => mode === parts.get("colour"));
  if (colour) state.colour = colour;
  for (const flag of kFlags) if (parts.has(flag)) state[flag] = parts.get(flag) === "1";
  const cellsOf = (name: string) =>
    (parts.get(name) ?? "").split(",").filter((text) => /^\d{1,8}$/.test(text)).map(Number);
  state.dug = cellsOf("dug");
  state.picked = cellsOf("cell")[0] ?? null;
  state.isolated = state.picked !== null && parts.get("alone") === "1";
  const theme = parts.get("theme");
  if (theme === "dark" || theme === "light") state.theme = theme;
  const camera = numbers(parts.get("camera"), 6);
  if (camera && isCamera(camera)) {
    state.camera = {
      position: [camera[0]!, camera[1]!, camera[2]!],
      target: [camera[3]!, camera[4]!, camera[5]!],
    };
  }
  return state;
}
