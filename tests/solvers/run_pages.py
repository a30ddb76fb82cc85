#!/usr/bin/env python3
"""Runs the pages of docs/user/solvers: their commands, then their snippet of Python, where the solver is installed.

    run_pages.py PATH-OF-HEXHEX

A snippet computes `error`, the largest difference from a linear function that the boundary was given,
`volume` and, if it can, the `area` of patch_1; a program in C++ prints these three. The part is an octagonal prism of height 1 around a unit circle.
Exit code 77 if no solver is installed. HEXHEX_PYTHON names a Python with modules of solvers.
"""

import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "parts"))
from common import python_with  # noqa: E402

PAGES = pathlib.Path(__file__).resolve().parents[2] / "docs" / "user" / "solvers"
# Page: what it needs, how exact its numbers are, and options of more runs.
NEEDS = {"scikit-fem": "skfem", "ngsolve": "ngsolve", "mfem": "mfem", "getfem": "getfem", "dolfinx": "dolfinx", "calculix": None,
         "dealii": None, "openfoam": None}
# What else tells that a solver is installed.
SIGNS = {"calculix": lambda: shutil.which("ccx"), "openfoam": lambda: shutil.which("checkMesh"),
         "dealii": lambda: pathlib.Path("/usr/share/cmake/deal.II").exists()}
DIGITS = {"calculix": 1e-6}
MORE_RUNS = {"calculix": ["--order", "2"]}

OCTAGON = 2 * math.sqrt(2)


def python_for(page):
    if NEEDS[page] is None:
        return sys.executable if SIGNS[page]() else None
    return python_with(NEEDS[page])


def run(*words, folder):
    result = subprocess.run([str(word) for word in words], cwd=folder, capture_output=True, text=True, check=False)
    if result.returncode != 0:
        sys.exit(f"{' '.join(map(str, words))} failed:\n{result.stdout}{result.stderr}")
    return result.stdout


def run_python(snippets, python, folder):
    (pathlib.Path(folder) / "snippet.py").write_text(
        snippets["python"] + "\nprint(float(error), float(volume), float(globals().get('area', volume)))\n",
        encoding="utf-8")
    return run(python, "snippet.py", folder=folder)


def run_cpp(snippets, folder):
    """Compiles `part.cpp`, quickly."""
    (pathlib.Path(folder) / "part.cpp").write_text(snippets["cpp"], encoding="utf-8")
    (pathlib.Path(folder) / "CMakeLists.txt").write_text(
        snippets["cmake"] + "target_compile_options(part PRIVATE -O0)\n", encoding="utf-8")
    run("cmake", "-S", ".", "-B", "build", "-DCMAKE_BUILD_TYPE=Release", folder=folder)
    run("cmake", "--build", "build", folder=folder)
    return run("build/part", folder=folder)


def check_page(page, command, python, options):
    text = (PAGES / f"{page}.md").read_text(encoding="utf-8")
    with tempfile.TemporaryDirectory() as name:
        lines = re.findall(r"(?m)^    hexhex (.*)$", text)
        if not any(f"--for {page}" in line for line in lines):
            sys.exit(f"{page}.md does not write a mesh with --for {page}")
        for line in lines:
            run(command, *line.split(), *(options if "--for" in line else []), folder=name)
        snippets = dict(re.findall(r"(?ms)^```(\w+)\n(.*?)^```$", text))
        said = run_cpp(snippets, name) if "cpp" in snippets else run_python(snippets, python, name)
    found = [float(x) for x in said.split()[-3:]]
    limit = DIGITS.get(page, 1e-12)
    for value, expected, what in zip(found, (0, OCTAGON, OCTAGON), ("error", "volume", "area")):
        if not abs(value - expected) < limit:
            sys.exit(f"{page}, {what}: {value!r} instead of {expected!r}")


def main():
    command = pathlib.Path(sys.argv[1]).resolve()
    if set(NEEDS) != {page.stem for page in PAGES.glob("*.md")} - {"README"}:
        sys.exit("the pages are not those that this test knows")
    skipped = 0
    for page in NEEDS:
        python = python_for(page)
        if python is not None:
            for options in ([], MORE_RUNS.get(page)):
                if options is not None:
                    check_page(page, command, python, options)
        skipped += python is None
        print(f"{page}: {'skipped, it is not installed' if python is None else 'passed'}", flush=True)
    sys.exit(77 if skipped == len(NEEDS) else 0)


if __name__ == "__main__":
    main()
