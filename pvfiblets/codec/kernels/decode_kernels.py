"""Compiled kernels: fiblets to points, in parallel."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np

from ...support.array_types import Float64s, Floats, Int64s, UInt8s, UInt16s, UInt32s
from ..jit import kernel, parallel_kernel
from ..layout import DIRECTION, NODE_BYTES, PAGE_BITS, PLAIN_BYTES, SPLINE, STEP_LEVELS, WIDE, WIDE_HEADER
from .direction_kernels import first_frame, turn
from .spline_kernels import advance, load, point_of, slope

BLOCK = 256  # fiblets a thread decodes in one go


@kernel
def _decode_direction(a: tuple[float, float, float], shape: int, step: float, table: Float64s, codes: UInt8s, at: int,
                      n: int, origin: Float64s, p: Floats) -> None:  # fmt: skip
    dx, dy, dz, w, x, y, z = first_frame(shape)
    ax = a[0] + step * dx
    ay = a[1] + step * dy
    az = a[2] + step * dz
    p[1, 0], p[1, 1], p[1, 2] = ax + origin[0], ay + origin[1], az + origin[2]
    for i in range(2, n):
        code = codes[at + i - 2]
        w, x, y, z = turn(w, x, y, z, table[code])
        ax += step * (1.0 - 2.0 * (y * y + z * z))
        ay += step * (2.0 * (x * y + w * z))
        az += step * (2.0 * (x * z - w * y))
        p[i, 0], p[i, 1], p[i, 2] = ax + origin[0], ay + origin[1], az + origin[2]


@kernel
def _take(codes: UInt8s, at: int, width: int) -> np.int64:
    value = np.int64(0)
    for byte in range(width):
        value |= np.int64(codes[at + byte]) << (8 * byte)
    return value


@kernel
def _signed(value: int, bits: int) -> int:
    return value - (1 << bits) if value >> (bits - 1) else value


@kernel
def _decode_lattice(a: tuple[float, float, float], kind: int, shape: int, step: int, h: float, codes: UInt8s, at: int,
                    n: int, origin: Float64s, p: Floats) -> None:  # fmt: skip
    if kind == WIDE:
        l0 = _signed(_take(codes, at, 4), 32)
        l1 = _signed(_take(codes, at + 4, 4), 32)
        l2 = _signed(_take(codes, at + 8, 4), 32)
        nx, ny = max(_take(codes, at + 12, 4), 1), max(_take(codes, at + 16, 4), 1)
        width = step & 7
        at += WIDE_HEADER
    else:
        l0 = _signed(shape & 0xFF, 8)
        l1 = _signed(shape >> 8 & 0xFF, 8)
        l2 = _signed(shape >> 16 & 0xFF, 8)
        nx, ny = (shape >> 24 & 0xFF) + 1, (step & 0xFF) + 1
        width = kind
    k0, k1, k2 = 0, 0, 0
    for i in range(1, n):
        value = _take(codes, at, width)
        at += width
        rows = value // nx
        k0 += l0 + value - rows * nx
        k1 += l1 + rows % ny
        k2 += l2 + rows // ny
        p[i, 0] = a[0] + h * k0 + origin[0]
        p[i, 1] = a[1] + h * k1 + origin[1]
        p[i, 2] = a[2] + h * k2 + origin[2]


@kernel
def _decode_plain(
    a: tuple[float, float, float], h: float, codes: UInt8s, at: int, n: int, origin: Float64s, p: Floats
) -> None:
    k0, k1, k2 = 0, 0, 0
    for i in range(1, n):
        k0 += _signed(_take(codes, at, 4), 32)
        k1 += _signed(_take(codes, at + 4, 4), 32)
        k2 += _signed(_take(codes, at + 8, 4), 32)
        at += PLAIN_BYTES
        p[i, 0] = a[0] + h * k0 + origin[0]
        p[i, 1] = a[1] + h * k1 + origin[1]
        p[i, 2] = a[2] + h * k2 + origin[2]


@kernel
def _decode_spline(a: tuple[float, float, float], shape: int, h: float, codes: UInt8s, at: int, nodes: int, n: int,
                   origin: Float64s, p: Floats) -> None:  # fmt: skip
    state, node = np.zeros((2, 3)), np.zeros((2, 3))
    for axis in range(3):
        state[1, axis] = slope(shape, axis)
    i = 1
    for piece in range(nodes):
        span = load(codes, at + piece * NODE_BYTES, node)
        for m in range(1, min(span, n - i) + 1):
            for axis in range(3):
                p[i, axis] = a[axis] + h * point_of(state, node, m, span, axis) + origin[axis]
            i += 1
        advance(state, node, max(span, 1))
    for rest in range(i, n):  # of a damaged file
        p[rest] = p[i - 1]


@kernel
def decode_one(f: int, arrays: tuple[UInt32s, UInt32s, UInt8s, Int64s], low: UInt16s, fine: bool, origin: Float64s,
               scale: Float64s, steps: tuple[float, float, float], tables: Float64s, out: Floats,
               row: int) -> int:  # fmt: skip
    """Decode fiblet `f` into ``out`` from `row` on, in the terms of :func:`decode`."""
    # Returns the number of its points; 0, and nothing is written, if its record points beyond the arrays.
    anchors, decoding, codes, code_base = arrays
    lo, hi, lattice = steps
    w0, w1 = anchors[f, 0], anchors[f, 1]
    shape, w3, w4 = np.int64(decoding[f, 0]), np.int64(decoding[f, 1]), np.int64(decoding[f, 2])
    q0, q1, q2 = float(w0 & 0xFFFF), float(w0 >> 16), float(w1 & 0xFFFF)
    if fine:
        q0 = q0 * 65536.0 + float(low[f, 0])
        q1 = q1 * 65536.0 + float(low[f, 1])
        q2 = q2 * 65536.0 + float(low[f, 2])
    a = (scale[0] * q0, scale[1] * q1, scale[2] * q2)
    n: Any = (w4 >> 20 & 0x3F) + 1
    step, cap, kind = w3 >> 22, w4 >> 26 & 0xF, w4 >> 30
    at = code_base[f >> PAGE_BITS] + (w3 & 0x3FFFFF)
    size, plain, spline = n - 2, kind == WIDE and step & 7 == 0, kind == WIDE and step & 7 == SPLINE
    if plain:
        size = (n - 1) * PLAIN_BYTES
    elif spline:
        size = (step >> 3) * NODE_BYTES
    elif kind == WIDE:
        size = WIDE_HEADER + (n - 1) * (step & 7)
    elif kind != DIRECTION:
        size = (n - 1) * kind
    # A record read from a damaged file must not reach beyond the arrays.
    if at < 0 or at + size > len(codes) or row < 0 or row + n > len(out):
        return 0
    p = out[row : row + n]
    p[0, 0], p[0, 1], p[0, 2] = a[0] + origin[0], a[1] + origin[1], a[2] + origin[2]
    if n == 1:
        return 1
    if kind == DIRECTION:
        length = lo if hi <= lo else lo + step * (hi - lo) / STEP_LEVELS
        _decode_direction(a, shape, length, tables[cap], codes, at, n, origin, p)
    elif plain:
        _decode_plain(a, lattice * 0.5**cap, codes, at, n, origin, p)
    elif spline:
        _decode_spline(a, shape, lattice * 0.5**cap, codes, at, step >> 3, n, origin, p)
    else:
        _decode_lattice(a, kind, shape, step, lattice * 0.5**cap, codes, at, n, origin, p)
    return n


@parallel_kernel
def decode(fiblets: Int64s, destination: Int64s, arrays: tuple[UInt32s, UInt32s, UInt8s, Int64s], low: UInt16s,
           fine: bool, origin: Float64s, scale: Float64s, steps: tuple[float, float, float], tables: Float64s,
           out: Floats) -> int:  # fmt: skip
    """Decode fiblets into ``out``; returns how many were damaged and left out."""
    n_blocks = (len(fiblets) + BLOCK - 1) // BLOCK
    missed = np.zeros(n_blocks, np.int64)
    for block in numba.prange(n_blocks):
        for m in range(block * BLOCK, min((block + 1) * BLOCK, len(fiblets))):
            done = decode_one(fiblets[m], arrays, low, fine, origin, scale, steps, tables, out, destination[m])
            missed[block] += done == 0
    return int(missed.sum())
