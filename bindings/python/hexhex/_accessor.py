"""The accessor ``hexhex`` of PyVista's unstructured grids, in versions that have
register_dataset_accessor: PyVista finds it as an entry point of the installed package."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pyvista

from . import _types

if TYPE_CHECKING:
    from ._types import CheckReport, Map, Mesh, VerifyReport


class HexhexAccessor:
    """``grid.hexhex``: a grid of tetrahedra with a map, or of hexahedra.

    A map is the array ``igm`` of cells with 12 components, or of points with 3: see
    Map.from_pyvista().
    """

    def __init__(self, grid: Any) -> None:
        self._grid = grid

    def map(self, array: str = "igm") -> Map:
        """The hexhex.Map of a grid of tetrahedra."""
        return _types.Map.from_pyvista(self._grid, array)

    def mesh(self) -> Mesh:
        """The hexhex.Mesh of a grid of hexahedra."""
        return _types.Mesh.from_pyvista(self._grid)

    def extract(self, array: str = "igm", **options: Any) -> Any:
        """The hexahedral mesh of a map as a grid. Options are those of hexhex.extract()."""
        import hexhex

        return hexhex.extract(self.map(array), **options).to_pyvista()

    def check(self, array: str = "igm", **options: Any) -> CheckReport:
        """What hexhex.check() says of a map."""
        import hexhex

        return hexhex.check(self.map(array), **options)

    def verify(self, mesh: Any, array: str = "igm", **options: Any) -> VerifyReport:
        """Whether a grid of hexahedra is the mesh of this map: hexhex.verify()."""
        import hexhex

        return hexhex.verify(self.map(array), _types.Mesh.from_pyvista(mesh), **options)


if hasattr(pyvista, "register_dataset_accessor"):
    pyvista.register_dataset_accessor("hexhex", pyvista.UnstructuredGrid)(HexhexAccessor)
