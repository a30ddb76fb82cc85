"""Conversion of meshes and maps from and to VTK, PyVista and meshio, which are imported on first
use. Arrays have the same names as in .vtu files (docs/user/formats.md)."""

from __future__ import annotations

import dataclasses
import re
import sys
from typing import TYPE_CHECKING, Any

import numpy as np

from ._errors import ArgumentError

if TYPE_CHECKING:
    import numpy.typing as npt

    from ._types import BaseComplex, Features, Map, Mesh

    Arrays = dict[str, npt.NDArray[Any]]

TETRA, HEXAHEDRON, LAGRANGE_HEXAHEDRON = 10, 12, 72  # VTK cell types


@dataclasses.dataclass(frozen=True)
class Grid:
    """Points, cells of one type, and named arrays; the rows of a feature array are vertices and a
    tag."""

    points: npt.NDArray[np.float64]
    cells: npt.NDArray[Any]
    of_points: Arrays
    of_cells: Arrays
    of_field: Arrays


def _features(features: Features, faces: str, points: int, grid_points: Arrays,
              grid_field: Arrays) -> None:
    if len(features.vertices):
        tags = np.zeros(points, dtype=np.int32)
        tags[features.vertices[:, 0]] = features.vertices[:, 1]
        grid_points["feature_vertex"] = tags
    if len(features.edges):
        grid_field["feature_edges"] = features.edges
    if len(features.faces):
        grid_field[faces] = features.faces
    if features.names:
        grid_field["named_tags"] = np.array(list(features.names), dtype=np.int32)
        texts = "".join(name + "\0" for name in features.names.values())
        grid_field["tag_names"] = np.array(list(texts.encode()), dtype=np.uint8)


def grid_of_mesh(mesh: Mesh, quality: bool) -> Grid:
    """Converts a mesh, with all its known data."""
    of_points: Arrays = {}
    of_cells: Arrays = {}
    of_field: Arrays = {}
    if len(mesh.generator_tet):
        of_points.update(generator_tet=mesh.generator_tet, generator_kind=mesh.generator_kind,
                         generator_corners=mesh.generator_corners)
    if quality and len(mesh.cells):
        of_cells["scaled_jacobian"] = mesh._scaled_jacobians()
    if len(mesh.regions):
        of_cells["region"] = mesh.regions
    _features(mesh.features, "feature_quads", len(mesh.points), of_points, of_field)
    return Grid(mesh.points, mesh.cells, of_points, of_cells, of_field)


def grid_of_map(map: Map) -> Grid:
    """Converts a map; its parameters become the cell array igm with 12 components."""
    of_points: Arrays = {}
    of_cells: Arrays = {"igm": map.igm.reshape(len(map.igm), 12)}
    of_field: Arrays = {}
    if len(map.regions):
        of_cells["region"] = map.regions
    _features(map.features, "feature_triangles", len(map.points), of_points, of_field)
    return Grid(map.points, map.tets, of_points, of_cells, of_field)


def _known(names: Arrays, name: str, count: int, width: int) -> npt.NDArray[Any] | None:
    """Returns an array if it holds integers in this number of rows."""
    array = names.get(name)
    fits = (array is not None and array.dtype.kind in "iu" and len(array) == count
            and array.shape[1:] == ((width,) if width else ()))
    return array if fits else None


def _tags_of(grid: Grid, faces: str, corners: int) -> dict[str, Any]:
    """Returns arguments for Features."""
    vertex = _known(grid.of_points, "feature_vertex", len(grid.points), 0)
    tagged = None
    if vertex is not None and vertex.any():
        found = np.flatnonzero(vertex)
        tagged = np.column_stack((found, vertex[found])).astype(np.int32)
    rows: dict[str, Any] = {"vertices": tagged, "corners": corners}
    for argument, name, width in (("edges", "feature_edges", 3), ("faces", faces, corners + 1)):
        array = grid.of_field.get(name)
        rows[argument] = None if array is None else np.reshape(array, (-1, width))
    rows["names"] = _names_of(grid.of_field)
    return rows


def _names_of(of_field: Arrays) -> dict[tuple[int, int], str]:
    texts, tags = of_field.get("tag_names"), of_field.get("named_tags")
    if texts is None or tags is None:
        return {}
    if texts.dtype.kind == "U":  # as PyVista reads them from .vtu files
        names = [str(text) for text in texts]
    else:
        names = bytes(texts.astype(np.uint8)).decode().split("\0")[:-1]
    rows = np.reshape(tags, (-1, 2)).tolist()
    return {(dimension, tag): name for (dimension, tag), name in zip(rows, names)}


def mesh_of_grid(grid: Grid) -> Mesh:
    """The inverse of grid_of_mesh()."""
    from ._types import Features, Mesh

    count = len(grid.points)
    tet = _known(grid.of_points, "generator_tet", count, 0)
    corners = _known(grid.of_points, "generator_corners", count, 0)
    if tet is None or corners is None:
        tet = corners = None
    return Mesh(grid.points, grid.cells, generator_tet=tet, generator_corners=corners,
                features=Features(**_tags_of(grid, "feature_quads", 4)),
                regions=_known(grid.of_cells, "region", len(grid.cells), 0))


def map_of_grid(grid: Grid, name: str) -> Map:
    """The inverse of grid_of_map(). The array may also be a point array with three components."""
    from ._types import Features, Map

    igm = grid.of_cells.get(name)
    of_point = grid.of_points.get(name)
    if igm is not None and igm.ndim > 1 and igm[0:1].size in (0, 12):
        igm = igm.reshape(-1, 4, 3)
    elif of_point is not None and of_point.shape[1:] == (3,):
        igm = of_point[grid.cells]  # a single chart
    else:
        known = ", ".join(sorted({*grid.of_cells, *grid.of_points})) or "none"
        raise ArgumentError(
            f'There is no map in an array "{name}": it takes one of cells with 12 components, or one '
            f"of points with 3. The arrays are: {known}.", "InvalidArgument")
    return Map(grid.points, grid.cells, igm,
               features=Features(**_tags_of(grid, "feature_triangles", 3)),
               regions=_known(grid.of_cells, "region", len(grid.cells), 0))


def none_of(what: str, where: str) -> ArgumentError:
    """The error for a missing type of cells."""
    return ArgumentError(f"The {where} has no {what}.", "InvalidArgument")


# meshio ---------------------------------------------------------------------------------------

def to_meshio(grid: Grid, name: str) -> Any:
    """Creates a meshio.Mesh with cells of one type, and the arrays of points and cells."""
    import meshio

    # Some writers of meshio require signed indices.
    return meshio.Mesh(grid.points, [(name, grid.cells.astype(np.int64))],
                       point_data=grid.of_points,
                       cell_data={key: [array] for key, array in grid.of_cells.items()})


def from_meshio(mesh: Any, name: str, what: str) -> Grid:
    """Combines all blocks of a type, with the cell arrays of these blocks."""
    blocks = [i for i, block in enumerate(mesh.cells) if block.type == name]
    if not blocks:
        raise none_of(what, "mesh")
    of_cells = {key: np.concatenate([np.asarray(lists[i]) for i in blocks])
                for key, lists in mesh.cell_data.items()}
    return Grid(np.asarray(mesh.points, dtype=np.float64),
                np.concatenate([np.asarray(mesh.cells[i].data) for i in blocks]),
                {key: np.asarray(array) for key, array in mesh.point_data.items()}, of_cells, {})


_OWN_SETS = re.compile(r"boundary|hexahedra|patch_\d+|region_m?\d+|curve_m?\d+|surface_m?\d+")


def _tag_in(name: str) -> int | None:
    """7 for "surface_7", -7 for "surface_m7"; 0 for names that mean no tag; None for other
    names."""
    if not _OWN_SETS.fullmatch(name):
        return None
    word, _, number = name.partition("_")
    return 0 if word in ("boundary", "hexahedra", "patch") else int(number.replace("m", "-"))


def meshio_of_mesh(mesh: Mesh, patch_angle: float) -> Any:
    """Converts the hexahedra, then quads and lines, with their groups as cell sets."""
    import meshio

    grid, f = grid_of_mesh(mesh, False), mesh.features
    patches = mesh.boundary_patches(patch_angle)
    boundary = np.concatenate([np.empty((0, 4), dtype=np.uint32), *(p.quads for p in patches)])
    at_boundary = {tuple(sorted(quad)) for quad in boundary.tolist()}
    inside = [i for i, quad in enumerate(f.faces[:, :4].tolist())
              if tuple(sorted(quad)) not in at_boundary]
    tags = [np.full(len(p.quads), p.tag, dtype=np.int32) for p in patches]
    blocks = [("hexahedron", mesh.cells, mesh.regions if len(mesh.regions) else
               np.zeros(len(mesh.cells), dtype=np.int32), 3, "region"),
              ("quad", np.concatenate((boundary, f.faces[inside, :4])),
               np.concatenate((*tags, f.faces[inside, 4])), 2, "surface"),
              ("line", f.edges[:, :2], f.edges[:, 2], 1, "curve")]
    blocks = [block for block in blocks if len(block[1]) or block[0] == "hexahedron"]
    sets: dict[str, list[Any]] = {}

    def add(name: str, block: int, rows: Any) -> None:
        own = sets.setdefault(name, [np.empty(0, dtype=np.int64) for _ in blocks])
        own[block] = np.concatenate((own[block], rows)).astype(np.int64)

    for number, (kind, _, values, dimension, word) in enumerate(blocks):
        begin = 0
        for patch in patches if kind == "quad" else []:  # with their names in files
            add(patch.name, number, np.arange(begin, begin + len(patch.quads)))
            begin += len(patch.quads)
        for tag in np.unique(values[begin:]):
            named = next((p.name for p in patches if kind == "quad" and p.tag == tag), None)
            given = named or f.names.get((dimension, int(tag)))
            if tag:
                add(given or f"{word}_{tag}".replace("-", "m"), number,
                    begin + np.flatnonzero(values[begin:] == tag))
    of_cells = {name: [block[2] if (block[3] == 3) == (name == "region") else np.zeros_like(block[2])
                       for block in blocks] for name in ("region", "tag")}
    return meshio.Mesh(grid.points, [(block[0], block[1].astype(np.int64)) for block in blocks],
                       point_data=grid.of_points, cell_data=of_cells, cell_sets=sets)


def _sets_of(mesh: Any, kind: str, numbers: Any) -> tuple[Any, dict[int, str]] | None:
    """Returns a tag for each element of a kind, according to the sets that contain it, and names;
    None without sets.

    Args:
        numbers: numbers of the elements, which become the tag of a set if all its elements have the
            same; or None.
    """
    begins, total = {}, 0
    for i, block in enumerate(mesh.cells):
        if block.type == kind:
            begins[i] = total
            total += len(block.data)
    tags, names, found = np.zeros(total, dtype=np.int32), {}, False
    known = {name: _tag_in(name) for name in mesh.cell_sets}
    free = iter(sorted(set(range(1, len(known) + 1)) - set(known.values())))
    for name, lists in mesh.cell_sets.items():
        rows = [begins[i] + np.asarray(lists[i], dtype=np.int64) for i in begins
                if lists[i] is not None and len(lists[i])]
        if not rows or name.startswith("gmsh:"):
            continue
        chosen, tag, found = np.concatenate(rows), known[name], True
        if tag is None:
            same = [] if numbers is None else np.unique(numbers[chosen]).tolist()
            tag = int(same[0]) if len(same) == 1 and same[0] else next(free)
            names[tag] = name
        tags[chosen] = tag
    return (tags, names) if found else None


def mesh_of_meshio(mesh: Any) -> Mesh:
    """The inverse of meshio_of_mesh(), also for files from other programs."""
    from ._types import Features, Mesh

    made = mesh_of_grid(from_meshio(mesh, "hexahedron", "hexahedra"))
    names, rows = {}, {}
    for kind, dimension, arrays in (("hexahedron", 3, ("region",)), ("quad", 2, ("tag",)),
                                    ("line", 1, ("tag",))):
        blocks = [i for i, block in enumerate(mesh.cells) if block.type == kind]
        numbers = next((np.concatenate([np.asarray(mesh.cell_data[name][i]) for i in blocks])
                        for name in (*arrays, "gmsh:physical", "medit:ref")
                        if blocks and name in mesh.cell_data), None)
        tags, named = _sets_of(mesh, kind, numbers) or (numbers, {})
        if not blocks or tags is None:
            continue
        elements = np.concatenate([np.asarray(mesh.cells[i].data) for i in blocks])
        for name, value in mesh.field_data.items():  # Gmsh's physical names: tag and dimension
            if np.shape(value) == (2,) and value[1] == dimension and (tags == value[0]).any():
                names[dimension, int(value[0])] = name
        names.update({(dimension, tag): name for tag, name in named.items()})
        rows[kind] = np.column_stack((elements, tags))[tags != 0].astype(np.int32)
        if kind == "hexahedron":
            rows[kind] = tags.astype(np.int32) if tags.any() else None
    f = made.features
    return Mesh(made.points, made.cells, generator_tet=made.generator_tet,
                generator_corners=made.generator_corners, regions=rows.get("hexahedron"),
                features=Features(f.vertices, rows.get("line"), rows.get("quad"), corners=4, names=names))


# VTK and PyVista ------------------------------------------------------------------------------

def _vtk_array(values: npt.NDArray[Any], name: str = "") -> Any:
    """Creates a VTK array that shares the memory and keeps it alive."""
    from vtkmodules.util.numpy_support import numpy_to_vtk

    array = numpy_to_vtk(np.ascontiguousarray(values), deep=False)
    array.SetName(name)
    return array


def _vtk_cells(cells: npt.NDArray[Any]) -> Any:
    """Creates a vtkCellArray. VTK supports signed 32-bit indices; larger ones are copied."""
    from vtkmodules.vtkCommonCore import vtkTypeInt32Array, vtkTypeInt64Array
    from vtkmodules.vtkCommonDataModel import vtkCellArray

    array = vtkCellArray()
    if not len(cells):
        return array
    small = cells.size < 2**31 and cells.dtype == np.uint32
    kind, dtype = (vtkTypeInt32Array, np.int32) if small else (vtkTypeInt64Array, np.int64)
    flat = np.ascontiguousarray(cells).reshape(-1)
    corners = flat.view(np.int32) if small else flat.astype(np.int64)
    ends = np.arange(0, cells.size + 1, cells.shape[1], dtype=dtype)
    arrays = []
    for values in (ends, corners):
        arrays.append(kind())
        arrays[-1].SetVoidArray(values, len(values), 1)
        arrays[-1].__dict__["_numpy_reference"] = values  # keeps it alive
    array.SetData(*arrays)
    return array


def to_vtk(grid: Grid, cell_type: int) -> Any:
    """Creates a vtkUnstructuredGrid with cells of one type on the same memory; requires only
    vtk."""
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid

    made = vtkUnstructuredGrid()
    places = vtkPoints()
    if len(grid.points):
        places.SetData(_vtk_array(grid.points))
    made.SetPoints(places)
    made.SetCells(cell_type, _vtk_cells(grid.cells))
    for arrays, data in ((grid.of_points, made.GetPointData()), (grid.of_cells, made.GetCellData()),
                         (grid.of_field, made.GetFieldData())):
        for name, values in arrays.items():
            data.AddArray(_vtk_array(values, name))
    return made


def to_pyvista(grid: Grid, cell_type: int) -> Any:
    """Creates the same as a pyvista.UnstructuredGrid."""
    import pyvista

    from . import _accessor  # noqa: F401  enables grid.hexhex

    made = pyvista.wrap(to_vtk(grid, cell_type))
    if "scaled_jacobian" in grid.of_cells:
        made.set_active_scalars("scaled_jacobian", preference="cell")
    return made


def from_pyvista(given: Any, cell_type: int, what: str) -> Grid:
    """Extracts the cells of one type from a PyVista or VTK data set."""
    import pyvista

    data = pyvista.wrap(given)
    if not isinstance(data, pyvista.UnstructuredGrid):
        if not isinstance(data, pyvista.DataSet):
            raise ArgumentError(f"A {type(given).__name__} is no data set of cells.",
                                "InvalidArgument")
        data = data.cast_to_unstructured_grid()
    chosen = data.celltypes == cell_type
    if not chosen.any():
        raise none_of(what, "data set")

    def arrays(of: Any, rows: Any = slice(None)) -> Arrays:
        return {name: np.asarray(of[name])[rows] for name in of.keys()
                if np.asarray(of[name]).dtype.kind in "iufU"}

    return Grid(np.asarray(data.points, dtype=np.float64), data.cells_dict[cell_type],
                arrays(data.point_data), arrays(data.cell_data, chosen), arrays(data.field_data))


# Corners of the edges along each axis, around the cell; and of the faces across it, the lower first.
_EDGES = np.array([[[0, 1], [3, 2], [7, 6], [4, 5]], [[0, 3], [1, 2], [5, 6], [4, 7]],
                   [[0, 4], [1, 5], [2, 6], [3, 7]]])
_SIDES = np.array([[[0, 3, 7, 4], [1, 2, 6, 5]], [[0, 1, 5, 4], [3, 2, 6, 7]], [[0, 1, 2, 3], [4, 5, 6, 7]]])


def _middles(points: npt.NDArray[np.float64], elements: npt.NDArray[Any]) -> tuple[Any, Any]:
    """The middle of each of the different elements, rows of vertices; and per element, which one it is."""
    rows = np.sort(elements.reshape(-1, elements.shape[-1]), axis=1)
    unique, which = np.unique(rows, axis=0, return_inverse=True)
    return points[unique].mean(axis=1), which.reshape(elements.shape[:-1])


def complex_to_pyvista(parts: BaseComplex) -> Any:
    """What BaseComplex.to_pyvista() says."""
    import pyvista

    points, cells = np.array(parts.mesh.points), np.array(parts.mesh.cells)
    number = np.repeat(np.arange(len(cells)), 3)  # of the cell, once for each axis

    def add(to: Any, **arrays: Any) -> None:
        for name, array in arrays.items():
            if len(array):  # PyVista takes no empty ones
                to[name] = array

    def surfaces(nodes: Any, quads: Any, **arrays: Any) -> Any:
        made = pyvista.PolyData.from_regular_faces(nodes, quads)
        add(made.cell_data, **arrays)
        return made

    def lines(nodes: Any, polylines: Any, **arrays: Any) -> Any:
        made = pyvista.PolyData(nodes)
        made.verts = np.empty(0, dtype=np.int64)
        made.lines = np.concatenate([[len(line), *line] for line in polylines] or [[]]).astype(np.int64)
        add(made.cell_data, **arrays)
        return made

    grid = parts.mesh.to_pyvista()
    add(grid.cell_data, block=parts.cell_blocks, sheets=parts.cell_sheets, chords=parts.cell_chords)
    of_edges, edges = _middles(points, cells[:, _EDGES])  # (m, 3, 4)
    of_faces, faces = _middles(points, cells[:, _SIDES])  # (m, 3, 2)
    order = np.argsort(faces.ravel(), kind="stable")
    twice = np.flatnonzero(np.diff(faces.ravel()[order]) == 0)
    both = np.stack((order[twice], order[twice + 1]), axis=1)  # places of inner faces in two cells
    blocks = parts.cell_blocks[both // 6]
    apart = blocks[:, 0] != blocks[:, 1]
    made = pyvista.MultiBlock()
    made["cells"] = grid
    made["walls"] = surfaces(points, cells[:, _SIDES].reshape(-1, 4)[both[apart, 0]], blocks=blocks[apart])
    made["sheets"] = surfaces(of_edges, edges.reshape(-1, 4), sheet=parts.cell_sheets.ravel(), cell=number)
    made["chords"] = lines(of_faces, faces.reshape(-1, 2), chord=parts.cell_chords.ravel(), cell=number)
    made["singular_curves"] = lines(points, [curve.vertices for curve in parts.curves],
                                    valence=np.array([curve.valence for curve in parts.curves], dtype=int),
                                    boundary=np.array([curve.boundary for curve in parts.curves], dtype=bool))
    irregular = [(kind, vertex) for kind, each in enumerate(parts.irregular) for vertex in each.vertices]
    kinds, vertices = np.array(irregular, dtype=int).reshape(-1, 2).T
    made["irregular_vertices"] = pyvista.PolyData(points[vertices])
    add(made["irregular_vertices"].point_data, kind=kinds, vertex=vertices)
    return made


def vtk_order(p: int, *, row_by_row: bool = False) -> npt.NDArray[np.int64]:
    """Returns the nodes of a cell of order p in VTK_LAGRANGE_HEXAHEDRON order (VTK 9.1 and later).
    With row_by_row, upright edges come row by row, as before VTK 9 and in the .vtu files that
    meshio reads and writes."""
    inner = range(1, p)
    nodes = [(0, 0, 0), (p, 0, 0), (p, p, 0), (0, p, 0), (0, 0, p), (p, 0, p), (p, p, p), (0, p, p)]
    for k in (0, p):
        nodes += [(i, 0, k) for i in inner] + [(p, j, k) for j in inner]
        nodes += [(i, p, k) for i in inner] + [(0, j, k) for j in inner]
    for i, j in ((0, 0), (p, 0), (0, p), (p, p)) if row_by_row else ((0, 0), (p, 0), (p, p), (0, p)):
        nodes += [(i, j, k) for k in inner]
    nodes += [(i, j, k) for i in (0, p) for k in inner for j in inner]
    nodes += [(i, j, k) for j in (0, p) for k in inner for i in inner]
    nodes += [(i, j, k) for k in (0, p) for j in inner for i in inner]
    nodes += [(i, j, k) for k in inner for j in inner for i in inner]
    return np.array([i + (p + 1) * (j + (p + 1) * k) for i, j, k in nodes])


class _AsGrid:
    """Replaces a VTK class in PyVista's table of wrappers; creates a grid instead."""

    def __new__(cls, mesh: Any) -> Any:
        return mesh.to_pyvista()


class Wrappable:
    """Makes an object acceptable to pyvista.wrap(), which asks for the name of a VTK class and
    looks it up."""

    def GetClassName(self) -> str:
        """Returns a name that PyVista finds."""
        pyvista = sys.modules.get("pyvista")
        if pyvista is not None:
            pyvista._wrappers.setdefault("hexhex", _AsGrid)
        return "hexhex"
