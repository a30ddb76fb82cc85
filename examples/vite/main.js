// Sends a map to the worker, and shows what becomes of it.
const worker = new Worker(new URL("./worker.js", import.meta.url), { type: "module" });
worker.onmessage = ({ data }) => {
  document.querySelector("#result").textContent = data;
};
worker.postMessage(null);
document.querySelector("#file").addEventListener("change", async ({ target }) => {
  const [file] = target.files;
  worker.postMessage({ name: file.name, bytes: new Uint8Array(await file.arrayBuffer()) });
});
