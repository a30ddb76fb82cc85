"""The Python package: results, arrays without copies, threads, signals, errors, other libraries."""

import doctest
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
    result = doctest.testmod(hexhex, extraglobs={"hexhex": hexhex})
    assert result.attempted > 10 and result.failed == 0


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
import os, signal, threading, time, hexhex
signal.signal(signal.SIGINT, signal.default_int_handler)  # ignored in jobs in the background
map = hexhex.generate("sphere", cells=16, refine=4)
def interrupt(stage, share):
    if not sent:
        sent.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)
sent = []
try:
    hexhex.extract(map, scale=12, threads=1, progress=interrupt)
    print("not interrupted")
except KeyboardInterrupt:
    print("interrupted after", time.monotonic() - sent[0])
"""


def test_ctrl_c():
    result = subprocess.run([sys.executable, "-c", INTERRUPTED], capture_output=True, text=True,
                            timeout=120, check=True)
    assert result.stdout.startswith("interrupted after"), result.stdout + result.stderr
    assert float(result.stdout.split()[-1]) < 2


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


def test_pyvista(sphere):
    pytest.importorskip("pyvista")
    mesh = hexhex.extract(sphere)
    grid = mesh.to_pyvista()
    assert grid.n_cells == 448 and grid.GetNumberOfPoints() == len(mesh.points)
    assert np.array_equal(grid.point_data["generator_kind"], mesh.generator_kind)
    assert 3 < grid.volume < 4.2  # VTK agrees about the order of corners
