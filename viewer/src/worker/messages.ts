// What the page and its worker say to each other.
import type { MeshInfo } from "../format";
import type { Filter, Visible } from "./visible";

export type ToWorker =
  | { kind: "begin"; info: MeshInfo }
  /** The next chunk of a table, in base64 or as bytes. */
  | { kind: "chunk"; table: string; chunk: number; data: string | ArrayBuffer }
  | { kind: "end" }
  | { kind: "show"; filter: Filter };

/** What the page keeps of the mesh. */
export interface LoadedMesh {
  /** Four numbers per vertex: a position in scene coordinates, and the kind of its generator. */
  positions: Float32Array<ArrayBuffer>;
  cells: Uint32Array<ArrayBuffer>;
  quality: Uint16Array<ArrayBuffer>;
  layers: Uint16Array<ArrayBuffer>;
  deepestLayer: number;
  boundaryEdges: Uint32Array<ArrayBuffer>;
  /** Three numbers per edge: two vertices, and 2 * valence + (1 on the boundary). */
  singularEdges: Uint32Array<ArrayBuffer>;
  /** Three numbers per edge: two vertices, and the tag. */
  featureEdges: Uint32Array<ArrayBuffer>;
  /** Tags of quads; the feature f of a quad has tag quadTags[f - 1]. */
  quadTags: number[];
}

export type FromWorker =
  | { kind: "progress"; what: string; share: number }
  | { kind: "loaded"; mesh: LoadedMesh }
  | { kind: "visible"; visible: Visible; milliseconds: number }
  | { kind: "failed"; message: string };
