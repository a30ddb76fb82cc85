"""Fills a body with tets: python3 -c SCRIPT MESHER INPUT SIZE TETS THREADS

The first line of the output names MESHER with its version; exit code 3: it is not installed. INPUT is
part.stl, as text, or part.step, beside part.geo, which has Gmsh read it. The tets go into part.msh
(Gmsh), with named faces of STEP files as groups of triangles, and with solids as groups of tets if there
are several. Solids that touch are glued. SIZE is the length of an edge; 0, for part.step alone: so that
there are about TETS. THREADS 0: as many as there are cores.
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
OVERLAP = "Solids overlap; what several have in common is a region of its own."


def write(points, tets, regions=(), triangles=(), sides=(), names=()):
    """Into part.msh (Gmsh 2.2). Corners are counted from 0; regions and sides are numbers of groups, 0
    for none; names are of (dimension, group)."""
    kinds = ((2, triangles, sides), (4, tets, regions or [0] * len(tets)))
    rows = [(kind, group, element) for kind, elements, groups in kinds for element, group in zip(elements, groups)]
    with open("part.msh", "w") as out:
        out.write(f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n{len(names)}\n")
        out.writelines('%d %d "%s"\n' % (*group, name.replace('"', "_")) for group, name in sorted(dict(names).items()))
        out.write(f"$EndPhysicalNames\n$Nodes\n{len(points)}\n")
        out.writelines("%d %.17g %.17g %.17g\n" % (i, *p) for i, p in enumerate(points, 1))
        out.write(f"$EndNodes\n$Elements\n{len(rows)}\n")
        for i, (kind, group, element) in enumerate(rows, 1):
            out.write(f"{i} {kind} 2 {group} {group} {' '.join(str(v + 1) for v in element)}\n")
        out.write("$EndElements\n")


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
    origin = (points.min(axis=0) + points.max(axis=0)) / 2  # far from which its tolerances fail
    points, cells = pytetwild.tetrahedralize(
        points - origin, triangles.reshape(-1, 3).astype(numpy.int32), edge_length_abs=size, num_threads=threads
    )[:2]
    write((points + origin).tolist(), cells.tolist())


def netgen(source, size, tets, threads):
    if source.endswith(".stl"):
        from netgen.stl import STLGeometry

        geometry = STLGeometry(source)
    else:
        from netgen.occ import Glue, OCCGeometry

        geometry = OCCGeometry(source)
        apart = list(geometry.shape.solids)
        if len(apart) > 1:
            geometry = OCCGeometry(Glue(apart))
            if geometry.shape.mass < (1 - 1e-6) * sum(solid.mass for solid in apart):
                print("note: " + OVERLAP)
        size = size or (6 * 2**0.5 * geometry.shape.mass / tets) ** (1 / 3)
    mesh = geometry.GenerateMesh(maxh=size)
    vertices = [[v.nr - 1 for v in element.vertices] for element in mesh.Elements3D()]
    solids = [element.index for element in mesh.Elements3D()]
    faces = [[v.nr - 1 for v in element.vertices] for element in mesh.Elements2D()]
    names = {}
    sides = [0] * len(faces)
    if source.endswith(".step"):
        called = mesh.GetRegionNames(codim=1)
        numbers = {name: i for i, name in enumerate(dict.fromkeys(called), 1) if name not in ("", "default")}
        names = {(2, i): name for name, i in numbers.items()}
        descriptors = mesh.FaceDescriptors()
        sides = [numbers.get(called[descriptors[e.index - 1].bc - 1], 0) for e in mesh.Elements2D()]
    several = len(set(solids)) > 1
    if several:
        called = dict(enumerate(mesh.GetRegionNames(codim=0), 1))  # without those that have no name
        for i in set(solids):
            names[3, i] = called[i] if called.get(i, "default") not in ("", "default") else f"region_{i}"
    write([p.p for p in mesh.Points()], vertices, solids if several else (), faces, sides, names)


def name_in(path):
    """Of a solid, from Shapes/ASSEMBLY/INSTANCE/PRODUCT: that of the instance, unless it is a number."""
    *above, name = path.split("/")
    if len(above) > 2 and any(letter.isalpha() for letter in above[-1]):
        name = above[-1]
    # This is written where there is no name.
    return "" if name.startswith("Open CASCADE STEP translator") else name


def gmsh(source, size, tets, threads):
    import gmsh as program

    words = ["gmsh", "-nopopup"]
    try:
        program.initialize(words, interruptible=False)
    except TypeError:  # before Gmsh 4.11
        program.initialize(words)
    program.option.setNumber("Geometry.OCCImportLabels", 1)
    program.open("part.geo")
    model = program.model
    for dimension in (2, 3):
        entities = model.getEntities(dimension)
        groups = {}
        for _, tag in entities:
            name = name_in(model.getEntityName(dimension, tag))
            if dimension == 3 and len(entities) > 1:
                groups.setdefault(name or f"region_{tag}", []).append(tag)
            elif dimension == 2 and name and " & " not in name:  # that of a body, with layers
                groups.setdefault(name, []).append(tag)
        for name, tags in groups.items():
            model.setPhysicalName(dimension, model.addPhysicalGroup(dimension, tags), name)
    program.option.setNumber("Mesh.SaveAll", 1)
    model.mesh.generate(3)
    program.write("part.msh")


def version_of(package):
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:  # Debian's Gmsh
        return ""


def end_with_parent():
    while os.read(0, 1):
        pass
    os._exit(1)


def main():
    name, source, size, tets, threads = sys.argv[1:]
    threading.Thread(target=end_with_parent, daemon=True).start()
    if importlib.util.find_spec(MODULES[name]) is None:
        return NOT_THERE
    print(PACKAGES[name], version_of(PACKAGES[name]), flush=True)
    return globals()[name](source, float(size), float(tets), int(threads))


sys.exit(main())
