"""Which streamlines pass through a region, end in it, or stay in it: asked of the compressed data.

What is tested are the decoded points, in the float64 arithmetic of ``decompress(dtype=float64)``: the answer is that of
``region.contains`` on those points, exactly. Most fiblets need no decoding. All points of a fiblet, and the segment
that joins it to the next, lie in the capsule about its chord (:mod:`..capsules`), hence in a ball about the middle of
the chord. A ball that lies in the region, or apart from it, settles its fiblet (:mod:`.classify`); the others are
decoded where their streamline's answer is still open, and only there.

Sets of any size are gone through by a few pages at a time; of a mapped one, the memory of what was read is given back.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ..codec.archive import forget
from ..codec.decompress import decode_fiblets, select_streamlines
from ..codec.layout import PAGE, unpack
from ..codec.stored_parts import in_parts, stored_parts
from . import passing_kernels as kernels
from .classify import classify
from .endpoints import anchor_points
from .point_flags import ALL, check_sampling
from .shapes import SURFACE

if TYPE_CHECKING:
    from ..codec.fibletset import FibletSet
    from .region import Region

__all__ = ["FibletBalls", "iter_balls", "region_flags"]

Ints = npt.NDArray[np.int64]
Mask = npt.NDArray[np.bool_]
Floats = npt.NDArray[np.float64]

PAGES = 8  # looked at together
FIBLETS = 1 << 13  # decoded together: at most 12 MB of points
RUN = 8  # consecutive points that a mesh is asked about together
SAMPLES = 1 << 20  # positions tested together
MOST_SAMPLES = 1 << 28
"""Positions on one fiblet, beyond which a sampling is refused."""


@dataclass(frozen=True)
class FibletBalls:
    """Consecutive fiblets, and balls that hold them.

    Attributes
    ----------
    first : int
        Number of the first of them.
    anchors : numpy.ndarray
        ``(n, 2)`` uint32, a copy.
    ranks : numpy.ndarray
        ``(n,)`` int64.
    centres, radii : numpy.ndarray
        ``(n, 3)`` and ``(n,)`` float64, mm.
    """

    first: int
    anchors: npt.NDArray[np.uint32]
    ranks: Ints
    centres: Floats
    radii: Floats


def region_flags(
    fiblets: FibletSet, region: Region, sampling: float | None = None, ids: Any = None, *, bits: int = 15
) -> npt.NDArray[np.uint8]:
    """Say how each streamline lies to a region.

    Parameters
    ----------
    fiblets : FibletSet
        In memory or mapped.
    region : Region
        Positions in mm of the set.
    sampling : float, optional
        mm: positions in between are tested too, so that no two on a segment are farther apart than that. For
        linearised streamlines, whose points are far apart. By default only points are tested.
    ids : array_like, optional
        Streamlines to ask about, as for :meth:`.FibletSet.decompress`; the others' flags are 0. All by default.
    bits : int
        Flags that are wanted; the others are undefined. The fewer, the less needs decoding.

    Returns
    -------
    numpy.ndarray
        ``(n_streamlines,)`` uint8: the sum of ``ANY = 1`` (some point lies in the region), ``ALL = 2`` (every point
        does), ``FIRST = 4`` and ``LAST = 8`` (the first, the last point does). 0 for a streamline without points.

    Raises
    ------
    ValueError
        If the sampling is not a length above 0, or so short that a fiblet would take more than 2^28 positions.
    IndexError
        If an id is out of range.
    FormatError
        If the file is damaged.
    """
    spacing = check_sampling(sampling)
    if in_parts(fiblets):
        return _flags_of_parts(fiblets, region, sampling, ids, bits)
    n = fiblets.n_ranks
    wanted = np.ones(n, bool) if ids is None else _wanted(fiblets, ids)
    flags = np.full(n, ALL, np.uint8)
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
                some = which[i : i + FIBLETS]
                for rows, found in _tested(fiblets, region, spacing, balls, some):
                    kernels.merge(found, rows, balls.anchors, ranks, flags[part])
    except IndexError:
        fiblets.verify()  # a damaged file says so itself; whatever else is wrong is raised as it is
        raise
    flags[~wanted] = 0
    if fiblets.rank_to_id is None:
        return flags
    out = np.zeros(fiblets.n_streamlines, np.uint8)
    out[fiblets.rank_to_id] = flags
    return out


def _flags_of_parts(
    fiblets: FibletSet, region: Region, sampling: float | None, ids: Any, bits: int
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
    """Go through a set's fiblets, a few pages at a time.

    Parameters
    ----------
    fiblets : FibletSet
    wanted : numpy.ndarray, optional
        ``(n_ranks,)`` bool: pages without any of these streamlines are passed over.

    Yields
    ------
    FibletBalls
    """
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


def _tested(
    fiblets: FibletSet, region: Region, spacing: float, balls: FibletBalls, rows: Ints
) -> Iterator[tuple[Ints, npt.NDArray[np.uint8]]]:
    """Decode some fiblets and test their points; yield them in portions, with flags of each by itself."""
    which = rows + balls.first
    counts = unpack("last", np.asarray(fiblets.decoding[which])).astype(np.int64) + 1
    starts = np.concatenate([[0], np.cumsum(counts)])
    points = np.empty((int(starts[-1]), 3))
    decode_fiblets(fiblets, which, starts[:-1], points)
    if not spacing:
        yield rows, _reduced(region, points, starts)
        return
    joined = unpack("end", balls.anchors[rows]) == 0
    joints = np.zeros((len(rows), 3))
    joints[joined] = anchor_points(fiblets, which[joined] + 1)
    sizes = np.empty(len(rows))
    kernels.count_samples(points, starts, joints, joined, spacing, sizes)
    if sizes.max() > MOST_SAMPLES:
        raise ValueError(
            f"sampling is {spacing} mm; a fiblet of a step of {fiblets.step_hi:g} mm or more would take "
            f"{sizes.max():.0f} positions, more than 2^28: use a longer sampling"
        )
    totals = np.concatenate([[0], np.cumsum(sizes.astype(np.int64))])
    first = 0
    while first < len(rows):
        last = max(int(np.searchsorted(totals, totals[first] + SAMPLES, side="right")) - 1, first + 1)
        at = totals[first : last + 1] - totals[first]
        out = np.empty((int(at[-1]), 3))
        kernels.fill_samples(points, starts[first : last + 1], joints[first:last], joined[first:last], spacing, at, out)
        yield rows[first:last], _reduced(region, out, at)
        first = last


def _reduced(region: Region, points: Floats, starts: Ints) -> npt.NDArray[np.uint8]:
    found = np.empty(len(starts) - 1, np.uint8)
    kernels.reduce_fiblets(_inside(region, points), starts, found)
    return found


def _inside(region: Region, points: Floats) -> Mask:
    """``region.contains(points)``; for a mesh, whose rays cost more, points are settled by runs where they can be."""
    if all(leaf.kind != SURFACE for leaf in region.leaves):
        return region.contains(points)
    n = -(-len(points) // RUN)
    centres, radii = np.empty((n, 3)), np.empty(n)
    kernels.run_balls(points, RUN, centres, radii)
    sides = classify(region, centres, radii).repeat(RUN)[: len(points)]
    inside = sides > 0
    near = np.flatnonzero(sides == 0)
    inside[near] = region.contains(points[near])
    return inside
