// The legend: as elements of the page, and drawn into saved pictures.
import {
  cssOf, featureColour, insideQuality, kBadColour, kGeneratorColours, kGeneratorNames, kInsideColour,
  kNoCategory, kSkinColour, type Rgb, skinQuality, valenceColour, viridis,
} from "../colours";
import type { MeshInfo } from "../format";
import type { ViewState } from "../state";
import type { LoadedMesh } from "../worker/messages";
import type { Layers } from "../worker/topology";
import { grouped, make } from "./dom";
import { namesOf } from "./patches";

interface Chip {
  colour: string;
  text: string;
  edge: boolean;
}

interface Part {
  title: string;
  /** Both ends of the colour map, if there is one, and its colours, above one another. */
  scale?: { ends: [string, string]; ramps: ((share: number) => Rgb)[] };
  chips: Chip[];
}

const chip = (hex: number, text: string, edge = false): Chip => ({ colour: cssOf(hex), text, edge });

/** Chips for the first of many. */
function firstChips(names: (string | number)[]): Chip[] {
  const chips = names.slice(0, 12).map((name, i) => chip(featureColour(i), String(name)));
  if (names.length > chips.length) chips.push(chip(kNoCategory, `${names.length - chips.length} more`));
  return chips;
}

const kSkinAndCut = [chip(kSkinColour, "boundary"), chip(kInsideColour, "cut")];

function cellPart(state: ViewState, info: MeshInfo, mesh: LoadedMesh, layers: Layers | null): Part | null {
  const { quadTags, regionTags } = mesh;
  switch (state.colour) {
    case "quality":
      return {
        title: "scaled Jacobian",
        scale: { ends: ["0", "1"], ramps: [skinQuality, insideQuality] },
        chips: info.validity.refuted + info.validity.undecided > 0
          ? [...kSkinAndCut, chip(kBadColour, "not positive")]
          : kSkinAndCut,
      };
    case "generator":
      return {
        title: info.hasGenerators ? "vertex lies in a ... of the tets" : "generators are not known",
        chips: info.hasGenerators ? kGeneratorNames.map((n, i) => chip(kGeneratorColours[i]!, n)) : [],
      };
    case "feature":
      return {
        title: quadTags.length > 0 ? "tag of the face" : "no tagged faces",
        chips: firstChips(quadTags),
      };
    case "patch":
      return {
        title: "patch of the boundary",
        chips: [...firstChips(namesOf(info)), chip(kInsideColour, "cut")],
      };
    case "region":
      return {
        title: regionTags.length > 0 ? "region of the cell" : "no regions",
        chips: firstChips(regionTags),
      };
    case "layer":
      return {
        title: "layer from the boundary",
        scale: { ends: ["0", String(layers?.deepest ?? "...")], ramps: [viridis] },
        chips: [],
      };
    case "plain":
      return { title: "", chips: kSkinAndCut };
  }
}

function edgePart(title: string, counts: [number, number][], boundary: boolean): Part | null {
  if (counts.length === 0) return null;
  return {
    title,
    chips: counts.map(([valence, count]) =>
      chip(valenceColour(valence, boundary), `${valence} (${grouped(count)})`, true)),
  };
}

export class Legend {
  private parts: Part[] = [];

  constructor(private readonly box: HTMLElement) {}

  update(state: ViewState, info: MeshInfo, mesh: LoadedMesh, layers: Layers | null): void {
    const parts = [
      cellPart(state, info, mesh, layers),
      state.inner ? edgePart("valence of singular edges inside", info.singular.inner, false) : null,
      state.boundary
        ? edgePart("valence of singular edges on the boundary", info.singular.boundary, true)
        : null,
    ];
    this.parts = parts.filter((part) => part !== null);
    this.box.replaceChildren(...this.parts.flatMap((part) => this.elementsOf(part)));
  }

  private elementsOf(part: Part): HTMLElement[] {
    const made: HTMLElement[] = part.title ? [make("h3", part.title)] : [];
    if (part.scale) {
      const { ends, ramps } = part.scale;
      for (const ramp of ramps) {
        const bar = make("div", "", "bar");
        const stops = Array.from({ length: 21 }, (_, i) => `rgb(${ramp(i / 20).join()})`);
        bar.style.background = `linear-gradient(to right, ${stops.join()})`;
        made.push(bar);
      }
      const ticks = make("div", "", "ticks");
      ticks.append(make("span", ends[0]), make("span", ends[1]));
      made.push(ticks);
    }
    const list = make("ul");
    for (const { colour, text, edge } of part.chips) {
      const item = make("li");
      const mark = make("i", "", edge ? "edge" : "");
      mark.style.background = colour;
      item.append(mark, text);
      list.append(item);
    }
    if (part.chips.length > 0) made.push(list);
    return made;
  }

  /** Draws the legend into the lower left corner of a picture. */
  draw(picture: HTMLCanvasElement, ratio: number, text: string): void {
    const context = picture.getContext("2d")!;
    context.scale(ratio, ratio);
    context.fillStyle = text;
    context.font = "12px system-ui, sans-serif";
    const rows = this.parts.reduce((n, p) => n + 1 + (p.scale ? 2 : 0) + (p.chips.length ? 1 : 0), 0);
    let y = picture.height / ratio - 16 * rows;
    for (const part of this.parts) {
      context.fillText(part.title, 12, y);
      y += 16;
      if (part.scale) {
        const { ends, ramps } = part.scale;
        const tall = 10 / ramps.length;
        ramps.forEach((ramp, row) => {
          for (let i = 0; i < 200; ++i) {
            context.fillStyle = `rgb(${ramp(i / 199).join()})`;
            context.fillRect(12 + i, y - 9 + row * tall, 1.5, tall);
          }
        });
        context.fillStyle = text;
        y += 16;
        context.fillText(ends[0], 12, y - 2);
        context.textAlign = "right";
        context.fillText(ends[1], 212, y - 2);
        context.textAlign = "left";
        y += 16;
      }
      let x = 12;
      for (const item of part.chips) {
        context.fillStyle = item.colour;
        context.fillRect(x, item.edge ? y - 6 : y - 10, 14, item.edge ? 4 : 12);
        context.fillStyle = text;
        context.fillText(item.text, x + 18, y);
        x += 30 + context.measureText(item.text).width;
      }
      if (part.chips.length > 0) y += 16;
    }
  }
}
