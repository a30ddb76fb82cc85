#!/usr/bin/env python3
"""Writes meshes over HDF5 as other programs do.

usage: hdf_files.py KIND FILE

KIND is exodus: by the library of NetCDF (netCDF4), a file of NetCDF-4 with names, blocks, a side set
and node sets, compressed as SEACAS does; exodus27: a block of HEX27; exodus-lies: a block whose
elements are not in the file. cgns: by h5py, a file as the CGNS library maps it to HDF5: two cubes with
conditions; cgns-mixed: in one section of all; cgns20, cgns27: a cell of order 2; cgns-zones, cgns-apart:
a zone for each cube, with and without a connection; cgns-both: one of them structured; cgns-blocks: two
structured zones, whose axes differ, with a range as their connection, cgns-lists: with lists, cgns-loop:
periodic, too; cgns-ring: a structured zone around a hole; cgns-rind, cgns-flat, cgns-far, cgns-faces,
cgns-beyond: to be refused, as cgns-link, cgns-raw, cgns-virtual, whose coordinates are in another file,
FILE.other. vtkhdf: by VTK,
the two cubes; vtkhdf-parts: by h5py, each cube in a partition, with numbers of single precision and
no global numbers; vtkhdf-image, vtkhdf-short, vtkhdf-steps: to be refused.
Exit code 77: a package is not installed.
"""

import sys

CORNERS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]


def write_exodus(file, kind):
    import netCDF4
    import numpy

    def letters(name):
        return numpy.frombuffer(name.encode().ljust(33, b"\0"), dtype="S1")

    data = netCDF4.Dataset(file, "w", format="NETCDF4")
    # Two cubes beside each other along x, and a shell in between; the numbers of blocks are not in order.
    points = numpy.array(CORNERS + [(2, 0, 0), (2, 1, 0), (2, 0, 1), (2, 1, 1)], dtype=float)
    cells = [[1, 2, 3, 4, 5, 6, 7, 8], [2, 9, 10, 3, 6, 11, 12, 7]]
    if kind == "exodus27":
        # Corners, edges at the bottom, upright, at the top; inside; bottom, top, x-, x+, y-, y+.
        edges = [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 5), (2, 6), (3, 7), (4, 5), (5, 6), (6, 7), (7, 4)]
        cube = 2 * numpy.array(CORNERS, dtype=float)
        middles = [cube[[a, b]].mean(axis=0) for a, b in edges]
        rest = [(1, 1, 1), (1, 1, 0), (1, 1, 2), (0, 1, 1), (2, 1, 1), (1, 0, 1), (1, 2, 1)]
        points = numpy.array([*cube, *middles, *rest])
        cells = [list(range(1, 28))]
    data.createDimension("len_name", 33)
    data.createDimension("time_step", None)
    data.createDimension("num_nodes", len(points))
    data.createVariable("time_whole", "f8", ("time_step",))
    for axis, letter in enumerate("xyz"):
        variable = data.createVariable("coord" + letter, "f8", ("num_nodes",), zlib=True)
        variable[:] = points[:, axis]
    data.createDimension("num_el_blk", len(cells))
    data.createVariable("eb_prop1", "i4", ("num_el_blk",))[:] = [30, 20][: len(cells)]
    names = data.createVariable("eb_names", "S1", ("num_el_blk", "len_name"))
    for i, name in enumerate(["steel", "region_7"][: len(cells)]):
        names[i, :] = letters(name)
    for i, cell in enumerate(cells):
        data.createDimension(f"num_el_in_blk{i + 1}", 1)
        data.createDimension(f"num_nod_per_el{i + 1}", len(cell))
        variable = data.createVariable(f"connect{i + 1}", "i8" if i else "i4",
                                       (f"num_el_in_blk{i + 1}", f"num_nod_per_el{i + 1}"), zlib=True)
        variable.elem_type = "HEX" if kind == "exodus27" else "HEX8"
        if kind != "exodus-lies":
            variable[:] = [cell]
    data.createDimension("num_side_sets", 1)
    data.createVariable("ss_prop1", "i4", ("num_side_sets",))[:] = [5]
    names = data.createVariable("ss_names", "S1", ("num_side_sets", "len_name"))
    names[0, :] = letters("inlet")
    data.createDimension("num_side_ss1", 1)
    data.createVariable("elem_ss1", "i4", ("num_side_ss1",))[:] = [1]
    data.createVariable("side_ss1", "i4", ("num_side_ss1",))[:] = [4]  # x = 0
    data.createDimension("num_node_sets", 1)
    data.createVariable("ns_prop1", "i4", ("num_node_sets",))[:] = [9]
    data.createDimension("num_nod_ns1", 1)
    data.createVariable("node_ns1", "i4", ("num_nod_ns1",))[:] = [7]
    data.close()


def write_cgns(file, kind):
    import h5py
    import numpy

    def node(parent, name, label, kind="MT", data=None):
        group = parent.create_group(name, track_order=True)
        for key, value, size in (("name", name, 33), ("label", label, 33), ("type", kind, 3)):
            group.attrs.create(key, numpy.bytes_(value), dtype=f"S{size}")
        if data is not None:
            if kind == "C1":
                data = numpy.frombuffer(data.encode(), dtype=numpy.int8)
            group.create_dataset(" data", data=data)
        return group

    def integers(numbers):
        return numpy.array(numbers, dtype=numpy.int32)

    def zone_of(base, name, points, sections):
        zone = node(base, name, "Zone_t", "I8", numpy.array([[len(points)], [len(sections)], [0]], dtype=numpy.int64))
        node(zone, "ZoneType", "ZoneType_t", "C1", "Unstructured")
        grid = node(zone, "GridCoordinates", "GridCoordinates_t")
        for axis in range(3):
            column = numpy.array(points, dtype=float)[:, axis]
            node(grid, "Coordinate" + "XYZ"[axis], "DataArray_t", "R8", column)
        first = 1
        for title, number, rows in sections:
            section = node(zone, title, "Elements_t", "I4", numpy.array([number, 0], dtype=numpy.int32))
            last = first + len(rows) - 1
            node(section, "ElementRange", "IndexRange_t", "I8", numpy.array([first, last], dtype=numpy.int64))
            node(section, "ElementConnectivity", "DataArray_t", "I8",
                 numpy.array([v for row in rows for v in row], dtype=numpy.int64))
            first = last + 1
        return zone

    def condition(parent, name, location, points=None, span=None, family=None):
        bc = node(parent, name, "BC_t", "C1", "BCWall")
        node(bc, "GridLocation", "GridLocation_t", "C1", location)
        if points is not None:
            node(bc, "PointList", "IndexArray_t", "I4", numpy.array([[p] for p in points], dtype=numpy.int32))
        if span is not None:
            node(bc, "PointRange", "IndexRange_t", "I4", numpy.array([[p] for p in span], dtype=numpy.int32))
        if family is not None:
            node(bc, "FamilyName", "FamilyName_t", "C1", family)

    def connect(zone, donor, here, there):
        all_of_it = node(zone, "ZoneGridConnectivity", "ZoneGridConnectivity_t")
        to = node(all_of_it, "to", "GridConnectivity_t", "C1", donor)
        node(to, "GridConnectivityType", "GridConnectivityType_t", "C1", "Abutting1to1")
        for name, places in (("PointList", here), ("PointListDonor", there)):
            node(to, name, "IndexArray_t", "I4", integers(places).reshape(len(places), -1))

    def block(base, name, places):
        """A structured zone with a vertex at each of an array of places by i, j and k."""
        size = places.shape[:3]
        if kind == "cgns-far" and name == "First":
            size = (3, 1 << 16, 1 << 15)
        sizes = [size, [n - 1 for n in size], [0, 0, 0]] if kind != "cgns-flat" else [size[:2], [2, 2], [0, 0]]
        zone = node(base, name, "Zone_t", "I4", integers(sizes))
        node(zone, "ZoneType", "ZoneType_t", "C1", "Structured")
        grid = node(zone, "GridCoordinates", "GridCoordinates_t")
        if kind == "cgns-rind":
            places = places[1:]
        for axis in range(3):
            node(grid, "Coordinate" + "XYZ"[axis], "DataArray_t", "R8", places[..., axis].transpose(2, 1, 0))
        return zone

    def match(zone, donor, here, there, transform, periodic=False):
        all_of_it = zone.get("Connectivity") or node(zone, "Connectivity", "ZoneGridConnectivity_t")
        label = "GridConnectivity_t" if kind == "cgns-lists" else "GridConnectivity1to1_t"
        to = node(all_of_it, f"to{len(all_of_it)}", label, "C1", donor)
        if kind == "cgns-lists":
            node(to, "GridConnectivityType", "GridConnectivityType_t", "C1", "Abutting1to1")
            places = [(j, k) for j in (1, 2, 3) for k in (1, 2)]
            lists = ([[3, j, k] for j, k in places], [[4 - j, 3 - k, 1] for j, k in places])
            node(to, "PointList", "IndexArray_t", "I4", integers(lists[donor == "First"]))
            node(to, "PointListDonor", "IndexArray_t", "I4", integers(lists[donor == "Second"]))
            return
        node(to, "PointRange", "IndexRange_t", "I4", integers(here))
        node(to, "PointRangeDonor", "IndexRange_t", "I4", integers(there))
        node(to, "Transform", '"int[IndexDimension]"', "I4", integers(transform))
        if periodic:
            node(node(to, "Property", "GridConnectivityProperty_t"), "Periodic", "Periodic_t")

    def write_blocks(base):
        if kind == "cgns-ring":
            angles = numpy.linspace(0, -2 * numpy.pi, 9)[:, None, None]
            radii, heights = numpy.arange(1.0, 4)[None, :, None], numpy.arange(2.0)[None, None, :]
            ring = numpy.stack([radii * numpy.cos(angles) + 0 * heights, radii * numpy.sin(angles) + 0 * heights,
                                heights + 0 * angles * radii], axis=-1)
            match(block(base, "Ring", ring), "Ring", [[1, 1, 1], [1, 3, 2]], [[9, 1, 1], [9, 3, 2]], [1, 2, 3])
            return
        places = numpy.stack(numpy.meshgrid(*(numpy.arange(float(n)) for n in (5, 3, 2)), indexing="ij"), axis=-1)
        first = block(base, "First", places[:3])
        # Its axes are -y, -z and x.
        second = block(base, "Second", places[2:, ::-1, ::-1].transpose(1, 2, 0, 3))
        match(first, "Second", [[3, 1, 1], [3, 3, 2]], [[3, 2, 1], [1, 1, 1]], [3, -1, -2])
        if kind != "cgns-once":
            match(second, "First", [[1, 1, 1], [3, 2, 1]], [[3, 3, 2], [3, 1, 1]], [-2, -3, 1])
        if kind == "cgns-loop":
            match(first, "Second", [[1, 1, 1], [1, 3, 2]], [[3, 2, 3], [1, 1, 3]], [3, -1, -2], periodic=True)
        side = "FaceCenter" if kind == "cgns-faces" else "KFaceCenter"
        for zone, name, location, array, numbers in (
                (first, "west", "Vertex", "Range", [[1, 1, 1], [1, 3, 2]]),
                (second, "north", "IFaceCenter", "List", [[1, 1, 1], [1, 1, 2]] * (5000 if kind == "cgns-many" else 1)),
                (second, "east", side, "Range", [[1, 1, 3], [2, 1, 3]]),
                (first, "corner", "Vertex", "List", [[1, 3, 2]])):
            bc = node(zone.get("ZoneBC") or node(zone, "ZoneBC", "ZoneBC_t"), name, "BC_t", "C1", "BCWall")
            label = {"Range": "IndexRange_t", "List": "IndexArray_t"}[array]
            node(bc, "Point" + array, label, "I4", integers(numbers))
            node(bc, "GridLocation", "GridLocation_t", "C1", location)

    points = CORNERS + [(2, 0, 0), (2, 1, 0), (2, 0, 1), (2, 1, 1)]
    cells = [[1, 2, 3, 4, 5, 6, 7, 8], [2, 9, 10, 3, 6, 11, 12, 7]]
    with h5py.File(file, "w", track_order=True) as data:
        base = node(data, "Base", "CGNSBase_t", "I4", numpy.array([3, 3], dtype=numpy.int32))
        family, faces = "inflow", "FaceCenter"
        if kind == "cgns-gmsh":  # families of entities belong to those of physical groups
            family, faces = "S_1", "CellCenter"
            node(node(base, family, "Family_t"), "inflow", "FamilyName_t", "C1", "inflow")
        else:
            node(base, family, "Family_t")
        if kind[5:] in ("blocks", "lists", "once", "many", "loop", "ring", "rind", "flat", "far", "faces"):
            write_blocks(base)
        elif kind in ("cgns20", "cgns27"):
            # As the standard (SIDS) numbers the nodes: corners, edges at the bottom, upright and at the
            # top, faces from the bottom on around the cell to the top, and the middle.
            edges = [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 5), (2, 6), (3, 7), (4, 5), (5, 6), (6, 7), (7, 4)]
            cube = 2 * numpy.array(CORNERS, dtype=float)
            nodes = [*cube, *(cube[[a, b]].mean(axis=0) for a, b in edges)]
            nodes += [numpy.array(p, dtype=float)
                      for p in [(1, 1, 0), (1, 0, 1), (2, 1, 1), (1, 2, 1), (0, 1, 1), (1, 1, 2), (1, 1, 1)]]
            nodes = nodes[: int(kind[4:])]
            zone_of(base, "Zone", nodes, [("Cells", {20: 18, 27: 19}[len(nodes)], [range(1, len(nodes) + 1)])])
        elif kind == "cgns-both":
            first = zone_of(base, "First", CORNERS, [("Left", 17, [range(1, 9)])])
            x, y, z = numpy.meshgrid([1.0, 2.0], [0.0, 1.0], [0.0, 1.0], indexing="ij")
            second = block(base, "Second", numpy.stack([x, y, z], axis=-1))
            face = [(1, 1, 1), (1, 2, 1), (1, 1, 2), (1, 2, 2)]
            connect(first, "Second", [2, 3, 6, 7], face)
            connect(second, "First", face, [2, 3, 6, 7])
        elif kind in ("cgns-zones", "cgns-apart"):
            first = zone_of(base, "First", CORNERS, [("Left", 17, [range(1, 9)])])
            there = [(1, 0, 0), (2, 0, 0), (2, 1, 0), (1, 1, 0), (1, 0, 1), (2, 0, 1), (2, 1, 1), (1, 1, 1)]
            second = zone_of(base, "Second", there, [("Right", 17, [range(1, 9)])])
            if kind == "cgns-zones":
                connect(first, "Second", [2, 3, 6, 7], [1, 4, 5, 8])
                connect(second, "First", [1, 4, 5, 8], [2, 3, 6, 7])
        else:
            if kind == "cgns-beyond":
                cells[1][0] = 13
            quads = [[1, 5, 8, 4], [9, 10, 12, 11]]
            sections = [("Quads", 7, quads), ("Cells", 17, cells)]
            if kind == "cgns-mixed":
                sections = [("All", 20, [[7, *q] for q in quads] + [[17, *c] for c in cells])]
            zone = zone_of(base, "Zone", points, sections)
            conditions = node(zone, "ZoneBC", "ZoneBC_t")
            condition(conditions, "BC-1", faces, points=[1], family=family)
            condition(conditions, "BC-2", faces, span=[2, 2])
            condition(conditions, "BC-3", "Vertex", points=[1, 2, 3])
            put_into_another_file(data, "Base/Zone/GridCoordinates/CoordinateX/ data", kind)


def write_vtkhdf(file, kind):
    import numpy

    points = numpy.array(CORNERS + [(2, 0, 0), (2, 1, 0), (2, 0, 1), (2, 1, 1)], dtype=float)
    cells = numpy.array([range(8), [1, 8, 9, 2, 5, 10, 11, 6]])
    if kind == "vtkhdf":
        from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
        from vtkmodules.vtkCommonCore import vtkPoints
        from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkUnstructuredGrid
        from vtkmodules.vtkIOHDF import vtkHDFWriter

        grid = vtkUnstructuredGrid()
        places = vtkPoints()
        places.SetData(numpy_to_vtk(points, deep=True))
        grid.SetPoints(places)
        rows = vtkCellArray()
        offsets = numpy.array([0, 8, 16])
        rows.SetData(numpy_to_vtkIdTypeArray(offsets, deep=True), numpy_to_vtkIdTypeArray(cells.ravel(), deep=True))
        grid.SetCells(12, rows)
        regions = numpy_to_vtk(numpy.array([4, 5], dtype=numpy.int32), deep=True)
        regions.SetName("region")
        grid.GetCellData().AddArray(regions)
        writer = vtkHDFWriter()
        writer.SetInputData(grid)
        writer.SetFileName(file)
        writer.Write()
        return
    import h5py

    with h5py.File(file, "w") as data:
        grid = data.create_group("VTKHDF")
        grid.attrs["Version"] = (2, 1)
        grid.attrs.create("Type", numpy.bytes_("ImageData" if kind == "vtkhdf-image" else "UnstructuredGrid"))
        grid["NumberOfPoints"] = [8, 9 if kind == "vtkhdf-short" else 8]
        grid["NumberOfCells"] = [1, 1]
        grid["NumberOfConnectivityIds"] = [8, 8]
        grid["Points"] = points[cells].reshape(16, 3).astype(numpy.float32)
        grid["Connectivity"] = [*range(8), *range(8)]
        grid["Offsets"] = [0, 8, 0, 8]
        grid["Types"] = numpy.array([12, 12], dtype=numpy.uint8)
        grid.create_group("CellData")["region"] = numpy.array([4, 5], dtype=numpy.int32)
        if kind == "vtkhdf-steps":
            grid.create_group("Steps")["Values"] = [0.0, 1.0]


def put_into_another_file(data, path, kind):
    import h5py

    other = data.filename + ".other"
    if kind not in ("cgns-link", "cgns-raw", "cgns-virtual"):
        return
    values = data[path][...]
    del data[path]
    if kind == "cgns-raw":
        values.tofile(other)
        data.create_dataset(path, shape=values.shape, dtype="f8", external=[(other, 0, values.nbytes)])
        return
    with h5py.File(other, "w") as file:
        file["values"] = values
    if kind == "cgns-link":
        data[path] = h5py.ExternalLink(other, "values")
    else:
        layout = h5py.VirtualLayout(shape=values.shape, dtype="f8")
        layout[:] = h5py.VirtualSource(other, "values", shape=values.shape)
        data.create_virtual_dataset(path, layout)


if __name__ == "__main__":
    try:
        writers = {"cgns": write_cgns, "vtkh": write_vtkhdf, "exod": write_exodus}
        writers[sys.argv[1][:4]](sys.argv[2], sys.argv[1])
    except ImportError:
        sys.exit(77)
