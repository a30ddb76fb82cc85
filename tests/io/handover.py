"""How scripts of this folder hand over what another program read."""

import sys

NOT_INSTALLED = 77


def hand_over(readers):
    """Reads a file and writes OUT.points (float64), OUT.cells (int64) and OUT.groups (a line each:
    name and number of elements). The command line is NAME FILE OUT; readers[NAME](FILE) returns the
    three. Returns the exit code: NOT_INSTALLED if a module is missing."""
    name, file, out = sys.argv[1:]
    try:
        points, cells, groups = readers[name](file)
    except ImportError as error:
        print(error, file=sys.stderr)
        return NOT_INSTALLED
    points.astype("<f8").tofile(out + ".points")
    cells.astype("<i8").tofile(out + ".cells")
    with open(out + ".groups", "w", encoding="utf-8") as listing:
        for group in sorted(groups):
            print(group, groups[group], file=listing)
    return 0


def open_in_gmsh(file):
    """Gmsh's module, with a file in it. Fails if Gmsh warns of anything."""
    import gmsh

    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.logger.start()
    gmsh.open(file)
    complaints = [line for line in gmsh.logger.get() if line.startswith(("Error", "Warning"))]
    gmsh.logger.stop()
    assert not complaints, complaints
    return gmsh
