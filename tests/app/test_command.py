#!/usr/bin/env python3
"""End-to-end test of the hexhex command: exit codes, messages, files, reports.

    test_command.py PATH-OF-HEXHEX [unittest options]

Needs nothing but Python's standard library.
"""

import base64
import ctypes.util
import hashlib
import itertools
import json
import os
import pathlib
import pty
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import zlib

SUCCESS, INVALID_MAP, BAD_USAGE, FILE_PROBLEM, FAILURE, INTERRUPTED = 0, 1, 2, 3, 4, 130

# One tet: the map is valid as a file, but its boundary is not on integer planes.
ONE_TET = """4
0 0 0
1 0 0
0 1 0
0 0 1
1
0 1 2 3 0 0 0 1 0 0 0 1 0 0 0 1
"""

# A cube of six tets around a diagonal, its own polycube.
POLYCUBE = """MeshVersionFormatted 2
Dimension 3
Vertices
8
0 0 0 0
1 0 0 0
0 1 0 0
1 1 0 0
0 0 1 0
1 0 1 0
0 1 1 0
1 1 1 0
Tetrahedra
6
1 2 4 8 1
1 4 3 8 1
1 3 7 8 1
1 7 5 8 1
1 5 6 8 1
1 6 2 8 1
End
"""

KINDS = ["box", "cylinder", "sphere", "star", "tetrahedron", "torus", "shell", "handle-body"]

REPORT_KEYS = {
    "boundary",    "hexhex_version", "input", "output", "extract_seconds", "seconds", "cells", "vertices", "tets", "points",
    "scale", "threads", "engine", "stages", "peak_memory_bytes",
    "generators", "vertices_by_generator", "local_propellers", "global_propellers", "charts",
    "cut_faces", "overlapping_tets", "traced_cells", "singular_edges", "chart_jumps", "inner_faces",
    "max_displacement", "max_transition_residual", "mirrored", "tets_inverted_in_space", "quality",
    "validity", "verification", "streamed", "checksums", "repair", "quantization", "improvement", "order",
    "nodes", "curved", "arcs", "patches", "parts",
}


def mixed_mesh():
    """A cube with a pyramid on top, a tet inside of that, and a tagged quad, as legacy VTK."""
    points = [(x, y, z) for z in range(2) for y in range(2) for x in range(2)] + [(0.5, 0.5, 2)]
    cells = [[12, 0, 1, 3, 2, 4, 5, 7, 6], [14, 4, 5, 7, 6, 8], [10, 4, 5, 6, 8], [9, 0, 1, 3, 2]]
    numbers = sum(len(cell) for cell in cells)
    return ("# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\n"
            f"POINTS {len(points)} double\n" + "\n".join("%g %g %g" % p for p in points) +
            f"\nCELLS {len(cells)} {numbers}\n" +
            "".join(" ".join(map(str, [len(c) - 1] + c[1:])) + "\n" for c in cells) +
            f"CELL_TYPES {len(cells)}\n" + "".join(f"{c[0]}\n" for c in cells))


class CommandTest(unittest.TestCase):
    """Runs the command in an empty folder."""

    command = None

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="hexhex-test-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    @property
    def sanitized(self):
        """Sanitizers take a multiple of memory and time, so that maps of half the size keep them as busy."""
        return bool(re.search(b"__[atm]san_init", pathlib.Path(self.command).read_bytes()))

    def skip_if_sanitized(self):
        """Of a test that measures memory."""
        if self.sanitized:
            self.skipTest("the sanitizers take memory of their own")

    def run_command(self, *arguments, expect=SUCCESS, **options):
        result = subprocess.run([self.command, *map(str, arguments)], cwd=self.folder, text=True,
                                capture_output=True, timeout=600, check=False, **options)
        if expect is not None:
            self.assertEqual(result.returncode, expect,
                             f"{arguments}\n{result.stdout}\n{result.stderr}")
        return result

    def assert_fails(self, *arguments, expect, words=(), code=None):
        """The command fails with one sentence, and the folder stays as it was."""
        before = self.files()
        result = self.run_command(*arguments, "--quiet", expect=expect)
        self.assertEqual(self.files(), before)
        self.assertEqual(result.stdout, "")
        self.assertTrue(result.stderr.startswith("hexhex: error: "), result.stderr)
        for word in words:
            self.assertIn(word, result.stderr)
        if code:
            self.assertRegex(result.stderr.rstrip(), rf"\[{code}(, [^\]]+)?\]$")

    def files(self):
        return {path.name: path.read_bytes() for path in self.folder.iterdir() if path.is_file()}

    def write(self, name, text):
        data = text if isinstance(text, bytes) else text.encode()
        (self.folder / name).write_bytes(data)
        return name

    def generate(self, kind, *options, name="map.hexex"):
        self.run_command("generate", kind, "-o", name, "--quiet", *options)
        return name

    def generate_for_seconds(self):
        """A map whose extraction at a scale of 2 takes a second or some."""
        return self.generate("box", *(["--cells", "20", "--refine", "4"] if self.sanitized else
                                      ["--cells", "40", "--refine", "8"]))


class Help(CommandTest):
    def test_terminal_is_not_told_what_to_do(self):
        """Names in files are text, also for the terminal."""
        self.write("a.vtu", '<VTKFile type="UnstructuredGrid"><UnstructuredGrid>'
                   '<Piece NumberOfPoints="0" NumberOfCells="0"><PointData>'
                   '<DataArray type="Float64" Name="\x1b[31mred\x07" format="ascii"></DataArray>'
                   '</PointData></Piece>')
        for arguments, name in [(["check", "a.vtu", "--quiet"], "?[31mred?"), (["info", "a\n\x1b[2J.x"], "a??[2J.x")]:
            errors = self.run_command(*arguments, expect=FILE_PROBLEM).stderr
            self.assertIn(name, errors)
            self.assertTrue(errors.rstrip("\n").isprintable(), errors)

    def test_terminal_is_not_told_what_to_do_by_names_of_files(self):
        name = "a\x1b[31m.hexex"
        said = [self.run_command("generate", "box", "-o", name).stdout]
        for arguments in [["info", name], ["extract", name, "-o", "b\a.vtu"], ["info", "b\a.vtu"],
                          ["convert", "b\a.vtu", "c\r.mesh"], ["repair", name, "-o", "d\x7f.hexex"]]:
            said.append(self.run_command(*arguments).stdout)
        for text in said:
            self.assertIn("?", text)
            self.assertTrue(all(line.isprintable() for line in text.split("\n")), text)

    def test_help_and_version(self):
        text = self.run_command("--help").stdout
        for word in ["extract", "check", "verify", "generate", "info", "view", "Exit codes", "Examples"]:
            self.assertIn(word, text)
        self.assertRegex(self.run_command("--version").stdout, r"^hexhex \d+\.\d+\.\d+\n$")
        for subcommand in ["extract", "check", "verify", "generate", "repair", "info", "view"]:
            self.assertIn("Example", self.run_command(subcommand, "--help").stdout)

    def test_help_lists_every_kind(self):
        text = self.run_command("generate", "--help").stdout
        for kind in KINDS:
            self.assertIn(f"\n  {kind} ", text)


    def test_help_without_anything_and_as_a_subcommand(self):
        text = self.run_command("--help").stdout
        self.assertEqual(self.run_command().stdout, text)
        self.assertEqual(self.run_command("help").stdout, text)
        for subcommand in ["extract", "formats", "help"]:
            self.assertEqual(self.run_command("help", subcommand).stdout,
                             self.run_command(subcommand, "--help").stdout)


class BadUsage(CommandTest):
    def test_did_you_mean(self):
        self.generate("box")
        extract = ["extract", "map.hexex", "-o", "a.vtu"]
        for arguments, sentence in [
            (["extrct"], 'There is no subcommand "extrct". Did you mean extract?'),
            (["convrt", "a", "b"], 'There is no subcommand "convrt". Did you mean convert?'),
            (["xyzzy"], 'There is no subcommand "xyzzy".'),
            (["--versoin"], "There is no option --versoin. Did you mean --version?"),
            (["help", "quantise"], "Did you mean quantize?"),
            ([*extract, "--sclae", "2"], "There is no option --sclae. Did you mean --scale?"),
            ([*extract, "--no-verfy"], "There is no option --no-verfy. Did you mean --no-verify?"),
            ([*extract, "--scael=2"], "There is no option --scael. Did you mean --scale?"),
            ([*extract, "--quite"], "There is no option --quite. Did you mean --quiet?"),
            ([*extract, "--red"], "There is no option --red."),
            ([*extract, "--format", "dxf"],
             '--format: there is no format "dxf"; `hexhex formats` lists them.'),
            ([*extract, "b.vtu"], 'Unexpected argument "b.vtu".'),
            ([*extract, "--engine", "atals"],
             '--engine: there is no "atals"; choose atlas or propeller. Did you mean atlas?'),
            ([*extract, "--repair", "maybe"],
             '--repair: there is no "maybe"; choose auto or off.'),
            ([*extract, "--format", "vtk-binry"],
             '--format: there is no format "vtk-binry"; `hexhex formats` lists them. Did you mean '
             "vtk-binary?"),
            (["generate", "spehre", "-o", "b.hexex"], "Did you mean sphere?"),
            (["generate", "box", "-o", "b.hexex", "--charts", "randm"], "Did you mean random?"),
        ]:
            with self.subTest(arguments=arguments):
                result = self.run_command(*arguments, expect=BAD_USAGE)
                self.assertIn(f"{sentence}\n", result.stderr)
                given = "extract " if arguments[0] == "extract" else ""
                if given:
                    self.assertIn("Run `hexhex extract --help`", result.stderr)
                self.assertEqual(set(self.files()), {"map.hexex"})

    def test_other_names_of_formats_are_known(self):
        self.generate("box")
        self.run_command("extract", "map.hexex", "-o", "a.x", "--format", "gmsh22", "--quiet")

    def test_files_that_are_the_same(self):
        self.generate("box")
        (self.folder / "link.mesh").symlink_to(self.folder / "map.hexex")
        before = (self.folder / "map.hexex").read_bytes()
        for arguments in [
            ["-o", "a.mesh", "--report", "map.hexex"],
            ["-o", "a.mesh", "--report", "./a.mesh"],
            ["-o", "link.mesh"],
        ]:
            run = self.run_command("extract", "map.hexex", *arguments, expect=2)
            self.assertIn("same file", run.stderr)
        self.assertEqual((self.folder / "map.hexex").read_bytes(), before)
        self.assertFalse((self.folder / "a.mesh").exists())

    def test_wrong_options(self):
        self.write("map.hexex", ONE_TET)
        for arguments in [
            ["explode"], ["extract"], ["extract", "map.hexex"],
            ["extract", "map.hexex", "-o", "a.vtu", "--colour", "red"],
            ["extract", "map.hexex", "-o", "a.vtu", "--scale", "0"],
            ["extract", "map.hexex", "-o", "a.vtu", "--scale", "1.5"],
            ["extract", "map.hexex", "-o", "a.vtu", "--threads", "-1"],
            ["extract", "map.hexex", "-o", "a.vtu", "--tolerance", "0.25"],
            ["check", "map.hexex", "--tolerance", "nan"],
            ["generate", "pyramid", "-o", "a.hexex"],
            ["generate", "box", "-o", "a.hexex", "--charts", "odd"],
            ["generate", "box", "-o", "a.hexex", "--cells", "0"],
            ["generate", "star", "-o", "a.hexex", "--valence", "2"],
            ["generate", "star", "-o", "a.hexex", "--valence", "13"],
            ["generate", "box", "-o", "a.hexex", "--jitter", "2"],
            ["verify", "map.hexex"], ["info"],
        ]:
            with self.subTest(arguments=arguments):
                result = self.run_command(*arguments, expect=BAD_USAGE)
                self.assertIn("hexhex: error: ", result.stderr)
                self.assertEqual(set(self.files()), {"map.hexex"})


class FileProblems(CommandTest):
    def test_missing_input(self):
        words = ["missing.hexex", "No such file"]
        for arguments in [["extract", "missing.hexex", "-o", "a.vtu"], ["check", "missing.hexex"]]:
            self.assert_fails(*arguments, expect=FILE_PROBLEM, words=words, code="FileNotFound")

    def test_broken_input(self):
        broken = {
            "empty": (b"", "FileSyntax"),
            "garbage": (bytes(range(256)), "FileSyntax"),
            "short": (ONE_TET[:40].encode(), "FileSyntax"),
            "letters": (ONE_TET.replace("0 1 0\n", "0 one 0\n").encode(), "FileSyntax"),
            "huge": (b"999999999999\n0 0 0\n", "FileSyntax"),
            "infinite": (ONE_TET.replace("0 1 0\n", "0 inf 0\n").encode(), "NotFinite"),
            "index": (ONE_TET.replace("0 1 2 3", "0 1 2 4").encode(), "IndexOutOfRange"),
        }
        for name, (content, code) in broken.items():
            with self.subTest(name=name):
                file = self.write(f"{name}.hexex", content)
                self.assert_fails("extract", file, "-o", "a.vtu", expect=FILE_PROBLEM,
                                  words=[f"{name}.hexex, line "], code=code)

    def test_folder_as_input(self):
        (self.folder / "folder.hexex").mkdir()
        self.assert_fails("check", "folder.hexex", expect=FILE_PROBLEM, words=["it is a folder"],
                          code="FileNotFound")
        (self.folder / "plain").mkdir()
        self.assert_fails("check", "plain", expect=FILE_PROBLEM, words=["it is a folder"],
                          code="FileUnsupported")

    def test_mesh_is_no_map(self):
        self.run_command("extract", self.generate("box", "--cells", "1", "--refine", "1"), "-o", "a.vtu", "--quiet")
        self.assert_fails("check", "a.vtu", expect=FILE_PROBLEM, words=["it holds 8 hexahedra"], code="FileUnsupported")

    def test_unknown_extensions(self):
        self.write("map.hexex", ONE_TET)
        words = [".mesh, .meshb, .vtu"]
        self.assert_fails("extract", "map.hexex", "-o", "a.obj", expect=FILE_PROBLEM, words=words,
                          code="FileUnsupported")
        self.assert_fails("extract", "map.hexex", "-o", "a", expect=FILE_PROBLEM, words=words,
                          code="FileUnsupported")
        self.assert_fails("generate", "box", "-o", "a.msh", expect=FILE_PROBLEM,
                          words=[".hexex"], code="FileUnsupported")
        self.run_command("info", self.write("a.png", ""), expect=FILE_PROBLEM)

    def test_unwritable_output(self):
        map_file = self.generate("box", "--cells", "1", "--refine", "1")
        (self.folder / "taken.vtu").mkdir()
        for output in ["missing/a.vtu", "map.hexex/a.vtu", "taken.vtu"]:
            with self.subTest(output=output):
                self.assert_fails("extract", map_file, "-o", output, expect=FILE_PROBLEM,
                                  words=[output], code="FileWrite")
        self.assert_fails("extract", map_file, "-o", "a.vtu", "--report", "missing/r.json",
                          expect=FILE_PROBLEM, words=["missing/r.json"], code="FileWrite")
        self.assert_fails("generate", "box", "-o", "missing/a.hexex", expect=FILE_PROBLEM,
                          words=["missing"], code="FileWrite")

    @unittest.skipIf(os.geteuid() == 0, "the superuser may write anywhere")
    def test_folder_without_permission(self):
        map_file = self.generate("box", "--cells", "1", "--refine", "1")
        locked = self.folder / "locked"
        locked.mkdir(mode=0o555)
        self.assert_fails("extract", map_file, "-o", "locked/a.vtu", expect=FILE_PROBLEM,
                          words=["Permission denied"], code="FileWrite")

    def test_full_disk(self):
        map_file = self.generate("box", "--cells", "8", "--refine", "1")

        def limit_file_size():
            import resource
            resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000))

        known = self.run_command("formats").stdout
        for output in ["a.vtu", "a.mesh", "a.vtkhdf", "a.cgns", "a.exo", "a.foam"]:
            if output[1:] + " " not in known:
                continue
            before = self.files()
            result = self.run_command("extract", map_file, "-o", output, expect=FILE_PROBLEM,
                                      preexec_fn=limit_file_size)
            self.assertIn("File too large. [FileWrite]", result.stderr)
            self.assertEqual(self.files(), before)

    @unittest.skipUnless(sys.platform == "linux", "limits of address space")
    def test_scarce_memory(self):
        map_file = self.generate("box", "--cells", "1", "--refine", "1")
        import resource

        def run(kilobytes):
            limit = (1024 * kilobytes, 1024 * kilobytes)
            return subprocess.run(
                [self.command, "extract", map_file, "-o", "a.vtu", "--quiet", "--threads", "1"], cwd=self.folder,
                preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, limit), capture_output=True, check=False)

        # From where all libraries can be loaded on; the sanitizers want terabytes. With less, the loader says so, and
        # with still less the system kills what it cannot even map.
        least, most = 0, 400_000
        if run(most).returncode != SUCCESS:
            self.skipTest("it takes more address space than that")
        while most - least > 20:
            middle = (least + most) // 2
            least, most = (least, middle) if run(middle).returncode in [SUCCESS, FAILURE] else (middle, most)
        for kilobytes in range(most, most + 6000, 60):
            result = run(kilobytes)
            self.assertIn(result.returncode, [SUCCESS, FAILURE, 127], result.stderr)
            if result.returncode == FAILURE:
                self.assertIn(b"[OutOfMemory]", result.stderr)
            self.assertLessEqual(set(self.files()), {"map.hexex", "a.vtu"})

    def test_links_that_lead_nowhere(self):
        map_file = self.generate("box", "--cells", "1", "--refine", "1")
        (self.folder / "loop").symlink_to("loop")
        before = self.files()
        # A report is tried before the mesh is made.
        for arguments in [["-o", "loop", "--format", "vtu"], ["-o", "a.vtu", "--report", "loop"]]:
            self.assert_fails("extract", map_file, *arguments, expect=FILE_PROBLEM,
                              words=["loop", "leads nowhere"], code="FileWrite")
            self.assertEqual(self.files(), before)

    def test_old_output_survives_failure(self):
        map_file = self.write("map.hexex", ONE_TET)
        self.write("a.vtu", "old")
        self.assert_fails("extract", map_file, "-o", "a.vtu", expect=INVALID_MAP)
        self.assertEqual((self.folder / "a.vtu").read_text(), "old")

    def test_standard_output_that_is_full(self):
        if not os.path.exists("/dev/full"):
            self.skipTest("no /dev/full")
        map_file = self.write("map.hexex", ONE_TET)
        with open("/dev/full", "w", encoding="ascii") as full:
            process = subprocess.run([self.command, "info", map_file], cwd=self.folder,
                                     stdout=full, stderr=subprocess.PIPE, check=False, text=True)
        self.assertEqual(process.returncode, FILE_PROBLEM)
        self.assertIn("standard output", process.stderr)


class InvalidMaps(CommandTest):
    def test_boundary_off_the_lattice(self):
        map_file = self.write("map.hexex", ONE_TET)
        self.assert_fails("extract", map_file, "-o", "a.vtu", expect=INVALID_MAP,
                          code="BoundaryOffLattice")
        result = self.run_command("check", map_file, expect=INVALID_MAP)
        self.assertIn("BoundaryOffLattice", result.stdout)

    def test_flipped_tet(self):
        lines = (self.folder / self.generate("box")).read_text().splitlines()
        first = 1 + int(lines[0]) + 1
        numbers = lines[first].split()
        # Exchanging the parameters of two corners turns the tet inside out.
        numbers[4:7], numbers[7:10] = numbers[7:10], numbers[4:7]
        lines[first] = " ".join(numbers)
        map_file = self.write("flipped.hexex", "\n".join(lines) + "\n")
        self.assert_fails("extract", map_file, "-o", "a.vtu", expect=INVALID_MAP)
        result = self.run_command("check", map_file, "--json", expect=INVALID_MAP)
        report = json.loads(result.stdout)
        self.assertFalse(report["valid"])
        self.assertIsNone(report["expected"])
        self.assertTrue(report["defects"])
        for defect in report["defects"]:
            self.assertEqual(set(defect), {"code", "sentence", "count", "worst"})

    def test_no_tets(self):
        map_file = self.write("map.hexex", "1\n0 0 0\n0\n")
        self.assert_fails("extract", map_file, "-o", "a.vtu", expect=INVALID_MAP,
                          code="EmptyMesh")


def three_torus(cells):
    """A torus of 27 vertices without boundary, in a map of cells^3 hexahedra."""
    lines = ["27", *(f"{i % 3} {i // 3 % 3} {i // 9}" for i in range(27)), "162"]
    for i in range(27):
        for order in itertools.permutations(range(3)):
            at = [i % 3, i // 3 % 3, i // 9]
            corners = [tuple(at)]
            for axis in order:
                at[axis] += 1
                corners.append(tuple(at))
            if order not in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
                corners[2], corners[3] = corners[3], corners[2]
            tet = [x % 3 + 3 * (y % 3) + 9 * (z % 3) for x, y, z in corners]
            lines.append(" ".join(map(str, [*tet, *(cells * x / 3 for u in corners for x in u)])))
    return "\n".join(lines) + "\n"


class CoarseMaps(CommandTest):
    def test_are_verified(self):
        map_file = self.write("torus.hexex", three_torus(2))
        self.run_command("extract", map_file, "-o", "mesh.vtu")
        result = self.run_command("verify", map_file, "mesh.vtu")
        self.assertIn("not counted", result.stdout)
        self.run_command("extract", map_file, "-o", "mesh.vtu", "--scale", 2)
        self.run_command("verify", map_file, "mesh.vtu", "--scale", 2)


class Pipeline(CommandTest):
    def test_curved_meshes(self):
        map_file = self.generate("sphere", "--cells", "1", "--charts", "random")
        self.run_command("extract", map_file, "-o", "a.vtu", "--arcs", "arcs.vtp", "--patches",
                         "patches.ovmb", "--report", "r.json")
        report = json.loads((self.folder / "r.json").read_text())
        self.assertEqual((report["order"], report["nodes"]), (1, report["vertices"]))
        # Seven cells of a ball: 32 edges, 24 faces.
        self.assertEqual(report["arcs"]["count"], 32)
        self.assertEqual(report["patches"]["count"], 24)
        self.assertGreater(report["patches"]["polygons"], 24)
        patches = (self.folder / "patches.ovmb").read_bytes()
        self.assertIn(b"v_tet_generator_index", patches)  # takes the map
        for name in ["c.vtu", "c.msh", "c.mesh"]:
            self.run_command("extract", map_file, "-o", name, "--order", "3", "--report", "r.json")
            report = json.loads((self.folder / "r.json").read_text())
            self.assertEqual((report["cells"], report["vertices"]), (7, 16))
            self.assertEqual(report["nodes"], 16 + 32 * 2 + 24 * 4 + 7 * 8)
            self.assertEqual(report["order"], 3)
            self.assertTrue(report["verification"]["passed"])
            self.assertEqual(report["curved"], {"nodes": "blended", "straightened_cells": []})
        self.run_command("extract", map_file, "-o", "exact.mesh", "--order", "3", "--curved", "exact", "--report",
                         "r.json")
        self.assertEqual(json.loads((self.folder / "r.json").read_text())["curved"]["nodes"], "exact")
        self.assertNotEqual(self.files()["c.mesh"], self.files()["exact.mesh"])
        self.run_command("extract", map_file, "-o", "first.mesh")
        self.run_command("extract", map_file, "-o", "again.mesh", "--order", "1", "--report", "r.json")
        self.assertIsNone(json.loads((self.folder / "r.json").read_text())["curved"])
        files = self.files()
        self.assertEqual(files["first.mesh"], files["again.mesh"])
        self.assertIn(b"L2_T4_3D_P3", files["c.mesh"])

    def test_curved_meshes_that_are_refused(self):
        map_file = self.generate("box", "--cells", "1", "--refine", "1")
        for arguments, code in [
            (["--order", "3", "--arcs", "b.vtu"], BAD_USAGE),
            (["--stream", "--arcs", "b.vtu"], BAD_USAGE),
            (["--stream", "--order", "2"], BAD_USAGE),
            (["--curved", "exact"], BAD_USAGE),
            (["--order", "2", "--curved", "straight"], BAD_USAGE),
            (["--arcs", "a.vtu"], BAD_USAGE),
            (["--arcs", "b.vtu", "--patches", "b.vtu"], BAD_USAGE),
            (["--arcs", "b.mesh"], FILE_PROBLEM),
            (["--patches", "missing/b.vtu"], FILE_PROBLEM),
        ]:
            with self.subTest(arguments=arguments):
                self.assert_fails("extract", map_file, "-o", "a.vtu", *arguments, expect=code)
        self.assert_fails("extract", map_file, "-o", "a.ovm", "--order", "2", expect=FILE_PROBLEM,
                          code="FileUnsupported")
        for order in ["0", "10", "x"]:
            self.run_command("extract", map_file, "-o", "a.vtu", "--order", order,
                             expect=BAD_USAGE)

    def test_every_kind_from_map_to_verified_mesh(self):
        for kind in KINDS:
            with self.subTest(kind=kind):
                map_file = self.generate(kind, "--cells", "2", "--charts", "random", "--jitter",
                                         "0.3", "--offset", "1000")
                expected = json.loads(self.run_command("check", map_file, "--json").stdout)
                self.assertTrue(expected["valid"])
                for mesh in ["a.vtu", "a.mesh"]:
                    self.run_command("extract", map_file, "-o", mesh, "--report", "r.json")
                    report = json.loads((self.folder / "r.json").read_text())
                    self.assertEqual(report["cells"], expected["expected"]["cells"])
                    self.assertTrue(report["verification"]["passed"])
                    table = self.run_command("verify", map_file, mesh).stdout
                    self.assertIn("The mesh agrees with the map.", table)
                    self.assertNotIn("FAILED", table)
                    information = self.run_command("info", mesh).stdout
                    self.assertRegex(information, rf"cells +{report['cells']}\n")

    def test_the_boundary_is_listed(self):
        row = r"{} +{} +{} +\({}\) +\({}\)\n"
        top = row.format("patch_6", 16, 4, "1, 1, 2", "0, 0, 1")
        box = self.generate("box", "--cells", "2", "--refine", "1")
        run = self.run_command("extract", box, "-o", "a.msh", "--report", "a.json")
        self.assertRegex(run.stdout, top)
        self.assertRegex(run.stdout, "boundary +quads +area +centre +normal\n    patch_1 ")
        self.assertRegex(self.run_command("info", "a.msh").stdout, top)
        # What a mesh has in the file is what is listed, in JSON, too.
        for listed in (json.loads((self.folder / "a.json").read_text())["boundary"],
                       json.loads(self.run_command("info", "a.msh", "--json").stdout)["boundary"]):
            self.assertEqual([p["name"] for p in listed], [f"patch_{n}" for n in range(1, 7)])
            self.assertEqual(sum(p["quads"] for p in listed), 96)
            self.assertEqual(sum(p["area"] for p in listed), 24)
        # Twenty at most.
        ball = self.generate("sphere", "--cells", "12")
        lines = self.run_command("extract", ball, "-o", "b.msh", "--patch-angle", "0.5").stdout.splitlines()
        self.assertEqual(sum(line.startswith("    patch_") for line in lines), 20)
        self.assertEqual(sum(bool(re.match("    and +[0-9]+ more patches$", line)) for line in lines), 1)
        self.assertNotIn("patch", self.run_command("extract", ball, "-o", "c.vtu", "--stream").stdout)
        self.assertIn("excludes", self.run_command("info", "a.msh", "--pieces", "--patch-angle", "3",
                                                   expect=BAD_USAGE).stderr)

    def test_a_patch_angle_that_does_nothing_says_so(self):
        box, tagged = self.generate("box"), "tagged.vtu"
        self.run_command("generate", "box", "--features", "-o", tagged)
        for command, sentence in (
                (["extract", box, "-o", "a.msh"], ""), (["extract", box, "-o", "b.vtu"], "b.vtu holds no groups"),
                (["extract", tagged, "-o", "c.msh"], "are tagged"), (["convert", "b.vtu", "d.msh"], ""),
                (["extract", box, "-o", "e.vtu", "--stream"], "leave out --stream"),
                (["extract", box, "-o", "f.pvtu", "--parts", "2"], "leave out --stream and --parts"),
                (["convert", "b.vtu", "g.vtk"], "g.vtk holds no groups"), (["convert", box, "h.vtu"], "no quads"),
                (["improve", "b.vtu", "-o", "i.ovm"], "i.ovm holds no groups"),
                (["extract", box, "-o", "j.vtu", "--order", "2"], "j.vtu holds no groups"),
                (["convert", "j.vtu", "k.msh"], "")):
            told = self.run_command(*command, "--patch-angle", "30").stderr
            self.assertIn(sentence, told)
            self.assertEqual(told.count("--patch-angle does nothing here"), 1 if sentence else 0, command)
            self.assertNotIn("--patch-angle", self.run_command(*command).stderr)
        told = self.run_command("extract", box, "-o", "a.msh", "--patch-angle", "95").stderr
        self.assertIn("turns by more than 95 degrees", told)

    def test_groups_are_named_and_tags_split(self):
        def groups(*command):
            """Names of quads in the file that a command writes, and how many there are of each."""
            self.run_command(*command, "a.msh", "--format", "msh22-ascii")
            lines = (self.folder / "a.msh").read_text().splitlines()
            names = {line.split()[1]: line.split('"')[1] for line in lines if line.startswith("2 ") and '"' in line}
            quads = [line.split()[3] for line in lines if re.match(r"[0-9]+ 3 2 ", line)]
            return {name: quads.count(number) for number, name in names.items()}
        box, names = self.generate("box"), self.folder / "names.txt"
        names.write_text("# of the viewer\npatch_2 inlet\n\npatch_5 outlet # here\n")
        expected = {"patch_1": 64, "inlet": 64, "patch_3": 64, "patch_4": 64, "outlet": 64, "patch_6": 64}
        self.assertEqual(groups("extract", box, "--names", names, "-o"), expected)
        self.run_command("extract", box, "-o", "b.exo", "--order", "2", "--names", names)
        self.assertEqual(set(expected), set(re.findall("patch_[0-9]|inlet|outlet",
                                                       (self.folder / "b.exo").read_bytes().decode("latin-1"))))
        # All of the boundary under one name, then by smooth patches.
        self.assertEqual(groups("extract", box, "--patch-angle", "0", "-o"), {"boundary": 384})
        text = (self.folder / "a.msh").read_text().replace('"boundary"', '"wall"')
        (self.folder / "wall.msh").write_text(text)
        self.assertEqual(groups("convert", "wall.msh"), {"wall": 384})
        self.assertEqual(groups("convert", "wall.msh", "--split-tags"), {f"wall_{i}": 64 for i in range(1, 7)})
        names.write_text("wall_3 outlet\n")
        self.assertEqual(groups("convert", "wall.msh", "--split-tags", "--names", names)["outlet"], 64)
        told = self.run_command("convert", "wall.msh", "f.msh", "--names", names, expect=BAD_USAGE).stderr
        self.assertIn('no group of boundary quads has the name "wall_3". Groups: wall.', told)
        names.write_text("patch_1\n")
        told = self.run_command("extract", box, "-o", "f.msh", "--names", names, expect=BAD_USAGE).stderr
        self.assertIn("line 1: expected a name that a group has and a new one", told)
        self.run_command("extract", box, "-o", "f.vtu", "--stream", "--split-tags", expect=BAD_USAGE)

    def test_info_in_pieces(self):
        map_file = self.generate("sphere", "--jitter", "0.3")
        sums = set()
        for mesh in ["a.vtu", "a.mesh"]:
            self.run_command("extract", map_file, "-o", mesh)
            lines = self.run_command("info", mesh, "--pieces").stdout.splitlines()
            sums.add("\n".join(lines[1:]))
            self.assertRegex("\n".join(lines), r"(?s)cells +\d+\n.*checksum of cells +[0-9a-f]{16}\n")
        self.assertEqual(len(sums), 1)
        self.run_command("info", map_file, "--pieces", expect=FILE_PROBLEM)

    def test_generate_prints_the_answer_that_check_computes(self):
        answer = self.run_command("generate", "star", "-o", "map.hexex", "--valence", "7").stdout
        check = self.run_command("check", "map.hexex").stdout
        for label in ["cells", "boundary quads", "inner singular edges",
                      "boundary singular edges", "Euler characteristic"]:
            line = next(line for line in answer.splitlines() if line.strip().startswith(label))
            self.assertIn(line, check)
        self.assertIn("of valence 7", answer)

    def test_report(self):
        map_file = self.generate("sphere")
        for engine in ["atlas", "propeller"]:
            with self.subTest(engine=engine):
                self.run_command("extract", map_file, "-o", "a.vtu", "--report", "r.json",
                                 "--threads", "2", "--engine", engine)
                report = json.loads((self.folder / "r.json").read_text())
                self.assert_general_report(report, map_file)
                self.assertEqual(report["engine"], engine)
                self.assertEqual(report["charts"] > 0, engine == "atlas")
                self.assertEqual(report["global_propellers"] > 0, engine == "propeller")
                self.assertEqual(sum(report["quality"]["histogram"]), report["cells"])
                self.assertEqual(len(report["quality"]["histogram"]), 20)
                validity = report["validity"]
                self.assertEqual(validity["positive"], report["cells"])
                self.assertEqual((validity["refuted"], validity["undecided"]), (0, 0))
                self.assertEqual(validity["worst"], [])
                self.assertLessEqual(validity["minimum"], report["quality"]["minimum"])
                self.assertGreater(validity["minimum"], 0)
                self.assertFalse(report["streamed"])
                self.assertIsNone(report["checksums"])

    def assert_general_report(self, report, map_file):
        self.assertEqual(set(report), REPORT_KEYS)
        self.assertEqual(report["input"]["bytes"], (self.folder / map_file).stat().st_size)
        self.assertEqual(report["output"]["bytes"], (self.folder / "a.vtu").stat().st_size)
        # The build says whether it has oneTBB; without, there is one thread.
        self.assertEqual(report["threads"], int(os.environ.get("HEXHEX_TEST_THREADS", "2")))
        self.assertGreater(report["extract_seconds"], 0)
        self.assertGreater(report["peak_memory_bytes"], 1_000_000)
        self.assertAlmostEqual(sum(stage["share"] for stage in report["stages"]), 1, places=6)
        self.assertEqual(sum(report["vertices_by_generator"].values()), report["vertices"])

    def test_summary_names_an_engine_that_is_not_the_default(self):
        map_file = self.generate("box")
        for arguments, named in [([], False), (["--engine", "atlas"], False),
                                 (["--engine", "propeller"], True)]:
            text = self.run_command("extract", map_file, "-o", "a.vtu", *arguments).stdout
            self.assertEqual("engine" in text, named, text)

    def test_info_of_files_that_hold_a_map_or_a_mesh(self):
        for extension in ["ovm", "OVMB"]:
            map_file = self.generate("star", "--valence", "5", name=f"map.{extension}")
            self.run_command("extract", map_file, "-o", f"mesh.{extension}")
            information = self.run_command("info", map_file).stdout
            self.assertIn(f"{map_file}: a tetrahedral mesh with an integer-grid map\n", information)
            information = self.run_command("info", f"mesh.{extension}").stdout
            self.assertIn(f"mesh.{extension}: a hexahedral mesh\n", information)
        # A file that is neither is an error, not the other thing.
        self.write("map.ovm", (self.folder / "map.ovm").read_text()[:3000])
        self.assertIn("[FileSyntax", self.run_command("info", "map.ovm", expect=FILE_PROBLEM).stderr)

    def test_without_verification(self):
        map_file = self.generate("box")
        result = self.run_command("extract", map_file, "-o", "a.mesh", "--no-verify", "--report",
                                  "r.json")
        self.assertIn("skipped", result.stdout)
        self.assertIsNone(json.loads((self.folder / "r.json").read_text())["verification"])

    def test_same_bytes_with_any_number_of_threads(self):
        map_file = self.generate("torus", "--charts", "blocks", "--cells", "5")
        for extension in ["vtu", "mesh"]:
            for threads in [1, 2, 3]:
                self.run_command("extract", map_file, "-o", f"{threads}.{extension}",
                                 "--threads", threads, "--quiet")
            files = self.files()
            self.assertEqual(files[f"1.{extension}"], files[f"2.{extension}"])
            self.assertEqual(files[f"1.{extension}"], files[f"3.{extension}"])

    def test_scale(self):
        map_file = self.generate("cylinder", "--cells", "2")
        cells = []
        for scale in [1, 2]:
            self.run_command("extract", map_file, "-o", "a.vtu", "--scale", scale, "--report",
                             "r.json")
            self.run_command("verify", map_file, "a.vtu", "--scale", scale)
            cells.append(json.loads((self.folder / "r.json").read_text())["cells"])
        self.assertEqual(cells[1], 8 * cells[0])
        # The mesh at scale 2 does not agree with the map at scale 1.
        for scale in [1, 3]:
            result = self.run_command("verify", map_file, "a.vtu", "--scale", scale, expect=FAILURE)
            self.assertIn("FAILED", result.stdout)
            self.assertIn("\nThis looks like scale 2: try --scale 2.\n", result.stdout)
        other = self.generate("box", name="box.hexex")
        self.assertNotIn("looks like",
                         self.run_command("verify", other, "a.vtu", expect=FAILURE).stdout)

    def test_json_instead_of_text(self):
        map_file = self.generate("cylinder", "--cells", "2")
        self.run_command("extract", map_file, "-o", "a.vtu", "--scale", "2", "--quiet")

        def told(*arguments, expect=SUCCESS):
            result = self.run_command(*arguments, "--json", expect=expect)
            self.assertEqual(result.stderr, "")
            return json.loads(result.stdout)

        report = told("verify", map_file, "a.vtu", "--scale", "2")
        self.assertTrue(report["passed"])
        self.assertIsNone(report["likely_scale"])
        self.assertGreater(report["quality"]["minimum"], 0)
        report = told("verify", map_file, "a.vtu", expect=FAILURE)
        self.assertFalse(report["passed"])
        self.assertEqual((report["scale"], report["likely_scale"]), (1, 2))
        mesh, pieces, info = (told("info", "a.vtu"), told("info", "a.vtu", "--pieces"),
                              told("info", map_file))
        self.assertEqual((mesh["kind"], pieces["kind"], info["kind"]), ("mesh", "mesh", "map"))
        for key in ["cells", "vertices", "lower", "upper"]:
            self.assertEqual(mesh[key], pieces[key])
        self.assertEqual(mesh["validity"]["positive"], mesh["cells"])
        self.assertRegex(pieces["checksums"]["cells"], "^[0-9a-f]{16}$")
        self.assertEqual(told("check", map_file)["tets"], info["tets"])

    def test_report_on_the_standard_output(self):
        map_file = self.generate("box")
        result = self.run_command("extract", map_file, "-o", "a.vtu", "--report", "-")
        self.assertEqual(json.loads(result.stdout).keys(), REPORT_KEYS)
        self.assertEqual(set(self.files()), {"map.hexex", "a.vtu"})
        result = self.run_command("repair", map_file, "-o", "b.hexex", "--report", "-", "--quiet",
                                  expect=None)
        if result.returncode == SUCCESS:
            self.assertIsNone(json.loads(result.stdout))  # nothing was to be repaired

    def test_verify_says_what_is_no_mesh(self):
        self.generate("box", "--cells", "1")
        self.run_command("extract", "map.hexex", "-o", "right.mesh", "--quiet")
        lines = (self.folder / "right.mesh").read_text().splitlines()

        def section(name):
            begin = lines.index(name) + 2
            return [" ".join(line.split()[:-1]) for line in lines[begin:begin + int(lines[begin - 1])]]

        points, cells = section("Vertices"), section("Hexahedra")
        self.assertEqual((len(points), len(cells)), (27, 8))

        def verify(points, cells, expect=FAILURE):
            text = ["MeshVersionFormatted 2", "Dimension 3", f"Vertices {len(points)}", *(f"{p} 0" for p in points),
                    f"Hexahedra {len(cells)}", *(f"{c} 0" for c in cells), "End"]
            self.write("a.mesh", "\n".join(text) + "\n")
            return self.run_command("verify", "map.hexex", "a.mesh", expect=expect)

        verify(points, cells, SUCCESS)
        first = cells[0].split()
        for corners in ("1 1 1 1 1 1 1 1", "1 2 3 4 1 2 3 4", " ".join(first[4:] + first[:4])):
            self.assertIn("wrong_cells", verify(points, [corners] + cells[1:]).stdout)
            verify(points, [corners] * 8)
        verify(points, cells * 100)
        for point in ("5 5 5", "1e308 -1e308 0"):
            self.assertIn("vertices_off_lattice", verify([point] + points[1:], cells).stdout)
        for corner in ("0", "28", "4294967295", "-1"):
            corners = " ".join(first[:7] + [corner])
            self.assertIn("line", verify(points, [corners] + cells[1:], FILE_PROBLEM).stderr)
        # Whether a file says so or its mesh is refused.
        for arguments in [(points, []), ([], []), (["nan 0 0"] + points[1:], cells)]:
            self.assertIn(verify(*arguments, expect=None).returncode, (FAILURE, FILE_PROBLEM))

    def test_verify_takes_memory_for_its_mesh_alone(self):
        self.skip_if_sanitized()
        self.generate("box", "--cells", "1", name="box.hexex")
        self.run_command("extract", "box.hexex", "-o", "million.vtu", "--scale", "50", "--no-verify", "--quiet")
        size = (self.folder / "million.vtu").stat().st_size

        def peak(*arguments):
            run = subprocess.Popen([self.command, "verify", *arguments, "--quiet"], cwd=self.folder)
            _, status, usage = os.wait4(run.pid, 0)
            run.returncode = os.waitstatus_to_exitcode(status)
            self.assertEqual(run.returncode, FAILURE)
            return 1024 * usage.ru_maxrss

        # A mesh 125,000 times too large, of a million cells, and one that is as much too small.
        self.assertLess(peak("box.hexex", "million.vtu"), 5 * size + 50e6)
        self.run_command("extract", "box.hexex", "-o", "box.vtu", "--quiet")
        self.assertLess(peak("box.hexex", "box.vtu", "--scale", "50"), 50e6)

    def test_quiet_is_silent(self):
        map_file = self.generate("box")
        for arguments in [["generate", "box", "-o", "b.hexex"], ["check", map_file],
                          ["extract", map_file, "-o", "a.vtu"], ["verify", map_file, "a.vtu"]]:
            result = self.run_command(*arguments, "--quiet")
            self.assertEqual(result.stdout + result.stderr, "")

    def test_pipes_get_stages_only_if_asked(self):
        map_file = self.generate("box")
        self.assertEqual(self.run_command("extract", map_file, "-o", "a.vtu").stderr, "")
        result = self.run_command("extract", map_file, "-o", "a.vtu", "--verbose")
        lines = result.stderr.splitlines()
        self.assertIn("hexhex: read map", lines)
        self.assertIn("hexhex: write mesh", lines)
        self.assertEqual(len(lines), len(set(lines)))
        self.assertTrue(all(line.startswith("hexhex: ") for line in lines), lines)

    def on_terminal(self, *arguments, pauses=0):
        """What a run writes to its standard error output, a terminal, if it sleeps now and then."""
        ours, its = pty.openpty()
        with subprocess.Popen([self.command, *arguments], cwd=self.folder, stderr=its,
                              stdout=subprocess.DEVNULL) as process:
            os.close(its)
            for _ in range(pauses):
                time.sleep(0.1)
                process.send_signal(signal.SIGSTOP)
                time.sleep(0.5)
                process.send_signal(signal.SIGCONT)
            written = b""
            try:
                while piece := os.read(ours, 1 << 16):
                    written += piece
            except OSError:  # how a terminal ends
                pass
            os.close(ours)
        self.assertEqual(process.returncode, SUCCESS, written)
        return written.decode()

    def test_one_bar_that_never_goes_back(self):
        map_file = self.generate_for_seconds()
        text = self.on_terminal("extract", map_file, "-o", "a.vtu", "--scale", "2", pauses=4)
        shares = [int(share) for share in re.findall(r"(\d+) %", text)]
        self.assertGreater(len(shares), 0)
        self.assertEqual(shares, sorted(shares))
        self.assertLessEqual(shares[-1], 100)
        self.assertRegex(text, r"\[#* *\] +\d+ % +(\d+ (s|min|h) left)?")
        self.assertTrue(text.endswith("\r\x1b[K"), text[-80:])  # nothing is left of it
        self.assertNotIn("\n", text)

    def test_terminal_gets_no_bar_with_quiet_or_for_short_runs(self):
        map_file = self.generate("box")
        for arguments in [["--quiet"], []]:
            begin = time.monotonic()
            text = self.on_terminal("extract", map_file, "-o", "a.vtu", *arguments)
            if arguments or time.monotonic() - begin < 1:
                self.assertEqual(text, "")

    def test_summary_tells_the_time_of_each_part(self):
        map_file = self.generate("box")
        text = self.run_command("extract", map_file, "-o", "a.vtu", "--report", "r.json").stdout
        parts = ["reading", "extraction", "verification", "quality", "writing"]
        self.assertRegex(text, r"\n  time +\d+\.\d\d s: " + ", ".join(part + r" \d+\.\d\d"
                                                                    for part in parts) + r"\n")
        report = json.loads((self.folder / "r.json").read_text())
        self.assertEqual(list(report["seconds"]), parts)
        self.assertTrue(all(seconds >= 0 for seconds in report["seconds"].values()))
        text = self.run_command("extract", map_file, "-o", "a.vtu", "--stream").stdout
        self.assertRegex(text, r"\n  time +\S+ s: reading \S+, extraction and writing \S+\n")

    def test_nothing_but_the_outputs_is_left(self):
        map_file = self.generate("box")
        self.run_command("extract", map_file, "-o", "a.vtu", "--report", "r.json")
        self.assertEqual(set(self.files()), {"map.hexex", "a.vtu", "r.json"})


class Repair(CommandTest):
    def damaged(self, *options):
        return self.generate("sphere", "--refine", "4", "--defects", "5", *options)

    def can_repair(self):
        """Whether the command was built with the solver; one that was not says so."""
        map_file = self.damaged()
        result = subprocess.run([self.command, "repair", map_file, "-o", "probe.hexex", "--quiet"],
                                cwd=self.folder, text=True, capture_output=True, check=False)
        (self.folder / "probe.hexex").unlink(missing_ok=True)
        if result.returncode == SUCCESS:
            return True
        self.assertEqual(result.returncode, INVALID_MAP)
        self.assertIn("libeigen3-dev", result.stderr)
        extraction = subprocess.run([self.command, "extract", map_file, "-o", "probe.vtu"],
                                    cwd=self.folder, text=True, capture_output=True, check=False)
        self.assertEqual(extraction.returncode, INVALID_MAP)
        self.assertIn("libeigen3-dev", extraction.stderr)
        return False

    def test_extract_repairs_with_a_notice(self):
        if not self.can_repair():
            self.skipTest("built without Eigen")
        for kind in ["interior", "singular", "boundary", "sliver"]:
            map_file = self.damaged("--defect-kind", kind)
            self.run_command("check", map_file, "--quiet", expect=INVALID_MAP)
            run = self.run_command("extract", map_file, "-o", "mesh.vtu", "--report", "r.json")
            self.assertIn("It was repaired", run.stderr)
            report = json.loads((self.folder / "r.json").read_text())
            self.assertGreaterEqual(report["repair"]["bad_tets"], 1)
            self.assertEqual(len(report["repair"]["regions"]), 1)
            self.assertTrue(report["verification"]["passed"])
            self.assert_fails("extract", map_file, "-o", "off.vtu", "--repair", "off",
                              expect=INVALID_MAP, code="FlippedTet")
            self.run_command("extract", map_file, "-o", "s.vtu", "--stream", "--quiet")

    def test_repair_writes_a_valid_map(self):
        if not self.can_repair():
            self.skipTest("built without Eigen")
        map_file = self.damaged()
        run = self.run_command("repair", map_file, "-o", "repaired.hexex", "--report", "r.json")
        self.assertIn("It was repaired", run.stdout)
        self.run_command("check", "repaired.hexex", "--quiet")
        self.assertGreater(json.loads((self.folder / "r.json").read_text())["moved_vertices"], 0)
        self.run_command("repair", "repaired.hexex", "-o", "same.hexex", "--report", "n.json")
        self.assertEqual((self.folder / "same.hexex").read_bytes(),
                         (self.folder / "repaired.hexex").read_bytes())
        self.assertIsNone(json.loads((self.folder / "n.json").read_text()))
        for options in [["-o", map_file], ["-o", "x.hexex", "--report", map_file],
                        ["-o", "x.hexex", "--report", "x.hexex"]]:
            self.assert_fails("repair", map_file, *options, expect=BAD_USAGE,
                              code="InvalidArgument")

    def test_repair_follows_higher_orders_and_arcs(self):
        if not self.can_repair():
            self.skipTest("built without Eigen")
        map_file = self.damaged()
        run = self.run_command("extract", map_file, "-o", "curved.vtu", "--order", "2")
        self.assertIn("It was repaired", run.stderr)
        self.run_command("extract", map_file, "-o", "mesh.vtu", "--arcs", "arcs.vtu", "--quiet")

    def in_other_units(self, map_file, factor, name):
        """The same map with its parameters multiplied."""
        lines = (self.folder / map_file).read_text().split("\n")
        points = int(lines[0])
        tets = int(lines[points + 1])
        for i in range(points + 2, points + 2 + tets):
            words = lines[i].split()
            parameters = [repr(float(word) * factor) for word in words[4:]]
            lines[i] = " ".join(words[:4] + parameters)
        return self.write(name, "\n".join(lines))

    def test_first_line_of_check_says_what_a_map_is(self):
        def first_line(map_file, expect=INVALID_MAP):
            return self.run_command("check", map_file, expect=expect).stdout.split("\n")[0]

        valid = self.generate("sphere", "--charts", "blocks")
        self.assertEqual(first_line(valid, SUCCESS), "The map is valid.")
        self.generate("sphere", "--defects", "3", name="defective.hexex")
        self.assertRegex(first_line("defective.hexex"), r"^The map is defective: \d+ kinds? of defects?\.$")
        if "cannot quantize" in self.run_command("quantize", valid, "-o", "x.hexex", "--cells",
                                                 "500", expect=None).stderr:
            self.skipTest("built without Eigen")
        for factor, inverse in [(0.25, "4"), (1 / 3, "3"), (0.4, "2.5"), (10 / 7, "0.7")]:
            scaled = self.in_other_units(valid, factor, "scaled.hexex")
            self.assertEqual(
                first_line(scaled),
                f"The map is integer up to a scale: multiply its parameters by {inverse}, as `hexhex "
                f"quantize scaled.hexex -o integer.hexex --scale {inverse}` does.")
            # What it says, it can do.
            self.run_command("quantize", scaled, "-o", "integer.hexex", "--scale", inverse, "--quiet")
            self.assertIn("  cells                     448\n",
                          self.run_command("check", "integer.hexex").stdout)
            found = json.loads(self.run_command("check", scaled, "--json", expect=INVALID_MAP).stdout)
            self.assertEqual(found["kind"], "integer up to a scale")
            self.assertAlmostEqual(found["integer_factor"], float(inverse))
        self.generate("sphere", "--stretch", "0.5", "--charts", "random", name="seamless.hexex")
        text = self.run_command("check", "seamless.hexex", expect=INVALID_MAP).stdout
        self.assertTrue(text.startswith("The map is seamless"), text)
        self.assertNotIn("OffLattice", text)

    def test_map_and_mesh(self):
        """From tets alone; a mesh is certified, or not written."""
        self.run_command("generate", "box", "--cells", "2", "--refine", "2", "-o", "part.hexex", "--quiet")
        if "cannot make maps" in self.run_command("map", "part.hexex", "-o", "shaped.hexex", expect=None).stderr:
            self.skipTest("built without quantization")
        self.run_command("quantize", "shaped.hexex", "-o", "integer.hexex", "--cells", "100")
        run = self.run_command("mesh", "part.hexex", "-o", "part.vtu", "--cells", "100", "--method", "polycube",
                               "--keep-map", "kept.hexex", "--report", "part.json")
        self.assertIn("certified positive everywhere", run.stdout)
        self.assertIn("6 faces, 8 corners", run.stdout)
        report = json.loads((self.folder / "part.json").read_text())
        self.assertTrue(report["map"]["labels"]["valid"])
        self.assertEqual(report["map"]["tagged_edges"], report["map"]["feature_edges"])
        self.assertEqual(report["improvement"]["not_positive"], [])
        self.run_command("verify", "kept.hexex", "part.vtu")
        self.run_command("quantize", "--tets", "part.hexex", "--flags", "auto", "-o", "auto.hexex", "--cells", "100")
        self.run_command("mesh", "part.hexex", "-o", "bad.vtu", "--method", "magic", expect=BAD_USAGE)
        # A ball of a few cells is far from round.
        self.run_command("generate", "sphere", "--refine", "3", "-o", "ball.hexex", "--quiet")
        run = self.run_command("mesh", "ball.hexex", "-o", "ball.vtu", "--cells", "8", "--method", "polycube")
        self.assertIn("of the diagonal from the part: small features", run.stderr)
        # What both ways say is in the report; what is no solid leaves nothing behind.
        run = self.run_command("mesh", "part.hexex", "-o", "best.vtu", "--cells", "100", "--report", "best.json")
        self.assertIn("no other way was needed", run.stdout)
        report = json.loads((self.folder / "best.json").read_text())
        self.assertEqual([way["method"] for way in report["ways"]], ["polycube", "frames"])
        self.assertTrue(report["ways"][0]["certified"])
        self.assertIn("polycube: scaled Jacobian", report["why"])
        flat = (self.folder / "part.hexex").read_text().splitlines()
        count = int(flat[0])
        flat[1:count + 1] = [line.rsplit(maxsplit=1)[0] + " 0" for line in flat[1:count + 1]]
        (self.folder / "flat.hexex").write_text("\n".join(flat))
        for command in "mesh", "map":
            cells = ["--cells", "100"] if command == "mesh" else []
            self.assert_fails(command, "flat.hexex", "-o", "bad.hexex" if command == "map" else "bad.vtu", *cells,
                              expect=INVALID_MAP, code="FlippedTet")
        self.assertEqual(list(self.folder.glob("bad*")), [])

    def test_page_of_a_part_without_a_mesh(self):
        """A tet with a long spike on each face has no frame field with a mesh."""
        points = ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, -2), (1, -2, 1), (1, 1, 1), (-2, 1, 1))
        tets = ((0, 1, 2, 3), (0, 2, 1, 4), (0, 1, 3, 5), (1, 2, 3, 6), (0, 3, 2, 7))
        for name, first, rows in (("node", "8 3 0 0", points), ("ele", "5 4 0", tets)):
            lines = [" ".join(map(str, (number, *row))) for number, row in enumerate(rows)]
            (self.folder / f"star.{name}").write_text("\n".join([first, *lines, ""]))
        arguments = ["mesh", "star.ele", "-o", "star.vtu", "--cells", "100", "--method", "frames"]
        run = self.run_command(*arguments, "--view", "star.html", expect=None)
        if "cannot make maps" in run.stderr or "without the viewer page" in run.stderr:
            self.skipTest("built without quantization or viewer")
        self.assertEqual(run.returncode, INVALID_MAP)
        self.assertIn("star.html shows where", run.stderr)
        self.assertIn("[NotMeshable, edge", run.stderr)
        self.assertIn('"start":{"colour":"region"', (self.folder / "star.html").read_text())
        self.assertFalse((self.folder / "star.vtu").exists())
        # The page is less important than the reason.
        run = self.run_command(*arguments, "--view", "/dev/full", expect=INVALID_MAP)
        self.assertIn("There is no page: ", run.stderr)
        self.assertIn("[NotMeshable, edge", run.stderr)

    def test_maps_along_frames_are_seamless(self):
        """Not so where all tets are positive, but go around an edge twice."""
        part = pathlib.Path(__file__).parents[2] / "examples" / "bracket.mesh"
        if self.sanitized:
            part = self.write("part.mesh", POLYCUBE)
        run = self.run_command("map", str(part), "-o", "frames.hexex", "--method", "frames", expect=None)
        if "cannot make maps" in run.stderr:
            self.skipTest("built without quantization")
        if run.returncode == SUCCESS:
            self.run_command("quantize", "frames.hexex", "-o", "integer.hexex", "--cells", "500")
        else:
            self.assertIn("[NotMeshable", run.stderr)

    def test_quantize(self):
        self.run_command("generate", "sphere", "--stretch", "0.5", "--charts", "random", "--quiet",
                         "-o", "seamless.hexex")
        if "cannot quantize" in self.run_command("quantize", "seamless.hexex", "-o", "x.hexex",
                                                 "--cells", "500", expect=None).stderr:
            self.skipTest("built without Eigen")
        # What the other commands say of it.
        run = self.run_command("check", "seamless.hexex", expect=INVALID_MAP)
        self.assertIn("The map is seamless", run.stdout)
        run = self.run_command("check", "seamless.hexex", "--json", expect=INVALID_MAP)
        self.assertEqual(json.loads(run.stdout)["kind"], "seamless")
        run = self.run_command("extract", "seamless.hexex", "-o", "m.vtu", expect=INVALID_MAP)
        self.assertIn("hexhex quantize seamless.hexex", run.stderr)
        # In two steps and in one.
        run = self.run_command("quantize", "seamless.hexex", "-o", "integer.hexex", "--cells", "500",
                               "--report", "q.json")
        report = json.loads((self.folder / "q.json").read_text())
        self.assertIn(f"{report['cells']} cells of 500 asked for", run.stdout)
        self.run_command("check", "integer.hexex", "--tolerance", "0", "--quiet")
        self.run_command("extract", "integer.hexex", "-o", "two.vtu", "--quiet")
        self.run_command("extract", "seamless.hexex", "-o", "one.vtu", "--quantize", "--cells", "500",
                         "--report", "r.json")
        self.assertEqual((self.folder / "one.vtu").read_bytes(), (self.folder / "two.vtu").read_bytes())
        self.assertEqual(json.loads((self.folder / "r.json").read_text())["quantization"]["cells"],
                         report["cells"])
        for options in [[], ["--cells", "0"], ["--cells", "5", "--scale", "1"], ["--cells", "x"]]:
            self.run_command("quantize", "seamless.hexex", "-o", "bad.hexex", *options, expect=BAD_USAGE)
        self.assert_fails("quantize", "seamless.hexex", "-o", "bad.hexex", "--cells", "1e12",
                          expect=INVALID_MAP, code="TooLarge")
        self.run_command("extract", "seamless.hexex", "-o", "bad.vtu", "--cells", "5", expect=BAD_USAGE)
        # Maps that it cannot take.
        self.run_command("generate", "sphere", "--refine", "6", "--cells", "8", "--defects", "5", "--quiet",
                         "-o", "flipped.hexex")
        self.run_command("generate", "sphere", "--noise", "0.005", "--quiet", "-o", "noisy.hexex")
        for map, code in ("flipped.hexex", "FlippedTet"), ("noisy.hexex", "TransitionResidual"):
            for densify in [], ["--densify"]:
                self.assert_fails("quantize", map, "-o", "bad.hexex", "--cells", "500", *densify,
                                  expect=INVALID_MAP, code=code)
                self.assert_fails("extract", map, "-o", "bad.vtu", "--quantize", "--cells", "500", *densify,
                                  expect=INVALID_MAP, code=code)
        # What works is not made denser.
        self.run_command("quantize", "seamless.hexex", "-o", "same.hexex", "--cells", "500", "--densify",
                         "--quiet")
        self.assertEqual((self.folder / "same.hexex").read_bytes(), (self.folder / "integer.hexex").read_bytes())
        self.assertEqual(list(self.folder.glob("bad*")), [])

    def test_walls_of_published_maps(self):
        # Walls in the middle of a box, and all of its boundary among walls and among features.
        self.generate("box", "--features", name="box.hexex")
        lines = (self.folder / "box.hexex").read_text().splitlines()
        points = int(lines[0])
        end = points + 2 + int(lines[points + 1])
        at_tets = {}
        for tet in lines[points + 2:end]:
            corners = sorted(map(int, tet.split()[:4]))
            for left in range(4):
                face = tuple(corners[:left] + corners[left + 1:])
                at_tets[face] = at_tets.get(face, 0) + 1
        walls = [face for face, count in at_tets.items()
                 if count == 1 or all(float(lines[1 + v].split()[0]) == 1 for v in face)]
        text = [str(len(walls))] + [f"{a} {b} {c} 0.5" for a, b, c in walls]
        published = self.write("published.hexex", "\n".join(lines[:end] + text + lines[end:]) + "\n")

        def groups(*options):
            run = self.run_command("extract", published, "-o", "box.inp", *options)
            found = re.findall(r"\*SURFACE.*NAME=(\w+)", (self.folder / "box.inp").read_text())
            return re.search(r"(\d+) quads", run.stdout)[1], found

        patches = [f"S_PATCH_{i}" for i in range(1, 7)]
        self.assertEqual(groups(), ("0", patches))
        self.assertEqual(groups("--keep-walls"), ("64", patches))
        self.run_command("convert", published, "kept.vtu", "--keep-walls", "--quiet")
        self.assertIn(b"feature_triangles", (self.folder / "kept.vtu").read_bytes())
        self.run_command("convert", published, "box.vtu", "--quiet")
        self.assertNotIn(b"feature_triangles", (self.folder / "box.vtu").read_bytes())
        self.run_command("extract", "--tets", "a.mesh", "--polycube", "b.mesh", "-o", "c.vtu", "--keep-walls",
                         expect=BAD_USAGE)

    @staticmethod
    def bar(vertex_references, cells, corners=""):
        """Unit cubes in a row, as text of a `.mesh` file."""
        points = [(x, y, z) for x in range(5) for y in (0, 1) for z in (0, 1)]
        return ("MeshVersionFormatted 1\nDimension 3\nVertices\n20\n"
                + "".join(f"{x} {y} {z} {r}\n" for (x, y, z), r in zip(points, vertex_references))
                + f"Hexahedra\n{len(cells)}\n"
                + "".join(" ".join(str(v + 1) for v in cell) + " 0\n" for cell in cells) + corners + "End\n")

    def test_cells_that_list_their_corners_wrongly(self):
        sound = [[4 * i + k for k in (0, 4, 6, 2, 1, 5, 7, 3)] for i in range(4)]
        one = [*sound[:2], sound[2][4:] + sound[2][:4], sound[3]]
        every = [cell[4:] + cell[:4] for cell in sound]
        prism = [*sound[:3], [12, 16, 16, 14, 13, 17, 17, 15]]
        for name, cells in [("sound", sound), ("one", one), ("all", every), ("prism", prism)]:
            self.write(f"{name}.mesh", self.bar([0] * 20, cells))
        told = {name: self.run_command("info", f"{name}.mesh").stdout for name in ("sound", "one", "all", "prism")}
        for word in ("orientation", "repeated", "direction"):
            self.assertNotIn(word, told["sound"])
        self.assertIn("1 cell mirrored; the first is cell 2;", told["one"])
        self.assertRegex(told["one"], r"in the same direction +2 faces; the first is \(8, 10, 11, 9\), of cells 1 and 2")
        self.assertRegex(told["all"], r"orientation +the mesh is mirrored; `hexhex convert --reorient` reorients it")
        self.assertIn("1 cell names a vertex twice; the first is cell 3", told["prism"])
        faults = json.loads(self.run_command("info", "one.mesh", "--json").stdout)["faults"]
        self.assertEqual(faults, {"repeated_corners": [], "mirrored": [2], "not_orientable": None,
                                  "faces_in_the_same_direction": 2, "overfull_faces": 0})
        for name, code in [("one", "Orientation"), ("all", "Orientation"), ("prism", "RepeatedVertex")]:
            self.assert_fails("improve", f"{name}.mesh", "-o", "bad.vtu", expect=INVALID_MAP, code=code)
        for name in ("one", "all"):
            run = self.run_command("convert", f"{name}.mesh", f"{name}.vtu", "--reorient")
            self.assertIn("1 of them reoriented" if name == "one" else "4 of them reoriented", run.stdout)
            self.assertIn("certified positive everywhere", self.run_command("info", f"{name}.vtu").stdout)
            self.run_command("improve", f"{name}.vtu", "-o", "good.vtu", "--quiet")
        self.assert_fails("convert", "one.mesh", "bad.vtu", "--reorient", "--stream", expect=BAD_USAGE,
                          code="InvalidArgument")
        self.run_command("generate", "box", "--quiet", "-o", "map.hexex")
        self.assert_fails("convert", "map.hexex", "bad.vtu", "--reorient", expect=BAD_USAGE,
                          code="InvalidArgument")
        self.assertFalse((self.folder / "bad.vtu").exists())

    def test_improve_says_which_vertices_it_holds(self):
        cells = [[4 * i + k for k in (0, 4, 6, 2, 1, 5, 7, 3)] for i in range(4)]
        for references, corners, line in [
                ([-1] * 20, "", "0 free, 0 on the surface, 12 on curves, 8 held: 8 at corners"),
                ([0] * 8 + [5] + [0] * 11, "", "0 free, 0 on the surface, 11 on curves, 9 held: 8 at corners, 1 with a tag"),
                ([7] * 20, "Corners\n2\n9 10\n",
                 "0 free, 0 on the surface, 10 on curves, 10 held: 8 at corners, 2 with a tag")]:
            self.write("bar.mesh", self.bar(references, cells, corners))
            run = self.run_command("improve", "bar.mesh", "-o", "better.vtu")
            self.assertIn(f"{line}\n", run.stdout)
        run = self.run_command("improve", "bar.mesh", "-o", "better.vtu", "--fix-boundary")
        self.assertIn("20 held: 8 at corners, 2 with a tag, 10 on the boundary\n", run.stdout)

    def write_sheared_layers(self):
        """Three layers of cells between a refined side and an even one."""
        side, layers = 13, 4
        points = [(12 * ((1 - k / 3) * (i / 12) ** 3 + k / 3 * i / 12), j, 0.2 * k)
                  for k in range(layers) for j in range(5) for i in range(side)]
        corner = lambda i, j, k: 1 + i + side * (j + 5 * k)
        ring = ((0, 0), (1, 0), (1, 1), (0, 1))
        cells = [[corner(i + x, j + y, k + z) for z in (0, 1) for x, y in ring]
                 for k in range(layers - 1) for j in range(4) for i in range(side - 1)]
        lines = ["MeshVersionFormatted 2", "Dimension 3", "Vertices", str(len(points))]
        lines += [" ".join(map(str, point)) + " 0" for point in points]
        lines += ["Hexahedra", str(len(cells))] + [" ".join(map(str, cell)) + " 0" for cell in cells] + ["End"]
        (self.folder / "sheared.mesh").write_text("\n".join(lines))
        return "sheared.mesh"

    def test_improve_on_a_surface(self):
        self.run_command("generate", "box", "--cells", "3", "-o", "box.hexex", "--quiet")
        self.run_command("extract", "box.hexex", "-o", "box.vtu", "--quiet")
        count, *lines = (self.folder / "box.hexex").read_text().splitlines()
        points = [[float(x) for x in line.split()] for line in lines[:int(count)]]
        ends = [(min(axis) - 0.05, max(axis) + 0.05) for axis in zip(*points)]  # around the box
        corners = [[ends[k][i >> k & 1] for k in range(3)] for i in range(8)]
        quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
        lines = ["v {} {} {}".format(*corner) for corner in corners]
        lines += ["f {} {} {} {}".format(*(v + 1 for v in quad)) for quad in quads]
        (self.folder / "part.obj").write_text("\n".join(lines) + "\n")
        run = self.run_command("improve", "box.vtu", "--surface", "part.obj", "-o", "on.vtu", "--report", "i.json")
        self.assertRegex(run.stdout, "worst held by +cell [0-9]+ at vertex [0-9]+: ")
        report = json.loads((self.folder / "i.json").read_text())
        self.assertGreater(report["distance_before"]["hausdorff"], 5e-3)
        self.assertLess(report["distance_after"]["hausdorff"], 1e-9)
        self.assertIn(report["worst_cell"]["held_by"], ("corner", "curve", "surface", "neighbours"))
        self.assertEqual(report["cannot_be_positive"], [])
        # The boundary of tets is a surface, too.
        self.run_command("improve", "on.vtu", "--surface", "box.hexex", "-o", "back.vtu", "--report", "b.json", "--quiet")
        self.assertLess(json.loads((self.folder / "b.json").read_text())["distance_after"]["hausdorff"], 1e-9)
        self.assert_fails("improve", "box.vtu", "--surface", "part.obj", "--map", "box.hexex", "-o", "bad.vtu",
                          expect=BAD_USAGE)

    def test_improve_adds_a_pillow(self):
        self.run_command("generate", "box", "--cells", "2", "--quiet", "-o", "map.hexex")
        run = self.run_command("extract", "map.hexex", "-o", "one.vtu", "--improve", "--pillow", "always",
                               "--report", "r.json")
        self.assertIn("96 cells added under the boundary, 160 in all", run.stdout)
        report = json.loads((self.folder / "r.json").read_text())
        self.assertEqual((report["cells"], report["improvement"]["added_cells"]), (160, 96))
        # The mesh, which the map does not imply any more, can still be improved on its surface.
        self.run_command("improve", "one.vtu", "--map", "map.hexex", "-o", "two.vtu", "--report", "i.json", "--quiet")
        self.assertEqual(json.loads((self.folder / "i.json").read_text())["added_cells"], 0)
        self.run_command("extract", "map.hexex", "-o", "plain.vtu", "--quiet")
        run = self.run_command("improve", "plain.vtu", "--map", "map.hexex", "-o", "same.vtu", "--pillow", "auto")
        self.assertNotIn("pillow", run.stdout)
        self.run_command("improve", "plain.vtu", "-o", "bad.vtu", "--pillow", "maybe", expect=BAD_USAGE)
        self.assert_fails("extract", "map.hexex", "-o", "bad.vtu", "--improve", "--order", "2", "--pillow", "auto",
                          expect=BAD_USAGE, code="InvalidArgument", words=["--pillow adds straight cells"])

    def test_improve(self):
        self.generate("torus", "--jitter", "0.9", "--cells", "1" if self.sanitized else "2")
        run = self.run_command("extract", "map.hexex", "-o", "rough.vtu", "--scale", "2")
        self.assertRegex(run.stderr, "not positive everywhere.*--improve makes such cells positive")
        # With the map, in two steps and in one; without it.
        run = self.run_command("improve", "rough.vtu", "--map", "map.hexex", "-o", "two.vtu", "--report", "i.json")
        self.assertIn("certified positive everywhere", run.stdout)
        report = json.loads((self.folder / "i.json").read_text())
        self.assertEqual(report["not_positive"], [])
        self.assertGreaterEqual(report["after"]["quality"]["minimum"], report["before"]["quality"]["minimum"])
        self.assertGreater(report["moved_vertices"], 0)
        self.run_command("extract", "map.hexex", "-o", "one.vtu", "--scale", "2", "--improve", "--report", "r.json")
        self.assertEqual((self.folder / "one.vtu").read_bytes(), (self.folder / "two.vtu").read_bytes())
        extraction = json.loads((self.folder / "r.json").read_text())
        self.assertEqual(extraction["improvement"]["moved_vertices"], report["moved_vertices"])
        self.assertEqual(extraction["quality"], report["after"]["quality"])
        self.run_command("improve", "two.vtu", "-o", "own.mesh", "--fix-boundary", "--passes", "0", "--quiet")
        # The map of another object.
        self.run_command("generate", "sphere", "--cells", "3", "--quiet", "-o", "sphere.hexex")
        self.run_command("extract", "sphere.hexex", "-o", "sphere.vtu", "--quiet")
        self.assert_fails("improve", "sphere.vtu", "--map", "map.hexex", "-o", "bad.vtu", expect=BAD_USAGE,
                          code="InvalidArgument", words=["is not where the map is"])
        # Cells that are sheared for good: the mean falls for them, and that is said.
        self.run_command("convert", self.write_sheared_layers(), "sheared.vtu", "--quiet")
        run = self.run_command("improve", "sheared.vtu", "-o", "worse.vtu", "--fix-boundary", "--passes", "0")
        self.assertRegex(run.stderr, r"mean scaled Jacobian fell from 0\.21\d+ to 0\.19\d+")
        run = self.run_command("improve", "two.vtu", "-o", "three.vtu")
        self.assertNotIn("fell", run.stderr)
        # Formats that do not tell generators, options out of range, names that are the same.
        self.run_command("convert", "rough.vtu", "rough.mesh", "--quiet")
        self.assert_fails("improve", "rough.mesh", "--map", "map.hexex", "-o", "bad.vtu", expect=BAD_USAGE,
                          code="InvalidArgument")
        self.assert_fails("improve", "rough.vtu", "-o", "rough.vtu", expect=BAD_USAGE, code="InvalidArgument")
        for options in [["--target", "2"], ["--passes", "-1"], ["--slack", "x"], ["--feature-angle", "181"]]:
            self.run_command("improve", "rough.vtu", "-o", "bad.vtu", *options, expect=BAD_USAGE)
        for options in [["--stream"], ["--order", "4"], ["--partial"], ["--arcs", "arcs.vtu"]]:
            self.assert_fails("extract", "map.hexex", "-o", "bad.vtu", "--improve", *options, expect=BAD_USAGE,
                              code="InvalidArgument")
        # Curved cells, in two steps and in one.
        self.run_command("generate", "sphere", "--jitter", "0.5", "--cells", "1", "--quiet", "-o", "ball.hexex")
        curved = ["--order", "2", "--curved", "exact", "--quiet"]
        self.run_command("extract", "ball.hexex", "-o", "curved.vtu", *curved)
        self.run_command("extract", "ball.hexex", "-o", "one.vtu", "--improve", "--passes", "1", *curved)
        run = self.run_command("improve", "curved.vtu", "--map", "ball.hexex", "--passes", "1", "-o", "two.vtu")
        self.assertIn("untangled", run.stdout)
        self.assertEqual((self.folder / "one.vtu").read_bytes(), (self.folder / "two.vtu").read_bytes())
        self.assertNotEqual((self.folder / "one.vtu").read_bytes(), (self.folder / "curved.vtu").read_bytes())
        self.assert_fails("improve", "curved.vtu", "-o", "bad.vtu", "--compress", expect=BAD_USAGE,
                          code="InvalidArgument")
        self.run_command("extract", "map.hexex", "-o", "bad.vtu", "--target", "0.5", expect=BAD_USAGE)
        self.assertFalse((self.folder / "bad.vtu").exists())

    def test_partial(self):
        map_file = self.damaged()
        run = self.run_command("extract", map_file, "-o", "part.vtu", "--repair", "off",
                               "--partial", "--report", "part.json", expect=INVALID_MAP)
        self.assertIn("[FlippedTet", run.stderr)
        self.assertIn("hole at tet", run.stdout)
        self.assertIn(b'Name="region"', (self.folder / "part.vtu").read_bytes())
        self.run_command("info", "part.vtu")
        report = json.loads((self.folder / "part.json").read_text())
        self.assertTrue(report["partial"])
        self.assertEqual(report["error"]["code"], "FlippedTet")
        self.assertIn(f"{report['cells']} cells, {report['cells_at_holes']} of them", run.stdout)
        self.assertAlmostEqual(sum(hole["missing_cells"] for hole in report["holes"]),
                               report["missing_cells"])
        self.assertGreater(report["missing_cells"], 0)
        # A valid map is extracted as ever.
        self.generate("box", name="box.hexex")
        self.run_command("extract", "box.hexex", "-o", "box.vtu", "--partial")
        # Straight cells in memory only, said before anything is extracted or written.
        for options in [["--stream"], ["--order", "2"], ["--arcs", "arcs.vtu"],
                        ["--patches", "patches.vtu"]]:
            self.assert_fails("extract", "box.hexex", "-o", "b.vtu", "--partial", *options,
                              expect=BAD_USAGE, code="InvalidArgument")
        self.assertNotIn("arcs.vtu", self.files())


class Convert(CommandTest):
    """Other formats, and maps as two meshes."""

    def test_maps_through_all_formats_and_back(self):
        self.generate("sphere", "--charts", "random", "--jitter", "0.3")
        files = self.files()
        steps = [("a.vtu",), ("b.vtu", "--compress"), ("c.vtk",), ("d.vtk", "--format", "vtk-binary"),
                 ("e.ovm",), ("f.dat", "--format", "ovmb")]
        if ctypes.util.find_library("lz4"):
            steps.insert(2, ("b4.vtu", "--compress=lz4"))
        last, reading = "map.hexex", []
        for name, *options in steps:
            run = self.run_command("convert", last, name, *options)
            self.assertIn("a map of", run.stdout)
            last = name
        reading = ["--input-format", "ovmb"]
        self.run_command("convert", last, "back.hexex", *reading, "--quiet")
        self.assertEqual(self.files()["back.hexex"], files["map.hexex"])

    def test_meshes_through_all_formats(self):
        map_file = self.generate("star")
        self.run_command("extract", map_file, "-o", "a.vtu", "--quiet")
        last = "a.vtu"
        for name in ("b.msh", "c.meshb", "d.vtk", "e.ovmb", "f.mesh", "g.vtu"):
            run = self.run_command("convert", last, name)
            self.assertIn("a mesh of", run.stdout)
            last = name
        self.run_command("verify", map_file, last)
        checksums = {self.run_command("info", name, "--pieces").stdout.split(":", 1)[1]
                     for name in ("a.vtu", "c.meshb", "g.vtu")}
        self.assertEqual(len(checksums), 1)
        self.run_command("convert", "a.vtu", "h.msh", "--stream", "--quiet")
        self.run_command("verify", map_file, "h.msh")

    def test_two_meshes_are_a_map(self):
        self.generate("box", "--cells", "2")
        self.run_command("convert", "map.hexex", "a.vtu", "--quiet")
        pair = ["--tets", "a.vtu", "--polycube", "a.vtu"]
        run = self.run_command("info", *pair)
        self.assertIn("a.vtu and a.vtu: a tetrahedral mesh with an integer-grid map", run.stdout)
        self.run_command("convert", *pair, "b.hexex", "--quiet")
        same = self.run_command("check", *pair, expect=None).stdout
        self.assertEqual(same, self.run_command("check", "b.hexex", expect=None).stdout)
        self.generate("star", name="c.hexex")
        self.assert_fails("check", "--tets", "a.vtu", "--polycube", "c.hexex", expect=FILE_PROBLEM,
                          words=["a.vtu has", "c.hexex has"], code="FileUnsupported")
        self.assert_fails("check", "map.hexex", *pair, expect=BAD_USAGE, words=["MAP"])
        self.assert_fails("check", "--tets", "a.vtu", expect=BAD_USAGE, words=["--polycube"])
        self.assert_fails("convert", *pair, expect=BAD_USAGE, words=["OUTPUT"])

    def test_pairs_are_extracted_and_verified(self):
        self.write("tets.mesh", POLYCUBE)
        pair = ["--tets", "tets.mesh", "--polycube", "tets.mesh"]
        self.run_command("extract", *pair, "-o", "a.mesh", "--quiet", "--scale", "3")
        run = self.run_command("verify", *pair, "a.mesh", "--scale", "3")
        self.assertIn("cells                                27", run.stdout)

    def test_map_array_of_another_name(self):
        self.run_command("generate", "box", "-o", "a.vtu", "--map-array", "my map", "--quiet")
        self.assert_fails("check", "a.vtu", expect=FILE_PROBLEM, code="FileUnsupported",
                          words=["no map", '"my map" (cells, 12 components)', "--map-array"])
        self.run_command("check", "a.vtu", "--map-array", "my map")

    def test_refused(self):
        map_file = self.generate("box")
        self.run_command("extract", map_file, "-o", "a.mesh", "--quiet")
        fails = [(["map.hexex", "b.inp"], "holds a map"),
                 (["a.mesh", "b.hexex"], "holds a hexahedral mesh"),
                 (["a.mesh", "b.vtk", "--compress"], "no compression"),
                 (["a.mesh", "b.png"], ".png"),
                 (["missing.mesh", "b.vtu"], "missing.mesh")]
        for arguments, word in fails:
            self.assert_fails("convert", *arguments, expect=FILE_PROBLEM, words=[word])
        self.assert_fails("convert", "a.mesh", "./a.mesh", expect=BAD_USAGE, words=["same file"])
        self.assert_fails("extract", map_file, "-o", "b.mesh", "--compress", expect=FILE_PROBLEM,
                          words=["no compression"])
        self.assert_fails("convert", "a.mesh", "b.vtu", "--compress=lzma", expect=BAD_USAGE,
                          words=["zlib or lz4"])

    def test_formats(self):
        run = self.run_command("formats")
        for name in ("hexex", "mesh", "meshb", "vtu", "vtk", "vtk-binary", "ovm", "ovmb", "msh",
                     "msh22-ascii", "inp", "mfem"):
            self.assertRegex(run.stdout, rf"(?m)^{name} ")
        for solver in ("calculix", "dealii", "moose"):
            self.assertRegex(run.stdout, rf"(?m)^{solver} ")

    def test_solvers_choose_format_and_extension(self):
        self.generate("cylinder")
        for solver, file, begins in (("dealii", "a.msh", b"$MeshFormat\n2.2 0 8"), ("mfem", "a.mesh", b"MFEM mesh"),
                                     ("calculix", "a.inp", b"*HEADING"), ("moose", "a.e", b"CDF")):
            for name in ("a", file):
                self.run_command("extract", "map.hexex", "-o", name, "--for", solver, "--quiet")
                self.assertTrue((self.folder / file).read_bytes().startswith(begins), solver)
                (self.folder / file).unlink()
        self.run_command("extract", "map.hexex", "-o", "a", "--for", "calculix", "--order", "2")
        self.assertIn("TYPE=C3D20", (self.folder / "a.inp").read_text())
        self.run_command("convert", "a.inp", "b", "--for", "mfem")
        self.assertIn("nodes", (self.folder / "b.mesh").read_text())
        self.run_command("improve", "b.mesh", "-o", "c", "--for", "mfem")
        self.assertIn("nodes", (self.folder / "c.mesh").read_text())
        for arguments, expect, sentence in (
                (["-o", "a.vtu", "--for", "mfem"], BAD_USAGE, "MFEM reads .mesh files: write a.mesh in place of a.vtu."),
                (["-o", "a", "--for", "fenics"], BAD_USAGE, "choose abaqus, calculix, code-aster, dealii, dolfinx,"),
                (["-o", "a", "--for", "mfem", "--format", "vtu"], BAD_USAGE, "excludes"),
                (["-o", "d", "--for", "dealii", "--order", "2"], FILE_PROBLEM, "for deal.II, straight cells"),
                (["-o", "d", "--for", "calculix", "--order", "3"], FILE_PROBLEM, "these are of order 3")):
            run = self.run_command("extract", "map.hexex", *arguments, expect=expect)
            self.assertIn(sentence, run.stderr)
        self.assertNotIn("d.inp", self.files())

    def test_folders_are_made_for_openfoam_and_asked_for_otherwise(self):
        self.generate("cylinder")
        for output in ("new/case.foam", "new/constant/polyMesh"):  # the second replaces the folder
            self.run_command("extract", "map.hexex", "-o", output, "--for", "openfoam", "--quiet")
            self.assertTrue((self.folder / "new/constant/polyMesh/faces").exists())
        run = self.run_command("extract", "map.hexex", "-o", "other/a.vtu", expect=FILE_PROBLEM)
        self.assertIn("its folder does not exist; make it with `mkdir -p other`.", run.stderr)


    def test_files_of_other_kinds_are_named(self):
        self.write("a.mesh", POLYCUBE)
        self.write("old.msh", "$NOD\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$ENDNOD\n$ELM\n1\n"
                              "1 4 1 1 4 1 2 3 4\n$ENDELM\n")
        self.write("mfem.mesh", "MFEM NURBS mesh v1.0\n\ndimension\n3\n")
        self.write("a.obj", "v 0 0 0\n")
        self.write("a.fra", "FRA 1\n")
        for arguments, sentence in (
                (["info", "a.mesh"], "it holds 6 tetrahedra, of which `hexhex mesh` makes hexahedra"),
                (["info", "old.msh"], "it holds 1 tetrahedron, of which `hexhex mesh` makes hexahedra"),
                (["check", "a.mesh"], "Tets without a map: `hexhex mesh` makes hexahedra of them, or"),
                (["info", "mfem.mesh"], "other files of MFEM, such as NURBS and nonconforming meshes, are not read"),
                (["info", "a.obj"], ".obj files hold surfaces: `hexhex mesh` fills them"),
                (["info", "a.bdf"], "meshio converts .bdf files from and to .vtu: `pip install meshio[all]`"),
                (["extract", "a.fra", "-o", "b.vtu"], ".fra files hold frame fields, not maps: `hexhex map`")):
            self.assertIn(sentence, self.run_command(*arguments, expect=FILE_PROBLEM).stderr)


class MixedCells(CommandTest):
    """Hexahedra among other volume cells."""

    def setUp(self):
        super().setUp()
        self.write("mixed.vtk", mixed_mesh())

    def test_are_listed(self):
        text = self.run_command("info", "mixed.vtk").stdout
        self.assertIn("several types of cells", text)
        for name in ("hexahedra", "pyramids", "tetrahedra"):
            self.assertRegex(text, rf"\n  {name} +1\n")
        for options in ((), ("--pieces",)):
            listed = json.loads(self.run_command("info", "mixed.vtk", "--json", *options).stdout)
            self.assertEqual(listed["cell_types"], {"hexahedra": 1, "pyramids": 1, "tetrahedra": 1})
            self.assertEqual(listed["cells"], 1)

    def test_are_refused_unless_the_others_shall_be_left_out(self):
        commands = [("convert", "mixed.vtk", "a.ovm"), ("convert", "mixed.vtk", "a.vtu", "--stream"),
                    ("improve", "mixed.vtk", "-o", "a.vtu")]
        for command in commands:
            self.assert_fails(*command, expect=FILE_PROBLEM, code="FileUnsupported",
                              words=("1 pyramid and 1 tetrahedron", "--hexes-only"))
            result = self.run_command(*command, "--hexes-only")
            self.assertIn("pyramids (1), tetrahedra (1)", result.stderr)
        self.assertIn("a hexahedral mesh\n", self.run_command("info", "a.vtu").stdout)

    def test_are_carried_where_the_format_holds_them(self):
        result = self.run_command("convert", "mixed.vtk", "a.msh")
        self.assertIn("a mesh of 1 cell and 2 of other types, ", result.stdout)
        self.assertEqual(result.stderr, "")
        self.run_command("convert", "a.msh", "b.vtu")
        listed = json.loads(self.run_command("info", "b.vtu", "--json").stdout)
        self.assertEqual(listed["cell_types"], {"hexahedra": 1, "pyramids": 1, "tetrahedra": 1})
        self.assert_fails("convert", "b.vtu", "c.msh", "--split-tags", expect=BAD_USAGE,
                          words=("other cells",))

    def test_without_others_there_is_no_warning(self):
        self.run_command("extract", self.generate("box"), "-o", "a.vtu", "--quiet")
        self.assertEqual(self.run_command("convert", "a.vtu", "b.vtk", "--hexes-only").stderr, "")


class Parts(CommandTest):
    """extract --parts"""

    def test_pieces_are_the_mesh(self):
        map_file = self.generate("shell", "--cells", "3", "--features", "--charts", "random")
        self.run_command("extract", map_file, "-o", "whole.vtu", "--scale", "2", "--quiet")
        text = self.run_command("extract", map_file, "-o", "parts.pvtu", "--scale", "2", "--stream", "--parts", "5",
                                "--ghosts", "1", "--report", "r.json").stdout
        self.assertRegex(text, r"parts +5, of \d+ to \d+ cells")
        parts = json.loads((self.folder / "r.json").read_text())["parts"]
        self.assertEqual((parts["count"], parts["partition"], parts["ghost_layers"]), (5, "curve", 1))
        self.assertTrue(parts["verified"])
        summaries = [self.run_command("info", "--pieces", file).stdout.splitlines()[1:]
                     for file in ["whole.vtu", "parts.pvtu"]]
        self.assertEqual(summaries[0], summaries[1])
        for file in ["whole", "parts"]:
            self.run_command("convert", f"{file}.{'vtu' if file == 'whole' else 'pvtu'}", f"{file}.mesh", "--quiet")
        self.assertEqual((self.folder / "whole.mesh").read_bytes(), (self.folder / "parts.mesh").read_bytes())
        self.run_command("verify", map_file, "parts.pvtu", "--scale", "2", "--quiet")

    def test_what_is_refused(self):
        map_file = self.generate("box", "--cells", "1")
        for arguments, word, code in [
                (["a.pvtu", "--parts", "0"], "--parts", BAD_USAGE), (["a.pvtu", "--parts", "-2"], "--parts", BAD_USAGE),
                (["a.pvtu", "--parts", "2", "--ghosts", "17"], "--ghosts", BAD_USAGE),
                (["a.vtu", "--parts", "2"], "no format of meshes in parts", FILE_PROBLEM),
                (["a.foam", "--parts", "2", "--ghosts", "1"], "no ghost cells", FILE_PROBLEM),
                (["a.pvtu", "--parts", "2", "--order", "2"], "--parts", BAD_USAGE)]:
            with self.subTest(arguments=arguments):
                self.assert_fails("extract", map_file, "-o", *arguments, expect=code, words=[word])
        self.assert_fails("extract", map_file, "-o", "a.pvtu", expect=FILE_PROBLEM, words=["--parts"])
        (self.folder / "processor2").mkdir()
        self.assert_fails("extract", map_file, "-o", "a.foam", "--parts", "2", expect=FILE_PROBLEM, words=["processor2"])


class Stream(CommandTest):
    """extract --stream"""

    def test_same_mesh_as_in_memory(self):
        for kind in KINDS:
            map_file = self.generate(kind, "--charts", "random", "--jitter", "0.3", "--cells", "2" if self.sanitized else "3")
            others = ["meshb", "vtk", "msh"] if kind == "sphere" else []
            for extension in ["vtu", "mesh", *others]:
                with self.subTest(kind=kind, extension=extension):
                    whole, pieces = f"whole.{extension}", f"pieces.{extension}"
                    self.run_command("extract", map_file, "-o", whole, "--scale", "2")
                    text = self.run_command("extract", map_file, "-o", pieces, "--scale", "2",
                                            "--stream").stdout
                    self.assertRegex(text, r"verification +passed, 5 checks\n")
                    self.assertNotIn("Jacobian", text)
                    self.run_command("verify", map_file, pieces, "--scale", "2", "--quiet")
                    summaries = [self.run_command("info", "--pieces", file).stdout.splitlines()[1:]
                                 for file in [whole, pieces]]
                    self.assertEqual(summaries[0], summaries[1])

    def test_report(self):
        map_file = self.generate("sphere")
        self.run_command("extract", map_file, "-o", "a.vtu", "--stream", "--report", "r.json")
        report = json.loads((self.folder / "r.json").read_text())
        self.assertEqual(set(report), REPORT_KEYS)
        self.assertTrue(report["streamed"])
        self.assertIsNone(report["quality"])
        self.assertEqual(report["engine"], "atlas")
        self.assertEqual(report["output"]["bytes"], (self.folder / "a.vtu").stat().st_size)
        self.assertEqual(sum(report["vertices_by_generator"].values()), report["vertices"])
        self.assertGreater(report["peak_memory_bytes"], 1_000_000)
        self.assertTrue(report["verification"]["passed"])
        found = {item["name"]: item["found"] for item in report["verification"]["items"]}
        self.assertEqual(set(found), {"map_valid", "cells", "vertices", "vertices_off_lattice",
                                      "wrong_cells"})
        self.assertEqual(found["cells"], str(report["cells"]))
        read = json.loads(self.run_command("info", "--pieces", "--json", "a.vtu").stdout)
        self.assertEqual(report["checksums"], read["checksums"])

    def test_memory(self):
        """Neither a mesh of a million cells nor its file is in memory, also while it is verified."""
        self.skip_if_sanitized()
        map_file = self.generate("box", "--cells", "25")
        for name in ["vtu", "mesh", "meshb", "vtk", "vtk-binary", "msh"]:
            with self.subTest(format=name):
                self.run_command("extract", map_file, "-o", "a.x", "--format", name, "--stream",
                                 "--scale", "2", "--report", "r.json")
                report = json.loads((self.folder / "r.json").read_text())
                self.assertEqual(report["cells"], 1_000_000)
                self.assertTrue(report["verification"]["passed"])
                self.assertLess(report["peak_memory_bytes"], 80_000_000)

    def test_without_verification(self):
        map_file = self.generate("box")
        text = self.run_command("extract", map_file, "-o", "a.vtu", "--stream", "--no-verify",
                                "--report", "r.json")
        self.assertIn("skipped", text.stdout)
        self.assertNotIn("read mesh", text.stderr)
        report = json.loads((self.folder / "r.json").read_text())
        self.assertIsNone(report["verification"])
        self.assertRegex(report["checksums"]["cells"], "^[0-9a-f]{16}$")

    def test_same_bytes_with_any_number_of_threads(self):
        map_file = self.generate("torus", "--charts", "blocks", "--cells", "5")
        for extension in ["vtu", "mesh"]:
            for threads in [1, 2, 3]:
                self.run_command("extract", map_file, "-o", f"{threads}.{extension}", "--stream",
                                 "--threads", threads, "--quiet")
            files = self.files()
            self.assertEqual(files[f"1.{extension}"], files[f"2.{extension}"])
            self.assertEqual(files[f"1.{extension}"], files[f"3.{extension}"])

    def test_silent_and_nothing_but_the_outputs_is_left(self):
        map_file = self.generate("box")
        self.write("real.vtu", "old")
        (self.folder / "link.vtu").symlink_to("real.vtu")
        for output in ["a.vtu", "a.mesh", "link.vtu"]:
            result = self.run_command("extract", map_file, "-o", output, "--stream", "--quiet")
            self.assertEqual(result.stdout + result.stderr, "")
        self.assertEqual(set(self.files()),
                         {"map.hexex", "a.vtu", "a.mesh", "link.vtu", "real.vtu"})
        self.assertTrue((self.folder / "link.vtu").is_symlink())
        self.assertEqual(self.files()["real.vtu"], self.files()["a.vtu"])

    def test_refused(self):
        map_file = self.generate("box")
        (self.folder / "taken.vtu").mkdir()
        for output, expect, code, words in [
            ("a.ovm", FILE_PROBLEM, "FileUnsupported", ["a.ovm", "mesh, "]),
            ("a.obj", FILE_PROBLEM, "FileUnsupported", ["a.obj"]),
            ("taken.vtu", FILE_PROBLEM, "FileWrite", ["taken.vtu"]),
            ("missing/a.vtu", FILE_PROBLEM, "FileWrite", ["missing/a.vtu"]),
        ]:
            with self.subTest(output=output):
                self.assert_fails("extract", map_file, "-o", output, "--stream", expect=expect,
                                  code=code, words=words)
        self.assert_fails("extract", map_file, "-o", "a.vtu", "--stream", "--engine", "propeller",
                          expect=BAD_USAGE, code="InvalidArgument", words=["--engine"])

    def test_failure_leaves_what_was_there(self):
        self.write("a.vtu", "old")
        map_file = self.write("map.hexex", ONE_TET)
        self.assert_fails("extract", map_file, "-o", "a.vtu", "--stream", expect=INVALID_MAP,
                          code="BoundaryOffLattice")
        self.generate("box", "--cells", "8", "--refine", "1")

        def limit_file_size():
            import resource
            resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000))

        for output in ["a.vtu", "a.mesh"]:
            before = self.files()
            result = self.run_command("extract", map_file, "-o", output, "--stream",
                                      expect=FILE_PROBLEM, preexec_fn=limit_file_size)
            self.assertIn("File too large. [FileWrite]", result.stderr)
            self.assertIn(f"hexhex: error: {output}: ", result.stderr)
            self.assertEqual(self.files(), before)

    def test_into_a_pipe(self):
        map_file = self.generate("box")
        self.run_command("extract", map_file, "-o", "a.mesh", "--stream")
        pipe = self.folder / "pipe.mesh"
        os.mkfifo(pipe)
        with subprocess.Popen([self.command, "extract", map_file, "-o", pipe, "--stream", "--quiet"],
                              cwd=self.folder) as process:
            self.assertEqual(pipe.read_bytes(), (self.folder / "a.mesh").read_bytes())
            self.assertEqual(process.wait(timeout=600), SUCCESS)


class Interruption(CommandTest):
    def interrupt(self, last_line, *arguments, by=signal.SIGINT, sentence="Interrupted. [Cancelled]"):
        """Ctrl-C soon after a line of progress."""
        arguments = ["--verbose", *arguments]
        map_file = self.generate_for_seconds()
        with subprocess.Popen([self.command, "extract", map_file, "-o", "a.mesh", *arguments],
                              cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              text=True) as process:
            # With the first line, the handler is in place.
            for line in process.stderr:
                self.assertIn("hexhex: ", line)
                if line == last_line:
                    break
            time.sleep(0.05)
            process.send_signal(by)
            _, errors = process.communicate(timeout=600)
        self.assertEqual(process.returncode, INTERRUPTED, errors)
        self.assertIn(f"hexhex: error: {sentence}\n", errors)
        self.assertEqual(set(self.files()), {"map.hexex"})

    def test_interrupt_ends_with_a_sentence_and_no_file(self):
        self.interrupt("hexhex: read map\n", "--scale", "2")  # the work takes seconds

    def test_termination_is_called_so(self):
        self.interrupt("hexhex: read map\n", "--scale", "2", by=signal.SIGTERM, sentence="Terminated. [Cancelled]")

    def test_interrupt_of_a_stream(self):
        self.interrupt("hexhex: cells\n", "--scale", "2", "--stream")


class Surfaces(CommandTest):
    """PART as a surface; a shell script stands in for Python with a mesher."""

    TET = "OFF 4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"

    def setUp(self):
        super().setUp()
        (self.folder / "part.off").write_text(self.TET)

    def mesher(self, script):
        """The environment in which that is the mesher."""
        file = self.folder / "python"
        file.write_text("#!/bin/sh\n" + script)
        file.chmod(0o755)
        return {**os.environ, "HEXHEX_PYTHON": str(file)}

    def test_errors(self):
        result = self.run_command("map", "part.off", "-o", "a.hexex", "--quiet", expect=INVALID_MAP,
                                  env=self.mesher("echo Fake 1; echo no way; exit 1\n"))
        self.assertIn("It said: Fake 1 | no way", result.stderr)
        result = self.run_command("map", "part.off", "-o", "a.hexex", "--mesher", "tetwild",
                                  expect=FILE_PROBLEM, env=self.mesher("exit 3\n"))
        self.assertIn("`pip install pytetwild`", result.stderr)
        (self.folder / "open.off").write_text(self.TET.replace("4 4 6", "4 3 6"))
        self.assert_fails("mesh", "open.off", "-o", "a.vtu", expect=INVALID_MAP, code="NonManifoldEdge",
                          words=["open.off: The surface is open: the edge from (1, 0, 0) to (0, 1, 0)"])

    def test_mesher_ends_with_the_command(self):
        for number in [signal.SIGINT, signal.SIGKILL]:
            file = self.folder / "id"
            file.unlink(missing_ok=True)
            environment = self.mesher(f"echo $$ > '{file}.new'; mv '{file}.new' '{file}'; exec sleep 600\n")
            with subprocess.Popen([self.command, "map", "part.off", "-o", "a.hexex", "--quiet"],
                                  cwd=self.folder, env=environment, stderr=subprocess.DEVNULL) as process:
                while not file.exists() and process.poll() is None:
                    time.sleep(0.02)
                process.send_signal(number)
                process.wait(timeout=60)
            # Gone, or waiting for somebody to note it.
            status = pathlib.Path(f"/proc/{int(file.read_text())}/stat")
            for _ in range(500):
                if not status.exists() or status.read_text().rsplit(")", 1)[1].split()[0] == "Z":
                    break
                time.sleep(0.02)
            else:
                self.fail("the mesher runs on")
            self.assertFalse((self.folder / "a.hexex").exists())


class View(CommandTest):
    """The page of `hexhex view`, unpacked here on its own."""

    def setUp(self):
        super().setUp()
        self.generate("sphere", "--jitter", "0.2")
        self.run_command("extract", "map.hexex", "-o", "a.mesh", "--scale", "2", "--quiet")
        probe = subprocess.run([self.command, "view", "a.mesh", "-o", "probe.html", "--quiet"],
                               cwd=self.folder, text=True, capture_output=True, check=False)
        if "built without the viewer" in probe.stderr:
            self.assertEqual(probe.returncode, FILE_PROBLEM)
            self.skipTest("this hexhex was built without the viewer page")
        self.assertEqual(probe.returncode, SUCCESS, probe.stderr)
        (self.folder / "probe.html").unlink()

    def test_of_hexahedra_among_other_cells(self):
        self.write("mixed.vtk", mixed_mesh())
        self.assert_fails("view", "mixed.vtk", "-o", "m.html", expect=FILE_PROBLEM,
                          code="FileUnsupported", words=("1 pyramid", "--hexes-only"))
        result = self.run_command("view", "mixed.vtk", "-o", "m.html", "--hexes-only")
        self.assertIn("pyramids (1), tetrahedra (1)", result.stderr)

    @staticmethod
    def info(html):
        found = re.search(r'<script id="mesh-info" type="application/json">(.*?)</script>', html)
        return json.loads(found[1])

    @staticmethod
    def unpack(table, chunks):
        """The rows of a table from its compressed chunks."""
        rows = []
        for chunk in chunks:
            count = min(table["rowsPerChunk"], table["rows"] - len(rows))
            columns = table["columns"]
            data = zlib.decompress(chunk)
            planes = [data[1 + p * count * columns:][:count * columns] for p in range(data[0])]
            above = [0] * columns
            for row in range(count):
                for column in range(columns):
                    at = row * columns + column if table["byRows"] else column * count + row
                    code = sum(plane[at] << 8 * p for p, plane in enumerate(planes))
                    above[column] += code >> 1 if code & 1 == 0 else -(code + 1 >> 1)
                rows.append([value % 2**32 for value in above])
        return rows

    def tables(self, html):
        return {table["name"]: self.unpack(table, [
            base64.b64decode(re.search(f'id="data-{table["name"]}-{i}">(.*?)</script>', html)[1])
            for i in range(len(table["chunkBytes"]))]) for table in self.info(html)["tables"]}

    def mesh(self):
        """Points and cells (0-based) of a.mesh."""
        lines = (self.folder / "a.mesh").read_text().split("\n")
        def section(name):
            begin = lines.index(name)
            return [line.split() for line in lines[begin + 2:begin + 2 + int(lines[begin + 1])]]
        points = [[float(word) for word in words[:3]] for words in section("Vertices")]
        return points, [[int(word) - 1 for word in words[:8]] for words in section("Hexahedra")]

    def test_page_holds_the_mesh(self):
        output = self.run_command("view", "a.mesh").stdout
        self.assertIn("a.mesh -> a.html", output)
        html = (self.folder / "a.html").read_text()
        info, tables = self.info(html), self.tables(html)
        points, cells = self.mesh()
        self.assertTrue(tables["cells"] == cells)  # nobody waits for what differs in thousands of rows
        self.assertEqual(len(tables["points"]), len(points))
        for stored, point in zip(tables["points"], points):
            for axis in range(3):
                place = info["lower"][axis] + info["step"] * stored[axis]
                self.assertLess(abs(place - point[axis]), 0.51 * info["step"])
        summary = self.run_command("info", "a.mesh").stdout
        minimum = float(re.search(r"at least (-?[\d.]+)", summary)[1])
        self.assertAlmostEqual(min(row[0] for row in tables["quality"]) / 65534 * 2 - 1, minimum, 3)
        self.assertIsNone(info["verification"])
        # Nothing in the page leads to a network.
        self.assertNotRegex(re.sub(r"http://www\.w3\.org/\S+", "", html), r"(src|href)=.https?:")

    def test_page_tells_whether_mesh_and_map_agree(self):
        self.run_command("view", "a.mesh", "--map", "map.hexex", "--scale", "2", "-o", "b.html")
        self.assertTrue(self.info((self.folder / "b.html").read_text())["verification"]["passed"])
        run = self.run_command("view", "a.mesh", "--map", "map.hexex", "-o", "c.html",
                               expect=FAILURE)
        self.assertIn("warning: The mesh does not agree with map.hexex", run.stderr)
        self.assertFalse(self.info((self.folder / "c.html").read_text())["verification"]["passed"])

    def test_page_knows_generators(self):
        for extension in ["vtu", "ovmb"]:
            self.run_command("extract", "map.hexex", "-o", f"b.{extension}", "--quiet")
            self.run_command("view", f"b.{extension}", "-o", "b.html", "--quiet")
            kinds = self.tables((self.folder / "b.html").read_text())["generator_kinds"]
            self.assertEqual({kind for kind, in kinds}, {0, 1, 2, 3})

    def test_page_of_a_map(self):
        self.run_command("view", "map.hexex", "--scale", "2", "-o", "b.html")
        info = self.info((self.folder / "b.html").read_text())
        self.assertEqual((info["cells"], info["order"]), (len(self.mesh()[1]), 1))
        self.assertTrue(info["verification"]["passed"])

    def test_page_of_curved_cells(self):
        """The same, whether they come from a file or a map."""
        self.run_command("extract", "map.hexex", "-o", "c.vtu", "--order", "3", "--quiet")
        self.run_command("view", "c.vtu", "--map", "map.hexex", "-o", "c.html")
        self.run_command("view", "map.hexex", "--order", "3", "-o", "d.html")
        file, map_ = [(self.folder / page).read_text() for page in ["c.html", "d.html"]]
        self.assertTrue(self.info(file)["verification"]["passed"])
        self.assertEqual(self.info(file)["order"], 3)
        tables, others = self.tables(file), self.tables(map_)
        for name in ["points", "cells", "nodes", "quality", "generator_kinds"]:
            self.assertEqual(tables[name], others[name], name)
        # Two nodes on each of 12 edges, four on each of 6 faces.
        self.assertEqual({len(row) for row in tables["nodes"]}, {48})
        vertices, points = self.info(file)["vertices"], self.info(file)["points"]
        self.assertEqual({n for row in tables["nodes"] for n in row}, set(range(vertices, points)))

    def test_page_before_and_after(self):
        """What `improve` and `extract --improve` write beside the mesh."""
        self.generate("torus", "--jitter", "0.9", "--cells", "2" if self.sanitized else "3")
        self.run_command("extract", "map.hexex", "-o", "rough.vtu", "--quiet")
        run = self.run_command("improve", "rough.vtu", "--map", "map.hexex", "-o", "fine.vtu", "--view", "b.html")
        self.assertIn("page                      b.html", run.stdout)
        self.run_command("extract", "map.hexex", "-o", "same.vtu", "--improve", "--view", "c.html", "--quiet")
        self.run_command("view", "rough.vtu", "-o", "rough.html", "--quiet")
        self.run_command("view", "fine.vtu", "-o", "fine.html", "--quiet")
        both, extracted, rough, fine = [(self.folder / f"{name}.html").read_text()
                                        for name in ["b", "c", "rough", "fine"]]
        info, tables = self.info(both), self.tables(both)
        for key in ["quality", "validity"]:
            self.assertEqual(info["before"][key], self.info(rough)[key])
            self.assertEqual(info[key], self.info(fine)[key])
        self.assertGreater(info["before"]["validity"]["refuted"], 0)
        self.assertEqual(info["validity"]["refuted"], 0)
        self.assertEqual(tables["quality_before"], self.tables(rough)["quality"])
        self.assertEqual(len(tables["not_positive_before"]), info["before"]["validity"]["refuted"])
        self.assertEqual(tables, self.tables(extracted))
        self.assertTrue(self.info(extracted)["verification"]["passed"])
        earlier = [[(a + b) % 2**32 for a, b in zip(after, added)]
                   for after, added in zip(tables["points"], tables["points_before"])]
        place = lambda of, row: [of["lower"][axis] + of["step"] * row[axis] for axis in range(3)]
        for row, expected in zip(earlier, self.tables(rough)["points"]):
            for a, b in zip(place(info, row), place(self.info(rough), expected)):
                self.assertAlmostEqual(a, b, delta=2 * info["step"])
        # Without an improvement, the page is that of `view`, but for its title.
        self.run_command("extract", "map.hexex", "-o", "rough.vtu", "--view", "d.html", "--quiet")
        self.assertEqual(self.tables((self.folder / "d.html").read_text()), self.tables(rough))
        self.assertNotIn("points_before-0", rough + fine)
        self.assert_fails("improve", "fine.vtu", "-o", "bad.vtu", "--view", "fine.vtu", expect=BAD_USAGE,
                          words=["same file"])
        self.assert_fails("improve", "fine.vtu", "-o", "bad.vtu", "--view", "no/folder/a.html", expect=FILE_PROBLEM,
                          code="FileWrite")
        for option in ["--stream", "--partial"]:
            self.assert_fails("extract", "map.hexex", "-o", "bad.vtu", "--view", "e.html", option, expect=BAD_USAGE,
                              code="InvalidArgument")
        self.assertFalse((self.folder / "bad.vtu").exists())

    def test_page_problems(self):
        self.assert_fails("view", "a.mesh", "-o", "a.mesh", expect=BAD_USAGE, words=["same file"])
        self.assert_fails("view", "none.mesh", expect=FILE_PROBLEM, code="FileNotFound")
        self.assert_fails("view", "map.hexex", "--map", "map.hexex", "-o", "c.html",
                          expect=BAD_USAGE, code="InvalidArgument")
        self.assert_fails("view", "a.mesh", "--order", "2", expect=BAD_USAGE,
                          code="InvalidArgument")
        self.assert_fails("view", "a.mesh", "-o", "no/folder/a.html", expect=FILE_PROBLEM,
                          code="FileWrite")
        for arguments in [["--scale", "0"], ["--order", "10"]]:
            self.run_command("view", "a.mesh", *arguments, expect=BAD_USAGE)

    def test_page_allows_nothing_from_outside(self):
        self.run_command("view", "a.mesh", "-o", "b.html", "--quiet")
        page = (self.folder / "b.html").read_text()
        policy = re.search(r'<meta http-equiv="Content-Security-Policy" content="([^"]*)">', page)[1]

        def hash_of(tag):
            (text,) = re.findall(rf"<{tag}>(.*?)</{tag}>", page, re.S)
            return "'sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() + "'"

        self.assertEqual(dict(part.split(" ", 1) for part in policy.split("; ")), {
            "default-src": "'none'", "script-src": hash_of("script"), "style-src": hash_of("style"),
            "worker-src": "blob:", "img-src": "data:", "base-uri": "'none'", "form-action": "'none'"})
        # Before anything that it is about.
        self.assertLess(page.index("Content-Security-Policy"), page.index("<title>"))

    def test_opens_the_page(self):
        """With what the system has for that, which is told the whole path; a warning if there is nothing."""
        program = self.folder / ("open" if sys.platform == "darwin" else "xdg-open")
        program.write_text('#!/bin/sh\n/bin/echo "$1" >opened\n')
        program.chmod(0o755)
        told = self.folder / "opened"
        for name in ["b.html", "-b.html"]:
            told.unlink(missing_ok=True)
            self.run_command("view", "a.mesh", f"--output={name}", "--open", "--quiet", env={"PATH": str(self.folder)})
            end = time.monotonic() + 60  # nobody waits for the opener
            while time.monotonic() < end and not (told.exists() and told.read_text().endswith("\n")):
                time.sleep(0.05)
            opened = pathlib.Path(told.read_text().rstrip("\n"))
            self.assertTrue(opened.is_absolute())
            self.assertTrue(opened.samefile(self.folder / name))
        program.unlink()
        run = self.run_command("view", "a.mesh", "-o", "c.html", "--open", "--quiet", env={"PATH": str(self.folder)})
        self.assertRegex(run.stderr, "warning: The page is written, but .*open cannot be started")
        self.assertTrue((self.folder / "c.html").exists())


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    CommandTest.command = os.path.abspath(sys.argv.pop(1))
    unittest.main()
