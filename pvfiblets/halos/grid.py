"""A grid that tells which of many points lie near one of a few places."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Doubles = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

_TABLE = 20  # bits of the table of cells that are looked for: 1 MB, which stays in cache


class Grid:
    """Grid of cells: neighbours within a cell's width of a place lie in the 27 cells around it."""

    def __init__(self, places: Doubles, width: float) -> None:
        self._width = width  # of a cell
        # Two more on either side: places are in the frame but for rounding, and cells next to theirs are looked up.
        # With very small cells the numbers wrap around, and still differ where that matters.
        across = int(1.0 / width) + 6
        self._strides = np.array([1, across, across * across], np.int64)
        around = np.stack(np.meshgrid(*[[-1, 0, 1]] * 3, indexing="ij"), axis=-1).reshape(-1, 3) @ self._strides
        cells = (self._cells(places)[:, None] + around).ravel()
        order = np.argsort(cells, kind="stable")
        self._wanted, self._whose = cells[order], order // len(around)
        # Most look-ups miss all of these cells; a small table answers that sooner than the list of them.
        self._table = np.zeros(1 << _TABLE, bool)
        self._table[_hashed(self._wanted)] = True

    def _cells(self, points: Doubles) -> Ints:
        cells: Ints = (points / self._width + 2.0).astype(np.int64) @ self._strides
        return cells

    def near(self, points: Doubles) -> tuple[Ints, Ints, Ints]:
        """Return the points near a place; and for each, where in a list its near places are, and how many."""
        cells = self._cells(points)
        some = np.flatnonzero(self._table[_hashed(cells)])
        first = np.searchsorted(self._wanted, cells[some], side="left")
        counts = np.searchsorted(self._wanted, cells[some], side="right") - first
        keep = counts > 0
        return some[keep], first[keep], counts[keep]

    def pairs(self, first: Ints, counts: Ints) -> Ints:
        """All places that :meth:`near` told of, one point's after the other's."""
        rank = np.arange(int(counts.sum())) - np.repeat(np.cumsum(counts) - counts, counts)
        return self._whose[np.repeat(first, counts) + rank]


def _hashed(cells: Ints) -> Ints:
    """Return the table's index of each cell: the upper bits of a product, in which all bits of the cell count."""
    return ((cells.astype(np.uint64) * np.uint64(0x9E3779B97F4A7C15)) >> np.uint64(64 - _TABLE)).astype(np.int64)
