"""Maps, meshes, and reports."""

from __future__ import annotations

import copyreg
import dataclasses
import operator
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _compare, _hexhex, _interchange, _picture
from ._errors import ArgumentError

if TYPE_CHECKING:
    Floats = npt.NDArray[np.float64]
    Indices = npt.NDArray[np.uint32]
    Ints = npt.NDArray[np.int32]
    Corners = npt.NDArray[np.uint8]

# Faces of a hexahedron (VTK corner numbers), counterclockwise seen from outside.
_FACES = np.array([[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [3, 7, 6, 2], [1, 2, 6, 5],
                   [0, 4, 7, 3]])


def _floats(values: npt.ArrayLike, shape: tuple[int, ...], name: str) -> Floats:
    array = np.asarray(values)
    if array.ndim >= 1 and array.size == 12 * len(array) and shape == (4, 3):
        array = array.reshape(len(array), 4, 3)
    if array.shape[1:] != shape:
        raise ArgumentError(f"The array {name} has shape {array.shape}; it needs one of "
                            f"(n, {', '.join(map(str, shape))}).", "InvalidArgument")
    return np.ascontiguousarray(array, dtype=np.float64)


def _igm(values: npt.ArrayLike, points: Floats, tets: Indices) -> Floats:
    """Returns parameters per corner; parameters of a vertex apply to all corners there."""
    array = np.asarray(values)
    if array.ndim == 2 and array.shape[1] == 3 and len(array) == len(points) > 0:
        # Tets with invalid vertices are rejected later, with their numbers.
        array = array[np.minimum(tets, len(points) - 1)]
    elif array.ndim == 2 and array.shape[1] == 3:
        raise ArgumentError(f"The array igm has shape {array.shape}, which is one per vertex; there are "
                            f"{len(points)} vertices.", "InvalidArgument")
    return _floats(array, (4, 3), "igm")


def _indices(values: npt.ArrayLike, width: int, name: str) -> Indices:
    array = np.asarray(values)
    if array.ndim != 2 or array.shape[1] != width:
        raise ArgumentError(f"The array {name} has shape {array.shape}; it needs one of "
                            f"(n, {width}).", "InvalidArgument")
    if array.dtype.kind not in "iu":
        raise ArgumentError(f"The array {name} has dtype {array.dtype}; it needs integers.",
                            "InvalidArgument")
    if array.dtype == np.int32 and array.flags.c_contiguous:
        return array.view(np.uint32)  # negative numbers become out of range
    if array.dtype != np.uint32 and array.size and not (
            0 <= int(array.min()) and int(array.max()) < 2**32):
        raise ArgumentError(f"The array {name} has numbers that are no indices.",
                            "InvalidArgument")
    return np.ascontiguousarray(array, dtype=np.uint32)


def _ints(values: npt.ArrayLike | None, width: int, name: str,
          dtype: type[np.signedinteger[Any]] = np.int32) -> npt.NDArray[Any]:
    """Returns integers of shape (n, width), or (n,) for width 0; an empty array for None."""
    if values is None:
        return np.empty((0, width) if width else (0,), dtype=dtype)
    array = np.asarray(values)
    if array.shape == (0,) and width:
        array = np.empty((0, width), dtype=dtype)
    if array.ndim != (2 if width else 1) or (width and array.shape[1] != width):
        shape = f"(n, {width})" if width else "(n,)"
        raise ArgumentError(f"The array {name} has shape {array.shape}; it needs one of {shape}.",
                            "InvalidArgument")
    if array.size and array.dtype.kind not in "iu":
        raise ArgumentError(f"The array {name} has dtype {array.dtype}; it needs integers.",
                            "InvalidArgument")
    limits = np.iinfo(dtype)
    if array.dtype != dtype and array.size and not (
            limits.min <= int(array.min()) and int(array.max()) <= limits.max):
        raise ArgumentError(f"The array {name} has numbers beyond {np.dtype(dtype)}.",
                            "InvalidArgument")
    return np.ascontiguousarray(array, dtype=dtype)


def _whole(value: object, name: str) -> int:
    """Returns a 32-bit integer; also accepts values such as 2.0."""
    try:
        if isinstance(value, (float, np.floating)) and float(value).is_integer():
            value = int(value)
        number = operator.index(value)  # type: ignore[arg-type]
    except TypeError:
        raise ArgumentError(f"The {name} is {value!r}; it has to be a whole number.",
                            "InvalidArgument") from None
    if abs(number) >= 2**31:
        raise ArgumentError(f"The {name} is {number}, which is too large.", "InvalidArgument")
    return number


def _generators(tet: npt.ArrayLike | None, corners: npt.ArrayLike | None,
                count: int) -> tuple[Indices, Corners]:
    """Returns both arrays, with one number per point, or both empty."""
    known = [np.asarray([] if given is None else given) for given in (tet, corners)]
    if any(array.ndim != 1 for array in known) or not (
            len(known[0]) == len(known[1]) and len(known[0]) in (0, count)):
        raise ArgumentError("The arrays generator_tet and generator_corners need one number for "
                            "each point, or both none.", "InvalidArgument")
    return (np.ascontiguousarray(known[0], dtype=np.uint32),
            np.ascontiguousarray(known[1], dtype=np.uint8))


def _kind(corners: Corners) -> Corners:
    """Returns the number of corners in each set, minus one."""
    bits: Corners = np.unpackbits(corners[:, None], axis=1).sum(axis=1, dtype=np.uint8)
    return bits - np.uint8(1)


def _names_of(handle: Any) -> dict[tuple[int, int], str]:
    return {(dimension, tag): name for dimension, tag, name in handle.tag_names}


class Features:
    """Tagged vertices, edges, and triangles of tets or quads of a mesh, such as sharp curves and
    named surfaces. A row lists the vertices, in any order except for quads, and then the tag.

    Attributes:
        vertices: int32 of shape (k, 2): vertex, tag.
        edges: int32 of shape (k, 3): two vertices, tag.
        faces: for a Map, int32 of shape (k, 4): three vertices, tag; for a Mesh, (k, 5): four
            vertices, tag.
        names: names of tags in files, as a dict from (dimension, tag) to name; dimensions are 0 for
            vertices, 1 for edges, 2 for faces and 3 for regions.

    Raises:
        ArgumentError: for invalid shapes or types.
    """

    def __init__(self, vertices: npt.ArrayLike | None = None, edges: npt.ArrayLike | None = None,
                 faces: npt.ArrayLike | None = None, *, corners: int = 3,
                 names: dict[tuple[int, int], str] | None = None) -> None:
        self.vertices: Ints = _ints(vertices, 2, "features.vertices")
        self.edges: Ints = _ints(edges, 3, "features.edges")
        self.faces: Ints = _ints(faces, corners + 1, "features.faces")
        self.names: dict[tuple[int, int], str] = dict(names or {})

    @classmethod
    def _of_mesh(cls, h: Any) -> Features:
        return cls(h.feature_vertices, h.feature_edges, h.feature_quads, corners=4,
                   names=_names_of(h))

    def _name_rows(self) -> list[tuple[int, int, str]]:
        return [(dimension, tag, name) for (dimension, tag), name in self.names.items()]

    def __eq__(self, other: object) -> bool:
        """Compares rows, in the same order, and names."""
        return isinstance(other, Features) and self.names == other.names and _compare.same_arrays(
            self, other, ("vertices", "edges", "faces"))

    def __repr__(self) -> str:
        return (f"<hexhex.Features: {len(self.vertices)} vertices, {len(self.edges)} edges, "
                f"{len(self.faces)} faces>")

    def __bool__(self) -> bool:
        return bool(len(self.vertices) or len(self.edges) or len(self.faces))


class Map(_interchange.Wrappable):
    """A tetrahedral mesh with an integer-grid map.

    Attributes:
        points: positions, float64 of shape (n, 3).
        tets: 0-based vertices of each tet, uint32 of shape (m, 4).
        igm: parameters (u, v, w) of the four corners of each tet, in units of one hexahedron,
            float64 of shape (m, 4, 3). May be given per vertex, (n, 3), if there is a single chart.
        features: tagged vertices, edges and triangles: Features.
        regions: a number for each tet, inherited by the cells: int32 (m,); empty if there are none.
        edge_valences: known singular edges, int32 (k, 3): two vertices, and the number of hexahedra
            around the edge minus the regular one; empty: computed.
        rotations: known transitions, int8 (m, 4), numbered as in AlgoHex; empty: computed.
        answer: for a map from generate(), the known properties of its mesh at scale 1, without
            defects: a dict with cells, vertices, boundary_quads, inner_singular_edges and
            boundary_singular_edges (by valence), euler_characteristic, components,
            boundary_components, tagged_vertices, tagged_edges and tagged_quads (by tag), and
            regions; otherwise None.

    Arrays of these types in C order are used without a copy, as is an int32 array of ``tets``;
    others are converted. Do not modify them while a function uses them.

    Raises:
        ArgumentError: for invalid shapes or types.

    >>> map = hexhex.generate("box", features=True)
    >>> map.features, sorted(set(map.regions.tolist()))
    (<hexhex.Features: 8 vertices, 48 edges, 192 faces>, [1, 2, 3, 4, 5, 6, 7, 8])
    """

    def __init__(self, points: npt.ArrayLike, tets: npt.ArrayLike, igm: npt.ArrayLike, *,
                 features: Features | None = None, regions: npt.ArrayLike | None = None,
                 edge_valences: npt.ArrayLike | None = None,
                 rotations: npt.ArrayLike | None = None) -> None:
        self.points: Floats = _floats(points, (3,), "points")
        self.tets: Indices = _indices(tets, 4, "tets")
        self.igm: Floats = _igm(igm, self.points, self.tets)
        self.features: Features = Features() if features is None else features
        self.regions: Ints = _ints(regions, 0, "regions")
        self.edge_valences: Ints = _ints(edge_valences, 3, "edge_valences")
        self.rotations: npt.NDArray[np.int8] = _ints(rotations, 4, "rotations", np.int8)
        self.answer: dict[str, Any] | None = None

    @classmethod
    def _from_handle(cls, handle: _hexhex.Map) -> Map:
        features = Features(handle.feature_vertices, handle.feature_edges, handle.feature_faces,
                            names=_names_of(handle))
        return cls(handle.points, handle.tets, handle.igm, features=features,
                   regions=handle.regions, edge_valences=handle.edge_valences,
                   rotations=handle.rotations)

    def _arrays(self) -> _hexhex.MapArrays:
        """Returns the current attributes as arrays for the library."""
        f = self.features
        return _hexhex.MapArrays(
            _floats(self.points, (3,), "points"), _indices(self.tets, 4, "tets"),
            _floats(self.igm, (4, 3), "igm"), _ints(f.vertices, 2, "features.vertices"),
            _ints(f.edges, 3, "features.edges"), _ints(f.faces, 4, "features.faces"),
            _ints(self.regions, 0, "regions"), _ints(self.edge_valences, 3, "edge_valences"),
            _ints(self.rotations, 4, "rotations", np.int8), f._name_rows())

    def __eq__(self, other: object) -> bool:
        """Compares arrays and tags, bit for bit."""
        return isinstance(other, Map) and self.features == other.features and _compare.same_arrays(
            self, other, ("points", "tets", "igm", "regions", "edge_valences", "rotations"))

    def __repr__(self) -> str:
        return f"<hexhex.Map: {len(self.tets)} tets, {len(self.points)} points>"

    def _repr_html_(self) -> str:
        """For notebooks: includes a picture of the boundary, with the integer grid as a
        checkerboard."""
        return _picture.html(repr(self), lambda: _picture.of_map(self.points, self.tets, self.igm))

    @classmethod
    def from_pyvista(cls, grid: Any, array: str = "igm") -> Map:
        """Converts the tetrahedra of a PyVista (or VTK) data set, with the map in a cell array with
        12 components or a point array with 3, and tags and regions named as in to_pyvista().

        Raises:
            ArgumentError: if there are no tetrahedra or no such array.
            ImportError: without pyvista.
        """
        return _interchange.map_of_grid(
            _interchange.from_pyvista(grid, _interchange.TETRA, "tetrahedra"), array)

    def to_vtk(self) -> Any:
        """Returns a ``vtkUnstructuredGrid`` of tetrahedra on the same memory, with the map in the
        cell array ``igm`` with 12 components, and tags and regions as in .vtu files. Raises
        ImportError without vtk."""
        return _interchange.to_vtk(_interchange.grid_of_map(self), _interchange.TETRA)

    def to_pyvista(self) -> Any:
        """Returns the same as a ``pyvista.UnstructuredGrid``. Raises ImportError without
        pyvista."""
        return _interchange.to_pyvista(_interchange.grid_of_map(self), _interchange.TETRA)

    @classmethod
    def from_meshio(cls, mesh: Any, array: str = "igm") -> Map:
        """Converts the tetrahedra of a ``meshio.Mesh``, with a map as in from_pyvista()."""
        return _interchange.map_of_grid(
            _interchange.from_meshio(mesh, "tetra", "tetrahedra"), array)

    def to_meshio(self) -> Any:
        """Returns a ``meshio.Mesh`` with the map in the cell array ``igm``, regions, and tags of
        vertices. Raises ImportError without meshio."""
        return _interchange.to_meshio(_interchange.grid_of_map(self), "tetra")


@dataclasses.dataclass(frozen=True)
class SampleKind:
    """A kind of map for generate()."""

    name: str
    description: str


@dataclasses.dataclass(frozen=True)
class RepairedRegion:
    """Result of a repair at one place."""

    place: str  #: a bad tet
    index: int  #: number of that tet
    position: tuple[float, float, float]  #: in space
    bad_tets: int  #: flipped or flat before the repair
    tets: int  #: in the optimized patch
    moved_vertices: int
    largest_move: float  #: largest change of a coordinate, in parameter units


@dataclasses.dataclass(frozen=True)
class RepairReport:
    """Report of a repair; see docs/user/defects.md."""

    changed: bool  #: False for a valid map
    bad_tets: int
    moved_vertices: int
    largest_move: float  #: largest change of a coordinate, in parameter units
    split_edges: int
    added_tets: int
    rounded_vertices: int
    seconds: float
    regions: list[RepairedRegion]

    @classmethod
    def _of(cls, values: dict[str, Any]) -> RepairReport:
        return cls(**{**values, "regions": [RepairedRegion(*r) for r in values["regions"]]})


@dataclasses.dataclass(frozen=True)
class SeamlessReport:
    """Whether a map is seamless: charts differ by rotations and translations, and singular edges
    and the boundary are axis-aligned."""

    kind: str  #: "seamless", "almost seamless" (to within a hundredth of its extent), or "neither"
    displacement: float  #: of the nearest seamless map, in parameter units; 0 if there is none
    cells: float  #: its volume, in unit cubes
    problem: str  #: why it is "neither"; empty if can_quantize() is False


@dataclasses.dataclass(frozen=True)
class QuantizeReport:
    """Report of a quantization. Distortion is the scaled Jacobian of the map, at most 1."""

    cells_wanted: float
    cells: int
    scale: float  #: final scale of the seamless map's parameters
    displacement: float  #: largest change of a parameter needed to make the map seamless
    blocks: int  #: in the motorcycle complex
    arcs: int
    shortest_arc: int  #: in hexahedra
    longest_arc: int
    integers_by: str  #: "HiGHS", or "rounding" if HiGHS is not available
    attempts: int  #: number of target cell counts tried
    split_edges: int  #: each split adds a vertex to the tet mesh
    added_tets: int  #: by these splits
    worst_before: float
    median_before: float
    worst_after: float
    median_after: float
    stages: list[tuple[str, float]] = dataclasses.field(default_factory=list)
    #: (name, seconds); for a MeshedPart, they are in its own list


@dataclasses.dataclass(frozen=True)
class ShapeReport:
    """Report on the computation of a map by map_from_tets()."""

    method: str  #: "frames" or "polycube"
    rotation: Floats  #: rows: the axes in space that became the axes of the map, float64 (3, 3)
    charts: int  #: faces of the polycube; this and the next nine are for polycubes only
    corners: int  #: where at least three charts meet
    bad_loops: int  #: chart borders with fewer than four corners
    bad_corners: int  #: of more than three charts, without room, or where labels wind otherwise than normals
    opposite_edges: int  #: mesh edges between opposite labels
    turning_points: int  #: where edges of the polycube would reverse direction
    wrong_turns: int  #: charts whose right angles do not add up
    flat_charts: int  #: charts with two edges that would coincide
    deviation: float  #: mean of 1 minus the cosine between a triangle's normal and its label
    label_moves: int  #: random changes tried
    added_tets: int  #: by splits
    feature_edges: int  #: edges of the tets above the angle
    tagged_edges: int  #: those of them that are edges of the map
    inner_faces: int  #: interior triangles with a tag or between regions
    aligned_faces: int  #: those of them that lie in planes of the map, which the mesh follows
    aligned_area: float  #: share of the area of inner faces that these have, 0 to 1
    worst: float  #: distortion of the map as a scaled Jacobian, at most 1
    median: float


@dataclasses.dataclass(frozen=True)
class Arcs:
    """Hex edges as polylines. Arc e has inner points point_begin[e] to point_begin[e + 1] - 1 and
    one segment more than inner points, numbered from point_begin[e] + e."""

    ends: Indices  #: hex vertices at both ends of each arc, uint32 (e, 2)
    point_begin: npt.NDArray[np.uint64]  #: uint64 (e + 1,)
    points: Floats  #: positions of inner points, float64 (n, 3)
    parameters: Floats  #: positions of inner points along their arcs, in (0, 1), float64 (n,)
    generator_tet: Indices  #: simplex crossed at an inner point, as in Mesh, uint32 (n,)
    generator_corners: Corners  #: uint8 (n,)
    segment_tet: Indices  #: simplex that contains a segment, uint32 (n + e,)
    segment_corners: Corners  #: uint8 (n + e,)
    _handle: Any = dataclasses.field(repr=False, compare=False)

    def __len__(self) -> int:
        return len(self.ends)

    def __repr__(self) -> str:
        return f"<hexhex.Arcs: {len(self)} arcs, {len(self.points)} inner points>"

    def __reduce__(self) -> Any:
        return Arcs._of, (self._handle,)

    @classmethod
    def _of(cls, handle: _hexhex.PiecewiseMesh) -> Arcs:
        return cls(**handle.arcs, _handle=handle)


@dataclasses.dataclass(frozen=True)
class Patches:
    """Hex faces as planar polygons. Points are numbered in the order hex vertices, inner points of
    arcs, inner points of patches."""

    vertices: Indices  #: of each face, uint32 (f, 4)
    arcs: Indices  #: of each face, from vertex i to i + 1, uint32 (f, 4)
    reversed_arcs: Corners  #: bit i: that arc runs in the other direction, uint8 (f,)
    polygon_begin: npt.NDArray[np.uint64]  #: polygons of each face, uint64 (f + 1,)
    corner_begin: npt.NDArray[np.uint64]  #: corners of each polygon, uint64 (p + 1,)
    polygon_tet: Indices  #: simplex whose interior contains a polygon, uint32 (p,)
    polygon_corners: Corners  #: uint8 (p,)
    corners: Indices  #: numbers of points, counterclockwise in (u, v), uint32 (c,)
    parameters: Floats  #: (u, v) of each corner in its face, in [0, 1], float64 (c, 2)
    points: Floats  #: positions of inner points of faces, float64 (n, 3)
    generator_tet: Indices  #: uint32 (n,)
    generator_corners: Corners  #: uint8 (n,)
    _handle: Any = dataclasses.field(repr=False, compare=False)

    def __len__(self) -> int:
        return len(self.vertices)

    def __repr__(self) -> str:
        return (f"<hexhex.Patches: {len(self)} faces, {len(self.polygon_tet)} polygons, "
                f"{len(self.points)} inner points>")

    def __reduce__(self) -> Any:
        return Patches._of, (self._handle,)

    @classmethod
    def _of(cls, handle: _hexhex.PiecewiseMesh) -> Patches:
        return cls(**handle.patches, _handle=handle)


class _Hexes(_interchange.Wrappable):
    """What meshes of straight and of curved cells have in common."""

    _handle: _hexhex.Mesh | _hexhex.LagrangeMesh

    @property
    def generator_tet(self) -> Indices:
        """Per vertex or node: a tet that contains its generator, uint32 of shape (n,); empty if
        unknown."""
        return self._handle.generator_tet

    @property
    def generator_corners(self) -> Corners:
        """Per vertex or node: its generator as corners of that tet, bit i for corner i, uint8
        (n,)."""
        return self._handle.generator_corners

    @property
    def features(self) -> Features:
        """Tagged elements of the straight mesh, with quads as faces; views."""
        return Features._of_mesh(self._handle)

    @property
    def regions(self) -> Ints:
        """Region of each cell, int32 (m,); empty if unknown."""
        return self._handle.regions


class LagrangeMesh(_Hexes):
    """Hexahedra of order p: ``mesh.curved`` from ``extract(..., order=p)``, the result of
    read_curved(), or a mesh made from copies of your own arrays.

    Args:
        order: p, 1 to 9.
        points: positions of nodes, float64 (n, 3).
        nodes: nodes of each cell, integers (m, (p + 1)**3), in the order below.
        vertex_count: number of nodes that are hex vertices; these come first.
        generator_tet, generator_corners, features, regions: as in Mesh; optional.

    Raises:
        ArgumentError: for invalid shapes or types. Functions that use the mesh raise it for nodes
            that do not exist.

    >>> curved = hexhex.extract(hexhex.generate("box", cells=1), order=2).curved
    >>> hexhex.LagrangeMesh(2, curved.points, curved.nodes, curved.vertex_count)
    <hexhex.LagrangeMesh: 8 cells of order 2>
    """

    _handle: _hexhex.LagrangeMesh

    def __init__(self, order: int, points: npt.ArrayLike, nodes: npt.ArrayLike, vertex_count: int,
                 *, generator_tet: npt.ArrayLike | None = None,
                 generator_corners: npt.ArrayLike | None = None,
                 features: Features | None = None, regions: npt.ArrayLike | None = None) -> None:
        highest = 9
        order, vertex_count = _whole(order, "order"), operator.index(vertex_count)
        if not 1 <= order <= highest or vertex_count < 0:
            raise ArgumentError(f"The order is {order}, and {vertex_count} nodes are vertices. "
                                "Choose the order from 1 to 9.", "InvalidArgument")
        f = Features(corners=4) if features is None else features
        places = _floats(points, (3,), "points")
        self._handle = _hexhex.LagrangeMesh(
            order, places, _indices(nodes, (order + 1)**3, "nodes"), vertex_count,
            *_generators(generator_tet, generator_corners, len(places)),
            _ints(f.vertices, 2, "features.vertices"), _ints(f.edges, 3, "features.edges"),
            _ints(f.faces, 5, "features.faces"), _ints(regions, 0, "regions"),
            f._name_rows(), np.empty(0, dtype=np.uint32))

    @classmethod
    def _from_handle(cls, handle: _hexhex.LagrangeMesh) -> LagrangeMesh:
        mesh = cls.__new__(cls)
        mesh._handle = handle
        return mesh

    def __eq__(self, other: object) -> bool:
        """Compares nodes, cells, tags and regions, bit for bit."""
        return isinstance(other, LagrangeMesh) and self.features == other.features and (
            _compare.same_arrays(self, other, ("order", "vertex_count", "points", "nodes", "regions")))

    def __repr__(self) -> str:
        return f"<hexhex.LagrangeMesh: {len(self.nodes)} cells of order {self.order}>"

    def _repr_html_(self) -> str:
        """For notebooks: includes a picture of the straight mesh."""
        return _picture.html(repr(self), lambda: _picture.of_mesh(self.straight()))

    @property
    def order(self) -> int:
        """The order p, 1 to 9."""
        return self._handle.order

    @property
    def points(self) -> Floats:
        """Positions of nodes, float64 (n, 3); the first ``vertex_count`` are the hex vertices."""
        return self._handle.points

    @property
    def nodes(self) -> Indices:
        """Nodes of each cell, uint32 (m, (p + 1)**3): node (i, j, k), i / p of the way from corner
        0 to 1, j / p to corner 3, k / p to corner 4, is number i + (p + 1) (j + (p + 1) k)."""
        return self._handle.nodes

    @property
    def vertex_count(self) -> int:
        """Number of hex vertices."""
        return self._handle.vertex_count

    @property
    def straightened_cells(self) -> Indices:
        """Cells that left the surface in order to be positive, ascending, uint32 (k,); empty unless
        made by extract()."""
        return self._handle.straightened_cells

    def straight(self) -> Mesh:
        """Returns a copy of the straight mesh of the corners, with generators, tags and regions.
        Raises ArgumentError for nodes that do not exist."""
        return Mesh._from_handle(self._handle.straight())

    def _grid(self, *, row_by_row: bool = False) -> _interchange.Grid:
        kind = {"generator_kind": _kind(self.generator_corners)} if len(self.generator_tet) else {}
        regions = {"region": self.regions} if len(self.regions) else {}
        order = _interchange.vtk_order(self.order, row_by_row=row_by_row)
        return _interchange.Grid(self.points, self.nodes[:, order], kind, regions, {})

    def to_meshio(self) -> Any:
        """Returns a ``meshio.Mesh`` as meshio reads it from a .vtu file: of hexahedron27 for order
        2, otherwise of VTK_LAGRANGE_HEXAHEDRON. Raises ImportError without meshio."""
        if self.order == 2:
            return _interchange.to_meshio(self._grid(), "hexahedron27")
        return _interchange.to_meshio(self._grid(row_by_row=True), "VTK_LAGRANGE_HEXAHEDRON")

    def to_vtk(self) -> Any:
        """Returns a ``vtkUnstructuredGrid`` of VTK_LAGRANGE_HEXAHEDRON. Raises ImportError without
        vtk."""
        return _interchange.to_vtk(self._grid(), _interchange.LAGRANGE_HEXAHEDRON)

    def to_pyvista(self) -> Any:
        """Returns the same as a ``pyvista.UnstructuredGrid``. Raises ImportError without
        pyvista."""
        return _interchange.to_pyvista(self._grid(), _interchange.LAGRANGE_HEXAHEDRON)


@dataclasses.dataclass(frozen=True)
class BoundaryPatch:
    """A part of the boundary with its name in files."""

    name: str  #: "inlet", "surface_7" for tag 7, "patch_1", or "boundary"
    tag: int  #: tag of its quads; 0: none
    quads: Indices  #: facing outwards, uint32 (k, 4)
    area: float
    centre: tuple[float, ...]
    normal: tuple[float, ...]  #: area-weighted mean of unit normals: length 1 if flat, 0 if closed

    def __repr__(self) -> str:
        return f"<hexhex.BoundaryPatch: {self.name}, {len(self.quads)} quads, area {self.area:.4g}>"


@dataclasses.dataclass(frozen=True)
class SingularCurve:
    """A chain of singular edges of the same valence; closed if its last vertex is the first."""

    vertices: Indices  #: uint32 (k,)
    valence: int  #: number of cells around each edge
    boundary: bool  #: whether its edges are on the boundary; either all are or none


@dataclasses.dataclass(frozen=True)
class IrregularVertices:
    """Vertices with the same configuration of singular edges."""

    boundary: bool  #: whether they are on the boundary
    inner_valences: list[int]  #: of their interior singular edges, ascending
    boundary_valences: list[int]  #: of their boundary singular edges, ascending
    vertices: Indices  #: ascending, uint32 (k,)


@dataclasses.dataclass(frozen=True)
class BaseComplex:
    """Decomposition of a mesh into sheets, chords and blocks, numbered in order of their first
    cells. Opposite edges of a face belong to the same sheet, opposite faces of a cell to the same
    chord."""

    cell_sheets: Indices  #: sheets of the edges from corner 0 to 1, 3 and 4, uint32 (m, 3)
    sheets: int  #: number of sheets
    cell_chords: Indices  #: chords through a cell along these axes, uint32 (m, 3)
    chords: int  #: number of chords
    cell_blocks: Indices  #: uint32 (m,)
    block_sizes: npt.NDArray[np.uint64]  #: cells along the axes of the first cell, uint64 (b, 3);
    #: 0, 0, 0 for a block that is not a box
    block_cells: npt.NDArray[np.uint64]  #: uint64 (b,)
    curves: list[SingularCurve]
    irregular: list[IrregularVertices]
    mesh: Mesh  #: whose complex it is

    def to_pyvista(self) -> Any:
        """A ``pyvista.MultiBlock``: ``cells`` with the arrays block, sheets and chords; the data sets ``walls``
        (faces between blocks), ``sheets`` (a quad through the middle of each cell that a sheet passes),
        ``chords`` (a line from face to face), ``singular_curves`` (a polyline each, with valence and
        boundary) and ``irregular_vertices``. Raises ImportError without pyvista.

        >>> parts = hexhex.extract(hexhex.generate("sphere")).base_complex().to_pyvista()
        >>> parts["singular_curves"].n_cells, int(parts["sheets"]["sheet"].max())
        (20, 15)
        """
        return _interchange.complex_to_pyvista(self)

    def __repr__(self) -> str:
        return (f"<hexhex.BaseComplex: {self.sheets} sheets, {self.chords} chords, "
                f"{len(self.block_cells)} blocks, {len(self.curves)} singular curves>")


class Mesh(_Hexes):
    """A hexahedral mesh.

    ``Mesh(points, cells)`` copies your own arrays: float64 (n, 3) and integers (m, 8), and
    optionally generators (uint32 (n,) and uint8 (n,)), tags and regions (int32 (m,)).

    Attributes:
        statistics: statistics of the extraction, e.g. ``seconds``, and ``stages``, a list of
            (name, seconds); empty for other meshes.
        repair: RepairReport, if the map was repaired; otherwise None.
        repaired_map: the repaired map, from which the mesh was extracted, if the map needed repair;
            otherwise None.
        quantization: QuantizeReport, if the map was quantized; otherwise None.
        quantized_map: the resulting integer-grid map; otherwise None.
        arcs: the exact shapes of edges, if requested: Arcs; otherwise None.
        patches: the exact shapes of faces, if requested: Patches; otherwise None.
        curved: the higher-order cells, if requested: LagrangeMesh; otherwise None.

    Raises:
        ArgumentError: for invalid shapes or types.
    """

    _handle: _hexhex.Mesh

    def __init__(self, points: npt.ArrayLike, cells: npt.ArrayLike, *,
                 generator_tet: npt.ArrayLike | None = None,
                 generator_corners: npt.ArrayLike | None = None,
                 features: Features | None = None, regions: npt.ArrayLike | None = None) -> None:
        f = Features(corners=4) if features is None else features
        places = _floats(points, (3,), "points")
        self._set(_hexhex.Mesh(
            places, _indices(cells, 8, "cells"),
            *_generators(generator_tet, generator_corners, len(places)),
            _ints(f.vertices, 2, "features.vertices"), _ints(f.edges, 3, "features.edges"),
            _ints(f.faces, 5, "features.faces"), _ints(regions, 0, "regions"),
            f._name_rows()))

    def _set(self, handle: _hexhex.Mesh, notes: tuple[Any, Any, Any] = ({}, None, None)) -> None:
        statistics, report, repaired = notes
        self._handle = handle
        self.statistics: dict[str, Any] = statistics
        self.repair: RepairReport | None = None if report is None else RepairReport._of(report)
        self.repaired_map: Map | None = None if repaired is None else Map._from_handle(repaired)
        self.quantization: QuantizeReport | None = None
        self.quantized_map: Map | None = None
        self.arcs: Arcs | None = None
        self.patches: Patches | None = None
        self.curved: LagrangeMesh | None = None

    @classmethod
    def _from_handle(cls, handle: _hexhex.Mesh,
                     notes: tuple[Any, Any, Any] = ({}, None, None)) -> Mesh:
        mesh = cls.__new__(cls)
        mesh._set(handle, notes)
        return mesh

    def __eq__(self, other: object) -> bool:
        """Compares points, cells, tags, names and regions, in the same order and bit for bit,
        whatever their origin. hexhex.same_mesh() ignores differences in numbering."""
        return isinstance(other, Mesh) and self.features == other.features and _compare.same_arrays(
            self, other, ("points", "cells", "regions"))

    def diff(self, other: Mesh) -> str:
        """Describes how another mesh differs, in a few lines with counts and the first differences;
        empty if it is equal.

        >>> mesh = hexhex.extract(hexhex.generate("box"))
        >>> moved = hexhex.Mesh(mesh.points, mesh.cells)
        >>> moved.points[7, 0] += 0.5
        >>> mesh.diff(moved)[:51]
        'points: 1 of 729 differ, by up to 0.5; the first is'
        """
        return _compare.difference(self, other)

    def __repr__(self) -> str:
        return f"<hexhex.Mesh: {len(self.cells)} cells, {len(self.points)} points>"

    def _repr_html_(self) -> str:
        """For notebooks: includes a picture."""
        return _picture.html(repr(self), lambda: _picture.of_mesh(self))

    @property
    def points(self) -> Floats:
        """Positions, float64 of shape (n, 3). A view: writing to it changes the mesh."""
        return self._handle.points

    @property
    def cells(self) -> Indices:
        """Vertices of each cell in the order of VTK_HEXAHEDRON, uint32 of shape (m, 8). A view."""
        return self._handle.cells

    @property
    def generator_kind(self) -> npt.NDArray[np.uint8]:
        """Per vertex: dimension of its generator, 0 vertex, 1 edge, 2 face, 3 tet; uint8 (n,)."""
        return _kind(self.generator_corners)

    def boundary_patches(self, angle: float = 40) -> list[BoundaryPatch]:
        """Returns the named parts of the boundary, as grouped by write(): by tag, or else its
        smooth patches.

        Args:
            angle: in degrees: patches of an untagged boundary end where it turns by more; 0: a
                single one.

        >>> patches = hexhex.extract(hexhex.generate("box")).boundary_patches()
        >>> [(p.name, len(p.quads), p.area, p.normal) for p in patches][0]
        ('patch_1', 64, 4.0, (-1.0, 0.0, 0.0))
        """
        return [BoundaryPatch(name, tag, quads, area, tuple(centre), tuple(normal))
                for name, tag, quads, area, centre, normal
                in _hexhex.named_patches(self._handle, angle, 0)]

    def base_complex(self) -> BaseComplex:
        """Finds sheets, chords, blocks between the walls that extend straight from singular edges,
        singular curves, and irregular vertices by type. Raises ArgumentError for cells that do not
        fit together.

        >>> complex = hexhex.extract(hexhex.generate("sphere")).base_complex()
        >>> complex.sheets, complex.chords, complex.block_sizes.tolist()[0], len(complex.curves)
        (16, 96, [4, 4, 4], 20)
        """
        (sheets, sheet_count, chords, chord_count, blocks, sizes, curves,
         types) = _hexhex.base_complex(self._handle, 0, None)
        return BaseComplex(sheets, sheet_count, chords, chord_count, blocks, sizes[:, :3], sizes[:, 3],
                           [SingularCurve(*curve) for curve in curves],
                           [IrregularVertices(*kind) for kind in types], self)

    def structure(self) -> dict[str, int]:
        """Returns the numbers of faces, edges, boundary_quads, components and boundary_components,
        and the euler_characteristic."""
        counts: dict[str, int] = _hexhex.structure(self._handle, 0, None)[1]
        return counts

    def boundary_quads(self) -> Indices:
        """Returns the quads on the boundary, counterclockwise seen from outside, uint32 of shape
        (k, 4)."""
        quads = self.cells[:, _FACES].reshape(-1, 4)
        _, first, count = np.unique(np.sort(quads, axis=1), axis=0, return_index=True,
                                    return_counts=True)
        boundary: Indices = quads[np.sort(first[count == 1])]
        return boundary

    def singular_edges(self) -> tuple[Indices, npt.NDArray[np.int64], npt.NDArray[np.bool_]]:
        """Finds edges whose number of cells is not 4 (inside) or 2 (on the boundary).

        Returns:
            Vertices of each edge, uint32 of shape (k, 2), the smaller first; the number of cells
            around it, int64 (k,); and whether it is on the boundary, bool (k,).
        """
        rows: Indices = _hexhex.structure(self._handle, 0, None)[0]
        return rows[:, :2], rows[:, 2].astype(np.int64), rows[:, 3] != 0

    def _scaled_jacobians(self) -> Floats:
        jacobians: Floats = _hexhex.certify(self._handle, 0, None)[0]
        return jacobians

    @classmethod
    def from_pyvista(cls, grid: Any) -> Mesh:
        """Converts the hexahedra of a PyVista (or VTK) data set, with generators, tags and regions
        named as in to_pyvista(). Raises ArgumentError without hexahedra, ImportError without
        pyvista."""
        return _interchange.mesh_of_grid(
            _interchange.from_pyvista(grid, _interchange.HEXAHEDRON, "hexahedra"))

    @classmethod
    def from_meshio(cls, mesh: Any) -> Mesh:
        """Converts the hexahedra of a ``meshio.Mesh``. Tags of its lines and quads, and regions of
        its cells, come from cell sets, with their names, or else from the arrays ``tag`` and
        ``region``, ``gmsh:physical`` (with Gmsh's names) or ``medit:ref``. Sets called ``boundary``, ``patch_1`` and
        the like are not tags. Raises ArgumentError without hexahedra."""
        return _interchange.mesh_of_meshio(mesh)

    def to_meshio(self, patch_angle: float = 40) -> Any:
        """Returns a ``meshio.Mesh`` of the hexahedra with the array ``region``; boundary quads,
        tagged interior quads, and tagged edges as lines, with the array ``tag``. All groups made by
        write() become cell sets with their names. Generators and tags of vertices are arrays.
        Raises ImportError without meshio.

        Args:
            patch_angle: as in boundary_patches().
        """
        return _interchange.meshio_of_mesh(self, patch_angle)

    def to_vtk(self, *, quality: bool = True) -> Any:
        """Returns a ``vtkUnstructuredGrid`` on the same memory: writing to its points changes the
        mesh. It has the same arrays as .vtu files, if known: the point arrays ``generator_kind``,
        ``generator_tet``, ``generator_corners`` and ``feature_vertex``, the cell arrays
        ``scaled_jacobian`` and ``region``, and the field arrays ``feature_edges``,
        ``feature_quads``, and ``named_tags`` with ``tag_names``. Raises ImportError without vtk.

        Args:
            quality: whether to compute scaled Jacobians.
        """
        return _interchange.to_vtk(_interchange.grid_of_mesh(self, quality),
                                   _interchange.HEXAHEDRON)

    def to_pyvista(self, *, quality: bool = True) -> Any:
        """Returns the same as a ``pyvista.UnstructuredGrid``, as does ``pyvista.wrap(mesh)``.
        Raises ImportError without pyvista."""
        return _interchange.to_pyvista(_interchange.grid_of_mesh(self, quality),
                                       _interchange.HEXAHEDRON)


@dataclasses.dataclass(frozen=True)
class Extraction:
    """What extract_to() and extract_to_file() return: what a Mesh has beside its arrays."""

    statistics: dict[str, Any]
    repair: RepairReport | None  #: if the map was repaired
    repaired_map: Map | None  #: from which the mesh was extracted, if the map was repaired


@dataclasses.dataclass(frozen=True)
class Hole:
    """A place where cells are missing."""

    tet: int  #: the smallest tet of the hole
    tets: int
    invalid_tets: int
    position: tuple[float, float, float]  #: in space
    missing_cells: float  #: expected number of cells there in a valid map


@dataclasses.dataclass(frozen=True)
class PartialMesh:
    """Result of a partial extraction from an invalid map."""

    mesh: Mesh  #: its regions are 1 for cells at holes and 0 for others
    holes: list[Hole]  #: in descending order of missing cells
    invalid_tets: int
    missing_cells: float
    face_conflicts: int

    def __repr__(self) -> str:
        return (f"<hexhex.PartialMesh: {len(self.mesh.cells)} cells, {len(self.holes)} holes where "
                f"{self.missing_cells:.0f} cells are missing>")


@dataclasses.dataclass(frozen=True)
class MeshSummary:
    """Summary of a mesh; equal for meshes that are equal, bit for bit."""

    points: int
    cells: int
    lower: tuple[float, float, float]  #: corners of the bounding box
    upper: tuple[float, float, float]
    point_checksum: int
    cell_checksum: int


@dataclasses.dataclass(frozen=True)
class FileFormat:
    """A file format and its support in this build."""

    name: str  #: for ``format=``
    extension: str  #: including the dot; empty: the format must be requested by name
    description: str
    reads_maps: bool
    writes_maps: bool
    reads_tets: bool
    reads_meshes: bool
    writes_meshes: bool
    streams: bool
    compresses: bool


@dataclasses.dataclass(frozen=True)
class Defect:
    """A violated condition of a map."""

    code: str  #: as in docs/user/errors.md
    sentence: str  #: what is wrong and what to do
    count: int  #: number of all occurrences
    worst: list[tuple[str, int, int, float]]  #: place, its two numbers, and the amount; worst first


@dataclasses.dataclass(frozen=True)
class MapStructure:
    """Where the charts of a map change, and where it is singular. A transition maps parameters u in
    the chart of the first tet to R u + t in the chart of the second."""

    jump_tets: Indices  #: tets of each inner face with different charts, ascending, uint32 (j, 2)
    jump_vertices: Indices  #: of that face, in the order of the first tet's corners, uint32 (j, 3)
    rotations: npt.NDArray[np.int8]  #: R, int8 (j, 3, 3)
    translations: Floats  #: t, integers, float64 (j, 3)
    edges: Indices  #: vertices of each singular edge of the tets, ascending, uint32 (k, 2)
    valences: Ints  #: number of hexahedra around each edge, int32 (k,)
    boundary: npt.NDArray[np.bool_]  #: whether the edge is on the boundary, bool (k,)
    defects: list[Defect]  #: as from check(); what they hide is missing from the arrays above

    def __repr__(self) -> str:
        return (f"<hexhex.MapStructure: {len(self.jump_tets)} faces between charts, "
                f"{len(self.edges)} singular edges, {len(self.defects)} defects>")


@dataclasses.dataclass(frozen=True)
class CheckReport:
    """Properties of a map, the mesh to expect, and the defects of the map."""

    counts: dict[str, Any]  #: points, tets, edges, singular edges by valence, ...
    defects: list[Defect]  #: empty for a valid map
    expected: dict[str, Any] | None  #: properties of the mesh, if the map is valid

    @property
    def valid(self) -> bool:
        """Whether there are no defects."""
        return not self.defects

    def __repr__(self) -> str:
        if self.expected is not None:
            return f"<hexhex.CheckReport: valid, {self.expected['cells']} cells>"
        found = ", ".join(f"{d.code} ({d.count})" for d in self.defects)
        return f"<hexhex.CheckReport: {found or 'valid'}>"


@dataclasses.dataclass(frozen=True)
class VerifyItem:
    """One comparison of a mesh with its map."""

    name: str
    expected: str
    found: str
    passed: bool


@dataclasses.dataclass(frozen=True)
class VerifyReport:
    """Result of comparing a mesh with its map. True as a condition if all checks passed."""

    items: list[VerifyItem]

    @property
    def passed(self) -> bool:
        """Whether all checks passed."""
        return bool(self.items) and all(item.passed for item in self.items)

    def __bool__(self) -> bool:
        return self.passed

    def __repr__(self) -> str:
        bad = ", ".join(item.name for item in self.items if not item.passed)
        good = sum(item.passed for item in self.items)
        return (f"<hexhex.VerifyReport: {good} of {len(self.items)} checks passed"
                f"{', not ' + bad if bad else ''}>")


@dataclasses.dataclass(frozen=True)
class RefutedCell:
    """A cell that is not positive, and where its smallest value was found."""

    cell: int
    place: tuple[float, float, float]  #: in the cell: (u, v, w) in [0, 1]^3
    position: tuple[float, float, float]  #: in space
    scaled_jacobian: float  #: the value there; not positive


@dataclasses.dataclass(frozen=True)
class Quality:
    """Scaled Jacobians of a mesh, and validity of its cells: a cell is valid if its Jacobian
    determinant is proven to be positive everywhere in it, not only at corners."""

    scaled_jacobians: Floats  #: one per cell in [-1, 1], 1 for a cube; float64 (m,)
    minimum: float  #: 0 for a mesh without cells
    mean: float
    not_positive: int  #: cells with scaled Jacobian <= 0
    histogram: list[int]  #: of [-1, 1] in steps of 0.1
    validity: npt.NDArray[np.uint8]  #: 0 positive everywhere, 1 refuted, 2 undecided; uint8 (m,)
    positive: int  #: number of cells
    refuted: int
    undecided: int
    minimum_everywhere: float  #: lower bound of the scaled Jacobian, also inside cells
    worst: list[RefutedCell]  #: at most ten, most negative first

    @property
    def all_positive(self) -> bool:
        """Whether all cells are proven to be positive everywhere."""
        return self.refuted + self.undecided == 0

    def __repr__(self) -> str:
        return (f"<hexhex.Quality: {len(self.scaled_jacobians)} cells, scaled Jacobian "
                f"{self.minimum:.3f} to mean {self.mean:.3f}, {self.positive} positive everywhere>")


@dataclasses.dataclass(frozen=True)
class ImproveReport:
    """Report of an improvement. Lengths are in diagonals of the surface's bounding box."""

    before: Quality
    after: Quality
    not_positive: npt.NDArray[np.uint64]  #: cells that are not certified at the end, ascending
    far_cells: npt.NDArray[np.uint64]  #: boundary more than 1e-3 from the surface at the end
    far_cells_before: int  #: number of such cells before
    diagonal: float
    from_mesh_before: float  #: maximum distance from the mesh boundary to the object's
    from_surface_before: float  #: maximum distance from the object's boundary to the mesh's
    from_mesh_after: float
    from_surface_after: float
    inner_distance_before: float  #: of tagged and interface faces inside, from such triangles
    inner_distance_after: float
    free_vertices: int
    patch_vertices: int  #: vertices that slide on the surface
    curve_vertices: int  #: vertices that slide on curves
    fixed_vertices: int  #: vertices that do not move
    tagged_vertices: int  #: fixed vertices with a tag
    boundary_vertices: int  #: fixed only by fix_boundary; the other fixed ones are corners
    moved_vertices: int
    largest_move: float
    mean_move: float  #: mean over the moved vertices
    off_surface: int  #: vertices that used the slack
    off_creases: int  #: vertices that left creases because nothing else made cells good
    added_cells: int  #: cells of a pillow, last in the mesh and not included in ``before``
    curve_length: float  #: total length of the object's sharp and tagged edges
    curves_followed: float  #: share of that length that mesh edges follow
    snapped_curves: int  #: curve segments to which edges were snapped
    #: cells that share two adjacent faces with another cell: one of the two is never positive
    cannot_be_positive: npt.NDArray[np.uint64]
    paired_vertices: int  #: vertices fixed only because of such cells
    worst_cell: int  #: the cell with the least scaled Jacobian
    worst_held_by: str  #: "neighbours", "surface", "curve", "corner", "held vertex", "shared faces"
    worst_tagged: bool  #: whether that curve or corner has a tag
    worst_vertex: int  #: the vertex at its worst corner
    worst_angle: float  #: there, between two of its boundary faces, in degrees; 0 if there are none
    seconds: float


@dataclasses.dataclass(frozen=True)
class WayReport:
    """Outcome of one method and the criteria for its mesh."""

    method: str  #: "frames" or "polycube"
    has_mesh: bool
    refusal: str  #: why there is no mesh; empty if there is one, or if none was needed
    certified: bool  #: whether all cells are positive
    minimum: float  #: minimum scaled Jacobian
    distance: float  #: between the boundaries, in diagonals
    curves_followed: float  #: share of the length of sharp edges
    merit: float  #: 0 to 1 for a certified mesh; otherwise -1


@dataclasses.dataclass(frozen=True)
class FillReport:
    """How a mesher filled a surface or STEP file with tets."""

    mesher: str  #: including its version, if known
    tet_size: float  #: requested edge length; 0 for a STEP file if the mesher chose it
    tets: int
    triangles: int  #: of a surface, like the following
    bodies: int  #: each filled separately
    voids: int  #: inside the bodies
    volume: float  #: enclosed by the surface
    filled_volume: float  #: of the tets
    flat_triangles: int  #: removed first, as they have no area


@dataclasses.dataclass(frozen=True)
class MeshedPart:
    """Result of hexhex.mesh()."""

    mesh: Mesh
    map: Map  #: an integer-grid map, to which the generators of the mesh refer
    shape: ShapeReport
    quantization: QuantizeReport
    verification: VerifyReport  #: done before vertices moved
    improvement: ImproveReport
    ways: list[WayReport]  #: with the method "auto": both methods
    why: str  #: with the method "auto": why this mesh was chosen
    tags_released: bool  #: vertices could leave tagged edges to make cells positive
    missing_curves: int  #: segments of tagged curves for which no mesh edges were found
    #: dimension, tag and name of regions and surfaces of the part that no cell or quad has
    missing_groups: list[tuple[int, int, str]]
    stages: list[tuple[str, float]]  #: name and seconds
    filled: FillReport | None  #: how a surface or STEP file was filled with tets

    @property
    def all_positive(self) -> bool:
        """Whether all cells are proven to be positive everywhere."""
        return self.improvement.after.all_positive

    def __repr__(self) -> str:
        return (f"<hexhex.MeshedPart: {len(self.mesh.cells)} cells by {self.shape.method}, scaled "
                f"Jacobian at least {self.improvement.after.minimum:.3f}, "
                f"{len(self.improvement.not_positive)} not positive>")


# Pickle handles of the library by their arrays. Everything else is a plain object.
_of_hexes = operator.attrgetter("generator_tet", "generator_corners", "feature_vertices",
                                "feature_edges", "feature_quads", "regions", "tag_names")
copyreg.pickle(_hexhex.Mesh, lambda h: (_hexhex.Mesh, (h.points, h.cells, *_of_hexes(h))))
copyreg.pickle(_hexhex.LagrangeMesh, lambda h: (
    _hexhex.LagrangeMesh, (h.order, h.points, h.nodes, h.vertex_count, *_of_hexes(h),
                           h.straightened_cells)))
copyreg.pickle(_hexhex.PiecewiseMesh, lambda h: (
    _hexhex.PiecewiseMesh, (h.mesh, h.arcs, h.patches)))


class PartNeighbour(NamedTuple):
    """Interface between a part and one of its neighbours; the lists of both sides have the same
    order."""

    part: int
    vertices: Indices  #: local, ascending, uint32 of shape (n,)
    faces: npt.NDArray[np.uint64]  #: (m, 3): own cell, its side, global number of the other


@dataclasses.dataclass(frozen=True)
class MeshPart:
    """One part of a mesh from extract_parts(). Numbers are local unless called global: those refer
    to the undivided mesh."""

    mesh: Mesh  #: own vertices and cells first, then those of ghosts
    part: int
    own_points: int
    own_cells: int
    global_points: npt.NDArray[np.uint64]  #: per vertex
    global_cells: npt.NDArray[np.uint64]  #: per cell
    point_owners: Indices  #: per vertex: the smallest part with a cell at it
    ghost_parts: Indices  #: per ghost: the part that owns it
    ghost_layers: Indices  #: per ghost: its layer, starting at 1
    neighbours: list[PartNeighbour]  #: ascending by part

    @classmethod
    def _of(cls, values: tuple[Any, ...]) -> MeshPart:
        mesh, *others, neighbours = values
        fields: list[Any] = [Mesh._from_handle(mesh), *others,
                             [PartNeighbour(*neighbour) for neighbour in neighbours]]
        return cls(*fields)
