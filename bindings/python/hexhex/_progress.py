"""Progress shown by a tqdm bar."""

from __future__ import annotations

from typing import Any


class TqdmProgress:
    """A progress function that shows a tqdm bar, in terminals and notebooks. The bar closes when
    the work is done, or at the end of a ``with`` statement.

    >>> import hexhex
    >>> with hexhex.TqdmProgress(disable=True) as progress:  # other arguments are those of tqdm
    ...     mesh = hexhex.extract(hexhex.generate("box"), progress=progress)

    Raises:
        ImportError: without tqdm.
    """

    def __init__(self, **options: Any) -> None:
        from tqdm.auto import tqdm

        form = "{l_bar}{bar}| {elapsed}<{remaining}"
        self._bar = tqdm(**{"total": 1.0, "bar_format": form, "leave": True, **options})

    def __call__(self, stage: str, share: float) -> None:
        """Shows the completed fraction and the name of the current stage."""
        self._bar.set_description(stage, refresh=False)
        step = share - self._bar.n
        if step > 0:
            self._bar.update(step)
        if share >= 1:
            self._bar.refresh()

    def __enter__(self) -> TqdmProgress:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Closes the bar and leaves it as it is."""
        self._bar.close()
