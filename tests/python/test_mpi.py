"""hexhex.mpi, by programs that mpirun starts."""

import shutil
import subprocess
import sys

import pytest

import hexhex

pytest.importorskip("mpi4py")
if not shutil.which("mpirun"):
    pytest.skip("no mpirun", allow_module_level=True)

PREPARE = """
import builtins, os, sys
import numpy as np
from mpi4py import MPI
import hexhex._errors, hexhex.mpi
comm = MPI.COMM_WORLD
def say(word):
    os.write(1, f"{word} ".encode())  # in one piece: mpirun mixes what processes write
"""


def run(ranks, program, *arguments):
    """Runs a program in as many processes, within two minutes. Returns the words that they say."""
    command = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", str(ranks), sys.executable,
               "-c", PREPARE + program, *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout.split()


@pytest.mark.parametrize("ranks", [1, 3])
def test_parts_are_those_of_one_process(ranks):
    assert run(ranks, """
map = hexhex.generate("torus", cells=3, charts="random")
part = hexhex.mpi.extract_part(comm, map if comm.rank == 0 else None, ghosts=1, scale=2)
other = hexhex.extract_parts(map, comm.size, ghosts=1, scale=2)[comm.rank]
for name in ("global_points", "global_cells", "point_owners", "ghost_parts", "ghost_layers"):
    assert np.array_equal(getattr(part, name), getattr(other, name)), name
assert np.array_equal(part.mesh.points, other.mesh.points)
assert np.array_equal(part.mesh.cells, other.mesh.cells)
assert (part.part, part.own_cells) == (comm.rank, other.own_cells)
say("same")
""") == ["same"] * ranks


def test_files_are_those_of_one_process(tmp_path):
    said = run(3, """
import pathlib
folder = pathlib.Path(sys.argv[1])
map = hexhex.generate("sphere")
if comm.rank == 0:
    hexhex.write(map, folder / "map.hexex")
    hexhex.extract_parts_to_file(folder / "one.pvtu", map, 3)
    (folder / "one.pvtu").rename(folder / "first.pvtu")
    (folder / "one").rename(folder / "first")
comm.Barrier()
say(hexhex.mpi.extract_parts_to_file(comm, folder / "one.pvtu", folder / "map.hexex")["cells"])
""", tmp_path)
    assert said == ["448"] * 3
    for k in range(3):
        assert (tmp_path / f"one/one_{k}.vtu").read_bytes() == (
            tmp_path / f"first/one_{k}.vtu").read_bytes()


@pytest.mark.parametrize("given, error", [
    ("'/nowhere/map.hexex'", hexhex.FileError), ("None", hexhex.ArgumentError), ("7", TypeError)])
def test_what_fails_in_one_process_is_raised_in_all(given, error):
    said = run(3, f"""
try:
    hexhex.mpi.extract_part(comm, {given} if comm.rank == 0 else None)
except ({error.__module__}.{error.__name__}, hexhex.HexhexError)[comm.rank > 0] as failure:
    say("raised")
""")
    assert said == ["raised"] * 3


def test_a_failure_in_the_waiting_ends_all_processes():
    command = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", "2", sys.executable, "-c",
               PREPARE + """
def fail(self, yes):
    raise RuntimeError("not on this machine")
if comm.rank == 1:
    given = hexhex.mpi._given
    def given_then_fail(map, team):
        values = given(map, team)
        type(team).all_say = fail
        return values
    hexhex.mpi._given = given_then_fail
hexhex.mpi.extract_part(comm, hexhex.generate("box"))
"""]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)
    assert done.returncode != 0 and "not on this machine" in done.stderr
