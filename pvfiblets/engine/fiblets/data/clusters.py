"""Clusters: fiblets that lie near each other, with a box around them, so that culling tests many at once.

Fiblets are stored streamline by streamline: 32 that follow on each other are two whole streamlines, and nothing hides
a box around these. Sorted by place, along a Morton curve through the middles of their chords, 64 fill some millimetres.

A box is in units of anchors, coarsened so that 16 bits hold it with room around: place q stands for ``q * CLUSTER_STEP
- CLUSTER_BIAS``, for sets with 32-bit anchors times 65,536. It holds the capsules of its fiblets, rounded up by more
than a step. Places 0 and 65,535 mean that the box is unbounded on that side.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ....codec import layout
from .chunks import CLUSTER, CLUSTER_BIAS, CLUSTER_STEP

if TYPE_CHECKING:
    from ....codec.fibletset import FibletSet

SLICE = 1 << 19  # fiblets at a time
BITS = 10  # of the key along each axis

Array = npt.NDArray[Any]


def cluster_words(fiblets: FibletSet, first: int, last: int) -> Iterator[Array]:
    """Yield the words of ``shaders/fiblets/compute/clusters.glsl`` for some fiblets: boxes, then the order."""
    boxes = np.empty((last - first, 6), np.uint16)
    keys = np.empty(last - first, np.uint32)
    for begin in range(first, last, SLICE):
        end = min(begin + SLICE, last)
        a, b, reach = _capsules(fiblets, begin, end)
        rows = slice(begin - first, end - first)
        low = (np.minimum(a, b) - reach + CLUSTER_BIAS) / CLUSTER_STEP
        high = (np.maximum(a, b) + reach + CLUSTER_BIAS) / CLUSTER_STEP
        boxes[rows, :3] = np.clip(np.floor(low) - 1.0, 0.0, 65535.0)
        boxes[rows, 3:] = np.clip(np.ceil(high) + 1.0, 0.0, 65535.0)
        keys[rows] = _morton(np.clip(0.5 * (a + b), 0.0, 65535.0).astype(np.uint32) >> (16 - BITS))
    order = np.argsort(keys, kind="stable").astype(np.uint32)
    del keys
    for at in range(0, len(order), SLICE):
        part = boxes[order[at : at + SLICE]]
        starts = np.arange(0, len(part), CLUSTER)
        least = np.minimum.reduceat(part[:, :3], starts, axis=0)
        yield np.concatenate([least, np.maximum.reduceat(part[:, 3:], starts, axis=0)], axis=1).view(np.uint32)
    yield order


def _capsules(fiblets: FibletSet, first: int, last: int) -> tuple[Array, Array, Array]:
    """Ends of capsules, and how far they reach around these along each axis, ``(n, 3)`` float64 in units of boxes."""
    unit = 65536.0 if fiblets.anchors_low is not None else 1.0
    words = np.asarray(fiblets.anchors[first : last + 1])
    anchors = np.stack([layout.unpack(f"anchor_{axis}", words) for axis in "xyz"], axis=1).astype(np.float64)
    if fiblets.anchors_low is not None:
        anchors += np.asarray(fiblets.anchors_low[first : last + 1]) / unit
    n = last - first
    a = anchors[:n]
    b = np.concatenate([anchors[1:], anchors[-1:]])[:n]
    ends = np.flatnonzero(layout.unpack("end", words[:n]))
    pages = (first + ends) >> layout.PAGE_BITS
    ranks = np.asarray(fiblets.pages[:, 0], np.int64)[pages] + layout.unpack("rank", words[ends]).astype(np.int64)
    scale = np.asarray(fiblets.anchor_scale, np.float64) * unit
    b[ends] = a[ends] + layout.unpack_ends(np.asarray(fiblets.ends[ranks])) * fiblets.parameters.end_scale / scale
    radii = np.asarray(fiblets.reach[first:last], np.float64) * fiblets.reach_scale
    return a, b, radii[:, None] / scale


def _morton(places: Array) -> npt.NDArray[np.uint32]:
    """Interleave ten bits of each axis, ``(n, 3)``."""
    key = np.zeros(len(places), np.uint32)
    for axis in range(3):
        spread = places[:, axis].astype(np.uint32)
        for shift, mask in ((16, 0x030000FF), (8, 0x0300F00F), (4, 0x030C30C3), (2, 0x09249249)):
            spread = (spread | (spread << np.uint32(shift))) & np.uint32(mask)
        key |= spread << np.uint32(axis)
    return key
