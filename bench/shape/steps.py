#!/usr/bin/env python3
"""How long `hexhex mesh` takes by step, of parts with more and more tets.

    bench/shape/steps.py HEXHEX [--tets 5000 20000 80000 200000] [--threads 2] [--cells 20000] [--write docs/user/making-maps.md]

A row per part, method and size: tets, seconds on the clock and of the processors, memory, and what share of the time each
step took. The parts are balls and bodies with two handles: the tets of `hexhex generate`, without their maps. --write puts
the table between the marks `begin:steps` and `end` of a page. Run it on an idle machine."""
import argparse
import json
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

KINDS = ("sphere", "handle-body")
STEPS = {"field, curves and map along frames": ("frames",), "labels": ("labelling", "surface", "labels"),
         "polycube": ("planes", "untangling"), "integers": ("seamless map", "motorcycle complex", "integers", "bending"),
         "improve": ("moving", "quality", "cell faults")}
HEAD = ("| part | method | tets | cells | seconds | of the processor | MB | " + " | ".join(STEPS) + " |\n"
        + "|---|---|---:|---:|---:|---:|---:|" + "---:|" * len(STEPS) + "\n")


def refined(command, kind, tets, folder):
    """A part with about so many tets."""
    def generate(refine):
        file = folder / f"{kind}.hexex"
        subprocess.run([command, "generate", kind, "--refine", str(refine), "--jitter", "0.5", "-o", file, "--quiet"], check=True)
        points = int(file.open().readline())
        with file.open() as lines:
            for _ in range(points + 1):
                lines.readline()
            return file, int(lines.readline())
    least = generate(1)[1]
    return generate(max(1, round((tets / least) ** (1 / 3))))[0]


def row_of(command, kind, method, tets, options, folder):
    part = refined(command, kind, tets, folder)
    report = folder / "report.json"
    report.unlink(missing_ok=True)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    begin = time.monotonic()
    run = subprocess.run([command, "mesh", part, "-o", folder / "mesh.vtu", "--cells", str(options.cells), "--method", method,
                          "--threads", str(options.threads), "--report", report, "--quiet"], capture_output=True, text=True)
    seconds = time.monotonic() - begin
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    processor = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    if run.returncode != 0:
        return f"| {kind} | {method} | {tets} | {run.stderr.strip()[15:115]} | {seconds:.0f} | {processor:.0f} | |" + " |" * len(STEPS) + "\n"
    made = json.loads(report.read_text())
    times = made["seconds"]
    total = sum(value for step, value in times.items() if step != "both ways")
    shares = [sum(times.get(step, 0) for step in steps) / total for steps in STEPS.values()]
    return (f"| {kind} | {method} | {made['part']['tets']} | {made['mesh']['cells']} | {seconds:.0f} | {processor:.0f} "
            f"| {made['peak_memory_bytes'] / 1e6:.0f} | " + " | ".join(f"{share:.0%}" for share in shares) + " |\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command", type=lambda name: Path(name).resolve())
    parser.add_argument("--tets", type=int, nargs="+", default=[5000, 20000, 80000, 200000])
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--cells", type=int, default=20000)
    parser.add_argument("--methods", nargs="+", default=["polycube", "frames", "auto"])
    parser.add_argument("--write", type=Path)
    options = parser.parse_args()
    table = HEAD
    sys.stdout.write(HEAD)
    for kind in KINDS:
        for method in options.methods:
            for tets in options.tets:
                with tempfile.TemporaryDirectory() as folder:
                    row = row_of(options.command, kind, method, tets, options, Path(folder))
                sys.stdout.write(row)
                sys.stdout.flush()
                table += row
    if options.write:
        begin, end = "<!-- begin:steps -->\n", "<!-- end -->"
        text = options.write.read_text()
        head, rest = text.split(begin)
        options.write.write_text(head + begin + table + rest[rest.index(end):])


if __name__ == "__main__":
    main()
