// Small helpers for the page's elements.

/** The element with this id, which the page has. */
export function element<T extends HTMLElement = HTMLElement>(id: string): T {
  const found = document.getElementById(id);
  if (!found) throw new Error(`The page has no element "${id}".`);
  return found as T;
}

export function make<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  text = "",
  className = "",
): HTMLElementTagNameMap[K] {
  const made = document.createElement(tag);
  made.textContent = text;
  if (className) made.className = className;
  return made;
}

export const grouped = (count: number) => count.toLocaleString("en");

/** Fills a definition list. */
export function fillFacts(list: HTMLElement, facts: [string, string, string?][]): void {
  list.replaceChildren();
  for (const [name, value, id] of facts) {
    const cell = make("dd", value);
    if (id) cell.id = id;
    list.append(make("dt", name), cell);
  }
}

let problemShown = false;

/** Shows what went wrong, the first time. */
export function showProblem(message: string): void {
  if (problemShown) return;
  problemShown = true;
  const box = element("problem");
  box.textContent = message;
  box.hidden = false;
  element("progress").textContent = "";
}
