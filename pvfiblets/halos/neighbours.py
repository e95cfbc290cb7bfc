"""Distances from places on lines to the nearest other lines, or from points to the nearest others.

Lines are covered by arcs, each with a middle and a bound of its length to both sides. Only arcs that can be near one of
the queried places are divided; a grid finds them. The arcs that may hold the nearest place are then narrowed
down by the same bounds until the distance is known. So time and memory depend on how much lies near the places, not on
the number of points, and both are bounded: where there is too much, fewer places are queried.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from pvfiblets.support.ragged import offsets_from_counts

from .geometry import HaloLines
from .grid import Grid

Doubles = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

_SAME = {np.dtype(np.float32): 1e-6, np.dtype(np.float64): 1e-9}
"""Distances, by the largest coordinate, up to which places are one and the same."""

_EXACT = 0.01  # A distance is found when none can be less by more than this share of it

_SKIPPED = 8  # things through a place that are passed over before the place is given up

_BLOCK = 1 << 17  # arcs handled at a time, a few MB
_COARSE = 1 << 19  # arcs at most that all lines are covered by to begin with, and one more for each line
_MOST_ARCS = 1 << 22  # that those are divided into: two or three seconds
_MOST_PAIRS = 1 << 21  # of a place and an arc in a cell near it: some 100 MB
_PARTS = 4  # that an arc is divided into
_FEWEST = 16  # places that are worth asking about
_WHOLE = 2.0  # radius that reaches from anywhere in a box of size 1 to anywhere else


# ---------------------------------------------------------------------- what distances are measured to


@dataclass(frozen=True)
class Frame:
    """The bounds that points are measured in, so that numbers are near 1 whatever the millimetres are."""

    origin: Doubles  # `(3,)` float64, mm: their lower corner
    size: float  # mm, their largest extent
    diagonal: float  # mm
    same: float  # distance, by `size`, up to which places are one and the same

    @classmethod
    def around(cls, points: npt.NDArray[Any]) -> Frame:
        """The frame of points, with the size 0 if they are none or at one place."""
        if not len(points):
            return cls(np.zeros(3), 0.0, 0.0, 0.0)
        low, high = points.min(axis=0).astype(np.float64), points.max(axis=0).astype(np.float64)
        extent = high - low
        size = float(extent.max())
        if size == 0.0:
            return cls(low, 0.0, 0.0, 0.0)
        largest = float(np.maximum(np.abs(low), np.abs(high)).max())
        return cls(low, size, size * float(np.linalg.norm(extent / size)), _SAME[points.dtype] * (largest / size))

    def inside(self, points: npt.NDArray[Any]) -> Doubles:
        """Points from 0 to 1 along the largest extent."""
        return (points.astype(np.float64) - self.origin) / (self.size or 1.0)


class _Things(Protocol):
    """The places that distances are measured to."""

    frame: Frame

    def usual_spacing(self) -> float:
        """A guess at the distances."""

    def arcs(self, step: float) -> tuple[float, Iterator[tuple[Ints, Doubles]]]:
        """Cover everything with arcs of a length, or of more where those would be too many.

        Returns half their length, and blocks of them: things, and where along them the arcs' middles are.
        """

    def at(self, thing: Ints, where: Doubles) -> Doubles:
        """Places by where they are along things."""


class Paths:
    """Lines of two points and more, end to end: a place is a line and an arc length from the first one's start."""

    def __init__(self, lines: HaloLines, frame: Frame) -> None:
        self.frame, self.points = frame, lines.points  # of all their points
        some = np.flatnonzero(np.diff(lines.offsets) > 1)
        self.starts, self.ends = lines.offsets[some], lines.offsets[some + 1] - 1
        steps = np.zeros(lines.n_points)
        for first in range(0, lines.n_points - 1, _BLOCK):
            chords = np.diff(frame.inside(lines.points[first : first + _BLOCK + 1]), axis=0)
            steps[first + 1 : first + 1 + len(chords)] = _lengths(chords)
        heads = lines.offsets[:-1]
        steps[heads[heads < lines.n_points]] = 0.0
        self.reach: Doubles = np.cumsum(steps, out=steps)
        self.length = float(self.reach[-1]) if len(steps) else 0.0

    def __len__(self) -> int:
        return len(self.starts)

    def at(self, thing: Ints, where: Doubles) -> Doubles:
        """Places by arc length, clamped to the line's ends."""
        first = np.searchsorted(self.reach, where, side="right") - 1
        # Where one line ends another begins, at the same arc length.
        first = np.clip(first, self.starts[thing], self.ends[thing] - 1)
        start, stop = self.frame.inside(self.points[first]), self.frame.inside(self.points[first + 1])
        before = self.reach[first]
        step = self.reach[first + 1] - before
        part = np.clip((where - before) / np.where(step > 0.0, step, 1.0), 0.0, 1.0)
        return start + part[:, None] * (stop - start)

    def line_at(self, where: Doubles) -> Ints:
        """The line that each arc length is on."""
        return np.searchsorted(self.reach[self.ends], where, side="right").clip(0, len(self) - 1)

    def arcs(self, step: float) -> tuple[float, Iterator[tuple[Ints, Doubles]]]:
        """Half the length of arcs that cover all lines; and blocks of them: lines, and where their middles are."""
        step = max(step, self.length / _COARSE)
        return 0.5 * step, self._arcs(step)

    def _arcs(self, step: float) -> Iterator[tuple[Ints, Doubles]]:
        begin = self.reach[self.starts]
        lengths = self.reach[self.ends] - begin
        parts = np.maximum(np.ceil(lengths / step), 1.0).astype(np.int64)
        offsets = offsets_from_counts(parts)
        for first in range(0, int(offsets[-1]), _BLOCK):
            index = np.arange(first, min(first + _BLOCK, int(offsets[-1])))
            line = np.searchsorted(offsets, index, side="right") - 1
            where = begin[line] + (index - offsets[line] + 0.5) * (lengths[line] / parts[line])
            yield line, where.astype(np.float64)

    def usual_spacing(self) -> float:
        """Return the spacing if lines filled space as they do around a middling place of theirs."""
        n = 1 << 16
        where: Doubles = (np.arange(n, dtype=np.float64) + 0.5) * (self.length / n)
        return float(np.sqrt(_volume(self.at(self.line_at(where), where)) / self.length))


class Cloud:
    """Points, each a thing of its own and of no length."""

    def __init__(self, points: npt.NDArray[Any], frame: Frame) -> None:
        self.points, self.frame = points, frame  # `(n, 3)` mm, and the frame of all of them

    def at(self, thing: Ints, where: Doubles | None = None) -> Doubles:
        """Points by index."""
        del where
        return self.frame.inside(self.points[thing])

    def arcs(self, step: float) -> tuple[float, Iterator[tuple[Ints, Doubles]]]:
        """0, and blocks of points: their indices, and no matter where."""
        del step
        n = len(self.points)
        blocks = (np.arange(first, min(first + _BLOCK, n)) for first in range(0, n, _BLOCK))
        return 0.0, ((index, np.zeros(len(index))) for index in blocks)

    def usual_spacing(self) -> float:
        """Return the spacing if points filled space as they do around a middling one."""
        n = len(self.points)
        return float(np.cbrt(_volume(self.at(np.arange(0, n, max(n >> 16, 1)))) / n))


def _volume(places: Doubles) -> float:
    """Volume that places would fill if they were as dense everywhere as around the middling one."""
    cells = np.minimum((places * 32.0).astype(np.int64), 31) @ np.array([1, 32, 1024])
    _, inverse, counts = np.unique(cells, return_inverse=True, return_counts=True)
    return len(places) / float(np.median(counts[inverse.ravel()])) / 32.0**3


# ---------------------------------------------------------------------- the search


def distances(things: _Things, places: Doubles, own: Ints) -> Doubles:
    """Distances from places to the nearest of other things than their own."""
    least = 4.0 * things.frame.same
    radius = max(things.usual_spacing(), least)
    found = np.full(len(places), np.inf)
    growing = False
    while True:
        asked = np.flatnonzero(found == np.inf)
        try:
            pairs = _near(things, places[asked], own[asked], radius)
        except _TooDenseError as error:
            # Denser than was guessed: a smaller radius finds the nearer ones. Else fewer places must do.
            if error.by_pairs and not growing and radius > least:
                radius = max(0.25 * radius, least)
            elif len(found) > _FEWEST:
                found = found[: max(len(found) // 4, _FEWEST)]
            else:
                return np.where(found == np.inf, np.nan, found)
            continue
        found[asked] = _known(things, pairs, radius)
        # Far ones cannot change the median, however far they are.
        if 2 * np.count_nonzero(found < np.inf) > np.count_nonzero(~np.isnan(found)) or radius > _WHOLE:
            return found
        growing = True
        radius *= 2.0


class _TooDenseError(Exception):
    """There is too much near the places: pairs of one and an arc, or arcs to be divided."""

    def __init__(self, by_pairs: bool) -> None:
        super().__init__()
        self.by_pairs = by_pairs


@dataclass(frozen=True)
class _Pairs:
    """Places and arcs of things: place and thing by index, where along it the arc's middle is, and half its length."""

    places: Doubles
    place: Ints
    thing: Ints
    where: Doubles
    half: float

    def only(self, keep: npt.NDArray[np.bool_]) -> _Pairs:
        return replace(self, place=self.place[keep], thing=self.thing[keep], where=self.where[keep])

    def divided(self) -> _Pairs:
        thing, where = _divided(self.thing, self.where, self.half)
        return _Pairs(self.places, np.repeat(self.place, _PARTS), thing, where, self.half / _PARTS)


def _near(things: _Things, places: Doubles, own: Ints, radius: float) -> _Pairs:
    """Places, each with arcs that cover all of other things within the radius."""
    half, blocks = things.arcs(0.5 * radius)
    halves = [half]
    while halves[-1] > 0.25 * radius:
        halves.append(halves[-1] / _PARTS)
    grids = [Grid(places, radius + half) for half in halves]
    divided, paired = 0, 0
    parts: list[tuple[Ints, Ints, Doubles]] = []
    for block in blocks:
        todo = [(0, *block)]
        while todo:
            level, thing, where = todo.pop()
            half = halves[level]
            middles = things.at(thing, where)
            arc, first, counts = grids[level].near(middles)
            if level < len(grids) - 1:
                divided += _PARTS * len(arc)
                if divided > _MOST_ARCS:
                    raise _TooDenseError(by_pairs=False)
                finer, along = _divided(thing[arc], where[arc], half)
                firsts = range(0, len(finer), _BLOCK)
                todo += [(level + 1, finer[i : i + _BLOCK], along[i : i + _BLOCK]) for i in firsts]
                continue
            paired += int(counts.sum())
            if paired > _MOST_PAIRS:
                raise _TooDenseError(by_pairs=True)
            arc, place = np.repeat(arc, counts), grids[level].pairs(first, counts)
            distance = _lengths(middles[arc] - places[place])
            keep = (thing[arc] != own[place]) & (distance <= radius + half)
            if half == 0.0:
                keep &= distance > things.frame.same
            parts.append((place[keep], thing[arc[keep]], where[arc[keep]]))
    none = (np.zeros(0, np.int64), np.zeros(0, np.int64), np.zeros(0))
    place, thing, where = (np.concatenate(arrays) for arrays in zip(none, *parts, strict=True))
    return _Pairs(places, place, thing, where, halves[-1])


def _known(things: _Things, pairs: _Pairs, radius: float) -> Doubles:
    """Distances within the radius, infinity for others, NaN where there are only places that are the same."""
    found = np.full(len(pairs.places), np.inf)
    for _ in range(_SKIPPED):
        nearest, which = _nearest(things, pairs)
        same = nearest <= things.frame.same
        new = np.isfinite(nearest) & ~same
        found[new] = nearest[new]
        if not same.any():
            break
        # What goes through the place itself is passed over, and the search goes on without it.
        pairs = pairs.only(same[pairs.place] & (pairs.thing != which[pairs.place]))
    else:
        found[same] = np.nan
    found[found > radius] = np.inf
    return found


def _nearest(things: _Things, pairs: _Pairs) -> tuple[Doubles, Ints]:
    """Distance from each place to the nearest of its arcs, and whose that is."""
    # No place of an arc is farther from its middle than half its length: so an arc whose middle is by more than that
    # farther away than another's is out. The others are divided, until none can be nearer by what matters.
    best, which = np.full(len(pairs.places), np.inf), np.full(len(pairs.places), -1)
    while len(pairs.place):
        distance = _lengths(things.at(pairs.thing, pairs.where) - pairs.places[pairs.place])
        np.minimum.at(best, pairs.place, distance)
        first = distance == best[pairs.place]
        which[pairs.place[first]] = pairs.thing[first]
        nearest = best[pairs.place]
        matters = np.maximum(_EXACT * nearest, 0.5 * things.frame.same)
        pairs = pairs.only(distance - pairs.half < nearest - matters).divided()
    return best, which


def _divided(thing: Ints, where: Doubles, half: float) -> tuple[Ints, Doubles]:
    """Arcs divided into equal parts: things, and where the parts' middles are."""
    part = half / _PARTS
    along = where[:, None] + (2.0 * np.arange(_PARTS) + 1.0 - _PARTS) * part
    return np.repeat(thing, _PARTS), along.ravel()


def _lengths(vectors: Doubles) -> Doubles:
    lengths: Doubles = np.sqrt(np.einsum("ij,ij->i", vectors, vectors))
    return lengths
