"""Exceptions of the package: one class per family, each with a code and a place."""

from __future__ import annotations

import errno
import os
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ._types import RepairReport


class HexhexError(Exception):
    """Base class of all errors of the library.

    Attributes:
        code: what went wrong, e.g. ``"FlippedTet"``: docs/user/errors.md explains each code.
        place: where, e.g. ``"tet 12"``; empty if the error has no place.
        index: number of the tet, vertex, cell, or line of a file; 0 without a place.
        second: the second number of a place (an edge's other vertex, a face's opposite corner).
        repair: for errors of repair(): the RepairReport of what was done until then; otherwise
            None.
    """

    def __init__(self, message: str, code: str = "Internal", place: str = "", index: int = 0,
                 second: int = 0) -> None:
        super().__init__(message)
        self.code = code
        self.place = place
        self.index = index
        self.second = second
        self.repair: RepairReport | None = None

    def __reduce__(self) -> tuple[object, ...]:
        return (make, (self.code, str(self), self.place, self.index, self.second),
                {"repair": self.repair})


class ArgumentError(HexhexError, ValueError):
    """An option or array is out of range."""


class FileError(HexhexError, OSError):
    """A file cannot be read, understood, or written. ``errno`` is the system's reason, if there is
    one; the error is then also a FileNotFoundError, PermissionError, IsADirectoryError or
    NotADirectoryError, as appropriate."""

    def __str__(self) -> str:
        return str(self.args[0])


class _NotFound(FileError, FileNotFoundError):
    pass


class _Forbidden(FileError, PermissionError):
    pass


class _IsFolder(FileError, IsADirectoryError):
    pass


class _NoFolder(FileError, NotADirectoryError):
    pass


_BY_ERRNO: dict[int, type[FileError]] = {
    errno.ENOENT: _NotFound, errno.EACCES: _Forbidden, errno.EPERM: _Forbidden,
    errno.EISDIR: _IsFolder, errno.ENOTDIR: _NoFolder}
for _class in (_NotFound, _Forbidden, _IsFolder, _NoFolder):
    _class.__doc__ = FileError.__doc__
# The library ends its messages with the system's message, or replaces this one by advice.
_MISSING_FOLDER = "its folder does not exist; make it with "
_ERRNOS = {os.strerror(number): number for number in errno.errorcode}
_ERRNOS["it is a folder"] = errno.EISDIR


class MapError(HexhexError, ValueError):
    """The mesh or the map violates a condition of integer-grid maps."""


class CancelledError(HexhexError):
    """The caller cancelled the work."""


class MemoryExhaustedError(HexhexError, MemoryError):
    """Memory is exhausted."""


class InternalError(HexhexError, RuntimeError):
    """A bug in the library, or a result that failed verification."""


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
    """Creates the error for a code of the library."""
    family = _FAMILIES.get(code, MapError)
    number = None
    if family is FileError:
        number = _ERRNOS.get(message.rstrip(".").rpartition(": ")[2])
        if number is None and _MISSING_FOLDER in message:
            number = errno.ENOENT
        family = _BY_ERRNO.get(number or 0, FileError)
    error = family(message, code, place, index, second)
    if isinstance(error, FileError) and number is not None:
        error.errno, error.strerror = number, os.strerror(number)
        error.filename = message.partition(": ")[0]
    return error


def from_os_error(code: str, file: str, what: str, error: OSError) -> HexhexError:
    """Creates the error for a file that Python could not read or write."""
    reason = os.strerror(error.errno) if error.errno else str(error)
    return make(code, f"{file}: the file {what}: {reason}.", "", 0, 0)
