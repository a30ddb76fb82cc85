"""Maps and meshes in numpy's .npz files: arrays named after the attributes, for numpy.load()."""

from __future__ import annotations

import contextlib
import os
import secrets
import zipfile
from typing import Any

import numpy as np

from ._errors import ArgumentError, HexhexError, from_os_error, make
from ._types import Features, Map, Mesh

_FEATURES = ("vertices", "edges", "faces")
_OF_MAP = ("points", "tets", "igm", "regions", "edge_valences", "rotations")
_OF_MESH = ("points", "cells", "generator_tet", "generator_corners", "regions")


def is_npz(file: str, format: str | None) -> bool:
    """Whether the file is an .npz file according to its format or, without one, its name."""
    return format == "npz" if format else file.lower().endswith(".npz")


def write(what: object, file: str, compress: bool) -> None:
    """Writes a file, which appears complete or not at all. Raises FileError."""
    if not isinstance(what, (Map, Mesh)):
        raise ArgumentError(f"A {type(what).__name__} cannot be written to .npz files; a Map or Mesh "
                            "can.", "InvalidArgument")
    names = _OF_MAP if isinstance(what, Map) else _OF_MESH
    arrays: dict[str, Any] = {name: getattr(what, name) for name in names}
    arrays.update((f"feature_{name}", getattr(what.features, name)) for name in _FEATURES)
    arrays["feature_names"] = np.array([(str(dimension), str(tag), name) for dimension, tag, name
                                        in what.features._name_rows()], dtype=str)
    # Unknown arrays have no rows and are omitted from the file.
    always = ("points", "tets", "cells", "igm")
    arrays = {name: array for name, array in arrays.items() if len(array) or name in always}
    save = np.savez_compressed if compress else np.savez
    target = os.path.realpath(file)
    temporary = os.path.join(os.path.dirname(target), f".hexhex-{secrets.token_hex(8)}.tmp")
    try:
        with open(temporary, "xb") as output:
            save(output, **arrays)
            output.flush()
            os.fsync(output.fileno())
        os.replace(temporary, target)
    except BaseException as error:
        with contextlib.suppress(OSError):
            os.unlink(temporary)
        if isinstance(error, OSError):
            raise from_os_error("FileWrite", file, "cannot be written", error) from error
        raise


def read(file: str) -> Map | Mesh:
    """Reads a map or mesh. Raises FileError."""

    def fail(why: str) -> HexhexError:
        return make("FileSyntax", f"{file}: {why}.", "", 0, 0)

    try:
        with open(file, "rb") as source:
            if not zipfile.is_zipfile(source):
                raise ValueError("numpy.savez() writes zip archives")
            source.seek(0)
            archive = np.load(source, allow_pickle=False)
            arrays = {name: archive[name] for name in archive.files}
    except OSError as error:
        raise from_os_error("FileNotFound", file, "cannot be read", error) from error
    except Exception as error:  # about ten types, from numpy, zipfile and zlib
        raise fail(f"it is no .npz file, or damaged ({error})") from error
    rows = {name: arrays.pop(f"feature_{name}", None) for name in _FEATURES}
    named = arrays.pop("feature_names", np.empty((0, 3), dtype=str))
    for kind, needed, names, corners in ((Map, {"points", "tets", "igm"}, _OF_MAP, 3),
                                         (Mesh, {"points", "cells"}, _OF_MESH, 4)):
        if needed <= arrays.keys():
            try:
                return kind(**{name: array for name, array in arrays.items() if name in names},
                            features=Features(**rows, corners=corners, names={
                                (int(d), int(tag)): str(name) for d, tag, name in named}))
            except (ArgumentError, ValueError) as error:
                raise fail(str(error).rstrip(".")) from error
    raise fail("a map has the arrays points, tets and igm, a mesh points and cells; there are "
               f"{', '.join(sorted(arrays)) or 'none'}")
