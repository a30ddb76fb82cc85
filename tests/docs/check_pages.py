#!/usr/bin/env python3
"""Whether the pages of docs/ have all that they should: every error code; in their snippets, which other
tests run, every function of the libraries for C++, C and Python; every field of reports, which the header
for C has, too; and for every C function once, who may call it from several threads. And whether all tables
of the pages are whole, and links lead somewhere."""

import ast
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]

# Of arrays, and of an adapter.
INTERNAL = {"allocateArray", "freeArray", "allocate", "deallocate", "construct", "empty", "operator", "swap"}


def text(path):
    return (ROOT / path).read_text(encoding="utf-8")


def error_codes():
    body = re.search(r"enum class ErrorCode \{(.*?)\};", text("include/hexhex/error.hpp"), re.S)[1]
    return re.findall(r"^\s*([A-Z]\w+)", body, re.M)


def c_functions():
    return re.findall(r"HEXHEX_API [^;]*?\b(hexhex_\w+)\(", text("bindings/c/include/hexhex.h"))


def cpp_functions():
    """Those that are declared at the beginning of a line, and members, which are indented by two."""
    names = set()
    for header in (ROOT / "include/hexhex").glob("*.hpp"):
        if header.name == "view.hpp":  # of the command
            continue
        names.update(re.findall(
            r"^(?:  )?(?:\[\[nodiscard\]\] )?[A-Za-z][\w:<>,&* ]*?[ &*]([a-z]\w+)\(",
            re.sub(r"(?ms)^ private:.*?^};", "", header.read_text(encoding="utf-8")), re.M))
    return sorted(names - INTERNAL)


def python_names():
    """Functions of the package, and methods and properties of its classes."""
    names = set()
    for file in ("__init__", "_types"):
        for node in ast.parse(text(f"bindings/python/hexhex/{file}.py")).body:
            if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") == "__all__":
                names.update(name for name in ast.literal_eval(node.value) if name[0].islower())
            if isinstance(node, ast.ClassDef):
                names.update(method.name for method in node.body
                             if isinstance(method, ast.FunctionDef) and method.name[0] != "_")
    return sorted(names)


def report_fields():
    return sorted(set(re.findall(r'visit\("(\w+)"', text("include/hexhex/fields.hpp"))))


# C has no meshes in parts, and functions for tables.
NOT_IN_C = {"most_neighbours", "shared_faces", "shared_vertices", "boundary_genus", "inner_singular_edges",
            "boundary_singular_edges", "inner_singular_tet_edges", "boundary_singular_tet_edges"}


def threads_of_c():
    """What the table of threads lacks, names twice, or names in vain."""
    section = re.search(r"(?ms)^## Threads$(.*?)^## ", text("docs/user/api-c.md"))[1]
    said = re.findall(r"`(hexhex_\w+)`", "\n".join(re.findall(r"(?m)^\| (`.*?) \|", section)))
    functions = set(c_functions())
    return ([f"docs/user/api-c.md says nothing of {name} and threads" for name in functions - set(said)] +
            [f"docs/user/api-c.md says something of {name} and threads, which is no function"
             for name in set(said) - functions] +
            [f"docs/user/api-c.md says twice what {name} does in threads" for name in set(said)
             if said.count(name) > 1])


def misused_in_c():
    """Functions with handles that tests/c/misuse_test.c does not call with wrong ones."""
    header, test = text("bindings/c/include/hexhex.h"), text("tests/c/misuse_test.c")
    kinds = re.findall(r"HEXHEX_API void (hexhex_\w+)_destroy\(", header)
    takes_handle = re.compile(rf"\b({'|'.join(kinds)})\* \w+")
    return [f"tests/c/misuse_test.c lacks {name}" for name, parameters
            in re.findall(r"HEXHEX_API [^;]*?\b(hexhex_\w+)\(([^;]*)\);", header)
            if takes_handle.search(parameters) and not re.search(rf"\b{name}\(", test)]


def cells_of(row):
    """Columns of a row of a table. A bar in a code span still ends a cell, unless it is escaped."""
    return len(re.split(r"(?<!\\)\|", row.strip())) - 2


def pages():
    return [*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md"), *ROOT.glob("*/*/README.md")]


def anchors(page):
    """Of the headings of a page, as GitHub names them."""
    prose = re.sub(r"(?ms)^```.*?^```$", "", page.read_text(encoding="utf-8"))
    headings = [re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading)
                for heading in re.findall(r"(?m)^#+ (.*)$", prose)]
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def broken_links():
    """Links to files that are not there, or to headings that a page does not have."""
    broken = []
    for page in pages():
        for link in re.findall(r"\]\(([^)\s]+)\)", page.read_text(encoding="utf-8")):
            if re.match(r"\w+:", link):  # to the world outside
                continue
            file, _, anchor = link.partition("#")
            target = page.parent / file if file else page
            if not target.exists() or (anchor and anchor not in anchors(target)):
                broken.append(f"{page.relative_to(ROOT)}: the link to {link} leads nowhere")
    return broken


def broken_tables():
    """Rows without a table, of another width than their table, or that go on in a second line."""
    broken = []
    for page in pages():
        lines, columns, in_code = page.read_text(encoding="utf-8").splitlines(), 0, False
        for number, line in enumerate(lines, 1):
            place = f"{page.relative_to(ROOT)}, line {number}"
            in_code ^= line.startswith("```")
            if in_code or not line.startswith("|"):
                if columns > 0 and line.strip() and not line.startswith(("```", "<!--")):
                    broken.append(f"{place}: the row of a table above goes on here")
                columns = 0
                continue
            if not line.rstrip().endswith("|"):
                broken.append(f"{place}: the row of a table has no end")
            if columns == 0:
                columns = cells_of(line)
                rule = lines[number] if number < len(lines) else ""
                if not re.fullmatch(r"\|( *:?-+:? *\|)+", rule.strip()):
                    broken.append(f"{place}: the row belongs to no table")
            if cells_of(line) != columns:
                broken.append(f"{place}: {cells_of(line)} cells in a table of {columns} columns")
    return broken


def main():
    missing = threads_of_c() + misused_in_c() + broken_tables() + broken_links()
    contents = (("docs/user/errors.md", error_codes(), None), ("docs/user/troubleshooting.md", error_codes(), None),
             ("docs/user/report.md", report_fields(), None),
             ("bindings/c/include/hexhex.h", sorted({*report_fields()} - NOT_IN_C), None),
             ("docs/user/api-c.md", c_functions(), "c"), ("docs/user/api-cpp.md", cpp_functions(), "cpp"),
             ("docs/user/api-python.md", python_names(), "python"))
    for page, names, language in contents:
        if len(names) < 10:
            missing.append(f"{page}: nothing found to look for")
        content = text(page)
        if language is not None:
            content = "\n".join(re.findall(rf"(?ms)^```{language}\n(.*?)^```$", content))
        missing += [f"{page} lacks {name}" for name in names
                    if not re.search(rf"\b{name}\b", content)]
    if missing:
        sys.exit("\n".join(missing))
    print("The pages are complete.")


if __name__ == "__main__":
    main()

