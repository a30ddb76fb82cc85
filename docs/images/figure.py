"""What the scripts that draw figures share: reading maps and meshes, and SVG."""

import contextlib
import math


def minus(a, b):
    return tuple(x - y for x, y in zip(a, b))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def read_map(name):
    """Points, and for each tet its vertices and the parameters of its corners, of a .hexex file."""
    with open(name, encoding="ascii") as file:
        lines = file.read().split("\n")
    count = int(lines[0])
    points = [tuple(map(float, line.split())) for line in lines[1:count + 1]]
    tets = []
    for line in lines[count + 2:count + 2 + int(lines[count + 1])]:
        words = line.split()
        u = [float(word) for word in words[4:16]]
        tets.append(([int(word) for word in words[:4]],
                     [tuple(u[i:i + 3]) for i in range(0, 12, 3)]))
    return points, tets


def read_medit(name, kind):
    """Points and cells of a .mesh file; the kind is Tetrahedra or Hexahedra."""
    with open(name, encoding="ascii") as file:
        words = file.read().split()
    at = words.index("Vertices") + 2
    count = int(words[at - 1])
    points = [tuple(map(float, words[at + 4 * i:at + 4 * i + 3])) for i in range(count)]
    at, corners = words.index(kind) + 2, 4 if kind == "Tetrahedra" else 8
    count = int(words[at - 1])
    cells = [[int(word) - 1 for word in words[at + (corners + 1) * i:at + (corners + 1) * i + corners]] for i in range(count)]
    return points, cells


def boundary_triangles(tets):
    """Triangles of just one of the tets, counter-clockwise from outside, with their parameters."""
    found = {}
    for vertices, u in tets:
        for order in ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1)):
            triangle = [vertices[i] for i in order]
            found.setdefault(tuple(sorted(triangle)), []).append((triangle, [u[i] for i in order]))
    return [same[0] for same in found.values() if len(same) == 1]


def isolines(corners, parameters, axis):
    """Segments in a triangle on which one of the parameters is an integer."""
    values = [u[axis] for u in parameters]
    for level in range(math.ceil(min(values)), math.floor(max(values)) + 1):
        ends = [corners[i] for i in range(3) if values[i] == level]
        for i in range(3):
            a, b = values[i] - level, values[(i + 1) % 3] - level
            if a * b < 0:
                p, q = corners[i], corners[(i + 1) % 3]
                ends.append(tuple(x + a / (a - b) * (y - x) for x, y in zip(p, q)))
        if len(ends) == 2:
            yield ends[0], ends[1]


class Figure:
    """An SVG picture in the making. Points are (x, y), y downwards."""

    def __init__(self, width, height):
        self.lines = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
                      f'width="{width}" height="{height}" font-family="Helvetica, Arial, '
                      'sans-serif" stroke-linejoin="round" stroke-linecap="round">',
                      '<rect width="100%" height="100%" fill="white"/>']

    def polygon(self, points, fill, stroke="none", width=1.0, opacity=1.0):
        text = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        shine = f' fill-opacity="{opacity}"' if opacity < 1 else ""
        self.lines.append(f'<polygon points="{text}" fill="{fill}" stroke="{stroke}" '
                          f'stroke-width="{width}"{shine}/>')

    def line(self, a, b, stroke, width, dash=""):
        dashes = f' stroke-dasharray="{dash}"' if dash else ""
        self.lines.append(f'<line x1="{a[0]:.1f}" y1="{a[1]:.1f}" x2="{b[0]:.1f}" '
                          f'y2="{b[1]:.1f}" stroke="{stroke}" stroke-width="{width}"{dashes}/>')

    @contextlib.contextmanager
    def outlined(self, stroke, width):
        """What is filled meanwhile has this outline."""
        self.lines.append(f'<g stroke="{stroke}" stroke-width="{width}">')
        yield
        self.lines.append("</g>")

    def fill(self, points, fill):
        text = "L".join(f"{x:.1f} {y:.1f}" for x, y in points)
        self.lines.append(f'<path d="M{text}z" fill="{fill}"/>')

    def dot(self, at, radius, fill, stroke="white", width=1.0):
        self.lines.append(f'<circle cx="{at[0]:.1f}" cy="{at[1]:.1f}" r="{radius}" fill="{fill}" '
                          f'stroke="{stroke}" stroke-width="{width}"/>')

    def text(self, at, words, size, anchor="middle", fill="#22344d"):
        self.lines.append(f'<text x="{at[0]:.1f}" y="{at[1]:.1f}" font-size="{size}" '
                          f'text-anchor="{anchor}" fill="{fill}">{words}</text>')

    def arrow(self, a, b, stroke, width):
        """A line with a head at b."""
        self.line(a, b, stroke, width)
        x, y = minus(b, a)
        length = (x * x + y * y) ** 0.5
        x, y = 2.6 * width * x / length, 2.6 * width * y / length
        self.polygon([b, (b[0] - x + 0.6 * y, b[1] - y - 0.6 * x),
                      (b[0] - x - 0.6 * y, b[1] - y + 0.6 * x)], stroke, stroke, 1)

    def finish(self):
        return "\n".join([*self.lines, "</svg>"])
