"""Ragged arrays: offsets, and the checks that every Streamlines passes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array: TypeAlias = NDArray[Any]
Floats: TypeAlias = NDArray[np.floating[Any]]
Ints: TypeAlias = NDArray[np.int64]

_BLOCK_POINTS = 1 << 18  # points handled at a time by reductions: about 6 MB of float64, which stays in cache


def offsets_from_counts(counts: ArrayLike) -> Ints:
    """(n + 1,) int64 running sum of the `n` counts, beginning with 0."""
    counts = np.asarray(counts, np.int64)
    offsets = np.zeros(len(counts) + 1, np.int64)
    np.cumsum(counts, out=offsets[1:])
    return offsets


def cut_offsets(offsets: Ints, rows: Ints) -> tuple[Ints, Ints]:
    """Return the offsets once ascending `rows` are gone and lines end there, and how many pieces each line has."""
    left = offsets - np.searchsorted(rows, offsets)
    cuts = np.unique(rows - np.arange(len(rows)))
    owner = np.searchsorted(left, cuts, side="right") - 1
    inner = left[owner] < cuts  # a row at a line's end shortens the line and cuts nothing
    cuts, owner = cuts[inner], owner[inner]
    return np.insert(left, owner + 1, cuts), 1 + np.bincount(owner, minlength=len(offsets) - 1)


def blocks(offsets: Ints, max_points: int) -> Iterator[tuple[int, int]]:
    """Consecutive ranges of streamlines of at most `max_points` points (see Streamlines.blocks)."""
    if max_points < 1:
        raise ValueError(f"max_points is {max_points}, expected at least 1")
    n = len(offsets) - 1
    start = 0
    while start < n:
        stop = int(np.searchsorted(offsets, offsets[start] + max_points, side="right")) - 1
        stop = min(max(stop, start + 1), n)
        yield start, stop
        start = stop


def as_points(points: ArrayLike) -> Floats:
    """Return points as a (n, 3) array of float32 or float64; ValueError if they are none."""
    array = np.asarray(points) if not isinstance(points, np.ndarray) else points
    if array.size == 0 and array.ndim < 2:
        array = np.zeros((0, 3), np.float32)
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"points have the shape {array.shape}, expected (n_points, 3)")
    if array.dtype in (np.float32, np.float64) and array.dtype.isnative:
        return array
    if array.dtype.kind not in "fiub":
        raise ValueError(f"points have the type {array.dtype}, expected numbers")
    narrow = array.dtype.kind == "f" and array.dtype.itemsize <= 4
    return array.astype(np.float32 if narrow else np.float64)


def as_offsets(offsets: ArrayLike, n_points: int) -> Ints:
    """Return offsets as int64; ValueError unless they run from 0 to `n_points` upwards."""
    array = np.asarray(offsets)
    if array.ndim != 1 or len(array) == 0 or array.dtype.kind not in "iu":
        raise ValueError(
            f"offsets have the shape {array.shape} and type {array.dtype}, expected (n_streamlines + 1,) integers"
        )
    array = array.astype(np.int64, copy=False)
    if array[0] != 0 or array[-1] != n_points:
        raise ValueError(f"offsets run from {array[0]} to {array[-1]}, expected 0 to {n_points} (the points)")
    if np.any(array[1:] < array[:-1]):
        at = int(np.argmax(array[1:] < array[:-1]))
        raise ValueError(f"offsets decrease after streamline {at}; they must never decrease")
    return array


def as_columns(columns: Mapping[str, ArrayLike] | None, n: int, title: str, what: str) -> dict[str, Array]:
    """Return named arrays; ValueError unless each has `n` rows."""
    result: dict[str, Array] = {}
    for name, values in (columns or {}).items():
        array = np.asarray(values)
        if array.ndim == 0 or len(array) != n:
            raise ValueError(
                f"{title}[{name!r}] has the shape {array.shape}, expected one row for each of the {n} {what}"
            )
        result[name] = array
    return result


def as_members(name: str, ids: ArrayLike, n: int) -> Ints:
    """Return a group's indices as int64; ValueError unless all are in [0, `n`)."""
    array = np.asarray(ids)
    if array.size == 0:
        return np.zeros(0, np.int64)
    if array.ndim != 1 or array.dtype.kind not in "iu":
        raise ValueError(f"group {name!r} must be a list of integers, not {array.dtype}")
    if array.min() < 0 or array.max() >= n:
        raise ValueError(f"group {name!r} refers to streamlines {array.min()} to {array.max()}, but there are {n}")
    return array.astype(np.int64)


def as_affine(affine: ArrayLike) -> NDArray[np.float64]:
    """Return a (4, 4) float64 matrix; ValueError for another shape."""
    array = np.asarray(affine, np.float64)
    if array.shape != (4, 4):
        raise ValueError(f"the affine has the shape {array.shape}, expected (4, 4)")
    return array


def join(parts: Sequence[Mapping[str, Array]], title: str) -> dict[str, Array]:
    """Concatenate arrays of the same name; ValueError if a part lacks one."""
    names = list(parts[0])
    for part in parts[1:]:
        if odd := sorted(set(names) ^ set(part)):
            raise ValueError(f"{title} {odd} is not in every part; add it to all of them or remove it")
    return {name: np.concatenate([p[name] for p in parts]) for name in names}


def as_ids(index: Any, n: int) -> Ints:
    """Return numbers from 0 to `n` - 1 of an index array or a mask; IndexError if they are out of range."""
    ids = np.asarray(index)
    if ids.ndim != 1:
        raise IndexError(f"an index array must have one dimension, not {ids.ndim}")
    if ids.dtype == bool:
        if len(ids) != n:
            raise IndexError(f"a mask of {len(ids)} values cannot select among {n} streamlines")
        return np.flatnonzero(ids).astype(np.int64)
    if len(ids) == 0:
        return np.zeros(0, np.int64)
    if ids.dtype.kind not in "iu":
        raise IndexError(f"streamlines are chosen by integers or a mask, not by {ids.dtype}")
    if ids.min() < -n or ids.max() >= n:
        raise IndexError(
            f"streamline indices run from {ids.min()} to {ids.max()}, but there are {n} streamlines"
        )
    return np.where(ids < 0, ids + n, ids).astype(np.int64)


def lengths(points: Floats, offsets: Ints) -> NDArray[np.float64]:
    """Return the length of each polyline, ``(n,)`` float64, summed in float64."""
    result = np.zeros(len(offsets) - 1)
    for start, stop in blocks(offsets, _BLOCK_POINTS):
        first, last = offsets[start], offsets[stop]
        if last - first < 2:
            continue
        part = points[first:last].astype(np.float64)
        segments = np.sqrt(np.einsum("ij,ij->i", d := np.diff(part, axis=0), d))
        # The segment that leads from one streamline to the next belongs to neither.
        inner = offsets[start + 1 : stop] - first
        segments[inner[(inner > 0) & (inner < last - first)] - 1] = 0.0
        owner = np.repeat(np.arange(stop - start), np.diff(offsets[start : stop + 1]))[:-1]
        result[start:stop] = np.bincount(owner, segments, minlength=stop - start)
    return result
