"""The Python package: results, arrays without copies, threads, signals, errors, other libraries."""

import doctest
import itertools
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import hexhex


@pytest.fixture(scope="module")
def sphere():
    return hexhex.generate("sphere", charts="random", jitter=0.05)


def address(array):
    return array.__array_interface__["data"][0]


def test_doctests():
    for module, least in ((hexhex, 30), (hexhex._types, 3)):
        result = doctest.testmod(module, extraglobs={"hexhex": hexhex})
        assert result.attempted >= least and result.failed == 0


def test_extract_and_verify(sphere):
    mesh = hexhex.extract(sphere.points, sphere.tets, sphere.igm, scale=2)
    assert mesh.cells.shape == (3584, 8) and mesh.cells.dtype == np.uint32
    assert mesh.points.shape == (3817, 3) and mesh.points.dtype == np.float64
    assert mesh.statistics["charts"] > 0
    report = hexhex.verify(sphere, mesh, scale=2)
    assert report and all(item.passed for item in report.items)
    assert not hexhex.verify(sphere, mesh, scale=3)
    assert np.bincount(mesh.generator_kind, minlength=4).sum() == 3817
    assert np.array_equal(mesh.cells, hexhex.extract(sphere, scale=2, engine="propeller",
                                                     threads=1).cells)


def test_boundary_and_singular_edges(sphere):
    mesh = hexhex.extract(sphere)
    expected = hexhex.check(sphere).expected
    assert len(mesh.boundary_quads()) == expected["boundary_quads"]
    # Outwards: the volume behind the boundary is positive.
    p = mesh.points[mesh.boundary_quads()]
    volume = sum(np.einsum("ij,ij->i", p[:, 0], np.cross(p[:, i], p[:, i + 1])).sum()
                 for i in (1, 2)) / 6
    assert volume > 3
    edges, valence, boundary = mesh.singular_edges()
    inner = dict(zip(*np.unique(valence[~boundary], return_counts=True)))
    assert inner == expected["inner_singular_edges"]
    assert not boundary.any() and edges.shape[1] == 2


def test_no_copies_in(sphere):
    points = np.array(sphere.points)
    igm = np.array(sphere.igm).reshape(-1, 12)
    for dtype in (np.uint32, np.int32):
        tets = np.array(sphere.tets, dtype=dtype)
        used = hexhex.Map(points, tets, igm)
        assert address(used.points) == address(points)
        assert address(used.tets) == address(tets)
        assert address(used.igm) == address(igm)
        assert len(hexhex.extract(used).cells) == 448
    # Others are converted.
    converted = hexhex.Map(np.asfortranarray(points), sphere.tets.astype(np.int64).tolist(),
                           igm.astype(np.longdouble))
    assert len(hexhex.extract(converted).cells) == 448


def test_no_copies_out(sphere):
    mesh = hexhex.extract(sphere)
    assert address(mesh.points) == address(mesh.points)
    assert address(mesh.cells) == address(mesh.cells)
    mesh.points[0] = (7, 8, 9)
    assert tuple(mesh.points[0]) == (7, 8, 9)
    points, cells = mesh.points, mesh.cells
    total = cells.sum()
    del mesh  # the arrays keep what they show alive
    hexhex.extract(sphere, scale=2)
    assert tuple(points[0]) == (7, 8, 9) and cells.sum() == total


def test_extractor_keeps_its_arrays(sphere):
    extractor = hexhex.Extractor(np.array(sphere.points), np.array(sphere.tets),
                                 np.array(sphere.igm))
    for scale in (3, 1, 2):
        assert np.array_equal(extractor.extract(scale=scale).points,
                              hexhex.extract(sphere, scale=scale).points)
    with pytest.raises(hexhex.ArgumentError):
        extractor.extract(scale=1000)
    # Other orders and outputs, in any order.
    for options in (dict(order=3), dict(scale=2, arcs=True, patches=True), dict(order=2, scale=2)):
        mesh, expected = extractor.extract(**options), hexhex.extract(sphere, **options)
        assert np.array_equal(mesh.points, expected.points)
        assert (mesh.arcs is None) == (expected.arcs is None)
        if mesh.arcs is not None:
            assert np.array_equal(mesh.arcs.points, expected.arcs.points)
            assert np.array_equal(mesh.patches.corners, expected.patches.corners)
        if mesh.curved is not None:
            assert np.array_equal(mesh.curved.points, expected.curved.points)
            assert np.array_equal(mesh.curved.nodes, expected.curved.nodes)
    with pytest.raises(hexhex.ArgumentError):
        extractor.extract(scale=33, order=2)


def test_errors(sphere, tmp_path):
    igm = np.array(sphere.igm)
    igm[11, 0] = igm[11, 1]
    with pytest.raises(hexhex.MapError) as caught:
        hexhex.extract(sphere.points, sphere.tets, igm)
    assert caught.value.code == "FlippedTet" and caught.value.place.startswith("tet ")
    assert isinstance(caught.value, ValueError)
    report = hexhex.check(sphere.points, sphere.tets, igm)
    assert not report.valid and report.expected is None
    assert report.defects[0].code == "FlippedTet"
    assert report.defects[0].worst[0][1] == caught.value.index
    (tmp_path / "bad.hexex").write_text("2\n0 0 0\n0 x 0\n")
    with pytest.raises(hexhex.FileError) as caught:
        hexhex.read(tmp_path / "bad.hexex")
    assert (caught.value.code, caught.value.index) == ("FileSyntax", 3)
    with pytest.raises(hexhex.FileError):
        hexhex.read(tmp_path / "none.ovm")
    bad = [dict(scale=0), dict(tolerance=1), dict(engine="steam"), dict(threads=0)]
    for options in bad:
        with pytest.raises(hexhex.ArgumentError):
            hexhex.extract(sphere, **options)
    with pytest.raises(hexhex.ArgumentError):
        hexhex.extract(sphere.points, sphere.points, sphere.igm)
    negative = np.array(sphere.tets, dtype=np.int32)
    negative[3, 1] = -1
    with pytest.raises(hexhex.MapError) as caught:
        hexhex.extract(sphere.points, negative, sphere.igm)
    assert caught.value.code == "IndexOutOfRange"
    with pytest.raises(hexhex.ArgumentError):
        hexhex.generate("banana")


def test_verify_meshes_that_are_none(sphere):
    mesh = hexhex.extract(sphere)

    def damaged(points=None, cells=None):
        return hexhex.verify(sphere, hexhex.Mesh(mesh.points if points is None else points,
                                                 mesh.cells if cells is None else cells))

    assert damaged()
    for value in (np.nan, np.inf, 1e308, 0):
        points = np.array(mesh.points)
        points[7] = value
        assert not damaged(points=points)
        assert not damaged(points=np.full_like(points, value))
    for corners in ([0] * 8, [0, 1, 2, 3] * 2):
        cells = np.array(mesh.cells)
        cells[5] = corners
        assert not damaged(cells=cells)
        assert not damaged(cells=np.full_like(cells, corners))
    assert not damaged(cells=mesh.cells[:0])
    assert not damaged(cells=np.tile(mesh.cells, (100, 1)))
    cells = np.array(mesh.cells)
    cells[5, 3] = len(mesh.points)
    assert not damaged(cells=cells)


def test_files(sphere, tmp_path):
    hexhex.write(sphere, tmp_path / "map.hexex")
    assert np.array_equal(hexhex.read(tmp_path / "map.hexex").igm, sphere.igm)
    mesh = hexhex.extract(sphere)
    for name in ("m.vtu", "m.mesh", "m.ovm", "m.msh"):
        hexhex.write(mesh, tmp_path / name)
        assert np.array_equal(hexhex.read(tmp_path / name).points, mesh.points)
    quality = hexhex.quality(mesh)
    assert quality.minimum > 0 and quality.scaled_jacobians.shape == (448,)
    copy = hexhex.Mesh(mesh.points, mesh.cells)
    assert hexhex.verify(sphere, copy)


def test_every_format_of_this_build(sphere, tmp_path):
    """Also in a wheel, which brings no library for them along."""
    mesh = hexhex.extract(sphere)
    formats = [f for f in hexhex.formats() if f.writes_meshes]
    assert {"exodus", "vtu", "msh", "openfoam"} <= {f.name for f in formats}
    for f in formats:
        file = tmp_path / (f.name + (f.extension or ".mfem"))
        hexhex.write(mesh, file, format=f.name)
        assert file.exists()
        if f.reads_meshes and f.name != "openfoam":  # which has no order of corners
            np.testing.assert_array_equal(hexhex.read(file, format=f.name).cells, mesh.cells)


def test_hexahedra_among_other_cells(tmp_path):
    file = tmp_path / "mixed.mesh"
    points = [f"{x} {y} {z} 0" for z in range(2) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
    file.write_text("MeshVersionFormatted 2 Dimension 3 Vertices 9 " + " ".join(points) + " 0 0 2 0 "
                    "Hexahedra 1 1 2 3 4 5 6 7 8 0 Pyramids 1 5 6 7 8 9 0 End")
    for read in (hexhex.read, hexhex.read_mesh):
        with pytest.raises(hexhex.FileError, match="1 hexahedron and 1 pyramid"):
            read(file)
        assert len(read(file, hexes_only=True).cells) == 1


def test_progress(sphere):
    seen = []
    hexhex.extract(sphere, progress=lambda stage, share: seen.append((stage, share)))
    assert len({stage for stage, _ in seen}) > 5
    assert all(0 <= share <= 1 for _, share in seen)

    def stop(stage, share):
        raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        hexhex.extract(sphere, progress=stop)


def test_gil_is_released():
    """While one thread extracts, another one runs Python."""
    big = hexhex.generate("sphere", cells=8, refine=6)
    done = threading.Event()
    worker = threading.Thread(target=lambda: (hexhex.extract(big, scale=6, threads=1), done.set()))
    steps = 0
    worker.start()
    while not done.is_set():
        steps += 1
        time.sleep(0.001)
    worker.join()
    assert steps > 20


INTERRUPTED = """
import os, signal, hexhex
signal.signal(signal.SIGINT, signal.default_int_handler)  # ignored in jobs in the background
map = hexhex.generate("sphere", cells=16, refine=4)
stages = []
def interrupt(stage, share):
    if not stages:
        os.kill(os.getpid(), signal.SIGINT)
    stages.append(stage)
try:
    hexhex.extract(map, scale=12, threads=1, progress=interrupt)
    print("not interrupted")
except KeyboardInterrupt:
    print("interrupted in", *stages)
"""


def test_ctrl_c():
    """It ends the work before the stage begins that takes most of the time."""
    result = subprocess.run([sys.executable, "-c", INTERRUPTED], capture_output=True, text=True,
                            timeout=120, check=True)
    assert result.stdout.startswith("interrupted in input"), result.stdout + result.stderr
    assert "cells" not in result.stdout.split(), result.stdout


def test_many_threads(sphere):
    """Calls from several threads at once give the same."""
    expected = hexhex.extract(sphere, scale=2)
    results = [None] * 4

    def run(i):
        results[i] = hexhex.extract(sphere, scale=2, threads=1)

    threads = [threading.Thread(target=run, args=(i,)) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for mesh in results:
        assert np.array_equal(mesh.points, expected.points)
        assert np.array_equal(mesh.cells, expected.cells)


def test_meshio(sphere, tmp_path):
    meshio = pytest.importorskip("meshio")
    mesh = hexhex.extract(sphere)
    mesh.to_meshio().write(tmp_path / "m.vtk")
    read = meshio.read(tmp_path / "m.vtk")
    assert np.array_equal(read.cells_dict["hexahedron"], mesh.cells)
    assert np.array_equal(read.points, mesh.points)


def test_features():
    box = hexhex.generate("box", features=True)
    used = hexhex.Map(box.points, box.tets, box.igm, features=box.features, regions=box.regions)
    assert address(used.features.faces) == address(box.features.faces)
    assert address(used.regions) == address(box.regions)
    mesh = hexhex.extract(used)
    assert len(mesh.features.vertices) == 8 and len(mesh.features.edges) == 12 * 8
    assert sorted(np.unique(mesh.features.faces[:, 4])) == [1, 2, 3, 4, 5, 6]
    assert address(mesh.features.faces) == address(mesh.features.faces)
    assert (np.bincount(mesh.regions)[1:] == 64).all()
    copy = hexhex.Mesh(mesh.points, mesh.cells, features=mesh.features, regions=mesh.regions)
    assert np.array_equal(copy.features.faces, mesh.features.faces)
    for bad in ([[1, 2, 3]], [["a", "b"]], [[2**40, 1]], [0.5], 7):
        with pytest.raises(hexhex.ArgumentError):
            hexhex.Features(vertices=bad)
    for bad in ({"features": hexhex.Features(vertices=[[10**6, 1]])}, {"regions": [1, 2]}):
        with pytest.raises(hexhex.HexhexError):
            hexhex.extract(hexhex.Map(box.points, box.tets, box.igm, **bad))


def test_curved(sphere, tmp_path):
    mesh = hexhex.extract(sphere, order=3, arcs=True, patches=True)
    straight = hexhex.extract(sphere)
    assert np.array_equal(mesh.points, straight.points)
    curved, arcs, patches = mesh.curved, mesh.arcs, mesh.patches
    assert curved.nodes.shape == (448, 64) and curved.vertex_count == len(mesh.points)
    corners = curved.nodes[:, [0, 3, 15, 12, 48, 51, 63, 60]]
    assert np.array_equal(corners, mesh.cells)
    assert arcs.point_begin[-1] == len(arcs.points) and len(arcs) == mesh.structure()["edges"]
    assert len(patches) == mesh.structure()["faces"]
    assert patches.corner_begin[-1] == len(patches.corners)
    total = patches.points.sum()
    address_of_nodes = address(curved.nodes)
    del mesh  # arrays keep what they show alive
    assert patches.points.sum() == total and address(curved.nodes) == address_of_nodes
    assert hexhex.quality(curved).scaled_jacobians.shape == (448,)
    assert hexhex.quality(curved).validity.shape == (448,)
    for what, name in ((curved, "c.vtu"), (curved, "c.msh"), (arcs, "a.vtp"), (patches, "p.ovmb")):
        hexhex.write(what, tmp_path / name)
        assert (tmp_path / name).stat().st_size > 1000
    with pytest.raises(hexhex.FileError):
        hexhex.write(arcs, tmp_path / "a.stl")
    with pytest.raises(hexhex.ArgumentError):
        hexhex.write(arcs, tmp_path / "a.vtu", compress=True)
    assert hexhex.extract(sphere, order=2).arcs is None
    for order in (0, 10, -1):
        with pytest.raises(hexhex.ArgumentError):
            hexhex.extract(sphere, order=order)


def test_repair():
    bad = hexhex.generate("sphere", cells=8, refine=4, defects=2)
    with pytest.raises(hexhex.MapError):
        hexhex.extract(bad)
    part = hexhex.extract_partial(bad)
    assert 0 < len(part.mesh.cells) < 3584 and part.missing_cells > 0 and part.holes[0].tets > 0
    assert set(part.mesh.regions.tolist()) == {0, 1}
    if not hexhex.can_repair():
        pytest.skip("without Eigen")
    good, report = hexhex.repair(bad)
    assert report.changed and report.bad_tets >= 2 and report.regions[0].place.startswith("tet")
    mesh = hexhex.extract(bad, repair=True)
    assert mesh.repair.changed and np.array_equal(mesh.repaired_map.igm, good.igm)
    assert hexhex.verify(mesh.repaired_map, mesh)
    assert hexhex.extract(good, repair=True).repair is None


def seamless(map, factor=2**0.5, **rest):
    """The same map with charts that no longer are integer."""
    return hexhex.Map(map.points, map.tets, map.igm * factor, **rest)


def needs_quantization():
    if not hexhex.can_quantize():
        pytest.skip("without Eigen")


def test_walls_are_features_if_they_are_kept(tmp_path):
    # Two tets with the triangle 1 2 3 between them.
    (tmp_path / "map.hexex").write_text(
        "5\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1\n2\n0 1 2 3 0 0 0 1 0 0 0 1 0 0 0 1\n"
        "1 2 3 4 1 0 0 0 1 0 0 0 1 1 1 1\n2\n1 2 3 0.5\n0 1 2 0\n")
    for read in hexhex.read_map, hexhex.read:
        assert len(read(tmp_path / "map.hexex").features.faces) == 0
        assert read(tmp_path / "map.hexex", keep_walls=True).features.faces.tolist() == [[1, 2, 3, 2]]


def test_improve_pulls_onto_a_surface(tmp_path):
    map = hexhex.generate("box", cells=2)
    mesh = hexhex.extract(map)
    low, high = mesh.points.min(axis=0) - 0.05, mesh.points.max(axis=0) + 0.05
    corners = [[(low, high)[i >> k & 1][k] for k in range(3)] for i in range(8)]
    quads = [(1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (3, 7, 8, 4), (1, 5, 7, 3), (2, 4, 8, 6)]
    part = tmp_path / "part.obj"
    part.write_text("".join("v {} {} {}\n".format(*c) for c in corners)
                    + "".join("f {} {} {} {}\n".format(*q) for q in quads))
    better, report = hexhex.improve(mesh, surface=part)
    np.testing.assert_allclose(better.points.max(axis=0), high)
    assert report.from_mesh_before > 0.005 and report.from_mesh_after < 1e-9
    assert report.worst_held_by in ("corner", "curve", "surface", "neighbours")
    assert len(report.cannot_be_positive) == 0 and report.paired_vertices == 0
    with pytest.raises(ValueError, match="not both"):
        hexhex.improve(mesh, map, surface=part)


def test_improve_moves_a_copy_until_cells_are_positive():
    map = hexhex.generate("torus", cells=3, jitter=0.9)
    mesh = hexhex.extract(map, scale=2)
    points = mesh.points.copy()
    better, report = hexhex.improve(mesh, map)
    assert np.array_equal(mesh.points, points) and np.array_equal(better.cells, mesh.cells)
    assert report.after.all_positive and len(report.not_positive) == 0
    assert (len(report.far_cells) > 0) == (report.from_mesh_after > 1e-3)
    assert (report.far_cells_before > 0) == (report.from_mesh_before > 1e-3)
    assert report.after.minimum >= report.before.minimum == hexhex.quality(mesh).minimum
    assert report.after.minimum == hexhex.quality(better).minimum
    assert report.moved_vertices == (better.points != points).any(axis=1).sum()
    moved = np.linalg.norm(better.points - points, axis=1).max()
    assert np.isclose(report.largest_move * report.diagonal, moved)
    fixed, report = hexhex.improve(mesh, fix_boundary=True, passes=0)
    assert report.patch_vertices == 0 < report.fixed_vertices
    assert report.tagged_vertices == 0 < report.boundary_vertices <= report.fixed_vertices
    with pytest.raises(hexhex.ArgumentError):
        hexhex.improve(mesh, target=2)
    with pytest.raises(hexhex.ArgumentError, match="is not where the map is|not in the map"):
        hexhex.improve(mesh, hexhex.generate("box", cells=3))


def test_improve_adds_a_layer_of_cells():
    map = hexhex.generate("box", cells=2)
    mesh = hexhex.extract(map)
    better, report = hexhex.improve(mesh, map, pillow="always")
    assert report.added_cells == 6 * 16 == len(better.cells) - len(mesh.cells)
    assert report.after.all_positive and len(report.after.scaled_jacobians) == len(better.cells)
    assert len(report.before.scaled_jacobians) == len(mesh.cells)
    assert hexhex.improve(mesh, map, pillow="auto")[1].added_cells == 0  # cells are perfect
    with pytest.raises(hexhex.ArgumentError, match='no pillow "yes"'):
        hexhex.improve(mesh, pillow="yes")
    with pytest.raises(hexhex.ArgumentError, match="straight cells"):
        hexhex.improve(hexhex.extract(map, order=2).curved, map, pillow="auto")


def test_improve_moves_nodes_of_curved_cells():
    map = hexhex.generate("sphere", cells=1, jitter=0.5)
    curved = hexhex.extract(map, order=2).curved
    better, report = hexhex.improve(curved, map, target=0.1, passes=1)
    assert isinstance(better, hexhex.LagrangeMesh) and np.array_equal(better.nodes, curved.nodes)
    assert report.moved_vertices == (better.points != curved.points).any(axis=1).sum() > 0
    assert report.after.minimum >= report.before.minimum
    assert report.after.minimum == hexhex.quality(better).minimum


def quantized_cells(map, **density):
    made, report = hexhex.quantize(map, **density)
    mesh = hexhex.extract(made)
    assert hexhex.check(made).valid and hexhex.verify(made, mesh)
    assert report.cells == len(mesh.cells)
    return len(mesh.cells)


@pytest.mark.parametrize("kind", ["box", "sphere", "torus", "handle-body"])
def test_quantization_of_integer_grid_maps(kind):
    needs_quantization()
    map = hexhex.generate(kind, cells=3, charts="random")
    expected = hexhex.check(map).expected["cells"]
    assert hexhex.examine_seamless(map).kind == "seamless"
    assert quantized_cells(map, scale=1) == expected
    assert quantized_cells(seamless(map), scale=0.5**0.5) == expected
    assert quantized_cells(seamless(map), cells=8 * expected) == 8 * expected


def test_quantization_report():
    needs_quantization()
    map = hexhex.generate("sphere", cells=4)
    told = []
    made, report = hexhex.quantize(seamless(map), scale=0.5**0.5,
                                   progress=lambda stage, share: told.append(stage))
    assert "bending" in told and "bending" in [name for name, seconds in report.stages]
    assert report.cells == 448 and abs(report.cells_wanted - 448) < 1e-6
    assert report.displacement < 1e-9 and report.integers_by in ("HiGHS", "rounding")
    assert 0 < report.blocks <= report.arcs and 1 <= report.shortest_arc <= report.longest_arc
    assert 0 < report.worst_after <= report.median_after <= 1
    assert 0 < report.worst_before <= report.median_before <= 1
    assert len(made.tets) == len(map.tets) + report.added_tets
    assert len(made.points) == len(map.points) + report.split_edges
    # As many as asked, by each way to ask.
    for density in ({"cells": 448}, {"edge_length": (4.18 / 448) ** (1 / 3)}):
        assert hexhex.quantize(seamless(map), **density)[1].cells == 448
    # The result does not depend on threads.
    assert np.array_equal(made.igm, hexhex.quantize(seamless(map), scale=0.5**0.5, threads=1)[0].igm)


def moved_charts(map, seed):
    """Each tet's chart rotated and shifted at random: the same seamless map."""
    random = np.random.default_rng(seed)
    rotations = [np.eye(3)[list(order)] * signs for order in itertools.permutations(range(3))
                 for signs in itertools.product((1, -1), repeat=3)]
    rotations = np.array([r for r in rotations if np.linalg.det(r) > 0])
    igm = np.einsum("tij,tkj->tki", rotations[random.integers(24, size=len(map.tets))], map.igm)
    return hexhex.Map(map.points, map.tets, igm + random.uniform(-9, 9, (len(map.tets), 1, 3)))


def test_quantization_of_moved_charts():
    needs_quantization()
    map = seamless(hexhex.generate("sphere", cells=3, jitter=0.05))
    expected = [quantized_cells(map, cells=cells) for cells in (100, 1000)]
    for seed in range(2):
        moved = moved_charts(map, seed)
        with pytest.raises(hexhex.MapError):
            hexhex.extract(moved)
        assert [quantized_cells(moved, cells=cells) for cells in (100, 1000)] == expected


def test_quantization_keeps_features():
    needs_quantization()
    map = hexhex.generate("box", cells=2, features=True)
    made, report = hexhex.quantize(
        seamless(map, features=map.features, regions=map.regions), scale=0.5**0.5)
    mesh, before = hexhex.extract(made), hexhex.extract(map)
    assert report.cells == 64
    for dimension in ("vertices", "edges", "faces"):
        assert len(getattr(mesh.features, dimension)) == len(getattr(before.features, dimension)) > 0
    assert np.array_equal(np.bincount(mesh.regions), np.bincount(before.regions))


def test_quantization_refuses():
    needs_quantization()
    map = seamless(hexhex.generate("sphere"))
    for options in ({}, {"cells": 0}, {"cells": -1}, {"cells": float("nan")}, {"scale": 0},
                    {"cells": 10, "scale": 1}, {"cells": 0, "scale": 1}, {"edge_length": -1},
                    {"cells": 10, "tolerance": 0.5}, {"cells": 10, "threads": 0}):
        with pytest.raises(hexhex.ArgumentError):
            hexhex.quantize(map, **options)
    with pytest.raises(hexhex.MapError) as caught:
        hexhex.quantize(map, cells=1e12)
    assert caught.value.code == "TooLarge"
    sheared = np.array(map.igm)
    sheared[..., 0] += 0.1 * sheared[..., 1]
    none = hexhex.Map(map.points, map.tets, sheared)
    report = hexhex.examine_seamless(none)
    assert report.kind == "neither" and len(report.problem) > 20
    flipped = hexhex.generate("sphere", cells=8, refine=6, defects=5)
    for wrong, code in (none, "TransitionResidual"), (flipped, "FlippedTet"):
        for densify in (False, True):
            with pytest.raises(hexhex.MapError) as caught:
                hexhex.quantize(wrong, cells=100, densify=densify)
            assert caught.value.code == code
    assert quantized_cells(map, cells=100, densify=True) == quantized_cells(map, cells=100)
    with pytest.raises(ZeroDivisionError):
        hexhex.quantize(map, cells=100, progress=lambda stage, share: 1 / 0)


def volume_of_tets(points, tets):
    corners = np.asarray(points)[tets]
    return np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1])).sum() / 6


def test_map_from_tets():
    needs_quantization()
    tets = hexhex.generate("cylinder")
    for method in ("frames", "polycube"):
        map, report = hexhex.map_from_tets(tets.points, tets.tets, method=method)
        assert report.method == method and 0 < report.worst <= report.median <= 1
        assert np.allclose(report.rotation @ report.rotation.T, np.eye(3))
        assert np.array_equal(map.points[:len(tets.points)], tets.points)
        assert len(map.tets) == len(tets.tets) + report.added_tets
        assert 0 < len(map.features.edges) == report.tagged_edges <= report.feature_edges
        assert hexhex.examine_seamless(map).kind == "seamless"
        if method == "polycube":  # as many faces and corners as a box, at least
            assert report.charts >= 6 and report.corners >= 8 and report.deviation > 0
    again = hexhex.map_from_tets(tets.points, tets.tets, method=method, threads=1)[0]
    assert np.array_equal(map.igm, again.igm)


@pytest.mark.parametrize("kind", ["sphere", "torus"])
def test_mesh_of_tets(kind, tmp_path):
    needs_quantization()
    tets = hexhex.generate(kind)
    told = set()
    part = hexhex.mesh(tets.points, tets.tets, cells=500, method="polycube", pillow="never",
                       snap_curves=False, progress=lambda stage, share: told.add(stage))
    assert {"labelling", "motorcycle complex", "quality"} <= told and len(part.stages) > 10
    assert part.shape.method == "polycube" and part.verification
    assert part.quantization.cells_wanted == 500
    assert len(part.mesh.cells) == part.quantization.cells + part.improvement.added_cells
    assert part.all_positive and hexhex.quality(part.mesh).all_positive
    assert hexhex.quality(part.mesh).minimum == part.improvement.after.minimum > 0
    # The mesh fills the solid: the volume behind its boundary.
    p = part.mesh.points[part.mesh.boundary_quads()]
    volume = sum(np.einsum("ij,ij->i", p[:, 0], np.cross(p[:, i], p[:, i + 1])).sum()
                 for i in (1, 2)) / 6
    assert volume == pytest.approx(volume_of_tets(tets.points, tets.tets), rel=0.03)
    # Its cells are those of its map, which the improvement has not changed.
    assert np.array_equal(hexhex.extract(part.map).cells, part.mesh.cells)
    # The same of a file that holds tets alone.
    meshio = pytest.importorskip("meshio")
    file = tmp_path / "tets.vtu"
    meshio.Mesh(tets.points, [("tetra", tets.tets)]).write(file)
    same = hexhex.mesh(file, cells=500, method="polycube", pillow="never", snap_curves=False)
    assert np.array_equal(same.mesh.points, part.mesh.points)
    assert "500" not in repr(part) and f"{len(part.mesh.cells)} cells" in repr(part)


def test_tags_of_a_file_are_those_of_its_mesh(tmp_path):
    needs_quantization()
    tets = hexhex.generate("box")  # of side 2, around the origin or not
    low = tets.points[:, 0].min()
    faces = np.sort(tets.tets[:, [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]]].reshape(-1, 3), axis=1)
    left = [f for f in faces if np.all(tets.points[f, 0] == low)]
    groups = [(2, 7, left), (4, 5, tets.tets)]
    lines = [f"{kind} 2 {tag} 1 {' '.join(str(v + 1) for v in element)}"
             for kind, tag, elements in groups for element in elements]
    file = tmp_path / "tagged.msh"
    file.write_text("\n".join(
        ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "2", '2 7 "inlet"', '3 5 "steel"',
         "$EndPhysicalNames", "$Nodes", str(len(tets.points))]
        + [f"{i} {' '.join(repr(float(x)) for x in p)}" for i, p in enumerate(tets.points, 1)]
        + ["$EndNodes", "$Elements", str(len(lines))]
        + [f"{i} {line}" for i, line in enumerate(lines, 1)] + ["$EndElements", ""]))
    part = hexhex.mesh(file, cells=200, method="polycube")
    quads = part.mesh.features.faces
    assert len(quads) > 0 and set(quads[:, 4]) == {7} and set(part.mesh.regions) == {5}
    assert np.allclose(part.mesh.points[quads[:, :4], 0], low)
    assert part.filled is None and part.missing_curves == 0 and part.shape.inner_faces == 0
    hexhex.write(part.mesh, tmp_path / "mesh.msh", format="gmsh22")
    written = (tmp_path / "mesh.msh").read_text()
    assert '2 7 "inlet"' in written and '3 5 "steel"' in written


def test_mesh_of_a_surface(tmp_path, monkeypatch):
    needs_quantization()
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    file = tmp_path / "cube.off"
    file.write_text("\n".join(["OFF", "8 12 0"] + [" ".join(map(str, p)) for p in corners]
                              + [f"3 {a} {b} {c}" for a, b, c in triangles]) + "\n")
    with pytest.raises(hexhex.ArgumentError, match='no mesher "yes"'):
        hexhex.mesh(file, cells=50, mesher="yes")
    monkeypatch.setenv("HEXHEX_PYTHON", str(tmp_path / "none"))
    with pytest.raises(hexhex.FileError, match="netgen-mesher is not installed"):
        hexhex.mesh(file, cells=50, mesher="netgen")
    pytest.importorskip("netgen")
    monkeypatch.setenv("HEXHEX_PYTHON", sys.executable)
    part = hexhex.mesh(file, cells=50, mesher="netgen")
    assert part.all_positive and part.filled.mesher.startswith("netgen-mesher")
    assert part.filled.volume == pytest.approx(1) and part.filled.triangles == 12


def test_bodies_that_touch_are_warned_of(tmp_path):
    needs_quantization()
    corners = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    tets = [(1, 2, 4, 8), (1, 3, 4, 8), (1, 5, 6, 8), (1, 2, 6, 8), (1, 3, 7, 8), (1, 5, 7, 8)]
    lines = ["MeshVersionFormatted 2", "Dimension 3", "Vertices", "16"]
    lines += [f"{x + dx} {y} {z} 0" for dx in (0, 1) for x, y, z in corners]
    lines += ["Tetrahedra", "12"]
    lines += [" ".join(str(v + more) for v in tet) + " 0" for more in (0, 8) for tet in tets]
    file = tmp_path / "two.mesh"
    file.write_text("\n".join(lines + ["End"]) + "\n")
    with pytest.warns(UserWarning, match="2 components, of which some touch"):
        part = hexhex.mesh(file, cells=16, method="polycube")
    assert part.all_positive


def test_mesh_by_edge_length_and_with_a_layer():
    needs_quantization()
    tets = hexhex.generate("box")  # of side 2
    part = hexhex.mesh(tets.points, tets.tets, edge_length=0.5, pillow="always")
    side = np.ptp(np.asarray(tets.points)[:, 0])
    assert part.quantization.cells == round(side / 0.5) ** 3
    assert part.improvement.added_cells == 6 * round(side / 0.5) ** 2 and part.all_positive


def test_mesh_of_tets_refuses(tmp_path):
    needs_quantization()
    corner = (np.eye(4, 3, -1), [[0, 1, 2, 3]])
    for given, options in (
            (corner, {}), (corner, {"cells": 0}), (corner, {"cells": 9, "edge_length": 1}),
            (corner, {"cells": 9, "method": "magic"}), (corner, {"cells": 9, "seed": -1}),
            (corner, {"cells": 9, "pillow": "yes"}), (corner, {"cells": 9, "feature_angle": 200}),
            (corner, {"cells": 9, "threads": 0}), (corner[:1], {"cells": 9}),
            ((tmp_path, corner[1]), {"cells": 9}), ((corner[0], [[0, 1, 2, 4]]), {"cells": 9})):
        with pytest.raises((hexhex.ArgumentError, hexhex.MapError)) as caught:
            hexhex.mesh(*given, **options)
        assert caught.value.code in ("InvalidArgument", "IndexOutOfRange")
    with pytest.raises(hexhex.FileError):
        hexhex.mesh(tmp_path / "none.vtu", cells=9)
    # A tet with a long spike on each face.
    star = ([*corner[0], (1, 1, -2), (1, -2, 1), (1, 1, 1), (-2, 1, 1)],
            [(0, 1, 2, 3), (0, 2, 1, 4), (0, 1, 3, 5), (1, 2, 3, 6), (0, 3, 2, 7)])
    with pytest.raises(hexhex.MapError) as caught:
        hexhex.map_from_tets(*star, method="frames")
    assert caught.value.code == "NotMeshable" and caught.value.place
    part = hexhex.mesh(*star, cells=9)
    assert part.all_positive and part.why
    ways = {way.method: way for way in part.ways}
    assert ways["frames"].refusal and not ways["frames"].has_mesh
    assert ways["polycube"].certified and not ways["polycube"].refusal
    assert ways["polycube"].minimum == part.improvement.after.minimum
    with pytest.raises(ZeroDivisionError):
        hexhex.mesh(*corner, cells=9, progress=lambda stage, share: 1 / 0)


def test_interrupts_after_quantization():
    """Solvers may handle signals while they work: Ctrl-C stays ours."""
    needs_quantization()
    code = """
import os, signal, hexhex
signal.signal(signal.SIGINT, signal.default_int_handler)  # ignored in jobs of a shell's background
map = hexhex.generate("sphere")
hexhex.quantize(hexhex.Map(map.points, map.tets, map.igm * 2**0.5), cells=500)
try:
    os.kill(os.getpid(), signal.SIGINT)
    for _ in range(1000): pass
except KeyboardInterrupt:
    raise SystemExit(0)
raise SystemExit("Ctrl-C does nothing any more")
"""
    subprocess.run([sys.executable, "-c", code], check=True, timeout=120)


def test_pieces(sphere, tmp_path):
    class Sink:
        def __init__(self):
            self.parts, self.ended = [], False

        def begin(self, points, cells):
            self.expected = points, cells

        def points(self, first, points, tets, corners):
            assert len(points) == len(tets) == len(corners)

        def cells(self, first, cells):
            self.parts.append(cells)

        def end(self):
            self.ended = True

    mesh = hexhex.extract(sphere, scale=2)
    for extract in (lambda sink: hexhex.extract_to(sink, sphere, scale=2),
                    lambda sink: hexhex.Extractor(sphere).extract_to(sink, scale=2)):
        sink = Sink()
        extract(sink)
        assert sink.ended and sink.expected == (3817, 3584)
        assert np.array_equal(np.concatenate(sink.parts), mesh.cells)

    class Broken(Sink):
        def cells(self, first, cells):
            raise LookupError("full")

    with pytest.raises(LookupError, match="full"):
        hexhex.extract_to(Broken(), sphere)
    with pytest.raises(AttributeError):
        hexhex.extract_to(object(), sphere)
    hexhex.extract_to_file(tmp_path / "m.vtu", sphere, scale=2)
    assert hexhex.summarize(tmp_path / "m.vtu") == hexhex.summarize(mesh)
    writer = hexhex.MeshWriter(tmp_path / "w.vtu")
    with pytest.raises(hexhex.HexhexError):
        writer.end()
    del writer
    assert not (tmp_path / "w.vtu").exists()


def test_odd_arguments(sphere):
    """Layouts that have to be converted give the same; what is no map is an error."""
    expected = hexhex.extract(sphere)
    wide = np.zeros((2 * len(sphere.points), 6))
    wide[::2, ::2] = sphere.points
    strided = hexhex.extract(wide[::2, ::2], np.asfortranarray(sphere.tets)[:, :],
                             sphere.igm[::-1][::-1])
    assert np.array_equal(strided.points, expected.points)
    big = hexhex.extract(sphere.points.astype(">f8"), sphere.tets.astype(">i8"), sphere.igm)
    assert np.array_equal(big.cells, expected.cells)
    none = np.empty((0, 3)), np.empty((0, 4), np.uint32), np.empty((0, 4, 3))
    nan = np.array(sphere.points)
    nan[3, 1] = np.nan
    infinite = np.array(sphere.igm)
    infinite[0, 0, 0] = np.inf
    negative = np.array(sphere.tets, dtype=np.int64)
    negative[3, 1] = -1
    bad = [none, (nan, sphere.tets, sphere.igm), (sphere.points, sphere.tets, infinite),
           (sphere.points, negative, sphere.igm), (sphere.points, sphere.tets, sphere.igm[1:]),
           (sphere.points, sphere.tets[:, :3], sphere.igm), (sphere.points[:-1], *none[1:]),
           (sphere.points, sphere.tets.astype(float), sphere.igm), (None, None, None),
           (sphere.points[:, 0], sphere.tets, sphere.igm)]
    for arrays in bad:
        with pytest.raises((hexhex.ArgumentError, hexhex.MapError)):
            hexhex.extract(*arrays)
    reassigned = hexhex.Map(sphere.points, sphere.tets, sphere.igm)
    reassigned.igm = sphere.igm[1:]
    with pytest.raises(hexhex.HexhexError):
        hexhex.extract(reassigned)


def test_reentry(sphere):
    """Progress functions may use the library; an extractor serves one call at a time."""
    inner = []

    def extract_again(stage, share):
        if not inner:
            inner.append(hexhex.extract(sphere, progress=lambda stage, share: None))

    outer = hexhex.extract(sphere, progress=extract_again)
    assert np.array_equal(inner[0].cells, outer.cells)
    extractor = hexhex.Extractor(sphere)
    with pytest.raises(hexhex.ArgumentError, match="in use"):
        extractor.extract(progress=lambda stage, share: extractor.extract())
    assert len(extractor.extract().cells) == 448


# Large arrays, as smaller ones fit into what malloc has set aside for threads.
MEMORY = """
import resource, sys, hexhex
map = hexhex.generate("sphere", cells=4, refine=4)
pages = int(open("/proc/self/statm").read().split()[0])
for extra in (2, 60, 200):
    space = pages * resource.getpagesize() + extra * 2**20
    resource.setrlimit(resource.RLIMIT_AS, (space, resource.RLIM_INFINITY))
    try:
        print(len(hexhex.extract(map, scale=20, threads=int(sys.argv[1])).cells))
    except MemoryError as error:
        print("MemoryError", getattr(error, "code", ""))
resource.setrlimit(resource.RLIMIT_AS, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
print(len(hexhex.extract(map, scale=20).cells))
"""


@pytest.mark.parametrize("threads", [1, 8])
def test_memory(threads):
    result = subprocess.run([sys.executable, "-c", MEMORY, str(threads)], capture_output=True,
                            text=True, timeout=120, check=False)
    lines = result.stdout.split("\n")
    assert result.returncode == 0 and lines[3] == "3584000", result.stdout + result.stderr
    assert "MemoryError" in lines[0]


def test_answers():
    """What is known of a generated map is what its mesh has."""
    assert len(hexhex.sample_kinds()) == 8 and all(k.description for k in hexhex.sample_kinds())
    for kind in hexhex.sample_kinds():
        map = hexhex.generate(kind.name, cells=2, features=True)
        mesh, answer = hexhex.extract(map), map.answer
        assert (len(mesh.cells), len(mesh.points)) == (answer["cells"], answer["vertices"])
        counts = mesh.structure()
        for name in ("boundary_quads", "euler_characteristic", "components",
                     "boundary_components"):
            assert counts[name] == answer[name]
        _, valence, boundary = mesh.singular_edges()
        assert dict(zip(*np.unique(valence[~boundary], return_counts=True))) == \
            answer["inner_singular_edges"]
        for rows, name in ((mesh.features.vertices, "tagged_vertices"),
                           (mesh.features.edges, "tagged_edges"),
                           (mesh.features.faces, "tagged_quads")):
            assert dict(zip(*np.unique(rows[:, -1], return_counts=True))) == answer[name]
        assert len(set(mesh.regions.tolist())) == answer["regions"]
    for kind in hexhex.defect_kinds():
        assert hexhex.generate("box", refine=4, defects=1, defect_kind=kind).answer["cells"] == 512
    assert hexhex.Map(map.points, map.tets, map.igm).answer is None


def test_map_structure(sphere):
    structure = hexhex.map_structure(sphere)
    counts = hexhex.check(sphere).counts
    assert len(structure.jump_tets) == counts["chart_jumps"] and structure.defects == []
    assert dict(zip(*np.unique(structure.valences, return_counts=True))) == \
        counts["inner_singular_tet_edges"]
    assert not structure.boundary.any() and (structure.edges[:, 0] < structure.edges[:, 1]).all()
    # Transitions carry the parameters of a face's corners over.
    u = [sphere.igm[tets][sphere.tets[tets] == structure.jump_vertices[:, :1]]
         for tets in structure.jump_tets.T]
    image = np.einsum("jrc,jc->jr", structure.rotations, u[0]) + structure.translations
    assert np.abs(image - u[1]).max() < 1e-9
    assert (structure.translations == np.rint(structure.translations)).all()
    bad = hexhex.generate("sphere", cells=8, refine=4, defects=2)
    assert hexhex.map_structure(bad).defects[0].code == "FlippedTet"
    with pytest.raises(hexhex.ArgumentError):
        hexhex.map_structure(sphere, tolerance=7)


def test_curved_files(tmp_path):
    box = hexhex.generate("box", features=True)
    curved = hexhex.extract(box, order=3).curved
    hexhex.write(curved, tmp_path / "c.vtu",
                 scaled_jacobians=hexhex.quality(curved).scaled_jacobians)
    assert hexhex.holds_curved(tmp_path / "c.vtu")
    read = hexhex.read_curved(tmp_path / "c.vtu")
    for name in ("points", "nodes", "generator_tet", "generator_corners"):
        assert np.array_equal(getattr(read, name), getattr(curved, name))
    assert (read.order, read.vertex_count) == (3, curved.vertex_count)
    hexhex.write(box, tmp_path / "box.vtu")
    assert not hexhex.holds_curved(tmp_path / "box.vtu")
    for name in ("box.vtu", "none.vtu", "c.msh"):
        with pytest.raises(hexhex.FileError):
            hexhex.read_curved(tmp_path / name)
    with pytest.raises(hexhex.ArgumentError):
        hexhex.write(curved, tmp_path / "c.vtu", scaled_jacobians=[1.0])

    assert len(curved.regions) == 512 and len(curved.features.faces) == 6 * 64
    copy = hexhex.LagrangeMesh(3, curved.points, curved.nodes, curved.vertex_count,
                               generator_tet=curved.generator_tet,
                               generator_corners=curved.generator_corners,
                               features=curved.features, regions=curved.regions)
    straight, expected = copy.straight(), hexhex.extract(box)
    assert np.array_equal(straight.cells, expected.cells)
    assert np.array_equal(straight.generator_corners, expected.generator_corners)
    assert np.array_equal(straight.features.faces, expected.features.faces)
    assert np.array_equal(copy.regions, curved.regions)
    nodes = np.array(curved.nodes)
    nodes[5, 5] = 10**6
    wrong = hexhex.LagrangeMesh(3, curved.points, nodes, curved.vertex_count)
    for use in (hexhex.quality, hexhex.LagrangeMesh.straight,
                lambda mesh: hexhex.write(mesh, tmp_path / "w.vtu")):
        with pytest.raises(hexhex.ArgumentError):
            use(wrong)
    assert not (tmp_path / "w.vtu").exists()
    for arguments in ((2, curved.points, curved.nodes, 8), (10, curved.points, curved.nodes, 8),
                      (3, curved.points, curved.nodes, -1)):
        with pytest.raises(hexhex.ArgumentError):
            hexhex.LagrangeMesh(*arguments)
    with pytest.raises(hexhex.ArgumentError):
        hexhex.Mesh(expected.points, expected.cells, generator_tet=[1, 2])
    mesh = hexhex.Mesh(expected.points, expected.cells, generator_tet=expected.generator_tet,
                       generator_corners=expected.generator_corners)
    assert np.array_equal(mesh.generator_kind, expected.generator_kind)


def test_small_things(sphere, tmp_path):
    mesh = hexhex.extract(sphere)
    quality = hexhex.quality(mesh)
    assert sum(quality.histogram) == 448 and quality.minimum == quality.scaled_jacobians.min()
    assert abs(quality.mean - quality.scaled_jacobians.mean()) < 1e-12
    assert quality.all_positive and quality.positive == 448 and quality.worst == []
    assert quality.validity.dtype == np.uint8 and not quality.validity.any()
    assert 0 < quality.minimum_everywhere <= quality.minimum
    mirrored = hexhex.quality(hexhex.Mesh(-mesh.points, mesh.cells))
    assert not mirrored.all_positive and (mirrored.validity == 1).all()
    assert len(mirrored.worst) == 10 and mirrored.worst[0].scaled_jacobian < mirrored.minimum + 1e-12 < 0
    one = hexhex.scaled_jacobian(mesh.points[mesh.cells[7]])
    assert one == quality.scaled_jacobians[7]
    for corners in (mesh.points[:7], mesh.points[:8, :2], 3):
        with pytest.raises(hexhex.ArgumentError):
            hexhex.scaled_jacobian(corners)
    empty = hexhex.quality(hexhex.Mesh(np.empty((0, 3)), np.empty((0, 8), np.uint32)))
    assert (empty.minimum, empty.not_positive, sum(empty.histogram)) == (0, 0, 0)
    stages = mesh.statistics["stages"]
    assert len(stages) > 5 and stages[0][0] == "input" and all(s >= 0 for _, s in stages)

    hexhex.write(mesh, tmp_path / "mesh.data", format="vtu")
    assert hexhex.summarize(tmp_path / "mesh.data", format="vtu") == hexhex.summarize(mesh)
    sink = hexhex.SummarySink()
    with pytest.raises(hexhex.ArgumentError):
        sink.result()
    hexhex.read_to(sink, tmp_path / "mesh.data", format="vtu")
    assert sink.result() == hexhex.summarize(mesh)
    with pytest.raises(hexhex.ArgumentError):
        sink.end()
    with pytest.raises(AttributeError):
        hexhex.read_to(object(), tmp_path / "mesh.data", format="vtu")
    for what, file, options in (("map", "x.hexex", {}), ("mesh", "x.data", {"format": "vtu"}),
                                ("curved", "x.msh", {}), ("arcs", "x.vtp", {}),
                                ("patches", "x.ovmb", {})):
        hexhex.require_format(what, file, **options)
        with pytest.raises(hexhex.FileError):
            hexhex.require_format(what, "x.stl")
    with pytest.raises(hexhex.ArgumentError, match="banana"):
        hexhex.require_format("banana", "x.vtu")


def test_repair_of_pieces(tmp_path):
    if not hexhex.can_repair():
        pytest.skip("without Eigen")
    bad = hexhex.generate("sphere", cells=8, refine=4, defects=2)
    notes = hexhex.extract_to_file(tmp_path / "m.vtu", bad, repair=True)
    assert notes.repair.bad_tets >= 2
    assert hexhex.verify(notes.repaired_map, hexhex.read(tmp_path / "m.vtu"))
    notes = hexhex.extract_to(hexhex.SummarySink(), bad, repair=True)
    assert notes.repair.changed and notes.repaired_map is not None
    notes = hexhex.extract_to(hexhex.SummarySink(), hexhex.generate("sphere"), repair=True)
    assert notes.repair is None and notes.repaired_map is None
    mesh = hexhex.extract(bad, order=2, repair=True)
    assert mesh.repair.changed and hexhex.verify(mesh.repaired_map, mesh)
    # A repair that fails says what it has done.
    igm = np.array(bad.igm)
    igm[:200] = igm[:200, ::-1]
    with pytest.raises(hexhex.MapError) as caught:
        hexhex.repair(hexhex.Map(bad.points, bad.tets, igm))
    assert isinstance(caught.value.repair, hexhex.RepairReport)
    with pytest.raises(hexhex.MapError) as caught:
        hexhex.extract(bad)
    assert caught.value.repair is None


def test_vtk_alone(sphere):
    """to_vtk() takes vtk and no pyvista; curved cells are in VTK's order of nodes."""
    pytest.importorskip("vtkmodules")
    code = """
import sys
sys.modules["pyvista"] = None
import hexhex
mesh = hexhex.extract(hexhex.generate("sphere"), order=3)
grid, curved = mesh.to_vtk(), mesh.curved.to_vtk()
from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter
for g in (grid, curved):
    sizes = vtkCellSizeFilter()
    sizes.SetInputData(g)
    sizes.Update()
    volumes = sizes.GetOutput().GetCellData().GetArray("Volume")
    values = [volumes.GetValue(i) for i in range(448)]
    assert min(values) > 0 and 3 < sum(values) < 4.2, (min(values), sum(values))
"""
    subprocess.run([sys.executable, "-c", code], check=True, timeout=120)


def test_pyvista(sphere):
    pytest.importorskip("pyvista")
    mesh = hexhex.extract(sphere)
    grid = mesh.to_pyvista()
    assert grid.n_cells == 448 and grid.GetNumberOfPoints() == len(mesh.points)
    assert np.array_equal(grid.point_data["generator_kind"], mesh.generator_kind)
    assert 3 < grid.volume < 4.2  # VTK agrees about the order of corners
