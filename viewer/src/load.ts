// From what the page holds to a loaded mesh: hands the compressed chunks to the worker.
import type { MeshInfo } from "./format";
import { element, grouped, make } from "./ui/dom";
import { memoryEstimate } from "./ui/statistics";
import type { FromWorker, LoadedMesh, ToWorker, Wanted } from "./worker/messages";
import type { CurvedFaces } from "./worker/curved_faces";
import type { Layers } from "./worker/topology";
import type { Visible } from "./worker/visible";

/** From here on a browser may run out of memory, so the page asks before it loads. */
const kManyCells = 5e6;

declare const WORKER_SOURCE: string;

export class MeshWorker {
  onVisible: (visible: Visible, curved: CurvedFaces | null, milliseconds: number) => void = () => {};
  onLit: (light: Uint8Array<ArrayBuffer>) => void = () => {};
  onLayers: (layers: Layers) => void = () => {};
  private readonly worker: Worker;
  private running = false;
  private next: Wanted | null = null;

  constructor(
    private readonly onProgress: (what: string, share: number) => void,
    private readonly onLoaded: (mesh: LoadedMesh) => void,
    private readonly onFailed: (message: string) => void,
  ) {
    const source = new Blob([WORKER_SOURCE], { type: "text/javascript" });
    this.worker = new Worker(URL.createObjectURL(source));
    this.worker.onmessage = (event: MessageEvent<FromWorker>) => this.handle(event.data);
    this.worker.onerror = (event) => this.onFailed(event.message || "The worker has failed.");
  }

  send(message: ToWorker, transfer: Transferable[] = []): void {
    this.worker.postMessage(message, transfer);
  }

  /** Asks for the faces of a filter. While one is being worked on, only the last one waits. */
  show(wanted: Wanted): void {
    if (this.running) {
      this.next = wanted;
      return;
    }
    this.running = true;
    this.send({ kind: "show", ...wanted });
  }

  /** Whether no answer is awaited. */
  get idle(): boolean {
    return !this.running;
  }

  private handle(message: FromWorker): void {
    switch (message.kind) {
      case "progress":
        return this.onProgress(message.what, message.share);
      case "loaded":
        return this.onLoaded(message.mesh);
      case "lit":
        // Of faces that are on their way out if something else was asked for since.
        return this.running ? undefined : this.onLit(message.light);
      case "layers":
        return this.onLayers(message.layers);
      case "failed":
        return this.onFailed(message.message);
      case "visible": {
        this.running = false;
        const next = this.next;
        this.next = null;
        if (next) this.show(next);
        this.onVisible(message.visible, message.curved, message.milliseconds);
      }
    }
  }
}

export function readInfo(): MeshInfo {
  const info = JSON.parse(element("mesh-info").textContent!) as MeshInfo;
  if (info.format !== 1) throw new Error("The data of this page is of another version.");
  return info;
}

/** Resolves when the mesh may be loaded: at once, or when people have agreed to a large one. */
async function agreed(info: MeshInfo): Promise<void> {
  if (info.cells <= kManyCells) return;
  const gigabytes = (memoryEstimate(info) / 1e9).toFixed(1);
  const box = element("progress");
  const button = make("button", "Load it");
  button.id = "load-anyway";
  box.replaceChildren(
    make("p", `This mesh has ${grouped(info.cells)} cells. The browser needs about ${gigabytes} GB.`),
    button,
  );
  await new Promise((resolve) => button.addEventListener("click", resolve, { once: true }));
}

function sendEmbedded(info: MeshInfo, worker: MeshWorker): void {
  for (const table of info.tables) {
    for (let chunk = 0; chunk < table.chunkBytes.length; ++chunk) {
      const holder = element(`data-${table.name}-${chunk}`);
      worker.send({ kind: "chunk", table: table.name, chunk, data: holder.textContent! });
      holder.remove();  // its memory is wanted for the mesh
    }
  }
}

export async function load(info: MeshInfo, worker: MeshWorker): Promise<void> {
  await agreed(info);
  worker.send({ kind: "begin", info });
  sendEmbedded(info, worker);
  worker.send({ kind: "end" });
}
