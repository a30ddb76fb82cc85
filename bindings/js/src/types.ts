// What goes in and what comes out. Keys of reports are those of the command's JSON: docs/user/report.md.

/** Called with a stage's name and its finished share in [0, 1], some hundred times in all. */
export type Progress = (stage: string, share: number) => void;

export interface Place {
  /** As sentences have it: "tet 12", "edge 3-17". */
  text: string;
  kind: "none" | "tet" | "face" | "edge" | "vertex" | "line" | "cell";
  /** The tet (of a face, too), vertex, line (from 1) or cell; the first vertex of an edge. */
  index: number;
  /** The corner opposite a face, 0 to 3; the second vertex of an edge. */
  second: number;
}

/** What the library throws: what is wrong, where, and what to do. docs/user/errors.md has the codes. */
export class HexhexError extends Error {
  override readonly name = "HexhexError";
  constructor(
    readonly code: string,
    message: string,
    readonly place: Place,
  ) {
    super(message);
  }
}

export interface FileFormat {
  name: string;
  /** With the dot; empty: has to be asked for by name. */
  extension: string;
  description: string;
  readsMaps: boolean;
  writesMaps: boolean;
  readsTets: boolean;
  readsHexMeshes: boolean;
  writesHexMeshes: boolean;
}

export interface SampleOptions {
  /** Hexahedra along each block edge, 1 to 10000. */
  cells?: number;
  /** Sub-blocks of tets along each block edge, 1 to 500: 12 tets each. */
  refine?: number;
  /** Of "star", 3 to 12. */
  valence?: number;
  charts?: "aligned" | "blocks" | "random" | "scattered";
  jitter?: number;
  onLattice?: number;
  noise?: number;
  offset?: number;
  /** Makes the map seamless instead of integer: 0 to 0.9. */
  stretch?: number;
  features?: boolean;
  seed?: number;
  /** At least so many tets are flipped or flat. */
  defects?: number;
  defectKind?: "interior" | "singular" | "boundary" | "sliver";
}

export interface ReadOptions {
  /** A format by its name, whatever the file's name ends in. */
  format?: string;
  /** The array that holds the map in .vtu and .vtk files; "igm" if it is not given. */
  mapArray?: string;
  /** Walls of a motorcycle complex that .hexex files list, inside, are features with the tag 2. */
  keepWalls?: boolean;
  /** Leaves out other volume cells of a mesh, which are an error otherwise. */
  hexesOnly?: boolean;
}

export interface WriteOptions {
  format?: string;
  /** Of boundary groups, in degrees. */
  patchAngle?: number;
  /** Arrays of .vtu files with zlib. */
  compress?: boolean;
}

export interface CheckOptions {
  /** What the expectation is for. */
  scale?: number;
  tolerance?: number;
}

export interface Defect {
  code: string;
  sentence: string;
  count: number;
  /** At most ten, the worst first. */
  worst: { place: Place; amount: number }[];
}

export interface Expectation {
  cells: number;
  boundary_quads: number;
  inner_singular_edges: Record<string, number>;
  boundary_singular_edges: Record<string, number>;
  euler_characteristic: number;
  components: number;
  boundary_components: number;
}

export interface CheckReport {
  valid: boolean;
  kind: "integer" | "integer up to a scale" | "seamless" | "almost seamless" | "neither";
  /** What parameters are to be multiplied by, of a map that is integer up to a scale; or null. */
  integer_factor: number | null;
  points: number;
  tets: number;
  edges: number;
  faces: number;
  inner_faces: number;
  boundary_faces: number;
  chart_jumps: number;
  isolated_vertices: number;
  tets_inverted_in_space: number;
  mirrored: boolean;
  corners_reversed: boolean;
  max_transition_residual: number;
  max_displacement: number;
  inner_singular_tet_edges: Record<string, number>;
  boundary_singular_tet_edges: Record<string, number>;
  singular_nodes: number;
  boundary_genus: number[];
  defects: Defect[];
  scale: number;
  /** null for a map that is not valid. */
  expected: Expectation | null;
}

export interface ExtractOptions {
  /** Multiplies all parameters: scale^3 times as many cells. */
  scale?: number;
  tolerance?: number;
}

/** One of the first three. */
export interface QuantizeOptions {
  cells?: number;
  scale?: number;
  edgeLength?: number;
  densify?: boolean;
  wallTag?: number;
  tolerance?: number;
}

export interface QuantizeReport {
  cells_wanted: number;
  cells: number;
  scale: number;
  displacement: number;
  blocks: number;
  arcs: number;
  shortest_arc: number;
  longest_arc: number;
  integers_by: string;
  attempts: number;
  split_edges: number;
  added_tets: number;
  scaled_jacobian_before: { worst: number; median: number };
  scaled_jacobian_after: { worst: number; median: number };
}

/** One of the first two. */
export interface MeshOptions {
  /** There are more if a map of so few cannot be found. */
  cells?: number;
  edgeLength?: number;
  method?: "auto" | "frames" | "polycube";
  /** Of random decisions. */
  seed?: number;
  /** In degrees: where the surface turns by more is an edge of the object; 40 if it is not given. */
  featureAngle?: number;
  /** Cells with a smaller scaled Jacobian are improved; 0.3 if it is not given. */
  target?: number;
  passes?: number;
  fixBoundary?: boolean;
  /** So far may vertices leave the surface where nothing else helps, in diagonals: 1e-3 if it is not given. */
  slack?: number;
  /** A layer of cells under the boundary. */
  pillow?: "never" | "auto" | "always";
}

export interface SurfaceDistance {
  from_mesh: number;
  from_surface: number;
  hausdorff: number;
}

/** docs/user/report.md explains the keys of these. */
export interface ShapeReport {
  method: "frames" | "polycube";
  rotation: number[][];
  labels: {
    valid: boolean;
    charts: number;
    corners: number;
    bad_loops: number;
    bad_corners: number;
    opposite_edges: number;
    turning_points: number;
    wrong_turns: number;
    flat_charts: number;
    deviation: number;
  };
  label_moves: number;
  added_tets: number;
  feature_edges: number;
  tagged_edges: number;
  inner_faces: number;
  aligned_faces: number;
  aligned_area: number;
  scaled_jacobian: { worst: number; median: number };
}

export interface ImproveReport {
  before: Certificate;
  after: Certificate;
  not_positive: number[];
  diagonal: number;
  distance_before: SurfaceDistance;
  distance_after: SurfaceDistance;
  inner_distance_before: number;
  inner_distance_after: number;
  far_cells_before: number;
  far_cells: number[];
  vertices: {
    free: number;
    on_patches: number;
    on_curves: number;
    fixed: number;
    fixed_by_tags: number;
    fixed_by_option: number;
    fixed_by_cells: number;
  };
  moved_vertices: number;
  largest_move: number;
  mean_move: number;
  off_surface: number;
  off_creases: number;
  added_cells: number;
  curve_length: number;
  curves_followed: number;
  snapped_curves: number;
  cannot_be_positive: number[];
  worst_cell: {
    cell: number;
    held_by: "neighbours" | "surface" | "curve" | "corner" | "held vertex" | "shared faces";
    tagged: boolean;
    vertex: number;
    angle: number;
  };
  seconds: number;
}

export interface MeshReport {
  ways: {
    method: "frames" | "polycube";
    refusal?: string;
    certified?: boolean;
    minimum?: number;
    distance?: number;
    curves_followed?: number;
    merit?: number;
  }[];
  why: string;
  map: ShapeReport;
  quantization: QuantizeReport;
  verification: VerifyReport;
  improvement: ImproveReport;
  tags_released: boolean;
  missing_curves: number;
  /** Regions and surfaces of the part that no cell or quad has. */
  missing_groups: { dimension: number; tag: number; name: string }[];
}

export interface VerifyReport {
  passed: boolean;
  items: { name: string; expected: string; found: string; passed: boolean }[];
}

export interface Certificate {
  quality: { minimum: number; mean: number; not_positive: number; histogram: number[] };
  validity: {
    positive: number;
    refuted: number;
    undecided: number;
    minimum: number;
    worst: { cell: number; place: number[]; position: number[]; scaled_jacobian: number }[];
  };
}
