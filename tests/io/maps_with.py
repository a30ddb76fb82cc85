#!/usr/bin/env python3
"""Reads maps with another program, and writes them again in all ways that the program knows.

usage: maps_with.py PROGRAM FOLDER FILE...

PROGRAM is vtk or meshio. All files hold the same tets with the cell array `igm`; they are compared,
and the first one is written to FOLDER. Exit code 77: the program is not installed.
"""

import pathlib
import sys

from handover import NOT_INSTALLED


def write_with_vtk(folder, files):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOLegacy import vtkUnstructuredGridReader, vtkUnstructuredGridWriter
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter

    grids = []
    for file in files:
        if file.suffix == ".vtu":
            reader = vtkXMLUnstructuredGridReader()
        else:
            reader = vtkUnstructuredGridReader()
            reader.ReadAllFieldsOn()
        reader.SetFileName(str(file))
        reader.Update()
        grids.append(reader.GetOutput())
        assert grids[-1].GetCellType(0) == 10, file
        for of in (lambda grid: grid.GetPoints().GetData(),
                   lambda grid: grid.GetCells().GetConnectivityArray(),
                   lambda grid: grid.GetCellData().GetArray("igm")):
            assert (vtk_to_numpy(of(grids[-1])) == vtk_to_numpy(of(grids[0]))).all(), file
    for mode in ("Ascii", "Binary", "Appended"):
        for compressor in ("None", "ZLib", "LZ4", "LZMA"):
            for encoded in (0, 1):
                writer = vtkXMLUnstructuredGridWriter()
                writer.SetInputData(grids[0])
                getattr(writer, "SetDataModeTo" + mode)()
                getattr(writer, "SetCompressorTypeTo" + compressor)()
                writer.SetEncodeAppendedData(encoded)
                for order in ("Little", "Big"):
                    getattr(writer, f"SetByteOrderTo{order}Endian")()
                    writer.SetFileName(str(folder / f"{mode}_{compressor}_{encoded}_{order}.vtu"))
                    assert writer.Write()
    for version in (42, 51):
        writer = vtkUnstructuredGridWriter()
        writer.SetInputData(grids[0])
        writer.SetFileVersion(version)
        writer.SetFileTypeToBinary()  # as text, it writes too few digits
        writer.SetFileName(str(folder / f"legacy_{version}.vtk"))
        assert writer.Write()


def write_with_meshio(folder, files):
    import meshio

    meshes = [meshio.read(file) for file in files]
    for file, mesh in zip(files, meshes):
        assert mesh.cells[0].type == "tetra", file
        assert (mesh.points == meshes[0].points).all(), file
        assert (mesh.cell_data["igm"][0] == meshes[0].cell_data["igm"][0]).all(), file
    for name in ("a.vtu", "b.vtk"):
        meshio.write(folder / name, meshes[0])
    # Only the tets: for pairs of meshes.
    tets = meshio.Mesh(meshes[0].points, meshes[0].cells)
    for name in ("tets.mesh", "tets.meshb"):
        meshio.write(folder / name, tets)
    meshio.write(folder / "tets4.msh", tets, file_format="gmsh")
    meshio.write(folder / "tets2.msh", tets, file_format="gmsh22")


def main():
    program, folder, *files = sys.argv[1:]
    try:
        globals()["write_with_" + program](pathlib.Path(folder), [pathlib.Path(f) for f in files])
    except ImportError as error:
        print(error, file=sys.stderr)
        return NOT_INSTALLED
    return 0


if __name__ == "__main__":
    sys.exit(main())
