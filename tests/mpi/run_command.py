#!/usr/bin/env python3
"""`mpirun -n N hexhex extract` writes what one process writes, or one message and nothing.

    run_command.py COMMAND MPIRUN

Skipped (77) where MPI cannot start processes."""

import os
import pathlib
import subprocess
import sys
import tempfile

COMMAND, MPIRUN = sys.argv[1:]
SKIPPED, BAD_USAGE, FILE_PROBLEM = 77, 2, 3
EXTENSIONS = {"pvtu": ".pvtu", "msh": ".msh", "msh-split": ".msh", "exodus-e": ".e", "mfem": "", "openfoam": ".foam",
              "vtkhdf": ".vtkhdf"}
OFTEN = {"pvtu": (1, 2, 3, 4, 8), "vtkhdf": (1, 2, 3, 4, 8), "openfoam": (1, 3, 8)}  # others with 3 processes
SAME_VTKHDF = pathlib.Path(__file__).parents[1] / "parts" / "same_vtkhdf.py"


def run(*command, folder, fails=False):
    result = subprocess.run([str(word) for word in command], cwd=folder, capture_output=True, text=True,
                            timeout=100)
    if (result.returncode != 0) != fails:
        sys.exit(f"{command} ended with {result.returncode}:\n{result.stdout}{result.stderr}")
    return result


def contents(folder):
    return {path.relative_to(folder).as_posix(): path.read_bytes()
            for path in folder.rglob("*") if path.is_file()}


def require(condition, what):
    if not condition:
        sys.exit(what)


def check_vtkhdf(one, many):
    """The same datasets: one process does not know how long they become, and writes them by blocks."""
    python = os.environ.get("HEXHEX_PYTHON", sys.executable)
    result = subprocess.run([python, SAME_VTKHDF, one, many], capture_output=True, text=True, timeout=100)
    require(result.returncode in (0, SKIPPED), f"{many}: {result.stdout}{result.stderr}")
    if result.returncode == SKIPPED:
        print("without h5py, only that there is a .vtkhdf file")
    require([path.name for path in many.parent.iterdir()] == ["x.vtkhdf"], "one file is due")


def compile_parallel_hdf5(folder):
    """A program over HDF5's library for the MPI that is here; None without one."""
    version = subprocess.run([MPIRUN, "--version"], capture_output=True, text=True).stdout
    package = "hdf5-openmpi" if "Open" in version else "hdf5-mpich"
    try:
        flags = run("pkg-config", "--cflags", "--libs", package, folder=folder).stdout.split()
    except (SystemExit, OSError):
        print(f"without {package}, parallel HDF5 is not asked")
        return None
    program = folder / "parallel_hdf5"
    run("mpicc", pathlib.Path(__file__).with_name("parallel_hdf5.c"), "-o", program, *flags, folder=folder)
    return program


def check_parallel_hdf5(folder, map_file):
    """Each rank of parallel HDF5 reads its piece, and writes the same file."""
    program = compile_parallel_hdf5(folder)
    for processes in (1, 4) if program else ():
        run(MPIRUN, "-n", processes, COMMAND, "extract", map_file, "-o", "pieces.vtkhdf", "--ghosts", 1, "--mpi",
            folder=folder)
        (folder / "copy").mkdir(exist_ok=True)
        run(MPIRUN, "-n", processes, program, "pieces.vtkhdf", "copy/x.vtkhdf", folder=folder)
        check_vtkhdf(folder / "pieces.vtkhdf", folder / "copy/x.vtkhdf")


def check_files(folder, map_file):
    """The same files as one process writes, and, glued, the same bytes as the mesh in one piece."""
    run(COMMAND, "extract", map_file, "-o", "whole.vtu", "--quiet", folder=folder)
    for processes in (1, 2, 3, 4, 8):
        for name, extension in EXTENSIONS.items():
            if processes not in OFTEN.get(name, (3,)):
                continue
            ghosts = ["--ghosts", 1] if name in ("vtkhdf", "msh") and processes == 3 else []
            one, many = folder / "one", folder / "many"
            one.mkdir(), many.mkdir()
            said = run(MPIRUN, "-n", processes, COMMAND, "extract", map_file, "-o", many / f"x{extension}",
                       "--format", name, "--mpi", *ghosts, folder=folder).stdout
            run(COMMAND, "extract", map_file, "-o", one / f"x{extension}", "--format", name, "--parts",
                processes, *ghosts, "--quiet", folder=folder)
            if name == "vtkhdf":
                check_vtkhdf(one / "x.vtkhdf", many / "x.vtkhdf")
            else:
                require(contents(one) == contents(many), f"{name}: {processes} processes write other files than one")
            require(said.count("peak memory") == 1, f"one process shall speak, and not: {said}")
            if name == "pvtu":
                run(COMMAND, "convert", many / "x.pvtu", "glued.vtu", "--quiet", folder=folder)
                run(COMMAND, "convert", "whole.vtu", "copy.vtu", "--quiet", folder=folder)
                require((folder / "glued.vtu").read_bytes() == (folder / "copy.vtu").read_bytes(),
                        f"{processes} parts are not glued to the whole")
            for path in (one, many):
                run("rm", "-r", path, folder=folder)


def check_failures(folder, map_file):
    def fails(arguments, text, code, command=(COMMAND,)):
        before = contents(folder)
        words = [*command, "extract", *arguments] if arguments else command
        result = run(MPIRUN, "-n", 3, *words, folder=folder, fails=True)
        require(result.stderr.count("hexhex: error:") == 1 and text in result.stderr,
                f"{words}: one message with '{text}' is due, not\n{result.stderr}")
        require(result.returncode == code, f"{words}: {result.returncode} is no {code}")
        require(contents(folder) == before, f"{words}: something was written")

    fails(["none.hexex", "-o", "x.pvtu"], "none.hexex", FILE_PROBLEM)
    fails([map_file, "-o", "x.cgns"], "several processes cannot write", FILE_PROBLEM)
    fails([map_file, "-o", "x.vtu"], "no format of meshes in parts", FILE_PROBLEM)
    fails([map_file, "-o", "x.pvtu", "--parts", "2"], "2 parts and 3 processes", BAD_USAGE)
    # Each process has another name for the file, another format, or another map.
    own = "rank=${OMPI_COMM_WORLD_RANK:-$PMI_RANK}; "
    for words, text in [('"$1" extract "$2" -o x$rank.pvtu', "map.ovm --output x1.pvtu"),
                        ('"$1" extract "$2" -o x.msh --format msh$(test $rank = 2 && echo -split)', "msh-split"),
                        ('"$1" extract $rank.hexex -o x.pvtu', "1.hexex")]:
        fails([], text, BAD_USAGE, ["bash", "-c", own + "exec " + words, "bash", COMMAND, map_file])
    # One process cannot write where the others can: it works in another folder.
    (folder / "there").mkdir()
    elsewhere = "test ${OMPI_COMM_WORLD_RANK:-$PMI_RANK} = 1 && cd /; exec \"$@\""
    for file, name in [("x.msh", "msh-split"), ("x.vtkhdf", "vtkhdf"), ("x.foam", "openfoam")]:
        fails([map_file, "-o", f"there/{file}", "--format", name], "Process 1:", FILE_PROBLEM,
              ["bash", "-c", elsewhere, "bash", COMMAND])
    # The disk is full for one of them: its files may not become longer than that.
    small = "test ${OMPI_COMM_WORLD_RANK:-$PMI_RANK} = 1 && ulimit -f 20; trap '' XFSZ; exec \"$@\""
    for file in ["x.vtkhdf", "x.pvtu", "x.foam"]:
        fails([map_file, "-o", f"there/{file}", "--scale", 3], "Process 1:", FILE_PROBLEM,
              ["bash", "-c", small, "bash", COMMAND])


def check_killed(folder, map_file):
    """Where one process is killed, all end, and there is no file; temporaries may stay."""
    killed = "test ${OMPI_COMM_WORLD_RANK:-$PMI_RANK} != 1 && exec \"$@\"; \"$@\" & sleep 0.2; kill -9 $!; wait $!"
    run(MPIRUN, "-n", 3, "bash", "-c", killed, "bash", COMMAND, "extract", map_file, "-o", "killed.vtkhdf", "--scale", 60,
        folder=folder, fails=True)
    require(not (folder / "killed.vtkhdf").exists(), "there is a file although a process was killed")


def main():
    try:
        subprocess.run([MPIRUN, "-n", "2", "true"], check=True, capture_output=True, timeout=60)
    except (OSError, subprocess.SubprocessError) as error:
        print(f"skipped: {error}")
        sys.exit(SKIPPED)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        map_file = folder / "map.ovm"
        run(COMMAND, "generate", "shell", "-o", map_file, "--cells", 2, "--features", folder=folder)
        check_files(folder, map_file)
        check_parallel_hdf5(folder, map_file)
        check_failures(folder, map_file)
        check_killed(folder, map_file)
    print("The command works on MPI.")


main()
