"""What the tests of files of parts have in common: running commands, finding modules, and reading Gmsh's files."""

import os
import struct
import subprocess
import sys

PYTHONS = [p for p in (os.environ.get("HEXHEX_PYTHON"), "/usr/bin/python3", sys.executable) if p]


def check(condition, message):
    if not condition:
        sys.exit(f"FAILED: {message}")


def run(*command, **options):
    done = subprocess.run([str(c) for c in command], stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, check=False, **options)
    check(done.returncode == 0, f"{' '.join(map(str, command))}:\n{done.stdout[-3000:]}")
    return done.stdout


def python_with(module):
    """A Python that has a module, or None."""
    for python in PYTHONS:
        if os.access(python, os.X_OK) and subprocess.run(
                [python, "-c", f"import {module}"], capture_output=True, check=False).returncode == 0:
            return python
    return None


def read_gmsh(file):
    """Nodes and hexahedra of a binary .msh file, numbers from 0 on, by what the format says.

    @return positions by node, nodes by hexahedron, and the parts that own ghosts
    """
    data = memoryview(file.read_bytes())
    text = bytes(data)

    def section(name):
        return data[text.index(f"${name}\n".encode()) + len(name) + 2:]
    nodes, points, at = section("Nodes"), {}, 32
    for _ in range(struct.unpack_from("<Q", nodes)[0]):
        count = struct.unpack_from("<3iQ", nodes, at)[3]
        numbers = struct.unpack_from(f"<{count}Q", nodes, at + 20)
        at += 20 + 8 * count
        for i, number in enumerate(numbers):
            points[number - 1] = struct.unpack_from("<3d", nodes, at + 24 * i)
        at += 24 * count
    elements, cells, at = section("Elements"), {}, 32
    for _ in range(struct.unpack_from("<Q", elements)[0]):
        dimension, _, _, count = struct.unpack_from("<3iQ", elements, at)
        at += 20
        size = 9 if dimension == 3 else 5
        for i in range(count if dimension == 3 else 0):
            number, *corners = struct.unpack_from("<9Q", elements, at + 72 * i)
            cells[number - 1] = [n - 1 for n in corners]
        at += 8 * size * count
    owners = read_owners(section("GhostElements")) if b"$GhostElements\n" in text else {}
    return points, cells, owners


def read_owners(ghosts):
    count, = struct.unpack_from("<Q", ghosts)
    at, owners = 8, {}
    for _ in range(count):
        element, owner, others = struct.unpack_from("<QiQ", ghosts, at)
        at += 20 + 4 * others
        owners[element - 1] = owner - 1
    return owners
