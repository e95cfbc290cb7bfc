"""An order of streamlines in which neighbours lie close together: along a Hilbert curve through both of their ends.

A streamline is a point of six dimensions: its two ends, that with the lesser y first, so that tracking the other way
round changes nothing. The Hilbert curve visits such points so that neighbours on the curve are near in space. Two
streamlines whose ends are near each other mostly belong to one bundle and run side by side; adding the middle point to
the key made groups of consecutive fiblets larger, not smaller.

What it gains, on a made-up brain of 64,000 streamlines at 0.1 mm, as the mean area that the box around consecutive
fiblets shows: 32 of them, 70 mm squared instead of 138; 1024, 101 instead of 241; a page, 166 instead of 256.
"""

from __future__ import annotations

from typing import Literal

import numpy as np
import numpy.typing as npt

from ...streamlines import Streamlines

Order = Literal["input", "hilbert"]
BITS = 10  # a number: six of them make a key of 60 bits
Ints = npt.NDArray[np.int64]


def check_order(order: str) -> None:
    """Refuse an order that there is none of."""
    if order not in ("input", "hilbert"):
        raise ValueError(f"order is {order!r}; 'input' or 'hilbert' is needed")


def hilbert_order(streamlines: Streamlines) -> Ints:
    """Streamlines that have points, in the order of the curve."""
    offsets = np.asarray(streamlines.offsets)
    filled = np.flatnonzero(np.diff(offsets) > 0)
    order: Ints = filled[ends_order(streamlines.points[offsets[filled]], streamlines.points[offsets[filled + 1] - 1])]
    return order


def ends_order(first: npt.ArrayLike, last: npt.ArrayLike) -> Ints:
    """The same of the streamlines' first and last points, ``(n, 3)`` each, mm."""
    a, b = np.asarray(first, np.float64), np.asarray(last, np.float64)
    if not len(a):
        return np.zeros(0, np.int64)
    swap = (a[:, 1] > b[:, 1])[:, None]
    ends = np.concatenate([np.where(swap, b, a), np.where(swap, a, b)], axis=1)
    lower = np.tile(np.minimum(a, b).min(axis=0), 2)
    extent = max(float((ends - lower).max()), np.finfo(float).tiny)
    cells = np.minimum((ends - lower) / extent * (1 << BITS), (1 << BITS) - 1).astype(np.int64)
    return np.argsort(hilbert_keys(cells, BITS), kind="stable")


def hilbert_keys(cells: Ints, bits: int) -> npt.NDArray[np.uint64]:
    """Distances along a Hilbert curve."""
    # Skilling, "Programming the Hilbert curve", AIP Conference Proceedings 707 (2004): undo the curve's rotations from
    # the coarsest bit to the finest, then Gray-decode across the coordinates, and interleave their bits.
    x = np.array(cells, np.int64).T.copy()
    d = len(x)
    for level in range(bits - 1, 0, -1):
        bit, rest = 1 << level, (1 << level) - 1
        for axis in range(d):
            inverted = (x[axis] & bit) != 0
            exchanged = np.where(inverted, 0, (x[0] ^ x[axis]) & rest)
            x[0] ^= np.where(inverted, rest, exchanged)
            x[axis] ^= exchanged
    for axis in range(1, d):
        x[axis] ^= x[axis - 1]
    turned = np.zeros_like(x[0])
    for level in range(bits - 1, 0, -1):
        turned ^= np.where((x[d - 1] & (1 << level)) != 0, (1 << level) - 1, 0)
    x ^= turned
    keys = np.zeros(x.shape[1], np.uint64)
    for level in range(bits - 1, -1, -1):
        for axis in range(d):
            keys = keys << np.uint64(1) | (x[axis] >> level & 1).astype(np.uint64)
    return keys
