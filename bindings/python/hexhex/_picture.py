"""Small pictures for notebooks, drawn without any other package."""

from __future__ import annotations

import base64
import html as text
import struct
import zlib
from typing import TYPE_CHECKING, Any, Callable

import numpy as np

from ._errors import HexhexError

if TYPE_CHECKING:
    import numpy.typing as npt

    from ._types import Mesh

    Floats = npt.NDArray[np.float64]

_SIZE = 320  # pixels, in both directions
_CELLS = np.array([0.36, 0.60, 0.85])  # colour of hexahedra
_EVEN, _ODD = np.array([0.93, 0.75, 0.40]), np.array([0.98, 0.93, 0.80])  # of the integer grid


def html(title: str, draw: Callable[[], bytes | None]) -> str:
    """Returns a title with a picture below it, if there is something to draw."""
    try:
        picture = draw()
    except (HexhexError, IndexError):  # nonexistent vertices, which functions report
        picture = None
    title = f"<code>{text.escape(title)}</code>"
    if picture is None:
        return title
    data = base64.b64encode(picture).decode("ascii")
    return f'<div>{title}<br><img alt="" width="{_SIZE}" src="data:image/png;base64,{data}"></div>'


def of_mesh(mesh: Mesh) -> bytes | None:
    """Draws the boundary of a hexahedral mesh."""
    quads = np.concatenate([np.empty((0, 4), np.uint32), *(p.quads for p in mesh.boundary_patches(0))])
    return _draw(mesh.points[quads], None)


def of_map(points: Floats, tets: npt.NDArray[Any], igm: Floats) -> bytes | None:
    """Draws the boundary of a tetrahedral mesh, with a checkerboard of its integer grid."""
    opposite = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])
    faces = tets[:, opposite].reshape(-1, 3)
    a, b, c = np.sort(faces, axis=1).T.astype(np.int64)
    order = np.lexsort((c, b, a))
    same = (np.diff(a[order]) == 0) & (np.diff(b[order]) == 0) & (np.diff(c[order]) == 0)
    alone = np.ones(len(faces), dtype=bool)
    alone[order[1:][same]] = alone[order[:-1][same]] = False
    triangle = [0, 1, 2, 2]  # a quad with a repeated corner
    return _draw(points[faces[alone]][:, triangle],
                 igm[:, opposite].reshape(-1, 3, 3)[alone][:, triangle])


def _draw(corners: Floats, parameters: Floats | None) -> bytes | None:
    """Draws quads (n, 4, 3), seen from a fixed direction; None if there are none."""
    if not len(corners) or not np.isfinite(corners).all():
        return None
    turned = corners @ _turn()
    lowest = turned.min(axis=(0, 1))
    extent = turned.max(axis=(0, 1)) - lowest
    scale = (_SIZE - 8) / max(float(extent[:2].max()), 1e-300)
    turned = (turned - lowest - extent / 2) * scale + _SIZE / 2
    normal = np.cross(turned[:, 2] - turned[:, 0], turned[:, 3] - turned[:, 1])
    light = np.abs(normal @ np.array([0.3, 0.5, 0.81])) / np.maximum(
        np.linalg.norm(normal, axis=1), 1e-300)
    longest = np.linalg.norm(np.roll(turned, -1, axis=1) - turned, axis=2).max(axis=1)
    canvas = _Canvas()
    # Process quads of similar size together, with at least one sample per pixel along each edge.
    levels = np.ceil(np.log2(np.maximum(longest, 1))).astype(int)
    for level in np.unique(levels):
        samples = 2**int(level) + 1
        chosen = np.flatnonzero(levels == level)
        for part in np.array_split(chosen, max(1, len(chosen) * samples**2 >> 21)):
            canvas.add(turned[part], light[part], samples, longest[part],
                       None if parameters is None else parameters[part])
    return canvas.png()


def _turn() -> Floats:
    """Rotation from space to right, down, and towards the viewer."""
    a, b = np.radians((35.0, -25.0))
    around = np.array([[np.cos(a), 0, -np.sin(a)], [np.sin(a), 0, np.cos(a)], [0, -1, 0]])
    tilt = np.array([[1, 0, 0], [0, np.cos(b), np.sin(b)], [0, -np.sin(b), np.cos(b)]])
    turn: Floats = around @ tilt
    return turn


class _Canvas:
    """Pixels and their depths."""

    def __init__(self) -> None:
        self._depth = np.full(_SIZE * _SIZE, -np.inf)
        self._colour = np.ones((_SIZE * _SIZE, 3))

    def add(self, corners: Floats, light: Floats, samples: int, longest: Floats,
            parameters: Floats | None) -> None:
        """Draws quads as samples x samples points each."""
        along = np.linspace(0, 1, samples)
        u, v = (each.ravel() for each in np.meshgrid(along, along))
        weights = np.stack([(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v])
        places = np.einsum("cs,ncx->nsx", weights, corners)
        if parameters is None:
            colour = np.broadcast_to(_CELLS, places.shape).copy()
            # Draw edges about one pixel wide, unless quads are not much larger than a pixel.
            edge = np.minimum(np.minimum(u, 1 - u), np.minimum(v, 1 - v))[None, :]
            colour[edge * longest[:, None] < np.minimum(0.8, longest / 8)[:, None]] *= 0.35
        else:
            at = np.einsum("cs,ncx->nsx", weights, parameters)
            # Boundary faces lie in integer planes, where rounding must not decide.
            colour = np.where(((np.floor(at + 1e-6).sum(axis=2) % 2) == 0)[..., None], _EVEN, _ODD)
        colour = colour * (0.35 + 0.65 * light)[:, None, None]
        self._put(places.reshape(-1, 3), colour.reshape(-1, 3))

    def _put(self, places: Floats, colour: Floats) -> None:
        pixel = np.clip(places[:, :2].astype(np.int64), 0, _SIZE - 1) @ np.array([1, _SIZE])
        order = np.lexsort((places[:, 2], pixel))
        last = order[np.append(np.diff(pixel[order]) != 0, True)]  # the nearest at each pixel
        nearer = last[places[last, 2] > self._depth[pixel[last]]]
        self._depth[pixel[nearer]] = places[nearer, 2]
        self._colour[pixel[nearer]] = colour[nearer]

    def png(self) -> bytes:
        """Returns the picture as a PNG file."""
        rows = (self._colour * 255).astype(np.uint8).reshape(_SIZE, _SIZE * 3)
        data = np.hstack((np.zeros((_SIZE, 1), dtype=np.uint8), rows)).tobytes()

        def chunk(kind: bytes, content: bytes) -> bytes:
            check = zlib.crc32(kind + content)
            return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", check)

        header = struct.pack(">IIBBBBB", _SIZE, _SIZE, 8, 2, 0, 0, 0)
        return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(data))
                + chunk(b"IEND", b""))
