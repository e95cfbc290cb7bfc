"""How far the encoder may turn segments, in plain NumPy and float64; :mod:`.turn_kernels` compute the same.

Symbols: ``u`` and ``v`` are the unit vectors of the segments before and after a point, ``u'`` and ``v'`` what they
decode to, and ``A`` is the largest angle that is promised between the tangents, which are the directions of
``S = u + v`` and of ``S' = u' + v'``. From ``|S' - S| <= |u' - u| + |v' - v|`` follows that the angle between both is
at most ``A`` where

    ``|u' - u| <= sin(A) |S| / 2`` and ``|v' - v| <= sin(A) |S| / 2``.

Each segment so has a bound of its own, the lesser of those at its two ends, whatever its neighbours decode to: fiblets
can be coded apart from each other. At the end of a line there is one segment only, and it has the whole bound. The
sharper the bend, the shorter is ``S``, and the finer are its two segments coded.

Points at which no segment longer than a pixel ends, and those where a line turns back on itself, bound nothing.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .tangents import LEAST_SUM, ONE_POINT

__all__ = ["Turns", "may_turn"]

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Turns:
    """Directions of consecutive segments, and how far each may be turned.

    Attributes
    ----------
    units : numpy.ndarray
        ``(n, 3)`` unit vectors, or none.
    allowed : numpy.ndarray
        ``(n,)`` largest distance of a unit vector that is drawn instead; infinite where any will do.
    """

    units: Array
    allowed: Array

    def __getitem__(self, part: slice) -> Turns:
        return Turns(self.units[part], self.allowed[part])

    def excess(self, decoded: Array, following: Array | None = None) -> float:
        """Greatest ratio of a turn to what is allowed.

        Parameters
        ----------
        decoded : numpy.ndarray
            ``(n, 3)`` decoded points that the segments lead on from.
        following : numpy.ndarray, optional
            ``(3,)`` decoded point that the last segment leads to; without it there is none.
        """
        points = decoded if following is None else np.concatenate([decoded, following[None]])
        worst = 0.0
        for i in range(len(points) - 1):
            if self.allowed[i] < np.inf:
                drawn, _ = _unit(points[i + 1] - points[i])
                worst = max(worst, _size(drawn - self.units[i]) / float(self.allowed[i]))
        return worst


def may_turn(line: Array, shortest: float, angle: float) -> Turns:
    """How far the segments of a streamline may be turned.

    Parameters
    ----------
    line : numpy.ndarray
        ``(n, 3)`` its points, mm.
    shortest : float
        Only segments longer than this count, mm.
    angle : float
        Largest angle between true and drawn tangents, degrees.

    Returns
    -------
    Turns
        Of its ``n - 1`` segments.
    """
    found = [_unit(line[i + 1] - line[i]) for i in range(len(line) - 1)]
    units = [unit if length > shortest * ONE_POINT else np.zeros(3) for unit, length in found]
    longer = [length > shortest for _, length in found]
    allowed = np.full(len(found), np.inf)
    for i in range(len(line)):
        around = [k for k in (i - 1, i) if 0 <= k < len(found)]
        tangent = _size(sum((units[k] for k in around), np.zeros(3)))
        if any(longer[k] for k in around) and tangent > LEAST_SUM:
            limit = np.sin(np.radians(angle)) * tangent
            for k in around:
                allowed[k] = min(allowed[k], limit * 0.5 if len(around) == 2 else limit)
    return Turns(np.array(units).reshape(-1, 3), allowed)


def _unit(v: Array) -> tuple[Array, float]:
    largest = float(np.abs(v).max())
    if largest == 0.0:
        return np.zeros(3), 0.0
    v = v / largest
    size = _size(v)
    return v / size, size * largest


def _size(v: Array) -> float:
    return float(np.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]))
