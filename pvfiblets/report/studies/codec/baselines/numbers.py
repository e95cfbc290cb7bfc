"""Coordinates as shorter numbers, and raw coordinates squeezed by a general compressor."""

from __future__ import annotations

import zlib
from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np
import numpy.typing as npt

from . import COUNT_BYTES

TOP = 65535.0


@dataclass
class NumbersPacked:
    """Coordinates in ``content``; ``unpack`` returns the points."""

    content: Any
    unpack: Callable[[Any], npt.NDArray[np.floating]]
    nbytes: int

    def points(self) -> npt.NDArray[np.floating]:
        """Decode all points, ``(n, 3)``."""
        return self.unpack(self.content)


def float16(points: npt.NDArray[np.floating], offsets: npt.NDArray[np.int64]) -> NumbersPacked:
    """Half-precision coordinates, as TRX files may hold."""
    with np.errstate(over="ignore"):
        halves = points.astype(np.float16)
    if not np.isfinite(halves).all():
        raise ValueError(f"coordinates of {np.abs(points).max():g} mm are beyond float16, which ends at 65504")
    return NumbersPacked(halves, lambda h: h.astype(np.float32), _size(halves.nbytes, offsets))


def int16(points: npt.NDArray[np.floating], offsets: npt.NDArray[np.int64]) -> NumbersPacked:
    """Whole numbers of 16 bits over the bounds, by axis: off by no more than half an extent's 65535th."""
    lower = points.min(0).astype(np.float64)
    unit = (points.max(0).astype(np.float64) - lower) / TOP
    scaled = (points - lower) / np.where(unit > 0.0, unit, 1.0)
    levels = np.rint(scaled).astype(np.uint16)
    return NumbersPacked(levels, lambda n: n * unit + lower, _size(levels.nbytes + 48, offsets))


def squeezed_by_zlib(level: int) -> Callable[[npt.NDArray[np.floating], npt.NDArray[np.int64]], NumbersPacked]:
    """Deflated float32 coordinates."""
    return _squeezed(lambda raw: zlib.compress(raw, level), zlib.decompress)


def squeezed_by_zstd(level: int) -> Callable[[npt.NDArray[np.floating], npt.NDArray[np.int64]], NumbersPacked]:
    """Float32 coordinates squeezed by Zstandard."""
    zstandard = import_module("zstandard")
    compress, decompress = zstandard.ZstdCompressor(level=level), zstandard.ZstdDecompressor()
    return _squeezed(compress.compress, decompress.decompress)


def _squeezed(
    compress: Callable[[bytes], bytes], decompress: Callable[[bytes], bytes]
) -> Callable[[npt.NDArray[np.floating], npt.NDArray[np.int64]], NumbersPacked]:
    def pack(points: npt.NDArray[np.floating], offsets: npt.NDArray[np.int64]) -> NumbersPacked:
        content = compress(np.ascontiguousarray(points, np.float32).tobytes())
        return NumbersPacked(
            content,
            lambda squeezed: np.frombuffer(decompress(squeezed), np.float32).reshape(-1, 3),
            _size(len(content), offsets),
        )

    return pack


def _size(content: int, offsets: npt.NDArray[np.int64]) -> int:
    return int(content) + COUNT_BYTES * (len(offsets) - 1)
