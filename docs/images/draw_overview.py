#!/usr/bin/env python3
"""Draws docs/images/overview.svg: a part and its hexahedra.

    docs/images/draw_overview.py PATH-OF-HEXHEX > docs/images/overview.svg

Both panels show examples/bracket.mesh: its tets, and what `hexhex mesh` makes of them.
"""
import math
import subprocess
import sys
import tempfile
from pathlib import Path

from figure import Figure, dot, minus, read_medit

PANEL = 320
HEIGHT = 250
SIZE = 0.158 * PANEL  # of a unit
CENTER = (0.0, 0.0, 0.85)
TITLES = ("your part, as tets", "its hexahedra")
PART = Path(__file__).resolve().parents[2] / "examples" / "bracket.mesh"
TETS, HEXAHEDRA = (222, 226, 232), (180, 198, 218)
TRIANGLES = ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1))
QUADS = ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))


def rotation(turn, tilt):
    """Rows: right, up, towards the viewer."""
    c, s, ct, st = math.cos(turn), math.sin(turn), math.cos(tilt), math.sin(tilt)
    return ((-s, c, 0), (-st * c, -st * s, ct), (ct * c, ct * s, st))


VIEW = rotation(math.radians(-58), math.radians(24))
LIGHT = (0.25, 0.55, 0.8)


def boundary(points, cells, sides):
    """Corners of faces of just one cell."""
    found = {}
    for cell in cells:
        for side in sides:
            vertices = [cell[i] for i in side]
            found.setdefault(tuple(sorted(vertices)), []).append(vertices)
    return [[points[v] for v in same[0]] for same in found.values() if len(same) == 1]


def middle(points):
    return tuple(sum(p[k] for p in points) / len(points) for k in range(3))


def seen(point):
    return tuple(dot(row, point) for row in VIEW)


def shade(points):
    """How much light a flat face gets; None if it is seen from behind."""
    a, b, c = (seen(p) for p in points[:3])
    p, q = minus(b, a), minus(c, a)
    n = (p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0])
    length = math.sqrt(dot(n, n))
    if n[2] <= 0 or length == 0:
        return None
    return 0.74 + 0.28 * max(0.0, dot(n, LIGHT) / length)


def lit(color, light):
    return "#" + "".join(f"{round(min(255, channel * light)):02x}" for channel in color)


def place(panel, point):
    x, y, _ = seen(minus(point, CENTER))
    return (PANEL * (panel + 0.5) + SIZE * x, 0.47 * HEIGHT - SIZE * y)


def back_to_front(faces):
    return sorted(faces, key=lambda face: seen(middle(face))[2])


def draw(figure, panel, faces, color, outline, width):
    with figure.outlined(outline, width):
        for corners in back_to_front(faces):
            light = shade(corners)
            if light is not None:
                figure.fill([place(panel, p) for p in corners], lit(color, light))


def main():
    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder) / "mesh.mesh"
        subprocess.run([sys.argv[1], "mesh", PART, "-o", target, "--cells", "2500", "--method", "polycube", "--quiet"], check=True)
        panels = [boundary(*read_medit(file, kind), sides)
                  for file, kind, sides in ((PART, "Tetrahedra", TRIANGLES), (target, "Hexahedra", QUADS))]
    figure = Figure(2 * PANEL, HEIGHT + 10)
    draw(figure, 0, panels[0], TETS, "#44546a", 0.5)
    draw(figure, 1, panels[1], HEXAHEDRA, "#22344d", 0.8)
    for panel, title in enumerate(TITLES):
        figure.text((PANEL * (panel + 0.5), HEIGHT), title, 15)
    figure.arrow((PANEL - 14, 0.3 * HEIGHT), (PANEL + 14, 0.3 * HEIGHT), "#22344d", 3)
    print(figure.finish())


main()
