#!/usr/bin/env python3
"""Draws docs/images/overview.svg: a map, its integer grid, and its hexahedra.

    docs/images/draw_overview.py PATH-OF-HEXHEX > docs/images/overview.svg

All three panels show a bearing bracket: its tets, coloured by the parameters of their charts; the
lines where a parameter is an integer; the cells that hexhex extracts.
"""
import math
import subprocess
import sys
import tempfile
from pathlib import Path

from bracket import Bracket
from figure import Figure, boundary_triangles, dot, isolines, minus, read_map, read_mesh

PANEL = 320
HEIGHT = 250
SIZE = 0.158 * PANEL  # of a unit
CENTER = (0.0, 0.0, 0.85)
TITLES = ("a map: tets with parameters", "its integer grid", "the hexahedra")
TINT = ((228, 87, 86), (84, 162, 75), (76, 120, 168))  # of u, v, w
QUADS = ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))


def rotation(turn, tilt):
    """Rows: right, up, towards the viewer."""
    c, s, ct, st = math.cos(turn), math.sin(turn), math.cos(tilt), math.sin(tilt)
    return ((-s, c, 0), (-st * c, -st * s, ct), (ct * c, ct * s, st))


VIEW = rotation(math.radians(-58), math.radians(24))
LIGHT = (0.25, 0.55, 0.8)


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


def blend(color, share):
    return tuple(share * channel + (1 - share) * 255 for channel in color)


def tint(parameters, scale):
    """A mixture of the three colours, by the mean of a triangle's parameters."""
    shares = [min(1.0, abs(sum(u[k] for u in parameters)) / 3 / scale) for k in range(3)]
    return tuple(255 - sum(share * (255 - TINT[k][i]) for k, share in enumerate(shares)) / 1.4
                 for i in range(3))


def place(panel, point):
    x, y, _ = seen(minus(point, CENTER))
    return (PANEL * (panel + 0.5) + SIZE * x, 0.47 * HEIGHT - SIZE * y)


def back_to_front(faces):
    return sorted(faces, key=lambda face: seen(middle(face[0]))[2])


def tet_panels(figure, points, tets):
    triangles = [([points[v] for v in vertices], u) for vertices, u in boundary_triangles(tets)]
    scale = max(abs(x) for _, u in triangles for corner in u for x in corner)
    for panel in (0, 1):
        for corners, u in back_to_front(triangles):
            light = shade(corners)
            if light is None:
                continue
            at = [place(panel, p) for p in corners]
            color = tint(u, scale) if panel == 0 else (240, 243, 248)
            edge = "#44546a" if panel == 0 else "#bcc6d4"
            figure.polygon(at, lit(color, light), edge, 0.5)
            if panel == 1:
                for axis in range(3):
                    for a, b in isolines(corners, u, axis):
                        figure.line(place(1, a), place(1, b),
                                    lit(TINT[axis], 0.9), 1.4)


def hex_panel(figure, points, cells):
    quads = {}
    for cell in cells:
        for quad in QUADS:
            vertices = [cell[i] for i in quad]
            quads.setdefault(tuple(sorted(vertices)), []).append(vertices)
    outer = [([points[v] for v in same[0]], None) for same in quads.values() if len(same) == 1]
    for corners, _ in back_to_front(outer):
        light = shade(corners)
        if light is not None:
            figure.polygon([place(2, p) for p in corners],
                           lit(blend(TINT[2], 0.42), light), "#22344d", 1.0)


def main():
    command = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        map_file, mesh_file = Path(folder) / "map.hexex", Path(folder) / "mesh.mesh"
        Bracket().write(map_file)
        subprocess.run([command, "extract", map_file, "-o", mesh_file, "--quiet"], check=True)
        points, tets = read_map(map_file)
        hex_points, cells = read_mesh(mesh_file)
    figure = Figure(3 * PANEL, HEIGHT + 10)
    tet_panels(figure, points, tets)
    hex_panel(figure, hex_points, cells)
    for panel, title in enumerate(TITLES):
        figure.text((PANEL * (panel + 0.5), HEIGHT), title, 15)
    for panel in (1, 2):
        figure.arrow((PANEL * panel - 14, 0.3 * HEIGHT), (PANEL * panel + 14, 0.3 * HEIGHT),
                     "#22344d", 3)
    print(figure.finish())


main()
