"""What the package raises: one class per family, each with code and place."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ._types import RepairReport


class HexhexError(Exception):
    """Base of all errors of the library.

    Attributes:
        code: what went wrong, e.g. ``"FlippedTet"``: docs/errors.md explains each.
        place: where, e.g. ``"tet 12"``; empty if it is about no place.
        index: number of the tet, vertex, cell, or line of a file; 0 without a place.
        second: the second number of a place (an edge's other vertex, a face's opposite corner).
        repair: of an error of repair(): what it had done until then, a RepairReport; else None.
    """

    def __init__(self, message: str, code: str = "Internal", place: str = "", index: int = 0,
                 second: int = 0) -> None:
        super().__init__(message)
        self.code = code
        self.place = place
        self.index = index
        self.second = second
        self.repair: RepairReport | None = None


class ArgumentError(HexhexError, ValueError):
    """An option or array is out of range."""


class FileError(HexhexError, OSError):
    """A file cannot be read, understood, or written."""


class MapError(HexhexError, ValueError):
    """The mesh or the map violates a condition of integer-grid maps."""


class CancelledError(HexhexError):
    """The caller asked to stop."""


class MemoryExhaustedError(HexhexError, MemoryError):
    """Memory was exhausted."""


class InternalError(HexhexError, RuntimeError):
    """A bug of the library, or a result that failed its verification."""


_FAMILIES: dict[str, type[HexhexError]] = {
    "InvalidArgument": ArgumentError,
    "FileNotFound": FileError,
    "FileSyntax": FileError,
    "FileUnsupported": FileError,
    "FileWrite": FileError,
    "Cancelled": CancelledError,
    "OutOfMemory": MemoryExhaustedError,
    "VerificationFailed": InternalError,
    "Internal": InternalError,
}


def make(code: str, message: str, place: str, index: int, second: int) -> HexhexError:
    """The error for a code of the library."""
    return _FAMILIES.get(code, MapError)(message, code, place, index, second)
