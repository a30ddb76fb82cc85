"""How far two surfaces of triangles are from each other, by points on both: nothing is taken from hexhex but what it wrote."""
import numpy as np
from scipy.spatial import cKDTree

FACES = np.array([[0, 4, 7, 3], [1, 2, 6, 5], [0, 1, 5, 4], [3, 7, 6, 2], [0, 3, 2, 1], [4, 5, 6, 7]])
SIDES = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])
SPACING = 1 / 200  # of points, in diagonals
CANDIDATES = 16  # so many pieces of triangles, the nearest by their centres, are tried
PARTS = 2  # of a quad, which is bilinear, along each side


def read_medit(file):
    """Vertices and hexahedra of a .mesh file."""
    words = iter(file.read_text().split())
    points = cells = None
    for word in words:
        if word == "Vertices":
            points = np.array([[float(next(words)) for _ in range(4)] for _ in range(int(next(words)))])[:, :3]
        elif word == "Hexahedra":
            cells = np.array([[int(next(words)) for _ in range(9)] for _ in range(int(next(words)))])[:, :8] - 1
    return points, cells


def read_tets(file):
    """Points and tets of a .hexex file, without its map."""
    with open(file, encoding="ascii") as lines:
        points = np.array([next(lines).split()[:3] for _ in range(int(next(lines)))], dtype=float)
        tets = np.array([next(lines).split()[:4] for _ in range(int(next(lines)))], dtype=int)
    return points, tets


def on_one_side(faces):
    """Those that occur once."""
    _, first, counts = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    return faces[first[counts == 1]]


def tet_boundary(points, tets):
    return points[on_one_side(tets[:, SIDES].reshape(-1, 3))]


def hex_boundary(points, cells):
    quads = points[on_one_side(cells[:, FACES].reshape(-1, 4))]
    u, v = (grid.ravel() for grid in np.meshgrid(*2 * [np.linspace(0, 1, PARTS + 1)], indexing="ij"))
    weights = np.stack([(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v], axis=1)
    lattice = np.einsum("pc,qcx->qpx", weights, quads)
    first = np.array([i * (PARTS + 1) + j for i in range(PARTS) for j in range(PARTS)])[:, None]
    row = PARTS + 1
    corners = np.concatenate([first + [[0, row, row + 1]], first + [[0, row + 1, 1]]])
    return lattice[:, corners].reshape(-1, 3, 3)


def divided(triangles, spacing):
    """Corners of pieces that triangles are divided into, centres of these, and the triangle of each."""
    sides = np.linalg.norm(triangles - np.roll(triangles, 1, axis=1), axis=2).max(axis=1)
    divisions = np.maximum(1, np.ceil(sides / spacing).astype(int))
    corners, centres, owners = [], [], []
    for n in np.unique(divisions):
        which = np.flatnonzero(divisions == n)

        def at(places):
            u, v = np.array(places).T / n
            return np.einsum("wc,tcx->twx", np.stack([u, v, 1 - u - v], axis=1), triangles[which]).reshape(-1, 3)

        corners.append(at([(i, j) for i in range(n + 1) for j in range(n + 1 - i)]))
        pieces = [(i + third, j + third) for third in (1 / 3, 2 / 3) for i in range(n) for j in range(n - i)
                  if i + j + 2 * third < n]
        centres.append(at(pieces))
        owners.append(np.repeat(which, len(pieces)))
    return np.concatenate(corners), np.concatenate(centres), np.concatenate(owners)


def to_segment(points, a, b):
    edge = b - a
    share = np.einsum("px,px->p", points - a, edge) / np.maximum(np.einsum("px,px->p", edge, edge), 1e-300)
    return np.linalg.norm(points - a - np.clip(share, 0, 1)[:, None] * edge, axis=1)


def to_triangle(points, triangles):
    """Of each point to the triangle of the same number."""
    a, b, c = (triangles[:, i] for i in range(3))
    least = np.minimum(np.minimum(to_segment(points, a, b), to_segment(points, b, c)), to_segment(points, c, a))
    normal = np.cross(b - a, c - a)
    square = np.einsum("px,px->p", normal, normal)
    inside = square > 0
    for p, q in ((a, b), (b, c), (c, a)):
        inside &= np.einsum("px,px->p", np.cross(q - p, points - p), normal) >= 0
    height = np.abs(np.einsum("px,px->p", points - a, normal)) / np.sqrt(np.maximum(square, 1e-300))
    return np.where(inside, height, least)


def to_pieces(points, pieces):
    """Of each point to a surface, which comes with what divided() makes of it."""
    triangles, _, centres, owners = pieces
    _, near = cKDTree(centres).query(points, k=min(CANDIDATES, len(centres)))
    columns = near.reshape(len(points), -1).T
    return np.min([to_triangle(points, triangles[owners[column]]) for column in columns], axis=0)


def distances(first, second):
    """The largest from points on the first surface to the second, and the other way round, in diagonals of the second."""
    diagonal = np.linalg.norm(np.ptp(second.reshape(-1, 3), axis=0))
    pieces = [(surface, *divided(surface, SPACING * diagonal)) for surface in (first, second)]

    def largest(start, end):
        return float(to_pieces(np.unique(start[1], axis=0), end).max()) / diagonal

    return largest(*pieces), largest(*reversed(pieces))
