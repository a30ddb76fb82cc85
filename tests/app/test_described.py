#!/usr/bin/env python3
"""The manual page and the completions name every option of every subcommand.

    test_described.py PATH-OF-HEXHEX
"""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).parents[2]
FILES = ("hexhex.1", "hexhex.bash", "_hexhex", "hexhex.fish")


class DescribedTest(unittest.TestCase):
    command = None

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="hexhex-described-")
        subprocess.run([ROOT / "scripts/describe-command", cls.command, cls.folder.name], check=True)
        cls.texts = {name: (pathlib.Path(cls.folder.name) / name).read_text() for name in FILES}

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_every_option_is_named(self):
        top = subprocess.run([self.command, "--help"], capture_output=True, text=True, check=True)
        block = top.stdout.partition("Subcommands:")[2].partition("\n\n")[0]
        subcommands = [line.split()[0] for line in block.splitlines() if line.strip()]
        self.assertIn("extract", subcommands)
        for subcommand in subcommands:
            text = subprocess.run([self.command, subcommand, "--help"], capture_output=True,
                                  text=True, check=True).stdout
            options = re.findall(r"^ {2,}(?:-\w,)?--([\w-]+)", text, re.MULTILINE)
            self.assertIn("help", options)
            for option in options:
                self.assertIn("\\-\\-" + option.replace("-", "\\-"), self.texts["hexhex.1"])
                self.assertRegex(self.texts["hexhex.bash"],
                                 rf"(?m)^    {subcommand}\).* --{option}[ \"]")
                self.assertIn(f"'--{option}[", self.texts["_hexhex"])
                self.assertRegex(self.texts["hexhex.fish"],
                                 rf"(?m)from {subcommand}'.* -l {option} ")

    def test_shells_understand_them(self):
        for shell, option, name in (("bash", "-n", "hexhex.bash"), ("zsh", "-n", "_hexhex"),
                                    ("fish", "--no-execute", "hexhex.fish")):
            if shutil.which(shell):
                subprocess.run([shell, option, f"{self.folder.name}/{name}"], check=True)

    def test_bash_completes(self):
        script = f"""source {self.folder.name}/hexhex.bash
          complete_words() {{ COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _hexhex
            echo "${{COMPREPLY[*]}}"; }}
          complete_words hexhex ver; complete_words hexhex extract --sc
          complete_words hexhex extract --engine p; complete_words hexhex generate tor
          complete_words hexhex help quan; complete_words hexhex extract --repair o"""
        result = subprocess.run(["bash", "-c", script], capture_output=True, text=True, check=True)
        self.assertEqual(result.stdout.split(), ["verify", "--scale", "propeller", "torus", "quantize",
                                                  "off"])


if __name__ == "__main__":
    DescribedTest.command = sys.argv.pop(1)
    unittest.main()
