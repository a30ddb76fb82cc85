"""Prints lines and branches per folder that were executed, and lists those that were not.

    report.py EXPORT.json EXPORT.lcov MISSING.txt [--executed] FOLDER...

Of files below the folders, or those of them of which anything was executed. A branch is a condition
with one of its two outcomes. Instantiations of a template count together.
"""
import collections
import json
import os
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]


def line_counts(lcov):
    """Executions by file and line."""
    counts = {}
    lines = None
    for text in pathlib.Path(lcov).read_text().splitlines():
        key, _, value = text.partition(":")
        if key == "SF":
            lines = counts.setdefault(os.path.normpath(value), {})
        elif key == "DA":
            line, count = (int(number) for number in value.split(",")[:2])
            lines[line] = max(count, lines.get(line, 0))
    return counts


def branch_counts(export):
    """By file and place of a condition: how often it was true, and false."""
    counts = {}
    for file in json.loads(pathlib.Path(export).read_text())["data"][0]["files"]:
        places = counts.setdefault(os.path.normpath(file["filename"]), {})
        for branch in file["branches"]:
            outcomes = places.setdefault(tuple(branch[:4]), [0, 0])
            outcomes[0] += branch[4]
            outcomes[1] += branch[5]
    return counts


def share(hit, total):
    return f"{hit:6} of {total:6} {100 * hit / total if total else 100:6.1f} %"


def main(export, lcov, missing_name, *folders):
    only_executed = "--executed" in folders
    lines = line_counts(lcov)
    branches = branch_counts(export)
    totals = collections.defaultdict(lambda: [0, 0, 0, 0])
    missing = []
    for file in sorted(lines):
        path = pathlib.Path(file).relative_to(ROOT)
        if not any(path.is_relative_to(folder) for folder in folders):
            continue
        if only_executed and not any(lines[file].values()):
            continue
        source = pathlib.Path(file).read_text().splitlines()
        sums = totals["/".join(path.parts[1:-1])]
        sums[0] += sum(count > 0 for count in lines[file].values())
        sums[1] += len(lines[file])
        for line, count in lines[file].items():
            if count == 0:
                missing.append((path, line, "not executed", source[line - 1].strip()))
        for (line, begin, end_line, end), outcomes in branches.get(file, {}).items():
            if outcomes == [0, 0]:
                # A constant, or on a line that is not executed, which is listed as a line.
                if lines[file].get(line, 0) == 0:
                    sums[3] += 2
                continue
            sums[2] += (outcomes[0] > 0) + (outcomes[1] > 0)
            sums[3] += 2
            condition = source[line - 1][begin - 1:end - 1 if end_line == line else None]
            for count, outcome in zip(outcomes, ("true", "false")):
                if count == 0:
                    missing.append((path, line, f"never {outcome}", condition))
    total = [sum(column) for column in zip(*totals.values())]
    print(f"{'folder':10} {'lines':>25} {'branches':>25}")
    for folder, sums in list(totals.items()) + [("all", total)]:
        print(f"{folder:10} {share(*sums[:2])} {share(*sums[2:])}")
    listing = [f"{path}:{line}: {what}: {text}" for path, line, what, text in sorted(missing)]
    pathlib.Path(missing_name).write_text("\n".join(listing) + "\n")
    print(f"{len(listing)} places are listed in {missing_name}")


if __name__ == "__main__":
    main(*sys.argv[1:])
