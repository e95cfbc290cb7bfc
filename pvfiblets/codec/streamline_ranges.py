"""Ranges of a streamline in a set: its fiblets, and its points among all points."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from .files.stored_parts import in_parts, stored_parts
from .layout import PAGE, PAGE_BITS, unpack

if TYPE_CHECKING:
    from .fibletset import FibletSet

FEW = 256  # streamlines that are looked for one by one; more are found by reading all records
Ints = npt.NDArray[np.int64]


@dataclass(frozen=True)
class StreamlineRanges:
    """Ranges of some streamlines' fiblets and points among all."""

    fiblet: Ints  # `(n,)` int64: first fiblet and number of fiblets, first point and number of points
    fiblets: Ints
    point: Ints
    points: Ints

    @classmethod
    def from_fiblets(cls, fiblets: FibletSet) -> StreamlineRanges:
        """Return the ranges of all streamlines."""
        if in_parts(fiblets):
            return cls._of_parts(fiblets)
        owners, n = fiblets.fiblet_streamlines(), fiblets.n_streamlines
        begins = np.flatnonzero(np.diff(owners, prepend=-1))
        first, point = np.zeros(n, np.int64), np.zeros(n, np.int64)
        first[owners[begins]] = begins
        point[owners[begins]] = fiblets.fiblet_points()[begins]
        counts = np.bincount(owners, fiblets.fiblet_counts(), minlength=n).astype(np.int64)
        return cls(first, np.bincount(owners, minlength=n), point, counts)

    @classmethod
    def _of_parts(cls, fiblets: FibletSet) -> StreamlineRanges:
        """Return the ranges in a set of shards, which are coded one behind the other."""
        whole = cls(*(np.zeros(fiblets.n_streamlines, np.int64) for _ in range(4)))
        fiblet = point = 0
        for part, ids in stored_parts(fiblets):
            own, there = cls.from_fiblets(part), np.asarray(ids)
            filled = there[own.fiblets > 0]
            whole.fiblet[filled] = own.fiblet[own.fiblets > 0] + fiblet
            whole.point[filled] = own.point[own.fiblets > 0] + point
            whole.fiblets[there], whole.points[there] = own.fiblets, own.points
            fiblet, point = fiblet + part.n_fiblets, point + part.n_points
        return whole

    def at(self, chosen: Ints) -> StreamlineRanges:
        """Return the ranges of some of them."""
        return StreamlineRanges(self.fiblet[chosen], self.fiblets[chosen], self.point[chosen], self.points[chosen])


def ranges_of(fiblets: FibletSet, chosen: Ints) -> StreamlineRanges:
    """Ranges of chosen streamlines; a few are found without reading the records of the others."""
    if len(chosen) > FEW:
        return StreamlineRanges.from_fiblets(fiblets).at(chosen)
    return StreamlineRanges(*(np.array([_find(fiblets, int(i)) for i in chosen], np.int64).reshape(-1, 4).T))


def _find(fiblets: FibletSet, streamline: int) -> tuple[int, int, int, int]:
    """First fiblet, number of fiblets, first point and number of points of one streamline."""
    rank, ids = streamline, fiblets.rank_to_id
    if ids is not None:
        found = np.flatnonzero(ids == streamline)
        if not found.size:
            return 0, 0, 0, 0  # without points
        rank = int(found[0])
    # Pages begin with fiblets of rising ranks; fiblets of one rank lie in consecutive pages.
    begins = fiblets.pages[:-1, 0]
    first = max(int(np.searchsorted(begins, rank, side="left")) - 1, 0)
    last = int(np.searchsorted(begins, rank, side="right")) - 1
    at = first * PAGE
    ranks = unpack("rank", fiblets.anchors[at : (last + 1) * PAGE]).astype(np.int64)
    ranks += begins[first : last + 1].repeat(PAGE)[: len(ranks)]
    mine = np.flatnonzero(ranks == rank) + at
    if not mine.size:
        raise IndexError(f"streamline {streamline} has no fiblets")  # verify() reports a damaged file
    counts = unpack("last", fiblets.decoding[mine]).astype(np.int64) + 1
    point = int(unpack("point", fiblets.decoding[mine[0]])) + int(fiblets.pages[mine[0] >> PAGE_BITS, 2])
    return int(mine[0]), len(mine), point, int(counts.sum())


def coded_rows(fiblets: FibletSet) -> Ints:
    """Index among all points, in the order of the streamlines, of each point as coded: ``(n_points,)`` int64."""
    places = StreamlineRanges.from_fiblets(fiblets)
    starts = np.cumsum(places.points) - places.points
    order = np.argsort(places.point[places.points > 0], kind="stable")
    filled = np.flatnonzero(places.points > 0)[order]
    lengths = places.points[filled]
    return np.arange(fiblets.n_points) + np.repeat(starts[filled] - (np.cumsum(lengths) - lengths), lengths)
