"""Greatest turns that the encoder may make, in plain NumPy and float64; `pvfiblets.codec.tangents` says why."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from pvfiblets.codec.layout import MAX_POINTS
from pvfiblets.codec.tangents import LEAST_SUM, ONE_POINT

FIRST_SHARE = 0.8
LOOK_BACK = 20

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Turns:
    """Directions of consecutive segments, and how far each may be turned."""

    units: Array  # `(n, 3)` unit vectors, or none
    allowed: Array  # `(n,)` largest distance of a unit vector that is drawn instead; infinite where any will do
    # `(n,)` distance of each unit vector from the tangent where its segment begins, 0 where that bounds nothing
    bends: Array
    # `(n,)` as `allowed` where a fiblet begins with the segment, though not the streamline; -1 where none should
    first: Array

    def __getitem__(self, part: slice) -> Turns:
        return Turns(self.units[part], self.allowed[part], self.bends[part], self.first[part])

    def excess(self, decoded: Array, following: Array | None = None) -> float:
        """Greatest ratio of a turn to its bound in a fiblet."""
        points = decoded if following is None else np.concatenate([decoded, following[None]])
        worst = 0.0
        for i in range(len(points) - 1):
            allowed = float(self.allowed[i])
            if i == 0 and self.first[0] >= 0.0:
                allowed = min(allowed, float(self.first[0]))
            if allowed < np.inf:
                drawn, _ = _unit(points[i + 1] - points[i])
                worst = max(worst, _size(drawn - self.units[i]) / allowed)
        return worst


def may_turn(line: Array, shortest: float, angle: float) -> Turns:
    """Return the greatest turns of the segments of a streamline."""
    found = [_unit(line[i + 1] - line[i]) for i in range(len(line) - 1)]
    units = [unit if length > shortest * ONE_POINT else np.zeros(3) for unit, length in found]
    longer = [length > shortest for _, length in found]
    allowed, first, bends = np.full(len(found), np.inf), np.full(len(found), np.inf), np.zeros(len(found))
    chord = 2.0 * np.sin(0.5 * np.radians(angle))
    for i in range(len(line)):
        around = [k for k in (i - 1, i) if 0 <= k < len(found)]
        total = sum((units[k] for k in around), np.zeros(3))
        tangent = _size(total)
        if any(longer[k] for k in around) and tangent > LEAST_SUM:
            limit = np.sin(np.radians(angle)) * tangent
            for k in around:
                allowed[k] = min(allowed[k], limit * 0.5 if len(around) == 2 else limit)
            if len(around) == 2:
                bends[i] = _size(total / tangent - units[i])
                rest = chord - bends[i]
                first[i] = rest if rest >= (1.0 - FIRST_SHARE) * chord else -1.0
    return Turns(np.array(units).reshape(-1, 3), allowed, bends, first)


def cut(turns: Turns, angle: float) -> list[int]:
    """Return the starts of a streamline's slots, at most 60 points after each other."""
    # A slot ends before its 60th point where the line bends there by more than the first point of a fiblet may: at the
    # next point before at which it does not, or at that of the least bend among 20.
    n = len(turns.units) + 1
    enough = FIRST_SHARE * 2.0 * np.sin(0.5 * np.radians(angle))

    def sharpness(i: int) -> float:
        return (
            float(turns.bends[i]) if i + 1 < n and turns.bends[i] > enough else 0.0
        )  # a single point draws no segment

    begins = [0]
    while n - begins[-1] > MAX_POINTS:
        last = begins[-1] + MAX_POINTS
        begins.append(min(range(last, last - LOOK_BACK, -1), key=sharpness))
    return begins


def _unit(v: Array) -> tuple[Array, float]:
    largest = float(np.abs(v).max())
    if largest == 0.0:
        return np.zeros(3), 0.0
    v = v / largest
    size = _size(v)
    return v / size, size * largest


def _size(v: Array) -> float:
    return float(np.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]))
