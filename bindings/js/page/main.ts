// The page: from what is dropped to what is shown and kept.
import { ColorManagement } from "three";
import { decodeBase64 } from "../viewer/format";
import { element, fillFacts, grouped, make } from "../viewer/ui/dom";
import { MapScene } from "./map_scene";
import type { MeshOptions, SampleOptions } from "../src/types.js";
import type { MapShape, OpenedMap, OpenedMesh, OpenedPart, Source, Start } from "./messages";
import { Session, TaskError } from "./session";

ColorManagement.enabled = false;

/** Their .vtu has 1.9 GB, and Chromium holds no file beyond 2 GB; memory ends later: docs/user/browser.md. */
const kMostCells = 25e6;
const kDownloads = [".vtu", ".mesh", ".msh", ".vtk", ".ovm"];
/** Beside the plain samples: what else the page can do. */
const kMoreSamples: { label: string; kind: string; options: SampleOptions; withoutMap?: boolean }[] = [
  { label: "sphere, damaged", kind: "sphere", options: { cells: 6, refine: 3, defects: 4 } },
  { label: "cylinder, seamless", kind: "cylinder", options: { cells: 4, refine: 3, stretch: 0.3 } },
  { label: "cylinder, without a map", kind: "cylinder", options: { cells: 2, refine: 3 }, withoutMap: true },
];

let session: Session;
let scene: MapScene | null = null;
let map: OpenedMap | null = null;
let mesh: OpenedMesh | null = null;
let part: OpenedPart | null = null;
/** What a new worker reads again. */
let source: { files: File[] } | { sample: Source & { sample: string } } | null = null;
/** Hexahedra that were asked of the quantization of that; 0: it was not quantized. */
let quantized = 0;
let meshUrl = "";

function tell(message: string): void {
  element("problem").textContent = message;
  element("problem").hidden = message === "";
}

function setWorking(working: boolean): void {
  element("working").hidden = !working;
  element("progress").textContent = working ? "Working ..." : "";
  document.body.dataset.working = String(working);
  // So that tests see short work, too.
  if (!working) document.body.dataset.done = String(Number(document.body.dataset.done ?? 0) + 1);
  for (const button of document.querySelectorAll<HTMLButtonElement>("#panel button, #panel select, #panel input")) {
    button.disabled = working;
  }
}

async function bytesOf(file: File): Promise<ArrayBuffer> {
  try {
    return await file.arrayBuffer();
  } catch {
    throw new Error(
      `${file.name} cannot be read: it is a folder, has changed meanwhile, or has more than the 2 GB ` +
      "that browsers read at once.");
  }
}

async function contentOf(): Promise<Source> {
  if (!source) throw new Error("There is nothing to read.");
  if ("sample" in source) return source.sample;
  const files = source.files.map(async (file) => ({ name: file.name, bytes: await bytesOf(file) }));
  return { files: await Promise.all(files) };
}

const messageOf = (error: unknown) => (error instanceof Error ? error.message : String(error));

const buffersOf = (content: Source) => ("files" in content ? content.files.map(({ bytes }) => bytes) : []);

/** A worker that knows what the last one knew, but for the mesh. */
async function recover(): Promise<void> {
  forgetMesh();
  await session.restart();
  if (!map && !part) return;
  const content = await contentOf();
  await session.run("reopen", [content, quantized], buffersOf(content));
  if (part) showPart(part);  // its map has gone with the worker
}

/** The same; without what there was if that does not work, or is cancelled. */
async function recoverOrForget(): Promise<void> {
  try {
    await recover();
  } catch (error) {
    if (!(error instanceof TaskError && error.code === "Cancelled")) tell(messageOf(error));
    forget();
    await session.restart();
  }
}

/** Runs work that people wait for, and tells what went wrong with it. */
async function work(run: () => Promise<void>): Promise<void> {
  tell("");
  setWorking(true);
  try {
    await run();
  } catch (error) {
    const code = error instanceof TaskError ? error.code : "";
    if (code !== "Cancelled") tell(messageOf(error));
    // The memory of the work comes back with another worker.
    if (["Cancelled", "OutOfMemory", "Fault"].includes(code)) await recoverOrForget();
  } finally {
    setWorking(false);
  }
}

function showView(what: "map" | "mesh"): void {
  element("canvas").hidden = what !== "map";
  element("mesh-view").hidden = what !== "mesh";
  element("show-map").setAttribute("aria-pressed", String(what === "map"));
  element("show-mesh").setAttribute("aria-pressed", String(what === "mesh"));
}

function forgetMesh(): void {
  mesh = null;
  element<HTMLIFrameElement>("mesh-view").removeAttribute("src");
  element("mesh-view").hidden = true;
  element("mesh").hidden = true;
  URL.revokeObjectURL(meshUrl);
}

function forget(): void {
  forgetMesh();
  map = part = null;
  for (const id of ["map", "extracting", "quantizing", "meshing", "canvas"]) element(id).hidden = true;
  element("welcome").hidden = false;
}

function showDefects({ report, shape }: OpenedMap): void {
  element("defects").replaceChildren(...report.defects.map((defect, d) => {
    const box = make("div");
    const times = defect.count === 1 ? "once" : `${grouped(defect.count)} times`;
    box.append(make("p", `${defect.code}, ${times}: ${defect.sentence}`, "bad"));
    defect.worst.forEach(({ place, amount }, i) => {
      if (place.kind === "none") return;
      const button = make("button", amount === 0 ? place.text : `${place.text} (${amount.toPrecision(3)})`);
      button.type = "button";
      button.addEventListener("click", () => {
        showView("map");
        scene?.lookAt(shape.places[d]![i]!.centre);
      });
      box.append(button);
    });
    return box;
  }));
}

const scaleValue = () => element<HTMLInputElement>("scale").valueAsNumber;

function showScale(): void {
  const scale = scaleValue();
  element("scale-value").textContent = String(scale);
  element("cells").textContent = grouped((map?.report.expected?.cells ?? 0) * scale ** 3);
}

function showMap(opened: OpenedMap): void {
  map = opened;
  const { report } = opened;
  element("welcome").hidden = true;
  element("map").hidden = false;
  element("map-name").textContent = opened.name;
  fillFacts(element("map-facts"), [
    ["points", grouped(report.points)],
    ["tets", grouped(report.tets), "map-tets"],
    ["singular edges", grouped([report.inner_singular_tet_edges, report.boundary_singular_tet_edges]
      .flatMap((counts) => Object.values(counts)).reduce((sum, n) => sum + n, 0))],
  ]);
  element("verdict").textContent = report.valid ? "The map is valid." : "The map is not valid:";
  showDefects(opened);
  element("extracting").hidden = !report.valid || part !== null;  // of a part, the mesh is there
  if (report.expected) {
    const most = Math.max(1, Math.floor(Math.cbrt(kMostCells / report.expected.cells)));
    const slider = element<HTMLInputElement>("scale");
    slider.max = String(Math.min(most, 100));
    slider.value = "1";
    showScale();
  }
  const seamless = !report.valid && report.kind !== "neither";
  element("quantizing").hidden = !seamless;
  element("quantize-hint").textContent =
    `The map is ${report.kind}: its integers are still to be chosen.`;
  draw(opened.shape);
}

function draw(shape: MapShape): void {
  showView("map");
  try {
    scene ??= new MapScene(element<HTMLCanvasElement>("canvas"));
    scene.show(shape);
  } catch (error) {
    tell(`The map cannot be drawn, but all else works. ${messageOf(error)}`);
  }
}

function showPart(opened: OpenedPart): void {
  map = null;
  part = opened;
  for (const id of ["welcome", "extracting", "quantizing"]) element(id).hidden = true;
  for (const id of ["map", "meshing"]) element(id).hidden = false;
  element("map-name").textContent = opened.name;
  fillFacts(element("map-facts"), [["points", grouped(opened.points)], ["tets", grouped(opened.tets), "map-tets"]]);
  element("verdict").textContent = "There is no map on these tets.";
  element("defects").replaceChildren();
  draw(opened.shape);
}

function showMesh(opened: OpenedMesh, why = ""): void {
  mesh = opened;
  const { quality, validity } = opened.certificate;
  element("welcome").hidden = true;
  element("mesh").hidden = false;
  element("mesh-name").textContent = opened.name;
  const bad = validity.refuted + validity.undecided;
  fillFacts(element("mesh-facts"), [
    ["cells", grouped(opened.cells), "mesh-cells"],
    ["vertices", grouped(opened.vertices)],
    ["scaled Jacobian", `${quality.minimum.toFixed(3)} to 1, mean ${quality.mean.toFixed(3)}`],
    ["valid everywhere", bad === 0 ? "all cells, proven" : `all but ${grouped(bad)}`, "valid-cells"],
  ]);
  const { verification } = opened;
  const failed = verification?.items.filter(({ passed }) => !passed) ?? [];
  const box = element("verification");
  box.className = failed.length > 0 ? "bad" : "";
  box.textContent = !verification
    ? "There is no valid map to compare the mesh with."
    : failed.length === 0
      ? `Verified: it is the mesh of ${map!.name} at scale ${opened.scale}.`
      : `It is not the mesh of ${map!.name} at scale ${opened.scale}: ` +
        failed.map(({ name, expected, found }) => `${name} ${found} instead of ${expected}`).join("; ");
  element("why").textContent = why;
  URL.revokeObjectURL(meshUrl);
  if (typeof opened.view === "string") {
    tell(opened.view);
    return;
  }
  meshUrl = URL.createObjectURL(new Blob([opened.view], { type: "text/html" }));
  opened.view = new Uint8Array(0);  // the blob has it
  element<HTMLIFrameElement>("mesh-view").src = meshUrl;
  showView("mesh");
}

/** Reads files or makes a sample; what there was before is given up. */
function open(from: NonNullable<typeof source>): Promise<void> {
  return work(async () => {
    forget();
    source = from;
    quantized = 0;
    await session.restart();
    const content = await contentOf();
    const opened = await session.run("open", [content], buffersOf(content));
    element("part-hint").textContent = opened.noMap;
    if (opened.part) showPart(opened.part);
    if (opened.map) showMap(opened.map);
    element("show-map").hidden = !opened.map && !opened.part;
    if (opened.mesh) showMesh(opened.mesh);
  });
}

function extract(): Promise<void> {
  return work(async () => {
    forgetMesh();
    showView("map");
    showMesh(await session.run("extract", [scaleValue()]));
  });
}

function cellsIn(id: string): number {
  const wanted = element<HTMLInputElement>(id).valueAsNumber;
  if (!(wanted >= 1)) throw new Error("Say about how many hexahedra it shall be.");
  return wanted;
}

function meshPart(): Promise<void> {
  return work(async () => {
    const cells = cellsIn("part-cells");
    const method = element<HTMLSelectElement>("method").value as MeshOptions["method"];
    forgetMesh();
    showPart(part!);
    const made = await session.run("mesh", [{ cells, method }]);
    showMap(made.map);
    showMesh(made.mesh, made.why && `Kept: ${made.why}.`);
  });
}

function quantize(): Promise<void> {
  return work(async () => {
    const wanted = cellsIn("wanted");
    forgetMesh();
    const opened = await session.run("quantize", [wanted]);
    quantized = wanted;
    showMap(opened);
  });
}

function download(extension: string): Promise<void> {
  return work(async () => {
    const name = mesh!.name.replace(/\.[^.]*$/, "") + extension;
    const bytes = await session.run("write", [name]);
    const link = make("a");
    link.href = URL.createObjectURL(new Blob([bytes]));
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 60000);
  });
}

function openFiles(files: File[]): void {
  if (files.length > 0 && document.body.dataset.working === "false") void open({ files });
}

function bindDrop(): void {
  const over = (is: boolean) => document.body.classList.toggle("over", is);
  document.addEventListener("dragover", (event) => {
    event.preventDefault();
    over(true);
  });
  document.addEventListener("dragleave", () => over(false));
  document.addEventListener("drop", (event) => {
    event.preventDefault();
    over(false);
    openFiles([...(event.dataTransfer?.files ?? [])]);
  });
  // What is dropped on the mesh, which is a page of its own.
  window.addEventListener("message", (event) => {
    if (event.source !== element<HTMLIFrameElement>("mesh-view").contentWindow) return;
    openFiles((event.data as File[]).filter((file) => file instanceof File));
  });
}

function bind({ version, formats, samples }: Start): void {
  const names = (can: "readsMaps" | "readsHexMeshes" | "readsTets") =>
    [...new Set(formats.filter((format) => format[can]).map(({ extension }) => extension))].filter(Boolean).join(", ");
  element("map-formats").textContent = names("readsMaps");
  element("mesh-formats").textContent = names("readsHexMeshes");
  element("tet-formats").textContent = names("readsTets");
  element("version").textContent = `hexhex ${version}`;
  const menu = element<HTMLSelectElement>("samples");
  const entries: typeof kMoreSamples = [
    ...samples.map(({ name, description }) => ({ label: `${name}: ${description}`, kind: name, options: {} })),
    ...kMoreSamples,
  ];
  entries.forEach(({ label }, i) => {
    const option = make("option", label);
    option.value = String(i);
    menu.append(option);
  });
  menu.addEventListener("change", () => {
    const entry = entries[Number(menu.value)];
    const chosen = menu.value !== "" && entry;
    menu.value = "";
    if (!chosen) return;
    const { kind, options, withoutMap } = chosen;
    void open({ sample: { sample: kind, options, ...(withoutMap && { withoutMap }) } });
  });
  const input = element<HTMLInputElement>("files");
  input.addEventListener("change", () => {
    const files = [...(input.files ?? [])];
    input.value = "";
    if (files.length > 0) void open({ files });
  });
  element("scale").addEventListener("input", showScale);
  element("extract").addEventListener("click", () => void extract());
  element("quantize").addEventListener("click", () => void quantize());
  element("mesh-part").addEventListener("click", () => void meshPart());
  element("cancel").addEventListener("click", () => session.cancel());
  element("show-map").addEventListener("click", () => showView("map"));
  element("show-mesh").addEventListener("click", () => showView("mesh"));
  for (const extension of kDownloads) {
    const button = make("button", extension);
    button.type = "button";
    button.addEventListener("click", () => void download(extension));
    element("downloads").append(button);
  }
}

async function start(): Promise<void> {
  window.addEventListener("unhandledrejection", (event) => tell(String(event.reason)));
  const holder = element("wasm");
  const packed = decodeBase64(holder.textContent!);
  holder.remove();
  const unpacked = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  const module = await WebAssembly.compile(await new Response(unpacked).arrayBuffer());
  session = new Session(
    module,
    (stage, share) => (element("progress").textContent = `${stage} ... ${Math.round(share * 100)} %`),
    (bytes) => (element("memory").textContent = `${Math.round(bytes / 2 ** 20)} MB of memory in use`),
  );
  for (const id of ["wanted", "part-cells"]) element<HTMLInputElement>(id).max = String(kMostCells);
  bind(await session.restart());
  bindDrop();
  setWorking(false);
  document.body.dataset.ready = "true";
}

start().catch((error: unknown) => {
  // Browsers that are older lack one of these.
  const old = typeof DecompressionStream === "undefined" || error instanceof WebAssembly.CompileError;
  tell(old ? "This page needs a newer browser: Chrome 95, Firefox 113, Safari 16.4, or later ones." : messageOf(error));
});
