"""`CullingChoice`: whether the next picture is drawn with two-phase culling or without, by what pictures took.

Two-phase culling changes no pixel, so that it can be switched on and off from picture to picture. What it costs, a
pyramid of depth twice and two passes over all fiblets, it saves where much is hidden: of a whole brain from 6 million
segments on, on the machines that were measured; with the camera inside it costs up to two thirds more than it saves.

From time to time some pictures are drawn the other way, and the faster way is kept. Trials grow rarer the longer the
answer stays the same: 3 pictures of 40, then of 80, up to 320.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterator
from contextlib import contextmanager

from ..gl.picture_clock import PictureClock

FEW_FIBLETS = 20_000
"""Fewer, 1.2 million points, are never worth it: nothing is tried, and nothing of it is compiled."""

SHORTEST, LONGEST = 40, 320  # pictures from trial to trial
TRIAL = 3  # pictures of the other kind; the first, which still lacks what the last one showed, does not count
FASTER = 0.95  # of the time, to be worth a change


class CullingChoice:
    """Decides picture by picture."""

    def __init__(self, clock: PictureClock, culling: bool = True) -> None:
        self.culling = culling  # the faster method, once measured
        self._clock = clock
        self._planned: list[tuple[bool, bool]] = []  # whether culled, and whether its time counts
        self._times: dict[bool, list[float]] = {True: [], False: []}
        self._awaited = 0
        self._period = SHORTEST
        self._left = 4  # pictures to the next trial: the first ones compile
        self._key: Hashable = None
        self._trial = 0

    def next(self, key: Hashable) -> bool:
        """Return whether the next picture is culled."""
        self._look()
        if key != self._key:
            self._key = key
            self.start_over()
        if not self._planned and not self._awaited:
            self._left -= 1
            if self._left <= 0:
                self._plan()
        return self._planned[0][0] if self._planned else self.culling

    @contextmanager
    def drawing(self) -> Iterator[None]:
        """Time the picture that :meth:`next` decided on, if its time counts."""
        planned = self._planned.pop(0) if self._planned else None
        if planned is None or not planned[1]:
            yield
            return
        with self._clock.timed((self._trial, planned[0])):
            yield

    def _plan(self) -> None:
        self._trial += 1
        self._times = {True: [], False: []}
        now, other = self.culling, not self.culling
        self._planned = [*[(now, True)] * (TRIAL - 1), (other, False), *[(other, True)] * (TRIAL - 1)]
        self._awaited = 2 * (TRIAL - 1)

    def _look(self) -> None:
        """Record finished pictures, and decide once all pictures of a trial have finished."""
        for (trial, culled), seconds in self._clock.finished():
            if trial == self._trial and self._awaited:
                self._times[culled].append(seconds)
                self._awaited -= 1
                if self._awaited == 0:
                    self._decide()

    def _decide(self) -> None:
        if min(self._times[not self.culling]) < FASTER * min(self._times[self.culling]):
            self.culling = not self.culling
            self._period = SHORTEST
        else:
            self._period = min(2 * self._period, LONGEST)
        self._left = self._period

    def start_over(self) -> None:
        """Try again soon: the scene has changed, or a picture was aborted."""
        self._planned, self._awaited, self._trial = [], 0, self._trial + 1
        self._period, self._left = SHORTEST, 4

    def release(self) -> None:
        """Give the clock's queries back; twice is harmless."""
        self._clock.release()
