#!/usr/bin/env python3
"""Compares two .vtkhdf files dataset by dataset with h5py, and as VTK reads them.

    same_vtkhdf.py ONE OTHER

Exit code 77 where h5py is not installed."""

import sys

SKIPPED = 77
try:
    import h5py
except ImportError:
    sys.exit(SKIPPED)


def contents(path):
    """Groups, datasets and attributes by name; of a dataset its type, shape and bytes."""
    found = {}

    def add(name, item):
        found[name] = {key: str(value) for key, value in item.attrs.items()}
        if isinstance(item, h5py.Dataset):
            found[name] |= {"dtype": str(item.dtype), "shape": item.shape, "bytes": item[()].tobytes()}
    with h5py.File(path) as file:
        file.visititems(add)
    return found


def seen_by_vtk(path):
    """What VTK makes of it, as bytes by name; nothing where it cannot read VTKHDF."""
    try:
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkFiltersCore import vtkAppendFilter
        from vtkmodules.vtkIOHDF import vtkHDFReader
    except ImportError:
        return {}
    reader = vtkHDFReader()
    reader.SetFileName(path)
    reader.Update()
    grid = reader.GetOutputDataObject(0)
    if not grid.IsA("vtkUnstructuredGrid"):
        append = vtkAppendFilter()
        for i in range(grid.GetNumberOfPartitions()):
            append.AddInputData(grid.GetPartition(i))
        append.Update()
        grid = append.GetOutput()
    seen = {"cells": vtk_to_numpy(grid.GetCells().GetConnectivityArray()).tobytes(),
            "points": vtk_to_numpy(grid.GetPoints().GetData()).tobytes()}
    for kind, data in [("point", grid.GetPointData()), ("cell", grid.GetCellData())]:
        for i in range(data.GetNumberOfArrays()):
            array = data.GetArray(i)
            seen[f"{kind} {array.GetName()}"] = vtk_to_numpy(array).tobytes()
    assert grid.GetNumberOfCells() > 0, f"VTK finds no cells in {path}"
    return seen


def main():
    for look in (contents, seen_by_vtk):
        one, other = (look(path) for path in sys.argv[1:])
        differing = [name for name in one.keys() | other.keys() if one.get(name) != other.get(name)]
        if differing:
            sys.exit(f"{look.__name__}: {', '.join(sorted(differing))} differ.")
    if "VTKHDF/NumberOfPoints" not in contents(sys.argv[1]):
        sys.exit(f"{sys.argv[1]} has no parts.")


main()
