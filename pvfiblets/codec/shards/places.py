"""The shard of each streamline: neighbours share a shard, and no shard exceeds the size limit.

Streamlines are put in the order in which a Hilbert curve through space visits the middles of them (the first point of
their middle fiblet), and the shards are consecutive stretches of that order. A streamline lies in one shard as a whole,
so that a shard is an ordinary set.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from ..encoding.ordering import hilbert_keys
from ..files.archive import forget
from ..layout import PAGE, WORDS, unpack

if TYPE_CHECKING:
    from ..fibletset import FibletSet

BITS = 16
BLOCK = 64 * PAGE
Ints = npt.NDArray[np.int64]


def shards_of(fiblets: FibletSet, size: int) -> list[Ints]:
    """Divide a set's streamlines."""
    firsts = _firsts(fiblets)
    sizes = streamline_bytes(fiblets, firsts)
    order = np.argsort(_keys(fiblets, firsts), kind="stable")
    ids = order if fiblets.rank_to_id is None else np.asarray(fiblets.rank_to_id)[order]
    cuts = _cuts(sizes[order], size)
    parts = [np.sort(ids[a:b]) for a, b in pairwise(cuts.tolist())] or [np.zeros(0, np.int64)]
    if fiblets.n_ranks < fiblets.n_streamlines:
        without = np.ones(fiblets.n_streamlines, bool)
        without[ids] = False
        parts[0] = np.sort(np.concatenate([parts[0], np.flatnonzero(without)]))
    return parts


def streamline_bytes(fiblets: FibletSet, firsts: Ints | None = None) -> Ints:
    """``(n_ranks,)`` bytes that each streamline takes in a file: of records, codes, and values of points."""
    if firsts is None:
        firsts = _firsts(fiblets)
    record = 4 * (WORDS["anchors"] + WORDS["decoding"]) + 2 + (0 if fiblets.anchors_low is None else 6)
    point = sum(values.codes.dtype.itemsize for values in fiblets.per_point.values())
    rows = sum(rows.dtype.itemsize * int(np.prod(rows.shape[1:])) for rows in fiblets.per_streamline.values())
    stops = np.append(firsts[1:], fiblets.n_fiblets)
    codes = np.empty(len(firsts) + 1, np.int64)
    points = np.empty(len(firsts) + 1, np.int64)
    codes[-1], points[-1] = len(fiblets.codes), fiblets.n_points
    for start in range(0, len(firsts), BLOCK):
        which = firsts[start : start + BLOCK]
        words = np.asarray(fiblets.decoding[which])
        base = fiblets.pages[which // PAGE]
        taken = slice(start, start + len(which))
        codes[taken] = unpack("code", words).astype(np.int64) + base[:, 1]
        points[taken] = unpack("point", words).astype(np.int64) + base[:, 2]
    counts = np.diff(points)
    if fiblets.exact is not None:
        return counts * (3 * fiblets.exact.dtype.itemsize + point) + rows + 4
    sizes: Ints = (stops - firsts) * record + np.diff(codes) + counts * point + rows + 4  # 4: the last chord
    return sizes


def _firsts(fiblets: FibletSet) -> Ints:
    """``(n_ranks,)`` the first fiblet of each streamline."""
    found = [np.zeros(0, np.int64)]
    for start in range(0, fiblets.n_fiblets, BLOCK):
        rows = fiblets.anchors[start : start + BLOCK]
        found.append(np.flatnonzero(unpack("begin", rows)) + start)
        forget(fiblets.anchors, start, start + len(rows))
    firsts = np.concatenate(found)
    if len(firsts) != fiblets.n_ranks:
        fiblets.verify()
        raise ValueError(f"{len(firsts)} streamlines begin where {fiblets.n_ranks} are")
    return firsts


def _keys(fiblets: FibletSet, firsts: Ints) -> npt.NDArray[np.uint64]:
    """``(n_ranks,)`` where the curve meets the middle of each streamline."""
    middles = (firsts + np.append(firsts[1:], fiblets.n_fiblets)) // 2
    scale = fiblets.anchor_scale * (1.0 if fiblets.anchors_low is None else 65536.0)
    extent = max(float(scale.max()) * 65535.0, np.finfo(float).tiny)
    keys = np.empty(len(firsts), np.uint64)
    for start in range(0, len(middles), BLOCK):
        words = np.asarray(fiblets.anchors[middles[start : start + BLOCK]])
        q = np.stack([unpack(f"anchor_{axis}", words) for axis in "xyz"], axis=1).astype(float)
        cells = np.clip(q * (scale / extent) * ((1 << BITS) - 1), 0, (1 << BITS) - 1).astype(np.int64)
        keys[start : start + len(words)] = hilbert_keys(cells, BITS)
    return keys


def _cuts(sizes: Ints, size: int) -> Ints:
    """Return the bounds of stretches that keep to a limit of bytes, unless one item is larger."""
    # They are as even as can be: 10 bytes of 1 each, at most 4 together, are 4, 3, 3 rather than 4, 4, 2.
    if not len(sizes):
        return np.zeros(1, np.int64)
    ends = np.cumsum(sizes)
    share = int(ends[-1]) / -(-int(ends[-1]) // size)
    cuts, done = [0], 0
    while cuts[-1] < len(sizes):
        before = int(ends[cuts[-1] - 1]) if cuts[-1] else 0
        done += 1
        wanted = min(max(share * done, before + 1), before + size)
        # As near to the share as whole streamlines come, and never over the size.
        at = int(np.searchsorted(ends, wanted, side="left")) + 1
        if at > len(ends) or (at - 1 > cuts[-1] and int(ends[at - 1]) - before > size):
            at -= 1
        cuts.append(max(at, cuts[-1] + 1))
    return np.array(cuts)
