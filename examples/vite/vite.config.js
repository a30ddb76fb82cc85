// The file is found beside the script that asks for it, which packing in advance would break.
export default { optimizeDeps: { exclude: ["hexhex"] }, worker: { format: "es" } };
