#!/usr/bin/env python3
"""Glues what `hexhex extract --parts` writes, in every format, and compares it with the mesh in one piece.

    glue_parts.py PATH-OF-HEXHEX

Each format is read by what it says of itself: positions, cells, and global numbers, which make pieces
one mesh. Its vertices and cells have to be those of the whole, bit for bit, and in the same order.
.vtkhdf and .cgns take h5py, of the Python that HEXHEX_PYTHON names or of this one.
"""

import os
import pathlib
import re
import struct
import subprocess
import sys
import tempfile

from common import check, read_gmsh, run


class Glue:
    """Adds up pieces: positions by global vertices, vertices by global cells."""

    def __init__(self):
        self.points = {}
        self.cells = {}

    def add(self, numbers, positions, cell_numbers, cells):
        """Cells are rows of places in `numbers`."""
        for number, position in zip(numbers, positions, strict=True):
            position = tuple(position)
            check(self.points.setdefault(number, position) == position, f"vertex {number} is in two places")
        for number, cell in zip(cell_numbers, cells, strict=True):
            check(number not in self.cells, f"cell {number} is in two parts")
            self.cells[number] = tuple(numbers[i] for i in cell)


def rows(values, width):
    values = list(values)
    return [values[i:i + width] for i in range(0, len(values), width)]


def read_whole(file):
    """Points and cells of a .mesh file."""
    text = file.read_text()

    def section(name):
        body = text[re.search(rf"(?m)^{name}\n", text).end():]
        count, body = body.split("\n", 1)
        return [line.split() for line in body.split("\n", int(count))[:int(count)]]
    points = [tuple(map(float, line[:3])) for line in section("Vertices")]
    cells = [tuple(int(v) - 1 for v in line[:8]) for line in section("Hexahedra")]
    return points, cells


def glue_pvtu(folder, _parts, command):
    run(command, "convert", folder / "m.pvtu", folder / "glued.mesh", "--quiet")
    glue = Glue()
    points, cells = read_whole(folder / "glued.mesh")
    glue.add(range(len(points)), points, range(len(cells)), cells)
    return glue


def glue_vtkhdf(folder, _parts, _command):
    import h5py
    glue = Glue()
    with h5py.File(folder / "m.vtkhdf") as file:
        mesh = file["VTKHDF"]
        point = cell = 0
        for n_points, n_cells in zip(mesh["NumberOfPoints"], mesh["NumberOfCells"], strict=True):
            glue.add(mesh["PointData/GlobalPointIds"][point:point + n_points].tolist(),
                     mesh["Points"][point:point + n_points].tolist(),
                     mesh["CellData/GlobalCellIds"][cell:cell + n_cells].tolist(),
                     rows(mesh["Connectivity"][8 * cell:8 * (cell + n_cells)].tolist(), 8))
            point += n_points
            cell += n_cells
    return glue


def glue_cgns(folder, _parts, _command):
    import h5py
    glue = Glue()
    with h5py.File(folder / "m.cgns") as file:
        for name, zone in file["Base"].items():
            if not name.startswith("Part_"):
                continue
            numbers = zone["GlobalNodeNumber/GlobalNodeNumber/ data"][:].tolist()
            axes = [zone[f"GridCoordinates/Coordinate{axis}/ data"][:].tolist() for axis in "XYZ"]
            cells = [i - 1 for i in zone["hexahedra/ElementConnectivity/ data"][:].tolist()]
            glue.add([n - 1 for n in numbers], zip(*axes, strict=True),
                     [n - 1 for n in zone["GlobalCellNumber/GlobalCellNumber/ data"][:].tolist()],
                     rows(cells, 8))
    return glue


def glue_gmsh(folder, parts, _command):
    glue = Glue()
    files = sorted(folder.glob("m_*"))
    check(len(files) == parts, f"{len(files)} files of {parts} parts")
    for file in files:
        points, cells, _ = read_gmsh(file)
        place = {number: i for i, number in enumerate(points)}
        glue.add(list(points), points.values(), list(cells),
                 [[place[n] for n in cell] for cell in cells.values()])
    return glue


def glue_one_gmsh(folder, _parts, _command):
    glue = Glue()
    glue.points, cells, _ = read_gmsh(folder / "m.msh")
    glue.cells = {number: tuple(cell) for number, cell in cells.items()}
    return glue


def read_netcdf(file):
    """Variables of a CDF-2 file: {name: list of numbers}."""
    data, at, variables = file.read_bytes(), 8, {}

    def number(kind=">i"):
        nonlocal at
        at += struct.calcsize(kind)
        return struct.unpack_from(kind, data, at - struct.calcsize(kind))[0]

    def text():
        nonlocal at
        length = number()
        at += (length + 3) // 4 * 4
        return data[at - (length + 3) // 4 * 4:][:length].decode()

    def attributes():
        nonlocal at
        number()
        for _ in range(number()):
            text()
            size = {2: 1, 4: 4, 5: 4, 6: 8}[number()] * number()
            at += (size + 3) // 4 * 4
    number()
    dimensions = [(text(), number()) for _ in range(number())]
    attributes()
    number()
    for _ in range(number()):
        name = text()
        count = 1
        for _ in range(number()):
            count *= dimensions[number()][1]
        attributes()
        kind = {2: "b", 4: "i", 6: "d"}[number()]
        number()
        variables[name] = struct.unpack_from(f">{count}{kind}", data, number(">q"))
    return variables


def glue_exodus(folder, parts, _command):
    glue = Glue()
    width = len(str(parts - 1))
    for part in range(parts):
        piece = read_netcdf(folder / f"m.e.{parts}.{part:0{width}}")
        if "node_num_map" not in piece:
            continue  # an empty part
        axes = [piece[f"coord{axis}"] for axis in "xyz"]
        glue.add([n - 1 for n in piece["node_num_map"]], zip(*axes, strict=True),
                 [n - 1 for n in piece["elem_num_map"]],
                 rows([n - 1 for n in piece["connect1"]], 8))
    return glue


def foam_list(file):
    """The entries of an OpenFOAM list, as lists of words; they stand in lines."""
    found = re.search(r"\n(\d+)\n\(\n((?:.*\n)*?)\)\n", file.read_text())
    if found is None:
        check(re.search(r"\n0\n?\(\s*\)", file.read_text()), f"{file} has no list")
        return []
    lines = [re.sub(r"^\d+\(|[()]", "", line).split() for line in found[2].splitlines()]
    check(len(lines) == int(found[1]), f"{file} has {len(lines)} entries, and says {found[1]}")
    return lines


def glue_openfoam(folder, parts, _command):
    """Cells are sets of vertices: faces do not tell their order."""
    glue = Glue()
    for part in range(parts):
        mesh = folder / f"processor{part}/constant/polyMesh"
        numbers = [int(n) for n, in foam_list(mesh / "pointProcAddressing")]
        cell_numbers = [int(n) for n, in foam_list(mesh / "cellProcAddressing")]
        cells = [set() for _ in cell_numbers]
        faces = [list(map(int, face)) for face in foam_list(mesh / "faces")]
        for name in ("owner", "neighbour"):
            for face, (cell,) in zip(faces, foam_list(mesh / name), strict=name == "owner"):
                cells[int(cell)].update(face)
        positions = [tuple(map(float, p)) for p in foam_list(mesh / "points")]
        glue.add(numbers, positions, cell_numbers, [sorted(cell) for cell in cells])
    glue.cells = {n: tuple(sorted(cell)) for n, cell in glue.cells.items()}
    return glue


def glue_mfem(folder, parts, _command):
    """MFEM has no global numbers: vertices are the same where they are, cells in order of the parts."""
    number_of, glue = {}, Glue()
    for part in range(parts):
        text = (folder / f"m.{part:06}").read_text()
        cells = text.split("elements\n", 1)[1].split("\n", 1)
        lines = cells[1].split("\n")[:int(cells[0])]
        body = text.split("\nvertices\n", 1)[1].split("\n", 2)
        points = [tuple(map(float, line.split())) for line in body[2].split("\n")[:int(body[0])]]
        numbers = [number_of.setdefault(p, len(number_of)) for p in points]
        first = len(glue.cells)
        glue.add(numbers, points, range(first, first + len(lines)),
                 [list(map(int, line.split()[2:])) for line in lines])
    return glue


FORMATS = {
    "pvtu": ("m.pvtu", glue_pvtu), "vtkhdf": ("m.vtkhdf", glue_vtkhdf), "msh": ("m.msh", glue_one_gmsh),
    "msh-split": ("m", glue_gmsh), "openfoam": ("m.foam", glue_openfoam),
    "exodus-e": ("m.e", glue_exodus), "mfem": ("m", glue_mfem), "cgns": ("m.cgns", glue_cgns)}


def compare(format_, parts, glue, points, cells):
    what = f"{format_}, {parts} parts"
    if format_ == "mfem":
        # By positions: which vertex is which follows from them.
        mine = sorted(tuple(glue.points[v] for v in cell) for cell in glue.cells.values())
        check(mine == sorted(tuple(points[v] for v in cell) for cell in cells), f"{what}: other cells")
        return
    check([glue.points.get(i) for i in range(len(points))] == points
          and len(glue.points) == len(points), f"{what}: other vertices")
    if format_ == "openfoam":
        cells = [tuple(sorted(cell)) for cell in cells]
    check([glue.cells.get(i) for i in range(len(cells))] == cells
          and len(glue.cells) == len(cells), f"{what}: other cells")


def main():
    python = os.environ.get("HEXHEX_PYTHON")
    if python and not os.environ.get("HEXHEX_GLUE"):
        sys.exit(subprocess.run([python, *sys.argv], env={**os.environ, "HEXHEX_GLUE": "1"},
                                check=False).returncode)
    command = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as name:
        top = pathlib.Path(name)
        run(command, "generate", "torus", "-o", top / "map.hexex", "--cells", 3, "--quiet")
        run(command, "extract", top / "map.hexex", "-o", top / "whole.mesh", "--quiet")
        points, cells = read_whole(top / "whole.mesh")
        for format_, (file, glue) in FORMATS.items():
            for parts in (1, 3, 512):
                folder = top / f"{format_}{parts}"
                folder.mkdir()
                run(command, "extract", top / "map.hexex", "-o", folder / file, "--format", format_,
                    "--parts", parts, "--quiet")
                try:
                    glued = glue(folder, parts, command)
                except ImportError as missing:
                    print(f"{format_}: skipped, {missing}")
                    break
                compare(format_, parts, glued, points, cells)
            else:
                print(f"{format_}: glued")


if __name__ == "__main__":
    main()
