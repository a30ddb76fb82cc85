"""What meshes are made of, compared with what follows from their cells alone; and whether two are the same."""

import itertools
import re
import subprocess
import sys

import numpy as np
import pytest

import hexhex

KINDS = [kind.name for kind in hexhex.sample_kinds()]
PLACES = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])


@pytest.fixture(scope="module")
def meshes():
    return {kind: hexhex.extract(hexhex.generate(kind, cells=3)) for kind in KINDS}


class Sets:
    """Which of many things are the same."""

    def __init__(self):
        self.parent = {}

    def find(self, x):
        self.parent.setdefault(x, x)
        while self.parent[x] != x:
            x = self.parent[x]
        return x

    def unite(self, a, b):
        self.parent[self.find(a)] = self.find(b)

    def count(self):
        return len({self.find(x) for x in list(self.parent)})


def edges_of(cell):
    """Corners of the edges along each axis."""
    return [[(a, b) for a, b in itertools.combinations(range(8), 2)
             if abs(PLACES[a] - PLACES[b]).tolist() == np.eye(3, dtype=int)[axis].tolist()]
            for axis in range(3)]


def faces_of(axis):
    return [[c for c in range(8) if PLACES[c][axis] == side] for side in (0, 1)]


def named(cell, corners):
    return tuple(sorted(int(cell[c]) for c in corners))


def by_sets(mesh):
    """Sheets as sets of edges, chords as sets of faces, blocks by walls that grow face by face."""
    sheets, chords, cells_at, edge_faces, edge_cells = Sets(), Sets(), {}, {}, {}
    along = edges_of(None)
    for c, cell in enumerate(mesh.cells):
        for axis in range(3):
            edges = [named(cell, e) for e in along[axis]]
            for edge in edges:
                sheets.unite(edges[0], edge)
                edge_cells.setdefault(edge, set()).add(c)
            near, far = (named(cell, f) for f in faces_of(axis))
            chords.unite(near, far)
            for face in (near, far):
                cells_at.setdefault(face, []).append(c)
    for face in cells_at:
        for edge in itertools.combinations(face, 2):
            if edge in edge_cells:
                edge_faces.setdefault(edge, []).append(face)
    outside = {face for face, cells in cells_at.items() if len(cells) == 1}
    on_boundary = {edge for face in outside for edge in itertools.combinations(face, 2)}
    regular = {edge for edge, cells in edge_cells.items()
               if edge not in on_boundary and len(cells) == 4}
    singular = {edge for edge, cells in edge_cells.items()
                if len(cells) != (2 if edge in on_boundary else 4)}
    walls = {face for edge in singular for face in edge_faces[edge]} | outside
    front = list(walls - outside)
    while front:
        face = front.pop()
        for edge in itertools.combinations(face, 2):
            if edge not in regular:
                continue
            # The face across has no cell in common with this one.
            across = [f for f in edge_faces[edge] if not set(cells_at[f]) & set(cells_at[face])]
            assert len(across) == 1
            if across[0] not in walls:
                walls.add(across[0])
                front.append(across[0])
    blocks = Sets()
    for c in range(len(mesh.cells)):
        blocks.find(c)
    for face, cells in cells_at.items():
        if face not in walls:
            blocks.unite(*cells)
    return sheets, chords, blocks, singular


@pytest.mark.parametrize("kind", KINDS)
def test_base_complex(meshes, kind):
    mesh = meshes[kind]
    found, (sheets, chords, blocks, singular) = mesh.base_complex(), by_sets(mesh)
    assert (found.sheets, found.chords) == (sheets.count(), chords.count())
    assert len(found.block_cells) == blocks.count()
    numbers = {}
    for c, cell in enumerate(mesh.cells):  # the same sets under other names
        for axis in range(3):
            edge, face = named(cell, edges_of(cell)[axis][0]), named(cell, faces_of(axis)[0])
            for what, number, name in (("sheet", found.cell_sheets[c, axis], sheets.find(edge)),
                                       ("chord", found.cell_chords[c, axis], chords.find(face))):
                assert numbers.setdefault((what, name), number) == number
        assert numbers.setdefault(("block", blocks.find(c)), found.cell_blocks[c]) == found.cell_blocks[c]
    # Every block of a sample is a box of 3 cells each way, cut by walls of others.
    assert np.array_equal(found.block_sizes.prod(axis=1), found.block_cells)
    assert found.block_cells.sum() == len(mesh.cells)
    assert np.array_equal(np.bincount(found.cell_blocks), found.block_cells)
    # Curves are all singular edges, each once, and end where others meet.
    edges = [tuple(sorted(map(int, pair))) for curve in found.curves
             for pair in zip(curve.vertices, curve.vertices[1:])]
    assert sorted(edges) == sorted(singular)
    rows, valences, boundary = mesh.singular_edges()
    known = {tuple(map(int, row)): (int(v), bool(b)) for row, v, b in zip(rows, valences, boundary)}
    for curve in found.curves:
        for pair in zip(curve.vertices, curve.vertices[1:]):
            assert known[tuple(sorted(map(int, pair)))] == (curve.valence, curve.boundary)
    # Vertices by the singular edges at them.
    at = {}
    for edge, (valence, on_boundary) in known.items():
        for vertex in edge:
            at.setdefault(vertex, ([], []))[on_boundary].append(valence)
    outside = set(mesh.boundary_quads().reshape(-1).tolist())
    listed = {int(v): kind for kind in found.irregular for v in kind.vertices}
    assert listed.keys() == at.keys()
    for vertex, (inner, outer) in at.items():
        kind = listed[vertex]
        assert (kind.inner_valences, kind.boundary_valences) == (sorted(inner), sorted(outer))
        assert kind.boundary == (vertex in outside)


def test_base_complex_refuses():
    mesh = hexhex.extract(hexhex.generate("box", cells=1))
    cells = mesh.cells.copy()
    cells[3] = cells[3][[4, 5, 6, 7, 0, 1, 2, 3]]
    with pytest.raises(hexhex.ArgumentError, match="same direction"):
        hexhex.Mesh(mesh.points, cells).base_complex()
    cells[3] = cells[3][0]
    with pytest.raises(hexhex.ArgumentError, match="Cell 3 names a vertex twice"):
        hexhex.Mesh(mesh.points, cells).base_complex()


@pytest.mark.parametrize("kind", KINDS)
def test_boundary_patches(meshes, kind):
    """Areas and normals are those of triangles; together, they are the boundary."""
    mesh = meshes[kind]
    patches = mesh.boundary_patches()
    together = np.sort(np.concatenate([p.quads for p in patches]), axis=1)
    expected = np.sort(mesh.boundary_quads(), axis=1)
    assert sorted(together.tolist()) == sorted(expected.tolist())
    total = np.zeros(3)
    for patch in patches:
        corners = mesh.points[patch.quads]
        vectors = np.zeros((len(corners), 3))
        areas, moment = np.zeros(len(corners)), np.zeros(3)
        for split in ((0, 1, 2), (0, 2, 3), (1, 2, 3), (1, 3, 0)):  # each way counts by half
            a, b, c = (corners[:, i] for i in split)
            cross = np.cross(b - a, c - a) / 2
            size = np.linalg.norm(cross, axis=1)
            vectors += cross / 2
            areas += size / 2
            moment += (size[:, None] / 2 * (a + b + c) / 3).sum(axis=0)
        assert patch.area == pytest.approx(areas.sum())
        assert patch.normal == pytest.approx(vectors.sum(axis=0) / areas.sum(), abs=1e-12)
        assert patch.centre == pytest.approx(moment / areas.sum(), abs=1e-12)
        total += np.array(patch.normal) * patch.area
    assert total == pytest.approx(0, abs=1e-9)  # it is closed


def test_boundary_patches_have_names():
    box = hexhex.generate("box", features=True)
    box.features.names = {(2, 1): "inlet"}
    mesh = hexhex.extract(box)
    assert mesh.features.names == {(2, 1): "inlet"}
    assert [p.name for p in mesh.boundary_patches()] == ["inlet"] + [f"surface_{n}" for n in range(2, 7)]
    assert [p.tag for p in mesh.boundary_patches()] == list(range(1, 7))
    plain = hexhex.Mesh(mesh.points, mesh.cells)
    assert [(p.name, p.tag) for p in plain.boundary_patches(0)] == [("boundary", 0)]
    assert plain.boundary_patches()[2].name == "patch_3"
    with pytest.raises(hexhex.ArgumentError):
        plain.boundary_patches(181)


def shuffled(mesh, seed):
    """The same mesh with other numbers, cells turned."""
    random = np.random.default_rng(seed)
    places, cells = random.permutation(len(mesh.points)), random.permutation(len(mesh.cells))
    points = np.empty_like(mesh.points)
    points[places] = mesh.points
    turned = places[mesh.cells[cells].astype(int)]
    for row in range(0, len(turned), 2):
        turned[row] = turned[row][[3, 2, 6, 7, 0, 1, 5, 4] if row % 4 else [1, 2, 3, 0, 5, 6, 7, 4]]
    f = mesh.features
    rows = [np.column_stack((places[r[:, :-1]], r[:, -1])) for r in (f.vertices, f.edges, f.faces)]
    return hexhex.Mesh(points, turned, regions=mesh.regions[cells],
                       features=hexhex.Features(*(random.permutation(r) for r in rows), corners=4,
                                                names=f.names))


def test_equality(tmp_path):
    tagged = hexhex.generate("handle-body", features=True)
    mesh = hexhex.extract(tagged)
    assert mesh == hexhex.extract(tagged, threads=1) and not mesh != mesh
    assert mesh != hexhex.extract(tagged, scale=2) and mesh != 3 and tagged != mesh
    hexhex.write(mesh, tmp_path / "a.vtu")
    assert hexhex.read(tmp_path / "a.vtu") == mesh
    assert hexhex.extract(tagged, order=2).curved == hexhex.extract(tagged, order=2).curved
    assert hexhex.Map(tagged.points, tagged.tets, tagged.igm) != tagged
    other = shuffled(mesh, 1)
    assert other != mesh and hexhex.same_mesh(other, mesh)
    assert mesh.diff(other) == "the same mesh with other numbers" and mesh.diff(mesh) == ""
    # Every kind of change is one.
    def moved(m): m.points[5] += 1e-12
    def mirrored(m): m.cells[7] = m.cells[7][[4, 5, 6, 7, 0, 1, 2, 3]]
    def other_region(m): m.regions[3] += 1
    def other_tag(m): m.features.edges[2, 2] += 1
    for change in (moved, mirrored, other_region, other_tag):
        changed = shuffled(mesh, 2)
        change(changed)
        assert not hexhex.same_mesh(changed, mesh) and mesh.diff(changed)
        changed = hexhex.Mesh(mesh.points, mesh.cells, regions=mesh.regions, features=mesh.features)
        change(changed)
        assert changed != mesh and len(mesh.diff(changed).splitlines()) == 1


def test_slits_are_seen():
    """Two cells that touch in four points of their own have no face in common."""
    joined = hexhex.extract(hexhex.generate("box", cells=1))
    points = np.concatenate((joined.points, joined.points[joined.cells[0]]))
    cells = joined.cells.copy()
    cells[0] = np.arange(8) + len(joined.points)
    apart = hexhex.Mesh(points, cells)
    assert not hexhex.same_mesh(joined, apart)
    unused = hexhex.Mesh(np.concatenate((joined.points, joined.points[joined.cells[0]])), joined.cells)
    assert not hexhex.same_mesh(unused, apart)
    free = hexhex.Mesh(joined.points[::-1], (len(joined.points) - 1 - joined.cells.astype(int))[::-1])
    assert hexhex.same_mesh(joined, free)


def test_differences_are_told(meshes):
    mesh = meshes["box"]
    changed = hexhex.Mesh(mesh.points, mesh.cells)
    changed.points[11, 2] += 0.25
    assert re.fullmatch(r"points: 1 of 343 differ, by up to 0\.25; the first is 11: \[.*\] here, \[.*\] there",
                        mesh.diff(changed))
    fewer = hexhex.Mesh(mesh.points, mesh.cells[:-2])
    assert mesh.diff(fewer).splitlines() == [
        "cells: 216 here, 214 there",
        f"cells here, by their centres: 2 of 216 are not there; the first is 214: {mesh.cells[214].tolist()}"]
    assert "points: 343 here, 2197 there" in mesh.diff(hexhex.extract(hexhex.generate("box", cells=6)))


def test_parameters_of_vertices():
    box = hexhex.generate("box")
    uvw = np.zeros_like(box.points)
    uvw[box.tets] = box.igm
    expected = hexhex.extract(box)
    assert hexhex.extract(box.points, box.tets, uvw) == expected
    assert hexhex.check(box.points, box.tets, uvw).valid
    with pytest.raises(hexhex.ArgumentError, match="one per vertex; there are 189"):
        hexhex.extract(box.points, box.tets, uvw[:-1])
    tets = box.tets.copy()
    tets[4, 2] = 1000
    with pytest.raises(hexhex.MapError, match="at tet 4"):
        hexhex.extract(box.points, tets, uvw)


def test_seamless_maps_are_advised():
    if not hexhex.can_quantize():
        pytest.skip("this build cannot quantize")
    whole = hexhex.generate("sphere")
    seamless = hexhex.Map(whole.points, whole.tets, whole.igm * 2**0.5)
    for options in ({}, {"order": 2}, {"patches": True}):
        with pytest.raises(hexhex.MapError, match=r"integer up to a scale.*hexhex\.quantize\(map, scale="):
            hexhex.extract(seamless, **options)
    box = hexhex.generate("box")
    stretched = hexhex.Map(box.points, box.tets, box.igm * [1, 2**0.5, 3**0.5])
    sentence = r"The map is seamless .* not integer.*hexhex\.extract\(map, quantize=True, cells=1254\)\."
    with pytest.raises(hexhex.MapError, match=sentence) as caught:
        hexhex.extract(stretched)
    mesh = hexhex.extract(stretched, quantize=True, cells=1254)  # as it says
    assert caught.value.code == "BoundaryOffLattice" or caught.value.code == "TransitionResidual"
    assert len(mesh.cells) == mesh.quantization.cells and mesh.quantized_map.tets.shape[1] == 4
    assert hexhex.verify(mesh.quantized_map, mesh)
    for options in ({"cells": 100}, {"edge_length": 0.1}):
        with pytest.raises(hexhex.ArgumentError, match="quantize=True"):
            hexhex.extract(box, **options)
    broken = hexhex.Map(box.points, box.tets, np.random.default_rng(1).random(box.igm.shape))
    with pytest.raises(hexhex.MapError, match="Nor can it be quantized: "):
        hexhex.extract(broken)
    assert hexhex.extract(box).quantization is None


def test_meshio_has_groups(tmp_path):
    meshio = pytest.importorskip("meshio")
    box = hexhex.generate("box", features=True)
    box.features.names = {(2, 1): "inlet", (3, 2): "steel"}
    mesh = hexhex.extract(box)
    made = mesh.to_meshio()
    assert [block.type for block in made.cells] == ["hexahedron", "quad", "line"]
    assert {"inlet", "surface_2", "steel", "region_3", "curve_1"} <= made.cell_sets.keys()
    areas = {p.name: len(p.quads) for p in mesh.boundary_patches()}
    assert {name: len(made.cell_sets[name][1]) for name in areas} == areas
    assert sum(len(rows[0]) for rows in made.cell_sets.values()) == len(mesh.cells)
    back = hexhex.Mesh.from_meshio(made)
    assert hexhex.same_mesh(back, mesh) and set(back.features.names.values()) == {"inlet", "steel"}
    # Smooth patches have names there, and are no tags when they come back.
    plain = hexhex.Mesh(mesh.points, mesh.cells)
    made = plain.to_meshio(patch_angle=30)
    assert sorted(made.cell_sets) == [f"patch_{n}" for n in range(1, 7)]
    assert hexhex.Mesh.from_meshio(made) == plain
    # By way of files, of meshio and of ours.
    mesh.to_meshio().write(tmp_path / "a.vtu")
    assert np.array_equal(hexhex.Mesh.from_meshio(meshio.read(tmp_path / "a.vtu")).regions, mesh.regions)
    hexhex.write(mesh, tmp_path / "a.msh", format="gmsh41-ascii")
    read = hexhex.Mesh.from_meshio(meshio.read(tmp_path / "a.msh"))
    names = {p.name: len(p.quads) for p in read.boundary_patches()}
    assert names == areas


def test_names_are_kept(tmp_path):
    import copy
    import pickle

    box = hexhex.generate("box", features=True)
    box.features.names = {(2, 3): "wall", (0, 1): "corner"}
    mesh = hexhex.extract(box)
    for other in (pickle.loads(pickle.dumps(mesh)), copy.deepcopy(mesh)):
        assert other == mesh and other.features.names == box.features.names
    for value, name in ((box, "map.npz"), (mesh, "mesh.npz")):
        hexhex.write(value, tmp_path / name)
        assert hexhex.read(tmp_path / name) == value
    hexhex.write(mesh, tmp_path / "a.msh")
    assert hexhex.read(tmp_path / "a.msh").features.names[(2, 3)] == "wall"


def test_pages(tmp_path):
    mesh = hexhex.extract(hexhex.generate("sphere"), order=2)
    try:
        page = hexhex.view(mesh, title="a <ball>")
    except hexhex.FileError as error:
        assert "without the viewer" in str(error)
        with pytest.raises(hexhex.FileError, match="without the viewer"):
            hexhex.write(mesh, tmp_path / "a.html")
        pytest.skip("this build has no viewer")
    assert page.html.startswith("<!") and "a <ball>" not in page.html.split("<body", 1)[0]
    shown = page._repr_html_()
    assert shown.startswith("<iframe ") and shown.count("<") == 2 and 'srcdoc="' in shown
    for value in (mesh, mesh.curved):
        hexhex.write(value, tmp_path / "page.html")
        text = (tmp_path / "page.html").read_text(encoding="utf-8")
        assert text.startswith("<!") and len(text) > 100_000
    code = "import sys, hexhex; hexhex.view(hexhex.extract(hexhex.generate('box')));" \
           "assert not {'trame', 'pyvista', 'IPython'} & set(sys.modules)"
    subprocess.run([sys.executable, "-c", code], check=True, timeout=120)


@pytest.mark.parametrize("kind", ["box", "sphere", "torus"])
def test_base_complex_in_pyvista(meshes, kind):
    pytest.importorskip("pyvista")
    mesh = meshes[kind]
    parts, (_, _, blocks, singular) = mesh.base_complex(), by_sets(mesh)
    made = parts.to_pyvista()
    assert made.keys() == ["cells", "walls", "sheets", "chords", "singular_curves", "irregular_vertices"]
    assert np.array_equal(made["cells"]["block"], parts.cell_blocks)
    # Faces of two cells in different blocks, found by names of vertices.
    cells_at = {}
    for c, cell in enumerate(mesh.cells):
        for axis in range(3):
            for face in faces_of(axis):
                cells_at.setdefault(named(cell, face), []).append(c)
    walls = {face for face, cells in cells_at.items() if len({blocks.find(c) for c in cells}) == 2}
    assert {tuple(sorted(q)) for q in made["walls"].regular_faces.tolist()} == walls
    # Edges of the polylines are the singular edges, each once.
    curves = made["singular_curves"]
    edges = [tuple(sorted(e)) for i in range(curves.n_cells)
             for ids in [curves.get_cell(i).point_ids] for e in zip(ids, ids[1:])]
    assert set(edges) == singular and len(edges) == len(singular)
    assert made["irregular_vertices"].n_points == sum(len(each.vertices) for each in parts.irregular)
    # A sheet is one piece, and so is a chord; each passes its cells as often as they say.
    for name, array, of_cells in (("sheets", "sheet", parts.cell_sheets), ("chords", "chord", parts.cell_chords)):
        for number in range(int(of_cells.max()) + 1):
            piece = made[name].extract_cells(made[name][array] == number)
            assert piece.n_cells == (of_cells == number).sum()
            assert piece.connectivity()["RegionId"].max() == 0
    if kind == "box":  # of edge length 2: 3 sheets each way, and 9 chords
        sizes = made["sheets"].compute_cell_sizes()
        assert np.allclose(np.bincount(sizes["sheet"], sizes["Area"]), 4)
        sizes = made["chords"].compute_cell_sizes()
        assert np.allclose(np.bincount(sizes["chord"], sizes["Length"]), 2)


def test_module_opens_pages(monkeypatch, tmp_path, capsys):
    from hexhex import __main__ as module
    opened = []
    monkeypatch.setattr(module.webbrowser, "open", opened.append)
    page = tmp_path / "hexhex.html"
    monkeypatch.setattr(module, "_PAGE", page)
    assert "without the page hexhex.html" in module.main([])
    page.write_text("<!doctype html>")
    assert module.main([]) is None and opened == [page.as_uri()]
    assert "missing.vtu" in module.main([str(tmp_path / "missing.vtu")])
    assert module.main(["a", "b"]).startswith("usage:")
    hexhex.write(hexhex.generate("box"), tmp_path / "box.hexex")
    problem = module.main([str(tmp_path / "box.hexex")])
    assert ("viewer" in problem) if problem else opened[-1].endswith("/box.html")
