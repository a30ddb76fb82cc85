#!/usr/bin/env python3
"""Draws docs/images/quantize.svg: how a seamless map becomes a mesh.

    docs/images/draw_quantize.py PATH-OF-HEXHEX > docs/images/quantize.svg

All four panels show the lower end of one cylinder: lines of a seamless map's parameters, which do not
meet where charts do; the walls that grow from its four singular curves; the integers that hexhex
quantize has chosen for their arcs; the hexahedra.
"""
import subprocess
import sys
import tempfile
from pathlib import Path

from figure import Figure, boundary_triangles, isolines, minus, read_map, read_medit

PANEL = 240
TITLES = ("a seamless map", "its motorcycle complex", "integers for its arcs", "the mesh")
TINT = ("#e45756", "#54a24b", "#4c78a8")
DARK = "#22344d"
QUADS = ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))


def place(panel, point):
    return (PANEL * (panel + 0.5) + 0.45 * PANEL * point[0], 0.49 * PANEL - 0.45 * PANEL * point[1])


def end_triangles(name):
    """Of a map's lower end, with parameters."""
    points, tets = read_map(name)
    return points, [(vertices, u) for vertices, u in boundary_triangles(tets)
                    if all(points[v][2] == 0 for v in vertices)]


def edges_of(triangles):
    """Per edge: the ends' parameters in each triangle at it."""
    edges = {}
    for vertices, u in triangles:
        for i in range(3):
            (a, ua), (b, ub) = sorted([(vertices[i], u[i]), (vertices[i - 1], u[i - 1])])
            edges.setdefault((a, b), []).append((ua, ub))
    return edges


def arcs_of(triangles):
    """Chains of edges where charts differ or the object ends, between vertices where these meet."""
    seams = [edge for edge, sides in edges_of(triangles).items()
             if len(sides) == 1 or max(abs(x - y) for p, q in zip(*sides) for x, y in zip(p, q)) > 1e-6]
    at = {}
    for edge in seams:
        for v in edge:
            at.setdefault(v, []).append(edge)
    arcs, left = [], set(seams)
    for start in (v for v, edges in at.items() if len(edges) != 2):
        for edge in at[start]:
            if edge not in left:
                continue
            arc, v = [], start
            while edge in left:
                left.remove(edge)
                arc.append(edge)
                v = edge[0] if edge[1] == v else edge[1]
                if len(at[v]) == 2:
                    edge = at[v][0] if at[v][1] == edge else at[v][1]
            arcs.append(arc)
    return arcs, {v for v, edges in at.items() if len(edges) == 3 and
                  all(len(edges_of(triangles)[e]) == 2 for e in edges)}


def length(arc, edges):
    """In the map's parameters."""
    return sum(max(abs(x) for x in minus(*edges[edge][0])) for edge in arc)


def draw(figure, seamless, integer, mesh):
    points, triangles = end_triangles(seamless)
    integers = edges_of(end_triangles(integer)[1])
    arcs, singular = arcs_of(triangles)
    for panel in range(3):
        for vertices, u in triangles:
            at = [place(panel, points[v]) for v in vertices]
            figure.polygon(at, "#f0f3f8", "#cfd7e3", 0.5)
        for vertices, u in triangles if panel == 0 else ():
            corners = [points[v] for v in vertices]
            for axis in range(3):
                if max(p[axis] for p in u) - min(p[axis] for p in u) < 1e-6:
                    continue
                for a, b in isolines(corners, u, axis):
                    figure.line(place(0, a), place(0, b), TINT[axis], 1.2)
    for panel in (1, 2):
        for arc in arcs:
            for a, b in arc:
                figure.line(place(panel, points[a]), place(panel, points[b]), DARK, 2)
    for panel in (0, 1):
        for v in singular:
            figure.dot(place(panel, points[v]), 4, "#e45756")
    for arc in arcs:
        a, b = (points[v] for v in arc[len(arc) // 2])
        middle = place(2, [(x + y) / 2 for x, y in zip(a, b)])
        figure.dot(middle, 9, "white", DARK)
        figure.text((middle[0], middle[1] + 4), str(round(length(arc, integers))), 11)
    hex_points, cells = mesh
    for cell in cells:
        for quad in QUADS:
            if all(hex_points[cell[i]][2] == 0 for i in quad):
                figure.polygon([place(3, hex_points[cell[i]]) for i in quad], "#cfdcec", DARK, 1)


def main():
    command = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        seamless, integer, mesh = (Path(folder) / name for name in
                                   ("seamless.hexex", "integer.hexex", "mesh.mesh"))
        for words in (["generate", "cylinder", "--cells", "5", "--refine", "4", "--charts", "blocks",
                       "--stretch", "0.4", "--seed", "3", "-o", seamless],
                      ["quantize", seamless, "-o", integer, "--cells", "700"],
                      ["extract", integer, "-o", mesh]):
            subprocess.run([command, *words, "--quiet"], check=True)
        figure = Figure(4 * PANEL, PANEL + 20)
        draw(figure, seamless, integer, read_medit(mesh, "Hexahedra"))
    for panel, title in enumerate(TITLES):
        figure.text((PANEL * (panel + 0.5), PANEL + 10), title, 14)
    for panel in (1, 2, 3):
        figure.arrow((PANEL * panel - 10, 0.49 * PANEL), (PANEL * panel + 10, 0.49 * PANEL), DARK, 2.5)
    print(figure.finish())


main()
