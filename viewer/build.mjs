// Bundles the page: node build.mjs OUTPUT.cpp
//
// The output is C++: the page in pieces, cut at the places where the program puts title and data in.
import { createHash } from "node:crypto";
import { readFile, writeFile } from "node:fs/promises";
import { build } from "esbuild";

const output = process.argv[2];
if (!output) throw new Error("usage: node build.mjs OUTPUT.cpp");

/** One self-contained script. */
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

const worker = await bundle("src/worker/worker.ts");
const script = await bundle("src/main.ts", { WORKER_SOURCE: JSON.stringify(worker) });
for (const text of ["</script", "<!--"]) {
  if (script.includes(text)) throw new Error(`the script contains ${text}, which would end it`);
}
const style = (await build({ entryPoints: ["src/style.css"], minify: true, write: false }))
  .outputFiles[0].text;

const fixed = { STYLE: style, SCRIPT: script };
const template = await readFile("src/page.html", "utf8");
const filled = template.replace(/@(STYLE|SCRIPT)@/g, (_, name) => fixed[name]);

/** What an element's text has to be for a Content-Security-Policy to let it in. */
function hashOf(tag) {
  const texts = [...filled.matchAll(new RegExp(`<${tag}>([^]*?)</${tag}>`, "g"))];
  if (texts.length !== 1) throw new Error(`the page has ${texts.length} elements <${tag}>`);
  return `sha256-${createHash("sha256").update(texts[0][1]).digest("base64")}`;
}

const pieces = filled
  .replace(/@(STYLE|SCRIPT)_HASH@/g, (_, name) => hashOf(name.toLowerCase()))
  .split(/@(TITLE|INFO|DATA)@/);
const names = pieces.filter((_, i) => i % 2 === 1);
if (names.join() !== "TITLE,INFO,DATA") throw new Error(`unexpected places: ${names}`);

/** A C++ literal. Compilers may limit the length of one, so it comes as several. */
function literal(text) {
  const parts = [];
  for (let i = 0; i < text.length; i += 8000) parts.push(`R"~hexhex~(${text.slice(i, i + 8000)})~hexhex~"`);
  return parts.join("\n");
}

const source = `// Made by viewer/build.mjs from viewer/src. Do not edit.
#include <view/page_template.hpp>

// Compilers that matter take literals of any length.
#pragma GCC diagnostic ignored "-Woverlength-strings"

namespace hexhex::view {

const PageTemplate* pageTemplate() {
  static const PageTemplate kTemplate{
${pieces.filter((_, i) => i % 2 === 0).map(literal).join(",\n")}};
  return &kTemplate;
}

}  // namespace hexhex::view
`;
await writeFile(output, source);
console.log(`${output}: ${Math.round(source.length / 1024)} KiB`);
