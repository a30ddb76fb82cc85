#!/usr/bin/env python3
"""Draws docs/images/engine-propeller.svg and engine-atlas.svg: how the two engines work.

    docs/images/draw_engines.py PATH-OF-HEXHEX FOLDER

Both show the top of a column around an edge of valence three, where the map's triangles lie in one
plane: what the engines do with tets in space can be seen there with triangles.
"""
import math
import subprocess
import sys
import tempfile
from pathlib import Path

from figure import Figure, boundary_triangles, isolines, minus, read_map

PANEL, MARGIN = 270, 22
INK, PALE, LINE = "#22344d", "#eef2f8", "#aab6c6"
RED, BLUE, GREEN, ORANGE = "#d64545", "#3f73b5", "#3d9a50", "#e8963a"
DIRECTIONS = ((1, 0), (0, 1), (-1, 0), (0, -1))
DIAGONALS = ((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5))
TINY = 1e-9


class Patch:
    """Triangles in the plane with two parameters at each corner, and who is beside whom."""

    def __init__(self, points, tets):
        top = max(p[2] for p in points)
        self.points = points
        self.triangles = [(v, [(a, b) for a, b, _ in u]) for v, u in boundary_triangles(tets)
                          if all(points[i][2] == top for i in v)]
        sides = {}
        for t, (v, _) in enumerate(self.triangles):
            for i in range(3):
                sides.setdefault(frozenset((v[i], v[(i + 1) % 3])), []).append((t, i))
        self.mates = {}
        for pair in sides.values():
            if len(pair) == 2:
                self.mates[pair[0]], self.mates[pair[1]] = pair[1], pair[0]

    def weights(self, t, p):
        """Barycentric coordinates of parameters in a triangle."""
        a, b, c = self.triangles[t][1]
        area = cross(minus(b, a), minus(c, a))
        return (cross(minus(b, p), minus(c, p)) / area, cross(minus(c, p), minus(a, p)) / area,
                cross(minus(a, p), minus(b, p)) / area)

    def place(self, t, p):
        """The point of the plane with these parameters in the chart of a triangle."""
        weights = self.weights(t, p)
        corners = [self.points[i] for i in self.triangles[t][0]]
        return tuple(sum(w * corner[k] for w, corner in zip(weights, corners)) for k in range(2))

    def is_cut(self, t, i):
        """Whether the charts on both sides of an inner side differ."""
        if (t, i) not in self.mates:
            return False
        other, j = self.mates[t, i]
        here, there = self.triangles[t][1], self.triangles[other][1]
        return (here[i], here[(i + 1) % 3]) != (there[(j + 1) % 3], there[j])

    def cross_side(self, t, i, vectors):
        """Parameters and directions as the triangle behind a side has them."""
        other, j = self.mates[t, i]
        here, there = self.triangles[t][1], self.triangles[other][1]
        a, b = here[i], there[(j + 1) % 3]
        p, q = minus(here[(i + 1) % 3], a), minus(there[j], b)
        c = (p[0] * q[0] + p[1] * q[1]) / (p[0] ** 2 + p[1] ** 2)
        s = cross(p, q) / (p[0] ** 2 + p[1] ** 2)
        point, direction = vectors
        x, y = minus(point, a)
        return other, ((b[0] + c * x - s * y, b[1] + s * x + c * y),
                       (c * direction[0] - s * direction[1], s * direction[0] + c * direction[1]))

    def trace(self, t, p, direction, length=1.0):
        """Follows a straight segment of parameters from triangle to triangle.

        @return its points in the plane, the triangles, and the sides that it crosses; None if it
                leaves the patch
        """
        path, visited, crossed = [self.place(t, p)], [t], []
        left, entered = length, None
        while True:
            u = self.triangles[t][1]
            best = None
            for i in range(3):
                a, side = u[i], minus(u[(i + 1) % 3], u[i])
                falling = cross(side, direction)
                if i == entered or falling >= -TINY:
                    continue
                step = -cross(side, minus(p, a)) / falling
                if best is None or step < best[0]:
                    best = (max(step, 0.0), i)
            if best is None or best[0] >= left - TINY:
                p = (p[0] + left * direction[0], p[1] + left * direction[1])
                return path + [self.place(t, p)], visited, crossed
            step, i = best
            p = (p[0] + step * direction[0], p[1] + step * direction[1])
            path.append(self.place(t, p))
            left -= step
            if (t, i) not in self.mates:
                return None
            crossed.append((t, i))
            _, entered = self.mates[t, i]
            t, (p, direction) = self.cross_side(t, i, (p, direction))
            visited.append(t)

    def grid_points(self, shift):
        """Points whose parameters are integers plus `shift`: triangle, parameters, weights."""
        for t, (_, u) in enumerate(self.triangles):
            low = [math.floor(min(c[k] for c in u)) - 1 for k in range(2)]
            high = [math.ceil(max(c[k] for c in u)) + 1 for k in range(2)]
            for x in range(low[0], high[0] + 1):
                for y in range(low[1], high[1] + 1):
                    weights = self.weights(t, (x + shift, y + shift))
                    if min(weights) > -TINY:
                        yield t, (x + shift, y + shift), weights

    def propellers(self, at):
        """Directions along the grid from a point of the plane: triangle, parameters, direction."""
        found = {}
        for t, p, _ in self.grid_points(0):
            if math.dist(self.place(t, p), at) > 1e-6:
                continue
            for d in DIRECTIONS:
                near = (p[0] + 1e-6 * d[0], p[1] + 1e-6 * d[1])
                if min(self.weights(t, near)) > -1e-12:
                    x, y = minus(self.place(t, near), at)
                    found.setdefault(round(math.atan2(y, x), 3), (t, p, d))
        return [found[angle] for angle in sorted(found)]


def cross(a, b):
    return a[0] * b[1] - a[1] * b[0]


class Panel:
    """Where the patch, or its chart, stands in the figure."""

    def __init__(self, figure, column, points):
        low = [min(p[k] for p in points) for k in range(2)]
        high = [max(p[k] for p in points) for k in range(2)]
        self.figure, self.column = figure, column
        self.scale = (PANEL - 2 * MARGIN) / max(high[0] - low[0], high[1] - low[1])
        self.middle = [(low[k] + high[k]) / 2 for k in range(2)]

    def __call__(self, p):
        return (PANEL * (self.column + 0.5) + self.scale * (p[0] - self.middle[0]),
                PANEL / 2 - self.scale * (p[1] - self.middle[1]))

    def title(self, *lines):
        for i, words in enumerate(lines):
            self.figure.text((PANEL * (self.column + 0.5), PANEL + 14 + 17 * i), words, 13)

    def triangles(self, patch, fill=PALE, stroke=LINE, chosen=()):
        for t, (v, _) in enumerate(patch.triangles):
            self.figure.polygon([self(patch.points[i]) for i in v],
                                "#ffe2b8" if t in chosen else fill, stroke, 0.8)

    def grid(self, patch, width=1.0, color=BLUE):
        for v, u in patch.triangles:
            for axis in range(2):
                for a, b in isolines([patch.points[i] for i in v], u, axis):
                    self.figure.line(self(a), self(b), color, width)

    def path(self, points, color, width):
        for a, b in zip(points, points[1:]):
            self.figure.line(self(a), self(b), color, width)


def lattice_points(patch):
    """Points of the plane, each with the number of corners of its generator."""
    found = {}
    for t, p, weights in patch.grid_points(0):
        at = patch.place(t, p)
        found[round(at[0], 6), round(at[1], 6)] = (at, sum(w > 1e-7 for w in weights))
    return list(found.values())


def draw_propeller_engine(patch):
    figure = Figure(4 * PANEL, PANEL + 48)
    panels = [Panel(figure, i, patch.points) for i in range(4)]
    points = lattice_points(patch)

    panels[0].triangles(patch)
    for at, corners in points:
        figure.dot(panels[0](at), 4.2, {1: RED, 2: GREEN, 3: BLUE}[corners])
    panels[0].title("lattice points, by generator:",
                    '<tspan fill="#d64545">vertex</tspan>, <tspan fill="#3d9a50">edge</tspan> or '
                    '<tspan fill="#3f73b5">triangle</tspan>')

    panels[1].triangles(patch)
    for at, _ in points:
        ends = []
        for t, p, d in patch.propellers(at):
            traced = patch.trace(t, p, d, 0.3)
            if traced is not None:
                ends.append((traced[0], patch.trace(t, p, d) is not None))
        for path, _ in ends:
            panels[1].path(path[:-1], BLUE, 1.6)
            figure.arrow(panels[1](path[-2]), panels[1](path[-1]), BLUE, 1.6)
        figure.dot(panels[1](at), 3, INK, "none")
    panels[1].title("propellers: the hex edges that leave", "each vertex, found once per generator")

    traces = [patch.trace(t, p, d) for at, corners in points if corners == 3
              for t, p, d in patch.propellers(at)]
    longest = max((trace for trace in traces if trace is not None),
                  key=lambda one: len(one[1]) + math.dist(one[0][0], one[0][-1]))
    panels[2].triangles(patch, chosen=longest[1])
    for at, _ in points:
        figure.dot(panels[2](at), 2.4, LINE, "none")
    panels[2].path(longest[0][:-1], RED, 2.4)
    figure.arrow(panels[2](longest[0][-2]), panels[2](longest[0][-1]), RED, 2.4)
    figure.dot(panels[2](longest[0][0]), 4.2, INK)
    figure.dot(panels[2](longest[0][-1]), 4.2, INK)
    panels[2].title("each propeller is traced once,", "tet by tet, to its opposite")

    panels[3].triangles(patch, fill="#dce7f4", stroke="#dce7f4")
    panels[3].grid(patch, 1.8)
    for at, _ in points:
        figure.dot(panels[3](at), 3, INK, "none")
    panels[3].title("the corners between propellers", "join to cells")
    return figure.finish()


def cells_of(patch):
    """Corners in the plane of each cell, and the half diagonals that cross a cut."""
    found = {}
    for t, p, _ in patch.grid_points(0.5):
        length = math.sqrt(0.5)
        traces = [patch.trace(t, p, (d[0] / length, d[1] / length), length) for d in DIAGONALS]
        if None in traces:
            continue
        behind = [path for path, _, crossed in traces
                  if any(patch.is_cut(*side) for side in crossed)]
        at = patch.place(t, p)
        found[round(at[0], 6), round(at[1], 6)] = ([trace[0][-1] for trace in traces], behind)
    return list(found.values())


def draw_atlas_engine(patch):
    figure = Figure(3 * PANEL, PANEL + 48)
    cuts = [(t, i) for t in range(len(patch.triangles)) for i in range(3) if patch.is_cut(t, i)]

    panel = Panel(figure, 0, patch.points)
    panel.triangles(patch)
    for t, i in cuts:
        v = patch.triangles[t][0]
        figure.line(panel(patch.points[v[i]]), panel(patch.points[v[(i + 1) % 3]]), RED, 3)
    panel.title("the map: triangles join to one chart;",
                '<tspan fill="#d64545">cuts</tspan> are where the transition turns')

    panel = Panel(figure, 1, [corner for _, u in patch.triangles for corner in u])
    for _, u in patch.triangles:
        figure.polygon([panel(corner) for corner in u], PALE, LINE, 0.8)
    for t, i in cuts:
        u = patch.triangles[t][1]
        figure.line(panel(u[i]), panel(u[(i + 1) % 3]), RED, 3)
    for p in {p for _, p, _ in patch.grid_points(0)}:
        figure.dot(panel(p), 3.4, BLUE, "none")
    panel.title("its chart: neighbouring lattice", "points stand side by side")

    panel = Panel(figure, 2, patch.points)
    panel.triangles(patch, fill="#f6f8fb", stroke="#dde4ed")
    cells = cells_of(patch)
    for corners, behind in cells:
        figure.polygon([panel(p) for p in corners], "#f6c98f" if behind else "#cfe0f3", "#5b7390",
                       1.2)
    for t, i in cuts:
        v = patch.triangles[t][0]
        figure.line(panel(patch.points[v[i]]), panel(patch.points[v[(i + 1) % 3]]), RED, 3)
    for _, behind in cells:
        for path in behind:
            panel.path(path, INK, 1.4)
            figure.dot(panel(path[-1]), 3, INK, "none")
    panel.title("cells: read off the chart, and", "walked to behind cuts (orange)")
    return figure.finish()


def main():
    command, folder = sys.argv[1], Path(sys.argv[2])
    with tempfile.TemporaryDirectory() as temporary:
        file = Path(temporary) / "map.hexex"
        subprocess.run([command, "generate", "star", "--valence", "3", "--cells", "3", "--refine",
                        "3", "--jitter", "0.5", "-o", file, "--quiet"], check=True)
        patch = Patch(*read_map(file))
    (folder / "engine-propeller.svg").write_text(draw_propeller_engine(patch) + "\n")
    (folder / "engine-atlas.svg").write_text(draw_atlas_engine(patch) + "\n")


main()
