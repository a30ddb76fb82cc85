"""Fills a body with tets: python3 -c SCRIPT MESHERS INPUT SIZE TETS THREADS

MESHERS are names with commas between them, best first. The first line of the output names the one
that is there; exit code 3: none is. INPUT is part.stl, as text, or part.step, beside part.geo, which
has Gmsh read it. The tets go into part.mesh (MEDIT). SIZE is the length of an edge; 0, for part.step
alone: so that there are about TETS. THREADS 0: as many as there are cores.
Ends when its standard input does, as that is when who started it has ended.
"""

import importlib.metadata
import importlib.util
import os
import sys
import threading
import types

PACKAGES = {"tetwild": "pytetwild", "netgen": "netgen-mesher", "gmsh": "gmsh"}
MODULES = {"tetwild": "pytetwild", "netgen": "netgen", "gmsh": "gmsh"}
NOT_THERE = 3


def write(points, tets):
    """Corners counted from 0."""
    with open("part.mesh", "w") as out:
        out.write(f"MeshVersionFormatted 2\nDimension 3\nVertices\n{len(points)}\n")
        out.writelines("%.17g %.17g %.17g 0\n" % tuple(p) for p in points)
        out.write(f"Tetrahedra\n{len(tets)}\n")
        out.writelines("%d %d %d %d 0\n" % tuple(v + 1 for v in t) for t in tets)
        out.write("End\n")


def tetwild(source, size, tets, threads):
    try:
        importlib.import_module("pyvista")
    except ImportError:  # which the package imports, but which only its other functions need
        sys.modules["pyvista"] = types.ModuleType("pyvista")
    import numpy
    import pytetwild

    with open(source) as lines:
        corners = [line.split()[1:] for line in lines if line.lstrip().startswith("vertex")]
    points, triangles = numpy.unique(numpy.array(corners, dtype=float), axis=0, return_inverse=True)
    points, cells = pytetwild.tetrahedralize(
        points, triangles.reshape(-1, 3).astype(numpy.int32), edge_length_abs=size, num_threads=threads
    )[:2]
    write(points.tolist(), cells.tolist())


def netgen(source, size, tets, threads):
    if source.endswith(".stl"):
        from netgen.stl import STLGeometry

        geometry = STLGeometry(source)
    else:
        from netgen.occ import OCCGeometry

        geometry = OCCGeometry(source)
        size = size or (6 * 2**0.5 * geometry.shape.mass / tets) ** (1 / 3)
    mesh = geometry.GenerateMesh(maxh=size)
    tets = [[v.nr - 1 for v in element.vertices] for element in mesh.Elements3D()]
    write([p.p for p in mesh.Points()], tets)


def gmsh(source, size, tets, threads):
    import gmsh as program

    program.initialize(["gmsh", "-nopopup"], interruptible=False)
    program.open("part.geo")
    program.model.mesh.generate(3)
    program.write("part.mesh")


def end_with_parent():
    while os.read(0, 1):
        pass
    os._exit(1)


def main():
    names, source, size, tets, threads = sys.argv[1:]
    threading.Thread(target=end_with_parent, daemon=True).start()
    for name in names.split(","):
        if importlib.util.find_spec(MODULES[name]) is None:
            continue
        print(PACKAGES[name], importlib.metadata.version(PACKAGES[name]), flush=True)
        return globals()[name](source, float(size), float(tets), int(threads))
    return NOT_THERE


sys.exit(main())
