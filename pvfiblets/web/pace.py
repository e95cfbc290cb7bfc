"""How coarse the pictures of a moving camera are: chosen from the times that frames took.

Each level costs less than the one before. What a level costs is the least of the last two frames that it drew, since a
frame may have compiled a program or waited for another process. Levels that have drawn nothing yet are reckoned from
those that have, and when a level becomes faster or slower, as where the camera comes nearer, the others are taken to
become so as well.
"""

from __future__ import annotations

from collections import deque
from typing import NamedTuple

__all__ = ["BUDGET", "LEVELS", "Level", "Pace"]

BUDGET = 0.075  # seconds that a moving frame may take to draw; browser and network take theirs beside it
ROOM = 0.6  # of the budget; a finer level is taken where it costs less than that


class Level(NamedTuple):
    """How a frame is drawn.

    Attributes
    ----------
    size : float
        Share of the width and of the height that is drawn.
    off : float
        Drawn pixels by which lines may be off.
    share : float
        Of the streamlines of large sets.
    cost : float
        What is expected of it before it has drawn anything, if the finest takes 1.
    """

    size: float
    off: float
    share: float
    cost: float


LEVELS = (
    Level(1.0, 0.0, 1.0, 1.0),
    Level(0.5, 1.0, 1.0, 0.55),
    Level(0.5, 1.0, 0.25, 0.2),
    Level(0.35, 2.0, 0.25, 0.13),
    Level(0.35, 2.0, 0.0625, 0.06),
)
"""No haste to most. Costs: the median frame of a brain of 6 million segments, 0.5 mm each, by software OpenGL."""


class Pace:
    """The level of the next frame.

    Attributes
    ----------
    level : Level
        That of the next frame of a moving camera.
    """

    def __init__(self) -> None:
        self._times: dict[Level, deque[float]] = {}
        self._scale = 0.0  # seconds for a cost of 1, by the last frame; nothing is slow before the first
        self.level = LEVELS[0]

    def took(self, level: Level, seconds: float) -> None:
        """Note how long a frame took to draw."""
        before = self._cost(level) if level in self._times else None
        times = self._times.setdefault(level, deque(maxlen=2))
        times.append(seconds)
        now = min(times)
        if before is None:
            self._scale = now / level.cost
            return
        change = now / before
        self._scale *= change
        for other, its in self._times.items():
            if other is not level:
                self._times[other] = deque((change * time for time in its), maxlen=2)

    def choose(self) -> Level:
        """Choose the level of the next frame: the finest that the budget has time for."""
        finer = LEVELS.index(self.level)
        limits = (BUDGET * (ROOM if k < finer else 1.0) for k in range(len(LEVELS)))
        fits = (level for level, limit in zip(LEVELS, limits, strict=True) if self._cost(level) <= limit)
        self.level = next(fits, LEVELS[-1])
        return self.level

    @property
    def untried(self) -> bool:
        """Whether a moving frame would be drawn by a level that has drawn none yet."""
        return self.choose() not in self._times

    def _cost(self, level: Level) -> float:
        """Return the seconds that a level is expected to take."""
        return min(self._times[level]) if level in self._times else self._scale * level.cost
