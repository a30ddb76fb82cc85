"""Judges a hex mesh of a part by its file alone: exact positivity, distances both ways, followed edges. Nothing here is
hexhex's."""
import math
from dataclasses import dataclass
from itertools import product

import boundaries
import numpy as np

CORNERS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
HALVINGS = 12  # of a cell that is not decided before
NEAR = 5e-3  # of the diagonal: a sharp edge is followed where one of the mesh is as near
STEP = 1 / 400  # of the diagonal, between points of sharp edges


@dataclass
class Verdict:
    cells: int
    bad: int  # cells that are not positive everywhere, or not decided
    minimum: float  # scaled Jacobian at corners
    to_surface: float
    from_surface: float
    followed: float  # share of the length of sharp edges; 1 without any

    def good(self):
        return bool(self.bad == 0 and self.minimum >= 0.2 and max(self.to_surface, self.from_surface) <= NEAR)


def integers(points):
    """The same points times a power of two, as Python's integers."""
    ratios = [x.as_integer_ratio() for x in points.ravel().tolist()]
    common = max(below for _, below in ratios)  # all of them are powers of two
    return np.array([above * (common // below) for above, below in ratios], dtype=object).reshape(points.shape)


def determinant(a, b, c):
    return (a[..., 0] * (b[..., 1] * c[..., 2] - b[..., 2] * c[..., 1])
            - a[..., 1] * (b[..., 0] * c[..., 2] - b[..., 2] * c[..., 0])
            + a[..., 2] * (b[..., 0] * c[..., 1] - b[..., 1] * c[..., 0]))


def bezier(cells):
    """Coefficients of the Jacobian determinants of trilinear cells, 3 x 3 x 3 each, times 8: products of derivatives,
    the first of degree (0, 1, 1), the second (1, 0, 1), the third (1, 1, 0)."""
    at = {tuple(corner): cells[:, i] for i, corner in enumerate(CORNERS)}
    total = np.full((len(cells), 3, 3, 3), 0, dtype=object)
    for j1, k1, i2, k2, i3, j3 in product((0, 1), repeat=6):
        value = determinant(at[1, j1, k1] - at[0, j1, k1], at[i2, 1, k2] - at[i2, 0, k2], at[i3, j3, 1] - at[i3, j3, 0])
        total[:, i2 + i3, j1 + j3, k1 + k2] += value
    # Bernstein polynomials of degree 2 have the factor 2 in their middle: 8 / that of three directions.
    factor = [2, 1, 2]
    for i, j, k in product(range(3), repeat=3):
        total[:, i, j, k] *= factor[i] * factor[j] * factor[k]
    return total


def halves(coefficients, axis):
    """Those of both halves, times 4."""
    a, b, c = np.moveaxis(coefficients, axis, 0)
    middle = a + 2 * b + c
    return [np.stack(half, axis=axis) for half in ((4 * a, 2 * (a + b), middle), (middle, 2 * (b + c), 4 * c))]


def positive_everywhere(coefficients, halvings=HALVINGS):
    """True only if proven: all coefficients of some division are positive."""
    if (coefficients > 0).all():
        return True
    if halvings == 0 or not (coefficients[::2, ::2, ::2] > 0).all():  # those are values at corners
        return False
    return all(positive_everywhere(half, halvings - 1) for half in halves(coefficients, halvings % 3))


def bad_cells(points, cells):
    coefficients = bezier(integers(points)[cells])
    doubtful = np.flatnonzero(~(coefficients > 0).all(axis=(1, 2, 3)))
    return sum(not positive_everywhere(coefficients[cell]) for cell in doubtful)


def least_scaled_jacobian(points, cells):
    least = 1.0
    for i, corner in enumerate(CORNERS):
        edges = []
        for axis in range(3):
            other = corner.copy()
            other[axis] = 1 - other[axis]
            j = int(np.flatnonzero((CORNERS == other).all(axis=1))[0])
            edge = (points[cells[:, j]] - points[cells[:, i]]) * (1 - 2 * corner[axis])
            edges.append(edge / np.linalg.norm(edge, axis=1, keepdims=True))
        least = min(least, float(np.linalg.det(np.stack(edges, axis=1)).min()))
    return least


def sharp_edges(faces, points, angle):
    """Pairs of points of edges where the normals of two faces differ by more than an angle in degrees."""
    corners = points[faces]
    normals = np.cross(corners[:, 2] - corners[:, 0], corners[:, -1] - corners[:, 1])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    edges = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    owner = np.repeat(np.arange(len(faces)), faces.shape[1])
    order = np.lexsort(edges.T)
    edges, owner = edges[order], owner[order]
    pairs = np.flatnonzero((edges[1:] == edges[:-1]).all(axis=1))
    cosines = np.einsum("ij,ij->i", normals[owner[pairs]], normals[owner[pairs + 1]])
    return points[edges[pairs[cosines < math.cos(math.radians(angle))]]]


def pieces_along(edges, step):
    """Middles of pieces of edges, and their lengths."""
    lengths = np.linalg.norm(edges[:, 1] - edges[:, 0], axis=1)
    counts = np.maximum(1, np.ceil(lengths / step).astype(int))
    which = np.repeat(np.arange(len(edges)), counts)
    place = (np.concatenate([np.arange(n) for n in counts]) + 0.5) / counts[which]
    return edges[which, 0] + place[:, None] * (edges[which, 1] - edges[which, 0]), (lengths / counts)[which]


def followed_share(wanted, found, diagonal):
    if len(wanted) == 0:
        return 1.0
    if len(found) == 0:
        return 0.0
    points, lengths = pieces_along(wanted, STEP * diagonal)
    near = boundaries.cKDTree(pieces_along(found, STEP * diagonal)[0]).query(points)[0] <= NEAR * diagonal
    return float(lengths[near].sum() / lengths.sum())


def judge(mesh, points, tets, angle=40):
    """The verdict on a .mesh file, made of these tets; edges of the tets sharper than the angle should be followed."""
    vertices, cells = boundaries.read_medit(mesh)
    surface = boundaries.on_one_side(tets[:, boundaries.SIDES].reshape(-1, 3))
    quads = boundaries.on_one_side(cells[:, boundaries.FACES].reshape(-1, 4))
    diagonal = float(np.linalg.norm(np.ptp(points[surface].reshape(-1, 3), axis=0)))
    away = boundaries.distances(boundaries.hex_boundary(vertices, cells), points[surface])
    # Half the angle will do for the mesh: its quads are larger than the triangles.
    followed = followed_share(sharp_edges(surface, points, angle), sharp_edges(quads, vertices, angle / 2), diagonal)
    return Verdict(len(cells), bad_cells(vertices, cells), least_scaled_jacobian(vertices, cells), *away, followed)
