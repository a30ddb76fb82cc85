#!/usr/bin/env python3
"""Reads a hexahedral mesh in a format of an optional component with VTK.

usage: read_optional.py FORMAT FILE OUT

FORMAT is vtkhdf, exodus, cgns or openfoam. OUT.points gets the coordinates (float64), OUT.cells the
0-based corners of the hexahedra (int64; of openfoam in ascending order), OUT.groups a line for each
region and each group of quads: its name, and how many elements it has. Exit code 77: VTK is not
installed. (VTK reads coordinates of openfoam as float32.)
"""

import sys

from handover import hand_over


def arrays_of(grid):
    from vtkmodules.util.numpy_support import vtk_to_numpy

    corners = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
    return vtk_to_numpy(grid.GetPoints().GetData()), corners.reshape(-1, 8)


def leaves_of(tree):
    """All data sets of a tree with their names."""
    from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet

    iterator = tree.NewIterator()
    while not iterator.IsDoneWithTraversal():
        name = iterator.GetCurrentMetaData().Get(vtkCompositeDataSet.NAME())
        yield name, iterator.GetCurrentDataObject()
        iterator.GoToNextItem()


def read_vtkhdf(file):
    import numpy
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOHDF import vtkHDFReader

    reader = vtkHDFReader()
    reader.SetFileName(file)
    reader.Update()
    grid = reader.GetOutput()
    assert all(grid.GetCellType(i) == 12 for i in range(grid.GetNumberOfCells()))
    assert grid.GetCellData().GetArray("scaled_jacobian") is not None
    regions = vtk_to_numpy(grid.GetCellData().GetArray("region"))
    groups = {f"region_{r}": int((regions == r).sum()) for r in numpy.unique(regions)}
    quads = vtk_to_numpy(grid.GetFieldData().GetArray("feature_quads"))
    groups |= {f"surface_{t}": int((quads[:, 4] == t).sum()) for t in numpy.unique(quads[:, 4])}
    return *arrays_of(grid), groups


def read_exodus(file):
    import numpy
    from vtkmodules.vtkIOExodus import vtkExodusIIReader

    reader = vtkExodusIIReader()
    reader.SetFileName(file)
    reader.SetSqueezePoints(False)
    reader.UpdateInformation()
    groups = {}
    for kind in (reader.ELEM_BLOCK, reader.SIDE_SET, reader.NODE_SET):
        for i in range(reader.GetNumberOfObjects(kind)):
            groups[reader.GetObjectName(kind, i)] = reader.GetNumberOfEntriesInObject(kind, i)
    reader.Update()
    blocks = [arrays_of(grid) for _, grid in leaves_of(reader.GetOutput())]
    return blocks[0][0], numpy.concatenate([corners for _, corners in blocks]), groups


def read_cgns(file):
    from vtkmodules.vtkIOCGNSReader import vtkCGNSReader

    reader = vtkCGNSReader()
    reader.SetFileName(file)
    reader.EnableAllBases()
    reader.SetLoadMesh(True)
    reader.SetLoadBndPatch(True)
    reader.Update()
    leaves = [leaf for _, leaf in leaves_of(reader.GetOutput())]
    groups = {}
    hexahedra = None
    for leaf in leaves:
        if leaf.GetCellType(0) == 12:
            hexahedra = leaf
        elif leaf.GetFieldData().HasArray("ispatch"):
            name = leaf.GetFieldData().GetAbstractArray("FamilyName")
            groups[str(len(groups)) if name is None else name.GetValue(0)] = leaf.GetNumberOfCells()
    from vtkmodules.util.numpy_support import vtk_to_numpy

    cells = hexahedra.GetCells()
    corners = vtk_to_numpy(cells.GetConnectivityArray())
    offsets = vtk_to_numpy(cells.GetOffsetsArray())
    count = int((offsets[1:] - offsets[:-1] == 8).sum())
    points = vtk_to_numpy(hexahedra.GetPoints().GetData())
    return points, corners[: 8 * count].reshape(-1, 8), {"patches": len(groups),
                                                         "quads": sum(groups.values())}


def read_openfoam(file):
    import numpy
    from vtkmodules.vtkIOGeometry import vtkOpenFOAMReader

    reader = vtkOpenFOAMReader()
    reader.SetFileName(file)
    reader.ReadZonesOn()
    reader.UpdateInformation()
    reader.EnableAllPatchArrays()
    reader.Update()
    leaves = dict(leaves_of(reader.GetOutput()))
    groups = {n: g.GetNumberOfCells() for n, g in leaves.items() if n != "internalMesh"}
    points, corners = arrays_of(leaves["internalMesh"])
    return points, numpy.sort(corners, axis=1), groups


READERS = {
    "vtkhdf": read_vtkhdf,
    "exodus": read_exodus,
    "cgns": read_cgns,
    "openfoam": read_openfoam,
}

if __name__ == "__main__":
    sys.exit(hand_over(READERS))
