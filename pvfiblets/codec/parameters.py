"""Parameters that a file's fiblets share: origin, anchor grid, steps, lattice edge and the error bound."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from typing import Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from ..formats.mapped import forget
from ..formats.scratch import is_long, spans
from ..invalid_points import MOST_LOOKED_AT, refuse_beyond, warn_of_far
from ..streamlines import Streamlines
from ..support.ragged import blocks
from .layout import END_LEVELS, MAX_POINTS
from .point_values import ValueSurvey, value_columns
from .small_sets import without_kernels

DEFAULT_ANGLE = 10.0  # degrees between true and drawn tangents
DEFAULT_PROMISE_STEPS = 0.1
DEFAULT_PROMISE_EXTENT = 1.0 / 4000.0  # of the diagonal of a view along an axis: half a pixel on a full screen
EVEN_SHARE = 0.9  # of the segments within STEP_BAND of the median: steps are constant, and directions code nearly all
COARSE = 1.0 / 20.0  # of the bounds' diagonal: errors of longer steps show, constant or not
DRAWN_SHARE = 2.0**-28  # of the bounds' diagonal that points of exact sets are drawn off by at most
UNEQUAL = 1.0 / 20.0  # of the extent or the steps in space: where a view along an axis has less, units differ
CONSTANT_STEP = 1e-4  # relative spread of steps under which one step serves the whole file
LEAST = math.sqrt(float(np.finfo(np.float64).tiny)) * 2.0**60  # mm, about 1.7e-136: squares of errors stay normal
STEP_BAND = 0.06  # steps within this of the median can be coded by direction; others vary too much for it
SAMPLE = 1_000_000  # segment lengths kept at most; a median needs no more
BLOCK_POINTS = 2_000_000
MOST_CHUNKS = 64  # remembered places before every other one goes
OF_VIEWS = 50_000  # segments that tell whether steps are even, and how long they are in a view
SAMPLED = 4_000_000  # points per sample of segments
EXACT_BELOW = 1_000_000  # bytes of points; smaller sets keep every bit by default
EXACT_UP_TO = 1 << 30  # bytes of points up to which a set that coding would enlarge keeps every bit; opening reads all
CUT_SHARE = 0.25  # of the promise that resampling may use up, and so leave to coding less
BUDGET = 0.98  # decoded points may be rounded to float32 wherever that moves them by less than the rest
_ANCHOR_SHARE = 0.5  # of the promise that 16-bit anchors may use before finer ones are taken

Vector = npt.NDArray[np.float64]
Effort: TypeAlias = Literal["fast", "high", "small"]


@dataclass
class Survey:
    """Result of a first pass over the data."""

    lower: Vector = field(default_factory=lambda: np.full(3, np.inf))  # `(3,)` true bounds, mm
    upper: Vector = field(default_factory=lambda: np.full(3, -np.inf))
    longest: float = 0.0  # longest segment, mm
    # largest component of a vector between a streamline's last point and another of the last (at most) 60, mm
    widest_end: float = 0.0
    # segments `(n, 3)`, mm: every `stride`-th, so few that memory stays bounded
    sample: list[npt.NDArray[np.float64]] = field(default_factory=list)
    places: list[npt.NDArray[np.float64]] = field(default_factory=list)  # some points of each chunk `(n, 3)`, mm
    stride: int = 1
    n_points: int = 0  # totals
    n_streamlines: int = 0
    values: dict[str, ValueSurvey] = field(default_factory=dict)

    def add(self, streamlines: Streamlines, per_point: Iterable[str] = ()) -> None:
        """Take in one chunk; ``per_point`` names the arrays whose values are wanted."""
        points = streamlines.points
        self.n_points += len(points)
        self.n_streamlines += len(streamlines)
        for name, column in value_columns(streamlines, per_point):
            self.values.setdefault(name, ValueSurvey()).add(column)
        if not len(points):
            return
        with without_kernels("coding", len(points)) as small:
            lower, upper, longest, widest_end = _scan(points, np.asarray(streamlines.offsets, np.int64), small)
        if not (np.isfinite(lower).all() and np.isfinite(upper).all()):
            bad = next(
                a + int(rows[0])
                for a, b in spans(len(points))
                if len(rows := np.flatnonzero(~np.isfinite(points[a:b]).all(axis=1)))
            )
            raise ValueError(
                f"point {bad} is {points[bad].tolist()}; finite coordinates in mm are needed: remove or repair it, "
                "or give nan='drop' or nan='split'"
            )
        refuse_beyond(max(float(np.abs(lower).max()), float(np.abs(upper).max())))
        self.lower, self.upper = np.minimum(self.lower, lower), np.maximum(self.upper, upper)
        self.longest = max(self.longest, longest)
        self.widest_end = max(self.widest_end, widest_end)
        # The sample stays even: at overflow every other length goes, and sampling continues at half the rate.
        while self.n_points > self.stride * SAMPLE:
            self.sample = [part[::2].copy() for part in self.sample]
            self.stride *= 2
        self.places.append(np.array(points[:: max(1, len(points) // MOST_LOOKED_AT)], np.float64))
        if len(self.places) > MOST_CHUNKS:
            self.places = [np.concatenate(self.places)[::2].copy()]
        self.sample.append(_segments(points, streamlines.offsets, self.stride))


def _scan(
    points: npt.NDArray[np.floating], offsets: npt.NDArray[np.int64], small: bool
) -> tuple[Vector, Vector, float, float]:
    """Bounds, longest segment and widest end (mm) of streamlines that have points; bounds are infinite if one is."""
    if not small:
        from .kernels.direction_kernels import scan  # numba loads only for large sets

        parts = []
        for own, goes_on in _scanned(offsets):
            rows = np.empty((-(-(len(own) - 1) // 1024), 8))
            # One type of points, so that the kernel is not compiled twice.
            scan(points[own[0] : own[-1]].astype(np.float64), own - own[0], rows)
            if goes_on:
                rows[:, 7] = 0.0  # these are no streamline's last points
            forget(points, 0, int(own[-1]))
            parts.append(rows)
        found = np.concatenate(parts)
        return found[:, :3].min(0), found[:, 3:6].max(0), float(np.sqrt(found[:, 6].max())), float(found[:, 7].max())
    if not np.isfinite(points).all():
        return np.full(3, -np.inf), np.full(3, np.inf), 0.0, 0.0
    wide = np.asarray(points, np.float64)
    joins = np.zeros(len(points), bool)
    joins[offsets[1:-1][offsets[1:-1] < len(points)]] = True  # a segment into the next streamline is none
    delta = (wide[1:] - wide[:-1])[~joins[1:]]
    with np.errstate(over="ignore"):  # of coordinates that are refused
        squares = delta[:, 0] ** 2 + delta[:, 1] ** 2 + delta[:, 2] ** 2
    filled = offsets[1:] > offsets[:-1]
    first, last = offsets[:-1][filled], offsets[1:][filled] - 1
    widest = 0.0
    for back in range(1, MAX_POINTS):
        first, last = first[last - back >= first], last[last - back >= first]
        if not first.size:
            break
        widest = max(widest, float(np.abs(wide[last] - wide[last - back]).max()))
    return wide.min(0), wide.max(0), float(np.sqrt(squares.max(initial=0.0))), widest


def _scanned(offsets: npt.NDArray[np.int64]) -> Iterator[tuple[npt.NDArray[np.int64], bool]]:
    """Yield the offsets of each block's streamlines; a very long one comes in parts that overlap."""
    # And whether it goes on behind this part.
    for a, b in blocks(offsets, BLOCK_POINTS):
        first, stop = int(offsets[a]), int(offsets[b])
        if b > a + 1 or not is_long(stop - first):
            yield offsets[a : b + 1], False
            continue
        while first < stop:
            end = stop if stop - first <= BLOCK_POINTS else first + BLOCK_POINTS
            yield np.array([first, end]), end < stop
            first = stop if end == stop else end - MAX_POINTS


def _segments(points: npt.NDArray[np.floating], offsets: npt.NDArray[np.int64], stride: int) -> Vector:
    """Every ``stride``-th segment, ``(n, 3)``, mm."""
    first = np.arange(0, max(len(points) - 1, 0), stride)
    joins = np.searchsorted(offsets, first + 1)  # a segment that would cross into the next streamline is none
    inside = offsets[np.minimum(joins, len(offsets) - 1)] != first + 1
    first = first[inside]
    found = np.empty((len(first), 3))
    for a, b in spans(len(first), max(SAMPLED // stride, 1)):
        found[a:b] = points[first[a:b] + 1].astype(np.float64) - points[first[a:b]].astype(np.float64)
        if is_long(len(points)):
            forget(points, 0, int(first[b - 1]))
    return found


def _moving(segments: Vector) -> Vector:
    """Lengths of segments above 0, mm."""
    lengths = np.sqrt((segments**2).sum(axis=1))
    return lengths[lengths > 0.0]


def median_step(streamlines: Streamlines) -> float:
    """Median length of segments that have one, mm; 0 without any."""
    points = streamlines.points
    moving = _moving(_segments(points, np.asarray(streamlines.offsets), max(1, len(points) // SAMPLE)))
    return float(np.median(moving)) if moving.size else 0.0


def survey(chunks: Iterable[Streamlines], per_point: Iterable[str] = ()) -> Survey:
    """First pass: bounds, steps and value ranges of all chunks."""
    found = Survey()
    names = tuple(per_point)
    for chunk in chunks:
        found.add(chunk, names)
    return found


def bounds_of(found: Survey) -> tuple[float, float, float, float, float, float]:
    """Bounds in VTK's order; zeros where there are no points."""
    if found.n_points == 0:
        return (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    pairs = np.stack([found.lower, found.upper], axis=1).ravel().tolist()
    return (pairs[0], pairs[1], pairs[2], pairs[3], pairs[4], pairs[5])


@dataclass(frozen=True)
class Parameters:
    """Numbers shared by all fiblets of a file; lengths in mm."""

    origin: tuple[float, float, float]  # an anchor `q` stands at `origin + anchor_scale * q`
    anchor_scale: tuple[float, float, float]
    anchor_bits: int  # 16 or 32 bits an axis
    step: float  # median step, and the least and greatest that a direction fiblet can name
    step_lo: float
    step_hi: float
    lattice: float  # edge of the lattice of the lattice kinds
    reach_scale: float  # unit of the capsules' radii
    end_scale: float  # unit of the streamlines' end vectors; above 0
    promise: float  # no decoded point is farther from its original
    # half the chord and the capsule's radius together are no larger for any fiblet: each lies within a sphere of this
    # radius about the middle of its chord
    largest_radius: float = 0.0
    # distance that lines were resampled to, and 0 where the points are the source's. The error bound is then about
    # lines: no point of the decoded one is farther from the source's, and none of the source's from the decoded one.
    resampled: float = 0.0

    @classmethod
    def choose(cls, found: Survey, max_error: float | None = None) -> Parameters:
        """Choose parameters for surveyed data; by default `_default_promise`, or what anchors hold."""
        if max_error is not None and not (math.isfinite(max_error) and max_error > 0.0):
            raise ValueError(f"max_error is {max_error}; a positive length in mm is needed")
        empty = found.n_points == 0
        lower = np.zeros(3) if empty else found.lower
        extent = np.zeros(3) if empty else found.upper - found.lower
        segments = np.concatenate(found.sample) if found.sample else np.empty((0, 3))
        moving = _moving(segments)
        step = float(np.median(moving)) if moving.size else found.longest
        finest = _finest(found)
        if max_error is None:
            promise = max(_default_promise(segments, step, extent), finest)
            if step == 0.0:  # no segment has a length: as fine as 16-bit anchors are
                promise = max(finest, _anchor_error(extent, 16) / _ANCHOR_SHARE) if found.n_points else 1e-6
        elif max_error < finest:
            raise ValueError(
                f"max_error is {max_error} mm; over bounds of {extent.max():g} mm at {np.abs(lower).max():g} mm from "
                f"the origin the finest promise is {finest:.3g} mm: ask for that, or bring the data nearer the origin"
            )
        else:
            promise = float(max_error)
        bits = 16 if _anchor_error(extent, 16) <= _ANCHOR_SHARE * promise else 32
        lo, hi = _step_range(moving, step)
        return cls(
            origin=tuple(lower.tolist()),
            anchor_scale=tuple((extent / (2.0**bits - 1.0)).tolist()),
            anchor_bits=bits,
            step=step,
            step_lo=lo,
            step_hi=hi,
            # Rounding to a cubic lattice errs by at most half its diagonal.
            lattice=2.0 / math.sqrt(3.0) * promise * BUDGET,
            reach_scale=(MAX_POINTS * found.longest + 4.0 * promise) / 65535.0,
            # Both ends of a decoded vector may be off by the error bound.
            end_scale=(found.widest_end + 2.0 * promise) / END_LEVELS * (1.0 + 1e-9),
            promise=promise,
        )

    @classmethod
    def of_resampled(cls, found: Survey, promise: float, step: float) -> Parameters:
        """Choose parameters to code lines that were resampled within ``CUT_SHARE`` of the error bound."""
        coding = max((1.0 - CUT_SHARE) * promise, _finest(found))
        return replace(cls.choose(found, coding), resampled=step)

    @classmethod
    def of_exact(cls, found: Survey) -> Parameters:
        """Choose parameters of an exact set; drawn points are as fine as int32."""
        empty = found.n_points == 0
        diagonal = 0.0 if empty else float(np.sqrt(((found.upper - found.lower) ** 2).sum()))
        return cls.choose(found, max(_finest(found), diagonal * DRAWN_SHARE))

    @property
    def budget(self) -> float:
        """Largest error that coding may cause, mm: the error bound less what rounding decoded points may add."""
        return self.promise * BUDGET


def tell_far(found: Survey) -> None:
    """Warn of few points so far away that the others are drawn visibly off."""
    if found.places:
        warn_of_far(np.concatenate(found.places), found.lower, found.upper, DRAWN_SHARE)


def _finest(found: Survey) -> float:
    """Least error that 32-bit anchors over the bounds can promise, mm."""
    if found.n_points == 0:
        return LEAST
    extent = found.upper - found.lower
    finest = _anchor_error(extent, 32) * 2.0 + float(np.spacing(np.abs(found.lower) + extent).max()) * 4.0
    return max(finest, LEAST)


def _anchor_error(extent: Vector, bits: int) -> float:
    return float(np.sqrt((extent**2).sum())) / (2.0**bits - 1.0) / 2.0


def _default_promise(segments: Vector, step: float, extent: Vector) -> float:
    """Greatest error in mm, for such segments in bounds of this extent."""
    # Direction codes err by some hundredths of a step, and where steps are constant a finer bound would take a second
    # byte a point. Lattice codes err by all that they may: there a tenth of a long step shows. So it does in a view
    # along an axis whose unit dominates the others, as metres do degrees.
    segments = segments[:: max(1, len(segments) // OF_VIEWS)]
    moving, diagonal = _moving(segments), math.hypot(*extent)
    even = moving.size and float((np.abs(moving - step) <= STEP_BAND * step).mean()) >= EVEN_SHARE
    coarse = not even or step > COARSE * diagonal
    promise = DEFAULT_PROMISE_STEPS * step
    for axis in range(3):
        seen = [i for i in range(3) if i != axis]
        wide, moving = math.hypot(*extent[seen]), _moving(segments[:, seen])
        own = float(np.median(moving)) if moving.size else step
        if own < UNEQUAL * step:
            promise = min(promise, DEFAULT_PROMISE_STEPS * own)
        if wide > 0.0 and (coarse or wide < UNEQUAL * diagonal or own < UNEQUAL * step):
            promise = min(promise, DEFAULT_PROMISE_EXTENT * wide)
    return promise


def _step_range(moving: Vector, step: float) -> tuple[float, float]:
    if not moving.size:
        return step, step
    near = moving[np.abs(moving - step) <= STEP_BAND * step]
    if not near.size:
        return step, step
    mean = float(near.mean())
    if float(near.std()) <= CONSTANT_STEP * step:
        return mean, mean
    return step * (1.0 - STEP_BAND), step * (1.0 + STEP_BAND)
