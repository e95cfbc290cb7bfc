"""Whole-array operations on the rows of a tractogram: find, leave out, transform.

Blocks of rows that fit a core's cache are handled by a few threads (NumPy releases the
interpreter's lock), so a pass costs about what reading the memory costs.
"""

from __future__ import annotations

import os
import threading
import warnings
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from os import PathLike
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from pvfiblets.formats.mapped import forget
from pvfiblets.formats.scratch import is_long, scratch_array
from pvfiblets.invalid_points import without_points
from pvfiblets.streamlines import Streamlines, offsets_from_counts

Array = NDArray[Any]
Ints = NDArray[np.int64]

BLOCK_BYTES = 3 << 19  # bytes per block: measured best between 0.2 and 12 MB for a 180 MB file on two cores

_THREADS = min(os.cpu_count() or 1, 8)

_TOLD_ROUNDING = 1e-3  # error of float32 (mm) from which writers warn


def nonfinite(values: Array) -> Ints:
    """Find the indices (ascending) of NaN and infinity in a one-dimensional float array."""

    def part(first: int, last: int) -> Ints:
        found = np.flatnonzero(~np.isfinite(values[first:last])) + first
        forget(values, first, last)
        return found

    parts = _each_block(part, len(values), values.itemsize)
    return np.concatenate(parts) if parts else np.zeros(0, np.int64)


def check_rounding(path: str | PathLike[str], points: Array) -> None:
    """Refuse points that float32 cannot hold, warn if it moves them; of mapped points nothing stays in memory."""
    most, step = 0.0, BLOCK_BYTES // 8
    for first in range(0, len(points) if points.dtype == np.float64 else 0, step):
        block = points[first : first + step]
        with np.errstate(over="ignore"):
            most = max(most, float(np.abs(block - block.astype(np.float32)).max()))
        forget(points, 0, first + len(block))
    if not np.isfinite(most):
        raise ValueError(f"{path}: float32 cannot hold some coordinates; check the units, or write doubles")
    if most > _TOLD_ROUNDING:
        warnings.warn(
            f"{path}: float32 moves points by up to {most:.2g} mm; doubles (--double, double=True) keep them, which "
            "not all programs read",
            UserWarning,
            stacklevel=4,
        )


def finite_rows(rows: Array, dtype: DTypeLike) -> tuple[Array, Ints, Array]:
    """Copy the rows that are finite throughout, in one pass over the memory."""
    n, k = rows.shape
    kind = np.dtype(dtype)
    out = np.empty((n, k), kind)
    # A row seen as one opaque value lets NumPy's mask copy whole runs of rows by memcpy.
    row = np.dtype((np.void, k * kind.itemsize))
    target = out.view(row)[:, 0] if n else out
    step = max(1, BLOCK_BYTES // (k * kind.itemsize))
    n_blocks = -(-n // step)
    # Where a block's rows go depends on how many the blocks before it leave out: each block
    # tells the next. Blocks are begun in order, so the one waited for is always under way.
    left_out_before = [0] * (n_blocks + 1)
    known = [threading.Event() for _ in range(n_blocks + 1)]
    known[0].set()

    def part(first: int, last: int) -> tuple[Ints, Array]:
        i = first // step
        try:
            block = np.ascontiguousarray(rows[first:last], kind)
            flat = np.flatnonzero(~np.isfinite(block.reshape(-1))) // k
            bad = flat[np.diff(flat, prepend=-1) > 0]
            known[i].wait()
            left_out_before[i + 1] = left_out_before[i] + len(bad)
        finally:
            known[i + 1].set()
        at = first - left_out_before[i]
        source = block.view(row)[:, 0]
        if len(bad):
            keep = np.ones(last - first, bool)
            keep[bad] = False
            source = source[keep]
        target[at : at + len(source)] = source
        return bad + first, block[bad]  # while the block is in the cache

    parts = _each_block(part, n, k * kind.itemsize)
    bad = np.concatenate([p[0] for p in parts]) if parts else np.zeros(0, np.int64)
    others = np.concatenate([p[1] for p in parts]) if parts else np.zeros((0, k), kind)
    kept = out[: n - len(bad)]
    # A file of little but delimiters should not keep the space that they took.
    return (kept.copy() if len(bad) > n // 8 else kept), bad, others


def without_rows(rows: Array, leave_out: Ints, dtype: DTypeLike, *, long: bool = False) -> Array:
    """Copy of `rows` as native `dtype`, less the rows `leave_out`."""
    n, k = rows.shape
    kind = np.dtype(dtype)
    out = (scratch_array if long else np.empty)((n - len(leave_out), k), kind)
    if out.size == 0:
        return out
    # A row seen as one opaque value lets NumPy's mask copy whole runs of rows by memcpy.
    row = np.dtype((np.void, k * kind.itemsize))
    target = out.view(row)[:, 0]

    def part(first: int, last: int) -> None:
        begin, end = np.searchsorted(leave_out, (first, last))
        block = rows[first:last]
        if block.dtype != kind:
            with np.errstate(over="ignore", invalid="ignore"):  # non-finite values are reported later
                block = block.astype(kind)
        place = target[first - begin : last - end]
        source = block.view(row)[:, 0]
        if begin == end:
            place[:] = source
        else:
            keep = np.ones(last - first, bool)
            keep[leave_out[begin:end] - first] = False
            place[:] = source[keep]
        if long:
            forget(rows, first, last)
            forget(out, first - begin, last - end)

    _each_block(part, n, rows.itemsize * k)
    return out


def transformed(points: Array, affine: NDArray[np.float64], *, long: bool = False) -> NDArray[np.float32]:
    """(n, 3) float32 points moved by a (4, 4) affine, computed in float64; made on disk where they are `long`."""
    out = (scratch_array if long else np.empty)((len(points), 3), np.float32)
    linear, shift = affine[:3, :3], affine[:3, 3]

    def part(first: int, last: int) -> None:
        with np.errstate(over="ignore", invalid="ignore"):  # some NaN cannot even be widened without a complaint
            block = points[first:last].astype(np.float64)
            for j in range(3):
                # Not by matrix product: its library would start threads inside these threads.
                column = np.full(last - first, shift[j])
                for i in np.flatnonzero(linear[j]):
                    column += linear[j, i] * block[:, i]
                out[first:last, j] = column
        if long:
            forget(points, first, last)
            forget(out, first, last)

    _each_block(part, len(points), 24)
    return out


def finite(
    points: Array,
    counts: Ints,
    per_point: Mapping[str, Array],
    dropped: dict[str, int],
    **rest: Any,
) -> Streamlines:
    """Streamlines of the points whose three coordinates are finite."""
    # The others are left out with their data, lines are cut there, and `dropped` counts both; a streamline that has
    # none left stays as a streamline without points.
    streamlines = Streamlines(points, offsets_from_counts(counts), per_point, dropped=dropped, **rest)
    values = points if points.flags.c_contiguous else np.ascontiguousarray(points)
    bad = nonfinite(values.reshape(-1))
    return without_points(streamlines, np.unique(bad // 3), delete=_less) if len(bad) else streamlines


def _less(values: Array, rows: Ints) -> Array:
    """Values without some rows; mapped arrays stay on disk."""
    if not (is_long(len(values)) and isinstance(values, np.memmap)):
        return np.delete(values, rows, axis=0)
    flat = values.reshape(len(values), -1)
    return without_rows(flat, rows, values.dtype, long=True).reshape(-1, *values.shape[1:])


def _each_block(part: Callable[[int, int], Any], n: int, row_bytes: int) -> list[Any]:
    """Call ``part(first, last)`` for consecutive blocks of rows, several at a time, in order."""
    step = max(1, BLOCK_BYTES // max(1, row_bytes))
    firsts = range(0, n, step)
    if len(firsts) < 2 or _THREADS < 2:
        return [part(first, min(first + step, n)) for first in firsts]
    with ThreadPoolExecutor(_THREADS) as pool:
        return list(pool.map(lambda first: part(first, min(first + step, n)), firsts))
