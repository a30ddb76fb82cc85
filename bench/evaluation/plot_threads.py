"""Time against the number of threads."""

from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator, NullFormatter, NullLocator, StrMethodFormatter

from evaluation import style
from evaluation.results import Run, select

# Those that bench/extract_bench.cpp measures with more than two threads.
MAPS = ("sphere_blocks_million", "sphere_blocks_middle", "sphere_blocks_high",
        "s17c_sphere_r100_x2")


def _draw_map(axes: Axes, found: list[Run]) -> None:
    for engine, color in style.ENGINE_COLOR.items():
        line = sorted((run.threads, run["seconds"]) for run in found if run.engine == engine)
        if not line:
            continue
        threads, seconds = zip(*line)
        axes.plot(threads, seconds, color=color, marker="o")
        axes.plot(threads, [seconds[0] * threads[0] / n for n in threads], color=color,
                  linestyle=":", linewidth=1.2)
        for n, s in line[1:]:
            axes.annotate(f"{seconds[0] / s:.2f}x", (n, s), textcoords="offset points",
                          xytext=(-6, 7), ha="center", color=color, fontsize=10)
    counts = sorted({run.threads for run in found})
    axes.set_xscale("log", base=2)
    axes.set_yscale("log")
    axes.set_xticks(counts, [str(count) for count in counts])
    axes.xaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_major_locator(LogLocator(subs=(1, 2, 3, 4, 5, 7)))
    axes.yaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.margins(x=0.15, y=0.2)
    axes.set_xlabel("threads")


def _legend() -> list[Line2D]:
    handles = [Line2D([], [], color=color, marker="o", label=f"{engine} engine")
               for engine, color in style.ENGINE_COLOR.items()]
    return [*handles, Line2D([], [], color=style.GREY, linestyle=":", linewidth=1.2,
                             label="time of one thread / threads")]


def draw(runs: list[Run], path: Path) -> Path | None:
    found = select(runs, "extract")
    maps = [name for name in MAPS if any(run.map == name for run in found)]
    if not maps:
        return None
    made, panels = style.figure(1, len(maps), (2.7 * len(maps), 3.8))
    for axes, name in zip(panels, maps):
        of_map = [run for run in found if run.map == name]
        _draw_map(axes, of_map)
        axes.set_title(f"{name}\n{style.short(of_map[0].density)} hexes per tet")
    panels[0].set_ylabel("time [s]")
    below = 0.12  # of the height, for the legend
    made.get_layout_engine().set(rect=(0, below, 1, 1 - below))
    made.legend(handles=_legend(), loc="lower center", ncols=3, frameon=False)
    return style.save(made, path)
