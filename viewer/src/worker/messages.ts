// What the page and its worker say to each other.
import type { MeshInfo } from "../format";
import type { Moment } from "../moments";
import type { CurvedFaces } from "./curved_faces";
import type { Layers } from "./topology";
import type { Filter, Visible } from "./visible";

export type ToWorker =
  | { kind: "begin"; info: MeshInfo }
  /** The next chunk of a table, in base64. */
  | { kind: "chunk"; table: string; chunk: number; data: string }
  | { kind: "end" }
  | ({ kind: "show" } & Wanted);

/** What the page asks for. */
export interface Wanted {
  filter: Filter;
  /** Whether the points of curved faces are wanted. */
  curved: boolean;
  /** From before an improvement (0) to after it (1). */
  moment: number;
}

/** What the page keeps of the mesh. */
export interface LoadedMesh {
  /** Positions in scene coordinates, and as a fourth number the kind of the vertex' generator. */
  after: Moment;
  /** Null if the page shows one moment only. */
  before: Moment | null;
  cells: Uint32Array<ArrayBuffer>;
  /** 1: straight cells. */
  order: number;
  /** As in CurvedCells. */
  nodes: Uint32Array<ArrayBuffer>;
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
