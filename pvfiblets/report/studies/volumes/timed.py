"""How the study of volumes draws and times: variants of one data set take turns, for as long as there is time."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

from ...cameras import Camera
from ...drawing import LATE
from ...record import FRAME, LeftOut, Record
from ...study import Options
from ..codec.errors_and_times import Turns

__all__ = ["Timed", "drawing", "drawn", "sample"]


class Timed:
    """Records of one data set whose pictures are timed by turns once all are there."""

    def __init__(self, turns: Turns, options: Options, name: str, what: str) -> None:
        self._options, self._name = options, name
        self._turns, self._what = turns, what
        self._done: list[tuple[Record, int, int]] = []
        self._late: list[str] = []
        self._budget = options.budget.share()  # the reference is no measurement

    def allows(self, label: str) -> bool:
        """Say whether there is time for one more; if not, it is left out and named."""
        if self._budget.allows():
            return True
        self._late.append(label)
        return False

    def add(self, record: Record, draw: Callable[[], object], frames: int) -> None:
        """Take in a record, and what draws so many pictures of it."""
        self._done.append((record, self._turns.add(draw), frames))

    def finish(self, left_out: list[LeftOut]) -> Iterator[Record]:
        """Time all, and yield the records."""
        self._turns.run(self._options.repeats, self._budget.allows)
        for record, number, frames in self._done:
            record.times[self._what] = self._turns.timing(number, frames, FRAME)
            yield record
        if self._late:
            left_out.append(LeftOut(f"{self._name}: {', '.join(self._late)}", LATE))
        self._options.log(f"volumes: {self._name}: {len(self._done)} variants")


def drawn(ctx: Any, renderer: Any, camera: Camera, style: Any) -> Any:
    """Draw a picture, wait for it, and return its G-buffer."""
    from pvfiblets.engine import View

    buffer = renderer.render(View(camera.size, camera.model_view_projection), style)
    ctx.finish()
    return buffer


def drawing(ctx: Any, renderer: Any, style: Any) -> Callable[[Camera], object]:
    """Return what draws a camera's picture in one style."""
    return lambda camera: drawn(ctx, renderer, camera, style)


def sample(mask: npt.NDArray[np.bool_], count: int) -> npt.NDArray[np.int64]:
    """Return rows and columns, ``(n, 2)``, of so many pixels of a mask at most."""
    return np.random.default_rng(0).permutation(np.argwhere(mask))[:count]
