#!/usr/bin/env python3
"""Reads a .msh file with Gmsh and writes it again.

usage: gmsh_files.py VERSION BINARY IN OUT

VERSION is 2.2, 4 or 4.1, BINARY 0 or 1. Exit code 77: Gmsh is not installed.
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


if __name__ == "__main__":
    try:
        rewrite(*sys.argv[1:])
    except (ImportError, OSError) as error:
        print(error, file=sys.stderr)
        sys.exit(NOT_INSTALLED)
