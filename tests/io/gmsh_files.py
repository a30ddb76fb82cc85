#!/usr/bin/env python3
"""Reads a .msh file with Gmsh and writes it again.

usage: gmsh_files.py VERSION BINARY IN OUT
       gmsh_files.py boxes OUT

VERSION is 2.2, 4 or 4.1, BINARY 0 or 1. boxes: meshes two boxes with a common face, 3 cells along each
edge, as structured zones of CGNS. Exit code 77: Gmsh is not installed.
"""

import sys

from handover import NOT_INSTALLED


def rewrite(version, binary, source, target):
    import gmsh

    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.open(source)
    gmsh.option.setNumber("Mesh.MshFileVersion", float(version))
    gmsh.option.setNumber("Mesh.Binary", int(binary))
    gmsh.write(target)
    gmsh.finalize()


def mesh_boxes(target):
    import gmsh

    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    model = gmsh.model
    boxes = [(3, model.occ.addBox(x, 0, 0, 1 + x, 2, 3)) for x in (0, 1)]
    model.occ.fragment(boxes[:1], boxes[1:])
    model.occ.synchronize()
    for _, tag in model.getEntities(1):
        model.mesh.setTransfiniteCurve(tag, 4)
    for _, tag in model.getEntities(2):
        model.mesh.setTransfiniteSurface(tag)
        model.mesh.setRecombine(2, tag)
    for _, tag in model.getEntities(3):
        model.mesh.setTransfiniteVolume(tag)
    inflow = model.getEntitiesInBoundingBox(-0.1, -0.1, -0.1, 0.1, 2.1, 3.1, 2)
    model.addPhysicalGroup(2, [tag for _, tag in inflow], name="inflow")
    model.addPhysicalGroup(3, [1], name="steel")
    model.addPhysicalGroup(3, [2], name="copper")
    model.mesh.generate(3)
    gmsh.option.setNumber("Mesh.CgnsExportStructured", 1)
    gmsh.write(target)
    gmsh.finalize()


if __name__ == "__main__":
    try:
        if sys.argv[1] == "boxes":
            mesh_boxes(sys.argv[2])
        else:
            rewrite(*sys.argv[1:])
    except (ImportError, OSError) as error:
        print(error, file=sys.stderr)
        sys.exit(NOT_INSTALLED)
