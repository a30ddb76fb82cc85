"""Loads the plugin in ParaView's Python, extracts maps, and compares with the hexhex command.

    pvpython test_plugin.py PLUGIN-FOLDER HEXHEX OUTPUT-FOLDER [DATA-FOLDER]

Leaves pictures in the output folder. Ends with exit code 1 at the first difference.
"""

import glob
import json
import os
import subprocess
import sys

from paraview import servermanager
from paraview.simple import *
from paraview.vtk import vtkFileOutputWindow, vtkOutputWindow

PLUGINS, COMMAND, OUT = sys.argv[1:4]
DATA = sys.argv[4] if len(sys.argv) > 4 else ""


# A tet whose boundary is not on integer planes.
ONE_TET = """4
0 0 0
1 0 0
0 1 0
0 0 1
1
0 1 2 3 0 0 0 1 0 0 0 1 0 0 0 1
"""


def require(condition, message):
    if not condition:
        print("FAILED:", message)
        sys.exit(1)


def run(*arguments, expect=0):
    """The command's errors."""
    result = subprocess.run([COMMAND, *map(str, arguments), "--quiet"], cwd=OUT, text=True,
                            capture_output=True, check=False)
    require(result.returncode == expect, f"{arguments}: {result.stderr}")
    return result.stderr


def cells(source, port=0):
    return source.GetDataInformation(port).GetNumberOfCells()


def volume(source):
    integral = servermanager.Fetch(IntegrateVariables(Input=source))  # held: it owns the array
    return integral.GetCellData().GetArray("Volume").GetValue(0)


def fetch(source, port):
    """The data of a port. (ParaView's own Fetch of a port gives that of port 0.)"""
    return servermanager.Fetch(Calculator(Input=OutputPort(source, port)))


def close(a, b):
    return abs(a - b) <= 1e-9 * max(abs(a), abs(b))


def compare(map_file, scale):
    """Extracts a map here and with the command; returns the filter."""
    reader = OpenDataFile(os.path.join(OUT, map_file))
    filter_ = HexHexExtract(Input=OutputPort(reader, 0), Scale=scale)
    filter_.UpdatePipeline()
    run("extract", map_file, "-o", "command.vtu", "--scale", scale, "--report", "report.json")
    with open(os.path.join(OUT, "report.json"), encoding="utf-8") as file:
        report = json.load(file)
    require(cells(reader) == report["tets"], "another number of tets")
    require(cells(filter_) == report["cells"], "another number of cells than the command's")
    there = XMLUnstructuredGridReader(FileName=[os.path.join(OUT, "command.vtu")])
    require(close(volume(OutputPort(filter_, 0)), volume(there)), "another volume")
    grid = fetch(filter_, 0)
    minimum = grid.GetCellData().GetArray("scaled_jacobian").GetRange()[0]
    require(close(minimum, report["quality"]["minimum"]), "another quality")
    Delete(there)
    print(f"{map_file}: {cells(filter_)} cells, volume {volume(OutputPort(filter_, 0)):.6g}")
    return filter_


def check_writer(filter_):
    """What is written here is what the command writes."""
    for name in ["here.mesh", "here.ovmb"]:
        SaveData(os.path.join(OUT, name), proxy=OutputPort(filter_, 0))
        run("verify", "sphere.hexex", name, "--scale", filter_.Scale)
    with open(os.path.join(OUT, "here.mesh"), "rb") as here:
        run("extract", "sphere.hexex", "-o", "there.mesh", "--scale", filter_.Scale)
        with open(os.path.join(OUT, "there.mesh"), "rb") as there:
            require(here.read() == there.read(), "another file than the command's")


def check_curved():
    """Cells of higher order, arcs, patches; and the singular edges."""
    reader = OpenDataFile(os.path.join(OUT, "sphere.hexex"))
    filter_ = HexHexExtract(Input=OutputPort(reader, 0), Order=2, Arcs=1, Patches=1)
    filter_.UpdatePipeline()
    grid = fetch(filter_, 0)
    require(grid.GetCell(0).GetNumberOfPoints() == 27, "no cells of order 2")
    straight = HexHexExtract(Input=OutputPort(reader, 0))
    straight.UpdatePipeline()
    require(cells(straight, 2) == 0 and cells(straight, 3) == 0, "arcs that nobody wanted")
    require(cells(filter_) == cells(straight), "another number of curved cells")
    bounds = [port.GetDataInformation().GetBounds() for port in
              (OutputPort(filter_, 0), OutputPort(filter_, 2), OutputPort(filter_, 3))]
    for box in bounds:
        require(all(abs(box[i] - bounds[0][i]) < 0.05 for i in range(6)), "arcs that are elsewhere")
    require(cells(filter_, 3) >= cells(filter_, 0) * 3, "too few patches")
    # 20 singular edges of 4 hex edges each: 12 between the blocks, 8 towards the boundary.
    edges = fetch(filter_, 1)
    valence = edges.GetCellData().GetArray("valence")
    boundary = edges.GetCellData().GetArray("boundary")
    inner = [valence.GetValue(i) for i in range(edges.GetNumberOfCells())
             if boundary.GetValue(i) == 0]
    require(inner == [3] * 80, f"other singular edges: {len(inner)}")


def check_errors():
    """Errors have code and place, in ParaView's own message window."""
    with open(os.path.join(OUT, "bad.hexex"), "w", encoding="utf-8") as file:
        file.write(ONE_TET)
    command = run("extract", "bad.hexex", "-o", "bad.vtu", expect=1)
    code = command.rsplit("[", 1)[1].split("]")[0]
    log = os.path.join(OUT, "messages.txt")
    output = vtkFileOutputWindow()
    output.SetFileName(log)
    output.FlushOn()
    vtkOutputWindow.SetInstance(output)
    reader = OpenDataFile(os.path.join(OUT, "bad.hexex"))
    filter_ = HexHexExtract(Input=OutputPort(reader, 0))
    try:
        filter_.UpdatePipeline()
    except RuntimeError:
        pass
    vtkOutputWindow.SetInstance(None)
    with open(log, encoding="utf-8") as file:
        require(f"[{code}]" in file.read(), f"no message with {code}")
    require(cells(filter_) == 0, "cells of a map that is no map")


def take_picture(filter_, name):
    """A clip through the middle, cells by scaled Jacobian, singular edges as tubes."""
    if not os.environ.get("DISPLAY"):
        print("no X server here: no picture")
        return
    view = CreateView("RenderView")
    view.ViewSize = [1000, 800]
    view.Background = [1, 1, 1]
    view.UseColorPaletteForBackground = 0
    view.OrientationAxesVisibility = 0
    hexes = OutputPort(filter_, 0)
    box = hexes.GetDataInformation().GetBounds()
    middle = [(box[2 * i] + box[2 * i + 1]) / 2 for i in range(3)]
    clip = Clip(Input=hexes, ClipType="Plane", Crinkleclip=1)
    clip.ClipType.Origin = middle
    clip.ClipType.Normal = [1, 0.0, 0]
    shown = Show(clip, view)
    shown.SetRepresentationType("Surface With Edges")
    ColorBy(shown, ("CELLS", "scaled_jacobian"))
    colours = GetColorTransferFunction("scaled_jacobian")
    colours.ApplyPreset("Viridis (matplotlib)", True)
    colours.RescaleTransferFunction(0.3, 1)
    shown.SetScalarBarVisibility(view, True)
    bar = GetScalarBar(colours, view)
    bar.Title, bar.ComponentTitle = "scaled Jacobian", ""
    bar.TitleColor = bar.LabelColor = [0, 0, 0]
    inner = Threshold(Input=OutputPort(filter_, 1), Scalars=["CELLS", "boundary"],
                      LowerThreshold=0, UpperThreshold=0)
    lines = ExtractSurface(Input=inner)
    tubes = Show(Tube(Input=lines, Radius=0.012 * (box[1] - box[0])), view)
    ColorBy(tubes, None)
    tubes.AmbientColor = tubes.DiffuseColor = [0.84, 0.37, 0]
    view.CameraPosition = [middle[0] + 3 * (box[1] - box[0]), middle[1] - 2 * (box[3] - box[2]),
                           middle[2] + 1.2 * (box[5] - box[4])]
    view.CameraFocalPoint = middle
    view.CameraViewUp = [0, 0, 1]
    view.CameraParallelProjection = 0
    ResetCamera(view)
    view.CameraViewAngle = 25
    path = os.path.join(OUT, name)
    SaveScreenshot(path, view, ImageResolution=view.ViewSize)
    require(os.path.getsize(path) > 20000, "an empty picture")


os.makedirs(OUT, exist_ok=True)
LoadPlugin(glob.glob(os.path.join(PLUGINS, "**", "HexHex.so"), recursive=True)[0], ns=globals())
run("generate", "sphere", "--cells", "4", "--refine", "2", "--jitter", "0.05", "-o", "sphere.hexex")
sphere = compare("sphere.hexex", 3)
check_writer(sphere)
check_curved()
check_errors()
take_picture(sphere, "sphere.png")
real = os.path.join(DATA, "maps", "s17c_sphere_r1.hexex")
if DATA and os.path.exists(real):
    take_picture(compare(real, 1), "real.png")
else:
    print("no real map here: skipped")
print("The plugin agrees with the command.")
