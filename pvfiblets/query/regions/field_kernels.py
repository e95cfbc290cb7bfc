"""Compiled kernels: squared distances between voxels, and blocks of voxels; see :mod:`.fields`."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np

from ...codec.jit import kernel, parallel_kernel
from ...support.array_types import Bools, Float32s, Float64s, Int64s, UInt8s

_FAR = 1e37  # squared mm where no voxel is: finite, so that differences are


@kernel
def _lower_envelope(line: Float64s, out: Float64s, size: float, places: Int64s, starts: Float64s) -> None:
    """One dimension: ``out[i] = min over j of line[j] + (size (i - j))^2``; ``places``, ``starts`` are for scratch."""
    n = len(line)
    square = size * size
    count = 0
    for q in range(n):
        if line[q] >= _FAR:
            continue
        while count > 0:
            p = places[count - 1]
            # Where the parabola of q goes below that of p.
            meet = ((line[q] - line[p]) / square + (q * q - p * p)) / (2.0 * (q - p))
            if count > 1 and meet <= starts[count - 1]:
                count -= 1
            else:
                starts[count] = meet
                break
        if count == 0:
            starts[0] = -np.inf
        places[count] = q
        count += 1
    if count == 0:
        for i in range(n):
            out[i] = _FAR
        return
    k = 0
    for i in range(n):
        while k + 1 < count and starts[k + 1] < i:
            k += 1
        away = (i - places[k]) * size
        out[i] = line[places[k]] + away * away


@parallel_kernel
def _along_x(targets: Bools, squares: Float32s, size: float) -> None:
    nz, ny, nx = targets.shape
    for z in numba.prange(nz):
        line, out = np.empty(nx), np.empty(nx)
        places, starts = np.empty(nx, np.int64), np.empty(nx)
        for y in range(ny):
            for x in range(nx):
                line[x] = 0.0 if targets[z, y, x] else _FAR
            _lower_envelope(line, out, size, places, starts)
            for x in range(nx):
                squares[z, y, x] = out[x]


@parallel_kernel
def _along_y(squares: Float32s, size: float) -> None:
    nz, ny, nx = squares.shape
    for z in numba.prange(nz):
        line, out = np.empty(ny), np.empty(ny)
        places, starts = np.empty(ny, np.int64), np.empty(ny)
        for x in range(nx):
            for y in range(ny):
                line[y] = squares[z, y, x]
            _lower_envelope(line, out, size, places, starts)
            for y in range(ny):
                squares[z, y, x] = out[y]


def squared_distances(targets: Any, sizes: Any) -> Any:
    """Squared distances of voxel centres from the nearest target's centre."""
    squares = np.empty(targets.shape, np.float32)
    _along_x(targets, squares, float(sizes[0]))
    _along_y(squares, float(sizes[1]))
    _along_y(squares.swapaxes(0, 1), float(sizes[2]))  # along z
    return squares


@parallel_kernel
def _block_states(mask: Bools, block: int, out: UInt8s) -> None:
    nz, ny, nx = out.shape
    ni, nj, nk = mask.shape
    for z in numba.prange(nz):
        for y in range(ny):
            for x in range(nx):
                held = missed = False
                # A block that reaches beyond the volume is out there.
                if (x + 1) * block > ni or (y + 1) * block > nj or (z + 1) * block > nk:
                    missed = True
                for i in range(x * block, min((x + 1) * block, ni)):
                    for j in range(y * block, min((y + 1) * block, nj)):
                        for k in range(z * block, min((z + 1) * block, nk)):
                            if mask[i, j, k]:
                                held = True
                            else:
                                missed = True
                out[z, y, x] = 2 if held and missed else 1 if held else 0


def block_states(mask: Any, block: int) -> Any:
    """Return ``(nz, ny, nx)`` uint8 of blocks of a ``(i, j, k)`` bool volume: 0 all out, 1 all in, 2 both."""
    out = np.empty([-(-n // block) for n in mask.shape[::-1]], np.uint8)
    _block_states(mask, block, out)
    return out


@parallel_kernel
def look_up(mask: Bools, linear: Float64s, centre: Float64s, places: Float64s, out: Bools) -> None:
    """Look up in ``mask`` (i, j, k) the voxels nearest to ``linear (places - centre)``, into ``out`` (n,) bool."""
    ni, nj, nk = mask.shape
    for i in numba.prange(len(places)):
        x, y, z = places[i, 0] - centre[0], places[i, 1] - centre[1], places[i, 2] - centre[2]
        u = np.floor(linear[0, 0] * x + linear[0, 1] * y + linear[0, 2] * z + 0.5)
        v = np.floor(linear[1, 0] * x + linear[1, 1] * y + linear[1, 2] * z + 0.5)
        w = np.floor(linear[2, 0] * x + linear[2, 1] * y + linear[2, 2] * z + 0.5)
        inside = 0.0 <= u < ni and 0.0 <= v < nj and 0.0 <= w < nk  # false for NaN
        out[i] = mask[int(u), int(v), int(w)] if inside else False
