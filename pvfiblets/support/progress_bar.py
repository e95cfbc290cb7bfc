"""A progress bar. Without one, tqdm is not imported."""

from __future__ import annotations

from contextlib import AbstractContextManager, nullcontext
from typing import Any


class _NoBar:
    """A progress bar that shows nothing."""

    total: float | None = None

    def update(self, n: float | None = 1) -> None:
        """Forget it."""


def progress_bar(show: bool, **settings: Any) -> AbstractContextManager[Any]:
    """Return a bar, to be entered with ``with`` and told of every step by ``update(n)``."""
    if not show:
        return nullcontext(_NoBar())
    from tqdm import tqdm

    bar: AbstractContextManager[Any] = tqdm(**settings)
    return bar
