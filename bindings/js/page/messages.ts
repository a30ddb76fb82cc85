// What the page and its worker tell each other.
import type { Certificate, CheckReport, FileFormat, MeshOptions, SampleOptions, VerifyReport } from "../src/types.js";

/** Where a map or mesh comes from: files, or a sample. */
export type Source =
  | { files: { name: string; bytes: ArrayBuffer }[] }
  | { sample: string; options: SampleOptions; withoutMap?: boolean };

/** The object of a map, for drawing: in a box around the origin, with 1 as its longest side. */
export interface MapShape {
  /** Four numbers per vertex: x, y, z, 0. */
  positions: Float32Array<ArrayBuffer>;
  /** The boundary, three vertices each. */
  triangles: Uint32Array<ArrayBuffer>;
  /** Per defect and occurrence: the edges of the place, two vertices each, and where it is. */
  places: { edges: number[]; centre: [number, number, number] }[][];
}

export interface OpenedMap {
  name: string;
  report: CheckReport;
  shape: MapShape;
}

/** Tets without a map. */
export interface OpenedPart {
  name: string;
  points: number;
  tets: number;
  shape: MapShape;
}

export interface OpenedMesh {
  name: string;
  vertices: number;
  cells: number;
  certificate: Certificate;
  /** null if there is no map. */
  verification: VerifyReport | null;
  scale: number;
  /** The page of `hexhex view`; or why there is none. */
  view: Uint8Array<ArrayBuffer> | string;
}

export interface Opened {
  map: OpenedMap | null;
  mesh: OpenedMesh | null;
  part: OpenedPart | null;
  /** What keeps the file of the part from being one of a map or a mesh. */
  noMap: string;
}

export interface Start {
  version: string;
  formats: FileFormat[];
  samples: { name: string; description: string }[];
  canQuantize: boolean;
}

/** What the worker does: by name, what it is given, and what it answers. */
export interface Tasks {
  start: (module: WebAssembly.Module) => Start;
  /** Reads, and examines what was read. */
  open: (source: Source) => Opened;
  /** Reads again what an earlier worker had. @param wanted  of quantize(); 0: it was not quantized */
  reopen: (source: Source, wanted: number) => null;
  quantize: (wanted: number) => OpenedMap;
  /** Of the part. */
  mesh: (options: MeshOptions) => { map: OpenedMap; mesh: OpenedMesh; why: string };
  extract: (scale: number) => OpenedMesh;
  /** A file's content: of the mesh. */
  write: (name: string) => Uint8Array<ArrayBuffer>;
}
export type TaskName = keyof Tasks;

export type ToWorker = { task: TaskName; given: unknown[] };
export type FromWorker =
  | { kind: "progress"; stage: string; share: number }
  | { kind: "done"; answer: unknown; memory: number }
  | { kind: "failed"; code: string; message: string };
