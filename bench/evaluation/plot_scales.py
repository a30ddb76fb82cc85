"""Time against the number of hexahedra: the paper's Table 5 as a plot."""

from pathlib import Path

from matplotlib.lines import Line2D

from evaluation import style
from evaluation.results import Run, select


def _legend(maps: list[str]) -> list[Line2D]:
    handles = [Line2D([], [], color=color, label=f"{engine} engine")
               for engine, color in reversed(style.ENGINE_COLOR.items())]
    handles.append(Line2D([], [], color=style.GREY, label="copying the result"))
    for i, name in enumerate(maps):
        handles.append(Line2D([], [], color="#444444", marker=style.MARKERS[i],
                              linestyle=style.LINES[i], label=name))
    return handles


def draw(runs: list[Run], path: Path) -> Path | None:
    found = select(runs, "scale")
    if not found:
        return None
    maps = list(dict.fromkeys(run.map for run in found))
    made, (axes,) = style.figure(1, 1, (7.2, 4.8))
    for i, name in enumerate(maps):
        look = {"marker": style.MARKERS[i], "linestyle": style.LINES[i]}
        for engine, color in style.ENGINE_COLOR.items():
            line = sorted((run["hexes"], run["seconds"])
                          for run in found if run.map == name and run.engine == engine)
            if line:
                axes.plot(*zip(*line), color=color, **look)
        copy = sorted((run["hexes"], run["seconds_of_copy"])
                      for run in found if run.map == name and run.engine == "atlas")
        if copy:
            axes.plot(*zip(*copy), color=style.GREY, linewidth=1, markersize=3,
                      marker=style.MARKERS[i], linestyle=style.LINES[i])
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("hexahedra")
    axes.set_ylabel("time of one thread [s]")
    axes.legend(handles=_legend(maps), frameon=False)
    return style.save(made, path)
