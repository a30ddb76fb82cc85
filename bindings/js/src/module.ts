// The module that emscripten makes of module.cpp.

export interface FileSystem {
  writeFile(path: string, bytes: Uint8Array, options?: { canOwn?: boolean }): void;
  readFile(path: string): Uint8Array<ArrayBuffer>;
  unlink(path: string): void;
  mkdir(path: string): void;
  chdir(path: string): void;
}

export interface Module {
  FS: FileSystem;
  /** The memory; another object after it has grown. */
  HEAPU8: Uint8Array<ArrayBuffer>;
  UTF8ToString(at: number): string;
  stringToUTF8(text: string, at: number, room: number): void;
  lengthBytesUTF8(text: string): number;
  _malloc(bytes: number): number;
  _free(at: number): void;
  _hexhex_call(request: number): number;
  onProgress?: (stage: string, share: number) => void;
}

type Imports = WebAssembly.Imports;
export interface ModuleOptions {
  instantiateWasm(
    imports: Imports,
    done: (instance: WebAssembly.Instance, module: WebAssembly.Module) => void,
  ): object;
  locateFile(name: string): string;
  print(text: string): void;
  printErr(text: string): void;
}
