#!/usr/bin/env python3
"""Measures meshes of hexahedra of any order with another program.

usage: measure_with.py PROGRAM FILE...

PROGRAM is gmsh, mfem or vtk. FILE.measures gets lines "KIND NAME COUNT MEASURE": the kinds are
vertices, edges, quads, cells and nodes; NAME is that of a group, or "all"; the measure is length, area or
volume, integrated over the program's own shape functions (0 where it is not known); that of the kind
"flux", of groups of quads, is the flux of x / 3: that of a closed surface is the volume in it, if all
quads face outwards. A last line says
"jacobian MINIMUM", the smallest determinant of a cell's Jacobian matrix at the points of
integration, where cells are unit cubes. Exit code 77: the program is not installed.
"""

import sys

from handover import NOT_INSTALLED, open_in_gmsh

POINTS = 7  # of the integration in each direction, as the test takes


class Groups:
    """Sums by kind and name."""

    def __init__(self):
        self.sums = {}
        self.minimum = float("inf")

    def add(self, kind, name, measure, count=1):
        before = self.sums.get((kind, name), (0, 0.0))
        self.sums[kind, name] = (before[0] + count, before[1] + measure)

    def write(self, file):
        with open(file, "w", encoding="ascii") as out:
            for (kind, name), (count, measure) in sorted(self.sums.items()):
                out.write(f"{kind} {name} {count} {float(measure)!r}\n")
            out.write(f"jacobian {float(self.minimum)!r}\n")


def measure_with_gmsh(file):
    import numpy

    def gauss(dimension):
        """Places (always three coordinates) and weights in [-1, 1]^dimension."""
        at, weight = numpy.polynomial.legendre.leggauss(POINTS)
        grid = numpy.meshgrid(*[at] * dimension, *[numpy.zeros(1)] * (3 - dimension), indexing="ij")
        weights = numpy.array([1.0])
        for _ in range(dimension):
            weights = numpy.outer(weights, weight).ravel()
        return numpy.stack([g.ravel() for g in grid], axis=1).ravel(), weights

    gmsh = open_in_gmsh(file)
    groups = Groups()
    for dimension, kind in enumerate(("vertices", "edges", "quads", "cells")):
        for _, tag in gmsh.model.getPhysicalGroups(dimension):
            name = gmsh.model.getPhysicalName(dimension, tag)
            for entity in gmsh.model.getEntitiesForPhysicalGroup(dimension, tag):
                for element in gmsh.model.mesh.getElementTypes(dimension, entity):
                    tags, _ = gmsh.model.mesh.getElementsByType(element, entity)
                    if dimension == 0:
                        groups.add(kind, name, 0, len(tags))
                        continue
                    places, weights = gauss(dimension)
                    columns, determinants, at = gmsh.model.mesh.getJacobians(element, places, entity)
                    determinants = determinants.reshape(-1, len(weights))
                    if dimension == 2:
                        columns = columns.reshape(-1, len(weights), 3, 3)
                        normals = numpy.cross(columns[:, :, 0], columns[:, :, 1])
                        flux = (normals * at.reshape(normals.shape)).sum(axis=2) / 3
                        groups.add("flux", name, (flux @ weights).sum(), len(tags))
                    groups.add(kind, name, (determinants @ weights).sum(), len(tags))
                    if dimension == 3:
                        # Gmsh's cubes have edges of length 2.
                        groups.minimum = min(groups.minimum, 8 * determinants.min())
    nodes, _, _ = gmsh.model.mesh.getNodes()
    groups.add("nodes", "all", 0, len(nodes))
    gmsh.finalize()
    return groups


def measure_with_mfem(file):
    import mfem.ser as mfem

    mesh = mfem.Mesh(file, 0, 0, False)  # neither refined nor with corners exchanged
    assert mesh.Dimension() == 3
    assert mesh.CheckElementOrientation(False) == 0
    assert mesh.CheckBdrElementOrientation(False) == 0
    groups = Groups()

    def integrate(transformation, geometry):
        rule = mfem.IntRules.Get(geometry, 2 * POINTS - 1)
        total, minimum = 0.0, float("inf")
        for i in range(rule.GetNPoints()):
            point = rule.IntPoint(i)
            transformation.SetIntPoint(point)
            weight = transformation.Weight()
            minimum = min(minimum, weight)
            total += point.weight * weight
        return total, minimum

    for i in range(mesh.GetNE()):
        volume, minimum = integrate(mesh.GetElementTransformation(i), mfem.Geometry.CUBE)
        groups.add("cells", str(mesh.GetAttribute(i)), volume)
        groups.minimum = min(groups.minimum, minimum)
    for i in range(mesh.GetNBE()):
        area, _ = integrate(mesh.GetBdrElementTransformation(i), mfem.Geometry.SQUARE)
        groups.add("quads", str(mesh.GetBdrAttribute(i)), area)
    return groups


def measure_with_vtk(file):
    import numpy
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(file)
    reader.Update()
    grid = reader.GetOutput()
    groups = Groups()
    regions = grid.GetCellData().GetArray("region")
    places, weights = numpy.polynomial.legendre.leggauss(POINTS)
    places, weights = (places + 1) / 2, weights / 2
    derivatives = {}  # by the number of nodes: of all functions at all places
    for c in range(grid.GetNumberOfCells()):
        cell = grid.GetCell(c)
        count = cell.GetNumberOfPoints()
        if count not in derivatives:
            values = [0.0] * (3 * count)
            rows = []
            for x in places:
                for y in places:
                    for z in places:
                        cell.InterpolateDerivs((x, y, z), values)
                        # Lagrange cells list them node by node.
                        rows.append(numpy.array(values).reshape(count, 3).T if cell.IsA("vtkLagrangeHexahedron")
                                    else numpy.array(values).reshape(3, count))
            derivatives[count] = numpy.array(rows)
        points = numpy.array([cell.GetPoints().GetPoint(i) for i in range(count)])
        determinants = numpy.linalg.det(derivatives[count] @ points)
        products = numpy.einsum("i,j,k->ijk", weights, weights, weights).ravel()
        name = str(int(regions.GetValue(c))) if regions else "all"
        groups.add("cells", name, determinants @ products)
        groups.minimum = min(groups.minimum, determinants.min())
    for array, kind in (("feature_edges", "edges"), ("feature_quads", "quads")):
        rows = grid.GetFieldData().GetArray(array)
        for row in vtk_to_numpy(rows) if rows else ():
            groups.add(kind, str(row[-1]), 0)
    tags = grid.GetPointData().GetArray("feature_vertex")
    for tag in vtk_to_numpy(tags) if tags else ():
        if tag != 0:
            groups.add("vertices", str(tag), 0)
    groups.add("nodes", "all", 0, grid.GetNumberOfPoints())
    return groups


PROGRAMS = {"gmsh": measure_with_gmsh, "mfem": measure_with_mfem, "vtk": measure_with_vtk}

if __name__ == "__main__":
    for path in sys.argv[2:]:
        try:
            PROGRAMS[sys.argv[1]](path).write(path + ".measures")
        except ImportError as error:
            print(error, file=sys.stderr)
            sys.exit(NOT_INSTALLED)
