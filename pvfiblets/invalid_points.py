"""Points whose coordinates are no numbers (NaN, infinite): refused, left out, or places where lines end.

And those so far away that float32, which is what graphics cards compute with, ends before.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from typing import Literal, get_args

import numpy as np
import numpy.typing as npt

from .streamlines import Streamlines
from .support.ragged import Array, Ints, cut_offsets

Invalid = Literal["error", "drop", "split"]

NONFINITE = "non-finite points"
"""The reason under which `dropped` counts points with NaN or infinity among the coordinates."""
CUT = "streamlines added where others were cut at non-finite points"
"""The reason under which `dropped` counts the pieces, less one, of each line that such points divide."""
LARGEST = 1e35  # mm
BEYOND = 0.02  # of the points, on either side of each axis: few enough to be a mistake
MOST_LOOKED_AT = 2_000  # points, or some more


def refuse_beyond(reach: float) -> None:
    """Refuse coordinates that float32 does not hold."""
    if reach > LARGEST:
        raise ValueError(
            f"a coordinate of {reach:g} mm is beyond {LARGEST:g} mm, where float32 ends: check the units"
        )


def warn_of_far(points: Array, low: npt.NDArray[np.float64], high: npt.NDArray[np.float64], share: float) -> None:
    """Warn if a few points are so far away that all others are drawn off by half a pixel of a view of those."""
    some = np.asarray(points[:: max(1, len(points) // MOST_LOOKED_AT)], np.float64)
    if not len(some):
        return
    most = np.quantile(some, [BEYOND, 1.0 - BEYOND], axis=0)
    wide, off = math.hypot(*(most[1] - most[0])), share * math.hypot(*(high - low))
    if off > wide / 4000.0 > 0.0:
        far = high if (high - most[1]).max() >= (most[0] - low).max() else low
        warnings.warn(
            f"most points lie within {wide:.3g} mm of each other, but the farthest reach {far.tolist()}: lines may "
            f"be drawn {off:.2g} mm off, more than half a pixel; leave out the outlying lines",
            UserWarning,
            stacklevel=3,
        )


def valid_points(streamlines: Streamlines, nan: Invalid) -> Streamlines:
    """Return streamlines of finite points."""
    if nan not in get_args(Invalid):
        raise ValueError(f"nan is {nan!r}; choose one of {get_args(Invalid)}")
    if nan == "error":
        return streamlines
    with np.errstate(all="ignore"):  # one pass without a copy settles nearly every set
        if np.isfinite(np.sum(streamlines.points, dtype=np.float64)):
            return streamlines
    rows = np.flatnonzero(~np.isfinite(streamlines.points).all(axis=1))
    return without_points(streamlines, rows, cut=nan == "split") if len(rows) else streamlines


def _delete(values: Array, rows: Ints) -> Array:
    return np.delete(values, rows, axis=0)


def without_points(
    streamlines: Streamlines, rows: Ints, *, cut: bool = True, delete: Callable[[Array, Ints], Array] = _delete
) -> Streamlines:
    """Return the streamlines without some of their points (ascending), which end lines if `cut`."""
    if cut:
        offsets, pieces = cut_offsets(streamlines.offsets, rows)
    else:
        offsets = streamlines.offsets - np.searchsorted(rows, streamlines.offsets)
        pieces = np.ones(len(streamlines), np.int64)
    lines = np.repeat(np.arange(len(streamlines)), pieces)
    first = np.concatenate([[0], np.cumsum(pieces)])
    dropped = dict(streamlines.dropped)
    for reason, count in ((NONFINITE, len(rows)), (CUT, len(lines) - len(streamlines))):
        if count:
            dropped[reason] = dropped.get(reason, 0) + count
    return Streamlines(
        delete(streamlines.points, rows),
        offsets,
        {name: delete(values, rows) for name, values in streamlines.per_point.items()},
        {name: np.asarray(values)[lines] for name, values in streamlines.per_streamline.items()},
        {name: _of_pieces(members, first) for name, members in streamlines.groups.items()},
        streamlines.per_group,
        streamlines.affine,
        streamlines.space,
        dropped,
    )


def _of_pieces(members: Ints, first: Ints) -> Ints:
    """Return the numbers of the pieces of some streamlines, which follow each other."""
    counts = first[members + 1] - first[members]
    begins = np.cumsum(counts) - counts
    return np.arange(int(counts.sum())) + np.repeat(first[members] - begins, counts)
