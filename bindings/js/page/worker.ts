// The worker: has the library, the map and the mesh, and does one task after the other.
import { HexMesh, type Hexhex, HexhexError, load, TetMap } from "../src/index.js";
import type { CheckReport, VerifyReport } from "../src/types.js";
import type { FromWorker, OpenedMap, OpenedMesh, OpenedPart, Source, TaskName, Tasks, ToWorker } from "./messages.js";
import { shapeOf } from "./shape.js";

declare const self: {
  onmessage: ((event: MessageEvent<ToWorker>) => void) | null;
  postMessage(message: FromWorker, transfer?: Transferable[]): void;
};

let library: Hexhex;
let map: TetMap | null = null;
let mapName = "";
let report: CheckReport | null = null;
let mesh: HexMesh | null = null;
let meshName = "";
/** Tets without a map. */
let part: TetMap | null = null;
let partName = "";
let noMap = "";

function withoutExtension(name: string): string {
  return name.replace(/\.[^.]*$/, "");
}

function read(source: Source): void {
  if ("sample" in source) {
    map = library.generate(source.sample, source.options);
    mapName = `${source.sample}.hexex`;
    if (!source.withoutMap) return;
    part = library.makeMap(map.points.slice(), map.tets.slice());
    partName = source.sample;
    map = null;
    return;
  }
  for (const { name, bytes } of source.files) {
    const found = readFile(new Uint8Array(bytes), name);
    const isTets = found instanceof TetMap;
    if (isTets ? map ?? part : mesh) {
      throw new Error("These are two of a kind. Drop one map, one mesh, or a mesh with its map.");
    }
    if (!isTets) {
      mesh = found;
      meshName = name;
    } else if (found.parameters.length > 0) {
      map = found;
      mapName = name;
    } else {
      part = found;
      partName = name;
    }
  }
}

/** A map, a mesh, or tets without parameters. */
function readFile(bytes: Uint8Array, name: string): TetMap | HexMesh {
  try {
    return library.read(bytes, name);
  } catch (problem) {
    if (!(problem instanceof HexhexError)) throw problem;
    try {
      const tets = library.readTets(bytes, name);
      noMap = problem.message;
      return tets;
    } catch {
      throw problem;
    }
  }
}

const shapeOfTets = (tets: TetMap, of: Pick<CheckReport, "defects">) =>
  shapeOf(tets.points.slice(), tets.tets.slice(), of);

function examineMap(): OpenedMap {
  report = library.check(map!);
  return { name: mapName, report, shape: shapeOfTets(map!, report) };
}

function examinePart(tets: TetMap): OpenedPart {
  const shape = shapeOfTets(tets, { defects: [] });
  return { name: partName, points: tets.points.length / 3, tets: tets.tets.length / 4, shape };
}

/** The scale that the numbers of cells tell, or 1. */
function scaleOf(cells: number): number {
  const base = report?.expected?.cells ?? 0;
  const scale = Math.round(Math.cbrt(cells / base));
  return base > 0 && scale ** 3 * base === cells ? scale : 1;
}

function view(verification: VerifyReport | null): Uint8Array<ArrayBuffer> | string {
  try {
    return library.writePage(mesh!, verification ? { title: meshName, mapName } : { title: meshName });
  } catch (error) {
    if (error instanceof HexhexError) return error.message;
    throw error;
  }
}

const verifyMesh = (scale: number) => (map && report?.valid ? library.verify(mesh!, map, { scale }) : null);

function examineMesh(scale: number, verification = verifyMesh(scale)): OpenedMesh {
  return {
    name: meshName,
    vertices: mesh!.points.length / 3,
    cells: mesh!.cells.length / 8,
    certificate: library.certify(mesh!),
    verification,
    scale,
    view: view(verification),
  };
}

function requireMap(): TetMap {
  if (!map) throw new Error("There is no map. Drop one.");
  return map;
}

function quantizeMap(wanted: number): void {
  const quantized = library.quantize(requireMap(), { cells: wanted });
  map!.free();
  map = quantized.map;
}

const tasks: { [Name in TaskName]: (...given: Parameters<Tasks[Name]>) => ReturnType<Tasks[Name]> | Promise<ReturnType<Tasks[Name]>> } = {
  async start(module) {
    library = await load({ wasm: module });
    library.onProgress = (stage, share) => self.postMessage({ kind: "progress", stage, share });
    const { version, formats, samples, canQuantize } = library;
    return { version, formats, samples, canQuantize };
  },
  open(source) {
    read(source);
    const opened = map ? examineMap() : null;
    return {
      map: opened,
      mesh: mesh ? examineMesh(scaleOf(mesh.cells.length / 8)) : null,
      part: part ? examinePart(part) : null,
      noMap,
    };
  },
  reopen(source, wanted) {
    read(source);
    if (wanted > 0) quantizeMap(wanted);
    report = map && library.check(map);
    return null;
  },
  quantize(wanted) {
    quantizeMap(wanted);
    return examineMap();
  },
  mesh(options) {
    if (!part) throw new Error("There are no tets. Drop some.");
    mesh?.free();
    map?.free();
    mesh = map = null;
    const made = library.mesh(part, options);
    ({ mesh, map } = made);
    mapName = `the map of ${partName}`;
    meshName = `${withoutExtension(partName)}.vtu`;
    // Vertices have moved since it was verified.
    const opened = { map: examineMap(), mesh: examineMesh(1, made.report.verification) };
    return { ...opened, why: made.report.why };
  },
  extract(scale) {
    const from = requireMap();
    mesh?.free();
    mesh = null;
    mesh = library.extract(from, { scale });
    meshName = `${withoutExtension(mapName)}${scale > 1 ? `-${scale}` : ""}.vtu`;
    return examineMesh(scale);
  },
  write(name) {
    try {
      return library.writeMesh(mesh!, name);
    } catch (error) {
      if (!(error instanceof RangeError)) throw error;
      throw new Error(`${name} would have more than 2 GB, which browsers do not hold. Try another format, or a smaller scale.`);
    }
  },
};

/** Arrays that the page gets without a copy. */
function buffersOf(answer: unknown): ArrayBuffer[] {
  if (answer instanceof Uint8Array || answer instanceof Uint32Array || answer instanceof Float32Array) {
    return [answer.buffer as ArrayBuffer];
  }
  if (Array.isArray(answer) || answer === null || typeof answer !== "object") return [];
  return Object.values(answer).flatMap(buffersOf);
}

function failureOf(error: unknown): { code: string; message: string } {
  if (error instanceof HexhexError) return error;
  // What engines say when they have no memory for an array.
  if (error instanceof RangeError) {
    return { code: "OutOfMemory", message: "Memory is exhausted. Use a smaller scale, or the command." };
  }
  if (error instanceof WebAssembly.RuntimeError) {
    const message = `This is a fault of hexhex (${error.message}). Please report it, with what you did.`;
    return { code: "Fault", message };
  }
  return { code: "", message: error instanceof Error ? error.message : String(error) };
}

self.onmessage = async ({ data: { task, given } }) => {
  try {
    const answer = await (tasks[task] as (...given: unknown[]) => unknown)(...given);
    self.postMessage({ kind: "done", answer, memory: library.memoryBytes }, buffersOf(answer));
  } catch (error) {
    const { code, message } = failureOf(error);
    self.postMessage({ kind: "failed", code, message });
  }
};
