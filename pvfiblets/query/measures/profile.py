"""Values along a bundle: the mean over streamlines at places of equal arc length (along-tract statistics).

Streamlines of a bundle are stored in either direction. Each is turned to run as the first does, by the mean distance of
its resampled points to the first's, taken directly and flipped, the lesser deciding: Garyfallidis et al. 2012,
"QuickBundles, a method for tractography simplification", section 2.2, minimum average direct-flip distance.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ...codec.decompress import select_streamlines
from ...codec.layout import PAGE, unpack
from ...codec.point_values import PointValues
from ...codec.streamline_ranges import StreamlineRanges, ranges_of
from ...support.ragged import blocks
from .measures import Distance, Values, by_rank, measure

if TYPE_CHECKING:
    from ...codec.fibletset import FibletSet

Floats = npt.NDArray[np.float64]
CHUNK = 1 << 20  # points decoded, or places resampled, together


def mean_profile(
    fiblets: FibletSet, ids: Any, values_per_point: str | Distance | Values | npt.ArrayLike, n: int = 100
) -> tuple[Floats, Floats]:
    """Mean and spread of a value along some streamlines."""
    if n < 2:
        raise ValueError(f"n is {n}; at least 2 places along a streamline are needed")
    values = measure(fiblets, values_per_point)
    if values.kind != "point":
        raise ValueError(f"{values.name!r} has a value per {values.kind}; a profile needs values per point")
    chosen = select_streamlines(fiblets.n_streamlines, ids)
    places = ranges_of(fiblets, chosen)
    filled = np.flatnonzero(places.points > 0)
    chosen, places = chosen[filled], places.at(filled)
    tally = _Tally(n)
    first: Floats | None = None
    bare = by_rank(fiblets)
    ranks = _ranks(fiblets, places)
    # As much as a portion's points or its places are, whichever are more.
    sizes = np.maximum(places.points, n)
    for a, b in blocks(np.concatenate([[0], np.cumsum(sizes)]), CHUNK):
        lines = bare.decompress(ranks[a:b], dtype=np.float64)
        positions, found = _resampled(lines.points, lines.offsets, _values_at(values, places.at(np.arange(a, b))), n)
        first = positions[0] if first is None else first
        direct = np.linalg.norm(positions - first, axis=2).mean(axis=1)
        flipped = np.linalg.norm(positions[:, ::-1] - first, axis=2).mean(axis=1)
        turn = flipped < direct
        found[turn] = found[turn, ::-1]
        tally.add(found)
    return tally.result()


def _ranks(fiblets: FibletSet, places: StreamlineRanges) -> npt.NDArray[np.int64]:
    within = unpack("rank", np.asarray(fiblets.anchors[places.fiblet])).astype(np.int64)
    return within + fiblets.pages[places.fiblet // PAGE, 0]


def _values_at(values: Values, places: StreamlineRanges) -> Floats:
    """Values of the points of some streamlines, end to end."""
    starts = np.cumsum(places.points) - places.points
    rows = np.arange(int(places.points.sum())) + np.repeat(places.point - starts, places.points)
    kept = values.values
    return (kept.values(rows) if isinstance(kept, PointValues) else kept[rows]).astype(np.float64)


def _resampled(points: npt.NDArray[Any], offsets: Any, values: Floats, n: int) -> tuple[Floats, Floats]:
    from .measure_kernels import resample

    m = len(offsets) - 1
    positions, found = np.empty((m, n, 3)), np.empty((m, n))
    resample(points, values, offsets, positions, found)
    return positions, found


class _Tally:
    """Means and sums of squares, joined chunk by chunk (Chan, Golub and LeVeque 1983)."""

    def __init__(self, n: int) -> None:
        self.count, self.mean, self.squares = np.zeros(n), np.zeros(n), np.zeros(n)

    def add(self, rows: Floats) -> None:
        there = ~np.isnan(rows)
        count = there.sum(axis=0).astype(np.float64)
        mean = np.where(there, rows, 0.0).sum(axis=0) / np.maximum(count, 1.0)
        squares = np.where(there, (rows - mean) ** 2, 0.0).sum(axis=0)
        total = self.count + count
        apart, share = mean - self.mean, count / np.maximum(total, 1.0)
        self.mean = self.mean + apart * share
        self.squares = self.squares + squares + apart**2 * self.count * share
        self.count = total

    def result(self) -> tuple[Floats, Floats]:
        there = self.count > 0
        mean = np.where(there, self.mean, np.nan)
        return mean, np.where(there, np.sqrt(self.squares / np.maximum(self.count, 1.0)), np.nan)
