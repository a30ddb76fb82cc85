"""The share of each stage against density: the paper's Figure 18."""

from pathlib import Path

from matplotlib.axes import Axes

from evaluation import style
from evaluation.results import Run, select

# Stages that are drawn as one: what they do, and their color. Stages of the same kind have the same
# color in both panels.
_INPUT = {
    "topology": (("input", "topology", "regular vertices"), style.BLACK),
    "transitions, singularities": (("unfolding", "transitions", "singularities"), style.BLUE),
    "sanitization": (("sanitization", "scaling"), style.SKY),
}
GROUPS: dict[str, dict[str, tuple[tuple[str, ...], str]]] = {
    "atlas": _INPUT | {
        "vertices": (("sweep", "vertices", "grid"), style.GREEN),
        "charts, overlaps, cuts": (("charts", "overlaps", "cuts"), style.YELLOW),
        "cells": (("centers", "cells"), style.RED),
    },
    "propeller": _INPUT | {
        "vertices": (("vertices",), style.GREEN),
        "local connectivity": (("stars", "local connectivity"), style.YELLOW),
        "global connectivity": (("global connectivity",), style.ORANGE),
        "cells": (("cells",), style.RED),
    },
}
REST = "everything else"


def describe_groups(runs: list[Run]) -> str:
    """Which of the stages that ran are in each group, in Markdown."""
    lines = []
    for engine, groups in GROUPS.items():
        ran = {name for run in select(runs, "density", engine=engine) for name in run.stages}
        parts = []
        for label, (names, _) in groups.items():
            inside = [name for name in names if name in ran]
            ran -= set(inside)
            if inside and ", ".join(inside) != label:
                parts.append(f"*{label}*: " + ", ".join(f"`{name}`" for name in inside))
        if ran:
            parts.append(f"*{REST}*: " + ", ".join(f"`{name}`" for name in sorted(ran)))
        if parts:
            lines.append(f"- {engine} engine: " + "; ".join(parts) + ".\n")
    return "".join(lines)


def _shares(run: Run) -> dict[str, float]:
    """Of the time of the whole extraction, by group."""
    times = run.stages
    shares = {label: sum(times.get(name, 0.0) for name in names) / run["seconds"]
              for label, (names, _) in GROUPS[run.engine].items()}
    shares[REST] = max(0.0, 1 - sum(shares.values()))
    return shares


def _draw_engine(axes: Axes, engine: str, found: list[Run]) -> None:
    found = sorted(found, key=lambda run: run.density)
    shares = [_shares(run) for run in found]
    colors = {label: color for label, (_, color) in GROUPS[engine].items()} | {REST: style.GREY}
    bottoms = [0.0] * len(found)
    for label, color in colors.items():
        heights = [100 * share[label] for share in shares]
        axes.bar(range(len(found)), heights, bottom=bottoms, width=0.82, color=color, label=label,
                 edgecolor="white", linewidth=0.6)
        bottoms = [bottom + height for bottom, height in zip(bottoms, heights)]
    for i, run in enumerate(found):
        axes.text(i, 102, f"{run['seconds']:.2f} s", ha="center", fontsize=9)
    axes.set_xticks(range(len(found)), [style.short(run.density) for run in found])
    axes.set_ylim(0, 108)
    axes.set_yticks(range(0, 101, 25))
    axes.grid(axis="x", visible=False)
    axes.set_ylabel("share of the time [%]")
    axes.set_title(f"{engine} engine", pad=4, loc="left", fontweight="bold")
    handles, labels = axes.get_legend_handles_labels()
    axes.legend(reversed(handles), reversed(labels), loc="center left", bbox_to_anchor=(1.0, 0.5),
                frameon=False)


def draw(runs: list[Run], path: Path) -> Path | None:
    engines = {engine: select(runs, "density", engine=engine) for engine in GROUPS}
    if not all(engines.values()):
        return None
    made, panels = style.figure(2, 1, (8.6, 6.4))
    for axes, (engine, found) in zip(panels, engines.items()):
        _draw_engine(axes, engine, found)
    panels[-1].set_xlabel("hexahedra per tet")
    return style.save(made, path)
