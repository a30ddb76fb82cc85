"""Meshes in parts on MPI: each process makes one. Needs mpi4py; hexhex itself links no MPI.

Every function here is called by all processes of a communicator together, with the same arguments
but for the map, which only the first one needs to have. What fails in one process is raised in all.
docs/parts.md tells what a part has.

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
    """The part of this process, with the same numbers as the one of that rank in extract_parts().

    Args:
        comm: as many parts as it has processes are made.
        map: a map or its file; only that of the first process counts, and is sent to all others.
        threads: of each process; None for as many as there are cores.
        ghosts, partition, verify, scale, repair, round, tolerance, progress: as in extract_parts().

    Raises:
        ArgumentError: where MPI was initialized for one thread, and as extract_parts(); of the
            first process that failed, in all of them.
    """
    _check_partition(1, ghosts, partition)
    with _Team(comm) as team:
        return MeshPart._of(_hexhex.extract_part_of_team(
            team, *_given(map, team), ghosts, partition, verify,
            _options(scale, "atlas", tolerance, 0, repair, round), _threads(threads), progress))


def extract_parts_to_file(comm: MPI.Comm, file: Path, map: Map | Path | None, *, ghosts: int = 0,
                          partition: str = "curve", verify: bool = False, scale: int = 1,
                          format: str | None = None, threads: int | None = 1,
                          repair: bool = False, round: bool = False, tolerance: float = 1e-2,
                          progress: Progress | None = None) -> dict[str, Any]:
    """The same into files that all processes write together; docs/parts.md has the formats. Returns
    what hexhex.extract_parts_to_file() does, in all processes.

    Raises:
        FileError: if they cannot be written; and as extract_part().
    """
    _check_partition(1, ghosts, partition)
    with _Team(comm) as team:
        return _hexhex.extract_to_file_of_team(
            team, os.fspath(file), *_given(map, team), ghosts, partition, verify,
            _options(scale, "atlas", tolerance, 0, repair, round), format or "", _threads(threads),
            progress)


def _given(map: Map | Path | None, team: _Team) -> tuple[_hexhex.MapArrays | None, str]:
    """The map of the first process, as arrays or as a path. Without one, nobody waits for it."""
    arrays, path, failure = None, "", None
    try:
        if team.rank > 0:
            pass  # what other processes have does not count
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
    """What hexhex asks of connected processes, in a thread other than the main one."""

    _PIECE = 1 << 30  # MPI counts by int: longer messages go in pieces

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
        """Whether all processes say yes. Those that wait leave their core to others."""
        all_yes = np.zeros(1, np.int32)
        request = self._comm.Iallreduce(np.array([yes], np.int32), all_yes, MPI.MIN)
        pause = 1e-6
        while not request.Test():
            time.sleep(pause)
            pause = min(2 * pause, 1e-3)
        return bool(all_yes[0])

    def share(self, rank: int, data: npt.NDArray[Any]) -> None:
        """Gives an array of one process to all."""
        for begin in range(0, len(data), self._PIECE):
            self._comm.Bcast(data[begin:begin + self._PIECE], rank)

    def gather(self, mine: npt.NDArray[np.uint64], counts: npt.NDArray[np.uint64],
               everything: npt.NDArray[np.uint64]) -> None:
        """Puts what all give behind one another."""
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
        """Ends all processes."""
        self._comm.Abort(1)
