"""Errors of decoded points and of drawn directions."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from ..formats.mapped import forget
from ..formats.scratch import SPAN, is_long, spans
from ..streamlines import Streamlines
from .decompress import iter_chunks
from .fibletset import FibletSet
from .layout import unpack
from .parameters import LEAST
from .point_values import value_errors
from .streamline_ranges import coded_rows
from .tangents import pixel

_BINS = 20_000  # of the histogram that the percentile is read from: 5e-5 of the error bound each
_PER_DEGREE = 100  # bins of the histogram of angles


@dataclass(frozen=True)
class CodingError:
    """Distances between original and decoded points, and angles between true and drawn directions.

    Attributes
    ----------
    max_mm, mean_mm, p999_mm : float
        Largest, mean and 99.9th percentile, mm.
    max_steps, mean_steps, p999_steps : float
        The same in median steps (NaN where there is no step).
    streamline_max_mm, streamline_mean_mm : numpy.ndarray
        ``(n_streamlines,)`` by streamline, NaN for empty streamlines; empty in a summary.
    max_degrees, mean_degrees, p99_degrees : float
        Angle between true and drawn tangents (:mod:`.tangents`): largest, mean and 99th percentile over both ends of
        all segments longer than a 2000th of the bounds' diagonal. NaN where there is none.
    values : dict of str to dict
        ``max`` and ``mean`` difference of the kept per-point arrays from the originals, in their units, as measured
        when they were coded.
    """

    max_mm: float
    mean_mm: float
    p999_mm: float
    max_steps: float
    mean_steps: float
    p999_steps: float
    streamline_max_mm: npt.NDArray[np.float64]
    streamline_mean_mm: npt.NDArray[np.float64]
    max_degrees: float
    mean_degrees: float
    p99_degrees: float
    values: dict[str, dict[str, float]] = field(default_factory=dict)

    def summary(self) -> dict[str, dict[str, Any]]:
        """``error_mm`` and ``error_steps`` (max, mean, p999), ``error_degrees`` (max, mean, p99), ``error_values``."""
        return {
            "error_mm": {"max": self.max_mm, "mean": self.mean_mm, "p999": self.p999_mm},
            "error_steps": {"max": self.max_steps, "mean": self.mean_steps, "p999": self.p999_steps},
            "error_degrees": {"max": self.max_degrees, "mean": self.mean_degrees, "p99": self.p99_degrees},
            "error_values": self.values,
        }


class ErrorTally:
    """Gathers errors of a set chunk by chunk; in bounded memory, unless they are wanted by streamline.

    Of a set that was resampled, whose points are others than the original's, errors are distances of the points of each
    line from the other line, of both together; directions are not compared.
    """

    def __init__(self, fiblets: FibletSet, *, by_streamline: bool = True) -> None:
        self.resampled = fiblets.parameters.resampled > 0.0
        self._exact = fiblets.exact is not None
        self._values = value_errors(fiblets.per_point)
        self._step = fiblets.step
        self._promise = fiblets.promise
        self._dtype = fiblets.point_dtype()
        self._pixel = pixel(fiblets.bounds)
        self._firsts = _FirstPoints(fiblets)
        self._by_streamline = by_streamline
        self._largest = 0.0
        self._edge = max(fiblets.promise, LEAST) * 1.25
        self._histogram = np.zeros(_BINS + 1, np.int64)
        self._sum = 0.0
        self._n = 0
        self._maxima: list[npt.NDArray[np.float64]] = []
        self._means: list[npt.NDArray[np.float64]] = []
        self._angles = np.zeros(180 * _PER_DEGREE + 1, np.int64)
        self._angle_sum = 0.0
        self._largest_angle = 0.0

    def add(self, original: Streamlines, decoded: Streamlines) -> None:
        """Take in streamlines, and the same as decoded to float64."""
        offsets = np.asarray(original.offsets, np.int64)
        if is_long(original.n_points) and not (self.resampled or self._by_streamline):
            for first, last in original.blocks(SPAN):
                self._add_parts(original.points, decoded.points, int(offsets[first]), int(offsets[last]), offsets)
            return
        if self.resampled:
            from .kernels.line_distance import line_distances

            # Points come in the set's own type by default, and its rounding is part of their error.
            drawn = decoded.points.astype(self._dtype).astype(np.float64)
            others = np.asarray(decoded.offsets, np.int64)
            away = line_distances(original.points, offsets, drawn, others, self._promise)
            back = line_distances(drawn, others, original.points, offsets, self._promise)
            owners = [np.repeat(np.arange(len(lines)), lines.counts) for lines in (original, decoded)]
            order = np.argsort(np.concatenate(owners), kind="stable")
            self._add_distances(np.concatenate([away, back])[order], offsets + others)
            return
        firsts = self._firsts.of_next(original.n_points)
        drawn = np.asarray(decoded.points, np.float64)
        self._add_angles(original.points, drawn, offsets, firsts)
        self._add_distances(self._distances(original.points, drawn), offsets)

    def _add_parts(
        self, true: npt.NDArray[Any], drawn: npt.NDArray[Any], a: int, b: int, offsets: npt.NDArray[np.int64]
    ) -> None:
        """Compare points ``[a, b)``, whole streamlines or parts of one; no more is held at a time."""
        for first, last in spans(b - a):
            first, last = a + first, a + last
            lead, more = first - max(first - 1, a), min(last + 1, b) - last  # tangents need a point on either side
            rows = slice(first - lead, last + more)
            inner = offsets[(offsets > rows.start) & (offsets < rows.stop)]
            own = np.concatenate([[rows.start], inner, [rows.stop]]) - rows.start
            here, there = np.asarray(true[rows]), np.asarray(drawn[rows], np.float64)
            firsts = np.concatenate([np.zeros(lead, bool), self._firsts.of_next(last - first), np.zeros(more, bool)])
            self._add_angles(here, there, own, firsts, slice(lead, lead + last - first))
            self._add_distances(self._distances(here, there)[lead : lead + last - first], own)
            forget(true, 0, last)
            forget(drawn, 0, last)

    def _distances(self, true: npt.NDArray[Any], drawn: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        """Distances of points in the set's own type, whose rounding is part of their error."""
        from .kernels.error_kernels import distances  # numba loads only when errors are measured

        distance = np.empty(len(true))
        distances(true, drawn, self._dtype == np.float32, distance)
        return distance

    def _add_distances(self, distance: npt.NDArray[np.float64], offsets: npt.NDArray[np.int64]) -> None:
        """Take in distances, of streamlines whose own begin at these offsets."""
        from .kernels.error_kernels import add_up

        total, largest = add_up(distance, np.ones(len(distance), np.uint8), _BINS / self._edge, False, self._histogram)
        self._sum += total
        self._n += len(distance)
        self._largest = max(self._largest, largest)
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

    def _add_angles(
        self,
        true: npt.NDArray[Any],
        drawn: npt.NDArray[np.float64],
        offsets: npt.NDArray[np.int64],
        firsts: npt.NDArray[np.bool_],
        which: slice = slice(None),
    ) -> None:
        from .kernels.error_kernels import add_up
        from .kernels.tangent_kernels import tangent_angles

        degrees, uses = np.empty(len(true)), np.empty(len(true), np.uint8)
        tangent_angles(true, drawn, offsets, firsts, self._pixel, degrees, uses)
        if self._exact:  # its fiblets, whose first points have tangents of their own, are not stored
            degrees[:] = 0.0
        total, largest = add_up(degrees[which], uses[which], _PER_DEGREE, True, self._angles)
        self._angle_sum += total
        self._largest_angle = max(self._largest_angle, largest)

    def result(self) -> CodingError:
        """The errors so far; percentiles are rounded up: to 1/16000 of the error bound, to a hundredth of a degree."""
        maxima = np.concatenate(self._maxima) if self._maxima else np.empty(0)
        means = np.concatenate(self._means) if self._means else np.empty(0)
        if self._n == 0:
            none = float("nan")
            return CodingError(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, maxima, means, none, none, none, self._values)
        largest, mean = self._largest, self._sum / self._n
        place = int(np.searchsorted(np.cumsum(self._histogram), 0.999 * self._n))
        p999 = largest if place >= _BINS else min(largest, (place + 1) * self._edge / _BINS)
        scale = 1.0 / self._step if self._step > 0.0 else float("nan")
        steps = (largest * scale, mean * scale, p999 * scale)
        degrees, mean_degrees, p99_degrees = self._angle_figures()
        return CodingError(
            largest, mean, p999, *steps, maxima, means, degrees, mean_degrees, p99_degrees, self._values
        )

    def _angle_figures(self) -> tuple[float, float, float]:
        """Largest, mean and 99th percentile, degrees."""
        counted = np.cumsum(self._angles)
        if counted[-1] == 0:
            return float("nan"), float("nan"), float("nan")
        p99 = int(np.searchsorted(counted, 0.99 * counted[-1])) / _PER_DEGREE
        return self._largest_angle, self._angle_sum / float(counted[-1]), min(p99, self._largest_angle)


class _FirstPoints:
    """Whether points are the first of their fiblets, for chunks of consecutive streamlines."""

    def __init__(self, fiblets: FibletSet) -> None:
        self._fiblets = fiblets
        self._fiblet = self._begun = 0
        self._point = 0
        self._all: npt.NDArray[np.bool_] | None = None
        if not fiblets.in_order:
            coded = np.zeros(fiblets.n_points, bool)
            coded[fiblets.fiblet_points()] = True
            self._all = np.empty_like(coded)
            self._all[coded_rows(fiblets)] = coded

    def of_next(self, n: int) -> npt.NDArray[np.bool_]:
        """``(n,)`` of the next ``n`` points."""
        if self._all is not None:
            self._point += n
            return self._all[self._point - n : self._point]
        counts = unpack("last", self._fiblets.decoding[self._fiblet : self._fiblet + n]).astype(np.int64) + 1
        starts = self._begun + np.cumsum(counts) - counts
        inside = int(np.searchsorted(starts, n))
        # Where the next fiblet that is not among these begins, from the point after them.
        after = int(starts[inside]) if inside < len(starts) else int(starts[-1] + counts[-1]) if inside else self._begun
        self._fiblet, self._begun = self._fiblet + inside, after - n
        firsts = np.zeros(n, bool)
        firsts[starts[:inside]] = True
        return firsts


def measure_error(streamlines: Streamlines, fiblets: FibletSet) -> CodingError:
    """Measure the coding error of each point, by comparing streamlines with their compressed form.

    Parameters
    ----------
    streamlines : Streamlines
        The original points, mm.
    fiblets : FibletSet
        The same streamlines compressed; where they were resampled, lines are compared rather than points.

    Returns
    -------
    CodingError
        Errors of points in mm and in steps, also by streamline, and errors of directions in degrees. All are 0 for a
        set that keeps its points exactly. Such a set is drawn from fiblets made when it is opened: a drawn point is off
        by up to :attr:`.FibletSet.promise`, and the tangent at a fiblet's first point is the direction of the segment
        after it.

    Raises
    ------
    TypeError
        If the arguments have other types, for instance in reverse order.
    ValueError
        If the two do not have the same streamlines and points.
    """
    if not isinstance(streamlines, Streamlines) or not hasattr(fiblets, "parameters"):
        kinds = f"{type(streamlines).__name__} and {type(fiblets).__name__}"
        raise TypeError(f"measure_error takes Streamlines and their FibletSet, in this order; got {kinds}")
    resampled = fiblets.parameters.resampled > 0.0
    if len(streamlines) != fiblets.n_streamlines or (streamlines.n_points != fiblets.n_points and not resampled):
        raise ValueError(
            f"the fiblets hold {fiblets.n_streamlines} streamlines of {fiblets.n_points} points, the original "
            f"{len(streamlines)} of {streamlines.n_points}: errors can be measured only against the compressed "
            "streamlines"
        )
    offsets = np.asarray(streamlines.offsets, np.int64)
    if not resampled and not np.array_equal(offsets, fiblets.offsets()):
        first = int(np.flatnonzero(offsets != fiblets.offsets())[0]) - 1
        raise ValueError(f"streamline {first} has another number of points in the fiblets than in the original")
    tally = ErrorTally(fiblets)
    done = 0
    for decoded in iter_chunks(fiblets, dtype=np.float64):
        a, b = offsets[done], offsets[done + len(decoded)]
        part = Streamlines(streamlines.points[a:b], offsets[done : done + len(decoded) + 1] - a)
        tally.add(part, decoded)
        done += len(decoded)
    return tally.result()
