"""Fiblets to points in NumPy, in the arithmetic of `decode_kernels`: for few of them."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ..layout import (
    DIRECTION,
    NODE_BITS,
    NODE_BYTES,
    PAGE_BITS,
    PLAIN_BYTES,
    SLOPE_BITS,
    SLOPE_SHIFT,
    SPLINE,
    STEP_LEVELS,
    WIDE,
    WIDE_HEADER,
    code_bytes,
    unpack,
)
from .frame_arrays import first_frames, turn, turned_x

BATCH = 2048  # fiblets at once
LARGEST_WIDTH = 7  # bytes of a code, in damaged records

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


def decode(
    fiblets: Ints,
    destination: Ints,
    arrays: tuple[Any, ...],
    low: npt.NDArray[np.uint16],
    fine: bool,
    origin: Array,
    scale: Array,
    steps: tuple[float, float, float],
    tables: Array,
    out: npt.NDArray[np.floating],
) -> int:
    """Decode fiblets into ``out``; returns how many were damaged and left out."""
    # Arguments are as in `decode_kernels.decode`.
    missed = 0
    for a in range(0, len(fiblets), BATCH):
        some = fiblets[a : a + BATCH], destination[a : a + BATCH]
        missed += _decode_batch(*some, arrays, low if fine else None, origin, scale, steps, tables, out)
    return missed


def _decode_batch(
    which: Ints,
    to: Ints,
    arrays: tuple[Any, ...],
    low: npt.NDArray[np.uint16] | None,
    origin: Array,
    scale: Array,
    steps: tuple[float, float, float],
    tables: Array,
    out: npt.NDArray[np.floating],
) -> int:
    anchors, decoding, codes, code_base = arrays
    words, records = anchors[which], decoding[which]
    grid = np.stack([unpack(f"anchor_{axis}", words) for axis in "xyz"]).astype(np.float64)
    if low is not None:
        grid = grid * 65536.0 + low[which].T
    anchor = scale[:, None] * grid
    n, step, cap, kind, shape = (
        unpack(name, records).astype(np.int64) + more
        for name, more in (("last", 1), ("step", 0), ("cap", 0), ("kind", 0), ("shape", 0))
    )
    at = code_base[which >> PAGE_BITS] + unpack("code", records).astype(np.int64)
    plain, spline = ((kind == WIDE) & (step & 7 == width) for width in (0, SPLINE))
    size = code_bytes(records)
    # A record read from a damaged file must not reach beyond the arrays.
    bad = (at < 0) | (at + size > len(codes)) | (to < 0) | (to + n > len(out))
    first = np.flatnonzero(~bad)
    out[to[first]] = anchor[:, first].T + origin
    directed = np.flatnonzero(~bad & (kind == DIRECTION) & (n > 1))
    if directed.size:
        lo, hi, _ = steps
        d = directed[np.argsort(-n[directed], kind="stable")]
        length = lo + step[d] * (hi - lo) / STEP_LEVELS if hi > lo else np.full(len(d), lo)
        _decode_directions(anchor[:, d], shape[d], length, cap[d], tables, codes, at[d], n[d], origin, to[d], out)
    whole = np.flatnonzero(~bad & plain & (n > 1))
    if whole.size:
        edges = steps[2] * np.ldexp(1.0, -cap[whole])
        _decode_plain(anchor[:, whole], edges, codes, at[whole], n[whole], origin, to[whole], out)
    curved = np.flatnonzero(~bad & spline & (n > 1))
    if curved.size:
        c = curved
        edges = steps[2] * np.ldexp(1.0, -cap[c])
        _decode_splines(anchor[:, c], shape[c], edges, codes, at[c], step[c] >> 3, n[c], origin, to[c], out)
    others = np.flatnonzero(~bad & ~plain & ~spline & (kind != DIRECTION) & (n > 1))
    if others.size:
        o = others
        edges = steps[2] * np.ldexp(1.0, -cap[o])
        _decode_lattices(anchor[:, o], kind[o], shape[o], step[o], edges, codes, at[o], n[o], origin, to[o], out)
    return int(bad.sum())


def _decode_directions(
    p: Array, shape: Ints, step: Array, cap: Ints, tables: Array, codes: Any, at: Ints, n: Ints, origin: Array,
    to: Ints, out: Any,
) -> None:  # fmt: skip
    """Fiblets of direction codes, in order of falling numbers of points."""
    d, q = first_frames(shape)
    p = p + step * d
    out[to + 1] = p.T + origin
    turns = np.moveaxis(tables, 2, 0)
    for i in range(2, int(n[0])):
        m = int(np.searchsorted(-n, -i, side="left"))  # so many have an i-th point
        p, q = p[:, :m], q[:, :m]
        q = turn(q, turns[:, cap[:m], codes[at[:m] + i - 2]])
        p = p + step[:m] * turned_x(q)
        out[to[:m] + i] = p.T + origin


def _decode_plain(
    anchor: Array, edge: Array, codes: Any, at: Ints, n: Ints, origin: Array, to: Ints, out: Any
) -> None:
    """Fiblets of three whole numbers a point, of sets whose points are kept exactly."""
    owner, begin, place = _runs(n - 1)
    start = at[owner] + PLAIN_BYTES * place
    four = np.full(len(owner), 4)
    moves = np.stack([_signed(_take(codes, start + 4 * axis, four), 32) for axis in range(3)])
    out[to[owner] + 1 + place] = (anchor[:, owner] + edge[owner] * _summed(moves, owner, begin)).T + origin


def _decode_splines(
    anchor: Array, shape: Ints, edge: Array, codes: Any, at: Ints, nodes: Ints, n: Ints, origin: Array, to: Ints,
    out: Any,
) -> None:  # fmt: skip
    """Fiblets of cubic splines, in the symbols of `spline_kernels`."""
    place = np.zeros_like(anchor)
    slope = np.stack([_signed(shape >> SLOPE_BITS * axis & (1 << SLOPE_BITS) - 1, SLOPE_BITS) for axis in range(3)])
    slope = slope * (4.0 ** (shape >> 3 * SLOPE_BITS) * 0.5**SLOPE_SHIFT)
    done = np.ones(len(n), np.int64)
    for k in range(int(nodes.max())):
        some = np.flatnonzero(k < nodes)
        word = _take(codes, at[some] + k * NODE_BYTES, np.full(len(some), NODE_BYTES))
        node = [_signed(word >> 6 + NODE_BITS * j & (1 << NODE_BITS) - 1, NODE_BITS) for j in range(6)]
        d, e, span = np.array(node[:3], float), np.array(node[3:], float), word & 63
        owner, _, m = _runs(np.minimum(span, n[some] - done[some]))
        own, m = some[owner], m + 1
        x = m / span[owner]
        local = place[:, own] + m * slope[:, own] + x * x * ((d - 2.0 * e)[:, owner] + (2.0 * e)[:, owner] * x)
        out[to[own] + done[own] + m - 1] = (anchor[:, own] + edge[own] * local).T + origin
        done[some] += np.minimum(span, n[some] - done[some])
        span = np.maximum(span, 1)
        place[:, some] += span * slope[:, some] + d
        slope[:, some] += 2.0 * (d + e) / span
    owner, _, m = _runs(n - done)  # of damaged files
    out[to[owner] + done[owner] + m] = out[to[owner] + done[owner] - 1]


def _runs(sizes: Ints) -> tuple[Ints, Ints, Ints]:
    """Return for each item of runs laid end to end: its run, the start of each run, and its place in it."""
    owner = np.repeat(np.arange(len(sizes)), sizes)
    begin = np.cumsum(sizes) - sizes
    return owner, begin, np.arange(len(owner)) - begin[owner]


def _summed(moves: Ints, owner: Ints, begin: Ints) -> Ints:
    """Running sums ``(3, m)`` within runs."""
    sums = np.concatenate([np.zeros((3, 1), np.int64), np.cumsum(moves, axis=1)], axis=1)
    summed: Ints = sums[:, 1:] - sums[:, begin][:, owner]
    return summed


def _decode_lattices(
    anchor: Array, kind: Ints, shape: Ints, step: Ints, edge: Array, codes: Any, at: Ints, n: Ints, origin: Array,
    to: Ints, out: Any,
) -> None:  # fmt: skip
    """Fiblets of lattice codes."""
    wide = np.flatnonzero(kind == WIDE)
    lo = np.stack([_signed(shape >> shift & 0xFF, 8) for shift in (0, 8, 16)])
    nx, ny = (shape >> 24 & 0xFF) + 1, (step & 0xFF) + 1
    width = np.where(kind == WIDE, step & 7, kind)
    heads = [_take(codes, at[wide] + 4 * place, np.full(len(wide), 4)) for place in range(5)]
    lo[:, wide] = [_signed(head, 32) for head in heads[:3]]
    nx[wide], ny[wide] = np.maximum(heads[3], 1), np.maximum(heads[4], 1)
    start = at + np.where(kind == WIDE, WIDE_HEADER, 0)

    owner, begin, place = _runs(n - 1)
    value = _take(codes, start[owner] + place * width[owner], width[owner])
    rows = value // nx[owner]
    moves = np.stack([value - rows * nx[owner], rows % ny[owner], rows // ny[owner]]) + lo[:, owner]
    out[to[owner] + 1 + place] = ((anchor[:, owner] + edge[owner] * _summed(moves, owner, begin)).T) + origin


def _take(codes: Any, at: Ints, width: Ints) -> Ints:
    value = np.zeros(len(at), np.int64)
    for byte in range(min(LARGEST_WIDTH, int(width.max(initial=0)))):
        some = np.flatnonzero(byte < width)
        value[some] |= codes[at[some] + byte].astype(np.int64) << (8 * byte)
    return value


def _signed(value: Ints, bits: int) -> Ints:
    return np.where(value >> (bits - 1) != 0, value - (1 << bits), value)
