#!/usr/bin/env python3
"""What each of many processes takes to make its part of a mesh, measured on one machine without a network.

    PYTHONPATH=bench bench/parts/scaling.py build/release/bench/hexhex_part_times MAP.hexex FOLDER

The map at scale 4 in 1 to 4096 parts (strong scaling), and in 8 to 4096 parts of the same size (weak scaling). Prints
tables and draws FOLDER/scaling-{strong,weak}.svg. A process prepares the map, counts its share of the tets, and makes
its part; the slowest one of all counts. Processor time of one thread, so that other programs disturb little."""
import json
import subprocess
import sys
from pathlib import Path

from matplotlib.ticker import NullFormatter

from evaluation import style

STRONG = [(4, parts) for parts in (1, 8, 64, 512, 4096)]
WEAK = [(1, 8), (2, 64), (4, 512), (8, 4096)]


def measure(program, map_file, scale, parts):
    words = [program, map_file, str(scale), str(parts)]
    told = json.loads(subprocess.run(words, check=True, capture_output=True, text=True).stdout)
    if parts > 0:
        counting = min(told["counting"], told["preparation"])
        told["replicated"] = told["preparation"] - counting
        told["process"] = told["replicated"] + counting / parts + told["slowest"]
        told["resident"] = told["map"] + told["tables"] + told["memory"]
    return told


def megabytes(count):
    return f"{count / 1e6:.1f} MB"


def table(runs):
    print("| parts | cells of a part | slowest process | of it before its part | all parts | memory of a process | "
          "its part | counts sent |")
    print("|---:|---:|---:|---:|---:|---:|---:|---:|")
    for run in runs:
        before = run["process"] - run["slowest"]
        print(f"| {run['parts']} | {run['cells']:,} | {run['process']:.2f} s | {before:.2f} s | {run['sum']:.1f} s | "
              f"{megabytes(run['resident'])} | {megabytes(run['bytes'])} | {megabytes(run['counts'])} |", flush=True)


def draw(runs, ideal, path):
    """@param ideal  seconds of a process for a run, if nothing were lost"""
    made, (times, memory) = style.figure(1, 2, (8.4, 3.6))
    parts = [run["parts"] for run in runs]
    times.plot(parts, [run["process"] for run in runs], color=style.BLUE, marker="o", label="slowest process")
    times.plot(parts, [run["replicated"] for run in runs], color=style.RED, marker="s", label="of it replicated")
    times.plot(parts, [ideal(run) for run in runs], color=style.GREY, linestyle=":", label="ideal")
    times.set_ylabel("processor time [s]")
    memory.plot(parts, [run["resident"] / 1e6 for run in runs], color=style.BLUE, marker="o", label="process")
    memory.plot(parts, [run["bytes"] / 1e6 for run in runs], color=style.GREEN, marker="s", label="its part")
    memory.set_ylabel("memory [MB]")
    for axes in (times, memory):
        axes.set_xscale("log", base=8)
        axes.set_yscale("log")
        axes.set_xticks(parts, [str(count) for count in parts])
        axes.xaxis.set_minor_formatter(NullFormatter())
        axes.set_xlabel("parts")
        axes.legend(frameon=False)
    style.save(made, path)


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    program, map_file, folder = sys.argv[1], sys.argv[2], Path(sys.argv[3])
    for scale in (4, 8):
        whole = measure(program, map_file, scale, 0)
        print(f"In one piece at scale {scale}: {whole['cells']:,} cells, {whole['sum']:.2f} s, "
              f"{megabytes(whole['memory'])}", flush=True)
    strong = [measure(program, map_file, *run) for run in STRONG]
    print(f"\nThe map has {megabytes(strong[0]['map'])}. Strong scaling:\n")
    table(strong)
    draw(strong, lambda run: strong[0]["process"] / run["parts"], folder / "scaling-strong.svg")
    weak = [measure(program, map_file, *run) for run in WEAK]
    print("\nWeak scaling:\n")
    table(weak)
    draw(weak, lambda run: weak[0]["process"], folder / "scaling-weak.svg")


if __name__ == "__main__":
    main()
