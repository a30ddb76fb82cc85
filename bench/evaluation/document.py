"""Rewrites the generated parts of docs/results/performance.md and docs/results/ablation.md: what stands between
`<!-- begin:NAME -->` and `<!-- end -->`."""

import re
from collections.abc import Callable
from pathlib import Path

from evaluation import plot_density, tables
from evaluation.results import Run

PART = re.compile(r"(<!-- begin:([a-z-]+) -->\n).*?(<!-- end -->)", re.DOTALL)


Parts = dict[str, Callable[[], str]]


def _parts(runs: list[Run], about: dict[str, str]) -> dict[str, Parts]:
    """By page."""
    return {"performance.md": {
        "machine": lambda: tables.machine(about) + "\n" + tables.spread(runs),
        "table-extraction": lambda: tables.extraction(runs),
        "table-reference": lambda: tables.beside_reference(runs),
        "table-scales": lambda: tables.scales(runs),
        "table-stages": lambda: tables.stages(runs),
        "stage-groups": lambda: plot_density.describe_groups(runs),
        "table-curved": lambda: tables.curved(runs),
        "table-files": lambda: tables.files(runs),
        "table-ways": lambda: tables.ways(runs),
        "table-checks": lambda: tables.checks(runs),
        "table-commands": lambda: tables.commands(runs),
    }, "ablation.md": {
        "machine-of-ablation": lambda: tables.machine(about),
        "table-ablation": lambda: tables.ablation(runs),
        "table-epsilon": lambda: tables.epsilon(runs),
        "table-rasterization": lambda: tables.rasterization(runs),
        "table-lookup": lambda: tables.lookup(runs),
    }}


def rewrite(folder: Path, runs: list[Run], about: dict[str, str]) -> list[str]:
    """@return the names of parts for which there are no figures"""
    return [part for page, parts in _parts(runs, about).items()
            for part in rewrite_page(folder / page, parts)]


def rewrite_page(document: Path, parts: Parts) -> list[str]:
    """@return as rewrite()"""
    missing = []

    def replacement(match: re.Match[str]) -> str:
        name = match.group(2)
        if name not in parts:
            raise SystemExit(f"{document}: nothing generates a part named {name}.")
        text = parts.pop(name)()
        if not text:
            # Old figures must not stand beside the new description of the machine.
            missing.append(name)
            text = "Not measured.\n"
        return f"{match.group(1)}{text}{match.group(3)}"

    text = PART.sub(replacement, document.read_text(encoding="utf-8"))
    if parts:
        raise SystemExit(f"{document} has no place for {', '.join(parts)}.")
    document.write_text(text, encoding="utf-8")
    return missing
