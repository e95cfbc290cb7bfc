"""`Pieces`: one frame drawn piece by piece, so that its caller can handle events in between.

A drawing function that can be left between pieces is a generator: it yields where a piece ends and resumes on demand.
Meanwhile others may draw, into anything but this picture's own target, so bindings are made anew.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Generator, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from .gl.passes import Passes

PIECE = 0.05  # seconds of a piece, about: as long as an event waits that comes while one is drawn

FIRST = 8  # work groups of a stage whose time is not known yet: some 2,000 fiblets

GROWTH = 4  # greatest ratio of groups tried at once to the most so far

Found = TypeVar("Found")


class Pieces:
    """Ends of one picture's pieces, by the times of earlier ones."""

    def __init__(
        self,
        passes: Passes,  # whose clock stands while others draw
        again: Callable[[], Any],  # binds what drawing programs need, as others may have bound something else
        # seconds of a work group and the most groups so far, by stage: learnt here, and kept from picture to picture
        known: dict[str, tuple[float, int]],
        seconds: float = PIECE,  # of a piece
    ) -> None:
        self._passes = passes
        self._again = again
        self._known = known
        self._seconds = seconds
        self._begun = passes.clock()

    @property
    def due(self) -> bool:
        """Whether the piece has taken about as long as one is to take."""
        return self._passes.clock() - self._begun >= 0.8 * self._seconds

    def pause(self) -> Iterator[None]:
        """Pause for others to draw, and go on with another piece."""
        with self._passes.away():
            yield
        self._again()
        self._begun = self._passes.clock()

    def groups(self, stage: str, left: int) -> int:
        """Return how many work groups of a stage there is time for in this piece, one at least."""
        each, most = self._known.get(stage, (0.0, 0))
        if not most:
            return min(FIRST, left)
        time_left = self._begun + self._seconds - self._passes.clock()
        return max(1, min(int(time_left / max(each, 1e-7)), GROWTH * most, left))

    @contextmanager
    def measured(self, stage: str, groups: int) -> Iterator[None]:
        """Learn how long so many groups of a stage take, where OpenGL is done when a call returns."""
        began = time.perf_counter()
        yield
        each = (time.perf_counter() - began) / groups
        before, most = self._known.get(stage, (each, 0))
        # Groups differ: where they have become slower, the next piece is to be shorter at once.
        self._known[stage] = max(each, 0.5 * (before + each)), max(most, groups)


def finish(steps: Generator[None, None, Found]) -> Found:
    """Draw all pieces, and return what the generator returns."""
    while True:
        try:
            next(steps)
        except StopIteration as end:
            return end.value
