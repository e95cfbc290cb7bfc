"""Fiblets back to streamlines."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ..errors import FormatError
from ..formats.scratch import SPAN, is_long, scratch_array, spans
from ..streamlines import Streamlines
from ..support.ragged import blocks
from .direction_codebook import quaternions
from .files.archive import forget
from .layout import MAX_POINTS, PAGE_BITS, unpack
from .small_sets import without_kernels
from .streamline_ranges import StreamlineRanges, ranges_of

if TYPE_CHECKING:
    from .fibletset import FibletSet
    from .point_values import PointValues


def select_streamlines(n: int, ids: Any) -> npt.NDArray[np.int64]:
    """Normalise a selection of ``n`` streamlines to indices."""
    if isinstance(ids, slice):
        return np.arange(n)[ids]
    chosen = np.atleast_1d(np.asarray(ids))
    if chosen.dtype == bool:
        if chosen.shape != (n,):
            raise IndexError(f"a mask of shape {chosen.shape} cannot choose among {n} streamlines; ({n},) is needed")
        return np.flatnonzero(chosen)
    if chosen.size == 0:
        return np.empty(0, np.int64)
    if chosen.dtype.kind not in "iu":
        raise IndexError(f"streamline ids are whole numbers; got values of type {chosen.dtype}")
    chosen = chosen.astype(np.int64)
    bad = (chosen < -n) | (chosen >= n)
    if bad.any():
        raise IndexError(f"streamline {int(chosen[bad][0])} is not among the {n} streamlines (0..{n - 1})")
    return np.where(chosen < 0, chosen + n, chosen)


def decode_fiblets(
    fiblets: FibletSet, which: npt.NDArray[np.int64], destination: npt.NDArray[np.int64], points: npt.NDArray[Any]
) -> None:
    """Decode chosen fiblets."""
    with without_kernels("decoding", len(points)) as small:
        damaged = _decoder(small)(which, destination, *decoding_arrays(fiblets), points)
    if damaged:
        raise FormatError(
            "the set of fiblets", None, f"{damaged} records that point beyond its arrays", "an undamaged file"
        )


def decoding_arrays(fiblets: FibletSet) -> tuple[Any, ...]:
    """Return the arguments of `decode_kernels.decode_one` for a set, from ``arrays`` to ``tables``."""
    p, low = fiblets.parameters, fiblets.anchors_low
    return (
        (fixed(fiblets.anchors), fixed(fiblets.decoding), fixed(fiblets.codes), fixed(fiblets.pages[:, 1])),
        fixed(np.zeros((1, 3), np.uint16) if low is None else low), low is not None,
        fiblets.origin, fiblets.anchor_scale,
        (p.step_lo, p.step_hi, p.lattice), quaternions().astype(np.float64),
    )  # fmt: skip


def fixed(array: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """A read-only array, like the arrays of mapped sets: kernels are compiled once for both."""
    found = np.ascontiguousarray(array).view()
    found.flags.writeable = False
    return found


def _decoder(small: bool) -> Any:
    if small:
        from .arrays.decode_arrays import decode

        return decode
    from .kernels import decode_kernels  # numba loads only for large sets

    return decode_kernels.decode


def decompress(fiblets: FibletSet, ids: Any = None, dtype: npt.DTypeLike | None = None) -> Streamlines:
    """Decode streamlines; see :meth:`.FibletSet.decompress`."""
    kind = np.dtype(fiblets.point_dtype() if dtype is None else dtype)
    if kind not in (np.dtype(np.float32), np.dtype(np.float64)):
        raise ValueError(f"dtype is {kind}; float32 or float64 is needed")
    chosen = None if ids is None else select_streamlines(fiblets.n_streamlines, ids)
    try:
        return _decompress(fiblets, chosen, kind)
    except (IndexError, ValueError):
        fiblets.verify()  # raises for a damaged file; other errors pass
        raise


def _decompress(fiblets: FibletSet, chosen: npt.NDArray[np.int64] | None, kind: np.dtype[Any]) -> Streamlines:
    meta: dict[str, Any] = {"affine": fiblets.affine, "space": dict(fiblets.space), "dropped": dict(fiblets.dropped)}
    if chosen is None and not fiblets.in_order:
        chosen = np.arange(fiblets.n_streamlines)
    if chosen is None:
        if fiblets.exact is not None:
            points = fiblets.exact.astype(kind)
        else:
            points = np.empty((fiblets.n_points, 3), kind)
            decode_fiblets(fiblets, np.arange(fiblets.n_fiblets), fiblets.fiblet_points(), points)
        return Streamlines(
            points,
            fiblets.offsets(),
            per_point={k: v.values() for k, v in fiblets.per_point.items()},
            per_streamline=dict(fiblets.per_streamline),
            groups=dict(fiblets.groups),
            per_group={k: dict(v) for k, v in fiblets.per_group.items()},
            **meta,
        )
    return _take(fiblets, ranges_of(fiblets, chosen), chosen, kind, meta)


def _take(
    fiblets: FibletSet,
    places: StreamlineRanges,
    chosen: npt.NDArray[np.int64],
    kind: np.dtype[Any],
    meta: dict[str, Any],
) -> Streamlines:
    """Decode chosen streamlines, in the order given; ``places`` are theirs."""
    lengths = places.points
    fresh = np.concatenate([[0], np.cumsum(lengths)])
    rows = np.arange(int(fresh[-1])) + np.repeat(places.point - fresh[:-1], lengths)
    if fiblets.exact is not None:
        points = fiblets.exact[rows].astype(kind, copy=False)
    else:
        # Fiblets of the chosen streamlines, in their order: ranges of consecutive fiblets, laid end to end.
        n = places.fiblets
        which = np.arange(n.sum()) + np.repeat(places.fiblet - (np.cumsum(n) - n), n)
        counts = unpack("last", fiblets.decoding[which]).astype(np.int64) + 1
        points = np.empty((int(fresh[-1]), 3), kind)
        decode_fiblets(fiblets, which, np.cumsum(counts) - counts, points)
    groups = {}
    if fiblets.groups:
        place = np.full(fiblets.n_streamlines, -1, np.int64)
        place[chosen[::-1]] = np.arange(len(chosen))[::-1]
        for name, members in fiblets.groups.items():
            kept = place[np.asarray(members, np.int64)]
            groups[name] = kept[kept >= 0]
    return Streamlines(
        points,
        fresh,
        per_point={k: v.values(rows) for k, v in fiblets.per_point.items()},
        per_streamline={k: v[chosen] for k, v in fiblets.per_streamline.items()},
        groups=groups,
        per_group={k: dict(v) for k, v in fiblets.per_group.items()},
        **meta,
    )


def iter_chunks(
    fiblets: FibletSet, max_points: int = 2_000_000, dtype: npt.DTypeLike | None = None
) -> Iterator[Streamlines]:
    """Decode consecutive streamlines in bounded memory."""
    kind = np.dtype(fiblets.point_dtype() if dtype is None else dtype)
    try:
        iterate = _iterate if fiblets.in_order else _iterate_out_of_order
        yield from iterate(fiblets, max_points, kind)
    except (IndexError, ValueError):
        fiblets.verify()
        raise


def held_in_bounds(fiblets: FibletSet, chunks: Iterable[Streamlines]) -> Iterator[Streamlines]:
    """Bring decoded points that lie outside of the original points' bounds back to them, in place."""
    # That brings them nearer to their originals, if anything. Programs such as dipy refuse a file whose points leave
    # its image, and originals do lie on its very edge.
    edges, promise = np.reshape(fiblets.bounds, (3, 2)), fiblets.promise
    for chunk in chunks:
        for column, (low, high) in zip(chunk.points.T, edges.astype(chunk.points.dtype), strict=True):
            # No farther than coding can have moved them: bounds of a damaged file must not flatten its lines.
            column[(column < low) & (column >= low - promise)] = low
            column[(column > high) & (column <= high + promise)] = high
        yield chunk


def _iterate(fiblets: FibletSet, max_points: int, kind: np.dtype[Any]) -> Iterator[Streamlines]:
    n, a, first_id, first_point = fiblets.n_fiblets, 0, 0, 0
    while a < n or first_id < fiblets.n_streamlines:
        b = _next_begin(fiblets, a, max(max_points // MAX_POINTS, 1)) if a < n else n
        which = np.arange(a, b)
        counts = unpack("last", fiblets.decoding[a:b]).astype(np.int64) + 1
        begins = np.flatnonzero(unpack("begin", fiblets.anchors[a:b]))
        per_rank = np.add.reduceat(counts, begins) if begins.size else np.empty(0, np.int64)
        rank = fiblets.rank_at(a) if a < n else fiblets.n_ranks
        last_rank = rank + len(begins)
        ids = np.arange(rank, last_rank) if fiblets.rank_to_id is None else fiblets.rank_to_id[rank:last_rank]
        # Streamlines without points belong to the chunk of the streamline before them.
        stop = fiblets.n_streamlines
        if b < n:
            stop = last_rank if fiblets.rank_to_id is None else int(fiblets.rank_to_id[last_rank])
        if not first_id <= stop <= fiblets.n_streamlines:  # numbers from a damaged file must not size an array
            raise IndexError(f"streamlines {first_id} to {stop}, in a set of {fiblets.n_streamlines}")
        lengths = np.zeros(stop - first_id, np.int64)
        lengths[np.asarray(ids) - first_id] = per_rank
        rows = slice(first_point, first_point + int(counts.sum()))
        n_points = rows.stop - rows.start
        long = n_points > max_points and is_long(n_points)  # one line, longer than the limit
        points = _points(fiblets, which, counts, rows, kind, long)
        groups = {}
        for name, members in fiblets.groups.items():
            inside = np.asarray(members, np.int64)
            groups[name] = inside[(inside >= first_id) & (inside < stop)] - first_id
        yield Streamlines(
            points,
            np.concatenate([[0], np.cumsum(lengths)]),
            per_point={k: _values(v, rows, long) for k, v in fiblets.per_point.items()},
            per_streamline={k: v[first_id:stop] for k, v in fiblets.per_streamline.items()},
            groups=groups,
            per_group={k: dict(v) for k, v in fiblets.per_group.items()},
            affine=fiblets.affine,
            space=dict(fiblets.space),
            dropped=dict(fiblets.dropped) if first_id == 0 else {},
        )
        _forget(fiblets, a, b, rows)
        a, first_id, first_point = b, stop, rows.stop


def _points(
    fiblets: FibletSet,
    which: npt.NDArray[np.int64],
    counts: npt.NDArray[np.int64],
    rows: slice,
    kind: np.dtype[Any],
    long: bool,
) -> npt.NDArray[Any]:
    """Points of consecutive fiblets, which have so many each and are these rows; of a very long line on disk."""
    n = rows.stop - rows.start
    if not long:
        if fiblets.exact is not None:
            return fiblets.exact[rows].astype(kind)
        points = np.empty((n, 3), kind)
        decode_fiblets(fiblets, which, np.cumsum(counts) - counts, points)
        return points
    points = scratch_array((n, 3), kind)
    if fiblets.exact is not None:
        for a, b in spans(n):
            points[a:b] = fiblets.exact[rows.start + a : rows.start + b]
            forget(points, 0, b)
        return points
    starts = np.cumsum(counts) - counts
    for a, b in spans(len(which), SPAN // MAX_POINTS):
        stop = int(starts[b]) if b < len(which) else n
        decode_fiblets(fiblets, which[a:b], starts[a:b] - starts[a], points[starts[a] : stop])
        forget(points, 0, stop)
        forget(fiblets.codes, 0, int(fiblets.pages[which[a] >> PAGE_BITS, 1]))
    return points


def _values(values: PointValues, rows: slice, long: bool) -> npt.NDArray[Any]:
    if not long:
        return values.values(rows)
    n = rows.stop - rows.start
    found = scratch_array((n,), values.dtype)
    for a, b in spans(n):
        found[a:b] = values.values(slice(rows.start + a, rows.start + b))
        forget(found, 0, b)
    return found


def _iterate_out_of_order(fiblets: FibletSet, max_points: int, kind: np.dtype[Any]) -> Iterator[Streamlines]:
    """Streamlines in their own order, gathered from wherever they are coded."""
    places = StreamlineRanges.from_fiblets(fiblets)
    for a, b in blocks(np.concatenate([[0], np.cumsum(places.points)]), max_points):
        meta = {
            "affine": fiblets.affine,
            "space": dict(fiblets.space),
            "dropped": dict(fiblets.dropped) if a == 0 else {},
        }
        chosen = np.arange(a, b)
        yield _take(fiblets, places.at(chosen), chosen, kind, meta)
        _forget(fiblets, 0, fiblets.n_fiblets - 1, slice(0, fiblets.n_points))


def _forget(fiblets: FibletSet, a: int, b: int, rows: slice) -> None:
    """Release the memory of the read part of a mapped file, up to the page of codes that fiblet ``b`` begins in."""
    for array in (fiblets.anchors, fiblets.decoding, fiblets.anchors_low):
        if array is not None:
            forget(array, a, b)
    pages = fiblets.pages[:, 1]
    forget(fiblets.codes, int(pages[a >> PAGE_BITS]), int(pages[b >> PAGE_BITS]))
    for points in fiblets.per_point.values():
        forget(points.codes, rows.start, rows.stop)


def _next_begin(fiblets: FibletSet, a: int, wanted: int) -> int:
    """First fiblet at or after ``a + wanted`` that begins a streamline."""
    n = fiblets.n_fiblets
    if a + wanted >= n:
        return n
    # Rather a little less than asked for than a little more.
    back = np.flatnonzero(unpack("begin", fiblets.anchors[a + 1 : a + wanted + 1]))
    if back.size:
        return a + 1 + int(back[-1])
    start = a + wanted
    while start < n:
        ahead = np.flatnonzero(unpack("begin", fiblets.anchors[start : start + 65536]))
        if ahead.size:
            return start + int(ahead[0])
        start += 65536
    return n
