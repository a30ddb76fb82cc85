// What the page and its worker say to each other.
import type { MeshInfo } from "../format";
import type { CurvedFaces } from "./curved_faces";
import type { Layers } from "./topology";
import type { Filter, Visible } from "./visible";

export type ToWorker =
  | { kind: "begin"; info: MeshInfo }
  /** The next chunk of a table, in base64 or as bytes. */
  | { kind: "chunk"; table: string; chunk: number; data: string | ArrayBuffer }
  | { kind: "end" }
  /** @param curved  whether the points of curved faces are wanted */
  | { kind: "show"; filter: Filter; curved: boolean };

/** What the page keeps of the mesh. */
export interface LoadedMesh {
  /** Four numbers per vertex or node: a position in scene coordinates, the kind of its generator. */
  positions: Float32Array<ArrayBuffer>;
  cells: Uint32Array<ArrayBuffer>;
  /** 1: straight cells. */
  order: number;
  /** As in CurvedCells. */
  nodes: Uint32Array<ArrayBuffer>;
  quality: Uint16Array<ArrayBuffer>;
  /** The sharp edges of the boundary, two vertices each. */
  creases: Uint32Array<ArrayBuffer>;
  /** Three numbers per edge: two vertices, and 2 * valence + (1 on the boundary). */
  singularEdges: Uint32Array<ArrayBuffer>;
  /** Three numbers per edge: two vertices, and the tag. */
  featureEdges: Uint32Array<ArrayBuffer>;
  /** Per cell the place of its region in regionTags, plus 1; empty without regions. */
  regions: Uint32Array<ArrayBuffer>;
  regionTags: number[];
  /** Tags of quads; the feature f of a quad has tag quadTags[f - 1]. */
  quadTags: number[];
}

export type FromWorker =
  | { kind: "progress"; what: string; share: number }
  | { kind: "loaded"; mesh: LoadedMesh }
  /** What takes longer to find than the faces of the boundary, and comes after them. */
  | { kind: "layers"; layers: Layers }
  | { kind: "visible"; visible: Visible; curved: CurvedFaces | null; milliseconds: number }
  /** The light at the corners of the quads that were sent last, as in Occlusion. */
  | { kind: "lit"; light: Uint8Array<ArrayBuffer> }
  | { kind: "failed"; message: string };
