#!/usr/bin/env python3
"""Takes the snippets out of a page of docs/ and runs them, in a folder of their own.

    run_snippets.py PAGE LANGUAGE [COMPILER AND FLAGS...]

LANGUAGE: python (with this interpreter), sh, c or cpp. All snippets of a page are one program; those
of C and C++ are compiled with the command, which gets the source and the program's name appended. They
stand in one function, except those that begin with a definition or #include, which stand before it.
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile

PREAMBLE = {
    "c": "#include <stdio.h>\n#include <hexhex.h>\n",
    "cpp": "#include <iostream>\n#include <hexhex/hexhex.hpp>\n",
    "python": "",
    "sh": "set -euo pipefail\n",
}
MAIN = {"c": "int main(void) {\n", "cpp": "int main() {\n"}


def stands_before_main(snippet):
    return re.match(r"#include|static |struct |class ", snippet) is not None


def main():
    page, language, *compiler = sys.argv[1:]
    text = pathlib.Path(page).read_text(encoding="utf-8")
    snippets = re.findall(rf"(?ms)^```{language}\n(.*?)^```$", text)
    if not snippets:
        sys.exit(f"{page} has no snippet of {language}")
    if language in MAIN:
        before = [snippet for snippet in snippets if stands_before_main(snippet)]
        inside = [snippet for snippet in snippets if not stands_before_main(snippet)]
        program = "\n".join([PREAMBLE[language], *before, MAIN[language], *inside, "return 0;\n}\n"])
    else:
        program = PREAMBLE[language] + "\n".join(snippets)
    with tempfile.TemporaryDirectory(prefix="hexhex-docs-") as folder:
        source = pathlib.Path(folder) / f"page.{language}"
        source.write_text(program, encoding="utf-8")
        if language == "python":
            command = [sys.executable, str(source)]
        elif language == "sh":
            command = ["bash", str(source)]
        else:
            at = compiler.index("--") if "--" in compiler else len(compiler)
            subprocess.run([*compiler[:at], str(source), "-o", f"{folder}/page",
                            *compiler[at + 1:]], check=True)
            command = [f"{folder}/page"]
        result = subprocess.run(command, cwd=folder, env=os.environ, check=False,
                                capture_output=True, text=True)
        if result.returncode != 0:
            sys.exit(f"{page}, {language}: exit code {result.returncode}\n{result.stdout}"
                     f"{result.stderr}")
    print(f"{pathlib.Path(page).name}: {len(snippets)} snippets of {language}")


if __name__ == "__main__":
    main()
