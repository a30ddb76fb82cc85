#!/usr/bin/env python3
"""Reads a mesh of several kinds of cells with another program, which then writes it anew.

usage: mixed_with.py PROGRAM FILE OUT COPY

PROGRAM is meshio, vtk or gmsh. OUT gets a line for each cell, sorted: its number of corners, its
region and its corners, from 0 on. Fails unless all cells have a positive volume. COPY is what the
program writes. Exit code 77: the program is not installed.
"""

import sys

from handover import NOT_INSTALLED, open_in_gmsh

CORNERS = {"tetra": 4, "pyramid": 5, "wedge": 6, "hexahedron": 8}


def with_meshio(file, copy):
    import meshio

    mesh = meshio.read(file)
    regions = None
    for name in ("region", "gmsh:physical", "medit:ref"):
        regions = mesh.cell_data.get(name, regions)
    cells = []
    for number, block in enumerate(mesh.cells):
        if block.type not in CORNERS:
            continue
        for i, corners in enumerate(block.data):
            # meshio turns prisms of VTK round, as VTK's documentation had it before version 9.
            if block.type == "wedge" and file.endswith((".vtu", ".vtk")):
                corners = corners[[0, 2, 1, 3, 5, 4]]
            region = 0 if regions is None else int(regions[number].reshape(-1)[i])
            cells.append((region, corners))
    if file.endswith(".msh"):
        mesh.cell_data.pop("gmsh:geometrical", None)
        meshio.gmsh.write(copy, mesh, "2.2", binary=False)
    else:
        meshio.write(copy, mesh)
    return cells


def with_vtk(file, copy):
    import vtk

    xml = file.endswith(".vtu")
    reader = vtk.vtkXMLUnstructuredGridReader() if xml else vtk.vtkUnstructuredGridReader()
    reader.SetFileName(file)
    sizes = vtk.vtkCellSizeFilter()
    sizes.SetInputConnection(reader.GetOutputPort())
    validity = vtk.vtkCellValidator()
    validity.SetInputConnection(reader.GetOutputPort())
    sizes.Update()
    validity.Update()
    grid = reader.GetOutput()
    regions = grid.GetCellData().GetArray("region")
    cells = []
    for i in range(grid.GetNumberOfCells()):
        assert sizes.GetOutput().GetCellData().GetArray("Volume").GetTuple1(i) > 0, i
        assert validity.GetOutput().GetCellData().GetArray("ValidityState").GetTuple1(i) == 0, i
        ids = grid.GetCell(i).GetPointIds()
        corners = [ids.GetId(k) for k in range(ids.GetNumberOfIds())]
        cells.append((int(regions.GetTuple1(i)), corners))
    writer = vtk.vtkXMLUnstructuredGridWriter() if xml else vtk.vtkUnstructuredGridWriter()
    writer.SetFileName(copy)
    if not xml:
        writer.SetFileTypeToBinary()
    writer.SetInputData(grid)
    assert writer.Write() == 1
    return cells


def with_gmsh(file, copy):
    gmsh = open_in_gmsh(file)
    cells = []
    for dimension, tag in gmsh.model.getEntities(3):
        groups = gmsh.model.getPhysicalGroupsForEntity(dimension, tag)
        for elements, nodes in zip(*gmsh.model.mesh.getElements(dimension, tag)[1:]):
            assert (gmsh.model.mesh.getElementQualities(elements, "minDetJac") > 0).all()
            each = len(nodes) // len(elements)
            for i in range(len(elements)):
                cells.append((int(groups[0]), [int(v) - 1 for v in nodes[each * i : each * (i + 1)]]))
    gmsh.write(copy)
    gmsh.finalize()
    return cells


PROGRAMS = {"meshio": with_meshio, "vtk": with_vtk, "gmsh": with_gmsh}

if __name__ == "__main__":
    program, source, out, target = sys.argv[1:]
    try:
        found = PROGRAMS[program](source, target)
    except ImportError as error:
        print(error, file=sys.stderr)
        sys.exit(NOT_INSTALLED)
    with open(out, "w", encoding="utf-8") as listing:
        for line in sorted(f"{len(c)} {region} " + " ".join(map(str, c)) for region, c in found):
            print(line, file=listing)
