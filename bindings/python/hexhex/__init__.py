"""Hexahedral meshes from integer-grid maps.

>>> import hexhex
>>> map = hexhex.generate("sphere", cells=4)
>>> mesh = hexhex.extract(map, scale=2)
>>> mesh
<hexhex.Mesh: 3584 cells, 3817 points>
>>> bool(hexhex.verify(map, mesh, scale=2))
True

All functions except quantize() and mesh() may be called from several threads at once. They release
the GIL while they work, and Ctrl-C cancels them.
"""

from __future__ import annotations

import html
import importlib.util
import os
import pathlib
import sys
import tempfile
import warnings
from typing import TYPE_CHECKING, Any, Callable, Optional, Protocol, TypeVar, Union

import numpy as np

from . import _compare, _hexhex, _npz
from ._errors import (
    ArgumentError,
    CancelledError,
    FileError,
    HexhexError,
    InternalError,
    MapError,
    MemoryExhaustedError,
    make,
)
from ._progress import TqdmProgress
from ._types import (
    Arcs,
    BaseComplex,
    BoundaryPatch,
    CheckReport,
    Defect,
    Extraction,
    Features,
    FileFormat,
    FillReport,
    Hole,
    ImproveReport,
    IrregularVertices,
    LagrangeMesh,
    Map,
    MapStructure,
    Mesh,
    MeshPart,
    MeshSummary,
    MeshedPart,
    PartNeighbour,
    PartialMesh,
    Patches,
    Quality,
    QuantizeReport,
    RefutedCell,
    RepairReport,
    RepairedRegion,
    SampleKind,
    SeamlessReport,
    ShapeReport,
    SingularCurve,
    VerifyItem,
    VerifyReport,
    WayReport,
    _floats,
    _generators,
    _indices,
    _whole,
)

if TYPE_CHECKING:
    import numpy.typing as npt

    Progress = Callable[[str, float], object]
    Path = Union[str, "os.PathLike[str]"]

AnyMesh = TypeVar("AnyMesh", Mesh, LagrangeMesh)

__version__: str = _hexhex.version()

__all__ = [
    "Arcs", "ArgumentError", "BaseComplex", "BoundaryPatch", "CancelledError", "CheckReport",
    "Defect", "Extraction", "Extractor", "Features", "FileError", "FileFormat", "FillReport",
    "HexhexError",
    "Hole", "ImproveReport", "InternalError", "IrregularVertices", "LagrangeMesh", "Map",
    "MapError", "MapStructure", "MemoryExhaustedError", "Mesh", "MeshPart", "MeshSink",
    "MeshSummary", "MeshWriter", "MeshedPart", "PartNeighbour", "PartialMesh", "Patches",
    "Quality", "QuantizeReport", "RefutedCell", "RepairReport", "RepairedRegion", "SampleKind",
    "SeamlessReport", "ShapeReport", "SingularCurve", "SummarySink", "TqdmProgress",
    "VerifyItem", "VerifyReport", "ViewPage", "WayReport", "can_quantize", "can_repair",
    "check", "defect_kinds", "examine_seamless", "extract", "extract_partial", "extract_parts",
    "extract_parts_to_file", "extract_to", "extract_to_file", "formats", "generate",
    "holds_curved", "improve", "map_from_flags", "map_from_pair", "map_from_tets",
    "map_structure", "mesh", "quality", "quantize", "read", "read_curved", "read_flags",
    "read_map", "read_mesh", "read_pair", "read_tets", "read_to", "repair", "require_format",
    "same_mesh", "sample_kinds", "scaled_jacobian", "summarize", "verify", "view", "write",
]


if sys.modules.get("pyvista") is not None:
    from . import _accessor  # noqa: F401  in case nothing else registers it with PyVista


def _find_highs() -> None:
    """Points the extension to the HiGHS library of the package highsbox, if it is installed."""
    box = importlib.util.find_spec("highsbox")
    if "HEXHEX_HIGHS" in os.environ or box is None or box.origin is None:
        return
    library = pathlib.Path(box.origin).parent / "highs_dist/lib/libhighs.so"
    if library.exists():
        os.environ["HEXHEX_HIGHS"] = str(library)


_find_highs()


def _map_of(points: Map | npt.ArrayLike, tets: npt.ArrayLike | None,
            igm: npt.ArrayLike | None) -> Map:
    if isinstance(points, Map):
        if tets is not None or igm is not None:
            raise ArgumentError("Give a map alone, or points, tets and igm.", "InvalidArgument")
        return points
    if tets is None or igm is None:
        raise ArgumentError("Give a map, or points, tets and igm.", "InvalidArgument")
    return Map(points, tets, igm)


def _one_of(names: tuple[str, ...], name: str, what: str) -> str:
    if name not in names:
        *others, last = (f'"{each}"' for each in names)
        raise ArgumentError(f'There is no {what} "{name}". Choose {", ".join(others)} or {last}.',
                            "InvalidArgument")
    return name


def _compression(how: bool | str) -> int:
    """As in the C++ library: 0 for none, 1 for zlib, 2 for LZ4."""
    if not isinstance(how, str):
        return int(bool(how))
    names = ("zlib", "lz4")
    return 1 + names.index(_one_of(names, how, "compression"))


def _options(scale: int, engine: str, tolerance: float, repair: bool, round: bool,
             curved_nodes: str = "blended") -> _hexhex.Options:
    _one_of(("atlas", "propeller"), engine, "engine")
    _one_of(("blended", "exact"), curved_nodes, "place of curved nodes")
    return _hexhex.Options(_whole(scale, "scale"), engine == "propeller", tolerance, repair, round,
                           curved_nodes == "exact")


def _threads(threads: Optional[int]) -> int:
    if threads is None:
        return 0
    threads = _whole(threads, "number of threads")
    if threads < 1:
        raise ArgumentError(f"The number of threads is {threads}. Choose it from 1, or None for "
                            "all cores.", "InvalidArgument")
    return threads


def extract(points: Map | npt.ArrayLike, tets: npt.ArrayLike | None = None,
            igm: npt.ArrayLike | None = None, *, scale: int = 1, threads: int | None = None,
            order: int = 1, curved_nodes: str = "blended", arcs: bool = False,
            patches: bool = False, repair: bool = False, round: bool = False,
            engine: str = "atlas", tolerance: float = 1e-2, quantize: bool = False,
            cells: float | None = None, edge_length: float | None = None,
            progress: Progress | None = None) -> Mesh:
    """Extracts the hexahedral mesh that an integer-grid map implies.

    Args:
        points: a Map, or positions: float64 of shape (n, 3).
        tets: 0-based vertices of each tet: integers of shape (m, 4).
        igm: parameters of the corners of each tet, in units of one hexahedron: float64 of shape
            (m, 4, 3) or (m, 12); or, for a map with a single chart, of the vertices, (n, 3).
        scale: factor for all parameters: yields scale**3 times as many cells.
        threads: number of threads; None for all cores. Does not affect the result, bit for bit.
        order: order of the cells, 1 to 9. Above 1, ``mesh.curved`` holds cells of that order in
            addition.
        curved_nodes: placement of their nodes. "blended": nodes on the surface lie where the map
            puts them, and all others are blended between these. Cells are positive wherever
            straight ones are; those that left the surface to achieve this are listed in
            ``mesh.curved.straightened_cells``. "exact": all nodes lie where the map puts
            them, and cells may fold over.
        arcs: store the exact shapes of edges in ``mesh.arcs``.
        patches: store the exact shapes of faces in ``mesh.patches``, and of edges in ``mesh.arcs``.
        repair: first repair a map with flipped or flat tets, which is an error otherwise: see
            ``mesh.repair`` and ``mesh.repaired_map``.
        round: if the map is repaired: first round coordinates that deviate from integers by up to
            0.1.
        engine: "atlas", or "propeller" for the algorithm of the paper; both yield the same mesh.
        tolerance: maximum violation of the integer conditions by the map, below 0.25.
        quantize: turn a seamless map into an integer-grid map first, like quantize(): see
            ``mesh.quantization`` and ``mesh.quantized_map``.
        cells, edge_length: target resolution of the quantization, as in quantize().
        progress: called with the name of the stage and its completed fraction in [0, 1], from any
            thread; a TqdmProgress shows a bar. An exception raised by it ends the extraction and
            propagates to the caller.

    Returns:
        The mesh, with ``mesh.statistics`` of the extraction and the tags and regions of the map.

    Raises:
        MapError: for the first violated condition, with its place.
        ArgumentError: for invalid shapes and types, and options out of range.
        MemoryExhaustedError: if there is not enough memory.
        KeyboardInterrupt: after Ctrl-C.

    >>> map = hexhex.generate("box", cells=2)
    >>> hexhex.extract(map.points, map.tets, map.igm).cells.shape
    (64, 8)
    >>> mesh = hexhex.extract(map, order=2, arcs=True)
    >>> mesh.curved, len(mesh.arcs), mesh.patches
    (<hexhex.LagrangeMesh: 64 cells of order 2>, 300, None)
    """
    given, made = _map_of(points, tets, igm), None
    if quantize:
        given, made = _quantize(given, cells=cells, edge_length=edge_length, threads=threads,
                                progress=progress)
    elif cells is not None or edge_length is not None:
        raise ArgumentError("The arguments cells and edge_length are of quantizations: add "
                            "quantize=True. An integer-grid map has a scale.", "InvalidArgument")
    arrays = given._arrays()
    last = (_options(scale, engine, tolerance, repair, round, curved_nodes), _threads(threads),
            progress)
    mesh = _assembled(
        order, arcs, patches, lambda: _hexhex.extract(arrays, *last),
        lambda: _hexhex.extract_piecewise(arrays, patches, *last),
        lambda: _hexhex.extract_lagrange(arrays, _whole(order, "order"), *last))
    mesh.quantization, mesh.quantized_map = made, given if quantize else None
    return mesh


def _assembled(order: int, arcs: bool, patches: bool, extract_straight: Callable[[], Any],
               extract_pieces: Callable[[], Any], extract_order: Callable[[], Any]) -> Mesh:
    """Assembles a mesh from what is requested; each function returns a handle and notes."""
    if arcs or patches:
        pieces, notes = extract_pieces()
        mesh = Mesh._from_handle(pieces.mesh, notes)
        mesh.arcs = Arcs._of(pieces)
        if patches:
            mesh.patches = Patches._of(pieces)
    if order != 1:
        curved, notes = extract_order()
        if not (arcs or patches):
            mesh = Mesh._from_handle(curved.straight(), notes)
        mesh.curved = LagrangeMesh._from_handle(curved)
    elif not (arcs or patches):
        handle, notes = extract_straight()
        mesh = Mesh._from_handle(handle, notes)
    return mesh


class MeshSink(Protocol):
    """Receives a mesh in pieces, in this order, from one thread at a time (any thread). An
    exception raised by a method ends the extraction and propagates to its caller."""

    def begin(self, points: int, cells: int, /) -> object:
        """Receives the numbers of points and cells of the whole mesh."""

    def points(self, first: int, points: Any, generator_tet: Any, generator_corners: Any,
               /) -> object:
        """Receives points, starting at number first: float64 (n, 3); and, as in Mesh, uint32 (n,),
        uint8 (n,)."""

    def cells(self, first: int, cells: Any, /) -> object:
        """Receives cells, starting at number first: uint32 (m, 8); uint64 beyond 2**32 - 2
        points."""

    def end(self) -> object:
        """Called after the last piece."""


def extract_to(sink: MeshSink, map: Map, *, scale: int = 1, threads: int | None = None,
               repair: bool = False, round: bool = False, tolerance: float = 1e-2,
               progress: Progress | None = None) -> Extraction:
    """Extracts the same mesh as extract(), bit for bit, but passes it on in pieces and never holds
    all of it in memory. Excludes tags and regions. Other arguments and errors are as in extract().

    >>> class Count:
    ...     total = 0
    ...     def begin(self, points, cells): pass
    ...     def points(self, first, points, generator_tet, generator_corners): pass
    ...     def cells(self, first, cells): self.total += len(cells)
    ...     def end(self): print(self.total)
    >>> extraction = hexhex.extract_to(Count(), hexhex.generate("sphere"), scale=2)
    3584
    """
    options = _options(scale, "atlas", tolerance, repair, round)
    return _extraction(_hexhex.extract_to(sink, map._arrays(), options, _threads(threads),
                                          progress))


def _extraction(notes: tuple[dict[str, Any], Any, Any]) -> Extraction:
    statistics, report, repaired = notes
    return Extraction(statistics, None if report is None else RepairReport._of(report),
                      None if repaired is None else Map._from_handle(repaired))


def extract_to_file(file: Path, map: Map, *, scale: int = 1, format: str | None = None,
                    threads: int | None = None, repair: bool = False, round: bool = False,
                    tolerance: float = 1e-2, progress: Progress | None = None) -> Extraction:
    """Extracts the same mesh to a file, .vtu, .mesh, .meshb, .vtk or .msh, which appears complete
    or not at all. Returns the same.

    Raises:
        FileError: if the file cannot be written; and as extract().

    >>> import pathlib, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = pathlib.Path(folder) / "large.vtu"
    ...     extraction = hexhex.extract_to_file(file, hexhex.generate("box"), scale=3)
    ...     hexhex.summarize(file).cells
    13824
    """
    options = _options(scale, "atlas", tolerance, repair, round)
    return _extraction(_hexhex.extract_to_file(
        os.fspath(file), map._arrays(), options, format or "", _threads(threads), progress))


def _check_partition(parts: int, ghosts: int, partition: str) -> None:
    _one_of(("curve", "metis", "scotch"), partition, "partition")
    if not 1 <= parts <= 1 << 20 or not 0 <= ghosts <= 16:
        raise ArgumentError(f"{parts} parts with {ghosts} layers of ghosts are out of range. Choose "
                            "1 to 1048576, and 0 to 16.", "InvalidArgument")


def extract_parts(map: Map, parts: int, *, ghosts: int = 0, partition: str = "curve",
                  verify: bool = False, scale: int = 1, threads: int | None = None,
                  repair: bool = False, round: bool = False, tolerance: float = 1e-2,
                  progress: Progress | None = None) -> list[MeshPart]:
    """Extracts the mesh of extract() in parts, for distributed programs. docs/user/parts.md describes
    the contents of a part.

    Args:
        parts: number of parts; some may be empty.
        ghosts: layers of cells of other parts around each part.
        partition: method that partitions the mesh: "curve"; "metis" or "scotch", if that library is
            installed.
        verify: whether to prove that each part belongs to the mesh of the map, like verify().
        scale, threads, repair, round, tolerance, progress: as in extract().

    Raises:
        ArgumentError: for numbers out of range, and if the library is missing; and as extract().

    >>> parts = hexhex.extract_parts(hexhex.generate("box"), 4)
    >>> [part.own_cells for part in parts]
    [128, 128, 128, 128]
    >>> here, there = parts[0], parts[parts[0].neighbours[0].part]
    >>> back = next(n for n in there.neighbours if n.part == here.part)
    >>> bool((here.global_points[here.neighbours[0].vertices]
    ...       == there.global_points[back.vertices]).all())
    True
    """
    _check_partition(parts, ghosts, partition)
    options = _options(scale, "atlas", tolerance, repair, round)
    return [MeshPart._of(values) for values in _hexhex.extract_parts(
        map._arrays(), parts, ghosts, partition, verify, options, _threads(threads), progress)]


def extract_parts_to_file(file: Path, map: Map, parts: int, *, ghosts: int = 0,
                          partition: str = "curve", verify: bool = False, scale: int = 1,
                          format: str | None = None, threads: int | None = None,
                          repair: bool = False, round: bool = False, tolerance: float = 1e-2,
                          progress: Progress | None = None) -> dict[str, Any]:
    """Extracts the same parts to files; docs/user/parts.md lists the formats. Keeps only one part at a
    time in memory. Returns the balance of the parts and the size of their interfaces.

    Raises:
        FileError: if the files cannot be written; and as extract_parts().

    >>> import pathlib, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = pathlib.Path(folder) / "box.pvtu"
    ...     summary = hexhex.extract_parts_to_file(file, hexhex.generate("box"), 4, ghosts=1)
    ...     summary["largest"], len(hexhex.read(file).cells)
    (128, 512)
    """
    _check_partition(parts, ghosts, partition)
    options = _options(scale, "atlas", tolerance, repair, round)
    return _hexhex.extract_parts_to_file(
        os.fspath(file), map._arrays(), parts, ghosts, partition, verify, options,
        format or "", _threads(threads), progress)


class MeshWriter:
    """Writes a file, .vtu, .mesh, .meshb, .vtk or .msh, for a mesh that arrives in pieces:
    begin(), points() in order, cells() in order, end(). The complete file appears at end(); a
    writer dropped earlier leaves nothing behind. Also a MeshSink.

    Raises:
        FileError: if the file cannot be written.
        ArgumentError: for calls in the wrong order, and vertices that do not exist.

    >>> import pathlib, tempfile
    >>> mesh = hexhex.extract(hexhex.generate("box"))
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = pathlib.Path(folder) / "box.vtu"
    ...     writer = hexhex.MeshWriter(file)
    ...     writer.begin(len(mesh.points), len(mesh.cells))
    ...     writer.points(0, mesh.points)
    ...     writer.cells(0, mesh.cells)
    ...     writer.end()
    ...     hexhex.read(file)
    <hexhex.Mesh: 512 cells, 729 points>
    """

    def __init__(self, file: Path, *, format: str | None = None) -> None:
        self._writer = _hexhex.MeshWriter(os.fspath(file), format or "")

    def begin(self, points: int, cells: int, /) -> None:
        """Sets the numbers of points and cells of the whole mesh."""
        if points < 0 or cells < 0:
            raise ArgumentError("A mesh cannot have fewer than none.", "InvalidArgument")
        self._writer.begin(points, cells)

    def points(self, first: int, points: npt.ArrayLike,
               generator_tet: npt.ArrayLike | None = None,
               generator_corners: npt.ArrayLike | None = None, /) -> None:
        """Writes points, starting at number first: float64 (n, 3); and, as in Mesh, uint32 (n,),
        uint8 (n,)."""
        places = _floats(points, (3,), "points")
        self._writer.points(first, places, *_generators(generator_tet, generator_corners,
                                                        len(places)))

    def cells(self, first: int, cells: npt.ArrayLike, /) -> None:
        """Writes cells, starting at number first: integers (m, 8)."""
        _cells_to(self._writer, first, cells)

    def end(self) -> None:
        """Completes the file, which appears now."""
        self._writer.end()


def _cells_to(sink: _hexhex.MeshWriter | _hexhex.SummarySink, first: int,
              cells: npt.ArrayLike) -> None:
    array = np.asarray(cells)
    if array.dtype == np.uint64 and array.ndim == 2 and array.shape[1] == 8:
        sink.cells64(first, np.ascontiguousarray(array))
    else:
        sink.cells(first, _indices(array, 8, "cells"))


class SummarySink:
    """A MeshSink that summarizes what it receives: result() then equals summarize() of the mesh.

    Raises:
        ArgumentError: for calls in the wrong order, and vertices that do not exist.

    >>> sink, map = hexhex.SummarySink(), hexhex.generate("box")
    >>> extraction = hexhex.extract_to(sink, map)
    >>> sink.result() == hexhex.summarize(hexhex.extract(map))
    True
    """

    def __init__(self) -> None:
        self._sink = _hexhex.SummarySink()
        self._ended = False

    def begin(self, points: int, cells: int, /) -> None:
        """Sets the numbers of points and cells of the whole mesh."""
        if points < 0 or cells < 0:
            raise ArgumentError("A mesh cannot have fewer than none.", "InvalidArgument")
        self._sink.begin(points, cells)

    def points(self, first: int, points: npt.ArrayLike, generator_tet: object = None,
               generator_corners: object = None, /) -> None:
        """Adds points, starting at number first: float64 (n, 3). Ignores generators."""
        self._sink.points(first, _floats(points, (3,), "points"), *_generators(None, None, 0))

    def cells(self, first: int, cells: npt.ArrayLike, /) -> None:
        """Adds cells, starting at number first: integers (m, 8)."""
        _cells_to(self._sink, first, cells)

    def end(self) -> None:
        """Completes the summary."""
        self._sink.end()
        self._ended = True

    def result(self) -> MeshSummary:
        """Returns the summary, after end(). Raises ArgumentError before."""
        if not self._ended:
            raise ArgumentError("The mesh has not ended yet.", "InvalidArgument")
        return MeshSummary(**self._sink.result())


def read_to(sink: MeshSink, file: Path, *, format: str | None = None, threads: int | None = None,
            progress: Progress | None = None) -> None:
    """Reads a hexahedral mesh and passes it on in pieces. A .vtu file with appended data, as
    written by this library, takes a few megabytes of memory. Raises FileError, and whatever the
    sink raises.

    >>> import pathlib, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = pathlib.Path(folder) / "large.vtu"
    ...     extraction = hexhex.extract_to_file(file, hexhex.generate("box"), scale=3)
    ...     hexhex.read_to(hexhex.MeshWriter(file.with_suffix(".mesh")), file)
    ...     hexhex.summarize(file) == hexhex.summarize(file.with_suffix(".mesh"))
    True
    """
    _hexhex.read_to(sink, os.fspath(file), format or "", _threads(threads), progress)


class Extractor:
    """A prepared map for extracting several meshes: work that does not depend on the scale is done
    once. Serves one call at a time; another call, even from a progress function, is an
    ArgumentError.

    >>> extractor = hexhex.Extractor(hexhex.generate("box", cells=2))
    >>> [len(extractor.extract(scale=s).cells) for s in (1, 2, 3)]
    [64, 512, 1728]
    >>> extractor.cells
    64

    Args:
        points, tets, igm: as in extract(); must not change during the lifetime of the extractor.
        tolerance, threads, progress: as in extract().
        max_scale: the largest scale that will be requested, times the order.

    Raises:
        The errors of extract().
    """

    def __init__(self, points: Map | npt.ArrayLike, tets: npt.ArrayLike | None = None,
                 igm: npt.ArrayLike | None = None, *, tolerance: float = 1e-2, max_scale: int = 64,
                 threads: int | None = None, progress: Progress | None = None) -> None:
        self._extractor = _hexhex.Extractor(_map_of(points, tets, igm)._arrays(), tolerance,
                                            _whole(max_scale, "largest scale"), _threads(threads),
                                            progress)

    @property
    def cells(self) -> int:
        """Number of cells at scale 1; there are scale**3 times as many at other scales."""
        return self._extractor.cells()

    def extract(self, *, scale: int = 1, threads: int | None = None, order: int = 1,
                curved_nodes: str = "blended", arcs: bool = False, patches: bool = False,
                engine: str = "atlas", progress: Progress | None = None) -> Mesh:
        """Extracts the mesh at a scale, which is identical to that of hexhex.extract(). The scale
        times the order must not exceed ``max_scale``."""
        last = (_options(scale, engine, 0, False, False, curved_nodes), _threads(threads), progress)
        return _assembled(
            order, arcs, patches, lambda: self._extractor.extract(*last),
            lambda: self._extractor.extract_piecewise(patches, *last),
            lambda: self._extractor.extract_lagrange(_whole(order, "order"), *last))

    def extract_to(self, sink: MeshSink, *, scale: int = 1, threads: int | None = None,
                   progress: Progress | None = None) -> Extraction:
        """Extracts the same mesh in pieces, like hexhex.extract_to()."""
        options = _options(scale, "atlas", 0, False, False)
        return _extraction(self._extractor.extract_to(sink, options, _threads(threads), progress))


def can_repair() -> bool:
    """Whether this build supports repair (requires Eigen).

    >>> isinstance(hexhex.can_repair(), bool)
    True
    """
    return _hexhex.can_repair()


def repair(map: Map, *, tolerance: float = 1e-2, scale: int = 1, round: bool = False,
           refine: bool = True, threads: int | None = None,
           progress: Progress | None = None) -> tuple[Map, RepairReport]:
    """Returns a valid map that is identical, bit for bit, where the given map was valid.
    docs/user/defects.md explains what can be repaired, and how.

    Args:
        scale: upper bound for later scaling of the map.
        round: first round coordinates that deviate from integers by up to 0.1.
        refine: allow splitting edges of the tet mesh.
        tolerance, threads, progress: as in extract().

    Raises:
        MapError: if the map has other defects, or the repair fails; its ``repair`` reports what was
            done until then.
        ArgumentError: if the map needs repair and can_repair() is False.

    >>> repaired, report = hexhex.repair(hexhex.generate("sphere"))
    >>> report.changed, report.bad_tets
    (False, 0)
    """
    handle, values = _hexhex.repair(map._arrays(), tolerance, _whole(scale, "scale"), round, refine,
                                    _threads(threads), progress)
    report = RepairReport._of(values)
    if not isinstance(handle, tuple):
        return Map._from_handle(handle), report
    code, message, place, index, second = handle
    error = make(code, message, place, index, second)
    error.repair = report
    raise error


def can_quantize() -> bool:
    """Whether this build supports quantization (requires Eigen).

    >>> isinstance(hexhex.can_quantize(), bool)
    True
    """
    return _hexhex.can_quantize()


def quantize(map: Map, *, cells: float | None = None, scale: float | None = None,
             edge_length: float | None = None, densify: bool = False, wall_tag: int = 0,
             tolerance: float = 1e-5, threads: int | None = None,
             progress: Progress | None = None) -> tuple[Map, QuantizeReport]:
    """Computes an integer-grid map from a seamless one: chooses integers and deforms the map to
    match them. Preserves features and regions; may split edges of tets.

    Args:
        cells: desired number of hexahedra; or set one of the next two instead.
        scale: approximate scale factor for the parameters of the map.
        edge_length: average edge length of a hexahedron in space.
        densify: if no valid map is found at this resolution, use the first finer one that works.
        wall_tag: tagged interior triangles remain planes of the mesh, except those with this tag; 0
            for no exception. Walls read by read_map(keep_walls=True) have tag 2.
        tolerance: maximum deviation from seamlessness, relative to the extent of the map.
        threads, progress: as in extract().

    Raises:
        MapError: if the map is not seamless, or cannot be deformed to match integers.
        ArgumentError: for options out of range, or if can_quantize() is False.

    >>> map = hexhex.generate("sphere")  # 448 cells
    >>> if hexhex.can_quantize():
    ...     finer, report = hexhex.quantize(map, cells=3500)
    ...     report.cells == len(hexhex.extract(finer).cells) == 3584
    ... else: True
    True
    """
    many, factor, length = _densities(cells, scale, edge_length)
    handle, values = _hexhex.quantize(map._arrays(), many, factor, length, densify, wall_tag,
                                      tolerance, _threads(threads), progress)
    return Map._from_handle(handle), QuantizeReport(**values)


def _densities(*values: float | None) -> list[float]:
    """Converts None to 0, which the library uses for it, and rejects 0 as a number of cells."""
    return [0.0 if value is None else float(value) or float("nan") for value in values]


_quantize = quantize  # for functions with an argument of that name


def examine_seamless(map: Map, *, threads: int | None = None,
                     progress: Progress | None = None) -> SeamlessReport:
    """Checks whether a map is suitable for quantize().

    >>> hexhex.examine_seamless(hexhex.generate("box")).kind if hexhex.can_quantize() else "seamless"
    'seamless'
    """
    return SeamlessReport(*_hexhex.examine_seamless(map._arrays(), _threads(threads), progress))


def _part_of(points: Path | npt.ArrayLike, tets: npt.ArrayLike | None, mesher: str,
             tet_size: float | None, cells: float, feature_angle: float, threads: int,
             progress: Progress | None) -> tuple[_hexhex.TetMesh, FillReport | None]:
    """Returns arrays for the library, or the contents of a file; and how it was filled."""
    if isinstance(points, (str, os.PathLike)):
        if tets is not None:
            raise ArgumentError("Give a file alone, or points and tets.", "InvalidArgument")
        by = _one_of(("auto", "tetwild", "netgen", "gmsh", "tetgen"), mesher, "mesher")
        options = _hexhex.FillOptions(getattr(_hexhex.Mesher, by), _densities(tet_size)[0], cells,
                                      feature_angle)
        part, report, said = _hexhex.read_part(os.fspath(points), options, threads, progress)
        for warning in said:
            warnings.warn(warning, stacklevel=3)
        return part, None if report is None else FillReport(**report)
    if tets is None:
        raise ArgumentError("Give a file, or points and tets.", "InvalidArgument")
    return _hexhex.TetMesh(_floats(points, (3,), "points"), _indices(tets, 4, "tets")), None


def _shape_options(method: str, feature_angle: float, seed: int) -> _hexhex.ShapeOptions:
    if seed < 0:
        raise ArgumentError(f"The seed is {seed}. Choose it from 0.", "InvalidArgument")
    way = _one_of(("auto", "frames", "polycube"), method, "method")
    return _hexhex.ShapeOptions(getattr(_hexhex.ShapeMethod, way), feature_angle, seed)


def map_from_tets(points: Path | npt.ArrayLike, tets: npt.ArrayLike | None = None, *,
                  method: str = "auto", feature_angle: float = 40.0, seed: int = 1,
                  mesher: str = "auto", tet_size: float | None = None, threads: int | None = None,
                  progress: Progress | None = None) -> tuple[Map, ShapeReport]:
    """Computes a seamless map for tets without one, as input for quantize(). The given points come
    first in the map; tets may be split.

    Args:
        points: positions, float64 of shape (n, 3); or a file: either one that read_tets() reads,
            whose tags the map inherits, or a closed surface (.stl, .obj, .ply, .off, .vtp) or STEP file,
            which a mesher fills with tets.
        tets: 0-based vertices of each tet: integers of shape (m, 4).
        method: "frames" (follows a smooth frame field: good cells, if there is such a map),
            "polycube" (deforms the object into axis-aligned boxes), or "auto": whichever fits best.
        feature_angle: edges where the surface turns by more degrees, 0 to 180, receive a tag if
            they are edges of the map.
        seed: random seed: another one may succeed where this one fails.
        mesher: for surfaces and STEP files: "tetwild", "netgen", "gmsh", "tetgen", or "auto": the
            first that is installed.
        tet_size: edge length of the mesher's tets; None: about 20,000 tets, or as many as ``cells``
            requires.
        threads, progress: as in extract().

    Raises:
        MapError: if no map was found, with the place that prevents it; and for tets that do not
            form the mesh of a solid.
        ArgumentError: for options out of range, or if can_quantize() is False.
        FileError: if the file cannot be read.

    Warns:
        UserWarning: of bodies in a file that touch, but share no vertices, of solids that overlap,
            and of meshers whose tets were not taken.

    >>> tets = hexhex.generate("box")
    >>> if hexhex.can_quantize():
    ...     map, report = hexhex.map_from_tets(tets.points, tets.tets, method="polycube")
    ...     report.charts, hexhex.examine_seamless(map).kind
    ... else: (6, "seamless")
    (6, 'seamless')
    """
    options, workers = _shape_options(method, feature_angle, seed), _threads(threads)
    part, _ = _part_of(points, tets, mesher, tet_size, 0.0, feature_angle, workers, progress)
    handle, values = _hexhex.map_from_tets(part, options, workers, progress)
    return Map._from_handle(handle), ShapeReport(**values)


def mesh(points: Path | npt.ArrayLike, tets: npt.ArrayLike | None = None, *,
         cells: float | None = None, edge_length: float | None = None, method: str = "auto",
         feature_angle: float = 40.0, seed: int = 1, target: float = 0.3, passes: int = 2,
         fix_boundary: bool = False, slack: float = 1e-3, pillow: str = "auto",
         snap_curves: bool = True, mesher: str = "auto", tet_size: float | None = None,
         threads: int | None = None, progress: Progress | None = None) -> MeshedPart:
    """Computes a hexahedral mesh from tets without a map: map_from_tets(), quantize(), extract(),
    verify() and improve() in a single call.

    Args:
        points, tets, method, seed, mesher, tet_size: as in map_from_tets(). The mesh inherits the
            tags of a file.
        cells: desired number of hexahedra; the mesh has more if no map with so few cells is found.
        edge_length: average edge length of a hexahedron in space; instead of cells.
        feature_angle: as in map_from_tets() and improve().
        target, passes, fix_boundary, slack, pillow, snap_curves: as in improve().
        threads, progress: as in extract().

    Returns:
        The mesh, its map, and reports. ``all_positive`` tells whether all cells are proven to be
        positive: the mesh is returned even if they are not.

    Raises:
        The errors of map_from_tets().

    >>> tets = hexhex.generate("cylinder")
    >>> if hexhex.can_quantize():
    ...     part = hexhex.mesh(tets.points, tets.tets, cells=300)
    ...     part.all_positive, part.verification.passed
    ... else: (True, True)
    (True, True)
    """
    shape = _shape_options(method, feature_angle, seed)
    improvement = _improve_options(target, passes, fix_boundary, feature_angle, slack, pillow,
                                   snap_curves)
    many, length = _densities(cells, edge_length)
    workers = _threads(threads)
    part, filled = _part_of(points, tets, mesher, tet_size, many, feature_angle, workers, progress)
    (made, integer_map, values, quantization, rows, improved, ways, why, released, missing,
     lost, stages) = _hexhex.mesh_from_tets(part, shape, many, length, improvement, workers, progress)
    return MeshedPart(Mesh._from_handle(made), Map._from_handle(integer_map), ShapeReport(**values),
                      QuantizeReport(**quantization), _verification_of(rows),
                      _improvement_of(improved), [WayReport(*way) for way in ways], why,
                      released, missing, lost, stages, filled)


def extract_partial(map: Map, *, scale: int = 1, tolerance: float = 1e-2,
                    threads: int | None = None, progress: Progress | None = None) -> PartialMesh:
    """Extracts the cells of a map that no defect touches, and reports where others are missing.
    Arguments are as in extract().

    Raises:
        MapError: if the tet mesh itself is invalid.

    >>> part = hexhex.extract_partial(hexhex.generate("sphere", cells=8, refine=4, defects=2))
    >>> len(part.holes) > 0, len(part.mesh.cells) < 3584
    (True, True)
    """
    handle, holes, *rest = _hexhex.extract_partial(map._arrays(), _whole(scale, "scale"), tolerance,
                                                   _threads(threads), progress)
    return PartialMesh(Mesh._from_handle(handle), [Hole(*hole) for hole in holes], *rest)


def check(points: Map | npt.ArrayLike, tets: npt.ArrayLike | None = None,
          igm: npt.ArrayLike | None = None, *, tolerance: float = 1e-2, scale: int = 1,
          threads: int | None = None, progress: Progress | None = None) -> CheckReport:
    """Checks a map and collects all violated conditions. Arguments are as in extract().

    >>> report = hexhex.check(hexhex.generate("sphere"), scale=2)
    >>> report.valid, report.expected["cells"], report.expected["inner_singular_edges"]
    (True, 3584, {3: 160})
    """
    counts: dict[str, Any] = _hexhex.check(_map_of(points, tets, igm)._arrays(), tolerance,
                                           _whole(scale, "scale"), _threads(threads), progress)
    defects = [Defect(*defect) for defect in counts.pop("defects")]
    return CheckReport(counts, defects, counts.pop("expected"))


def map_structure(points: Map | npt.ArrayLike, tets: npt.ArrayLike | None = None,
                  igm: npt.ArrayLike | None = None, *, tolerance: float = 1e-2,
                  threads: int | None = None, progress: Progress | None = None) -> MapStructure:
    """Finds where the charts of a map change and which edges of its tets are singular, as far as
    possible even for a map with defects. Arguments are as in extract().

    >>> structure = hexhex.map_structure(hexhex.generate("star", valence=5, charts="blocks"))
    >>> len(structure.jump_tets) > 0, set(structure.valences[~structure.boundary].tolist())
    (True, {5})
    """
    jump_tets, vertices, rotations, translations, edges, valences, boundary, defects = (
        _hexhex.map_structure(_map_of(points, tets, igm)._arrays(), tolerance, _threads(threads),
                              progress))
    return MapStructure(jump_tets, vertices, rotations, translations, edges, valences,
                        boundary != 0, [Defect(*defect) for defect in defects])


def verify(map: Map, mesh: Mesh, *, scale: int = 1, tolerance: float = 1e-2, digits: int = 0,
           threads: int | None = None, progress: Progress | None = None) -> VerifyReport:
    """Checks whether a mesh is that of its map, in any numbering and with cells in any orientation:
    no other mesh passes. If the mesh has a ``repaired_map``, pass that map. ``digits``: number of
    significant digits in the coordinates of the mesh, 1 to 17; 0: 7 if all are single-precision
    numbers, otherwise 17.

    >>> map = hexhex.generate("torus")
    >>> report = hexhex.verify(map, hexhex.extract(map))
    >>> report.passed, report.items[2].name
    (True, 'cells')
    """
    rows = _hexhex.verify(map._arrays(), mesh._handle, _whole(scale, "scale"), tolerance,
                          _whole(digits, "number of digits"), _threads(threads), progress)
    return _verification_of(rows)


def _verification_of(rows: Any) -> VerifyReport:
    return VerifyReport([VerifyItem(*row) for row in rows])


def generate(kind: str, *, cells: int = 4, refine: int = 2, valence: int = 5,
             charts: str = "aligned", jitter: float = 0, on_lattice: float = 0, noise: float = 0,
             offset: float = 0, seed: int = 1, features: bool = False, defects: int = 0,
             defect_kind: str = "interior") -> Map:
    """Generates a map whose mesh is known in advance: see ``answer`` of the Map.

    Args:
        kind: "box", "cylinder", "sphere", "star", "tetrahedron", "torus", "shell", "handle-body".
        cells: number of hexahedra along each block edge.
        refine: number of tet sub-blocks along each block edge.
        valence: number of hexahedra around the inner edge of a "star", 3 to 12.
        charts: "aligned", "blocks" (a random chart per block), "random" (one per tet) or
            "scattered" (one for one tet in eight).
        jitter, on_lattice, noise, offset, seed: see docs/user/command.md.
        features: tag corners, curves and surfaces, and number the blocks as regions.
        defects: minimum number of flipped or flat tets.
        defect_kind: "interior", "singular", "boundary" or "sliver".

    Raises:
        ArgumentError: for options out of range.

    >>> map = hexhex.generate("star", valence=7, charts="random")
    >>> map, map.answer["cells"], map.answer["inner_singular_edges"]
    (<hexhex.Map: 672 tets, 185 points>, 448, {7: 4})
    """
    if seed < 0:
        raise ArgumentError(f"The seed is {seed}. Choose it from 0.", "InvalidArgument")
    handle, answer = _hexhex.generate(
        kind, _whole(cells, "number of cells"), _whole(refine, "refinement"),
        _whole(valence, "valence"), charts, jitter, on_lattice, noise, offset, seed, features,
        _whole(defects, "number of defects"), defect_kind)
    map = Map._from_handle(handle)
    map.answer = answer
    return map


def sample_kinds() -> list[SampleKind]:
    """Returns the kinds of maps for generate().

    >>> [kind.name for kind in hexhex.sample_kinds()][:4]
    ['box', 'cylinder', 'sphere', 'star']
    """
    return [SampleKind(*row) for row in _hexhex.sample_kinds()]


def defect_kinds() -> list[str]:
    """Returns the kinds of defects for generate().

    >>> hexhex.defect_kinds()
    ['interior', 'singular', 'boundary', 'sliver']
    """
    kinds: list[str] = _hexhex.defect_kinds()
    return kinds


def read_map(file: Path, *, format: str | None = None, map_array: str = "igm",
             keep_walls: bool = False, threads: int | None = None, progress: Progress | None = None) -> Map:
    """Reads a map: .hexex, .ovm, .ovmb, .vtu, .vtk, .npz. Raises FileError with the line as its
    place; for a missing file, this is also a FileNotFoundError.

    Args:
        format: name of the format, whatever the extension: see formats().
        map_array: name of the array that holds the map in .vtu and .vtk files.
        keep_walls: import interior walls of a motorcycle complex, which .hexex files list, as
            features with tag 2: faces between blocks.
    """
    if _npz.is_npz(os.fspath(file), format):
        return _read_npz(file, Map)  # type: ignore[no-any-return]
    return Map._from_handle(_hexhex.read_map(os.fspath(file), format or "", map_array,
                                             keep_walls, _threads(threads), progress))


def _read_npz(file: Path, kind: type[Any]) -> Any:
    found = _npz.read(os.fspath(file))
    if isinstance(found, kind):
        return found
    raise make("FileUnsupported", f"{os.fspath(file)}: there is a {type(found).__name__} in it, and no "
               f"{kind.__name__}.", "", 0, 0)


def read_tets(file: Path, *, format: str | None = None, threads: int | None = None,
              progress: Progress | None = None) -> tuple[Any, Any]:
    """Reads a tetrahedral mesh without a map: also .mesh, .meshb, .msh. Raises FileError.

    Returns:
        Positions, float64 (n, 3), and vertices of tets, uint32 (m, 4).
    """
    points, tets = _hexhex.read_tets(os.fspath(file), format or "", _threads(threads), progress)
    return points, tets


def read_pair(tets: Path, polycube: Path, *, threads: int | None = None,
              progress: Progress | None = None) -> Map:
    """Reads a map from two files with meshes of the same tets, as written by polycube tools: the
    points of the second are the parameters of the first. Raises FileError."""
    return Map._from_handle(_hexhex.read_pair(os.fspath(tets), os.fspath(polycube),
                                              _threads(threads), progress))


def map_from_pair(points: npt.ArrayLike, tets: npt.ArrayLike, polycube_points: npt.ArrayLike,
                  polycube_tets: npt.ArrayLike | None = None) -> Map:
    """Makes such a map from arrays: float64 (n, 3), integers (m, 4), float64 (n, 3), and tets with
    the same vertices, possibly in another order (None: the same tets). Raises ArgumentError."""
    corners = _indices(tets, 4, "tets")
    others = corners if polycube_tets is None else _indices(polycube_tets, 4, "polycube_tets")
    return Map._from_handle(_hexhex.map_from_pair(
        _floats(points, (3,), "points"), corners, _floats(polycube_points, (3,), "polycube_points"),
        others, 0))


def read_flags(tets: Path, flags: Path, *, surface: Path | None = None, array: str = "flags",
               threads: int | None = None, progress: Progress | None = None) -> Map:
    """Reads the seamless map of a polycube, as input for quantize(), from a tet mesh and labels of
    its boundary triangles: 0 to 5 for +x, -x, +y, -y, +z, -z.

    Args:
        flags: a text file with four numbers per tet, one for the face opposite each corner, -1
            inside; or with one per triangle of ``surface``; or a .vtu or .vtk file with triangles.
        surface: an .obj file.
        array: name of the cell array with the labels in .vtu and .vtk files.

    Raises:
        FileError: for files that cannot be read, or that do not match.
        ArgumentError: for labels that define no polycube, or if can_quantize() is False.
        MapError: for tets that are inverted in space, or cannot be deformed to match.
    """
    return Map._from_handle(_hexhex.read_flags(
        os.fspath(tets), os.fspath(flags), "" if surface is None else os.fspath(surface), array,
        _threads(threads), progress))


def map_from_flags(points: npt.ArrayLike, tets: npt.ArrayLike, flags: npt.ArrayLike, *,
                   threads: int | None = None, progress: Progress | None = None) -> Map:
    """Makes such a map from arrays: float64 (n, 3), integers (m, 4), integers (m, 4): a label for
    the face opposite each corner, -1 inside. Raises ArgumentError, MapError.

    >>> import numpy
    >>> hexhex.map_from_flags(numpy.eye(4, 3), [[0, 1, 2, 3]], [[6, 1, 3, 5]])  # doctest: +IGNORE_EXCEPTION_DETAIL
    Traceback (most recent call last):
        ...
    ArgumentError: ...
    """
    labels = np.asarray(flags)
    if labels.ndim != 2 or labels.shape[1] != 4 or not np.issubdtype(labels.dtype, np.integer):
        raise ArgumentError("flags are integers of the shape (m, 4).", "InvalidArgument")
    if labels.size and (labels.min() < -1 or labels.max() > 5):
        raise ArgumentError("flags are from -1 to 5.", "InvalidArgument")
    return Map._from_handle(_hexhex.map_from_flags(
        _floats(points, (3,), "points"), _indices(tets, 4, "tets"),
        np.ascontiguousarray(labels, dtype=np.int8), _threads(threads), progress))


def read_mesh(file: Path, *, format: str | None = None, hexes_only: bool = False,
              threads: int | None = None, progress: Progress | None = None) -> Mesh:
    """Reads a hexahedral mesh: .mesh, .meshb, .vtu, .vtk, .msh, .ovm, .ovmb, .npz. Raises
    FileError, also for a file with other volume cells unless hexes_only skips them."""
    if _npz.is_npz(os.fspath(file), format):
        return _read_npz(file, Mesh)  # type: ignore[no-any-return]
    return Mesh._from_handle(_hexhex.read_mesh(os.fspath(file), format or "", hexes_only,
                                               _threads(threads), progress))


def read_curved(file: Path, *, threads: int | None = None,
                progress: Progress | None = None) -> LagrangeMesh:
    """Reads the higher-order hexahedra of a .vtu file: ``mesh.curved`` as written by write(), but
    without regions; or VTK_LAGRANGE_HEXAHEDRON cells from other programs, all of the same order.

    Raises:
        FileError: if there are no such cells; and for files other than .vtu.

    >>> import pathlib, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = pathlib.Path(folder) / "curved.vtu"
    ...     hexhex.write(hexhex.extract(hexhex.generate("box"), order=3).curved, file)
    ...     hexhex.holds_curved(file), hexhex.read_curved(file)
    (True, <hexhex.LagrangeMesh: 512 cells of order 3>)
    """
    return LagrangeMesh._from_handle(_hexhex.read_lagrange(os.fspath(file), _threads(threads),
                                                           progress))


def holds_curved(file: Path) -> bool:
    """Whether a file is a .vtu file with higher-order hexahedra. Raises FileError."""
    return bool(_hexhex.holds_lagrange(os.fspath(file)))


def read(file: Path, *, format: str | None = None, map_array: str = "igm",
         keep_walls: bool = False, hexes_only: bool = False, threads: int | None = None,
         progress: Progress | None = None) -> Map | Mesh:
    """Reads whatever a file holds: a mesh or, if it has no hexahedra, a map. Arguments are as in
    read_map() and read_mesh().

    Raises:
        FileError: if it can be read as neither; place and index give the line.

    >>> import pathlib, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     hexhex.write(hexhex.generate("box"), pathlib.Path(folder) / "box.hexex")
    ...     hexhex.read(pathlib.Path(folder) / "box.hexex")
    <hexhex.Map: 768 tets, 189 points>
    """
    if _npz.is_npz(os.fspath(file), format):
        return _npz.read(os.fspath(file))
    found = _hexhex.read(os.fspath(file), format or "", map_array, keep_walls, hexes_only, _threads(threads),
                         progress)
    return Map._from_handle(found) if isinstance(found, _hexhex.Map) else Mesh._from_handle(found)


def write(what: Map | Mesh | LagrangeMesh | Arcs | Patches, file: Path, *,
          format: str | None = None, compress: bool | str = False, patch_angle: float = 40,
          map_array: str = "igm", map: Map | None = None,
          scaled_jacobians: npt.ArrayLike | None = None, threads: int | None = None,
          progress: Progress | None = None) -> None:
    """Writes a map, a mesh, or its curved parts; docs/user/formats.md lists the formats. The file
    appears complete or not at all.

    Args:
        what: a Map (.hexex, .ovm, .ovmb, .vtu, .vtk), a Mesh (see formats()), ``mesh.curved``
            (.vtu, .msh, .inp, MFEM's .mesh), ``mesh.arcs`` or ``mesh.patches`` (.vtu, .vtp, .ovmb).
            Maps and meshes also as .npz: their arrays by name, for numpy.load(). A Mesh and
            ``mesh.curved`` also as .html: the page of view().
        format: name of the format of a map or mesh, whatever the extension: see formats(), or
            "npz"; or the solver that will read a mesh: "dealii", "ngsolve" etc. (``hexhex formats``
            lists them).
        compress: "zlib" (or True) or "lz4": compress the arrays of a map or mesh in .vtu files;
            LZ4, by liblz4 where that is installed, is faster, and files are larger. "zlib" also
            in .npz files.
        patch_angle: for meshes, curved or not, without tagged quads, in formats with groups: a
            group ends where the boundary turns by more degrees; 0 to 180.
        map_array: name of the array that holds the map in .vtu and .vtk files.
        map: for arcs and patches, the map that they were extracted from (for a mesh with a
            ``repaired_map``, that map): .ovmb files then include the indices of the tet simplices
            that contain each point and edge.
        scaled_jacobians: those of quality(), if already available: float64, one per cell of a Mesh
            or LagrangeMesh; otherwise computed for formats that store them.

    Raises:
        FileError: if the file cannot be written.
        ArgumentError: for options out of range.
    """
    name, workers = os.fspath(file), _threads(threads)
    if _npz.is_npz(name, format):
        if compress == "lz4":
            raise ArgumentError("Arrays of .npz files are compressed with zlib alone.",
                                "InvalidArgument")
        return _npz.write(what, name, bool(_compression(compress)))
    if isinstance(what, (Mesh, LagrangeMesh)) and format is None and name.lower().endswith(".html"):
        return _hexhex.write_page(what._handle, name, pathlib.Path(name).stem, workers, progress)
    tets = None if map is None else map._arrays()
    jacobians = _floats([] if scaled_jacobians is None else scaled_jacobians, (),
                        "scaled_jacobians")
    if isinstance(what, Map):
        _hexhex.write_map(what._arrays(), name, format or "", _compression(compress), map_array,
                          workers, progress)
    elif isinstance(what, Mesh):
        _hexhex.write_mesh(what._handle, name, format or "", patch_angle, _compression(compress),
                           jacobians, workers, progress)
    elif compress or (format is not None and not isinstance(what, LagrangeMesh)):
        raise ArgumentError("Curved meshes are written without compress, arcs and patches also "
                            "without format.", "InvalidArgument")
    elif isinstance(what, LagrangeMesh):
        _hexhex.write_lagrange(what._handle, name, format or "", patch_angle, jacobians, workers,
                               progress)
    elif isinstance(what, Arcs):
        _hexhex.write_arcs(what._handle, tets, name, workers, progress)
    elif isinstance(what, Patches):
        _hexhex.write_patches(what._handle, tets, name, workers, progress)
    else:
        raise ArgumentError(f"A {type(what).__name__} cannot be written.", "InvalidArgument")


class ViewPage:
    """A page that shows a mesh: inline in notebooks, or written to a file by write().

    Attributes:
        html: the complete, self-contained page.
    """

    def __init__(self, html: str) -> None:
        self.html = html

    def __repr__(self) -> str:
        return f"<hexhex.ViewPage: {len(self.html)} characters>"

    def _repr_html_(self) -> str:
        return ('<iframe style="width: 100%; height: 600px; border: 0" sandbox="allow-scripts '
                f'allow-downloads" srcdoc="{html.escape(self.html)}"></iframe>')


def view(mesh: Mesh | LagrangeMesh, *, title: str = "mesh", threads: int | None = None,
         progress: Progress | None = None) -> ViewPage:
    """Creates an interactive page to rotate, cut and colour a mesh, like ``hexhex view``. Shown by
    a notebook cell if it is the value of its last line. Requires no other package, no server and no
    network.

    Raises:
        FileError: if hexhex was built without the viewer; wheels include it.
    """
    with tempfile.TemporaryDirectory(prefix="hexhex-view-") as folder:
        file = os.path.join(folder, "view.html")
        _hexhex.write_page(mesh._handle, file, title, _threads(threads), progress)
        return ViewPage(pathlib.Path(file).read_text(encoding="utf-8"))


def require_format(what: str, file: Path, *, format: str | None = None,
                   compress: bool | str = False, patch_angle: float = 40,
                   map_array: str = "igm") -> None:
    """Does nothing if write() supports the file's extension or the format, and the options. Use it
    to detect unsupported formats before long work.

    Args:
        what: "map", "mesh", "curved", "arcs" or "patches".

    Raises:
        FileError: if it does not.
        ArgumentError: for any other value of `what`.

    >>> hexhex.require_format("mesh", "later.vtu")
    >>> hexhex.require_format("mesh", "later.stl")  # doctest: +IGNORE_EXCEPTION_DETAIL
    Traceback (most recent call last):
        ...
    FileError: ...
    """
    _hexhex.require_format(what, os.fspath(file), format or "", patch_angle, _compression(compress),
                           map_array)


def formats() -> list[FileFormat]:
    """Returns the file formats of this build.

    >>> sorted({f.extension for f in hexhex.formats() if f.streams})
    ['.mesh', '.meshb', '.msh', '.vtk', '.vtu']
    """
    return [FileFormat(*row) for row in _hexhex.formats()]


def quality(mesh: Mesh | LagrangeMesh, *, threads: int | None = None,
            progress: Progress | None = None) -> Quality:
    """Computes the scaled Jacobian of each cell, and whether the Jacobian is positive everywhere in
    it. For straight cells as in the Verdict library, for curved cells (``mesh.curved``) the minimum
    over nodes and Gauss points.

    >>> hexhex.quality(hexhex.extract(hexhex.generate("box"))).minimum
    1.0
    """
    return _quality_of(_hexhex.certify(mesh._handle, _threads(threads), progress))


def _quality_of(fields: Any) -> Quality:
    *values, worst = fields
    values.append([RefutedCell(*each) for each in worst])
    return Quality(*values)


def improve(mesh: AnyMesh, map: Map | None = None, *,
            surface: str | os.PathLike[str] | None = None, target: float = 0.3, passes: int = 2,
            fix_boundary: bool = False, feature_angle: float = 40.0, slack: float = 1e-3,
            pillow: str = "never", snap_curves: bool = False, threads: int | None = None,
            progress: Progress | None = None) -> tuple[AnyMesh, ImproveReport]:
    """Moves vertices: first makes all cells positive, then improves the worst cells, then all.
    Vertices on the surface slide on it. Returns a new mesh and leaves the given one unchanged.

    Args:
        mesh: straight, or curved of order 1 to 3 (``mesh.curved``), in which case all nodes move.
        map: the map that the mesh was extracted from, whose surface vertices stay on. Without it,
            the surface is the boundary of the mesh.
        surface: instead of a map, a file with the surface that the boundary of the mesh
            approximates: triangles (``.stl``, ``.obj``, ``.ply``, ``.off``), or tets, whose boundary
            counts. Vertices are pulled onto it.
        target: improve cells with a smaller scaled Jacobian until nothing helps, 0 to 1.
        passes: final passes over all vertices, 0 to 1000.
        fix_boundary: keep vertices on the surface fixed.
        feature_angle: edges where the surface turns by more degrees are curves, as are tagged
            edges: vertices do not leave them.
        slack: how far untagged vertices may leave the surface where nothing else makes cells
            positive, in diagonals of its bounding box, 0 to 0.1; in meshes with bad cells, this
            also applies to raising cells below the target. Unless it is 0, coarse meshes may leave
            it farther, to get nearer.
        pillow: whether to add a layer of straight cells under the boundary: "never", "always", or
            "auto": if it leaves fewer cells that are not positive, or raises the minimum by at
            least 0.02.
        snap_curves: whether to snap edges of straight cells to curves that none follows, adding
            layers that make room for them, if that improves the mesh.
        threads, progress: as in extract().

    >>> map = hexhex.generate("torus", cells=2, jitter=0.6)
    >>> better, report = hexhex.improve(hexhex.extract(map), map)
    >>> report.after.all_positive and report.after.minimum >= report.before.minimum
    True
    """
    options = _improve_options(target, passes, fix_boundary, feature_angle, slack, pillow,
                               snap_curves)
    if map is not None and surface is not None:
        raise ValueError("Give a map or a surface, not both.")
    handle, report = _hexhex.improve(mesh._handle, None if map is None else map._arrays(),
                                     None if surface is None else os.fspath(surface), options,
                                     _threads(threads), progress)
    return type(mesh)._from_handle(handle), _improvement_of(report)


def _improve_options(target: float, passes: int, fix_boundary: bool, feature_angle: float,
                     slack: float, pillow: str, snap_curves: bool) -> _hexhex.ImproveOptions:
    mode = _one_of(("never", "auto", "always"), pillow, "pillow")
    return _hexhex.ImproveOptions(target, passes, fix_boundary, feature_angle, slack,
                                  getattr(_hexhex.PillowMode, mode), snap_curves)


def _improvement_of(fields: Any) -> ImproveReport:
    before, after, values = fields
    values["worst_held_by"] = ("neighbours", "surface", "curve", "corner", "held vertex",
                               "shared faces")[values["worst_held_by"]]
    return ImproveReport(_quality_of(before), _quality_of(after), **values)


def scaled_jacobian(corners: npt.ArrayLike) -> float:
    """Computes the scaled Jacobian of one hexahedron, in [-1, 1]. Raises ArgumentError for other
    shapes.

    Args:
        corners: positions in the order of VTK_HEXAHEDRON, float64 (8, 3).

    >>> hexhex.scaled_jacobian([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0),
    ...                         (0, 0, 2), (1, 0, 2), (1, 1, 2), (0, 1, 2)])
    1.0
    """
    return float(_hexhex.scaled_jacobian(_floats(corners, (3,), "corners")))


def same_mesh(a: Mesh, b: Mesh) -> bool:
    """Whether two meshes are the same up to the numbering of vertices, of cells, and of corners
    under rotations of cells. Positions are compared bit for bit; tags, names and regions are
    compared, too.

    >>> mesh = hexhex.extract(hexhex.generate("torus"))
    >>> other = hexhex.Mesh(mesh.points[::-1], len(mesh.points) - 1 - mesh.cells[::-1].astype(int))
    >>> mesh == other, hexhex.same_mesh(mesh, other), mesh.diff(other)
    (False, True, 'the same mesh with other numbers')
    """
    return _compare.canonical(a) == _compare.canonical(b)


def summarize(mesh: Mesh | Path, *, format: str | None = None, threads: int | None = None,
              progress: Progress | None = None) -> MeshSummary:
    """Summarizes a mesh in memory or in a file of any size, for comparing meshes.

    Args:
        mesh: a Mesh, or a file.
        format: name of the file's format, whatever its extension: see formats().

    >>> map = hexhex.generate("box")
    >>> hexhex.summarize(hexhex.extract(map)) == hexhex.summarize(hexhex.extract(map, threads=1))
    True
    """
    if isinstance(mesh, Mesh):
        values = _hexhex.summarize(mesh._handle, _threads(threads), progress)
    else:
        values = _hexhex.summarize_file(os.fspath(mesh), format or "", _threads(threads), progress)
    return MeshSummary(**values)
