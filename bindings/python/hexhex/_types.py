"""Maps, meshes, and reports."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _hexhex
from ._errors import ArgumentError

if TYPE_CHECKING:
    Floats = npt.NDArray[np.float64]
    Indices = npt.NDArray[np.uint32]

# Faces of a hexahedron in VTK's order, counter-clockwise seen from outside; its edges.
_FACES = np.array([[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [3, 7, 6, 2], [1, 2, 6, 5],
                   [0, 4, 7, 3]])
_EDGES = np.array([[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5],
                   [2, 6], [3, 7]])


def _floats(values: npt.ArrayLike, shape: tuple[int, ...], name: str) -> Floats:
    array = np.asarray(values)
    if array.ndim >= 1 and array.size == 12 * len(array) and shape == (4, 3):
        array = array.reshape(len(array), 4, 3)
    if array.shape[1:] != shape:
        raise ArgumentError(f"The array {name} has shape {array.shape}; it needs one of "
                            f"(n, {', '.join(map(str, shape))}).", "InvalidArgument")
    return np.ascontiguousarray(array, dtype=np.float64)


def _indices(values: npt.ArrayLike, width: int, name: str) -> Indices:
    array = np.asarray(values)
    if array.ndim != 2 or array.shape[1] != width:
        raise ArgumentError(f"The array {name} has shape {array.shape}; it needs one of "
                            f"(n, {width}).", "InvalidArgument")
    if array.dtype.kind not in "iu":
        raise ArgumentError(f"The array {name} has dtype {array.dtype}; it needs integers.",
                            "InvalidArgument")
    if array.dtype == np.int32 and array.flags.c_contiguous:
        return array.view(np.uint32)  # negative numbers become ones that are out of range
    if array.dtype != np.uint32 and array.size and not (
            0 <= int(array.min()) and int(array.max()) < 2**32):
        raise ArgumentError(f"The array {name} has numbers that are no indices.",
                            "InvalidArgument")
    return np.ascontiguousarray(array, dtype=np.uint32)


class Map:
    """A tetrahedral mesh with an integer-grid map.

    Attributes:
        points: positions, float64 of shape (n, 3).
        tets: vertices of each tet from 0, uint32 of shape (m, 4).
        igm: parameters (u, v, w) of the four corners of each tet, in units of one hexahedron,
            float64 of shape (m, 4, 3).

    Arrays of these types in C order are used without a copy, and so is ``tets`` as int32; others
    are converted. Do not change them while a function works on them.

    Raises:
        ArgumentError: shapes or types that do not fit.
    """

    def __init__(self, points: npt.ArrayLike, tets: npt.ArrayLike, igm: npt.ArrayLike) -> None:
        self.points: Floats = _floats(points, (3,), "points")
        self.tets: Indices = _indices(tets, 4, "tets")
        self.igm: Floats = _floats(igm, (4, 3), "igm")

    def __repr__(self) -> str:
        return f"<hexhex.Map: {len(self.tets)} tets, {len(self.points)} points>"


class Mesh:
    """A hexahedral mesh.

    ``Mesh(points, cells)`` copies arrays of one's own: float64 (n, 3) and integers (m, 8).
    """

    def __init__(self, points: npt.ArrayLike, cells: npt.ArrayLike) -> None:
        self._handle = _hexhex.Mesh(_floats(points, (3,), "points"), _indices(cells, 8, "cells"))
        self.statistics: dict[str, Any] = {}

    @classmethod
    def _from_handle(cls, handle: _hexhex.Mesh, statistics: dict[str, Any]) -> Mesh:
        mesh = cls.__new__(cls)
        mesh._handle = handle
        mesh.statistics = statistics
        return mesh

    def __repr__(self) -> str:
        return f"<hexhex.Mesh: {len(self.cells)} cells, {len(self.points)} points>"

    @property
    def points(self) -> Floats:
        """Positions, float64 of shape (n, 3). A view: what is written here is in the mesh."""
        return self._handle.points

    @property
    def cells(self) -> Indices:
        """Vertices of each cell in the order of VTK_HEXAHEDRON, uint32 of shape (m, 8). A view."""
        return self._handle.cells

    @property
    def generator_tet(self) -> Indices:
        """Per vertex a tet that contains its generator, uint32 of shape (n,); empty if unknown."""
        return self._handle.generator_tet

    @property
    def generator_corners(self) -> npt.NDArray[np.uint8]:
        """Per vertex its generator by corners of that tet: bit i for corner i, uint8 (n,)."""
        return self._handle.generator_corners

    @property
    def generator_kind(self) -> npt.NDArray[np.uint8]:
        """Per vertex the dimension of its generator: 0 vertex, 1 edge, 2 face, 3 tet; uint8 (n,)."""
        corners = self.generator_corners[:, None]
        kind: npt.NDArray[np.uint8] = np.unpackbits(corners, axis=1).sum(axis=1, dtype=np.uint8)
        return kind - np.uint8(1)

    def boundary_quads(self) -> Indices:
        """Quads on the boundary, counter-clockwise seen from outside, uint32 of shape (k, 4)."""
        quads = self.cells[:, _FACES].reshape(-1, 4)
        _, first, count = np.unique(np.sort(quads, axis=1), axis=0, return_index=True,
                                    return_counts=True)
        boundary: Indices = quads[np.sort(first[count == 1])]
        return boundary

    def singular_edges(self) -> tuple[Indices, npt.NDArray[np.int64], npt.NDArray[np.bool_]]:
        """Edges with another number of cells around them than 4 (inside) or 2 (on the boundary).

        Returns:
            Vertices of each edge, uint32 of shape (k, 2), the smaller first; the number of cells
            around it, int64 (k,); and whether it is on the boundary, bool (k,).
        """
        edges, valence = np.unique(np.sort(self.cells[:, _EDGES].reshape(-1, 2), axis=1), axis=0,
                                   return_counts=True)
        quads = self.boundary_quads()
        sides = np.stack([quads, np.roll(quads, -1, axis=1)], axis=-1).reshape(-1, 2)

        def key(pairs: Indices) -> npt.NDArray[np.uint64]:
            low, high = pairs.min(axis=1), pairs.max(axis=1)
            keys: npt.NDArray[np.uint64] = low.astype(np.uint64) << np.uint64(32)
            keys |= high.astype(np.uint64)
            return keys

        boundary = np.isin(key(edges), key(sides))
        singular = valence != np.where(boundary, 2, 4)
        return edges[singular], valence[singular].astype(np.int64), boundary[singular]

    def to_meshio(self) -> Any:
        """The mesh as a ``meshio.Mesh``. Raises ImportError without meshio."""
        import meshio

        # meshio wants signed indices for some of its writers.
        return meshio.Mesh(self.points, [("hexahedron", self.cells.astype(np.int64))])

    def to_vtk(self) -> Any:
        """The mesh as a ``vtkUnstructuredGrid``. Raises ImportError without VTK."""
        return self.to_pyvista()

    def to_pyvista(self) -> Any:
        """The mesh as a ``pyvista.UnstructuredGrid``, which is a ``vtkUnstructuredGrid``, with the
        point array ``generator_kind`` if it is known. Raises ImportError without pyvista."""
        import pyvista

        grid = pyvista.UnstructuredGrid({pyvista.CellType.HEXAHEDRON: self.cells.astype(np.int64)},
                                        self.points)
        if len(self.generator_corners):
            grid.point_data["generator_kind"] = self.generator_kind
        return grid


@dataclasses.dataclass(frozen=True)
class Defect:
    """One violated condition of a map."""

    code: str  #: as in docs/errors.md
    sentence: str  #: what is wrong and what to do
    count: int  #: all occurrences
    worst: list[tuple[str, int, int, float]]  #: place, its two numbers, and by how much; worst first


@dataclasses.dataclass(frozen=True)
class CheckReport:
    """What a map is, what its mesh will be, and what is wrong with it."""

    counts: dict[str, Any]  #: points, tets, edges, singular edges by valence, ...
    defects: list[Defect]  #: empty for a valid map
    expected: dict[str, Any] | None  #: what the mesh will have, if the map is valid

    @property
    def valid(self) -> bool:
        """Whether there are no defects."""
        return not self.defects


@dataclasses.dataclass(frozen=True)
class VerifyItem:
    """One comparison of a mesh with its map."""

    name: str
    expected: str
    found: str
    passed: bool


@dataclasses.dataclass(frozen=True)
class VerifyReport:
    """Whether a mesh agrees with its map. True as a condition if all checks passed."""

    items: list[VerifyItem]

    @property
    def passed(self) -> bool:
        """Whether all checks passed."""
        return bool(self.items) and all(item.passed for item in self.items)

    def __bool__(self) -> bool:
        return self.passed


@dataclasses.dataclass(frozen=True)
class Quality:
    """Scaled Jacobians of a mesh."""

    scaled_jacobians: Floats  #: one per cell in [-1, 1], 1 for a cube; float64 (m,)
    minimum: float  #: 0 for a mesh without cells
    mean: float
    not_positive: int  #: cells with scaled Jacobian <= 0
