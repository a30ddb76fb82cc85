#!/usr/bin/env python3
"""Reads a mesh of higher order with MFEM and writes it again.

usage: mfem_files.py SPACE ORDERING IN OUT

SPACE is H1 or L2, with nodes at the points of Gauss and Lobatto, or H1@U, at the same distances; ORDERING 0: coordinates axis by axis, 1: node by node. Exit code 77: MFEM is not installed.
"""

import sys

from handover import NOT_INSTALLED


def rewrite(space, ordering, source, target):
    import mfem.ser as mfem

    mesh = mfem.Mesh(source)
    order = mesh.GetNodalFESpace().GetMaxElementOrder()
    if space in ("H1", "L2"):
        mesh.SetCurvature(order, space == "L2", 3, int(ordering))
    else:
        collection = mfem.H1_FECollection(order, 3, mfem.BasisType.ClosedUniform)
        nodes = mfem.FiniteElementSpace(mesh, collection, 3, int(ordering))
        mesh.SetNodalFESpace(nodes)
    mesh.Print(target, 17)


if __name__ == "__main__":
    try:
        rewrite(*sys.argv[1:])
    except ImportError as error:
        print(error, file=sys.stderr)
        sys.exit(NOT_INSTALLED)
