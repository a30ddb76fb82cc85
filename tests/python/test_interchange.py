"""Copies in other processes, pictures, files of numpy, and other packages: VTK, PyVista, meshio, tqdm."""

import base64
import concurrent.futures
import copy
import ctypes.util
import errno
import gc
import io
import multiprocessing
import pickle
import struct
import subprocess
import sys
import zlib

import numpy as np
import pytest

import hexhex


@pytest.fixture(scope="module")
def tagged():
    return hexhex.generate("handle-body", charts="random", features=True, jitter=0.05)


@pytest.fixture(scope="module")
def mesh(tagged):
    return hexhex.extract(tagged, scale=2)


def same_maps(a, b):
    names = ("points", "tets", "igm", "regions", "edge_valences", "rotations")
    return (all(np.array_equal(getattr(a, name), getattr(b, name)) for name in names)
            and same_features(a, b))


def same_features(a, b):
    return a.features.names == b.features.names and all(np.array_equal(getattr(a.features, name), getattr(b.features, name))
               for name in ("vertices", "edges", "faces"))


def same_meshes(a, b):
    names = ("generator_tet", "generator_corners", "regions")
    return (hexhex.summarize(a) == hexhex.summarize(b) and same_features(a, b)
            and all(np.array_equal(getattr(a, name), getattr(b, name)) for name in names))


def in_two_ways(value):
    return pickle.loads(pickle.dumps(value)), copy.deepcopy(value)


def test_pickle(tagged, mesh):
    for other in in_two_ways(tagged):
        assert same_maps(other, tagged) and other.answer == tagged.answer
    for other in in_two_ways(mesh):
        assert same_meshes(other, mesh) and other.statistics == mesh.statistics
        other.points[0] += 1
        assert not np.array_equal(other.points, mesh.points)
    whole = hexhex.extract(tagged, order=2, patches=True)
    for other in in_two_ways(whole):
        assert same_meshes(other, whole) and np.array_equal(other.curved.nodes, whole.curved.nodes)
        for name in ("ends", "points", "segment_tet"):
            assert np.array_equal(getattr(other.arcs, name), getattr(whole.arcs, name))
        for name in ("vertices", "corners", "parameters", "polygon_begin"):
            assert np.array_equal(getattr(other.patches, name), getattr(whole.patches, name))


def test_copies_can_be_written(tagged, tmp_path):
    whole = hexhex.extract(tagged, order=2, patches=True)
    for name, part in (("a.vtu", whole.arcs), ("p.vtu", whole.patches), ("c.vtu", whole.curved),
                       ("m.vtu", whole)):
        hexhex.write(part, tmp_path / name)
        hexhex.write(copy.deepcopy(part), tmp_path / f"copy-{name}")
        assert (tmp_path / name).read_bytes() == (tmp_path / f"copy-{name}").read_bytes()


def test_reports_pickle(tagged, mesh):
    broken = hexhex.generate("sphere", cells=8, refine=4, defects=2)
    for value in (hexhex.check(tagged), hexhex.check(broken), hexhex.verify(tagged, mesh, scale=2),
                  hexhex.summarize(mesh), hexhex.formats()):
        assert all(other == value for other in in_two_ways(value))
    for value in (hexhex.quality(mesh), hexhex.map_structure(tagged), hexhex.extract_partial(broken)):
        assert all(repr(other) == repr(value) for other in in_two_ways(value))


def extract_at(map, scale):
    return hexhex.extract(map, scale=scale, threads=1)


def test_processes(tagged):
    context = multiprocessing.get_context("spawn")
    with concurrent.futures.ProcessPoolExecutor(2, mp_context=context) as pool:
        meshes = list(pool.map(extract_at, [tagged] * 2, [1, 2]))
        wrong = pool.submit(hexhex.read, "nowhere.vtu")
        assert isinstance(wrong.exception(), FileNotFoundError)
        assert wrong.exception().errno == errno.ENOENT
        defective = pool.submit(extract_at, hexhex.generate("sphere", cells=8, refine=4, defects=1), 1)
        assert isinstance(defective.exception(), hexhex.MapError)
        assert defective.exception().place.startswith("tet ")
    assert [len(m.cells) for m in meshes] == [832, 8 * 832]
    assert same_meshes(meshes[1], hexhex.extract(tagged, scale=2))


def test_representations_are_short(tagged, mesh):
    whole = hexhex.extract(tagged, patches=True)
    broken = hexhex.generate("sphere", cells=8, refine=4, defects=2)
    values = [tagged, mesh, hexhex.check(tagged), hexhex.check(broken), hexhex.quality(mesh),
              hexhex.verify(tagged, mesh), hexhex.map_structure(tagged), whole.arcs, whole.patches,
              hexhex.extract_partial(broken)]
    for value in values:
        assert repr(value).startswith(f"<hexhex.{type(value).__name__}: ") and len(repr(value)) < 160


def pixels(html):
    """Of the picture in a page: (height, width, 3)."""
    data = base64.b64decode(html.split("base64,")[1].split('"')[0])
    at, packed = 8, b""
    assert data.startswith(b"\x89PNG\r\n\x1a\n")
    while at < len(data):
        (length,), kind = struct.unpack(">I", data[at:at + 4]), data[at + 4:at + 8]
        content = data[at + 8:at + 8 + length]
        assert struct.unpack(">I", data[at + 8 + length:at + 12 + length])[0] == zlib.crc32(kind + content)
        if kind == b"IHDR":
            width, height = struct.unpack(">II", content[:8])
        if kind == b"IDAT":
            packed += content
        at += 12 + length
    rows = np.frombuffer(zlib.decompress(packed), dtype=np.uint8).reshape(height, 1 + 3 * width)
    return rows[:, 1:].reshape(height, width, 3)


def test_pictures(tagged, mesh):
    for value in (tagged, mesh, hexhex.extract(tagged, order=2).curved):
        page = value._repr_html_()
        assert repr(value).replace("<", "&lt;").replace(">", "&gt;") in page and len(page) < 200_000
        drawn = (pixels(page) < 255).any(axis=2)
        assert 0.1 < drawn.mean() < 0.9 and not drawn[0].any()
    # A box fills its outline: what is nearer hides what is behind.
    box = hexhex.extract(hexhex.generate("box"))
    drawn = (pixels(box._repr_html_()) < 255).any(axis=2)
    for row in drawn:
        columns = np.flatnonzero(row)
        assert len(columns) == 0 or len(columns) == columns[-1] - columns[0] + 1
    flat = hexhex.Mesh(np.zeros((8, 3)), [list(range(8))])
    assert "Mesh: 1 cells" in flat._repr_html_()
    wrong = hexhex.Mesh(np.zeros((8, 3)), [list(range(1, 9))])
    assert wrong._repr_html_() == "<code>&lt;hexhex.Mesh: 1 cells, 8 points&gt;</code>"
    assert "img" not in hexhex.Map(np.zeros((2, 3)), [[0, 1, 2, 3]], np.zeros((1, 12)))._repr_html_()
    assert "img" not in hexhex.Mesh(np.empty((0, 3)), np.empty((0, 8), dtype=np.uint32))._repr_html_()


@pytest.mark.parametrize("scale", [2.0, np.float32(2), np.int8(2)])
def test_whole_numbers(tagged, mesh, scale):
    assert hexhex.summarize(hexhex.extract(tagged, scale=scale)) == hexhex.summarize(mesh)
    assert hexhex.verify(tagged, mesh, scale=scale)


@pytest.mark.parametrize("scale", [2.5, "2", None, 10**12, float("nan"), float("inf")])
def test_no_whole_numbers(tagged, scale):
    with pytest.raises(hexhex.ArgumentError, match="The scale is .*(whole number|too large)"):
        hexhex.extract(tagged, scale=scale)


def test_kinds_are_listed():
    for options in (dict(kind="spehre"), dict(kind="box", charts="blokcs"),
                    dict(kind="box", defect_kind="")):
        with pytest.raises(hexhex.ArgumentError, match="Choose one of .*, "):
            hexhex.generate(**options)


def test_missing_files(tmp_path, mesh):
    folder = tmp_path / "folder.vtu"
    folder.mkdir()
    for call, kind, number in (
            (lambda: hexhex.read(tmp_path / "none.vtu"), FileNotFoundError, errno.ENOENT),
            (lambda: hexhex.read_map(tmp_path / "none.npz"), FileNotFoundError, errno.ENOENT),
            (lambda: hexhex.read_mesh(folder), IsADirectoryError, errno.EISDIR),
            (lambda: hexhex.write(mesh, tmp_path / "a" / "b.vtu"), FileNotFoundError, errno.ENOENT),
            (lambda: hexhex.write(mesh, tmp_path / "a" / "b.npz"), FileNotFoundError, errno.ENOENT)):
        with pytest.raises(kind) as caught:
            call()
        assert isinstance(caught.value, hexhex.FileError) and caught.value.errno == number
        assert str(caught.value).startswith(str(tmp_path)) and str(caught.value).endswith(".")
    (tmp_path / "empty.vtu").touch()
    with pytest.raises(hexhex.FileError) as caught:
        hexhex.read(tmp_path / "empty.vtu")
    assert caught.value.errno is None and not isinstance(caught.value, FileNotFoundError)


def test_npz(tagged, mesh, tmp_path):
    for value, same in ((tagged, same_maps), (mesh, same_meshes)):
        for compress in (False, True):
            file = tmp_path / f"{type(value).__name__}{compress}.npz"
            hexhex.write(value, file, compress=compress)
            assert same(hexhex.read(file), value)
            first = file.read_bytes()
            hexhex.write(value, file, compress=compress)
            assert first == file.read_bytes()
    assert np.array_equal(np.load(tmp_path / "MapFalse.npz")["igm"], tagged.igm)
    for how, compressor in (("zlib", b"vtkZLib"), (True, b"vtkZLib"), ("lz4", b"vtkLZ4")):
        if how == "lz4" and not ctypes.util.find_library("lz4"):
            continue
        hexhex.write(mesh, tmp_path / "a.vtu", compress=how)
        assert compressor in (tmp_path / "a.vtu").read_bytes()[:200]
        assert same_meshes(hexhex.read(tmp_path / "a.vtu"), mesh)
    with pytest.raises(hexhex.ArgumentError, match="zlib alone"):
        hexhex.write(mesh, tmp_path / "a.npz", compress="lz4")
    bare = hexhex.Map(tagged.points, tagged.tets, tagged.igm)
    hexhex.write(bare, tmp_path / "bare.any", format="npz")
    assert same_maps(hexhex.read(tmp_path / "bare.any", format="npz"), bare)
    with pytest.raises(hexhex.FileError, match="a Map in it, and no Mesh"):
        hexhex.read_mesh(tmp_path / "MapTrue.npz")
    assert not [file for file in tmp_path.iterdir() if "tmp" in file.name]
    with pytest.raises(hexhex.ArgumentError):
        hexhex.write(hexhex.extract(tagged, order=2).curved, tmp_path / "curved.npz")


def test_broken_npz(mesh, tmp_path):
    whole = io.BytesIO()
    np.savez(whole, points=mesh.points, cells=mesh.cells)
    good, file = whole.getvalue(), tmp_path / "a.npz"
    array, single = io.BytesIO(), io.BytesIO()
    np.savez(array, points=mesh.points, cells=np.array([{}], dtype=object))
    np.save(single, mesh.points)
    others = [dict(points=mesh.points), dict(points=mesh.points, cells=mesh.cells[:, :7]),
              dict(points=mesh.points, cells=mesh.cells.astype(float)), {}]
    bad = [b"", b"PK", good[:1000], good[:-40], array.getvalue(), single.getvalue(), b"x" * 5000]
    for arrays in others:
        made = io.BytesIO()
        np.savez(made, **arrays)
        bad.append(made.getvalue())
    random = np.random.default_rng(1)
    for _ in range(100):
        changed = bytearray(good[:2000] + good[-2000:])
        for at in random.integers(0, len(changed), 3):
            changed[at] = random.integers(256)
        bad.append(bytes(changed))
    for content in bad:
        file.write_bytes(content)
        with pytest.raises(hexhex.FileError, match="a.npz: "):
            hexhex.read(file)
    file.write_bytes(b"no archive")  # numpy's own sentence advises to unpickle it
    with pytest.raises(hexhex.FileError, match="zip"):
        hexhex.read(file)


def test_tqdm(tagged):
    pytest.importorskip("tqdm")
    shown = io.StringIO()
    with hexhex.TqdmProgress(file=shown, mininterval=0, ncols=60) as progress:
        hexhex.extract(tagged, progress=progress)
    assert "100%" in shown.getvalue()


def test_meshio(tagged, mesh, tmp_path):
    meshio = pytest.importorskip("meshio")
    bare = hexhex.Map(tagged.points, tagged.tets, tagged.igm, regions=tagged.regions)
    assert same_maps(hexhex.Map.from_meshio(bare.to_meshio()), bare)
    for order in (2, 3):  # what meshio makes of the file
        curved = hexhex.extract(tagged, order=order).curved
        hexhex.write(curved, tmp_path / "c.vtu")
        (read,), (made,) = meshio.read(tmp_path / "c.vtu").cells, curved.to_meshio().cells
        assert read.type == made.type and np.array_equal(read.data, made.data)
    back = hexhex.Mesh.from_meshio(mesh.to_meshio())
    assert hexhex.summarize(back) == hexhex.summarize(mesh) and np.array_equal(back.regions, mesh.regions)
    assert np.array_equal(back.generator_corners, mesh.generator_corners)
    # By way of its files, and several blocks.
    tagged.to_meshio().write(tmp_path / "map.vtu")
    assert np.array_equal(hexhex.read_map(tmp_path / "map.vtu").igm, tagged.igm)
    cut = len(mesh.cells) // 3
    blocks = meshio.Mesh(mesh.points, [("hexahedron", mesh.cells[:cut].astype(int)),
                                       ("hexahedron", mesh.cells[cut:].astype(int))])
    assert hexhex.summarize(hexhex.Mesh.from_meshio(blocks)) == hexhex.summarize(mesh)
    # As meshio reads Gmsh's files.
    physical = meshio.Mesh(mesh.points, [("hexahedron", mesh.cells.astype(int))],
                           cell_data={"gmsh:physical": [np.full(len(mesh.cells), 5)]},
                           field_data={"steel": np.array([5, 3]), "inlet": np.array([5, 2])})
    assert hexhex.Mesh.from_meshio(physical).features.names == {(3, 5): "steel"}
    with pytest.raises(hexhex.ArgumentError, match="no tetrahedra"):
        hexhex.Map.from_meshio(blocks)


def test_pyvista_meshes(mesh):
    pyvista = pytest.importorskip("pyvista")
    from vtkmodules.util.numpy_support import vtk_to_numpy

    grid = mesh.to_pyvista()
    assert np.shares_memory(np.asarray(grid.points), mesh.points)
    assert np.shares_memory(vtk_to_numpy(grid.GetCells().GetConnectivityArray()), mesh.cells)
    assert np.shares_memory(np.asarray(grid.cell_data["region"]), mesh.regions)
    assert np.array_equal(grid.cell_data["scaled_jacobian"], hexhex.quality(mesh).scaled_jacobians)
    assert "scaled_jacobian" not in mesh.to_pyvista(quality=False).cell_data
    assert same_meshes(hexhex.Mesh.from_pyvista(grid), mesh)
    assert same_meshes(hexhex.Mesh.from_pyvista(mesh.to_vtk()), mesh)
    wrapped = pyvista.wrap(mesh)
    assert isinstance(wrapped, pyvista.UnstructuredGrid) and wrapped.n_cells == len(mesh.cells)
    # The grid keeps the memory alive when all else is gone.
    alone = hexhex.extract(hexhex.generate("box")).to_pyvista()
    expected, wasted = alone.volume, []
    for _ in range(20):
        gc.collect()
        wasted.append(np.full(30_000, -1.0))
    assert alone.volume == expected == pytest.approx(8)
    assert alone.clean().n_points == 729


def test_names_of_tags_in_pyvista(tagged, mesh, tmp_path):
    pyvista = pytest.importorskip("pyvista")
    f = mesh.features
    named = hexhex.Mesh(mesh.points, mesh.cells, regions=np.ones(len(mesh.cells), dtype=np.int32),
                        features=hexhex.Features(f.vertices, f.edges, f.faces, corners=4,
                                                 names={(1, int(f.edges[0, 2])): "seam", (3, 1): "steel"}))
    assert same_features(hexhex.Mesh.from_pyvista(named.to_pyvista()), named)
    for write in (lambda file: hexhex.write(named, file), named.to_pyvista().save):
        write(str(tmp_path / "named.vtu"))
        assert same_features(hexhex.Mesh.from_pyvista(pyvista.read(tmp_path / "named.vtu")), named)
        assert same_features(hexhex.read_mesh(tmp_path / "named.vtu"), named)


def test_pyvista_maps(tagged):
    pyvista = pytest.importorskip("pyvista")
    grid = tagged.to_pyvista()
    assert np.shares_memory(np.asarray(grid.points), tagged.points)
    assert same_maps(hexhex.Map.from_pyvista(grid), hexhex.Map(
        tagged.points, tagged.tets, tagged.igm, features=tagged.features, regions=tagged.regions))
    assert pyvista.wrap(tagged).n_cells == len(tagged.tets)
    # One chart, as an array of points under another name; other cells do not disturb.
    box = hexhex.generate("box")
    parameters = np.zeros_like(box.points)
    parameters[box.tets] = box.igm
    plain = pyvista.UnstructuredGrid({pyvista.CellType.TETRA: box.tets.astype(int),
                                      pyvista.CellType.TRIANGLE: box.tets[:5, :3].astype(int)}, box.points)
    plain.point_data["uvw"] = parameters
    assert np.array_equal(hexhex.Map.from_pyvista(plain, "uvw").igm, box.igm)
    with pytest.raises(hexhex.ArgumentError, match='no map in an array "igm".*uvw'):
        hexhex.Map.from_pyvista(plain)
    with pytest.raises(hexhex.ArgumentError, match="no tetrahedra"):
        hexhex.Map.from_pyvista(pyvista.Sphere())
    with pytest.raises(hexhex.ArgumentError):
        hexhex.Map.from_pyvista(np.zeros((3, 3)))


def test_accessor(tagged, mesh):
    pyvista = pytest.importorskip("pyvista")
    if not hasattr(pyvista, "register_dataset_accessor"):
        pytest.skip("this PyVista has no accessors")
    grid = tagged.to_pyvista()
    made = grid.hexhex.extract(scale=2)
    assert same_meshes(made.hexhex.mesh(), mesh)
    assert grid.hexhex.check().valid and grid.hexhex.verify(made, scale=2)
    assert np.array_equal(grid.hexhex.map().igm, tagged.igm)
    # Who has not imported hexhex gets it as well: by the package's entry point, where it is installed.
    code = """
import sys, pyvista
grid = pyvista.read(sys.argv[1])
assert "hexhex" not in sys.modules
print(grid.hexhex.extract().n_cells)
"""
    from importlib.metadata import entry_points
    if not [e for e in entry_points(group="pyvista.accessors") if e.name == "hexhex"]:
        pytest.skip("hexhex is not installed as a package")
    import pathlib
    import tempfile
    with tempfile.TemporaryDirectory() as folder:
        file = str(pathlib.Path(folder) / "map.vtu")
        hexhex.write(tagged, file)
        run = subprocess.run([sys.executable, "-c", code, file], check=True, timeout=120,
                             capture_output=True, text=True)
    assert run.stdout.strip() == "832"


def test_nothing_of_others_is_imported():
    code = """
import sys
import hexhex
hexhex.extract(hexhex.generate("box"))._repr_html_()
found = {"pyvista", "vtkmodules", "meshio", "tqdm"} & set(sys.modules)
assert not found, found
"""
    subprocess.run([sys.executable, "-c", code], check=True, timeout=120)
