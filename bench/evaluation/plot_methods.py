"""Methods of single steps beside each other: the paper's Figures 22 and 23."""

from pathlib import Path

from matplotlib.axes import Axes

from evaluation import style
from evaluation.results import Run, select

RASTERIZATION = {"box": ("bounding box", style.GREY), "epsilon": ("lines, epsilon", style.RED),
                 "lines": ("lines", style.BLUE)}
LOOKUP = {"list": ("list", style.GREY), "hash": ("hash table", style.RED),
          "table": ("table", style.BLUE)}


def _draw_methods(axes: Axes, found: list[Run], methods: dict[str, tuple[str, str]],
                  per: str) -> None:
    for i, (method, (label, color)) in enumerate(methods.items()):
        line = sorted((run["points"] / run["tets"], run["ms"] * 1e6 / run[per])
                      for run in found if run.keys["method"] == method)
        if line:
            axes.plot(*zip(*line), color=color, marker=style.MARKERS[i], label=label)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("lattice points per tet")
    axes.legend(frameon=False)


def draw(runs: list[Run], path: Path) -> Path | None:
    rasterization, lookup = select(runs, "rasterization"), select(runs, "lookup")
    if not rasterization or not lookup:
        return None
    made, (left, right) = style.figure(1, 2, (8.6, 3.8))
    _draw_methods(left, rasterization, RASTERIZATION, "points")
    left.set_title("rasterization")
    left.set_ylabel("time per lattice point [ns]")
    _draw_methods(right, lookup, LOOKUP, "queries")
    right.set_title("look-up of a vertex")
    right.set_ylabel("time per look-up [ns]")
    return style.save(made, path)
