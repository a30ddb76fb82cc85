#!/usr/bin/env python3
"""Prints the medians of a Google Benchmark JSON file as Markdown tables."""

import sys
from pathlib import Path

from evaluation import results, tables


def main() -> None:
    runs = results.read_file(Path(sys.argv[1]))
    parts = [tables.engines(runs)]
    for engine in tables.ENGINES:
        parts.append(tables.extraction(runs, engine))
        parts += [tables.stages(runs, engine, unit) for unit in ("tet", "hex")]
    parts += [tables.scales(runs), tables.epsilon(runs), tables.others(runs)]
    print("\n".join(part for part in parts if part))
    if wrong := results.failures(runs):
        sys.exit("FAILED: " + "; ".join(wrong))


if __name__ == "__main__":
    main()
