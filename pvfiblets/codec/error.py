"""How far decoded points are from their originals."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from ..streamlines import Streamlines
from .fibletset import FibletSet

__all__ = ["CodingError", "ErrorTally", "measure_error"]

_BINS = 20_000  # of the histogram that the percentile is read from: five-thousandths of a percent of the promise each


@dataclass(frozen=True)
class CodingError:
    """Distances between original and decoded points.

    Attributes
    ----------
    max_mm, mean_mm, p999_mm : float
        Largest, mean and 99.9th percentile, mm.
    max_steps, mean_steps, p999_steps : float
        The same in median steps (NaN where there is no step).
    streamline_max_mm, streamline_mean_mm : numpy.ndarray
        ``(n_streamlines,)`` by streamline, NaN for those without points; empty where only a summary was asked for.
    """

    max_mm: float
    mean_mm: float
    p999_mm: float
    max_steps: float
    mean_steps: float
    p999_steps: float
    streamline_max_mm: npt.NDArray[np.float64]
    streamline_mean_mm: npt.NDArray[np.float64]

    def summary(self) -> dict[str, dict[str, float]]:
        """``{'error_mm': {max, mean, p999}, 'error_steps': {...}}``."""
        return {
            "error_mm": {"max": self.max_mm, "mean": self.mean_mm, "p999": self.p999_mm},
            "error_steps": {"max": self.max_steps, "mean": self.mean_steps, "p999": self.p999_steps},
        }


class ErrorTally:
    """Gathers errors chunk by chunk; in bounded memory, unless they are wanted by streamline."""

    def __init__(self, promise: float, step: float, *, by_streamline: bool = True) -> None:
        self._step = step
        self._by_streamline = by_streamline
        self._largest = 0.0
        self._edge = max(promise, np.finfo(float).tiny) * 1.25
        self._histogram = np.zeros(_BINS + 1, np.int64)
        self._sum = 0.0
        self._n = 0
        self._maxima: list[npt.NDArray[np.float64]] = []
        self._means: list[npt.NDArray[np.float64]] = []

    def add(self, original: Streamlines, decoded: npt.NDArray[Any]) -> None:
        """Take in streamlines and their decoded points, in the same order."""
        offsets = np.asarray(original.offsets, np.int64)
        delta = original.points.astype(np.float64) - decoded.astype(np.float64)
        distance = np.sqrt((delta**2).sum(1))
        bins = np.minimum(distance * (_BINS / self._edge), _BINS).astype(np.int64)
        self._histogram += np.bincount(bins, minlength=_BINS + 1)
        self._sum += float(distance.sum())
        self._n += len(distance)
        self._largest = max(self._largest, float(distance.max(initial=0.0)))
        if not self._by_streamline:
            return
        lengths = np.diff(offsets)
        filled = lengths > 0
        largest, mean = np.full(len(lengths), np.nan), np.full(len(lengths), np.nan)
        if filled.any():
            starts = offsets[:-1][filled]
            largest[filled] = np.maximum.reduceat(distance, starts)
            mean[filled] = np.add.reduceat(distance, starts) / lengths[filled]
        self._maxima.append(largest)
        self._means.append(mean)

    def result(self) -> CodingError:
        """The errors so far; the percentile is exact to 1/20000 of the promise, rounded up."""
        maxima = np.concatenate(self._maxima) if self._maxima else np.empty(0)
        means = np.concatenate(self._means) if self._means else np.empty(0)
        if self._n == 0:
            return CodingError(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, maxima, means)
        largest, mean = self._largest, self._sum / self._n
        place = int(np.searchsorted(np.cumsum(self._histogram), 0.999 * self._n))
        p999 = largest if place >= _BINS else min(largest, (place + 1) * self._edge / _BINS)
        scale = 1.0 / self._step if self._step > 0.0 else float("nan")
        return CodingError(largest, mean, p999, largest * scale, mean * scale, p999 * scale, maxima, means)


def measure_error(streamlines: Streamlines, fiblets: FibletSet) -> CodingError:
    """Compare streamlines with their compressed form, point by point.

    Parameters
    ----------
    streamlines : Streamlines
        The original points, mm.
    fiblets : FibletSet
        The same streamlines compressed.

    Returns
    -------
    CodingError
        In mm, in steps, and per streamline.

    Raises
    ------
    ValueError
        If the two do not have the same streamlines and points.
    """
    if len(streamlines) != fiblets.n_streamlines or streamlines.n_points != fiblets.n_points:
        raise ValueError(
            f"the fiblets hold {fiblets.n_streamlines} streamlines of {fiblets.n_points} points, the original "
            f"{len(streamlines)} of {streamlines.n_points}: errors can be measured only against what was compressed"
        )
    offsets = fiblets.offsets()
    if not np.array_equal(offsets, streamlines.offsets):
        first = int(np.flatnonzero(offsets != np.asarray(streamlines.offsets))[0]) - 1
        raise ValueError(f"streamline {first} has another number of points in the fiblets than in the original")
    tally = ErrorTally(fiblets.promise, fiblets.step)
    done = 0
    for decoded in fiblets.iter_chunks():
        a, b = offsets[done], offsets[done + len(decoded)]
        part = Streamlines(streamlines.points[a:b], offsets[done : done + len(decoded) + 1] - a)
        tally.add(part, decoded.points)
        done += len(decoded)
    return tally.result()
