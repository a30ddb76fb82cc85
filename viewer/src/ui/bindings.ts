// What buttons, sliders, keys and clicks do.
import type { App } from "../app";
import { kFlags, type SliceDirection } from "../state";
import { element, make, showProblem } from "./dom";

interface Shortcut {
  keys: string[];
  shown: string;
  what: string;
  run: (app: App) => void;
}

const kShortcuts: Shortcut[] = [
  { keys: ["a"], shown: "A", what: "before or after the improvement, if the page shows both", run: (app) => app.otherMoment() },
  { keys: ["x"], shown: "X", what: "slice across x, or none", run: (app) => app.slice("x") },
  { keys: ["y"], shown: "Y", what: "slice across y, or none", run: (app) => app.slice("y") },
  { keys: ["z"], shown: "Z", what: "slice across z, or none", run: (app) => app.slice("z") },
  { keys: ["v"], shown: "V", what: "slice across the view, or none", run: (app) => app.slice("view") },
  { keys: ["f"], shown: "F", what: "keep the other side", run: (app) => app.flip() },
  { keys: [","], shown: ",", what: "move the slice back", run: (app) => app.moveSlice(-1) },
  { keys: ["."], shown: ".", what: "move the slice on", run: (app) => app.moveSlice(1) },
  { keys: ["]", "+"], shown: "+", what: "peel a layer", run: (app) => app.morePeel(1) },
  { keys: ["[", "-"], shown: "-", what: "put a layer back", run: (app) => app.morePeel(-1) },
  { keys: ["c"], shown: "C", what: "next colouring", run: (app) => app.nextColour() },
  { keys: ["g"], shown: "G", what: "edges of cells", run: (app) => app.toggle("grid") },
  { keys: ["e"], shown: "E", what: "singular edges inside", run: (app) => app.toggle("inner") },
  { keys: ["b"], shown: "B", what: "singular edges on the boundary", run: (app) => app.toggle("boundary") },
  { keys: ["o"], shown: "O", what: "ghost of what is cut away", run: (app) => app.toggle("ghost") },
  { keys: ["r"], shown: "R", what: "rounded cells", run: (app) => app.toggle("rounded") },
  { keys: ["t"], shown: "T", what: "tagged edges", run: (app) => app.toggle("features") },
  { keys: ["u"], shown: "U", what: "curved or straight cells, if they are of higher order", run: (app) => app.toggle("curved") },
  { keys: ["k"], shown: "K", what: "clicks take cells away, or pick them", run: (app) => app.toggleDigging() },
  { keys: ["Backspace"], shown: "Backspace", what: "put the last cell back", run: (app) => app.undo() },
  { keys: ["w"], shown: "W", what: "go to the worst of the kept cells, and show it alone", run: (app) => app.pickWorst() },
  { keys: ["i"], shown: "I", what: "the picked cell alone, or all again", run: (app) => app.isolate() },
  { keys: ["h"], shown: "H", what: "the view at the start", run: (app) => app.look("home") },
  { keys: ["1"], shown: "1", what: "look from +x", run: (app) => app.look("x") },
  { keys: ["2"], shown: "2", what: "look from +y", run: (app) => app.look("y") },
  { keys: ["3"], shown: "3", what: "look from +z", run: (app) => app.look("z") },
  { keys: ["s"], shown: "S", what: "save a picture", run: (app) => void app.savePicture() },
  { keys: ["l"], shown: "L", what: "copy a link to this view", run: (app) => void app.copyLink() },
  { keys: ["d"], shown: "D", what: "dark or light", run: (app) => app.toggleTheme() },
  { keys: ["p"], shown: "P", what: "show or hide the panel", run: () => togglePanel() },
  { keys: ["Escape"], shown: "Esc", what: "no picked cell", run: (app) => app.unpick() },
  { keys: ["?"], shown: "?", what: "this list", run: () => showShortcuts() },
];

function togglePanel(): void {
  const folded = document.body.classList.toggle("folded");
  element("panel-toggle").setAttribute("aria-expanded", String(!folded));
}

function showShortcuts(): void {
  const dialog = element<HTMLDialogElement>("shortcuts");
  dialog.showModal();
  dialog.scrollTop = 0; // the focus goes to the button at its end
}

function listShortcuts(): void {
  for (const { shown, what } of kShortcuts) {
    const term = make("dt");
    term.append(make("kbd", shown));
    element("shortcut-list").append(term, make("dd", what));
  }
}

const onClick = (id: string, run: () => void) => element(id).addEventListener("click", run);

function bindControls(app: App): void {
  for (const button of document.querySelectorAll<HTMLElement>("[data-slice]")) {
    button.addEventListener("click", () => app.slice(button.dataset.slice as SliceDirection));
  }
  for (const button of document.querySelectorAll<HTMLElement>("[data-moment]")) {
    button.addEventListener("click", () => app.change({ moment: Number(button.dataset.moment) }));
  }
  for (const button of document.querySelectorAll<HTMLElement>("[data-look]")) {
    button.addEventListener("click", () => app.look(button.dataset.look as "home"));
  }
  const number = (id: string) => element<HTMLInputElement>(id).valueAsNumber;
  element("slice-position").addEventListener("input", () =>
    app.change({ position: number("slice-position") / 1000 }));
  element("moment").addEventListener("input", () => app.change({ moment: number("moment") / 1000 }));
  element("peel").addEventListener("input", () => app.peel(number("peel")));
  for (const id of ["quality-from", "quality-to"]) {
    element(id).addEventListener("change", () =>
      app.setQuality([number("quality-from"), number("quality-to")]));
  }
  const colour = element<HTMLSelectElement>("colour");
  colour.addEventListener("change", () => app.setColour(colour.value));
  for (const flag of kFlags) {
    element(`show-${flag}`).addEventListener("change", () => app.toggle(flag));
  }
  onClick("slice-flip", () => app.flip());
  onClick("quality-all", () => app.setQuality([-1, 1]));
  onClick("dig", () => app.toggleDigging());
  onClick("undo", () => app.undo());
  onClick("isolate", () => app.isolate());
  onClick("worst", () => app.pickWorst());
  onClick("share", () => void app.copyLink());
  onClick("theme", () => app.toggleTheme());
  onClick("picture", () => {
    app.savePicture().catch((error: unknown) => showProblem(String(error)));
  });
}

function bindKeys(app: App): void {
  document.addEventListener("keydown", (event) => {
    const undo = (event.ctrlKey || event.metaKey) && event.key === "z";
    if ((event.ctrlKey || event.altKey || event.metaKey) && !undo) return;
    const target = event.target as HTMLElement;
    // Where people type, keys are text. A dialog that was just closed may still have the focus.
    if (target.matches("input[type=number], select, dialog[open] *")) return;
    const pressed = undo ? "Backspace" : event.key;
    const shortcut = kShortcuts.find(({ keys }) =>
      keys.includes(pressed.length === 1 ? pressed.toLowerCase() : pressed));
    if (!shortcut) return;
    event.preventDefault();
    shortcut.run(app);
  });
}

/** A short press without much movement is a click; anything else moves the camera. */
function bindPicking(app: App): void {
  const canvas = element("canvas");
  let begin: { x: number; y: number; time: number } | null = null;
  canvas.addEventListener("pointerdown", (event) => {
    begin = event.isPrimary && event.button === 0
      ? { x: event.offsetX, y: event.offsetY, time: event.timeStamp }
      : null;
  });
  canvas.addEventListener("pointerup", (event) => {
    if (!begin || !event.isPrimary) return;
    const moved = Math.hypot(event.offsetX - begin.x, event.offsetY - begin.y);
    if (moved < 6 && event.timeStamp - begin.time < 600) app.clickAt(event.offsetX, event.offsetY, event.shiftKey);
    begin = null;
  });
}

/** What works before the mesh is there. */
export function bindPage(): void {
  onClick("panel-toggle", togglePanel);
  onClick("help", showShortcuts);
  listShortcuts();
}

export function bindApp(app: App): void {
  bindControls(app);
  bindKeys(app);
  bindPicking(app);
}
