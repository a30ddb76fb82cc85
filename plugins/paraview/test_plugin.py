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


def run_for_text(*arguments):
    """What the command prints."""
    return subprocess.run([COMMAND, *arguments], cwd=OUT, text=True, capture_output=True,
                          check=True).stdout


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
    # By the name of a format, whatever the extension; and a folder.
    for format_ in ["mfem", "msh22-ascii", "vtk", "vtu"]:
        writer = servermanager.writers.HexHexWriter(
            Input=OutputPort(filter_, 0), FileName=os.path.join(OUT, "here.txt"), Format=format_)
        writer.UpdatePipeline()
        run("extract", "sphere.hexex", "-o", "there.txt", "--format", format_, "--scale",
            filter_.Scale)
        with open(os.path.join(OUT, "here.txt"), "rb") as here, \
             open(os.path.join(OUT, "there.txt"), "rb") as there:
            require(here.read() == there.read(), f"another {format_} file than the command's")
    os.makedirs(os.path.join(OUT, "case"), exist_ok=True)
    SaveData(os.path.join(OUT, "case", "case.foam"), proxy=OutputPort(filter_, 0))
    require(os.path.exists(os.path.join(OUT, "case", "constant", "polyMesh", "owner")),
            "no polyMesh")


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


def rows(grid, name):
    """The values of a cell array, a tuple each."""
    array = grid.GetCellData().GetArray(name)
    return [array.GetTuple(i) for i in range(array.GetNumberOfTuples())]


def check_map_blocks():
    """Chart jumps, singular edges and features of a map, beside its tets."""
    run("generate", "sphere", "--cells", "2", "--refine", "2", "--charts", "blocks", "--features",
        "--jitter", "0.1", "-o", "blocks.ovmb")
    expected = json.loads(run_for_text("check", "blocks.ovmb", "--json"))
    reader = OpenDataFile(os.path.join(OUT, "blocks.ovmb"))
    reader.UpdatePipeline()
    tets = fetch(reader, 0)
    parameters = rows(tets, "hexhex_parameters")
    jumps = fetch(reader, 1)
    require(jumps.GetNumberOfCells() == expected["chart_jumps"] > 0, "another number of jumps")
    sides, rotations = rows(jumps, "tets"), rows(jumps, "rotation")
    translations = rows(jumps, "translation")
    for j in range(jumps.GetNumberOfCells()):
        for k in range(3):
            vertex = jumps.GetCell(j).GetPointId(k)
            u, v = (parameter_at(tets, parameters, int(t), vertex) for t in sides[j])
            for axis in range(3):
                image = translations[j][axis] + sum(
                    rotations[j][3 * axis + i] * u[i] for i in range(3))
                require(abs(image - v[axis]) < 1e-6, f"jump {j} does not carry parameters over")
    lines = fetch(reader, 2)
    inner = [int(v) for (v,), (b,) in zip(rows(lines, "valence"), rows(lines, "boundary")) if b == 0]
    counts = {str(v): inner.count(v) for v in set(inner)}
    require(counts == expected["inner_singular_tet_edges"], f"other singular edges: {counts}")
    features = fetch(reader, 3)
    dimensions = [int(d) for d, in rows(features, "dimension")]
    require(all(dimensions.count(d) > 0 for d in range(3)), "features are missing")
    types = [features.GetCell(i).GetCellDimension() for i in range(features.GetNumberOfCells())]
    require(types == dimensions, "features of another dimension")
    require(len({tag for tag, in rows(features, "tag")}) > 3, "features without their tags")


def parameter_at(tets, parameters, tet, vertex):
    corners = [tets.GetCell(tet).GetPointId(k) for k in range(4)]
    first = 3 * corners.index(vertex)
    return parameters[tet][first:first + 3]


def check_cancel():
    """Progress is told, and who aborts gets nothing, without an error."""
    reader = OpenDataFile(os.path.join(OUT, "sphere.hexex"))
    filter_ = HexHexExtract(Input=OutputPort(reader, 0), Scale=24)
    algorithm = filter_.GetClientSideObject()
    told = []

    def abort(caller, _event):
        told.append(caller.GetProgress())
        caller.SetAbortExecute(1)

    observer = algorithm.AddObserver("ProgressEvent", abort)
    filter_.UpdatePipeline()
    require(told and all(0 <= share <= 1 for share in told), "no progress")
    require(cells(filter_) == 0, "cells of an extraction that was cancelled")
    algorithm.RemoveObserver(observer)


def check_repair():
    """A few flipped tets are repaired; or they are an error."""
    run("generate", "box", "--cells", "4", "--refine", "4", "--defects", "2", "-o", "flipped.hexex")
    reader = OpenDataFile(os.path.join(OUT, "flipped.hexex"))
    filter_ = HexHexExtract(Input=OutputPort(reader, 0))
    filter_.UpdatePipeline()
    run("extract", "flipped.hexex", "-o", "flipped.vtu", "--report", "flipped.json")
    with open(os.path.join(OUT, "flipped.json"), encoding="utf-8") as file:
        require(cells(filter_) == json.load(file)["cells"], "another number of cells after repair")
    require(messages_of(HexHexExtract(Input=OutputPort(reader, 0), Repair=0), "FlippedTet"),
            "no error without repair")


def check_quantize():
    """A seamless map has a mesh as soon as it is quantized: the command's."""
    run("generate", "sphere", "--cells", "4", "-o", "integer.hexex")
    tets = fetch(OpenDataFile(os.path.join(OUT, "integer.hexex")), 0)
    parameters = tets.GetCellData().GetArray("hexhex_parameters")
    for t in range(parameters.GetNumberOfTuples()):
        parameters.SetTuple(t, [2 ** 0.5 * u for u in parameters.GetTuple(t)])
    source = TrivialProducer()
    source.GetClientSideObject().SetOutput(tets)
    source.UpdatePipeline()
    require(messages_of(HexHexExtract(Input=source), "TransitionResidual"),
            "no error without quantization")
    filter_ = HexHexExtract(Input=source, Quantize=1, Cells=3584)
    filter_.UpdatePipeline()
    require(cells(filter_) == 3584, f"{cells(filter_)} cells of a quantized map")


def check_mesh():
    """Tets without their map become the mesh that the command makes of them."""
    run("generate", "cylinder", "--cells", "2", "--refine", "2", "-o", "tets.vtu")
    tets = XMLUnstructuredGridReader(FileName=[os.path.join(OUT, "tets.vtu")])
    for method, name in enumerate(["auto", "polycube", "frames"]):
        run("mesh", "tets.vtu", "-o", "meshed.vtu", "--cells", "300", "--method", name)
        expected = fetch(XMLUnstructuredGridReader(FileName=[os.path.join(OUT, "meshed.vtu")]), 0)
        filter_ = HexHexMesh(Input=tets, Cells=300, Method=method)
        filter_.UpdatePipeline()
        found = fetch(filter_, 0)
        places = [[mesh.GetPoint(i) for i in range(mesh.GetNumberOfPoints())] for mesh in (expected, found)]
        require(cells(filter_) == expected.GetNumberOfCells() > 0 and places[0] == places[1],
                f"another mesh by {name} than the command's")
        worst = found.GetCellData().GetArray("scaled_jacobian").GetRange()[0]
        require(worst > 0, f"a scaled Jacobian of {worst} by {name}")
        lines = fetch(filter_, 1)
        require(0 not in [v for v, in rows(lines, "valence")] and lines.GetNumberOfCells() > 0,
                f"no singular edges by {name}")
    layered = HexHexMesh(Input=tets, Cells=300, Method=2, Pillow=2)
    layered.UpdatePipeline()
    require(cells(layered) > cells(filter_), "no layer of cells")
    for options in ({"Cells": -1}, {"FeatureAngle": 200}):
        require(messages_of(HexHexMesh(Input=tets, **options), "InvalidArgument", "vtkHexHexMesh"),
                f"no error for {options}")


def check_improve():
    """Before and after: what the command makes of a distorted mesh, and no worse cell than there was."""
    run("generate", "torus", "--jitter", "0.9", "--cells", "3", "-o", "rough.hexex")
    reader = OpenDataFile(os.path.join(OUT, "rough.hexex"))
    worst = []
    for improve in (0, 1):
        filter_ = HexHexExtract(Input=OutputPort(reader, 0), Scale=2, Improve=improve)
        filter_.UpdatePipeline()
        worst.append(fetch(filter_, 0).GetCellData().GetArray("scaled_jacobian").GetRange()[0])
    require(worst[0] < worst[1] > 0, f"scaled Jacobians {worst} before and after")
    # Nodes of curved cells, and singular edges with them.
    run("generate", "sphere", "--jitter", "0.3", "--cells", "1", "-o", "ball.hexex")
    reader = OpenDataFile(os.path.join(OUT, "ball.hexex"))
    run("extract", "ball.hexex", "--order", "2", "--improve", "-o", "ball.vtu")
    expected = fetch(OpenDataFile(os.path.join(OUT, "ball.vtu")), 0)
    curved = HexHexExtract(Input=OutputPort(reader, 0), Improve=1, Order=2)
    curved.UpdatePipeline()
    found = fetch(curved, 0)
    places = [[tuple(mesh.GetPoint(i)) for i in range(mesh.GetNumberOfPoints())] for mesh in (expected, found)]
    require(places[0] == places[1], "curved cells are not improved as the command does it")
    lines = fetch(curved, 1)
    ends = {tuple(lines.GetPoint(i)) for i in range(lines.GetNumberOfPoints())}
    require(ends and ends <= set(places[1]), "singular edges are not where the cells are")
    for options in ({"Order": 4}, {"Arcs": 1}):
        refused = HexHexExtract(Input=OutputPort(reader, 0), Improve=1, **options)
        require(messages_of(refused, "InvalidArgument"), f"no error for {options}")


def check_errors():
    """Errors have code and place, in ParaView's own message window."""
    with open(os.path.join(OUT, "bad.hexex"), "w", encoding="utf-8") as file:
        file.write(ONE_TET)
    command = run("extract", "bad.hexex", "-o", "bad.vtu", expect=1)
    code = command.rsplit("[", 1)[1].split("]")[0]
    reader = OpenDataFile(os.path.join(OUT, "bad.hexex"))
    filter_ = HexHexExtract(Input=OutputPort(reader, 0))
    require(messages_of(filter_, code), f"no message with {code}")
    require(cells(filter_) == 0, "cells of a map that is no map")


def messages_of(filter_, code, of="vtkHexHexExtract"):
    """The error message with a code, and with its place, that an update of a filter leads to."""
    log = os.path.join(OUT, "messages.txt")
    output = vtkFileOutputWindow()
    output.SetFileName(log)
    output.FlushOn()
    vtkOutputWindow.SetInstance(output)
    try:
        filter_.UpdatePipeline()
    except RuntimeError:
        pass
    vtkOutputWindow.SetInstance(None)
    with open(log, encoding="utf-8") as file:
        lines = file.read().splitlines()
    return [line for line in lines if of in line and f"[{code}" in line]


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
check_map_blocks()
check_cancel()
check_repair()
check_quantize()
check_mesh()
check_improve()
check_errors()
take_picture(sphere, "sphere.png")
real = os.path.join(DATA, "maps", "s17c_sphere_r1.hexex")
if DATA and os.path.exists(real):
    take_picture(compare(real, 1), "real.png")
else:
    print("no real map here: skipped")
print("The plugin agrees with the command.")
