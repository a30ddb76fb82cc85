// What the mesh adds up to, whether it agrees with its map, and what a picked cell is.
import { type MeshInfo, qualityOf, type ValidityInfo } from "../format";
import { isBefore, type Moments } from "../moments";
import { kTextureWidth, sceneOf } from "../scene_box";
import type { LoadedMesh } from "../worker/messages";
import type { Layers } from "../worker/topology";
import { element, fillFacts, grouped, make } from "./dom";

const valences = (counts: [number, number][]) =>
  counts.length === 0 ? "none" : counts.map(([v, n]) => `${grouped(n)} of valence ${v}`).join(", ");

const place = (p: number[]) => p.map((x) => Number(x.toPrecision(6))).join(", ");

const curvedFacts = (info: MeshInfo): [string, string, string][] => [
  ["order of the cells", String(info.order), "stat-order"],
  ["nodes on faces", grouped(info.points - info.vertices), "stat-nodes"],
];

function validityOf({ validity }: MeshInfo): string {
  const { refuted, undecided } = validity;
  if (refuted + undecided === 0) return "certified positive everywhere";
  return `${grouped(refuted)} not positive, ${grouped(undecided)} undecided`;
}

/** Where one of the worst cells is not positive. */
function refutationFacts(cell: number, info: MeshInfo): [string, string, string][] {
  const bad = info.validity.worst.find((each) => each.cell === cell);
  if (!bad) return [];
  return [["least, at place in the cell",
           `${bad.scaledJacobian.toFixed(4)} at ${place(bad.place)}`, "picked-refuted"]];
}

/** What is known of the mesh before or after its improvement. */
export function infoAt(info: MeshInfo, moment: number): MeshInfo {
  return isBefore(moment) ? { ...info, ...info.before } : info;
}

/** Both ends side by side. */
export function showImprovement({ before, quality, validity }: MeshInfo): void {
  if (!before) return;
  const bad = (of: ValidityInfo) => grouped(of.refuted + of.undecided);
  fillFacts(element("moment-facts"), [
    ["cells not positive", `${bad(before.validity)} \u2192 ${bad(validity)}`, "moment-bad"],
    ["scaled Jacobian, least",
     `${before.quality.minimum.toFixed(4)} \u2192 ${quality.minimum.toFixed(4)}`, "moment-minimum"],
    ["mean", `${before.quality.mean.toFixed(4)} \u2192 ${quality.mean.toFixed(4)}`, "moment-mean"],
  ]);
}

export function showStatistics(info: MeshInfo): void {
  const pageBytes = info.tables.flatMap((table) => table.chunkBytes).reduce((sum, n) => sum + n, 0);
  const { topology, quality } = info;
  fillFacts(element("statistics"), [
    ["cells", grouped(info.cells), "stat-cells"],
    ["vertices", grouped(info.vertices), "stat-vertices"],
    ...(info.order > 1 ? curvedFacts(info) : []),
    ["boundary quads", grouped(topology.boundaryQuads), "stat-boundary-quads"],
    ["components", grouped(topology.components)],
    ["boundary components", grouped(topology.boundaryComponents)],
    ["Euler characteristic", String(topology.eulerCharacteristic)],
    ["scaled Jacobian, least", quality.minimum.toFixed(4), "stat-minimum"],
    ["mean", quality.mean.toFixed(4), "stat-mean"],
    ["not positive", grouped(quality.notPositive), "stat-not-positive"],
    ["validity", validityOf(info), "stat-validity"],
    ["scaled Jacobian everywhere, at least", info.validity.minimum.toFixed(4), "stat-everywhere"],
    ["singular edges inside", valences(info.singular.inner), "stat-inner"],
    ["on the boundary", valences(info.singular.boundary), "stat-boundary"],
    ["from", place(info.lower)],
    ["to", place(info.upper)],
    ["data in the page", `${(pageBytes / 1e6).toFixed(1)} MB`],
    ["made by", info.program],
  ]);
  showVerification(info);
}

function showVerification(info: MeshInfo): void {
  const box = element("verification");
  const report = info.verification;
  if (!report) return;
  const good = report.items.filter((item) => item.passed).length;
  const text = report.passed ? `agrees with ${report.map}` : `does not agree with ${report.map}`;
  const head = make("p", `The mesh ${text}: ${good} of ${report.items.length} checks passed.`,
                    report.passed ? "" : "bad");
  head.id = "stat-verification";
  box.replaceChildren(head);
  for (const item of report.items.filter((each) => !each.passed)) {
    box.append(make("p", `${item.name}: expected ${item.expected}, found ${item.found}`, "bad"));
  }
}

function regionFacts(cell: number, mesh: LoadedMesh): [string, string, string][] {
  if (mesh.regions.length === 0) return [];
  return [["region", String(mesh.regionTags[mesh.regions[cell]! - 1]!), "picked-region"]];
}

export function showPicked(
  cell: number | null,
  info: MeshInfo,
  mesh: LoadedMesh,
  { quality, positions }: Moments,
  layers: Layers | null,
): void {
  const box = element("picked");
  box.hidden = cell === null;
  if (cell === null) return;
  element("picked-cell").textContent = String(cell);
  fillFacts(element("picked-facts"), [
    ["scaled Jacobian", qualityOf(quality[cell]!).toFixed(4), "picked-quality"],
    ...refutationFacts(cell, info),
    ["layer", String(layers?.ofCells[cell] ?? "...")],
    ...regionFacts(cell, mesh),
  ]);
  const { scale, centre } = sceneOf(info);
  // Not more digits than the quantization has left.
  const digits = Math.max(0, Math.ceil(-Math.log10(info.step)));
  const rows = Array.from({ length: 8 }, (_, k) => {
    const vertex = mesh.cells[8 * cell + k]!;
    const at = [0, 1, 2].map((axis) =>
      (positions[4 * vertex + axis]! / scale + centre[axis]!).toFixed(Math.min(digits, 12)));
    const row = make("tr");
    for (const text of [String(k), String(vertex), ...at]) row.append(make("td", text));
    return row;
  });
  element("picked-corners").querySelector("tbody")!.replaceChildren(...rows);
}

/** Bytes of memory that a mesh takes in the browser, the worker included. */
export function memoryEstimate(info: MeshInfo): number {
  const moments = info.before ? 3 : 1;
  const textures = Math.ceil(info.points / kTextureWidth) * kTextureWidth * 32 * moments;
  const columns = info.tables.find((table) => table.name === "nodes")?.columns ?? 0;
  return textures + info.cells * columns * 2 * 4 + info.cells * (2 * 32 + 3 * 24 + 12 + 12);
}
