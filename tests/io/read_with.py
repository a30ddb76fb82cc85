#!/usr/bin/env python3
"""Reads a hexahedral mesh with another program and hands over what that program understood.

usage: read_with.py PROGRAM FILE OUT

PROGRAM is meshio, vtk, gmsh or mfem. OUT.points gets the coordinates (float64), OUT.cells the
0-based corners of the hexahedra (int64), OUT.groups a line for each group of quads (of `.inp`: node
set): its name or number, and how many elements it has. Exit code 77: the program is not installed.
"""

import sys

from handover import hand_over, open_in_gmsh


def read_with_meshio(file):
    import meshio
    import numpy

    mesh = meshio.read(file)
    cells = mesh.cells_dict["hexahedron"]
    groups = {}
    if "gmsh:physical" in mesh.cell_data:
        names = {(int(v[0]), int(v[1])): name for name, v in mesh.field_data.items()}
        for block, tags in zip(mesh.cells, mesh.cell_data["gmsh:physical"]):
            if block.type == "quad":
                for tag in numpy.unique(tags):
                    name = names[int(tag), 2]
                    groups[name] = groups.get(name, 0) + int((tags == tag).sum())
    elif "medit:ref" in mesh.cell_data:
        for block, tags in zip(mesh.cells, mesh.cell_data["medit:ref"]):
            if block.type == "quad":
                groups |= {str(t): int((tags == t).sum()) for t in numpy.unique(tags)}
    else:
        groups = {name: len(nodes) for name, nodes in mesh.point_sets.items()}
    return mesh.points, cells, groups


def read_with_vtk(file):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOLegacy import vtkUnstructuredGridReader
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

    xml = file.endswith(".vtu")
    reader = vtkXMLUnstructuredGridReader() if xml else vtkUnstructuredGridReader()
    reader.SetFileName(file)
    reader.Update()
    grid = reader.GetOutput()
    assert all(grid.GetCellType(i) == 12 for i in range(grid.GetNumberOfCells()))
    corners = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 8)
    return vtk_to_numpy(grid.GetPoints().GetData()), corners, {}


def read_with_gmsh(file):
    import numpy

    gmsh = open_in_gmsh(file)
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    order = numpy.argsort(tags)
    points = coordinates.reshape(-1, 3)[order]
    _, cells = gmsh.model.mesh.getElementsByType(5)
    corners = numpy.searchsorted(tags[order], cells).reshape(-1, 8)
    groups = {}
    for dimension, tag in gmsh.model.getPhysicalGroups(2):
        name = gmsh.model.getPhysicalName(dimension, tag)
        for entity in gmsh.model.getEntitiesForPhysicalGroup(dimension, tag):
            quads, _ = gmsh.model.mesh.getElementsByType(3, entity)
            groups[name] = groups.get(name, 0) + len(quads)
    gmsh.finalize()
    return points, corners, groups


def read_with_mfem(file):
    import mfem.ser as mfem
    import numpy

    mesh = mfem.Mesh(file, 0, 0, False)  # neither refined nor with corners exchanged
    assert mesh.Dimension() == 3
    assert mesh.CheckElementOrientation(False) == 0
    points = numpy.array([mesh.GetVertexArray(i) for i in range(mesh.GetNV())])
    corners = numpy.array([mesh.GetElementVertices(i) for i in range(mesh.GetNE())])
    groups = {}
    for i in range(mesh.GetNBE()):
        attribute = str(mesh.GetBdrAttribute(i))
        groups[attribute] = groups.get(attribute, 0) + 1
    return points, corners, groups


READERS = {
    "meshio": read_with_meshio,
    "vtk": read_with_vtk,
    "gmsh": read_with_gmsh,
    "mfem": read_with_mfem,
}

if __name__ == "__main__":
    sys.exit(hand_over(READERS))
