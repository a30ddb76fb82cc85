#!/usr/bin/env python3
"""Reads curved meshes that the command wrote with VTK, and compares them with what they must be.

    read_with_vtk.py PATH-OF-HEXHEX

Exit code 77, "skipped", without VTK (Debian: python3-vtk9; PyPI: vtk).
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "parts"))
from common import python_with  # noqa: E402

try:
    import numpy
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
except ImportError:
    python = python_with("vtk, numpy, meshio") or python_with("vtk, numpy")
    if python is not None:
        os.execv(python, [python, *sys.argv])
    print("skipped: VTK for Python is missing")
    sys.exit(77)

LINE, POLYGON, BIQUADRATIC_QUAD, TRIQUADRATIC_HEXAHEDRON, LAGRANGE_HEXAHEDRON = 3, 7, 28, 29, 72


def check(condition, message):
    if not condition:
        sys.exit(f"FAILED: {message}")


class Folder:
    """Runs the command in an empty folder."""

    def __init__(self, command, path):
        self.command = command
        self.path = pathlib.Path(path)

    def run(self, *arguments):
        subprocess.run([self.command, *map(str, arguments), "--quiet"], cwd=self.path, check=True)

    def read(self, name):
        reader = vtk.vtkXMLPolyDataReader() if name.endswith(".vtp") \
            else vtk.vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(self.path / name))
        reader.Update()
        return reader.GetOutput()

    def read_blocks(self, name):
        """Cells and, of `.cgns`, patches, as VTK reads a file of Exodus or CGNS."""
        from vtkmodules.vtkIOCGNSReader import vtkCGNSReader
        from vtkmodules.vtkIOExodus import vtkExodusIIReader
        reader = vtkCGNSReader() if name.endswith(".cgns") else vtkExodusIIReader()
        reader.SetFileName(str(self.path / name))
        if name.endswith(".cgns"):
            reader.EnableAllBases()
            reader.SetLoadMesh(True)
            reader.SetLoadBndPatch(True)
        reader.Update()
        leaves = reader.GetOutput().NewIterator()
        while not leaves.IsDoneWithTraversal():
            yield leaves.GetCurrentDataObject()
            leaves.GoToNextItem()

    def report(self):
        return json.loads((self.path / "r.json").read_text())


def cell_types(grid):
    return {grid.GetCellType(i) for i in range(grid.GetNumberOfCells())}


def volumes(grid):
    """Of the tets that VTK makes of the cells."""
    tets = vtk.vtkDataSetTriangleFilter()
    tets.SetInputData(grid)
    sizes = vtk.vtkCellSizeFilter()
    sizes.SetInputConnection(tets.GetOutputPort())
    sizes.Update()
    return vtk_to_numpy(sizes.GetOutput().GetCellData().GetArray("Volume"))


def areas(grid):
    sizes = vtk.vtkCellSizeFilter()
    sizes.SetInputData(grid)
    sizes.Update()
    return vtk_to_numpy(sizes.GetOutput().GetCellData().GetArray("Area"))


def tet_volume(file):
    """Volume of the tets of a .hexex file."""
    numbers = file.read_text().split()
    count = int(numbers[0])
    points = numpy.array(numbers[1:1 + 3 * count], float).reshape(-1, 3)
    tets = numpy.array(numbers[2 + 3 * count:], object).reshape(-1, 16)[:, :4].astype(int)
    p = points[tets]
    return numpy.linalg.det(p[:, 1:] - p[:, :1]).sum() / 6


def check_affine(cell, what):
    """Positions of nodes are an affine function of VTK's own coordinates, and not mirrored if it is a volume."""
    count = cell.GetNumberOfPoints()
    places = numpy.array(cell.GetParametricCoords()).reshape(-1, 3)[:count, :cell.GetCellDimension()]
    points = numpy.array([cell.GetPoints().GetPoint(i) for i in range(count)])
    affine = numpy.c_[numpy.ones(count), places]
    fit = numpy.linalg.lstsq(affine, points, rcond=None)[0]
    check(abs(affine @ fit - points).max() < 1e-12, f"node order of {what}")
    check(cell.GetCellDimension() < 3 or numpy.linalg.det(fit[1:]) > 0, f"orientation of {what}")


def test_exodus_and_cgns(folder):
    """Order 2: nodes of cells and patches in these formats' order, and groups; our reader gives them back."""
    folder.run("generate", "box", "--features", "--cells", 1, "--refine", 1, "-o", "box.hexex")
    folder.run("extract", "box.hexex", "-o", "o.vtu", "--order", 2)
    expected = folder.read("o.vtu")
    corners = [[expected.GetPoint(i) for i in (ids.GetId(k) for k in range(8))]
               for ids in (expected.GetCell(c).GetPointIds() for c in range(8))]
    for name in ("a.exo", "a.cgns"):
        written = subprocess.run([folder.command, "extract", "box.hexex", "-o", name, "--order", "2"],
                                 cwd=folder.path, capture_output=True, text=True, check=False)
        if "HDF5" in written.stderr or "no format of" in written.stderr:
            print(f"skipped {name}: this build has no HDF5")
            continue
        check(written.returncode == 0, written.stderr)
        types = {}
        for grid in folder.read_blocks(name):
            for c in range(grid.GetNumberOfCells()):
                cell = grid.GetCell(c)
                types[cell.GetCellType()] = types.get(cell.GetCellType(), 0) + 1
                check_affine(cell, f"{name}, type {cell.GetCellType()}")
        check(types[TRIQUADRATIC_HEXAHEDRON] == 8, f"cells of {name}: {types}")
        # VTK's reader of Exodus leaves side sets out unless asked.
        check(name == "a.exo" or types[BIQUADRATIC_QUAD] == 24, f"quads of {name}: {types}")
        folder.run("convert", name, "again.vtu")
        again = folder.read("again.vtu")
        check(again.GetNumberOfPoints() == 125, f"nodes of {name}")
        found = [[again.GetPoint(i) for i in (ids.GetId(k) for k in range(8))]
                 for ids in (again.GetCell(c).GetPointIds() for c in range(8))]
        check(found == corners, f"cells of {name} as they come back")
        for c in range(8):
            check_affine(again.GetCell(c), f"{name} that comes back")


def test_lagrange_nodes(folder):
    """In a box, positions are an affine function of VTK's own coordinates of the nodes."""
    folder.run("generate", "box", "--cells", 1, "--refine", 1, "-o", "box.hexex")
    for order in range(2, 10):
        folder.run("extract", "box.hexex", "-o", "o.vtu", "--order", order)
        grid = folder.read("o.vtu")
        check(grid.GetNumberOfCells() == 8, f"8 cells of order {order}")
        check(cell_types(grid) == {LAGRANGE_HEXAHEDRON if order > 2 else TRIQUADRATIC_HEXAHEDRON}, f"cell types of order {order}")
        check(grid.GetNumberOfPoints() == (2 * order + 1) ** 3, f"shared nodes of order {order}")
        for c in range(8):
            check_affine(grid.GetCell(c), f"order {order}")


def test_rewritten(folder):
    """Files that VTK and meshio make of ours, of versions 2.2 and 0.1, hold the same cells."""
    try:
        import meshio
    except ImportError:
        print("skipped with meshio, which is missing")
        meshio = None
    folder.run("generate", "sphere", "--cells", 2, "-o", "m.hexex")
    for order in (2, 3, 4):
        folder.run("extract", "m.hexex", "-o", "o.vtu", "--order", order)
        grid = folder.read("o.vtu")
        writer = vtk.vtkXMLUnstructuredGridWriter()
        writer.SetInputData(grid)
        writer.SetFileName(str(folder.path / "vtk.vtu"))
        writer.Write()
        files = ["vtk.vtu"]
        if meshio is not None:
            mesh = meshio.read(folder.path / "o.vtu")
            check(mesh.cells[0].data.shape == (grid.GetNumberOfCells(), (order + 1) ** 3), "meshio's cells")
            mesh.write(folder.path / "meshio.vtu")
            files.append("meshio.vtu")
        expected = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
        for file in files:
            folder.run("convert", file, "again.vtu")
            for name in (file, "again.vtu"):
                cells = vtk_to_numpy(folder.read(name).GetCells().GetConnectivityArray())
                check((cells == expected).all(), f"{name} of {file}, order {order}")


def test_lagrange_volume(folder):
    """The volume converges to that of the tets."""
    folder.run("generate", "sphere", "--cells", 1, "--refine", 4, "--charts", "random", "-o",
               "m.hexex")
    expected = tet_volume(folder.path / "m.hexex")
    errors = []
    for order in (1, 2, 4):
        folder.run("extract", "m.hexex", "-o", "o.vtu", "--order", order, "--report", "r.json")
        grid = folder.read("o.vtu")
        check(grid.GetNumberOfCells() == folder.report()["cells"], f"cells of order {order}")
        parts = volumes(grid)
        check(parts.min() > 0, f"positive volumes of order {order}")
        errors.append(abs(parts.sum() - expected) / expected)
    check(errors[0] > 2 * errors[1] > 4 * errors[2], f"volumes converge: {errors}")
    check(errors[2] < 1e-2, f"volume of order 4: {errors}")


def test_piecewise_linear(folder):
    folder.run("generate", "sphere", "--cells", 2, "--jitter", 0.5, "--charts", "random", "-o",
               "m.hexex")
    for end, line, polygon in (("vtu", LINE, POLYGON), ("vtp", LINE, POLYGON)):
        folder.run("extract", "m.hexex", "-o", "a.vtu", "--arcs", f"arcs.{end}", "--patches",
                   f"patches.{end}", "--report", "r.json")
        report = folder.report()
        arcs = folder.read(f"arcs.{end}")
        check(cell_types(arcs) <= {line}, f"lines in .{end}")
        check(arcs.GetNumberOfCells() ==
              report["arcs"]["count"] + report["arcs"]["inner_points"], f"segments in .{end}")
        edges = vtk_to_numpy(arcs.GetCellData().GetArray("hex_edge"))
        check(len(set(edges)) == report["arcs"]["count"], f"hex edges in .{end}")
        check(arcs.GetNumberOfPoints() ==
              report["vertices"] + report["arcs"]["inner_points"], f"points in arcs.{end}")
        patches = folder.read(f"patches.{end}")
        check(patches.GetNumberOfCells() == report["patches"]["polygons"], f"polygons in .{end}")
        faces = vtk_to_numpy(patches.GetCellData().GetArray("hex_face"))
        check(len(set(faces)) == report["patches"]["count"], f"hex faces in .{end}")
        check(areas(patches).min() >= 0, f"areas in .{end}")
        parameters = vtk_to_numpy(patches.GetFieldData().GetArray("corner_uv"))
        corners = sum(patches.GetCell(i).GetNumberOfPoints()
                      for i in range(patches.GetNumberOfCells()))
        check(parameters.shape == (corners, 2), f"corner_uv in .{end}")
        check(parameters.min() == 0 and parameters.max() == 1, f"range of corner_uv in .{end}")


def main():
    command = str(pathlib.Path(sys.argv[1]).resolve())
    for test in (test_lagrange_nodes, test_exodus_and_cgns, test_rewritten, test_lagrange_volume, test_piecewise_linear):
        with tempfile.TemporaryDirectory(prefix="hexhex-test-") as path:
            test(Folder(command, path))
        print(f"passed: {test.__name__}")


if __name__ == "__main__":
    main()
