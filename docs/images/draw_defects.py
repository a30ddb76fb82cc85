#!/usr/bin/env python3
"""Draws one side of two maps in their parameters, side by side: draw_defects.py A.hexex B.hexex"""
import sys


def read(name):
    with open(name, encoding="ascii") as file:
        lines = file.read().split("\n")
    points = int(lines[0])
    tets = []
    for line in lines[points + 2:points + 2 + int(lines[points + 1])]:
        words = line.split()
        u = [float(word) for word in words[4:16]]
        tets.append(([int(word) for word in words[:4]], [u[i:i + 3] for i in range(0, 12, 3)]))
    return tets


def side(tets):
    """Boundary triangles in the plane u = 0, with their orientation."""
    count = {}
    for vertices, _ in tets:
        for c in range(4):
            face = tuple(sorted(vertices[:c] + vertices[c + 1:]))
            count[face] = count.get(face, 0) + 1
    corners = [(1, 3, 2), (0, 2, 3), (0, 3, 1), (0, 1, 2)]
    for vertices, u in tets:
        for c, order in enumerate(corners):
            face = tuple(sorted(vertices[:c] + vertices[c + 1:]))
            if count[face] == 1 and all(u[i][0] == 0 for i in order):
                triangle = [(u[i][1], u[i][2]) for i in order]
                (a, b), (c2, d), (e, f) = triangle
                yield triangle, (c2 - a) * (f - b) - (d - b) * (e - a) <= 0


def main():
    size, gap = 360, 40
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{2 * size + 3 * gap}" '
           f'height="{size + 2 * gap}">', '<rect width="100%" height="100%" fill="white"/>']
    for column, name in enumerate(sys.argv[1:3]):
        triangles = sorted(side(read(name)), key=lambda entry: entry[1])
        extent = max(max(max(p) for p in t) for t, _ in triangles)
        left = gap + column * (size + gap)
        for triangle, bad in triangles:
            text = " ".join(f"{left + x / extent * size:.1f},{gap + size - y / extent * size:.1f}"
                            for x, y in triangle)
            fill = "#d62728" if bad else "#e8eef7"
            out.append(f'<polygon points="{text}" fill="{fill}" '
                       f'fill-opacity="{0.6 if bad else 1}" stroke="#345" stroke-width="0.8"/>')
    print("\n".join(out + ["</svg>"]))


main()
