"""Compiled kernels: records of moved copies of streamlines; see `copies`.

All run over the copies ``m`` of one chunk. ``which`` ``(n,) int64`` is the streamline that each one copies; ``first``
``(n_pool + 1,) int64`` where the pool's streamlines begin among its fiblets; ``at`` ``(n + 1,) int64`` where the copies
begin among the fiblets of the whole result. ``out`` holds the chunk's rows only.
"""

from __future__ import annotations

import numba
import numpy as np

from ...support.array_types import Int64s, UInt8s, UInt16s, UInt32s
from ..jit import parallel_kernel
from ..layout import PAGE_BITS


@parallel_kernel
def copy_anchors(anchors: UInt32s, low: UInt16s, fine: bool, first: Int64s, which: Int64s, shift: Int64s, at: Int64s,
                 rank: int, pages: Int64s, out: UInt32s) -> None:  # fmt: skip
    """Anchors moved by ``shift`` ``(n, 3) int64`` whole units; with ``fine`` the upper halves of 32-bit anchors."""
    # `rank` is that of the first copy, `pages` the result's page table.
    for m in numba.prange(len(which)):
        begin = first[which[m]]
        for k in range(at[m + 1] - at[m]):
            f = at[m] + k
            w0, w1 = np.int64(anchors[begin + k, 0]), np.int64(anchors[begin + k, 1])
            q0, q1, q2 = w0 & 0xFFFF, w0 >> 16, w1 & 0xFFFF
            if fine:
                q0 = ((q0 << 16 | np.int64(low[begin + k, 0])) + shift[m, 0]) >> 16
                q1 = ((q1 << 16 | np.int64(low[begin + k, 1])) + shift[m, 1]) >> 16
                q2 = ((q2 << 16 | np.int64(low[begin + k, 2])) + shift[m, 2]) >> 16
            else:
                q0, q1, q2 = q0 + shift[m, 0], q1 + shift[m, 1], q2 + shift[m, 2]
            own = rank + m - pages[f >> PAGE_BITS, 0]
            out[f - at[0], 0] = q0 | q1 << 16
            out[f - at[0], 1] = q2 | own << 16 | (w1 >> 30) << 30


@parallel_kernel
def copy_anchors_low(low: UInt16s, first: Int64s, which: Int64s, shift: Int64s, at: Int64s, out: UInt16s) -> None:
    """Lower halves of moved 32-bit anchors."""
    for m in numba.prange(len(which)):
        begin = first[which[m]]
        for k in range(at[m + 1] - at[m]):
            for axis in range(3):
                out[at[m] - at[0] + k, axis] = (np.int64(low[begin + k, axis]) + shift[m, axis]) & 0xFFFF


@parallel_kernel
def copy_decoding(decoding: UInt32s, within: Int64s, first: Int64s, which: Int64s, at: Int64s, codes_at: Int64s,
                  points_at: Int64s, pages: Int64s, out: UInt32s) -> None:  # fmt: skip
    """Decoding words that point to the copies' own codes and points."""
    # `within` is `(n_fiblets, 2) int64`: code byte and point at which each of the pool's fiblets starts, counted from
    # its streamline's first; `codes_at` and `points_at` `(n,)` where the copies start in the result.
    for m in numba.prange(len(which)):
        begin = first[which[m]]
        for k in range(at[m + 1] - at[m]):
            g, f = begin + k, at[m] + k
            page = f >> PAGE_BITS
            code = codes_at[m] + within[g, 0] - pages[page, 1]
            point = points_at[m] + within[g, 1] - pages[page, 2]
            out[f - at[0], 0] = decoding[g, 0]
            out[f - at[0], 1] = (np.int64(decoding[g, 1]) >> 22) << 22 | code
            out[f - at[0], 2] = (np.int64(decoding[g, 2]) >> 20) << 20 | point


@parallel_kernel
def copy_reach(reach: UInt16s, first: Int64s, which: Int64s, at: Int64s, out: UInt16s) -> None:
    """Copy the originals' radii."""
    for m in numba.prange(len(which)):
        begin = first[which[m]]
        for k in range(at[m + 1] - at[m]):
            out[at[m] - at[0] + k] = reach[begin + k]


@parallel_kernel
def copy_codes(codes: UInt8s, start: Int64s, which: Int64s, codes_at: Int64s, out: UInt8s) -> None:
    """Copy the originals' codes; ``start`` ``(n_pool + 1,)`` is where a streamline's codes begin."""
    for m in numba.prange(len(which)):
        begin, to = start[which[m]], codes_at[m] - codes_at[0]
        for k in range(start[which[m] + 1] - begin):
            out[to + k] = codes[begin + k]
