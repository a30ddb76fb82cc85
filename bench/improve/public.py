#!/usr/bin/env python3
"""What `hexhex improve` makes of meshes of others, and of maps of real models: the table of docs/user/improve.md.

    PYTHONPATH=bench bench/improve/public.py HEXHEX [DATA] [--only WORD] [--docs FOLDER]

DATA has hexes/*.mesh and *.vtk (other cells are left out), maps/*.hexex (extracted at scale 1), and seamless/*.hexex
(quantized to 1 and 10 cells per tet); ../shared/data by default. Prints a row each, and what is not certified in the end;
with --docs, the table
replaces the one of FOLDER/improve.md. --only takes the files whose name contains a word. Needs numpy, scipy and matplotlib.

Distances are those of bench/improve/boundaries.py, from the mesh to the surface and back: of a map its boundary, of
another mesh its own boundary as it was, and of NAME_out, what others made of NAME_in, the boundary of that."""
import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import boundaries
from evaluation import document

PART = "table-public"
HEAD = ("| mesh | cells | not positive | afterwards | minimum | mean | to the surface | from the surface |\n"
        "|---|---:|---:|---:|---|---|---|---|\n")


class Refused(Exception):
    """The command failed; the first sentence of its error."""


class Runs:
    def __init__(self, command, folder):
        self.command = command
        self.folder = folder

    def run(self, *arguments):
        made = subprocess.run([self.command, *map(str, arguments), "--threads", "1", "--quiet"], cwd=self.folder,
                              capture_output=True, text=True)
        if made.returncode != 0:
            lines = made.stderr.strip().splitlines() or [f"exit code {made.returncode}"]
            raise Refused(lines[0].removeprefix("hexhex: error: ").split(". ")[0])

    def medit(self, mesh, name):
        self.run("convert", mesh, name, "--hexes-only")
        return boundaries.hex_boundary(*boundaries.read_medit(self.folder / name))

    def improvement(self):
        return json.loads((self.folder / "report.json").read_text())

    def of_mesh(self, file):
        self.run("improve", file, "-o", "after.vtu", "--report", "report.json", "--hexes-only")
        original = file.with_name(file.name.replace("_out.", "_in."))
        return self.improvement(), self.medit(original, "original.mesh"), self.medit(file, "before.mesh")

    def of_map(self, file, surface):
        self.run("extract", file, "-o", "before.vtu")
        self.run("extract", file, "-o", "after.vtu", "--improve", "--report", "report.json")
        return self.improvement()["improvement"], surface, self.medit("before.vtu", "before.mesh")


def surface_of(file):
    return boundaries.tet_boundary(*boundaries.read_tets(file))


def bad_of(part):
    return part["validity"]["refuted"] + part["validity"]["undecided"]


def row_of(name, runs, make):
    """A row, and whether all cells are certified, of what make() returns."""
    try:
        report, surface, before = make()
        after = runs.medit("after.vtu", "after.mesh")
    except Refused as error:
        return f"| {name} | refused: {error} | | | | | | |\n", False
    was, now = report["before"], report["after"]
    cells = sum(now["validity"][key] for key in ("positive", "refuted", "undecided"))
    far = [[f"{d:.1e}" for d in boundaries.distances(boundary, surface)] for boundary in (before, after)]
    pairs = [f"{was['quality'][key]:.3f} → {now['quality'][key]:.3f}" for key in ("minimum", "mean")]
    pairs += [f"{far[0][i]} → {far[1][i]}" for i in range(2)]
    left = bad_of(now)
    return f"| {name} | {cells:,} | {bad_of(was):,} | {left:,} | {' | '.join(pairs)} |\n", left == 0


def cases(data, runs):
    """(name, how to make it)."""
    for file in sorted([*(data / "hexes").glob("*.mesh"), *(data / "hexes").glob("*.vtk")]):
        yield file.stem, lambda file=file: runs.of_mesh(file)
    for file in sorted((data / "maps").glob("*.hexex")):
        yield file.stem, lambda file=file: runs.of_map(file, surface_of(file))
    for file in sorted((data / "seamless").glob("*.hexex")):
        for per_tet in (1, 10):
            def make(file=file, per_tet=per_tet):
                tets = len(boundaries.read_tets(file)[1])
                runs.run("quantize", file, "-o", "integer.ovmb", "--cells", per_tet * tets)
                return runs.of_map("integer.ovmb", surface_of(file))
            yield f"{file.stem}, {per_tet} per tet", make


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("hexhex", type=Path)
    parser.add_argument("data", type=Path, nargs="?", default=Path("../shared/data"))
    parser.add_argument("--only", default="")
    parser.add_argument("--docs", type=Path)
    arguments = parser.parse_args()
    rows, left = [], []
    print(HEAD, end="", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        runs = Runs(arguments.hexhex.resolve(), Path(folder))
        for name, make in cases(arguments.data.resolve(), runs):
            if arguments.only not in name:
                continue
            row, certified = row_of(name, runs, make)
            print(row, end="", flush=True)
            rows.append(row)
            if not certified:
                left.append(name)
    if not rows:
        sys.exit(f"nothing to improve in {arguments.data}")
    certified = len(rows) - len(left)
    ending = f"\n{certified} of {len(rows)} are certified in the end" + (
        f"; not {', '.join(left)}.\n" if left else ".\n")
    print(ending, end="")
    if arguments.docs is not None:
        document.rewrite_page(arguments.docs / "improve.md", {PART: lambda: HEAD + "".join(rows) + ending})


if __name__ == "__main__":
    main()
