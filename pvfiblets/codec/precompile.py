"""Calls that compile the kernels that code and decode streamlines; see `pvfiblets.precompile`."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..streamlines import Streamlines


def _lines() -> Streamlines:
    """A line of even steps, and one of uneven ones."""
    i = np.arange(130.0)
    even = np.stack([20.0 * np.cos(0.02 * i), 20.0 * np.sin(0.02 * i), 0.3 * i], axis=1)
    return Streamlines.from_list([even, np.stack([0.001 * i**2, np.sin(i), 0.1 * i], axis=1)])


def _coders() -> tuple[Any, Any, Any]:
    """A coder of either kind for the same lines, and the chunk's encoder."""
    from .arrays.array_coder import ArrayCoder
    from .encoding.compiled_coder import CompiledCoder
    from .parameters import Parameters, survey

    lines = _lines()
    parameters = Parameters.choose(survey([lines]))
    arguments = np.asarray(lines.points, np.float64), np.asarray(lines.offsets), parameters, (0.01, 0.17, 0.17)
    return ArrayCoder(*arguments), CompiledCoder(*arguments, "small"), lines


def _directions() -> None:
    from .kernels.direction_kernels import scan

    _, coder, lines = _coders()
    scan(np.asarray(lines.points, np.float64), np.asarray(lines.offsets), np.empty((1, 8)))
    slots, _ = coder.cut()
    m = len(slots)
    codes, end = np.zeros(lines.n_points, np.uint8), np.ones(m, np.uint8)
    ok, kind, cap = np.zeros(m, np.uint8), np.zeros(m, np.uint8), np.zeros(m, np.uint8)
    words, shape = np.zeros(m, np.uint32), np.zeros(m, np.uint32)
    coder.code_directions(slots, end, (ok, kind, shape, np.zeros(m, np.uint16), cap, np.zeros(m), words, codes))
    first, count = slots.T.copy()
    coder.gather(codes, first, count, first, np.zeros_like(codes))


def _lattices() -> None:
    arrays, coder, _ = _coders()
    slots, _ = arrays.cut()
    end, wanted = np.ones(len(slots), np.uint8), np.arange(len(slots))
    pieces, size = coder.plan_lattices(slots, end, wanted)
    total = int(pieces.sum())
    rows = [np.zeros(total, kind) for kind in (np.uint32, np.uint16, np.uint8, np.uint8)]
    rows += [np.zeros(total, np.int64) for _ in range(3)] + [np.zeros(total), np.zeros(total, np.uint32)]
    at = np.stack([np.cumsum(pieces) - pieces, np.cumsum(size) - size], axis=1)
    coder.code_lattices(slots, end, wanted, at, (np.zeros(int(size.sum()), np.uint8), *rows))


def _decoding() -> None:
    from .encoding.compress import compress
    from .small_sets import STATES

    fiblets = compress(_lines(), exact=False)  # exact sets are not decoded
    STATES["decoding"].loaded = True
    for kind in (np.float32, np.float64):
        fiblets.decompress(dtype=kind)


def _packing() -> None:
    from .files.packed import pack, unpack

    made = pack(np.zeros(4096, np.uint8))
    assert made is not None
    unpack("", "", *made)


PARTS = {"directions": _directions, "lattices": _lattices, "decoding": _decoding, "packing": _packing}
