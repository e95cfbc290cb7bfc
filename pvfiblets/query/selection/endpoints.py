"""Ends of streamlines, and streamlines with similar ends."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ...codec.decompress import decode_fiblets, select_streamlines
from ...codec.files.archive import forget
from ...codec.files.stored_parts import in_parts, of_streamlines
from ...codec.layout import PAGE, unpack
from ...streamlines import Streamlines

if TYPE_CHECKING:
    from ...codec.fibletset import FibletSet

Ints = npt.NDArray[np.int64]
Mask = npt.NDArray[np.bool_]
Floats = npt.NDArray[np.float64]


def anchor_points(fiblets: FibletSet, which: Ints) -> Floats:
    """First points of some fiblets, from their anchors."""
    words = np.asarray(fiblets.anchors[which])
    grid = np.stack([unpack(f"anchor_{axis}", words) for axis in "xyz"], axis=1).astype(np.float64)
    if fiblets.anchors_low is not None:
        grid = grid * 65536.0 + np.asarray(fiblets.anchors_low[which])
    points: Floats = fiblets.anchor_scale * grid + fiblets.origin
    return points


def end_points(data: FibletSet | Streamlines) -> Floats:
    """First and last point of every streamline, ``(n, 2, 3)``, without decoding the rest; NaN without points."""
    if isinstance(data, Streamlines):
        ends: Floats = np.full((len(data), 2, 3), np.nan)
        offsets = np.asarray(data.offsets)
        some = offsets[1:] > offsets[:-1]
        ends[some, 0], ends[some, 1] = data.points[offsets[:-1][some]], data.points[offsets[1:][some] - 1]
        return ends
    return _end_points(data)


def _end_points(fiblets: FibletSet) -> Floats:
    if in_parts(fiblets):
        ends: Floats = of_streamlines(fiblets, _end_points, np.nan, (2, 3))
        return ends
    ranked = np.full((fiblets.n_ranks, 2, 3), np.nan)
    try:
        for page in range(len(fiblets.pages) - 1):
            a, b = page * PAGE, min((page + 1) * PAGE, fiblets.n_fiblets)
            anchors = np.asarray(fiblets.anchors[a:b])
            ranks = unpack("rank", anchors).astype(np.int64) + fiblets.pages[page, 0]
            first, last = np.flatnonzero(unpack("begin", anchors)), np.flatnonzero(unpack("end", anchors))
            ranked[ranks[first], 0] = anchor_points(fiblets, a + first)
            ranked[ranks[last], 1] = _last_points(fiblets, a + last)
            for array in (fiblets.anchors, fiblets.anchors_low, fiblets.decoding):
                if array is not None:
                    forget(array, a, b)
            forget(fiblets.codes, int(fiblets.pages[page, 1]), int(fiblets.pages[page + 1, 1]))
    except IndexError:
        fiblets.verify()  # raises for a damaged file; other errors pass
        raise
    if fiblets.rank_to_id is None:
        return ranked
    out = np.full((fiblets.n_streamlines, 2, 3), np.nan)
    out[fiblets.rank_to_id] = ranked
    return out


def _last_points(fiblets: FibletSet, which: Ints) -> Floats:
    counts = unpack("last", np.asarray(fiblets.decoding[which])).astype(np.int64) + 1
    stops = np.cumsum(counts)
    points = np.empty((int(counts.sum()), 3))
    decode_fiblets(fiblets, which, stops - counts, points)
    return points[stops - 1]


def similar_ends(fiblets: FibletSet, ids: Any, distance: float) -> Mask:
    """Streamlines that begin and end near where some others do, in either direction."""
    reach = float(distance)
    if not (np.isfinite(reach) and reach > 0.0):
        raise ValueError(f"distance is {reach}; a length in mm above 0 is needed")
    from .endpoint_kernels import find_similar

    chosen = select_streamlines(fiblets.n_streamlines, ids)
    ends = end_points(fiblets)
    given = ends[np.unique(chosen)]
    given = given[~np.isnan(given[:, 0, 0])]
    found = np.zeros(fiblets.n_streamlines, bool)
    if not len(given):
        return found
    # Either end first, so that only the first is looked for.
    pairs = np.concatenate([given, given[:, ::-1]])
    low = pairs[:, 0].min(axis=0)
    # At most 2^20 cells along an axis: their numbers stay small whatever the distance.
    edge = max(reach, float((pairs[:, 0].max(axis=0) - low).max()) / 2.0**20)
    cells = np.floor((pairs[:, 0] - low) / edge).astype(np.int64)
    order = np.lexsort(cells.T)
    keys, starts = np.unique(cells[order] @ _STRIDES, return_index=True)
    # Keys rise with the lexical order of (z, y, x), the order of the sorted pairs.
    starts = np.append(starts, len(pairs)).astype(np.int64)
    find_similar(ends, np.ascontiguousarray(pairs[order]), keys, starts, low, edge, reach, found)
    return found


_STRIDES = np.array([1, 1 << 21, 1 << 42], np.int64)


def end_directions(fiblets: FibletSet) -> Floats:
    """Return the absolute direction from end to end as colours, (n, 3) from 0 to 1; grey where there is none."""
    ends = end_points(fiblets)
    apart = np.abs(ends[:, 1] - ends[:, 0])
    sizes = np.linalg.norm(apart, axis=1, keepdims=True)
    return np.where(sizes > 0.0, apart / np.where(sizes > 0.0, sizes, 1.0), 0.5)
