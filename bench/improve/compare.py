#!/usr/bin/env python3
"""hexhex improve beside other programs that move vertices: MFEM's TMOP, VTK's constrained smoothing, PyVista's, Gmsh.

    bench/improve/compare.py HEXHEX MAP.hexex:SCALE... MESH.mesh...

Prints a table in Markdown. Needs mfem, gmsh, vtk, pyvista and meshio of PyPI. All start from the same mesh, each in a
process of its own with one thread; a mesh without a map is its own surface. Time is processor time without reading and
writing, of hexhex that of the command. Certificates are those of hexhex; the distance is the largest one of boundary
vertices to the boundary of the map or the mesh, in diagonals.

TMOP: the untangling metric 352 if a corner is not positive, then the shape metric 303, at Gauss-Lobatto points;
boundary vertices stay, 50 steps of Newton's method. VTK: vtkConstrainedSmoothingFilter, 20 iterations, vertices of
the boundary stay. PyVista has no smoothing of cells, only of surfaces: smooth_taubin() of the mesh's boundary, 20
iterations, vertices inside stay. Gmsh: UntangleMeshGeometry, and Relocate3D, of a discrete volume without geometry."""
import json
import multiprocessing
import os
import resource
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import meshio
import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

FACES = np.array([[0, 4, 7, 3], [1, 2, 6, 5], [0, 1, 5, 4], [3, 7, 6, 2], [0, 3, 2, 1], [4, 5, 6, 7]])

LIMIT = 60  # seconds of processor time


def boundary_quads(cells):
    quads = cells[:, FACES].reshape(-1, 4)
    _, first, counts = np.unique(np.sort(quads, axis=1), axis=0, return_index=True, return_counts=True)
    return quads[first[counts == 1]]


def as_vtk(points, cells):
    grid = vtk.vtkUnstructuredGrid()
    places = vtk.vtkPoints()
    places.SetData(numpy_to_vtk(points, deep=True))
    grid.SetPoints(places)
    connectivity = vtk.vtkCellArray()
    offsets = np.arange(0, 8 * len(cells) + 1, 8)
    connectivity.SetData(vtk.util.numpy_support.numpy_to_vtkIdTypeArray(offsets, deep=True),
                         vtk.util.numpy_support.numpy_to_vtkIdTypeArray(cells.ravel().astype(np.int64), deep=True))
    grid.SetCells(vtk.VTK_HEXAHEDRON, connectivity)
    return grid


def smoothed_by_vtk(points, cells, _file, _bad):
    grid = as_vtk(points, cells)
    constraint = np.full(len(points), 1e30)
    constraint[np.unique(boundary_quads(cells))] = 0
    array = numpy_to_vtk(constraint, deep=True)
    array.SetName("SmoothingConstraints")
    grid.GetPointData().AddArray(array)
    smoothing = vtk.vtkConstrainedSmoothingFilter()
    smoothing.SetInputData(grid)
    smoothing.SetConstraintStrategyToConstraintArray()
    smoothing.SetOutputPointsPrecision(vtk.vtkAlgorithm.DOUBLE_PRECISION)
    begin = time.process_time()
    smoothing.Update()
    return vtk_to_numpy(smoothing.GetOutput().GetPoints().GetData()), time.process_time() - begin


def smoothed_by_pyvista(points, cells, _file, _bad):
    import pyvista

    quads = boundary_quads(cells)
    border, corners = np.unique(quads, return_inverse=True)
    faces = np.hstack([np.full((len(quads), 1), 4), corners.reshape(-1, 4)])
    surface = pyvista.PolyData(points[border], faces)
    begin = time.process_time()
    smooth = surface.smooth_taubin(n_iter=20)
    seconds = time.process_time() - begin
    result = points.copy()
    result[border] = smooth.points
    return result, seconds


def optimized_by_mfem(points, _cells, file, bad):
    import mfem._ser.tmop as tmop
    import mfem._ser.tmop_tools as tools
    import mfem.ser as mfem

    mesh = mfem.Mesh(str(file), 1, 1, False)
    # MFEM does not keep these alive.
    collection = mfem.H1_FECollection(1, 3)
    rules = mfem.IntegrationRules(0, mfem.Quadrature1D.GaussLobatto)
    nothing = mfem.Vector()
    space = mfem.FiniteElementSpace(mesh, collection, 3, mfem.Ordering.byNODES)
    mesh.SetNodalFESpace(space)
    nodes = mesh.GetNodes()
    rule = rules.Get(mfem.Geometry.CUBE, 3)
    everywhere = mfem.intArray(mesh.bdr_attributes.Max())
    everywhere.Assign(1)

    def lower(metric, least):
        target = tmop.TargetConstructor(tmop.TargetConstructor.IDEAL_SHAPE_EQUAL_SIZE)
        target.SetNodes(nodes)
        integrator = tmop.TMOP_Integrator(metric, target)
        integrator.SetIntegrationRule(rule)
        form = mfem.NonlinearForm(space)
        form.AddDomainIntegrator(integrator)
        form.SetEssentialBC(everywhere)
        inner = mfem.MINRESSolver()
        inner.SetMaxIter(100)
        inner.SetRelTol(1e-12)
        newton = tools.TMOPNewtonSolver(rule, 0)
        newton.SetPreconditioner(inner)
        newton.SetMaxIter(50)
        newton.SetRelTol(1e-6)
        newton.SetMinDetPtr(least.GetData())
        newton.SetOperator(form)
        nodes.SetTrueVector()
        newton.Mult(nothing, nodes.GetTrueVector())
        nodes.SetFromTrueVector()

    begin = time.process_time()
    least = mfem.Vector(1)  # determinant: metric and solver keep its place
    least[0] = 1.1 * bad - 1e-12
    if bad <= 0:
        lower(tmop.TMOP_Metric_352(least.GetData()), least)
    if bad > 0 or least[0] > 0:
        lower(tmop.TMOP_Metric_303(), least)
    seconds = time.process_time() - begin
    return nodes.GetDataArray().reshape(3, len(points)).T.copy(), seconds


def optimized_by_gmsh(method):
    def run(points, cells, _file, _bad):
        import gmsh

        gmsh.initialize()
        try:
            gmsh.option.setNumber("General.Terminal", 0)
            gmsh.option.setNumber("General.NumThreads", 1)
            gmsh.model.addDiscreteEntity(2, 1)
            gmsh.model.addDiscreteEntity(3, 1, [1])
            gmsh.model.mesh.addNodes(3, 1, np.arange(1, len(points) + 1), points.ravel())
            gmsh.model.mesh.addElementsByType(1, 3, [], (boundary_quads(cells) + 1).ravel())
            gmsh.model.mesh.addElementsByType(1, 5, [], (cells + 1).ravel())
            gmsh.model.mesh.reclassifyNodes()
            begin = time.process_time()
            gmsh.model.mesh.optimize(method, niter=20)
            seconds = time.process_time() - begin
            tags, places, _ = gmsh.model.mesh.getNodes()
            now = np.empty((int(max(tags)) + 1, 3))
            now[np.asarray(tags, dtype=int)] = np.asarray(places).reshape(-1, 3)
            # Nodes may have new numbers; cells keep their order.
            result = points.copy()
            result[cells.ravel()] = now[np.asarray(gmsh.model.mesh.getElementsByType(5)[1], dtype=int)]
            return result, seconds
        finally:
            gmsh.finalize()

    return run


def limited(tool, *arguments):
    """In a process of its own, which may crash or print, for LIMIT seconds at most."""
    def work(pipe):
        resource.setrlimit(resource.RLIMIT_CPU, (LIMIT, LIMIT + 1))
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        try:
            pipe.send(tool(*arguments))
        except Exception as error:  # what a tool says of itself belongs into the table
            pipe.send(" ".join(str(error).split())[:80])

    context = multiprocessing.get_context("fork")
    ours, theirs = context.Pipe()
    process = context.Process(target=work, args=(theirs,))
    process.start()
    theirs.close()
    try:
        return ours.recv()
    except EOFError:
        process.join()
        return f"not finished after {LIMIT} s" if process.exitcode == -signal.SIGXCPU else "crashed"
    finally:
        process.join()


def surface_of(file, folder, hexhex):
    """Of the boundary of a map or a mesh: a locator of its triangles."""
    subprocess.run([hexhex, "convert", file, folder / "map.vtu", "--quiet"], check=True)
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(folder / "map.vtu"))
    surface = vtk.vtkDataSetSurfaceFilter()
    surface.SetInputConnection(reader.GetOutputPort())
    triangles = vtk.vtkTriangleFilter()
    triangles.SetInputConnection(surface.GetOutputPort())
    triangles.Update()
    locator = vtk.vtkStaticCellLocator()
    locator.SetDataSet(triangles.GetOutput())
    locator.BuildLocator()
    return locator, triangles.GetOutput().GetLength()


def distance_to(surface, points):
    locator, diagonal = surface
    closest, cell, cell_id, sub, squared = [0.0] * 3, vtk.vtkGenericCell(), vtk.mutable(0), vtk.mutable(0), vtk.mutable(0.0)
    most = 0.0
    for point in points:
        locator.FindClosestPoint(point, closest, cell, cell_id, sub, squared)
        most = max(most, float(squared.get()))
    return most**0.5 / diagonal


def facts_of(points, cells, folder, hexhex):
    meshio.Mesh(points, [("hexahedron", cells)]).write(folder / "now.vtu", compression=None)
    run = subprocess.run([hexhex, "info", folder / "now.vtu", "--json"], check=True, capture_output=True, text=True)
    return json.loads(run.stdout)


def tool_rows(file, scale, folder, hexhex):
    """(tool, facts, distance, seconds) of each. Without a scale, the file is a mesh."""
    start = ["extract", file, "--scale", scale, "--threads", "1", "-o"] if scale else ["convert", file]
    of_map = ["--map", file] if scale else []
    for output in (["base.vtu"], ["mfem.mesh", "--format", "mfem"]):
        subprocess.run([hexhex, *start, *output, "--quiet"], check=True, cwd=folder)
    base = meshio.read(folder / "base.vtu")
    points, cells = base.points, base.cells_dict["hexahedron"].astype(np.int64)
    border = np.unique(boundary_quads(cells))
    surface = surface_of(file, folder, hexhex)

    def row(name, places, seconds):
        return name, facts_of(places, cells, folder, hexhex), distance_to(surface, places[border]), seconds

    yield row("as extracted" if scale else "as given", points, 0)
    before = os.times().children_user
    subprocess.run([hexhex, "improve", folder / "base.vtu", *of_map, "-o", folder / "better.vtu", "--quiet",
                    "--threads", "1"], check=True)
    seconds = os.times().children_user - before
    yield row("hexhex improve", meshio.read(folder / "better.vtu").points, seconds)
    corners = points[cells]
    edges = [(0, 1, 3, 4), (1, 2, 0, 5), (2, 3, 1, 6), (3, 0, 2, 7), (4, 7, 5, 0), (5, 4, 6, 1), (6, 5, 7, 2), (7, 6, 4, 3)]
    bad = min(np.linalg.det(corners[:, e[1:]] - corners[:, e[:1]]).min() for e in edges)
    for name, tool in (("MFEM TMOP", optimized_by_mfem), ("VTK constrained smoothing", smoothed_by_vtk),
                       ("PyVista smooth_taubin, boundary only", smoothed_by_pyvista),
                       ("Gmsh UntangleMeshGeometry", optimized_by_gmsh("UntangleMeshGeometry")),
                       ("Gmsh Relocate3D", optimized_by_gmsh("Relocate3D"))):
        result = limited(tool, points, cells, folder / "mfem.mesh", bad)
        yield (name, result, None, None) if isinstance(result, str) else row(name, *result)


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    hexhex = Path(sys.argv[1]).resolve()
    print("| mesh | tool | cells not positive | minimum | mean | distance | time |\n|---|---|---|---|---|---|---|")
    for argument in sys.argv[2:]:
        name, _, scale = argument.partition(":")
        file = Path(name).resolve()
        with tempfile.TemporaryDirectory() as folder:
            for name, facts, distance, seconds in tool_rows(file, scale, Path(folder), hexhex):
                label = f"{file.stem} x{scale}" if scale else file.stem
                if isinstance(facts, str):
                    print(f"| {label} | {name} | {facts} | | | | |", flush=True)
                    continue
                quality, validity = facts["quality"], facts["validity"]
                print(f"| {label} | {name} | {validity['refuted'] + validity['undecided']} of {facts['cells']} | "
                      f"{quality['minimum']:.3f} | {quality['mean']:.3f} | {distance:.1e} | {seconds:.2f} s |", flush=True)


if __name__ == "__main__":
    main()
