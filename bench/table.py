#!/usr/bin/env python3
"""Prints the medians of a Google Benchmark JSON file as Markdown tables."""

import json
import sys

# In the order in which an extraction runs them.
STAGES = ["input", "topology", "transitions", "singularities", "sanitization", "scaling", "vertices",
          "local connectivity", "global connectivity", "cells"]


def read_medians(path):
    with open(path, encoding="utf-8") as file:
        runs = json.load(file)["benchmarks"]
    return [run for run in runs if run.get("aggregate_name") == "median"]


def number(value):
    """Three significant digits, no exponent."""
    if value is None:
        return "-"
    if abs(value) >= 100:
        return f"{value:,.0f}"
    return f"{value:.1f}" if abs(value) >= 10 else f"{value:.2f}"


def print_table(header, rows):
    print("| " + " | ".join(header) + " |")
    print("|---|" + "---:|" * (len(header) - 1))
    for row in rows:
        print("| " + " | ".join(row) + " |")
    print()


def extraction_name(run):
    """('sphere_blocks_low', '1') of 'extract/sphere_blocks_low/threads:1/manual_time'."""
    parts = run["run_name"].split("/")
    return parts[1], parts[2].removeprefix("threads:")


def print_extractions(runs):
    rows = []
    for run in runs:
        name, threads = extraction_name(run)
        hexes = run["million_hexes"]
        rows.append([name, threads, f"{run['tets']:,.0f}", f"{hexes:.3g}",
                     number(hexes * 1e6 / run["tets"]), number(run["real_time"]),
                     number(run["ns_per_tet"]), number(run["ns_per_hex"]),
                     number(run.get("bytes_per_hex")), number(run["ratio_to_yardstick"])])
    print_table(["map", "threads", "tets", "million hexes", "hexes per tet", "ms", "ns per tet",
                 "ns per hex", "bytes per hex", "ratio to copy"], rows)


def print_stages(runs, unit):
    rows = []
    for run in runs:
        name, threads = extraction_name(run)
        if threads == "1":
            rows.append([name] + [number(run.get(f"{unit}: {stage}")) for stage in STAGES])
    print_table([unit.replace("_", " ")] + STAGES, rows)


def print_others(runs):
    rows = [["/".join(run["run_name"].split("/")[:2]), number(run["real_time"]),
             number(run["bytes_per_second"] * 1e-6)] for run in runs]
    print_table(["one thread", "ms", "MB/s"], rows)


def main():
    medians = read_medians(sys.argv[1])
    extractions = [run for run in medians if run["run_name"].startswith("extract/")]
    others = [run for run in medians if not run["run_name"].startswith("extract/")]
    if extractions:
        print_extractions(extractions)
        print_stages(extractions, "ns_per_tet")
        print_stages(extractions, "ns_per_hex")
    if others:
        print_others(others)


if __name__ == "__main__":
    main()
