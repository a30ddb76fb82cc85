#!/usr/bin/env python3
"""Draws docs/images/rasterizer.svg (candidates for lattice points in a tet) and parts.svg (what is in the file of a
part), both in the plane.

    docs/images/draw_schemes.py FOLDER
"""
import math
import sys
from fractions import Fraction
from pathlib import Path

from figure import Figure

INK, PALE, LINE = "#22344d", "#eef2f8", "#aab6c6"
RED, BLUE, GREEN, ORANGE = "#d64545", "#3f73b5", "#3d9a50", "#e8963a"
STEP = 40


def at(x, y, height):
    return 30 + STEP * float(x), 30 + STEP * (height - float(y))


def side(a, b, p):
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])


def legend(figure, rows, left, top):
    for i, (draw, words) in enumerate(rows):
        y = top + 30 * i
        draw((left, y))
        figure.text((left + 24, y + 5), words, 14, "start")


def rasterizer():
    """Lines of lattice points through a triangle: an interval in doubles, a little too long, whose points are tested
    exactly."""
    corners = [(Fraction(3, 5), Fraction(7, 10)), (Fraction(39, 5), Fraction(2)), (Fraction(12, 5), Fraction(27, 5))]
    width, height, more = 9, 6, 0.35
    figure = Figure(30 + STEP * (width + 9), 60 + STEP * height)
    figure.polygon([at(*c, height) for c in corners], PALE, INK, 1.5)
    for y in range(height + 1):
        ends = []
        for a, b in zip(corners, corners[1:] + corners[:1]):
            if min(a[1], b[1]) <= y <= max(a[1], b[1]):
                ends.append(a[0] + (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]))
        low, high = (float(min(ends)) - more, float(max(ends)) + more) if ends else (1, 0)
        if ends:
            figure.line(at(low, y, height), at(high, y, height), ORANGE, 5)
        for x in range(width + 1):
            is_inside = all(side(a, b, (x, y)) >= 0 for a, b in zip(corners, corners[1:] + corners[:1]))
            is_candidate = bool(ends) and math.ceil(low) <= x <= math.floor(high)
            assert is_candidate or not is_inside
            fill = BLUE if is_inside else RED if is_candidate else "white"
            figure.dot(at(x, y, height), 5 if is_candidate else 3, fill, LINE if fill == "white" else "white")
    left = 30 + STEP * (width + 1)
    legend(figure, [(lambda p: figure.line((p[0] - 9, p[1]), (p[0] + 9, p[1]), ORANGE, 5), "interval in doubles, enlarged"),
                    (lambda p: figure.dot(p, 5, BLUE), "inside; the ends of each line are tested exactly"),
                    (lambda p: figure.dot(p, 5, RED), "candidate that the exact test rejects"),
                    (lambda p: figure.dot(p, 3, "white", LINE), "never looked at")], left, 100)
    return figure.finish()


def parts():
    """Nine by six cells in three parts, and what part 1 holds: its cells, a layer of ghosts, and vertices with owners."""
    width, height = 9, 6

    def part(x, y):
        return 0 if x < 4 else 1 if y < 3 else 2

    figure = Figure(30 + STEP * (width + 9), 60 + STEP * height)
    colours = (GREEN, BLUE, ORANGE)
    own = {(x, y) for x in range(width) for y in range(height) if part(x, y) == 1}
    near = {(x + i, y + j) for x, y in own for i in (0, 1) for j in (0, 1)}
    for x in range(width):
        for y in range(height):
            corners = [(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)]
            is_ghost = (x, y) not in own and any(c in near for c in corners)
            opacity = 0.55 if (x, y) in own else 0.25 if is_ghost else 0.04
            figure.polygon([at(*c, height) for c in corners], colours[part(x, y)], LINE, 1, opacity)
    for x, y in sorted({c for x, y in own for c in ((x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1))}):
        around = [part(x + i, y + j) for i in (-1, 0) for j in (-1, 0) if 0 <= x + i < width and 0 <= y + j < height]
        figure.dot(at(x, y, height), 6, colours[min(around)])
    for words, x, y in (("part 0", 2, 3), ("part 1", 6.5, 1.5), ("part 2", 6.5, 4.5)):
        figure.text(at(x, y - 0.12, height), words, 15)
    left = 30 + STEP * (width + 1)

    def boxes(*shades):
        def draw(p):
            for i, (colour, opacity) in enumerate(shades):
                low, high = p[0] - 9 + 18 * i / len(shades), p[0] - 9 + 18 * (i + 1) / len(shades)
                figure.polygon([(low, p[1] - 9), (high, p[1] - 9), (high, p[1] + 9), (low, p[1] + 9)], colour, LINE, 1, opacity)
        return draw

    legend(figure, [(boxes((BLUE, 0.55)), "cells of part 1"),
                    (boxes((GREEN, 0.25), (ORANGE, 0.25)), "a layer of ghosts, of parts 0 and 2"),
                    (lambda p: figure.dot(p, 6, BLUE), "vertex owned by part 1"),
                    (lambda p: figure.dot(p, 6, GREEN), "shared, owned by part 0, the smallest")], left, 100)
    return figure.finish()


def main():
    folder = Path(sys.argv[1])
    (folder / "rasterizer.svg").write_text(rasterizer() + "\n")
    (folder / "parts.svg").write_text(parts() + "\n")


main()
