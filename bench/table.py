#!/usr/bin/env python3
"""Prints the medians of a Google Benchmark JSON file as Markdown tables."""

import sys
from pathlib import Path

from evaluation import results, tables


def main() -> None:
    runs = results.read_file(Path(sys.argv[1]))
    parts = [tables.extraction(runs), tables.stages(runs), tables.scales(runs), tables.epsilon(runs),
             tables.curved(runs), tables.checks(runs), tables.commands(runs),
             tables.files(runs)]
    print("\n".join(part for part in parts if part))
    if wrong := results.failures(runs):
        sys.exit("FAILED: " + "; ".join(wrong))


if __name__ == "__main__":
    main()
