"""Hexahedral meshes from integer-grid maps.

>>> import hexhex
>>> map = hexhex.generate("sphere", cells=4)
>>> mesh = hexhex.extract(map, scale=2)
>>> mesh
<hexhex.Mesh: 3584 cells, 3817 points>
>>> bool(hexhex.verify(map, mesh, scale=2))
True

All functions may be called from several threads at once. They release the GIL while they work, and
Ctrl-C cancels them.
"""

from __future__ import annotations

import os
import pathlib
from typing import TYPE_CHECKING, Any, Callable, Optional, Union

from . import _hexhex
from ._errors import (
    ArgumentError,
    CancelledError,
    FileError,
    HexhexError,
    InternalError,
    MapError,
    MemoryExhaustedError,
)
from ._types import CheckReport, Defect, Map, Mesh, Quality, VerifyItem, VerifyReport

if TYPE_CHECKING:
    import numpy.typing as npt

    Progress = Callable[[str, float], object]
    Path = Union[str, "os.PathLike[str]"]

__version__: str = _hexhex.version()

__all__ = [
    "ArgumentError", "CancelledError", "CheckReport", "Defect", "Extractor", "FileError",
    "HexhexError", "InternalError", "Map", "MapError", "MemoryExhaustedError", "Mesh", "Quality",
    "VerifyItem", "VerifyReport", "check", "extract", "generate", "quality", "read", "read_map",
    "read_mesh", "verify", "write",
]


def _map_of(points: Map | npt.ArrayLike, tets: npt.ArrayLike | None,
            igm: npt.ArrayLike | None) -> Map:
    if isinstance(points, Map):
        if tets is not None or igm is not None:
            raise ArgumentError("Give a map alone, or points, tets and igm.", "InvalidArgument")
        return points
    if tets is None or igm is None:
        raise ArgumentError("Give a map, or points, tets and igm.", "InvalidArgument")
    return Map(points, tets, igm)


def _is_propeller(engine: str) -> bool:
    if engine not in ("atlas", "propeller"):
        raise ArgumentError(f'There is no engine "{engine}". Choose "atlas" or "propeller".',
                            "InvalidArgument")
    return engine == "propeller"


def _threads(threads: Optional[int]) -> int:
    if threads is None:
        return 0
    if threads < 1:
        raise ArgumentError(f"The number of threads is {threads}. Choose it from 1, or None for "
                            "all cores.", "InvalidArgument")
    return threads


def extract(points: Map | npt.ArrayLike, tets: npt.ArrayLike | None = None,
            igm: npt.ArrayLike | None = None, *, scale: int = 1, threads: int | None = None,
            engine: str = "atlas", tolerance: float = 1e-2, epsilon: float = 1e-6,
            progress: Progress | None = None) -> Mesh:
    """Extracts the hexahedral mesh that an integer-grid map implies.

    Args:
        points: a Map, or positions: float64 of shape (n, 3).
        tets: vertices of each tet, from 0: integers of shape (m, 4).
        igm: parameters of the corners of each tet, in units of one hexahedron: float64 of shape
            (m, 4, 3) or (m, 12).
        scale: multiplies all parameters: scale**3 times as many cells.
        threads: None for all cores. The result does not depend on it, bit for bit.
        engine: "atlas", or "propeller" for the algorithm of the paper; the same mesh.
        tolerance: how far the map may be from its integer conditions, below 0.25.
        epsilon: of the propeller engine; changes the time, never the result.
        progress: called with the name of the stage and its finished share in [0, 1], from any
            thread. What it raises ends the extraction and is raised here.

    Returns:
        The mesh, with ``mesh.statistics`` of the extraction.

    Raises:
        MapError: for the first violated condition, with its place.
        ArgumentError: for shapes, types and options out of range.
        MemoryExhaustedError: if memory does not suffice.
        KeyboardInterrupt: after Ctrl-C.

    >>> map = hexhex.generate("box", cells=2)
    >>> hexhex.extract(map.points, map.tets, map.igm).cells.shape
    (64, 8)
    """
    m = _map_of(points, tets, igm)
    handle, statistics = _hexhex.extract(m.points, m.tets, m.igm, scale, _is_propeller(engine),
                                         tolerance, epsilon, _threads(threads), progress)
    return Mesh._from_handle(handle, statistics)


class Extractor:
    """A prepared map, for several meshes of it: what does not depend on the scale is done once.

    >>> extractor = hexhex.Extractor(hexhex.generate("box", cells=2))
    >>> [len(extractor.extract(scale=s).cells) for s in (1, 2, 3)]
    [64, 512, 1728]

    Args:
        points, tets, igm: as in extract(); they must not change while the extractor lives.
        tolerance, threads, progress: as in extract().
        max_scale: the largest scale that will be asked for.

    Raises:
        As extract().
    """

    def __init__(self, points: Map | npt.ArrayLike, tets: npt.ArrayLike | None = None,
                 igm: npt.ArrayLike | None = None, *, tolerance: float = 1e-2, max_scale: int = 64,
                 threads: int | None = None, progress: Progress | None = None) -> None:
        m = _map_of(points, tets, igm)
        self._extractor = _hexhex.Extractor(m.points, m.tets, m.igm, tolerance, max_scale,
                                            _threads(threads), progress)

    def extract(self, *, scale: int = 1, threads: int | None = None, engine: str = "atlas",
                epsilon: float = 1e-6, progress: Progress | None = None) -> Mesh:
        """The mesh at a scale: the same as that of hexhex.extract()."""
        handle, statistics = self._extractor.extract(scale, _is_propeller(engine), epsilon,
                                                     _threads(threads), progress)
        return Mesh._from_handle(handle, statistics)


def check(points: Map | npt.ArrayLike, tets: npt.ArrayLike | None = None,
          igm: npt.ArrayLike | None = None, *, tolerance: float = 1e-2, scale: int = 1,
          threads: int | None = None) -> CheckReport:
    """Examines a map and collects every violated condition. Arguments as in extract().

    >>> report = hexhex.check(hexhex.generate("sphere"), scale=2)
    >>> report.valid, report.expected["cells"], report.expected["inner_singular_edges"]
    (True, 3584, {3: 160})
    """
    m = _map_of(points, tets, igm)
    counts: dict[str, Any] = _hexhex.check(m.points, m.tets, m.igm, tolerance, scale,
                                           _threads(threads))
    defects = [Defect(*defect) for defect in counts.pop("defects")]
    return CheckReport(counts, defects, counts.pop("expected"))


def verify(map: Map, mesh: Mesh, *, scale: int = 1, tolerance: float = 1e-2,
           threads: int | None = None) -> VerifyReport:
    """Whether a mesh agrees with its map: counts, singular edges, topology, and positions.

    >>> map = hexhex.generate("torus")
    >>> report = hexhex.verify(map, hexhex.extract(map))
    >>> report.passed, report.items[2].name
    (True, 'cells')
    """
    rows = _hexhex.verify(map.points, map.tets, map.igm, mesh._handle, scale, tolerance,
                          _threads(threads))
    return VerifyReport([VerifyItem(*row) for row in rows])


def generate(kind: str, *, cells: int = 4, refine: int = 2, valence: int = 5,
             charts: str = "aligned", jitter: float = 0, on_lattice: float = 0, noise: float = 0,
             offset: float = 0, seed: int = 1) -> Map:
    """A map whose mesh is known in advance.

    Args:
        kind: "box", "cylinder", "sphere", "star", "tetrahedron", "torus", "shell", "handle-body".
        cells: hexahedra along each block edge.
        refine: tet sub-blocks along each block edge.
        valence: hexahedra around the inner edge of a "star", 3 to 12.
        charts: "aligned", "blocks" (a random chart per block) or "random" (per tet).
        jitter, on_lattice, noise, offset, seed: see docs/command.md.

    Raises:
        ArgumentError: for options out of range.

    >>> hexhex.generate("star", valence=7, charts="random")
    <hexhex.Map: 672 tets, 185 points>
    """
    if charts not in ("aligned", "blocks", "random"):
        raise ArgumentError(f'There is no style of charts "{charts}".', "InvalidArgument")
    handle = _hexhex.generate(kind, cells, refine, valence, charts, jitter, on_lattice, noise,
                              offset, seed)
    return Map(handle.points, handle.tets, handle.igm)


def read_map(file: Path, *, threads: int | None = None) -> Map:
    """Reads a map: .hexex, .ovm, .ovmb. Raises FileError with the line as its place."""
    handle = _hexhex.read_map(os.fspath(file), _threads(threads))
    return Map(handle.points, handle.tets, handle.igm)


def read_mesh(file: Path, *, threads: int | None = None) -> Mesh:
    """Reads a hexahedral mesh: .mesh, .meshb, .vtu, .vtk, .msh, .ovm, .ovmb. Raises FileError."""
    return Mesh._from_handle(_hexhex.read_mesh(os.fspath(file), _threads(threads)), {})


def read(file: Path, *, threads: int | None = None) -> Map | Mesh:
    """Reads what a file holds. Of .ovm and .ovmb, which may hold either: a map if it is one.

    Raises:
        FileError: if it can be read as neither; place and index tell the line.

    >>> import pathlib, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     hexhex.write(hexhex.generate("box"), pathlib.Path(folder) / "box.hexex")
    ...     hexhex.read(pathlib.Path(folder) / "box.hexex")
    <hexhex.Map: 768 tets, 189 points>
    """
    extension = pathlib.Path(file).suffix.lower()
    if extension == ".hexex":
        return read_map(file, threads=threads)
    if extension in (".ovm", ".ovmb"):
        try:
            return read_map(file, threads=threads)
        except HexhexError as error:
            if error.code == "FileNotFound":
                raise
    return read_mesh(file, threads=threads)


def write(what: Map | Mesh, file: Path, *, format: str | None = None,
          threads: int | None = None) -> None:
    """Writes a map (.hexex, .ovm, .ovmb) or a mesh (.vtu, .mesh, .meshb, .vtk, .msh, .inp, .ovm,
    .ovmb). The file appears complete or not at all.

    Args:
        format: of a mesh, whatever the extension is: docs/formats.md lists the names.

    Raises:
        FileError: if it cannot be written.
    """
    if isinstance(what, Map):
        _hexhex.write_map(what.points, what.tets, what.igm, os.fspath(file), _threads(threads))
    else:
        _hexhex.write_mesh(what._handle, os.fspath(file), format or "", _threads(threads))


def quality(mesh: Mesh, *, threads: int | None = None) -> Quality:
    """Scaled Jacobian of each cell, as in the Verdict library.

    >>> hexhex.quality(hexhex.extract(hexhex.generate("box"))).minimum
    1.0
    """
    values = _hexhex.scaled_jacobians(mesh._handle, _threads(threads))
    if not len(values):
        return Quality(values, 0.0, 0.0, 0)
    return Quality(values, float(values.min()), float(values.mean()), int((values <= 0).sum()))
