"""How all plots look: opaque white, so that they read on dark pages too; colours of Okabe and Ito,
which colour-blind people can tell apart; text as text, so that files stay small."""

from pathlib import Path

import matplotlib

matplotlib.use("svg")

from matplotlib import pyplot  # noqa: E402  (after the choice of the backend)
from matplotlib.axes import Axes  # noqa: E402
from matplotlib.figure import Figure  # noqa: E402

BLACK = "#000000"
ORANGE = "#E69F00"
SKY = "#56B4E9"
GREEN = "#009E73"
YELLOW = "#F0E442"
BLUE = "#0072B2"
RED = "#D55E00"
PURPLE = "#CC79A7"
GREY = "#999999"

ENGINE_COLOR = {"atlas": BLUE, "propeller": RED}
MARKERS = ("o", "s", "^", "D", "v", "P")
LINES = ("-", "--", ":", "-.")

pyplot.rcParams.update({
    "figure.facecolor": "white",
    "savefig.facecolor": "white",
    "svg.fonttype": "none",
    "svg.hashsalt": "hexhex",  # the same figures give the same file
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans", "Verdana", "Arial", "sans-serif"],
    "font.size": 11,
    "axes.titlesize": 11,
    "legend.fontsize": 10,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#dddddd",
    "grid.linewidth": 0.7,
    "lines.linewidth": 1.8,
    "lines.markersize": 5,
})


def short(value: float) -> str:
    """Two significant digits, no exponent."""
    return f"{value:.2g}" if value < 100 else f"{value:.0f}"


def figure(rows: int, columns: int, size: tuple[float, float],
           same_y: bool = False) -> tuple[Figure, list[Axes]]:
    """@param size  of the whole figure, in inches"""
    made, axes = pyplot.subplots(rows, columns, figsize=size, squeeze=False, sharey=same_y,
                                 layout="constrained")
    return made, [one for row in axes for one in row]


def save(made: Figure, path: Path) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    made.savefig(path, format="svg", metadata={"Date": None, "Creator": None})
    pyplot.close(made)
    # Editors and diffs dislike blanks at the ends of lines.
    lines = path.read_text(encoding="utf-8").splitlines()
    path.write_text("\n".join(line.rstrip() for line in lines) + "\n", encoding="utf-8")
    return path
