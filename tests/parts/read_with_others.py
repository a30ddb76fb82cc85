#!/usr/bin/env python3
"""Has other programs read meshes in parts, and compares what they find with the mesh in one piece.

    read_with_others.py PATH-OF-HEXHEX

VTK reads .pvtu, .vtkhdf and the pieces of Exodus, gmsh the partitioned .msh, OpenFOAM checks and
reconstructs decomposed cases, SEACAS' libraries join Exodus by Nemesis' maps, PETSc and deal.II load
cells by global numbers on four ranks. What is not on this machine is skipped with a word; exit code 77
if nothing is there. HEXHEX_PYTHON names a Python with vtk and gmsh.
"""

import json
import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile

from common import check, python_with, read_gmsh, run

JUDGES = pathlib.Path(__file__).parent / "judges"


class Mesh:
    """What is known of a mesh in one piece."""

    def __init__(self, file):
        text = file.read_text()

        def count(section):
            return int(re.search(rf"(?m)^{section}\n(\d+)$", text)[1])
        self.points = count("Vertices")
        self.quads = count("Quadrilaterals")
        self.cells = count("Hexahedra")


VTK_SCRIPT = """
import sys, vtk
path, ghosts = sys.argv[1], int(sys.argv[2])
if path.endswith(".pvtu"):
    reader = vtk.vtkXMLPUnstructuredGridReader()
elif hasattr(vtk, "vtkHDFReader"):
    reader = vtk.vtkHDFReader()
else:
    print("none"); sys.exit()
reader.SetFileName(path)
reader.Update()
grid = reader.GetOutput()
if hasattr(grid, "GetBlock") or grid.IsA("vtkPartitionedDataSet"):
    append = vtk.vtkAppendFilter()
    for i in range(grid.GetNumberOfPartitions()):
        append.AddInputData(grid.GetPartition(i))
    append.Update()
    grid = append.GetOutput()
ids = grid.GetCellData().GetArray("GlobalCellIds")
owned = set()
ghost = grid.GetCellData().GetArray("vtkGhostType")
points = grid.GetPointData().GetArray("GlobalPointIds")
# Merge points by global number, as a parallel reader would.
cells = {}
for c in range(grid.GetNumberOfCells()):
    cell = grid.GetCell(c)
    corners = tuple(int(points.GetValue(cell.GetPointId(k))) for k in range(8))
    number = int(ids.GetValue(c))
    if ghost is None or ghost.GetValue(c) == 0:
        assert number not in owned
        owned.add(number)
    assert cells.setdefault(number, corners) == corners
if ghosts:
    # Each piece alone: with ghosts, faces between parts are no surface.
    quads = 0
    for piece in range(int(sys.argv[3])):
        reader.UpdatePiece(piece, int(sys.argv[3]), 0)
        part = reader.GetOutput()
        part_surface = vtk.vtkGeometryFilter()
        part_surface.SetInputData(part)
        part_surface.Update()
        faces = part_surface.GetOutput()
        marks = faces.GetCellData().GetArray("vtkGhostType")
        quads += sum(1 for i in range(faces.GetNumberOfCells())
                     if marks is None or marks.GetValue(i) == 0)
else:
    quads = -1
print(len(owned), len({p for c in cells.values() for p in c}), quads)
"""


PIECES_SCRIPT = """
import sys, vtk
prefix, last = sys.argv[1], int(sys.argv[2]) - 1
controller = vtk.vtkDummyController()
vtk.vtkMultiProcessController.SetGlobalController(controller)
reader = vtk.vtkPExodusIIReader()
reader.SetController(controller)
reader.SetFilePattern("%s.%i")
reader.SetFilePrefix(prefix)
reader.SetFileRange(0, last)
reader.SetFileName(prefix + ".0")
reader.Update()
print(reader.GetOutput().GetNumberOfCells())
"""


def judge_vtk(command, map_file, mesh, folder):
    python = python_with("vtk")
    if python is None:
        return "no VTK"
    for parts in (1, 5):
        for ghosts in (0, 1):
            file = folder / f"v{parts}{ghosts}.pvtu"
            run(command, "extract", map_file, "-o", file, "--parts", parts, "--ghosts", ghosts, "--quiet")
            found = run(python, "-c", VTK_SCRIPT, file, ghosts, parts).split()
            check(found[:2] == [str(mesh.cells), str(mesh.points)], f"VTK: {file} has {found}")
            if ghosts:
                check(int(found[2]) == mesh.quads,
                      f"VTK: the surface of {file} has {found[2]} quads, not {mesh.quads}")
    file = folder / "v.vtkhdf"
    run(command, "extract", map_file, "-o", file, "--parts", 5, "--quiet")
    found = run(python, "-c", VTK_SCRIPT, file, 0, 5).split()
    if found != ["none"]:
        check(found[:2] == [str(mesh.cells), str(mesh.points)], f"VTK: {file} has {found}")
    if subprocess.run([python, "-c", "import vtk; vtk.vtkPExodusIIReader"], check=False).returncode == 0:
        run(command, "extract", map_file, "-o", folder / "v.e", "--parts", 5, "--quiet")
        found = run(python, "-c", PIECES_SCRIPT, folder / "v.e.5", 5).split()
        check(found == [str(mesh.cells)], f"VTK: pieces of Exodus have {found}")
    return None


GMSH_SCRIPT = """
import sys, gmsh
gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
cells, nodes, parts, quads = set(), set(), set(), 0
for file in sys.argv[1:]:
    gmsh.clear()
    gmsh.open(file)
    nodes |= set(int(n) for n in gmsh.model.mesh.getNodes()[0])
    for dim, tag in gmsh.model.getEntities(3):
        parts |= set(gmsh.model.getPartitions(3, tag))
        types, tags, _ = gmsh.model.mesh.getElements(3, tag)
        for of_type in tags:
            cells |= set(int(e) for e in of_type)
    for dim, tag in gmsh.model.getEntities(2):
        quads += sum(len(t) for t in gmsh.model.mesh.getElements(2, tag)[1])
print(len(cells), len(nodes), quads, len(parts))
"""


def judge_gmsh(command, map_file, mesh, folder):
    python = python_with("gmsh")
    if python is None:
        return "no gmsh"
    for ghosts in (0, 1):
        file = folder / f"g{ghosts}.msh"
        run(command, "extract", map_file, "-o", file, "--parts", 4, "--ghosts", ghosts, "--quiet")
        found = run(python, "-c", GMSH_SCRIPT, file).split()
        check(found[-4:] == [str(n) for n in (mesh.cells, mesh.points, mesh.quads, 4)],
              f"gmsh: {file} has {found}")
    run(command, "extract", map_file, "-o", folder / "s.msh", "--parts", 4, "--format", "msh-split",
        "--quiet")
    found = run(python, "-c", GMSH_SCRIPT, *[folder / f"s_{k}.msh" for k in range(1, 5)]).split()
    check(found[-4:] == [str(n) for n in (mesh.cells, mesh.points, mesh.quads, 4)],
          f"gmsh: the files of four parts have {found}")
    return None


CONTROL = """FoamFile {{ version 2.0; format ascii; class dictionary; object {0}; }}
application icoFoam; startFrom startTime; startTime 0; stopAt endTime; endTime 1; deltaT 1;
writeControl timeStep; writeInterval 1; writeFormat ascii; writePrecision 17;
ddtSchemes {{}} gradSchemes {{}} divSchemes {{}} laplacianSchemes {{}} interpolationSchemes {{}}
snGradSchemes {{}} solvers {{}} numberOfSubdomains 4; method simple;
"""


def judge_openfoam(command, map_file, mesh, folder):
    if not shutil.which("checkMesh") or not shutil.which("mpirun"):
        return "no OpenFOAM"
    case = folder / "case"
    (case / "system").mkdir(parents=True)
    for name in ("controlDict", "fvSchemes", "fvSolution", "decomposeParDict"):
        (case / "system" / name).write_text(CONTROL.format(name))
    run(command, "extract", map_file, "-o", case / "m.foam", "--parts", 4, "--quiet")
    environment = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1",
                   "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
                   "OMPI_MCA_rmaps_base_oversubscribe": "1",
                   # Where Debian has its settings.
                   "WM_PROJECT_DIR": os.environ.get("WM_PROJECT_DIR", "/usr/share/openfoam")}
    said = run("mpirun", "-n", 4, "checkMesh", "-parallel", "-constant", "-case", case,
               env=environment)
    check(re.search(rf"cells:\s+{mesh.cells}\b", said), f"checkMesh counts cells:\n{said}")
    check("Mesh OK." in said, f"checkMesh:\n{said}")
    run("reconstructParMesh", "-constant", "-case", case, "-mergeTol", "1e-7",
        env=environment)
    said = run("checkMesh", "-constant", "-case", case, env=environment)
    check(re.search(rf"cells:\s+{mesh.cells}\b", said), f"reconstructParMesh:\n{said}")
    check(re.search(rf"points:\s+{mesh.points}\b", said), f"reconstructParMesh:\n{said}")
    return None


def judge_exodus(command, map_file, mesh, folder):
    if not shutil.which("cc") or not pathlib.Path("/usr/include/ne_nemesisI.h").exists():
        return "no SEACAS"
    run("cc", JUDGES / "nemesis_parts.c", "-o", folder / "nemesis_parts", "-lnemesis", "-lexoIIv2c")
    for parts in (1, 4):
        run(command, "extract", map_file, "-o", folder / "e.e", "--format", "exodus-e", "--parts", parts,
            "--quiet")
        found = run(folder / "nemesis_parts", parts, folder / f"e.e.{parts}").split()
        check(found == [str(mesh.cells), str(mesh.points)], f"SEACAS: {parts} pieces have {found}")
    return None


def judge_petsc(command, map_file, mesh, folder):
    if not shutil.which("mpicc") or subprocess.run(
            ["pkg-config", "--exists", "PETSc"], check=False).returncode != 0:
        return "no PETSc"
    flags = run("pkg-config", "--cflags", "--libs", "PETSc").split()
    run("mpicc", JUDGES / "petsc_parts.c", "-o", folder / "petsc_parts", *flags)
    between = write_ranks(command, map_file, folder, ghosts=0)
    said = run(*ON_FOUR_RANKS, folder / "petsc_parts", folder, mesh.points)
    check(said.split()[-3:] == [str(n) for n in (mesh.cells, mesh.points, mesh.quads + 2 * between)],
          f"PETSc has {said}")
    return None


def judge_dealii(command, map_file, mesh, folder):
    if not shutil.which("mpirun") or not pathlib.Path("/usr/share/cmake/deal.II").exists():
        return "no deal.II"
    run("cmake", "-S", JUDGES, "-B", folder / "build")
    run("cmake", "--build", folder / "build")
    write_ranks(command, map_file, folder, ghosts=1)
    said = run(*ON_FOUR_RANKS, folder / "build/dealii_parts", folder)
    check(said.split()[-3:] == [str(n) for n in (mesh.cells, mesh.points, mesh.quads)],
          f"deal.II has {said}")
    return None


ON_FOUR_RANKS = ("mpirun", "--allow-run-as-root", "--oversubscribe", "-n", 4)


def write_ranks(command, map_file, folder, ghosts):
    """What four ranks have of a mesh, read from Gmsh's files of parts.

    A file per rank, all numbers of 64 bits: how many vertices, own cells and cells with ghosts there
    are; number and position of each vertex; number, owner and eight vertices of each cell.
    @return how many faces lie between ranks
    """
    run(command, "extract", map_file, "-o", folder / "p", "--format", "msh-split", "--parts", 4,
        "--ghosts", ghosts, "--report", folder / "r.json", "--quiet")
    for rank in range(4):
        points, cells, owners = read_gmsh(folder / f"p_{rank + 1}")
        with open(folder / f"rank{rank}.bin", "wb") as file:
            file.write(struct.pack("<3q", len(points), len(cells) - len(owners), len(cells)))
            for number, position in points.items():
                file.write(struct.pack("<q3d", number, *position))
            for number, corners in cells.items():
                file.write(struct.pack("<10q", number, owners.get(number, rank), *corners))
    return json.loads((folder / "r.json").read_text())["parts"]["shared_faces"]


def main():
    command = pathlib.Path(sys.argv[1]).resolve()
    skipped = 0
    judges = {"VTK": judge_vtk, "gmsh": judge_gmsh, "OpenFOAM": judge_openfoam,
              "SEACAS": judge_exodus, "PETSc": judge_petsc, "deal.II": judge_dealii}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        map_file = folder / "map.hexex"
        run(command, "generate", "torus", "-o", map_file, "--cells", 3, "--quiet")
        run(command, "extract", map_file, "-o", folder / "whole.mesh", "--quiet")
        mesh = Mesh(folder / "whole.mesh")
        for judge, function in judges.items():
            place = folder / judge
            place.mkdir()
            missing = function(command, map_file, mesh, place)
            skipped += missing is not None
            print(f"{judge}: {'skipped, ' + missing if missing else 'passed'}", flush=True)
    sys.exit(77 if skipped == len(judges) else 0)


if __name__ == "__main__":
    main()
