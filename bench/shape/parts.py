#!/usr/bin/env python3
"""What `hexhex mesh` makes of parts: the tets of all files in some folders, without the maps that come with them.

    PYTHONPATH=bench/improve bench/shape/parts.py HEXHEX FOLDER... [--cells 5000] [--method auto] [--only WORD] [--threads 1]

Prints a row per file: tets, how the map was made, whether there is a certified mesh, its least and mean
scaled Jacobian, distances between the boundaries in diagonals (both ways, by bench/improve/boundaries.py), the share of the
length of sharp edges that edges of the mesh follow, and seconds; then how many there are of each. Needs numpy and scipy."""
import argparse
import json
import subprocess
import tempfile
import time
from pathlib import Path

import boundaries

FORMATS = {".hexex", ".mesh", ".msh", ".vtu", ".vtk", ".ovm"}
HEAD = ("| part | tets | by | cells | minimum | mean | to the surface | from the surface | sharp edges | seconds |\n"
        "|---|---:|---|---:|---:|---:|---:|---:|---:|---:|\n")


def run(command, *arguments):
    """Whether it succeeded, and the first line of what it said."""
    made = subprocess.run([command, *map(str, arguments), "--quiet"], capture_output=True, text=True)
    return made.returncode == 0, (made.stderr.strip().splitlines() or [""])[0].removeprefix("hexhex: error: ")


def distances(command, folder):
    run(command, "convert", folder / "mesh.vtu", folder / "mesh.mesh")
    made = boundaries.hex_boundary(*boundaries.read_medit(folder / "mesh.mesh"))
    return boundaries.distances(made, boundaries.tet_boundary(*boundaries.read_tets(folder / "map.hexex")))


def row_of(file, options, folder):
    """A row, and what was reached: mapped, certified, good."""
    begin = time.monotonic()
    done, said = run(options.command, "mesh", file, "-o", folder / "mesh.vtu", "--cells", options.cells, "--keep-map",
                     folder / "map.hexex", "--report", folder / "report.json", "--threads", options.threads, "--method", options.method)
    seconds = time.monotonic() - begin
    if not done:
        mapped = run(options.command, "map", file, "-o", folder / "map.hexex", "--threads", options.threads, "--method", options.method)[0]
        return f"| {file.stem} | {'mapped, but ' if mapped else ''}{said[:160]} | | | | | | | | {seconds:.0f} |\n", (mapped, False, False)
    report = json.loads((folder / "report.json").read_text())
    shape, quality = report["map"], report["improvement"]["after"]["quality"]
    away = distances(options.command, folder)
    curves = report["improvement"]
    sharp = f"{100 * curves['curves_followed']:.1f} %" if curves["curve_length"] > 0 else "none"
    row = (f"| {file.stem} | {report['part']['tets']} | {shape['method']}{'' if shape['labels']['valid'] else ' (labels not quite valid)'} "
           f"| {report['mesh']['cells']} | {quality['minimum']:.3f} | {quality['mean']:.3f} | {away[0]:.1e} | {away[1]:.1e} "
           f"| {sharp} | {seconds:.0f} |\n")
    return row, (True, True, quality["minimum"] >= 0.2 and max(away) <= 5e-3)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command", type=lambda name: Path(name).resolve())
    parser.add_argument("folders", type=Path, nargs="+")
    parser.add_argument("--cells", type=int, default=5000)
    parser.add_argument("--method", default="auto")
    parser.add_argument("--only", default="")
    parser.add_argument("--threads", type=int, default=1)
    options = parser.parse_args()
    files = [file for folder in options.folders for file in sorted(folder.iterdir())
             if file.suffix in FORMATS and options.only in file.name]
    print(HEAD, end="", flush=True)
    reached = []
    for file in files:
        with tempfile.TemporaryDirectory() as folder:
            row, each = row_of(file.resolve(), options, Path(folder))
        print(row, end="", flush=True)
        reached.append(each)
    mapped, certified, good = (sum(column) for column in zip(*reached)) if reached else (0, 0, 0)
    print(f"\n{len(files)} parts: {mapped} mapped, {certified} certified, {good} of them within 5e-3 both ways and with a least "
          "scaled Jacobian of 0.2.")


if __name__ == "__main__":
    main()
