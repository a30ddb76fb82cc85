// See run. A ball of seven blocks at scales of one map, each by a library of its own, whose memory never
// becomes less: after the extraction, the verification and the certificate.
import { join } from "node:path";

const { load } = await import(join(process.env.HEXHEX_JS, "dist/index.js"));
const scales = process.argv.length > 2 ? process.argv.slice(2).map(Number) : [36, 45, 48, 51, 54];

/** The memory after a step, or why there is no more of it. */
function after(hexhex, step) {
  try {
    step();
    return `${Math.round(hexhex.memoryBytes / 2 ** 20).toLocaleString("en")} MiB`;
  } catch (error) {
    return error.code;
  }
}

console.log("| cells | extracted | verified | certified |\n|---|---|---|---|");
for (const scale of scales) {
  const hexhex = await load();
  const map = hexhex.generate("sphere", { cells: 4, refine: 4, charts: "random" });
  let mesh = null;
  const results = [
    () => (mesh = hexhex.extract(map, { scale })),
    () => hexhex.verify(mesh, map, { scale }),
    () => hexhex.certify(mesh),
  ].map((step, i) => (i > 0 && !mesh ? "" : after(hexhex, step)));
  console.log(`| ${[(448 * scale ** 3).toLocaleString("en"), ...results].join(" | ")} |`);
}
