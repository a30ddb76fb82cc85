#!/usr/bin/env python3
"""Which libraries the hexhex command loads, and when; and that all of its formats work with them.

    test_libraries.py PATH-OF-HEXHEX [unittest options]

Needs nothing but Python's standard library; also run on what is installed.
"""

import os
import pathlib
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import unittest

SUCCESS, FILE_PROBLEM, FAILURE = 0, 3, 4
MOST_LIBRARIES = 12  # as ldd counts them
OVER_HDF5 = ["cgns", "vtkhdf"]


class LibrariesTest(unittest.TestCase):
    command = None

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="hexhex-test-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.run_command("generate", "box", "--cells", "2", "--features", "-o", "map.ovm", "--quiet")

    def run_command(self, *arguments, expect=SUCCESS, **options):
        environment = dict(os.environ, **options.pop("variables", {}))
        result = subprocess.run([self.command, *arguments], cwd=self.folder, text=True, capture_output=True,
                                timeout=300, check=False, env=environment, **options)
        if expect is not None:
            self.assertEqual(result.returncode, expect, f"{arguments}\n{result.stdout}\n{result.stderr}")
        return result

    def linked(self):
        return subprocess.run(["ldd", self.command], capture_output=True, text=True, check=True).stdout

    def loaded(self, *arguments):
        """File names of all libraries that a run loads."""
        prefix = self.folder / "loads"
        self.run_command(*arguments, variables={"LD_DEBUG": "files", "LD_DEBUG_OUTPUT": str(prefix)})
        text = "".join(file.read_text(errors="replace") for file in self.folder.glob("loads.*"))
        for file in self.folder.glob("loads.*"):
            file.unlink()
        names = set(re.findall(r"calling init: (\S+)", text))
        self.assertTrue(any("libc.so" in name for name in names), "LD_DEBUG shows nothing")
        return {pathlib.Path(name).name for name in names}

    def written(self):
        """Rows of `hexhex formats` for hex meshes: name, extension, whether they are read."""
        text = self.run_command("formats").stdout
        rows = re.findall(r"(?m)^(\S+) +(\.\w+|-) +(?:read, write|write|read|-) +(read, write|write) ", text)
        return [(name, extension, "read" in uses) for name, extension, uses in rows]

    def require_hdf5(self):
        if "cgns" not in [name for name, _, _ in self.written()]:
            self.skipTest("built without HDF5")
        if "libhdf5" in self.linked():
            self.skipTest("linked with HDF5")

    def test_few_are_linked(self):
        self.assertLessEqual(len(self.linked().splitlines()), MOST_LIBRARIES, self.linked())
        self.assertNotRegex(self.linked(), "netcdf|curl|gnutls|mpi")

    def test_none_is_loaded_that_no_file_needs(self):
        self.require_hdf5()
        linked = set(re.findall(r"(?m)^\s*\S*?([^/\s]+\.so\S*)", self.linked()))
        for arguments in [["--version"], ["--help"], ["formats"], ["extract", "--help"], ["check", "map.ovm"],
                          ["extract", "map.ovm", "-o", "a.vtu"], ["extract", "map.ovm", "-o", "a.exo"],
                          ["info", "map.ovm"]]:
            more = {name for name in self.loaded(*arguments) - linked if not re.search("tbb|hwloc|udev|libcap", name)}
            self.assertEqual(more, set(), arguments)

    def test_loads_one_hdf5_where_a_file_needs_it(self):
        self.require_hdf5()
        for extension in OVER_HDF5:
            names = self.loaded("extract", "map.ovm", "-o", f"a.{extension}")
            self.assertEqual(len([name for name in names if re.match(r"libhdf5[^/]*\.so", name)]), 1, names)
            self.assertFalse([name for name in names if re.search("mpi|netcdf", name)])

    def assert_refused(self, library, reason):
        before = set(self.folder.iterdir())
        for extension in OVER_HDF5:
            # Said before anything is read.
            for source in ["map.ovm", "missing.ovm"]:
                result = self.run_command("extract", source, "-o", f"refused.{extension}", expect=FILE_PROBLEM,
                                          variables={"HEXHEX_HDF5": str(library)})
                self.assertRegex(result.stderr,
                                 rf"^hexhex: error: refused\.{extension}: such files take the library HDF5, version "
                                 rf"\d+\.\d+, which cannot be loaded \(.*{reason}.*\)\. Install \S+, or choose another "
                                 r"format\. \[FileUnsupported\]\n$")
        self.assertEqual(set(self.folder.iterdir()), before)

    def test_library_that_is_missing(self):
        self.require_hdf5()
        self.assert_refused("libnosuch.so.1", "libnosuch.so.1: cannot open shared object file")

    def test_library_that_is_none(self):
        self.require_hdf5()
        (self.folder / "text.so").write_text("This is no library.\n" * 100)
        self.assert_refused(self.folder / "text.so", "invalid ELF header")
        (self.folder / "empty.so").write_text("")
        self.assert_refused(self.folder / "empty.so", "file too short")
        self.assert_refused("libc.so.6", "undefined symbol: H5get_libversion")

    def test_library_of_another_version(self):
        self.require_hdf5()
        compiler = shutil.which("cc")
        if not compiler:
            self.skipTest("no compiler")
        source = self.folder / "other.c"
        source.write_text("int H5get_libversion(unsigned *a, unsigned *b, unsigned *c) {"
                          " *a = 1; *b = 2; *c = 3; return 0; }\n")
        subprocess.run([compiler, "-shared", "-fPIC", "-o", self.folder / "other.so", source], check=True)
        self.assert_refused(self.folder / "other.so", r"its version is 1\.2")

    def test_little_memory(self):
        """Neither the loader nor a library has a say where memory is scarce."""
        def run(output, kilobytes):
            limit = (1024 * kilobytes, 1024 * kilobytes)
            return self.run_command("extract", "map.ovm", "-o", output, "--quiet", "--threads", "1", expect=None,
                                    preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, limit))

        if run("a.vtu", 400_000).returncode != SUCCESS:
            self.skipTest("the sanitizers want terabytes")
        for kilobytes in range(40_000, 100_001, 2_000):
            result = run("a.vtu", kilobytes)
            self.assertEqual((result.returncode, result.stderr), (SUCCESS, ""), kilobytes)
            for extension in OVER_HDF5 if "libhdf5" not in self.linked() else []:
                result = run(f"a.{extension}", kilobytes)
                if "this build of hexhex cannot" in result.stderr:
                    continue
                self.assertIn(result.returncode, [SUCCESS, FAILURE], result.stderr)
                lines = result.stderr.splitlines()
                self.assertEqual(len(lines), 0 if result.returncode == SUCCESS else 1, lines)
                if lines:
                    self.assertIn("[OutOfMemory]", lines[0])

    def test_every_format_is_written_and_those_that_are_read_agree(self):
        rows = self.written()
        self.assertGreaterEqual(len(rows), 12)
        self.assertIn("exodus", [name for name, _, _ in rows])
        for name, extension, reads in rows:
            output = name + (".mesh" if extension == "-" else extension)
            self.run_command("extract", "map.ovm", "-o", output, "--format", name, "--scale", "2", "--quiet")
            self.assertTrue((self.folder / output).exists())
            if reads:
                self.run_command("verify", "map.ovm", output, "--scale", "2", "--quiet")


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    LibrariesTest.command = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
