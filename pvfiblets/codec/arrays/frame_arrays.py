"""Frames of many fiblets at once, in NumPy and in the arithmetic of `direction_kernels`."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ..layout import DIRECTION_SCALE

Array = npt.NDArray[np.float64]


def first_frames(words: npt.NDArray[np.int64]) -> tuple[Array, Array]:
    """First directions ``(3, k)`` and frames ``(4, k)`` of fiblets (the paper's ``M_0``)."""
    iu, iv = words & 0xFFFF, (words >> 16) & 0xFFFF
    iu, iv = np.where(iu >= 0x8000, iu - 0x10000, iu), np.where(iv >= 0x8000, iv - 0x10000, iv)
    u, v = iu / DIRECTION_SCALE, iv / DIRECTION_SCALE
    forward = np.abs(iu) + np.abs(iv) <= int(DIRECTION_SCALE)
    x = 1.0 - np.abs(u) - np.abs(v)
    y, z = np.where(forward, u, (1.0 - np.abs(v)) * signs(u)), np.where(forward, v, (1.0 - np.abs(u)) * signs(v))
    r = 1.0 / np.sqrt(x * x + y * y + z * z)
    dx, dy, dz = x * r, y * r, z * r
    w, y, z = 1.0 + np.where(forward, dx, -dx), np.where(forward, -dz, dz), np.where(forward, dy, -dy)
    r = 1.0 / np.sqrt(w * w + y * y + z * z)
    w, y, z = w * r, y * r, z * r
    nothing = np.zeros_like(w)
    frame = np.where(forward, np.stack([w, nothing, y, z]), np.stack([-z, y, nothing, w]))
    return np.stack([dx, dy, dz]), frame


def signs(values: Array) -> Array:
    """1 for numbers from 0 on, -1 for others."""
    return np.where(values >= 0.0, 1.0, -1.0)


def turn(q: Array, t: Array) -> Array:
    """Products of frames ``(4, k)`` and codes' quaternions ``(4, k)``: the frames one step on."""
    w, x, y, z = q
    return np.stack(
        [
            w * t[0] - x * t[1] - y * t[2] - z * t[3],
            w * t[1] + x * t[0] + y * t[3] - z * t[2],
            w * t[2] - x * t[3] + y * t[0] + z * t[1],
            w * t[3] + x * t[2] - y * t[1] + z * t[0],
        ]
    )


def turned_x(q: Array) -> Array:
    """Return the X axes of frames ``(4, k)``: ``(3, k)``."""
    w, x, y, z = q
    return np.stack([1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)])
