"""Compiled kernels: which points' values lie in a range, as bits; see :mod:`.bits`."""

from __future__ import annotations

import math

import numba
import numpy as np

from ...codec.jit import parallel_kernel
from ...support.array_types import Bools, Float64s, Integers, UInt32s


@parallel_kernel
def keep_values(values: Float64s, lo: float, hi: float, keep_nan: bool, words: UInt32s) -> None:
    """Clear the bits of points whose value is not within ``lo`` to ``hi``."""
    # `values` is `(n,)` float32, `words` `((n + 31) // 32,)` uint32, changed in place.
    for w in numba.prange(len(words)):
        word = np.uint32(0)
        for i in range(32 * w, min(32 * w + 32, len(values))):
            value = np.float64(values[i])
            if lo <= value <= hi or (keep_nan and math.isnan(value)):
                word |= np.uint32(1) << np.uint32(i & 31)
        words[w] &= word


@parallel_kernel
def keep_codes(codes: Integers, kept: Bools, words: UInt32s) -> None:
    """Clear the bits of points whose code is not kept."""
    # `codes` is `(n,)` uint8 or uint16, `kept` `(256 or 65536,)` bool, `words` as in `keep_values`.
    for w in numba.prange(len(words)):
        word = np.uint32(0)
        for i in range(32 * w, min(32 * w + 32, len(codes))):
            if kept[codes[i]]:
                word |= np.uint32(1) << np.uint32(i & 31)
        words[w] &= word
