// The groups of boundary quads: their names, which people may change and save for --names.
import { cssOf, featureColour } from "../colours";
import type { MeshInfo } from "../format";
import { element, grouped, make } from "./dom";
import { saveFile } from "./picture";

/** Names that were typed, by the number of the patch. */
const typed = new Map<number, string>();

export const namesOf = ({ patches }: MeshInfo): string[] =>
  patches.map(({ name }, i) => typed.get(i) ?? name);

/** A file has letters, digits and "_" in names, and no digit in front. */
const word = (text: string) => text.trim().replace(/[^A-Za-z0-9_]/g, "_").replace(/^(?=\d)/, "_").slice(0, 31);

/** Fills the list. @param onChange  of a name */
export function listPatches(info: MeshInfo, onChange: () => void): void {
  element("patches").hidden = info.patches.length === 0;
  const rows = info.patches.map(({ name, quads }, i) => {
    const row = make("li");
    const mark = make("i");
    mark.style.background = cssOf(featureColour(i));
    const input = make("input");
    input.value = name;
    input.setAttribute("aria-label", `Name of ${name}`);
    input.addEventListener("change", () => {
      const wanted = word(input.value);
      const others = namesOf(info).filter((_, k) => k !== i).map((other) => other.toLowerCase());
      // Two groups with one name would be one.
      if (wanted === "" || others.includes(wanted.toLowerCase())) input.value = typed.get(i) ?? name;
      else input.value = wanted;
      if (input.value === name) typed.delete(i);
      else typed.set(i, input.value);
      element<HTMLButtonElement>("save-names").disabled = typed.size === 0;
      onChange();
    });
    row.append(mark, input, make("span", grouped(quads)));
    return row;
  });
  element("patch-list").replaceChildren(...rows);
  element("save-names").addEventListener("click", () => {
    const lines = [...typed].sort(([a], [b]) => a - b).map(([i, name]) => `${info.patches[i]!.name} ${name}\n`);
    saveFile(new Blob(lines, { type: "text/plain" }), "names.txt");
  });
}
