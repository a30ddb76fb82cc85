"""The accessor ``hexhex`` for PyVista's unstructured grids, in versions with
register_dataset_accessor. PyVista finds it as an entry point of the installed package."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pyvista

from . import _types

if TYPE_CHECKING:
    from ._types import CheckReport, Map, Mesh, VerifyReport


class HexhexAccessor:
    """``grid.hexhex``: a grid of tetrahedra with a map, or of hexahedra.

    A map is the cell array ``igm`` with 12 components, or a point array with 3: see
    Map.from_pyvista().
    """

    def __init__(self, grid: Any) -> None:
        self._grid = grid

    def map(self, array: str = "igm") -> Map:
        """Returns the hexhex.Map of a grid of tetrahedra."""
        return _types.Map.from_pyvista(self._grid, array)

    def mesh(self) -> Mesh:
        """Returns the hexhex.Mesh of a grid of hexahedra."""
        return _types.Mesh.from_pyvista(self._grid)

    def extract(self, array: str = "igm", **options: Any) -> Any:
        """Extracts the hexahedral mesh of a map as a grid. Options are those of
        hexhex.extract()."""
        import hexhex

        return hexhex.extract(self.map(array), **options).to_pyvista()

    def check(self, array: str = "igm", **options: Any) -> CheckReport:
        """Checks a map with hexhex.check()."""
        import hexhex

        return hexhex.check(self.map(array), **options)

    def verify(self, mesh: Any, array: str = "igm", **options: Any) -> VerifyReport:
        """Checks with hexhex.verify() whether a grid of hexahedra is the mesh of this map."""
        import hexhex

        return hexhex.verify(self.map(array), _types.Mesh.from_pyvista(mesh), **options)


if hasattr(pyvista, "register_dataset_accessor"):
    pyvista.register_dataset_accessor("hexhex", pyvista.UnstructuredGrid)(HexhexAccessor)
