// What the page holds, as src/view/ writes it: a JSON text with counts and statistics, and tables of
// whole numbers in compressed chunks.
import type { ColourMode } from "./scene/surface";

/** A table of `rows` times `columns` 32-bit numbers, in chunks of consecutive rows. */
export interface TableInfo {
  name: string;
  rows: number;
  columns: number;
  /** Rows per chunk; the last chunk has what is left. */
  rowsPerChunk: number;
  /** Whether numbers are packed row by row, otherwise column by column. */
  byRows: boolean;
  /** Compressed bytes of each chunk. */
  chunkBytes: number[];
}

export interface CheckItem {
  name: string;
  expected: string;
  found: string;
  passed: boolean;
}

export interface QualityInfo {
  minimum: number;
  mean: number;
  notPositive: number;
}

/** Whether cells are positive everywhere; the worst that are not. */
export interface ValidityInfo {
  refuted: number;
  undecided: number;
  minimum: number;
  worst: { cell: number; place: [number, number, number]; scaledJacobian: number }[];
}

export interface MeshInfo {
  format: number;
  title: string;
  program: string;
  vertices: number;
  /** Vertices, then nodes of cells of higher order. */
  points: number;
  cells: number;
  /** 1: straight cells. */
  order: number;
  /** Lower corner of the bounding box. */
  lower: [number, number, number];
  upper: [number, number, number];
  /** Length of one unit of the quantized coordinates. */
  step: number;
  quality: QualityInfo;
  validity: ValidityInfo;
  /** The same before the mesh was improved, if the page shows that, too. */
  before?: { quality: QualityInfo; validity: ValidityInfo };
  topology: {
    boundaryQuads: number;
    boundaryComponents: number;
    components: number;
    eulerCharacteristic: number;
  };
  /** Number of singular edges by valence. */
  singular: { inner: [number, number][]; boundary: [number, number][] };
  /** Groups of boundary quads, as files name them, and how many quads they have. */
  patches: { name: string; quads: number }[];
  hasGenerators: boolean;
  /** How the page of a part begins: coloured by region, seen from the side of the place. */
  start?: { colour: ColourMode; from: [number, number, number] };
  verification: { map: string; passed: boolean; items: CheckItem[] } | null;
  tables: TableInfo[];
}

/** Scaled Jacobians are stored in 16 bits: 0 stands for -1, kQualitySteps for 1. */
export const kQualitySteps = 65534;

export function qualityOf(stored: number): number {
  return (stored / kQualitySteps) * 2 - 1;
}

export function storedQuality(quality: number): number {
  return Math.round(((quality + 1) / 2) * kQualitySteps);
}

/**
 * Decodes one chunk: a byte with the number of byte planes, then the planes of all its numbers. A
 * number is the zigzag code of the difference to the row above (0 above the first), modulo 2^32.
 */
export function decodeChunk(
  bytes: Uint8Array,
  rows: number,
  { columns, byRows }: TableInfo,
  to: Uint32Array,
  firstRow: number,
): void {
  const planes = bytes[0]!;
  const count = rows * columns;
  if (bytes.length !== 1 + planes * count) throw new Error("The data of this page is damaged.");
  const first = firstRow * columns;
  for (let column = 0; column < columns; ++column) {
    let value = 0;
    let at = byRows ? 1 + column : 1 + column * rows;
    for (let row = 0; row < rows; ++row, at += byRows ? columns : 1) {
      let code = 0;
      for (let plane = 0; plane < planes; ++plane) code |= bytes[at + plane * count]! << (8 * plane);
      value = (value + ((code >>> 1) ^ -(code & 1))) | 0;
      to[first + row * columns + column] = value;
    }
  }
}

/** Inflates zlib data with the browser's own decoder. */
export async function inflate(bytes: Uint8Array<ArrayBuffer>): Promise<Uint8Array> {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

export function decodeBase64(text: string): Uint8Array<ArrayBuffer> {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}
