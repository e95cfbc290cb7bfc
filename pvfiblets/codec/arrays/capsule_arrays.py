"""The capsules of many fiblets at once, in NumPy and in the arithmetic of `capsule_kernels`."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ..capsules import MARGIN, SMALLEST
from ..layout import END_LEVELS, pack_ends

Array = npt.NDArray[np.float64]


def capsules(
    decoded: Array,
    counts: npt.NDArray[np.int64],
    leads: npt.NDArray[np.bool_],
    following: Array,
    end_scale: float,
) -> tuple[Array, npt.NDArray[np.uint32]]:
    """Radii (mm) and words of ``ends`` of fiblets."""
    most, _, k = decoded.shape
    first, last = decoded[0], decoded[counts - 1, :, np.arange(k)].T
    levels = np.clip(np.rint((last - first) / end_scale), -float(END_LEVELS), float(END_LEVELS)).astype(np.int64)
    words = np.where(leads, 0, pack_ends(levels.T)).astype(np.uint32)
    to = np.where(leads, following, first + end_scale * levels)

    arc = _size(last - to)
    chord = to - first
    squares = chord[0] * chord[0] + chord[1] * chord[1] + chord[2] * chord[2]
    inverse = np.divide(1.0, squares, out=np.zeros(k), where=squares >= SMALLEST)
    widest = np.zeros(k)
    for i in range(1, most):
        inside = i < counts
        arc += np.where(inside, _size(decoded[i] - decoded[i - 1]), 0.0)
        away = decoded[i] - first
        along = (away[0] * chord[0] + away[1] * chord[1] + away[2] * chord[2]) * inverse
        beside = away - np.minimum(np.maximum(along, 0.0), 1.0) * chord
        apart = beside[0] * beside[0] + beside[1] * beside[1] + beside[2] * beside[2]
        np.maximum(widest, apart, out=widest, where=inside)
    return np.sqrt(widest) + MARGIN * arc, words


def _size(v: Array) -> Array:
    size: Array = np.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
    return size
