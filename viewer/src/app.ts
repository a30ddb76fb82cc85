// The loaded page: one state; what changes it, and what it changes.
import { kPickedColour } from "./colours";
import { EdgeCurves, kCellEdges } from "./curves";
import { type MeshInfo, qualityOf, storedQuality } from "./format";
import type { MeshWorker } from "./load";
import { isBefore, Moments } from "./moments";
import { thinLines, wideLines } from "./scene/lines";
import { badSegments, featureSegments, singularSegments } from "./scene/segments";
import { type ColourMode, kColourModes, Surface } from "./scene/surface";
import { Viewport } from "./scene/viewport";
import { sceneOf } from "./scene_box";
import { type Flag, fromFragment, kFlags, kStart, type Normal, type SliceDirection, toFragment, type ViewState } from "./state";
import { element, grouped } from "./ui/dom";
import { Histogram } from "./ui/histogram";
import { Legend } from "./ui/legend";
import { askedPicture, savePng } from "./ui/picture";
import { listPatches } from "./ui/patches";
import { infoAt, showImprovement, showPicked, showStatistics } from "./ui/statistics";
import { ballAround, worstKept } from "./worst";
import type { LoadedMesh } from "./worker/messages";
import type { CurvedFaces } from "./worker/curved_faces";
import type { Layers } from "./worker/topology";
import type { Filter, Visible } from "./worker/visible";

const kAxes: Record<"x" | "y" | "z", [number, number, number]> = {
  x: [1, 0, 0],
  y: [0, 1, 0],
  z: [0, 0, 1],
};

/** A share of a cell of a mesh of 100 cells per side: steps of the slice by keys. */
const kSliceStep = 0.01;

/** Points of the mesh that show how large it is: not all of many. */
function outlineOf({ points }: MeshInfo, { after, before }: LoadedMesh): Float32Array {
  const step = 4 * Math.ceil(points / 1e5);
  const outline: number[] = [];
  for (const moment of [after, before]) {
    for (let at = 0; moment && at < 4 * points; at += step) outline.push(...moment.positions.subarray(at, at + 4));
  }
  return Float32Array.from(outline);
}

export class App {
  private state: ViewState;
  private readonly viewport: Viewport;
  private readonly surface: Surface;
  private readonly histogram: Histogram;
  private readonly legend = new Legend(element("legend"));
  private readonly moments: Moments;
  private readonly curves: EdgeCurves | null;
  private lines;
  /** Whether the lines are those of curved cells. */
  private curvedLines: boolean;
  private pickedOutline = wideLines({ vertices: [], colours: [] }, new Float32Array(0), null, 1);
  private fragmentTimer = 0;
  /** Known a while after the mesh is there. */
  private layers: Layers | null = null;
  /** Whether clicks take cells away. */
  private digging = false;

  constructor(
    private readonly info: MeshInfo,
    private readonly mesh: LoadedMesh,
    private readonly worker: MeshWorker,
  ) {
    this.state = this.stateOf(location.hash);
    this.dropUnknown();

    const { half } = sceneOf(info);
    const canvas = element<HTMLCanvasElement>("canvas");
    this.viewport = new Viewport(canvas, half, outlineOf(info, mesh), () => this.saveFragment());
    this.moments = new Moments(mesh.after, mesh.before);
    this.moments.show(this.state.moment);
    this.surface = new Surface(mesh, this.moments);
    this.viewport.setSurface(this.surface);
    const { positions } = this.moments;
    this.curves = mesh.order > 1 ? new EdgeCurves({ ...mesh, positions }) : null;
    this.curvedLines = this.curved();
    this.lines = this.makeLines();
    this.histogram = new Histogram(
      element<HTMLCanvasElement>("histogram"),
      Math.min(info.quality.minimum, info.before?.quality.minimum ?? 1),
      (range) => this.change({ quality: range }),
    );
    worker.onLit = (light) => this.showLit(light);
    worker.onLayers = (layers) => this.setLayers(layers);
    worker.onVisible = (visible, curved, milliseconds) => this.showVisible(visible, curved, milliseconds);
    this.fillControls();
    this.placeCamera();
    this.applyTheme();
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.applyTheme());
    window.addEventListener("hashchange", () => this.restore(location.hash));
    this.update();
  }

  /** Changes the state and all that follows from it. */
  change(part: Partial<ViewState>): void {
    this.state = { ...this.state, ...part };
    this.update();
    this.saveFragment();
  }

  /** Slices through the middle; another click on the same direction switches the slice off. */
  slice(direction: SliceDirection): void {
    if (direction === "off" || direction === this.state.slice) return this.change({ slice: "off" });
    const towards = this.viewport.viewDirection();
    // The cut is what one wants to see.
    const away = towards["xyz".indexOf(direction)]! < 0;
    const normal = direction === "view" ? towards : (kAxes[direction].map((n) => (away ? -n : n) + 0) as Normal);
    this.change({ slice: direction, normal, position: 0.5 });
  }

  flip(): void {
    const [x, y, z] = this.state.normal;
    this.change({ normal: [-x, -y, -z], position: 1 - this.state.position });
  }

  moveSlice(steps: number): void {
    if (this.state.slice === "off") return;
    const position = this.state.position + steps * kSliceStep;
    this.change({ position: Math.min(Math.max(position, 0), 1) });
  }

  peel(layers: number): void {
    this.change({ peel: Math.max(layers, 0) });
  }

  morePeel(by: number): void {
    this.peel(this.state.peel + by);
  }

  nextColour(): void {
    const modes = kColourModes.filter((mode) => this.hasColour(mode));
    const next = modes.indexOf(this.state.colour) + 1;
    this.change({ colour: modes[next % modes.length]! });
  }

  toggle(flag: Flag): void {
    this.change({ [flag]: !this.state[flag] });
  }

  /** Goes from before to after the improvement, or back. */
  otherMoment(): void {
    if (this.info.before) this.change({ moment: isBefore(this.state.moment) ? 1 : 0 });
  }

  look(direction: "home" | "x" | "y" | "z"): void {
    this.viewport.look(direction === "home" ? undefined : kAxes[direction]);
    this.saveFragment();
  }

  toggleTheme(): void {
    this.state = { ...this.state, theme: this.isDark() ? "light" : "dark" };
    this.applyTheme();
    this.saveFragment();
  }

  /** What a click does: picks a cell, or takes it away. */
  clickAt(x: number, y: number, dig: boolean): void {
    const cell = this.viewport.pick(x, y);
    if (!dig && !this.digging) return this.change({ picked: cell, isolated: false });
    if (cell === null) return;
    const picked = this.state.picked === cell ? null : this.state.picked;
    this.change({ dug: [...this.state.dug, cell], picked, isolated: false });
  }

  toggleDigging(): void {
    this.digging = !this.digging;
    this.showControls();
  }

  /** Puts the cell back that was taken away last. */
  undo(): void {
    this.change({ dug: this.state.dug.slice(0, -1) });
  }

  unpick(): void {
    this.change({ picked: null, isolated: false });
  }

  /** Shows the picked cell alone, or with all others again. */
  isolate(): void {
    if (this.state.picked !== null) this.change({ isolated: !this.state.isolated });
  }

  /** Picks the worst of the cells that the filter keeps, goes close to it, and shows it alone. */
  pickWorst(): void {
    const worst = worstKept(this.mesh.cells, this.moments, this.layers, this.filter());
    if (worst === null) return;
    const { centre, radius } = ballAround(this.mesh.cells, this.moments, worst);
    this.viewport.approach(centre, radius);
    this.change({ picked: worst, isolated: true });
  }

  /** Saves what is on the canvas, as large as is asked for. */
  async savePicture(): Promise<void> {
    const wanted = askedPicture(element("canvas"));
    if (!wanted) return;
    const picture = this.viewport.picture(wanted.width, wanted.height, wanted.transparent);
    if (wanted.legend) {
      const { clientWidth, clientHeight } = element("canvas");
      const ratio = Math.min(picture.width / clientWidth, picture.height / clientHeight);
      const text = getComputedStyle(document.documentElement).getPropertyValue("--text");
      this.legend.draw(picture, ratio, text);
    }
    await savePng(picture, `${this.info.title.replace(/\.[^.]*$/, "")}.png`);
  }

  async copyLink(): Promise<void> {
    this.writeFragment();
    // Pages of files have no clipboard in some browsers; the address bar has the link anyway.
    await navigator.clipboard?.writeText(location.href).catch(() => undefined);
    const button = element("share");
    button.textContent = "Link is in the address bar";
    setTimeout(() => (button.textContent = "Link"), 2000);
  }

  private restore(fragment: string): void {
    if (fragment.replace(/^#/, "") === toFragment(this.state)) return;
    this.state = this.stateOf(fragment);
    this.dropUnknown();
    this.placeCamera();
    this.applyTheme();
    this.update();
  }

  private placeCamera(): void {
    if (this.state.camera) this.viewport.cameraState = this.state.camera;
    else this.viewport.look(this.info.start?.from);
  }

  /** What an address says; one that says nothing leaves the choice to the page. */
  private stateOf(fragment: string): ViewState {
    const state = fromFragment(fragment);
    if (fragment.length < 2 && this.info.start) state.colour = this.info.start.colour;
    return state;
  }

  /** An address may come from another mesh. */
  private dropUnknown(): void {
    const { state, info } = this;
    if (!info.before) state.moment = kStart.moment;
    state.dug = state.dug.filter((cell) => cell < info.cells);
    if (state.picked === null || state.picked < info.cells) return;
    state.picked = null;
    state.isolated = false;
  }

  private storedRange(): [number, number] {
    return [storedQuality(this.state.quality[0]), storedQuality(this.state.quality[1])];
  }

  private filter(): Filter {
    const { slice, normal, position, peel } = this.state;
    const { half } = sceneOf(this.info);
    const reach = normal.reduce((sum, n, axis) => sum + Math.abs(n) * half[axis]!, 0);
    return {
      plane: slice === "off" ? null : { normal, offset: (2 * position - 1) * reach },
      firstLayer: peel,
      quality: this.storedRange(),
      dug: this.state.dug,
      isolated: this.state.isolated ? this.state.picked : null,
    };
  }

  private update(): void {
    const { state } = this;
    state.peel = Math.min(state.peel, this.layers?.deepest ?? state.peel);
    this.worker.show({ filter: this.filter(), curved: this.curved(), moment: state.moment });
    const moved = this.moments.show(state.moment);
    if (moved) this.surface.showMoment();
    if (moved || this.curvedLines !== this.curved()) this.remakeLines();
    document.body.dataset.busy = "true";
    this.surface.setColouring(state.colour);
    this.surface.showGrid(state.grid);
    this.surface.setPicked(state.isolated ? null : state.picked);
    this.lines.inner.visible = state.inner;
    this.lines.boundary.visible = state.boundary;
    this.lines.features.visible = state.features;
    this.lines.creases.visible = state.ghost && !state.isolated;
    this.lines.bad.visible = state.colour === "quality" && !state.isolated;
    this.surface.showGhost(state.ghost, state.isolated);
    this.surface.showRounded(state.rounded);
    this.outlinePicked();
    this.showControls();
    this.histogram.setRange(state.quality);
    this.showFacts();
    this.viewport.redraw();
  }

  /** What panel and legend say of the mesh. */
  private showFacts(): void {
    const info = infoAt(this.info, this.state.moment);
    this.legend.update(this.state, info, this.mesh, this.layers);
    showPicked(this.state.picked, info, this.mesh, this.moments, this.layers);
    showStatistics(info);
  }

  /** Whether cells are drawn curved. */
  private curved(): boolean {
    return this.curves !== null && this.state.curved;
  }

  private makeLines() {
    const { singularEdges, featureEdges, creases } = this.mesh;
    const { positions } = this.moments;
    const curves = this.curvedLines ? this.curves : null;
    const lines = {
      inner: wideLines(singularSegments(singularEdges, false), positions, curves, 3),
      boundary: wideLines(singularSegments(singularEdges, true), positions, curves, 2),
      features: wideLines(featureSegments(featureEdges), positions, curves, 2.5),
      bad: wideLines(badSegments(this.mesh.cells, this.moments), positions, curves, 2),
      creases: thinLines(creases, positions, curves),
    };
    for (const object of Object.values(lines)) this.viewport.add(object);
    return lines;
  }

  private remakeLines(): void {
    for (const object of Object.values(this.lines)) this.viewport.remove(object);
    this.curvedLines = this.curved();
    this.lines = this.makeLines();
  }

  /** Whether the mesh has what a colouring shows. */
  private hasColour(mode: ColourMode): boolean {
    if (mode === "generator") return this.info.hasGenerators;
    if (mode === "feature") return this.mesh.quadTags.length > 0;
    if (mode === "patch") return this.info.patches.length > 0;
    if (mode === "region") return this.mesh.regionTags.length > 0;
    return true;
  }

  private outlinePicked(): void {
    this.viewport.remove(this.pickedOutline);
    const cell = this.state.picked;
    const vertices =
      cell === null ? [] : kCellEdges.map((corner) => this.mesh.cells[8 * cell + corner]!);
    const colours = vertices.slice(0, vertices.length / 2).map(() => kPickedColour);
    const curves = this.curved() ? this.curves : null;
    this.pickedOutline = wideLines({ vertices, colours }, this.moments.positions, curves, 2.5);
    this.viewport.add(this.pickedOutline);
  }

  private showVisible(visible: Visible, curved: CurvedFaces | null, milliseconds: number): void {
    this.surface.setQuads(visible, curved);
    element("curved-pieces").hidden = curved === null;
    element("drawn-pieces").textContent = String((curved?.pieces ?? 1) ** 2);
    element("kept-cells").textContent = grouped(visible.kept);
    element("drawn-quads").textContent = grouped(visible.quads.length / 6);
    this.histogram.set(visible.histogramCandidates, visible.histogramKept);
    document.body.dataset.milliseconds = milliseconds.toFixed(1);
    this.viewport.redraw();
  }

  private setLayers(layers: Layers): void {
    this.layers = layers;
    this.surface.setLayers(layers);
    element("peel-most").textContent = String(layers.deepest);
    const slider = element<HTMLInputElement>("peel");
    slider.max = String(layers.deepest);
    slider.disabled = false;
    if (this.state.peel > layers.deepest) this.change({ peel: layers.deepest });
    slider.value = String(this.state.peel);
    this.showFacts();
    this.viewport.redraw();
  }

  private showLit(light: Uint8Array<ArrayBuffer>): void {
    this.surface.setLight(light);
    document.body.dataset.busy = "false";
    this.viewport.redraw();
  }

  /** What does not change any more. */
  private fillControls(): void {
    element("all-cells").textContent = grouped(this.info.cells);
    const colours = element<HTMLSelectElement>("colour");
    for (const option of colours.options) {
      option.disabled = !this.hasColour(option.value as ColourMode);
    }
    element("moments").hidden = !this.info.before;
    showImprovement(this.info);
    listPatches(this.info, () => this.showFacts());
    element("show-curved").closest("label")!.hidden = this.mesh.order === 1;
    const noFeatures = this.mesh.featureEdges.length === 0;
    element("show-features").closest("label")!.hidden = noFeatures;
    element("controls").inert = false;
  }

  private showControls(): void {
    const { state } = this;
    for (const button of document.querySelectorAll<HTMLElement>("[data-slice]")) {
      button.setAttribute("aria-pressed", String(button.dataset.slice === state.slice));
    }
    for (const button of document.querySelectorAll<HTMLElement>("[data-moment]")) {
      button.setAttribute("aria-pressed", String(Number(button.dataset.moment) === state.moment));
    }
    element<HTMLInputElement>("moment").value = String(state.moment * 1000);
    const slider = element<HTMLInputElement>("slice-position");
    slider.disabled = state.slice === "off";
    slider.value = String(state.position * 1000);
    element<HTMLInputElement>("peel").value = String(state.peel);
    element("peel-value").textContent = String(state.peel);
    const lowest = Math.max(state.quality[0], Math.floor(qualityOf(0)));
    element<HTMLInputElement>("quality-from").value = String(Number(lowest.toFixed(4)));
    element<HTMLInputElement>("quality-to").value = String(Number(state.quality[1].toFixed(4)));
    element("dig").setAttribute("aria-pressed", String(this.digging));
    element<HTMLButtonElement>("undo").disabled = state.dug.length === 0;
    element("dug").textContent = state.dug.length === 0 ? "" : `${grouped(state.dug.length)} taken away`;
    element("isolate").setAttribute("aria-pressed", String(state.isolated));
    element("canvas").classList.toggle("digging", this.digging);
    element<HTMLSelectElement>("colour").value = state.colour;
    for (const flag of kFlags) {
      element<HTMLInputElement>(`show-${flag}`).checked = state[flag];
    }
  }

  private isDark(): boolean {
    if (this.state.theme !== "system") return this.state.theme === "dark";
    return matchMedia("(prefers-color-scheme: dark)").matches;
  }

  private applyTheme(): void {
    const root = document.documentElement;
    if (this.state.theme === "system") delete root.dataset.theme;
    else root.dataset.theme = this.state.theme;
    this.viewport.setBackground(getComputedStyle(root).getPropertyValue("--back").trim());
    this.histogram.draw();
  }

  private saveFragment(): void {
    // Browsers refuse to be told of a new address too often.
    clearTimeout(this.fragmentTimer);
    this.fragmentTimer = window.setTimeout(() => this.writeFragment(), 250);
  }

  private writeFragment(): void {
    this.state.camera = this.viewport.cameraState;
    history.replaceState(null, "", `#${toFragment(this.state)}`);
  }

  setQuality(range: [number, number]): void {
    if (!range.every(Number.isFinite)) return this.update();
    const clamp = (x: number) => Math.min(Math.max(x, -1), 1);
    this.change({ quality: [clamp(range[0]), clamp(range[1])] });
  }

  setColour(mode: string): void {
    this.change({ colour: kColourModes.find((each) => each === mode) ?? kStart.colour });
  }
}

export type { ColourMode };
