#!/usr/bin/env python3
"""What improvement takes in time and memory, against the number of cells.

    PYTHONPATH=bench bench/improve/sizes.py HEXHEX PLOT.svg

Balls at scales 1 to 14, extracted and improved by one command with one thread, whose processor time and peak memory
count as a whole; two threads beside it, by the clock. Prints a table and draws it."""
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from evaluation import style

BALLS = {
    "all positive": (["--cells", "8", "--refine", "4", "--jitter", "0.05"], (1, 3, 7, 14)),
    "a tenth not positive": (["--cells", "4", "--jitter", "0.5"], (4, 7, 13)),
}


def run(words, report):
    """@return seconds by the clock, seconds of processors, and what the command reports"""
    begin = time.perf_counter()
    # As a child of a shell: the memory of this process would count as its own.
    child = subprocess.Popen(["/bin/sh", "-c", '"$@"; exit $?', "sh", *words, "--report", report])
    _, status, usage = os.wait4(child.pid, 0)
    if status != 0:
        sys.exit(f"{' '.join(map(str, words))}: failed")
    return time.perf_counter() - begin, usage.ru_utime + usage.ru_stime, json.loads(report.read_text())


def measure(hexhex, folder, name):
    options, scales = BALLS[name]
    ball, mesh = folder / "ball.hexex", folder / "mesh.vtu"
    subprocess.run([hexhex, "generate", "sphere", *options, "-o", ball, "--quiet"], check=True)
    for scale in scales:
        words = [hexhex, "extract", ball, "--scale", str(scale), "--improve", "--no-verify", "--quiet", "-o", mesh]
        one, processor, told = run([*words, "--threads", "1"], folder / "report.json")
        two = run([*words, "--threads", "2"], folder / "report.json")[0]
        cells, memory = told["cells"], told["peak_memory_bytes"]
        print(f"| {name} | {cells:,} | {processor:.2f} s | {1e6 * processor / cells:.1f} µs | {one / two:.2f} | "
              f"{memory / cells:.0f} bytes |", flush=True)
        yield cells, processor


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    print("| ball | cells | processor time | per cell | two threads: times as fast | memory per cell |")
    print("|---|---|---|---|---|---|")
    made, (axes,) = style.figure(1, 1, (5.2, 3.6))
    with tempfile.TemporaryDirectory() as folder:
        for name, color in zip(BALLS, (style.BLUE, style.RED)):
            cells, seconds = zip(*measure(sys.argv[1], Path(folder), name))
            axes.plot(cells, seconds, color=color, marker="o", label=name)
            linear = [seconds[-1] * n / cells[-1] for n in cells]
            axes.plot(cells, linear, color=color, linestyle=":", linewidth=1.2)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("cells")
    axes.set_ylabel("processor time [s]")
    axes.legend(frameon=False, title="dotted: linear")
    style.save(made, Path(sys.argv[2]))


if __name__ == "__main__":
    main()
