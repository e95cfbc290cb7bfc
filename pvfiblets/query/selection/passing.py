"""Streamlines that pass through a region, end in it, or stay in it: found in the compressed data.

What is tested are the decoded points, in the float64 arithmetic of ``decompress(dtype=float64)``, and the segments
between them: of a point the answer is that of ``region.contains``, of a segment that of `segments`. Most fiblets
need no decoding. All points of a fiblet, and the segment that joins it to the next, lie in the capsule about its chord
(:mod:`..capsules`), hence in a ball about the middle of the chord. A ball that lies in the region, or apart from it,
settles its fiblet (`classify`); the others are decoded where their streamline's answer is still open, and only
there. Segments are tested where points leave the answer open, and the ball about a segment as well.

Sets of any size are processed a few pages at a time; of a mapped one, the pages read are released.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ...codec.decompress import decode_fiblets, select_streamlines
from ...codec.files.archive import forget
from ...codec.files.stored_parts import in_parts, stored_parts
from ...codec.layout import PAGE, unpack
from ..regions.classify import classify, pack
from ..regions.labels import Labels
from ..regions.segments import segment_flags
from ..regions.shapes import NOT, Plane
from . import passing_kernels as kernels
from .endpoints import anchor_points
from .point_flags import ALL, ANY, Sampling, check_sampling

if TYPE_CHECKING:
    from ...codec.fibletset import FibletSet
    from ..regions.region import Region

Ints = npt.NDArray[np.int64]
Mask = npt.NDArray[np.bool_]
Floats = npt.NDArray[np.float64]

PAGES = 8  # looked at together
FIBLETS = 1 << 13  # decoded together: at most 12 MB of points
SEGMENTS = 1 << 16  # tested together


@dataclass(frozen=True)
class FibletBalls:
    """Consecutive fiblets, and balls that hold them."""

    first: int  # number of the first of them
    anchors: npt.NDArray[np.uint32]  # `(n, 2)` uint32, a copy
    ranks: Ints  # `(n,)` int64
    centres: Floats  # `(n, 3)` and `(n,)` float64, mm
    radii: Floats


def region_flags(
    fiblets: FibletSet, region: Region, sampling: Sampling = "lines", ids: Any = None, *, bits: int = 15
) -> npt.NDArray[np.uint8]:
    """Return how each streamline lies to a region."""
    lines = check_sampling(sampling) == "lines"
    if in_parts(fiblets):
        return _flags_of_parts(fiblets, region, sampling, ids, bits)
    n = fiblets.n_ranks
    wanted = np.ones(n, bool) if ids is None else _wanted(fiblets, ids)
    flags = np.full(n, ALL, np.uint8)
    test = _Test(fiblets, region, lines, bits)
    try:
        for balls in iter_balls(fiblets, wanted):
            states = classify(region, balls.centres, balls.radii)
            # Flags of this stretch's streamlines only: a set larger than memory may have very many.
            base = int(balls.ranks[0])
            ranks = balls.ranks - base
            part = slice(base, base + int(ranks[-1]) + 1)
            still_open = np.zeros(len(states), bool)
            kernels.settle(states, balls.anchors, ranks, wanted[part], bits, flags[part], still_open)
            which = np.flatnonzero(still_open)
            for i in range(0, len(which), FIBLETS):
                rows = which[i : i + FIBLETS]
                test.take(balls, rows, ranks, flags[part])
    except IndexError:
        fiblets.verify()  # raises for a damaged file; other errors pass
        raise
    flags[~wanted] = 0
    if fiblets.rank_to_id is None:
        return flags
    out = np.zeros(fiblets.n_streamlines, np.uint8)
    out[fiblets.rank_to_id] = flags
    return out


class _Test:
    """Decodes fiblets and takes in what their points, and the segments between them, say of their streamlines."""

    def __init__(self, fiblets: FibletSet, region: Region, lines: bool, bits: int) -> None:
        self._fiblets, self._region, self._bits = fiblets, region, bits
        # A segment between two points on one side of a plane is on that side.
        only = region.leaves[0] if len(region.leaves) == 1 else None
        self._one_plane = isinstance(only, Plane)
        plain = region.program in ((0,), (0, NOT))
        self._labels = only if isinstance(only, Labels) and plain else None
        self._lines = lines and not self._one_plane
        self._packed = pack(region).arrays

    def take(self, balls: FibletBalls, rows: Ints, ranks: Ints, flags: npt.NDArray[np.uint8]) -> None:
        """Change the flags of the streamlines ``ranks`` of the fiblets ``rows``."""
        points, starts = self._decoded(balls, rows)
        n, region, labels = len(points), self._region, self._labels
        sides, inside, open_ = np.empty(n, np.int8), np.empty(n, np.bool_), np.empty(n, np.bool_)
        if labels is not None:
            # To look up a point's voxel takes less than to look up where a run of points lies.
            kernels.label_points(points, starts, labels.mask, labels.linear, labels.centre, inside, open_)
            inside ^= len(region.program) > 1  # ~labels
        elif self._one_plane:
            inside = region.contains(points)
        else:
            kernels.run_sides(points, starts, self._packed, sides)
            inside = sides > 0
            near = np.flatnonzero(sides == 0)
            inside[near] = region.contains(points[near])
        found = np.empty(len(rows), np.uint8)
        kernels.reduce_fiblets(inside, starts, found)
        kernels.merge(found, rows, balls.anchors, ranks, flags)
        if not self._lines:
            return
        known = flags[ranks[rows]]
        asked = (known & ANY == 0) & bool(self._bits & ANY) | (known & ALL != 0) & bool(self._bits & ALL)
        if labels is None:
            kernels.open_segments(points, starts, sides, asked, self._packed, open_)
        segments = np.flatnonzero(open_)
        owners = np.searchsorted(starts, segments, side="right") - 1
        segments, owners = segments[asked[owners]], rows[owners[asked[owners]]]
        for i in range(0, len(segments), SEGMENTS):
            some = segments[i : i + SEGMENTS]
            passed = segment_flags(region, points[some], points[some + 1])
            kernels.merge_segments(passed, owners[i : i + SEGMENTS], ranks, flags)

    def _decoded(self, balls: FibletBalls, rows: Ints) -> tuple[Floats, Ints]:
        """Points of fiblets, and where each one's begin; of lines each goes on to the next fiblet's first point."""
        fiblets, which = self._fiblets, rows + balls.first
        counts = unpack("last", np.asarray(fiblets.decoding[which])).astype(np.int64) + 1
        joined = unpack("end", balls.anchors[rows]) == 0 if self._lines else np.zeros(len(rows), bool)
        starts = np.concatenate([[0], np.cumsum(counts + joined)])
        points = np.empty((int(starts[-1]), 3))
        decode_fiblets(fiblets, which, starts[:-1], points)
        if self._lines:
            points[starts[1:][joined] - 1] = anchor_points(fiblets, which[joined] + 1)
        return points, starts


def _flags_of_parts(
    fiblets: FibletSet, region: Region, sampling: Sampling, ids: Any, bits: int
) -> npt.NDArray[np.uint8]:
    out = np.zeros(fiblets.n_streamlines, np.uint8)
    asked = np.ones(len(out), bool)
    if ids is not None:
        asked[:] = False
        asked[select_streamlines(len(out), ids)] = True
    for part, numbers in stored_parts(fiblets):
        if asked[numbers].any():
            out[numbers] = region_flags(part, region, sampling, asked[numbers], bits=bits)
    return out


def _wanted(fiblets: FibletSet, ids: Any) -> Mask:
    """``(n_ranks,)`` which ranks are of some streamlines."""
    mask = np.zeros(fiblets.n_streamlines, bool)
    mask[select_streamlines(fiblets.n_streamlines, ids)] = True
    return mask if fiblets.rank_to_id is None else mask[fiblets.rank_to_id]


def iter_balls(fiblets: FibletSet, wanted: Mask | None = None) -> Iterator[FibletBalls]:
    """Go through a set's fiblets, a few pages at a time."""
    table, n_pages = fiblets.pages, len(fiblets.pages) - 1
    p = fiblets.parameters
    top = np.abs(fiblets.origin) + fiblets.anchor_scale * 2.0**p.anchor_bits
    slack = 16.0 * float(np.spacing(top.max()))
    low = fiblets.anchors_low
    page = 0
    while page < n_pages:
        # The page's last streamline may go on in the next one, whose first rank it then is.
        if wanted is not None and not wanted[table[page, 0] : table[page + 1, 0] + 1].any():
            page += 1
            continue
        stop = page + 1
        while stop < min(page + PAGES, n_pages) and (
            wanted is None or wanted[table[stop, 0] : table[stop + 1, 0] + 1].any()
        ):
            stop += 1
        a, b = page * PAGE, min(stop * PAGE, fiblets.n_fiblets)
        more = min(b + 1, fiblets.n_fiblets)
        # Copies: kernels are compiled once for arrays that can be written to, and a map's memory can be given back.
        anchors = np.array(fiblets.anchors[a:more])
        ranks = unpack("rank", anchors[: b - a]).astype(np.int64) + table[page:stop, 0].repeat(PAGE)[: b - a]
        if not 0 <= int(ranks.min()) <= int(ranks.max()) < fiblets.n_ranks or (np.diff(ranks) < 0).any():
            raise IndexError(f"ranks {ranks.min()} to {ranks.max()} of {fiblets.n_ranks}, rising")
        if more == b and not anchors[-1, 1] >> 31:
            raise IndexError("the last fiblet does not end its streamline")
        base = int(ranks[0])
        centres, radii = np.empty((b - a, 3)), np.empty(b - a)
        kernels.balls(
            anchors,
            np.zeros((1, 3), np.uint16) if low is None else np.array(low[a:more]),
            low is not None,
            np.array(fiblets.ends[base : int(ranks[-1]) + 1])[ranks - base],
            np.array(fiblets.reach[a:b]),
            fiblets.origin,
            fiblets.anchor_scale,
            (fiblets.reach_scale, fiblets.end_scale, slack),
            centres,
            radii,
        )
        yield FibletBalls(a, anchors[: b - a], ranks, centres, radii)
        for array in (fiblets.anchors, fiblets.anchors_low, fiblets.decoding, fiblets.reach):
            if array is not None:
                forget(array, a, b)
        forget(fiblets.codes, int(table[page, 1]), int(table[stop, 1]))
        page = stop
