import type { Module, ModuleOptions } from "./module.js";
export default function createModule(options: ModuleOptions): Promise<Module>;
