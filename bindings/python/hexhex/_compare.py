"""Comparison of meshes: whether they are the same, and how they differ."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

    from ._types import Features, Mesh

    Array = npt.NDArray[Any]

# Generators of the 24 rotations of a hexahedron, as orders of its corners (VTK).
_QUARTER_X = [3, 2, 6, 7, 0, 1, 5, 4]
_QUARTER_Z = [1, 2, 3, 0, 5, 6, 7, 4]


def _turns() -> list[list[int]]:
    found, i = [list(range(8))], 0
    while i < len(found):
        for quarter in (_QUARTER_X, _QUARTER_Z):
            turned = [found[i][corner] for corner in quarter]
            if turned not in found:
                found.append(turned)
        i += 1
    return found


def same_arrays(a: Any, b: Any, names: tuple[str, ...]) -> bool:
    """Whether all of these attributes are equal."""
    return all(np.array_equal(getattr(a, name), getattr(b, name)) for name in names)


def _ranks(rows: Array) -> Array:
    """Returns a number for each row: its rank among the distinct rows in sorted order."""
    ranks: Array = np.unique(rows + 0.0, axis=0, return_inverse=True)[1].reshape(-1)  # -0 is 0
    return ranks


def _turned(cells: Array, ranks: Array) -> tuple[Array, Array]:
    """Rotates each cell such that the sequence of its corners' ranks is minimal; returns cells and
    ranks."""
    best, least = cells, ranks[cells]
    for turn in _turns()[1:]:
        other = ranks[cells[:, turn]]
        first = (other != least).argmax(axis=1)[:, None]
        smaller = np.take_along_axis(other, first, 1) < np.take_along_axis(least, first, 1)
        best, least = np.where(smaller, cells[:, turn], best), np.where(smaller, other, least)
    return best, least


def canonical(mesh: Mesh) -> Mesh:
    """Renumbers a mesh based on positions and cells alone: rotates cells and sorts them by
    location, orders vertices by their first cells, and sorts tags. Cells at the same location keep
    their order."""
    from ._types import Features, Mesh

    ranks = _ranks(mesh.points)
    cells, keys = _turned(mesh.cells.astype(np.int64), ranks)
    order = np.lexsort(keys.T[::-1])
    corners = cells[order].reshape(-1)
    used, first = np.unique(corners, return_index=True)
    unused = np.setdiff1d(np.arange(len(mesh.points)), used)
    vertices = np.concatenate([used[np.argsort(first)], unused[np.argsort(ranks[unused], kind="stable")]])
    number = np.empty(len(vertices), dtype=np.int64)
    number[vertices] = np.arange(len(vertices))

    def tagged(rows: Array) -> Array:
        names = np.sort(number[rows[:, :-1]], axis=1)
        table = np.column_stack((names, rows[:, -1])).astype(np.int32)
        sorted_rows: Array = table[np.lexsort(table.T[::-1])]
        return sorted_rows

    f = mesh.features
    return Mesh(mesh.points[vertices] + 0.0, number[corners].reshape(-1, 8),
                features=Features(tagged(f.vertices), tagged(f.edges), tagged(f.faces), corners=4,
                                  names=f.names),
                regions=mesh.regions[order] if len(mesh.regions) else None)


def _difference(what: str, a: Array, b: Array) -> list[str]:
    """Returns a line that describes how two arrays of the same shape differ."""
    rows = np.flatnonzero((a != b).any(axis=tuple(range(1, a.ndim))))
    if not len(rows):
        return []
    line = f"{what}: {len(rows)} of {len(a)} differ"
    if a.dtype.kind == "f":
        line += f", by up to {np.abs(a - b).max():.3g}"
    return [f"{line}; the first is {rows[0]}: {a[rows[0]].tolist()} here, {b[rows[0]].tolist()} there"]


def _missing(what: str, a: Array, b: Array, rows: Array) -> list[str]:
    """Returns a line about rows of a that b lacks. @param rows  what is shown of them"""
    ranks = _ranks(np.concatenate((a, b)))
    lacking = np.flatnonzero(~np.isin(ranks[:len(a)], ranks[len(a):]))
    if not len(lacking):
        return []
    return [f"{what}: {len(lacking)} of {len(a)} are not there; the first is {lacking[0]}: "
            f"{rows[lacking[0]].tolist()}"]


def _tags(a: Features, b: Features) -> list[str]:
    lines = []
    for name in ("vertices", "edges", "faces"):
        x, y = getattr(a, name), getattr(b, name)
        if len(x) != len(y):
            lines.append(f"tagged {name}: {len(x)} here, {len(y)} there")
        else:
            lines += _difference(f"tagged {name}", x, y)
    if a.names != b.names:
        lines.append(f"names of tags: {a.names} here, {b.names} there")
    return lines


def difference(a: Mesh, b: Mesh) -> str:
    """Returns lines that describe how b differs from a; empty if they are equal."""
    lines = [f"{name}: {len(getattr(a, name))} here, {len(getattr(b, name))} there"
             for name in ("points", "cells") if len(getattr(a, name)) != len(getattr(b, name))]
    if not lines and np.array_equal(a.cells, b.cells):
        lines = _difference("points", a.points, b.points)
    elif not lines and canonical(a) == canonical(b):
        return "the same mesh with other numbers"
    else:
        for x, y, where in ((a, b, "here"), (b, a, "of the other")):
            lines += _missing(f"points {where}", x.points, y.points, x.points)
            here, there = (m.points[m.cells].mean(axis=1) for m in (x, y))
            lines += _missing(f"cells {where}, by their centres", here, there, x.cells)
        if len(a.cells) == len(b.cells) and not any(line.startswith("cells") for line in lines):
            lines += _difference("cells", a.cells, b.cells)
    if len(a.regions) != len(b.regions):
        lines.append(f"regions: {len(a.regions)} here, {len(b.regions)} there")
    else:
        lines += _difference("regions", a.regions, b.regions)
    return "\n".join(lines + _tags(a.features, b.features))
