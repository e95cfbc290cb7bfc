"""Compiled kernels: pairs of ends looked for in a grid of cells; see :mod:`.endpoints`."""

from __future__ import annotations

import math

import numba
import numpy as np

from ...codec.jit import kernel, parallel_kernel
from ...support.array_types import Bools, Float64s, Int64s

BLOCK = 256  # streamlines a thread looks at in one go


@parallel_kernel
def find_similar(ends: Float64s, pairs: Float64s, keys: Int64s, starts: Int64s, low: Float64s, edge: float,
                 distance: float, found: Bools) -> None:  # fmt: skip
    """Return the streamlines with both ends near the ends of a pair."""
    squares = distance * distance
    for block in numba.prange((len(found) + BLOCK - 1) // BLOCK):
        for s in range(block * BLOCK, min((block + 1) * BLOCK, len(found))):
            found[s] = False
            x, y, z = (ends[s, 0, 0] - low[0]) / edge, (ends[s, 0, 1] - low[1]) / edge, (ends[s, 0, 2] - low[2]) / edge
            inside = -2.0 < x < 2.0**20 + 2.0 and -2.0 < y < 2.0**20 + 2.0 and -2.0 < z < 2.0**20 + 2.0
            if not inside:  # nor where there are no points
                continue
            cx, cy, cz = math.floor(x), math.floor(y), math.floor(z)
            for row in range(9):
                cell_y, cell_z = cy + row % 3 - 1, cz + row // 3 - 1
                if cell_y < 0 or cell_z < 0:
                    continue
                # Three cells along x are neighbours in the list of cells.
                base = (np.int64(cell_y) << 21) + (np.int64(cell_z) << 42)
                k = np.searchsorted(keys, base + max(cx - 1, 0))
                while k < len(keys) and keys[k] <= base + cx + 1 and not found[s]:
                    for i in range(starts[k], starts[k + 1]):
                        if _apart(ends, s, 0, pairs, i) <= squares and _apart(ends, s, 1, pairs, i) <= squares:
                            found[s] = True
                            break
                    k += 1
                if found[s]:
                    break


@kernel
def _apart(ends: Float64s, s: int, end: int, pairs: Float64s, i: int) -> float:
    dx = ends[s, end, 0] - pairs[i, end, 0]
    dy = ends[s, end, 1] - pairs[i, end, 1]
    dz = ends[s, end, 2] - pairs[i, end, 2]
    return dx * dx + dy * dy + dz * dz
