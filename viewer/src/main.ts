// The page: reads what it holds, loads it in the worker, then shows it.
import { ColorManagement } from "three";
import { App } from "./app";
import { load, MeshWorker, readInfo } from "./load";
import { bindApp, bindPage } from "./ui/bindings";
import { element, showProblem } from "./ui/dom";
import { showStatistics } from "./ui/statistics";

// Colours are numbers of the screen throughout, so that the legend shows the same ones.
ColorManagement.enabled = false;

window.addEventListener("error", (event) => showProblem(event.message));
window.addEventListener("unhandledrejection", (event) => showProblem(String(event.reason)));

async function start(): Promise<void> {
  bindPage();
  const info = readInfo();
  element("title").textContent = info.title;
  showStatistics(info);
  const worker = new MeshWorker(
    (what, share) => (element("progress").textContent = `${what} ... ${Math.round(share * 100)} %`),
    (mesh) => {
      element("progress").textContent = "";
      bindApp(new App(info, mesh, worker));
      document.body.dataset.loaded = "true";
    },
    showProblem,
  );
  await load(info, worker);
}

// Inside of hexhex.html, files that are dropped on the mesh are for that page.
if (window.parent !== window) {
  document.addEventListener("dragover", (event) => event.preventDefault());
  document.addEventListener("drop", (event) => {
    event.preventDefault();
    window.parent.postMessage([...(event.dataTransfer?.files ?? [])], "*");
  });
}

if (document.createElement("canvas").getContext("webgl2")) {
  start().catch((error: unknown) => showProblem(String(error)));
} else {
  showProblem("This browser has no WebGL 2, which the viewer draws with. Switch on hardware " +
    "acceleration, or take another browser.");
}
