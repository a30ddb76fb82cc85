"""From a map to a verified mesh, in Python.

    python3 pipeline.py [MAP [MESH]]
"""

import sys

import hexhex


def main(arguments):
    map = hexhex.read(arguments[0]) if arguments else hexhex.generate("sphere", refine=3)
    target = arguments[1] if len(arguments) > 1 else "mesh.vtu"

    report = hexhex.check(map)
    for defect in report.defects:
        print(f"{defect.sentence} ({defect.count} times, first at {defect.worst[0][0]})")
    if not report.valid:
        return 1

    # Arrays of your own work as well: hexhex.extract(points, tets, parameters).
    mesh = hexhex.extract(map, scale=2)
    verified = hexhex.verify(map, mesh, scale=2)
    quality = hexhex.quality(mesh)
    edges, valences, _ = mesh.singular_edges()
    print(f"{len(mesh.cells)} hexahedra, {len(edges)} singular edges of valence "
          f"{sorted(set(valences.tolist()))}, scaled Jacobian at least {quality.minimum:.3f}")
    hexhex.write(mesh, target)
    return 0 if verified else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
