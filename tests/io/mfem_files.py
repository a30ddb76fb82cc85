#!/usr/bin/env python3
"""Reads a mesh of order 2 with MFEM and writes it again.

usage: mfem_files.py SPACE ORDERING IN OUT

SPACE is H1 or L2; ORDERING 0: coordinates axis by axis, 1: node by node. Exit code 77: MFEM is not installed.
"""

import sys

from handover import NOT_INSTALLED


def rewrite(space, ordering, source, target):
    import mfem.ser as mfem

    mesh = mfem.Mesh(source)
    mesh.SetCurvature(2, space == "L2", 3, int(ordering))
    mesh.Print(target, 17)


if __name__ == "__main__":
    try:
        rewrite(*sys.argv[1:])
    except ImportError as error:
        print(error, file=sys.stderr)
        sys.exit(NOT_INSTALLED)
