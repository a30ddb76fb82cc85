"""Meshes in parts over MPI, one per process. Requires mpi4py; hexhex itself is not linked with MPI.

All processes of a communicator must call each function together, with the same arguments except for
the map, which only the first process needs to have. An error in one process is raised in all of
them. docs/user/parts.md describes the contents of a part.

    mpirun -n 4 python solver.py
"""

from __future__ import annotations

import os
import time
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
from mpi4py import MPI

from . import Map, MeshPart, _check_partition, _hexhex, _options, _threads
from ._errors import ArgumentError

if TYPE_CHECKING:
    from . import Path, Progress

__all__ = ["extract_part", "extract_parts_to_file"]


def extract_part(comm: MPI.Comm, map: Map | Path | None, *, ghosts: int = 0,
                 partition: str = "curve", verify: bool = False, scale: int = 1,
                 threads: int | None = 1, repair: bool = False, round: bool = False, tolerance: float = 1e-2,
                 progress: Progress | None = None) -> MeshPart:
    """Extracts the part of this process, identical to the part with its rank from extract_parts().

    Args:
        comm: communicator; there are as many parts as processes.
        map: a map or its file; only that of the first process is used, and sent to all others.
        threads: threads per process; None for as many as there are cores.
        ghosts, partition, verify, scale, repair, round, tolerance, progress: as in extract_parts().

    Raises:
        ArgumentError: if MPI was initialized for a single thread; and as extract_parts(): the error
            of the first process that failed, in all processes.
    """
    _check_partition(1, ghosts, partition)
    with _Team(comm) as team:
        return MeshPart._of(_hexhex.extract_part_of_team(
            team, *_given(map, team), ghosts, partition, verify,
            _options(scale, "atlas", tolerance, repair, round), _threads(threads), progress))


def extract_parts_to_file(comm: MPI.Comm, file: Path, map: Map | Path | None, *, ghosts: int = 0,
                          partition: str = "curve", verify: bool = False, scale: int = 1,
                          format: str | None = None, threads: int | None = 1,
                          repair: bool = False, round: bool = False, tolerance: float = 1e-2,
                          progress: Progress | None = None) -> dict[str, Any]:
    """Extracts the same parts to files that all processes write together; docs/user/parts.md lists the
    formats. Returns the result of hexhex.extract_parts_to_file() in all processes.

    Raises:
        FileError: if the files cannot be written; and as extract_part().
    """
    _check_partition(1, ghosts, partition)
    with _Team(comm) as team:
        return _hexhex.extract_to_file_of_team(
            team, os.fspath(file), *_given(map, team), ghosts, partition, verify,
            _options(scale, "atlas", tolerance, repair, round), format or "", _threads(threads),
            progress)


def _given(map: Map | Path | None, team: _Team) -> tuple[_hexhex.MapArrays | None, str]:
    """Returns the map of the first process, as arrays or as a path. If it has none, all processes
    learn of it instead of waiting."""
    arrays, path, failure = None, "", None
    try:
        if team.rank > 0:
            pass  # arguments on other ranks are ignored
        elif isinstance(map, Map):
            arrays = map._arrays()
        elif map is not None:
            path = os.fspath(map)
        else:
            raise ArgumentError("The first process has no map.", "InvalidArgument")
    except Exception as error:  # noqa: BLE001: the others have to learn of it, whatever it is
        failure = error
    if not team.all_say(failure is None):
        raise failure or ArgumentError("The first process has no map to send.", "InvalidArgument")
    return arrays, path


class _Team:
    """Communication that hexhex requires between processes, from a thread other than the main
    one."""

    _PIECE = 1 << 30  # MPI counts are ints: split longer messages

    def __init__(self, comm: MPI.Comm) -> None:
        if MPI.Query_thread() < MPI.THREAD_SERIALIZED:
            raise ArgumentError("MPI was initialized for the main thread alone. Set "
                                'mpi4py.rc.thread_level = "serialized" before the import of MPI.',
                                "InvalidArgument")
        self._comm = comm.Dup()
        self._comm.Set_errhandler(MPI.ERRORS_ARE_FATAL)
        self.rank = comm.Get_rank()
        self.size = comm.Get_size()

    def __enter__(self) -> _Team:
        return self

    def __exit__(self, *_: object) -> None:
        self._comm.Free()

    def all_say(self, yes: bool) -> bool:
        """Whether `yes` is true in all processes. Waiting processes yield their core to others."""
        all_yes = np.zeros(1, np.int32)
        request = self._comm.Iallreduce(np.array([yes], np.int32), all_yes, MPI.MIN)
        pause = 1e-6
        while not request.Test():
            time.sleep(pause)
            pause = min(2 * pause, 1e-3)
        return bool(all_yes[0])

    def share(self, rank: int, data: npt.NDArray[Any]) -> None:
        """Broadcasts an array of one process to all."""
        for begin in range(0, len(data), self._PIECE):
            self._comm.Bcast(data[begin:begin + self._PIECE], rank)

    def gather(self, mine: npt.NDArray[np.uint64], counts: npt.NDArray[np.uint64],
               everything: npt.NDArray[np.uint64]) -> None:
        """Concatenates the arrays of all processes."""
        if len(everything) <= self._PIECE:
            self._comm.Allgatherv(mine, [everything, counts.astype(np.int64).tolist()])
            return
        begin = 0
        for rank, count in enumerate(counts.tolist()):
            part = everything[begin:begin + count]
            if rank == self.rank:
                part[:] = mine
            self.share(rank, part)
            begin += count

    def abort(self) -> None:
        """Terminates all processes."""
        self._comm.Abort(1)
