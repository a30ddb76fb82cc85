#!/usr/bin/env python3
"""Whether the pages of docs/ name all that they should: every error code, every function of C and every
name of the Python package."""

import ast
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]

# Told of in words, or siblings of what a snippet shows.
C_IN_HEADER_ONLY = re.compile(r"_destroy$|_get_(arrays|stage)$|^hexhex_context_|^hexhex_buffer_|"
                              r"^hexhex_mesh_writer_|^hexhex_lagrange_mesh_|^hexhex_piecewise_mesh_|"
                              r"^hexhex_(version|scaled_jacobian|extractor_cells|mesh_copy|mesh_read|"
                              r"map_read_tets|map_read_pair|map_from_pair|check_get_occurrence|"
                              r"holes_get|repair_get_region)$")


def text(path):
    return (ROOT / path).read_text(encoding="utf-8")


def error_codes():
    body = re.search(r"enum class ErrorCode \{(.*?)\};", text("include/hexhex/error.hpp"), re.S)[1]
    return re.findall(r"^\s*([A-Z]\w+)", body, re.M)


def c_functions():
    names = re.findall(r"HEXHEX_API [^;]*?\b(hexhex_\w+)\(", text("bindings/c/include/hexhex.h"))
    return [name for name in names if not C_IN_HEADER_ONLY.search(name)]


def python_names():
    tree = ast.parse(text("bindings/python/hexhex/__init__.py"))
    for node in tree.body:
        if isinstance(node, ast.Assign) and node.targets[0].id == "__all__":
            return [name for name in ast.literal_eval(node.value) if name[0].islower()]
    raise SystemExit("the package has no __all__")


def main():
    missing = []
    for page, names in (("docs/errors.md", error_codes()), ("docs/troubleshooting.md", error_codes()),
                        ("docs/api-c.md", c_functions()), ("docs/api-python.md", python_names())):
        if len(names) < 10:
            missing.append(f"{page}: nothing found to look for")
        content = text(page)
        missing += [f"{page} lacks {name}" for name in names
                    if not re.search(rf"\b{name}\b", content)]
    if missing:
        sys.exit("\n".join(missing))
    print("The pages are complete.")


if __name__ == "__main__":
    main()
