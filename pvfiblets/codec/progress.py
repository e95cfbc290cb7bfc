"""Progress of work that goes through streamlines chunk by chunk: a bar, or a function that is called."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import TypeAlias

from ..streamlines import Streamlines
from ..support.progress_bar import progress_bar

Progress: TypeAlias = bool | Callable[[str, float], None]
"""Whether to show a bar; or a function of the step's name and finished share, 0 to 1."""


def shown(chunks: Iterable[Streamlines], total: int | None, what: str, progress: Progress) -> Iterator[Streamlines]:
    """Yield chunks, and show how far they have come."""
    if callable(progress):
        done = 0
        for chunk in chunks:
            progress(what, done / total if total else 0.0)
            yield chunk
            done += chunk.n_points
        return
    with progress_bar(progress, total=total, desc=what, unit="points", unit_scale=True) as bar:
        for chunk in chunks:
            yield chunk
            bar.update(chunk.n_points)
