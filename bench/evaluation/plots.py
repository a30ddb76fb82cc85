"""All plots of docs/results/performance.md."""

from pathlib import Path

from evaluation import plot_density, plot_methods, plot_scales, plot_threads
from evaluation.results import Run


def draw_all(runs: list[Run], folder: Path) -> list[Path]:
    """Draws what there are figures for; other files stay as they are.

    @return the files that were written
    """
    drawn = [
        plot_scales.draw(runs, folder / "scales.svg"),
        plot_threads.draw(runs, folder / "threads.svg"),
        plot_density.draw(runs, folder / "density.svg"),
        plot_methods.draw(runs, folder / "methods.svg"),
    ]
    return [path for path in drawn if path is not None]
