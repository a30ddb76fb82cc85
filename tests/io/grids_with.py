#!/usr/bin/env python3
"""Writes structured grids and surfaces with VTK in all its ways, each grid also as an unstructured one.

usage: grids_with.py FOLDER

Exit code 77: VTK is not installed.
"""

import math
import pathlib
import sys

from handover import NOT_INSTALLED

SIZE = (4, 3, 5)


def write(writer, data, file, **settings):
    writer.SetInputData(data)
    for name, value in settings.items():
        getattr(writer, name)(*value)
    writer.SetFileName(str(file))
    assert writer.Write()


def write_all(name, data, folder, xml, legacy):
    for mode in ("Ascii", "Binary", "Appended"):
        for compressor in ("None", "ZLib"):
            writer = xml()
            write(writer, data, folder / f"{name}_{mode}_{compressor}.{writer.GetDefaultFileExtension()}",
                  **{"SetDataModeTo" + mode: (), "SetCompressorTypeTo" + compressor: ()})
    for version in (42, 51) if legacy else ():  # as text, it writes too few digits
        write(legacy(), data, folder / f"{name}_{version}.vtk", SetFileVersion=(version,), SetFileTypeToBinary=())


def write_with_vtk(folder):
    from vtkmodules import vtkIOLegacy as legacy, vtkIOXML as xml
    from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkIntArray, vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkImageData, vtkRectilinearGrid, vtkStructuredGrid
    from vtkmodules.vtkFiltersCore import vtkAppendFilter
    from vtkmodules.vtkFiltersSources import vtkCubeSource

    turned, image = vtkImageData(), vtkImageData()
    turned.SetExtent(2, 1 + SIZE[0], -1, SIZE[1] - 2, 0, SIZE[2] - 1)
    turned.SetDirectionMatrix(0, -1, 0, 1, 0, 0, 0, 0, 1)
    image.SetDimensions(*SIZE)
    for each in (turned, image):
        each.SetOrigin(0.1, 0.2, 0.3)
        each.SetSpacing(0.3, 0.7, 1.1)
    rectilinear, curved, points = vtkRectilinearGrid(), vtkStructuredGrid(), vtkPoints()
    rectilinear.SetDimensions(*SIZE)
    for size, setter in zip(SIZE, "XYZ"):
        axis = vtkDoubleArray()
        for i in range(size):
            axis.InsertNextValue(math.sqrt(i))
        getattr(rectilinear, f"Set{setter}Coordinates")(axis)
    points.SetDataTypeToDouble()
    for k in range(SIZE[2]):
        for j in range(SIZE[1]):
            for i in range(SIZE[0]):
                points.InsertNextPoint((1 + i) * math.cos(j / 3), (1 + i) * math.sin(j / 3), k / 7)
    curved.SetDimensions(*SIZE)
    curved.SetPoints(points)
    for name, grid, new, old in (
            ("turned", turned, xml.vtkXMLImageDataWriter, None),
            ("image", image, xml.vtkXMLImageDataWriter, legacy.vtkStructuredPointsWriter),
            ("rectilinear", rectilinear, xml.vtkXMLRectilinearGridWriter, legacy.vtkRectilinearGridWriter),
            ("curved", curved, xml.vtkXMLStructuredGridWriter, legacy.vtkStructuredGridWriter)):
        regions = vtkIntArray()
        regions.SetName("region")
        for i in range(grid.GetNumberOfCells()):
            regions.InsertNextValue(10 + i)
        grid.GetCellData().AddArray(regions)
        write_all(name, grid, folder, new, old)
        append = vtkAppendFilter()
        append.SetOutputPointsPrecision(1)  # double
        append.AddInputData(grid)
        append.Update()
        write(xml.vtkXMLUnstructuredGridWriter(), append.GetOutput(), folder / (name + ".vtu"),
              SetCompressorTypeToNone=())
    cube = vtkCubeSource()
    cube.Update()
    write_all("cube", cube.GetOutput(), folder, xml.vtkXMLPolyDataWriter, legacy.vtkPolyDataWriter)


if __name__ == "__main__":
    try:
        write_with_vtk(pathlib.Path(sys.argv[1]))
    except (ImportError, OSError) as error:
        print(error, file=sys.stderr)
        sys.exit(NOT_INSTALLED)
