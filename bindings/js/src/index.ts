// hexhex for JavaScript: hexahedral meshes from integer-grid maps, by the library as WebAssembly.
//
//   import { load } from "hexhex";
//   const hexhex = await load();
//   const map = hexhex.generate("sphere", { cells: 8 });
//   const mesh = hexhex.extract(map, { scale: 2 });
//   if (!hexhex.verify(mesh, map, { scale: 2 }).passed) throw new Error("a bug");
//   const file = hexhex.writeMesh(mesh, "sphere.vtu");
//
// All but load() returns when it is done: call it in a worker if people wait.
import createModule from "./hexhex.mjs";
import type { Module } from "./module.js";
import { HexhexError } from "./types.js";
import type {
  Certificate, CheckOptions, CheckReport, ExtractOptions, FileFormat, MeshOptions, MeshReport, Place, Progress,
  QuantizeOptions, QuantizeReport, ReadOptions, SampleOptions, VerifyReport, WriteOptions,
} from "./types.js";

export * from "./types.js";

export interface LoadOptions {
  /** hexhex.wasm, if it is not beside this file: its bytes, or what WebAssembly.compile() made. */
  wasm?: BufferSource | WebAssembly.Module;
}

interface ArrayPlace {
  at: number;
  length: number;
  type: "f64" | "u32" | "i32" | "u8";
}
type Arrays = Record<string, ArrayPlace>;

interface MapAnswer {
  map: number;
  points: number;
  tets: number;
}
interface MeshAnswer {
  seconds?: number;
  mesh: number;
  vertices: number;
  cells: number;
}

async function wasmBytes(): Promise<BufferSource> {
  const place = new URL("./hexhex.wasm", import.meta.url);
  if (place.protocol === "file:" && typeof process === "object") {
    const name = "node:fs/promises";  // bundlers for pages do not know it
    const { readFile } = (await import(/* @vite-ignore */ name)) as typeof import("node:fs/promises");
    return readFile(place);
  }
  const response = await fetch(place);
  if (!response.ok) throw new Error(`${place.href}: ${response.status}`);
  return response.arrayBuffer();
}

/** Loads the library: with a memory of its own, which only ends with it. */
export async function load(options: LoadOptions = {}): Promise<Hexhex> {
  const source = options.wasm ?? (await wasmBytes());
  const module = source instanceof WebAssembly.Module ? source : await WebAssembly.compile(source);
  const made = await createModule({
    instantiateWasm(imports, done) {
      void WebAssembly.instantiate(module, imports).then((instance) => done(instance, module));
      return {};
    },
    locateFile: (name) => name,  // which is not looked for
    print: () => undefined,
    printErr: () => undefined,
  });
  // A folder of their own for files, whatever they are called.
  made.FS.mkdir(kFolder);
  made.FS.chdir(kFolder);
  return new Hexhex(made);
}

/** What lives in the library's memory until free(). */
class Held {
  /** @internal */
  constructor(
    protected readonly library: Hexhex,
    /** @internal */ readonly id: number,
  ) {}

  /** Gives the memory back. Nothing else can be done afterwards. */
  free(): void {
    this.library.call("free", { id: this.id });
  }
}

/** A tetrahedral mesh with a map. Arrays are views of the library's memory: read or change them, but
 * take them anew after each call, in which memory may move. */
export class TetMap extends Held {
  /** x, y, z of each vertex. */
  get points(): Float64Array<ArrayBuffer> { return this.array("points") as Float64Array<ArrayBuffer>; }
  /** Four vertices of each tet. */
  get tets(): Uint32Array<ArrayBuffer> { return this.array("tets") as Uint32Array<ArrayBuffer>; }
  /** u, v, w of corner 0, 1, 2, 3 of each tet, in its own chart. */
  get parameters(): Float64Array<ArrayBuffer> { return this.array("parameters") as Float64Array<ArrayBuffer>; }
  /** One per tet, or none. */
  get regions(): Int32Array<ArrayBuffer> { return this.array("regions") as Int32Array<ArrayBuffer>; }

  private array(name: string) {
    return this.library.view(this.library.call<Arrays>("mapArrays", { map: this.id })[name]!);
  }
}

/** A hexahedral mesh. Arrays as those of TetMap; without elements where the mesh has none. */
export class HexMesh extends Held {
  /** @internal */
  constructor(
    library: Hexhex,
    id: number,
    /** That the extraction took; undefined for other meshes. */
    readonly seconds?: number,
  ) {
    super(library, id);
  }

  /** x, y, z of each vertex. */
  get points(): Float64Array<ArrayBuffer> { return this.array("points") as Float64Array<ArrayBuffer>; }
  /** Eight vertices of each cell, in VTK's order. */
  get cells(): Uint32Array<ArrayBuffer> { return this.array("cells") as Uint32Array<ArrayBuffer>; }
  /** Per vertex: the smallest tet that contains the simplex in whose interior the vertex lies... */
  get generatorTet(): Uint32Array<ArrayBuffer> { return this.array("generatorTet") as Uint32Array<ArrayBuffer>; }
  /** ... and the corners of that tet that span it, as bits. */
  get generatorCorners(): Uint8Array<ArrayBuffer> { return this.array("generatorCorners") as Uint8Array<ArrayBuffer>; }
  /** One per cell, or none. */
  get regions(): Int32Array<ArrayBuffer> { return this.array("regions") as Int32Array<ArrayBuffer>; }
  /** One per cell, after certify(). */
  get scaledJacobians(): Float64Array<ArrayBuffer> { return this.array("scaledJacobians") as Float64Array<ArrayBuffer>; }
  /** Per cell, after certify(): 0 positive, 1 refuted, 2 undecided. */
  get validity(): Uint8Array<ArrayBuffer> { return this.array("validity") as Uint8Array<ArrayBuffer>; }

  private array(name: string) {
    const place = this.library.call<Arrays>("meshArrays", { mesh: this.id })[name];
    return this.library.view(place ?? { at: 0, length: 0, type: "u8" });
  }
}

/** The library. Functions throw HexhexError. */
export class Hexhex {
  readonly version: string;
  readonly formats: FileFormat[];
  readonly samples: { name: string; description: string }[];
  readonly canQuantize: boolean;

  /** @internal */
  constructor(private readonly module: Module) {
    const about = this.call<Pick<Hexhex, "version" | "formats" | "samples" | "canQuantize">>("about", {});
    this.version = about.version;
    this.formats = about.formats;
    this.samples = about.samples;
    this.canQuantize = about.canQuantize;
  }

  /** Called during long work; an exception thrown there is lost. */
  set onProgress(progress: Progress | undefined) {
    if (progress) this.module.onProgress = progress;
    else delete this.module.onProgress;
  }

  /** How much memory the library has taken so far: it never becomes less. */
  get memoryBytes(): number {
    return this.module.HEAPU8.byteLength;
  }

  /** A map with a known answer. @param kind  a name in `samples` */
  generate(kind: string, options: SampleOptions = {}): TetMap {
    return new TetMap(this, this.call<MapAnswer>("generate", { kind, ...options }).map);
  }

  /** A map from a file's content. @param name  its name: what it ends in is the format */
  readMap(bytes: Uint8Array, name: string, options: ReadOptions = {}): TetMap {
    const answer = this.withInput<MapAnswer>(bytes, name, (file) => this.call("readMap", { file, ...options }));
    return new TetMap(this, answer.map);
  }

  readMesh(bytes: Uint8Array, name: string, options: ReadOptions = {}): HexMesh {
    const answer = this.withInput<MeshAnswer>(bytes, name, (file) => this.call("readMesh", { file, ...options }));
    return new HexMesh(this, answer.mesh);
  }

  /** What the file holds: a hexahedral mesh or, where there are no hexahedra, a map. */
  read(bytes: Uint8Array, name: string, options: ReadOptions = {}): TetMap | HexMesh {
    const answer = this.withInput<MapAnswer | MeshAnswer>(bytes, name, (file) =>
      this.call("read", { file, ...options }));
    return "map" in answer ? new TetMap(this, answer.map) : new HexMesh(this, answer.mesh);
  }

  /** Tets without a map, for mesh(): the result has no parameters. */
  readTets(bytes: Uint8Array, name: string, options: ReadOptions = {}): TetMap {
    const answer = this.withInput<MapAnswer>(bytes, name, (file) => this.call("readTets", { file, ...options }));
    return new TetMap(this, answer.map);
  }

  /** A map of the caller's arrays, which are copied once: see TetMap for their contents.
   * @param parameters  left out: tets without a map, for mesh() */
  makeMap(points: ArrayLike<number>, tets: ArrayLike<number>, parameters?: ArrayLike<number>): TetMap {
    if (points.length % 3 !== 0 || tets.length % 4 !== 0 ||
        (parameters && parameters.length !== 3 * tets.length)) {
      throw new RangeError("There are three numbers per point, four per tet, and twelve parameters per tet.");
    }
    const sizes = { points: points.length / 3, tets: tets.length / 4, parameters: parameters !== undefined };
    const made = this.call<MapAnswer>("makeMap", sizes);
    const map = new TetMap(this, made.map);
    map.points.set(points);
    map.tets.set(tets);
    if (parameters) map.parameters.set(parameters);
    return map;
  }

  check(map: TetMap, options: CheckOptions = {}): CheckReport {
    return this.call("check", { map: map.id, ...options });
  }

  /** From a seamless map to an integer-grid map. Integers are found by rounding. */
  quantize(map: TetMap, options: QuantizeOptions): { map: TetMap; report: QuantizeReport } {
    const answer = this.call<MapAnswer & { report: QuantizeReport }>("quantize", { map: map.id, ...options });
    return { map: new TetMap(this, answer.map), report: answer.report };
  }

  /** A hexahedral mesh of tets that have no map, and the integer-grid map that it is of. Cells may still not be
   * positive in the end: the report of the improvement says which.
   * @param tets  of readTets() or makeMap(), or any map, whose parameters are not used */
  mesh(tets: TetMap, options: MeshOptions): { mesh: HexMesh; map: TetMap; report: MeshReport } {
    const answer = this.call<MapAnswer & MeshAnswer & { report: MeshReport }>("mesh", { tets: tets.id, ...options });
    return { mesh: new HexMesh(this, answer.mesh), map: new TetMap(this, answer.map), report: answer.report };
  }

  extract(map: TetMap, options: ExtractOptions = {}): HexMesh {
    const answer = this.call<MeshAnswer>("extract", { map: map.id, ...options });
    return new HexMesh(this, answer.mesh, answer.seconds);
  }

  /** Whether the mesh is that of the map at this scale. */
  verify(mesh: HexMesh, map: TetMap, options: ExtractOptions = {}): VerifyReport {
    return this.call("verify", { mesh: mesh.id, map: map.id, ...options });
  }

  /** The quality of all cells, and whether they are proven to be valid. */
  certify(mesh: HexMesh): Certificate {
    return this.call("certify", { mesh: mesh.id });
  }

  /** A file's content. @param name  a name that ends in a format of `formats` */
  writeMesh(mesh: HexMesh, name: string, options: WriteOptions = {}): Uint8Array<ArrayBuffer> {
    return this.withOutput(name, (file) => this.call("write", { mesh: mesh.id, file, ...options }));
  }

  writeMap(map: TetMap, name: string, options: WriteOptions = {}): Uint8Array<ArrayBuffer> {
    return this.withOutput(name, (file) => this.call("write", { map: map.id, file, ...options }));
  }

  /** The page of `hexhex view`: one HTML file that shows the mesh.
   * @param mapName  of the map that verify() has compared the mesh with */
  writePage(mesh: HexMesh, options: { title: string; mapName?: string }): Uint8Array<ArrayBuffer> {
    return this.withOutput("page.html", (file) => this.call("writePage", { mesh: mesh.id, file, ...options }));
  }

  /** @internal  A view of the memory, until it grows. */
  view(place: ArrayPlace) {
    const { buffer } = this.module.HEAPU8;
    const { at, length, type } = place;
    switch (type) {
      case "f64": return new Float64Array(buffer, at, length);
      case "u32": return new Uint32Array(buffer, at, length);
      case "i32": return new Int32Array(buffer, at, length);
      case "u8": return new Uint8Array(buffer, at, length);
    }
  }

  /** @internal */
  call<Answer>(what: string, request: object): Answer {
    const { module } = this;
    const text = JSON.stringify({ call: what, ...request });
    const room = module.lengthBytesUTF8(text) + 1;
    const at = module._malloc(room);
    let answer: { result: Answer; error?: { code: string; message: string; place: Place } };
    try {
      module.stringToUTF8(text, at, room);
      answer = JSON.parse(module.UTF8ToString(module._hexhex_call(at)));
    } finally {
      module._free(at);
    }
    if (answer.error) throw new HexhexError(answer.error.code, answer.error.message, answer.error.place);
    return answer.result;
  }

  private withInput<Answer>(bytes: Uint8Array, name: string, use: (file: string) => Answer): Answer {
    const file = pathOf(name);
    // Read at once, so that nobody changes the bytes meanwhile.
    this.module.FS.writeFile(file, bytes, { canOwn: true });
    try {
      return use(file);
    } finally {
      this.module.FS.unlink(file);
    }
  }

  private withOutput(name: string, write: (file: string) => void): Uint8Array<ArrayBuffer> {
    const file = pathOf(name);
    write(file);
    try {
      return this.module.FS.readFile(file);
    } finally {
      this.module.FS.unlink(file);
    }
  }
}

const kFolder = "/files";

/** Where a file is put: only its last part counts, as in sentences about it. */
function pathOf(name: string): string {
  return name.replace(/^.*[/\\]/, "").replace(/^\.*$/, "file");
}
