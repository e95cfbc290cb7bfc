"""Quality of the pictures of a moving camera, chosen from the times that frames took.

Each level costs less than the one before. A level has become slower when two frames in a row were, and faster when
three were; then the others are taken to have become so as well, as where the camera comes nearer. The first frame of a
level compiles programs and copies data, and the first after another level's says only that something else was expected
of it: neither says anything of other levels. Those that have drawn nothing yet are reckoned from the finest.
"""

from __future__ import annotations

from collections import deque
from typing import NamedTuple

BUDGET = 0.075  # seconds that a moving frame may take to draw; browser and network take theirs beside it
ROOM = 0.6  # of the budget; a finer level is taken where it costs less than that


class Level(NamedTuple):
    """The quality of a frame."""

    size: float  # share of the width and of the height that is drawn
    off: float  # error of lines in drawn pixels
    share: float  # of the streamlines of large sets
    cost: float  # its expected cost before it has drawn anything, if the finest takes 1


LEVELS = (
    Level(1.0, 0.0, 1.0, 1.0),
    Level(0.5, 1.0, 1.0, 0.55),
    Level(0.5, 1.0, 0.25, 0.2),
    Level(0.35, 2.0, 0.25, 0.13),
    Level(0.35, 2.0, 0.0625, 0.06),
)
"""No haste to most. Costs: the median frame of a brain of 6 million segments, 0.5 mm each, by software OpenGL."""


class Pace:
    """The level of the next frame."""

    def __init__(self) -> None:
        self._costs: dict[Level, float] = {}
        self._first: set[Level] = set()  # levels that have drawn one frame, which compiled and copied
        self._drawn: Level | None = None
        self._run: deque[float] = deque(maxlen=3)  # of that level, since another one drew
        self._scale = 0.0  # seconds for a cost of 1; nothing is slow before the first frame
        self.level = LEVELS[0]  # that of the next frame of a moving camera

    def took(self, level: Level, seconds: float, *, moved: bool = True) -> None:
        """Note how long a frame took to draw; where the camera has not moved since, it may take less than others do."""
        if level is not self._drawn:
            self._drawn = level
            self._run.clear()
        before = self._costs.get(level)
        if before is None:
            self._costs[level], self._scale = seconds, self._scale or seconds / level.cost
            self._first.add(level)
        elif moved or seconds > before:
            self._run.append(seconds)
            self._learn(level, before)
        if level is LEVELS[0]:
            self._scale = self._costs[level] / level.cost

    def _learn(self, level: Level, before: float) -> None:
        newest = self._run[-1]
        if level in self._first:
            self._first.discard(level)
            self._costs[level] = newest
            return
        if len(self._run) == 1:  # its estimate was wrong, or the machine is busy: other levels have not changed
            self._costs[level] = min(newest, (before * newest) ** 0.5)
            return
        slower, faster = min(list(self._run)[-2:]), max(self._run) if len(self._run) == 3 else before
        change = (slower if slower > before else min(faster, before)) / before
        self._scale *= change
        for other in self._costs:
            self._costs[other] *= change

    def choose(self) -> Level:
        """Choose the level of the next frame: the finest that the budget has time for."""
        finer = LEVELS.index(self.level)
        limits = (BUDGET * (ROOM if k < finer else 1.0) for k in range(len(LEVELS)))
        fits = (level for level, limit in zip(LEVELS, limits, strict=True) if self.expected(level) <= limit)
        self.level = next(fits, LEVELS[-1])
        return self.level

    @property
    def untried(self) -> bool:
        """Whether a moving frame would be drawn by a level that has drawn none yet."""
        return self.choose() not in self._costs

    def expected(self, level: Level) -> float:
        """Return the seconds that a level is expected to take; 0 before the first frame."""
        expected = self._scale * level.cost
        known = self._costs.get(level, expected)
        return min(known, expected) if level in self._first and level is not LEVELS[0] else known
