#!/usr/bin/env python3
"""Compares borders of parts that the curve cuts with those of METIS and Scotch.

    bench/parts/cuts.py HEXHEX MAP.hexex...

For 8 and 64 parts of each map at scale 2: shared vertices of the curve and of Scotch as multiples of
METIS', and the largest part of the curve as a multiple of the mean. A line with geometric means and
the largest of each number ends the table.
"""
import json
import math
import pathlib
import subprocess
import sys
import tempfile


def parts_of(command, map_file, count, method):
    """What the report says of parts."""
    with tempfile.TemporaryDirectory() as folder:
        report = pathlib.Path(folder) / "report.json"
        subprocess.run([command, "extract", map_file, "-o", f"{folder}/m", "--format", "msh-split",
                        "--scale", "2", "--parts", str(count), "--partition", method,
                        "--report", report, "--quiet"], check=True)
        return json.loads(report.read_text())


def compare(command, map_file, count):
    reports = {m: parts_of(command, map_file, count, m) for m in ("curve", "scotch", "metis")}
    metis = reports["metis"]["parts"]["shared_vertices"]
    largest = reports["curve"]["parts"]["largest"]
    return [reports["curve"]["parts"]["shared_vertices"] / metis,
            reports["scotch"]["parts"]["shared_vertices"] / metis,
            largest * count / reports["curve"]["cells"]]


def main():
    command, maps = sys.argv[1], sys.argv[2:]
    print(f"{'map':32} {'parts':>5} {'curve':>6} {'scotch':>6} {'largest':>7}")
    for count in (8, 64):
        rows = []
        for map_file in maps:
            rows.append(compare(command, map_file, count))
            print(f"{pathlib.Path(map_file).stem:32} {count:5} {rows[-1][0]:6.2f} {rows[-1][1]:6.2f}"
                  f" {rows[-1][2]:7.3f}")
        for what, of in (("geometric mean", lambda x: math.exp(sum(map(math.log, x)) / len(x))),
                         ("largest", max)):
            numbers = [of([row[k] for row in rows]) for k in range(3)]
            print(f"{what:32} {count:5} {numbers[0]:6.2f} {numbers[1]:6.2f} {numbers[2]:7.3f}")


if __name__ == "__main__":
    main()
