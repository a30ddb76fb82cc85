// Bundles the page: node page/build.mjs HEXHEX.wasm PAGE_TEMPLATE.cpp OUTPUT.html
//
// The second is the viewer's page as viewer/build.mjs makes it: its script and style run inside of
// this page, so their hashes have to be allowed here, too.
import { createHash } from "node:crypto";
import { readFile, writeFile } from "node:fs/promises";
import { deflateSync, gzipSync } from "node:zlib";
import { build } from "esbuild";

const [wasmFile, templateFile, output] = process.argv.slice(2);
if (!output) throw new Error("usage: node page/build.mjs HEXHEX.wasm PAGE_TEMPLATE.cpp OUTPUT.html");

/** Gzipped, as servers send the page: what people wait for. */
const kMostBytes = 2.1e6;

async function bundle(entry, define = {}) {
  const result = await build({
    entryPoints: [entry],
    bundle: true,
    minify: true,
    write: false,
    format: "iife",
    target: "es2022",
    charset: "ascii",
    legalComments: "inline",
    define,
    logLevel: "warning",
  });
  return result.outputFiles[0].text;
}

// The worker is given what it would look for beside itself.
const worker = await bundle("page/worker.ts", { "import.meta.url": '"file:///"' });
const script = await bundle("page/main.ts", { WORKER_SOURCE: JSON.stringify(worker) });
for (const text of ["</script", "<!--"]) {
  if (script.includes(text)) throw new Error(`the script contains ${text}, which would end it`);
}
const styles = await build({
  stdin: { contents: '@import "./viewer/style.css"; @import "./page/page.css";', loader: "css", resolveDir: "." },
  bundle: true, minify: true, write: false,
});
const style = styles.outputFiles[0].text;

/** What an element's text has to be for a Content-Security-Policy to let it in. */
const hashOf = (text) => `'sha256-${createHash("sha256").update(text).digest("base64")}'`;
const template = await readFile(templateFile, "utf8");
const innerHash = (kind) => {
  const found = template.match(new RegExp(`${kind}-src ('sha256-[^']*')`));
  if (!found) throw new Error(`${templateFile} has no ${kind}-src`);
  return found[1];
};

const wasm = deflateSync(await readFile(wasmFile), { level: 9 }).toString("base64");
const page = (await readFile("page/page.html", "utf8"))
  .replace("@SCRIPT_HASHES@", `${hashOf(`\n${script}\n`)} ${innerHash("script")}`)
  .replace("@STYLE_HASHES@", `${hashOf(`\n${style}\n`)} ${innerHash("style")}`)
  .replace("@STYLE@", () => style)
  .replace("@SCRIPT@", () => script)
  .replace("@WASM@", () => wasm);
await writeFile(output, page);
const sent = gzipSync(page, { level: 9 }).length;
console.log(`${output}: ${Math.round(page.length / 1024)} KiB, ${Math.round(sent / 1024)} KiB gzipped`);
if (sent > kMostBytes) throw new Error(`${output} is too large: ${sent} bytes gzipped`);
