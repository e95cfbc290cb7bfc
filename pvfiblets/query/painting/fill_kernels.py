"""A compiled kernel: voxels that hang together."""

from __future__ import annotations

import numpy as np

from ...codec.jit import kernel
from ...support.array_types import Bools, Int64s


@kernel
def connected(open_: Bools, shape: tuple[int, int, int], seed: int) -> Int64s:
    """Flat places of open voxels that are joined to a seed by faces, ``(n,)`` int64; none if it is not open."""
    # `open_` is flat in C order, bool; it is closed where the result goes.
    nx, ny, nz = shape
    found = np.empty(64, np.int64)
    if not open_[seed]:
        return found[:0].copy()
    found[0], n, done = seed, 1, 0
    open_[seed] = False
    while done < n:
        v = found[done]
        done += 1
        x, y, z = v // (ny * nz), v // nz % ny, v % nz
        if n + 6 > len(found):
            more = np.empty(2 * len(found), np.int64)
            more[:n] = found[:n]
            found = more
        for side in range(6):
            if side == 0 and x > 0:
                w = v - ny * nz
            elif side == 1 and x + 1 < nx:
                w = v + ny * nz
            elif side == 2 and y > 0:
                w = v - nz
            elif side == 3 and y + 1 < ny:
                w = v + nz
            elif side == 4 and z > 0:
                w = v - 1
            elif side == 5 and z + 1 < nz:
                w = v + 1
            else:
                continue
            if open_[w]:
                open_[w] = False
                found[n] = w
                n += 1
    return found[:n].copy()
