#!/usr/bin/env python3
"""Whether the outputs that a page shows are those of the command.

    check_samples.py PAGE PATH-OF-HEXHEX           fails if an output is another one
    check_samples.py PAGE PATH-OF-HEXHEX --write   writes the outputs into the page

Runs, in a folder of their own, all lines "    $ COMMAND" of a page, one after the other; what follows in the same
block is the output. Times and memory may differ. What a build cannot do is left out, with what needs its files.
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples"
UNAVAILABLE = re.compile("built without the viewer|cannot make maps of tets")
MEASURED = re.compile(r"^ *(time|peak memory) ")


def blocks(lines):
    """Ranges of lines that are indented by four, with a command at their beginning."""
    begin = None
    for i, line in enumerate([*lines, ""]):
        if begin is None and line.startswith("    $ "):
            begin = i
        elif begin is not None and not line.startswith("    "):
            yield begin, i
            begin = None


def samples(lines):
    """Pairs of a command and its output, and the numbers of the lines of the output."""
    for begin, end in blocks(lines):
        starts = [i for i in range(begin, end) if lines[i].startswith("    $ ")]
        for start, stop in zip(starts, [*starts[1:], end]):
            yield lines[start][6:], (start + 1, stop)


def comparable(output):
    return [re.sub(r"\d[\d.]*", "N", line) if MEASURED.match(line) else line for line in output]


def main():
    page, command = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()
    write = "--write" in sys.argv
    lines = page.read_text(encoding="utf-8").splitlines()
    environment = {**os.environ, "PATH": f"{command.parent}:{os.environ['PATH']}"}
    replaced, wrong, count, missing = [], [], 0, set()
    with tempfile.TemporaryDirectory(prefix="hexhex-samples-") as folder:
        (pathlib.Path(folder) / "examples").symlink_to(EXAMPLES)
        for text, (begin, end) in samples(lines):
            if missing.intersection(text.split()):
                continue
            run = subprocess.run(["bash", "-c", text], cwd=folder, env=environment, check=False,
                                 capture_output=True, text=True)
            if UNAVAILABLE.search(run.stderr):
                missing.update(re.findall(r"-o (\S+)", text))
                continue
            if run.returncode != 0:
                wrong.append(f"{text}\n{run.stderr}")
            shown = [line[4:] for line in lines[begin:end]]
            found = run.stdout.splitlines()
            if not shown:  # nothing is shown of it
                continue
            count += 1
            if comparable(shown) != comparable(found):
                wrong.append(f"{text}\nprints now\n{run.stdout}")
                replaced.append((begin, end, ["    " + line for line in found]))
    if write:
        for begin, end, output in reversed(replaced):
            lines[begin:end] = output
        page.write_text("\n".join(lines) + "\n", encoding="utf-8")
    elif wrong or count == 0:
        sys.exit("\n".join([f"{page}: an output is not as shown; --write corrects it", *wrong]))
    print(f"{page.name}: {count} outputs")


if __name__ == "__main__":
    main()
