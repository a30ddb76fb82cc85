#!/usr/bin/env python3
"""Curved cells of real maps: how many are not positive, and how far they are from the surface.

    bench/curved/trials.py HEXHEX MOST_CELLS MAP.hexex...

Extracts each map at scales 1 and 2, of up to MOST_CELLS cells, straight and of orders 2 and 3, the latter with exact nodes,
too, and prints a table. Distances, in diagonals, are from 16 points of each quad of the boundary to the boundary of the
tets, root mean square. What measures them takes nothing from hexhex but the nodes that it wrote. At the end: whether each
mesh that is positive when straight is positive, too, when curved, and how much longer that takes than exact nodes."""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[1] / "improve"))
import boundaries  # noqa: E402

SIDE = 4  # points along each side of a quad


def read_mfem(file, p):
    """Corners of cells, and their nodes as [cell, z, y, x]."""
    words = iter(file.read_text().split())
    while next(words) != "elements":
        pass
    corners = np.array([[int(next(words)) for _ in range(10)][2:] for _ in range(int(next(words)))])
    while next(words) != "Ordering:":
        pass
    assert next(words) == "1"  # x, y and z of a node together
    return corners, np.array(list(words), dtype=float).reshape(len(corners), p + 1, p + 1, p + 1, 3)


def read_straight(file):
    points, corners = boundaries.read_medit(file)
    return corners, points[corners[:, [0, 1, 3, 2, 4, 5, 7, 6]]].reshape(-1, 2, 2, 2, 3)


def weights(p, places):
    """Of the Lagrange polynomials of equidistant nodes."""
    nodes = np.arange(p + 1) / p
    factors = [[np.prod([(x - nodes[j]) / (nodes[i] - nodes[j]) for j in range(p + 1) if j != i]) for i in range(p + 1)]
               for x in places]
    return np.array(factors)


def boundary_points(corners, nodes):
    """16 points of each face that one cell has."""
    p = nodes.shape[1] - 1
    number = corners[:, [0, 1, 3, 2, 4, 5, 7, 6]].reshape(-1, 2, 2, 2)

    def faces(grid):
        return np.concatenate([np.moveaxis(grid, axis, 1)[:, side] for axis in (1, 2, 3) for side in (0, -1)])

    _, first, counts = np.unique(np.sort(faces(number).reshape(-1, 4), axis=1), axis=0, return_index=True,
                                 return_counts=True)
    own = weights(p, (np.arange(SIDE) + 0.5) / SIDE)
    return np.einsum("ai,bj,fijx->fabx", own, own, faces(nodes)[first[counts == 1]]).reshape(-1, 3)


def made(hexhex, folder, map_file, scale, order, nodes="blended"):
    run = [hexhex, "extract", map_file, "--scale", str(scale), "--order", str(order), "--curved", nodes, "--threads", "1",
           "--quiet", "-o", folder / "mesh.mesh", "--report", folder / "report.json"]
    subprocess.run(run, check=True, stderr=subprocess.DEVNULL)
    return json.loads((folder / "report.json").read_text())


def bad(report):
    return report["cells"] - report["validity"]["positive"]


def seconds(report):
    return report["extract_seconds"] + report["seconds"]["quality"]


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    hexhex, most, maps = sys.argv[1], float(sys.argv[2]), sys.argv[3:]
    broken, slowest, largest = [], 0, 0
    print("| map | scale | cells | not positive: straight | order 2 | order 3 | exact, 2 | exact, 3 | off the surface, 2 | 3 "
          "| distance: straight | order 2 | order 3 |\n" + "|---" * 13 + "|")
    with tempfile.TemporaryDirectory() as folder:
        for map_file in maps:
            points, tets = boundaries.read_tets(map_file)
            surface = boundaries.tet_boundary(points, tets)
            diagonal = np.linalg.norm(np.ptp(points, axis=0))
            pieces = (surface, *boundaries.divided(surface, boundaries.SPACING * diagonal))
            for scale in (1, 2):
                counts, exact, named, distances = [], [], [], []
                for order in (1, 2, 3):
                    report = made(hexhex, Path(folder), map_file, scale, order)
                    if report["cells"] > most:
                        break
                    file = Path(folder) / "mesh.mesh"
                    mesh = read_straight(file) if order == 1 else read_mfem(file, order)
                    found = boundaries.to_pieces(boundary_points(*mesh), pieces)
                    distances.append(np.sqrt(np.mean(found**2)) / diagonal)
                    counts.append(bad(report))
                    if order == 1:
                        continue
                    named.append(len(report["curved"]["straightened_cells"]))
                    before = made(hexhex, Path(folder), map_file, scale, order, "exact")
                    exact.append(bad(before))
                    slowest = max(slowest, seconds(report) / seconds(before))
                    largest = max(largest, report["peak_memory_bytes"] / before["peak_memory_bytes"])
                    if counts[-1] > counts[0]:
                        broken.append((map_file, scale, order))
                else:
                    print("|", " | ".join([Path(map_file).stem, str(scale), str(report["cells"]),
                                           *map(str, counts + exact + named), *(f"{d:.1e}" for d in distances)]), "|",
                          flush=True)
    print(f"\n{len(broken)} with more cells that are not positive than straight; at most {slowest:.2f} times the time of "
          f"exact nodes, with certificates, and {largest:.2f} times their memory")


if __name__ == "__main__":
    main()
