#!/usr/bin/env python3
"""Writes examples/bracket.mesh, the tets of a bearing bracket: a plate with two bolt holes, and an eye with a bore on it.

    docs/images/bracket.py examples/bracket.mesh
"""

import math
import sys
from pathlib import Path

BORE, EYE, HEIGHT = 0.62, 1.15, 1.45  # radii of the eye, and how high its axis is over the plate
HALF_DEPTH = 0.5  # of the eye
PLATE = (2.75, 1.25, 0.45)  # half length, half depth, thickness
BOLT = 0.42  # radius of the holes
CELL = 0.25  # about so long are edges of hexahedra


def arc(radius, begin, end, center=(0.0, 0.0)):
    """A curve over [0, 1]; angles in degrees."""
    def at(s):
        angle = math.radians(begin + s * (end - begin))
        return (center[0] + radius * math.cos(angle), center[1] + radius * math.sin(angle))
    return at


def segment(a, b):
    return lambda s: tuple(x + s * (y - x) for x, y in zip(a, b))


def ruled(inner, outer, lift):
    """A block between two curves of a plane, which lift(x, y, s) moves along the third axis."""
    def at(u, v, w):
        a, b = inner(u), outer(u)
        return lift(a[0] + v * (b[0] - a[0]), a[1] + v * (b[1] - a[1]), w)
    return at


def cells(length):
    return max(1, round(length / CELL / 2)) * 2  # even: a tet spans two


def side_of_eye():
    """From the plate along the straight side and on along the arc, up to 45 degrees."""
    straight, bend = HEIGHT, EYE * math.pi / 4
    curve = arc(EYE, 0, 45, (0.0, HEIGHT))

    def at(s):
        length = s * (straight + bend)
        return (EYE, length) if length <= straight else curve((length - straight) / bend)
    return at


def mirrored(curve):
    return lambda s: (-curve(1 - s)[0], curve(1 - s)[1])


def eye():
    """Four blocks around the bore, in the plane of x and z."""
    def lift(x, z, s):
        return (x, HALF_DEPTH * (2 * s - 1), z)
    center = (0.0, HEIGHT)
    deep, radial = cells(2 * HALF_DEPTH), cells(EYE - BORE)
    side, bottom = cells(HEIGHT + EYE * math.pi / 4), cells(2 * EYE)
    yield ruled(arc(BORE, -45, 45, center), side_of_eye(), lift), (side, radial, deep)
    yield ruled(arc(BORE, 45, 135, center), arc(EYE, 45, 135, center), lift), (bottom, radial, deep)
    yield ruled(arc(BORE, 135, 225, center), mirrored(side_of_eye()), lift), (side, radial, deep)
    yield (ruled(arc(BORE, 225, 315, center), segment((-EYE, 0), (EYE, 0)), lift),
           (bottom, radial, deep))


def plate():
    """Boxes below the eye, and on either side four blocks around a hole."""
    length, depth, thick = PLATE
    def up(x, y, s):
        return (x, y, thick * (s - 1))
    def down(x, y, s):
        return (x, y, -thick * s)
    layers = (-depth, -HALF_DEPTH, HALF_DEPTH, depth)
    along, high = [cells(b - a) for a, b in zip(layers, layers[1:])], cells(thick)
    for (a, b), n in zip(zip(layers, layers[1:]), along):
        yield (ruled(segment((-EYE, a), (EYE, a)), segment((-EYE, b), (EYE, b)), up),
               (cells(2 * EYE), n, high))
    for sign in (-1, 1):
        left, right = sorted((sign * EYE, sign * length))
        center = ((left + right) / 2, 0.0)
        corners = ((right, -depth), (right, depth), (left, depth), (left, -depth))
        for k in range(4):
            # Where the boxes are, points lie as theirs do.
            a, b = corners[k], corners[(k + 1) % 4]
            joins = a[0] == b[0] == sign * EYE
            edge = through_layers(a, b, layers, along) if joins else segment(a, b)
            around = sum(along) if k % 2 == 0 else cells(right - left)
            yield (ruled(arc(BOLT, 90 * k - 45, 90 * k + 45, center), edge, down),
                   (around, cells(depth - BOLT), high))


def through_layers(a, b, layers, along):
    """A segment on which points are as dense as in the layers."""
    places = [layers[0]]
    for (low, high), n in zip(zip(layers, layers[1:]), along):
        places += [low + (high - low) * (i + 1) / n for i in range(n)]
    if a[1] > b[1]:
        places.reverse()

    def at(s):
        i = min(int(s * (len(places) - 1)), len(places) - 2)
        rest = s * (len(places) - 1) - i
        return (a[0], places[i] + rest * (places[i + 1] - places[i]))
    return at


class Bracket:
    """Points and tets."""

    def __init__(self):
        self.points, self.tets, self.number = [], [], {}
        for at, counts in [*eye(), *plate()]:
            self.add_block(at, counts)

    def vertex(self, point):
        key = tuple(round(x * 1e6) for x in point)
        if key not in self.number:
            self.number[key] = len(self.points)
            self.points.append(point)
        return self.number[key]

    def add_block(self, at, counts):
        """Twelve tets for two by two by two hexahedra: around its centre, two for each face."""
        def corner(i, j, k):
            return self.vertex(at(i / counts[0], j / counts[1], k / counts[2]))
        for i in range(0, counts[0], 2):
            for j in range(0, counts[1], 2):
                for k in range(0, counts[2], 2):
                    box = [corner(i + 2 * a, j + 2 * b, k + 2 * c)
                           for c in (0, 1) for b in (0, 1) for a in (0, 1)]
                    self.add_box(box, corner(i + 1, j + 1, k + 1))

    def add_box(self, box, center):
        for face in ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4),
                     (1, 5, 7, 3)):
            quad = [box[i] for i in face]
            # The diagonal from the smallest number is the same for both neighbours.
            first = quad.index(min(quad))
            quad = quad[first:] + quad[:first]
            self.tets += [[center, quad[0], quad[2], quad[1]], [center, quad[0], quad[3], quad[2]]]

    def write(self, name):
        """As Medit's text."""
        lines = ["MeshVersionFormatted 2", "Dimension 3", "Vertices", str(len(self.points))]
        lines += [" ".join(f"{x:.6g}" for x in point) + " 0" for point in self.points]
        lines += ["Tetrahedra", str(len(self.tets))]
        lines += [" ".join(str(v + 1) for v in tet) + " 0" for tet in self.tets]
        name.write_text("\n".join([*lines, "End"]) + "\n", encoding="ascii")


if __name__ == "__main__":
    Bracket().write(Path(sys.argv[1]))
