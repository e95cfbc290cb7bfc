"""Compiled pre-integration of transfer functions: see :meth:`pvfiblets.raycast.transfer.Transfer.preintegrated`."""

from __future__ import annotations

import math
from typing import Any

import numba
import numpy as np
import numpy.typing as npt

from pvfiblets.codec.jit import kernel, parallel_kernel

__all__ = ["preintegrate"]

LARGEST_DEPTH = 24.0 * np.log(2.0)  # as of transfer.py, which loads this module only when it is needed
SPENT = 40.0  # optical depth behind which nothing is seen: exp(-40) is 4e-18
THICK = 0.5  # optical depth of a piece beyond which exp(-tau) falls too fast for one panel of the quadrature
GRADES = 14  # panels of a thick piece shrink to 2^-14 of it towards both ends

Array = npt.NDArray[np.float64]


def preintegrate(rgba: Array, units: float) -> npt.NDArray[np.float32]:
    """Colour and opacity of a step between all pairs of entries.

    Parameters
    ----------
    rgba : ndarray
        ``(n, 4)`` float64, linear between entries.
    units : float
        Length of the step in units of opacity.

    Returns
    -------
    ndarray
        ``(n, n, 4)`` float32: front, back; RGB multiplied by opacity, opacity.
    """
    rgba = np.ascontiguousarray(rgba, np.float64)
    thin = np.polynomial.legendre.leggauss(8)
    x, weights = (thin[0] + 1.0) / 2.0, thin[1] / 2.0
    ends = 0.5 ** np.arange(GRADES, 0, -1)
    breaks = np.concatenate([[0.0], ends, 1.0 - ends[-2::-1], [1.0]])
    widths = np.diff(breaks)
    graded = (breaks[:-1, None] + widths[:, None] * x).ravel()
    shares = (widths[:, None] * weights).ravel()
    alpha = rgba[:, 3]
    out = np.empty((len(rgba), len(rgba), 4), np.float32)
    _pairs(
        rgba, units, _depths(alpha, x), weights, _depths(alpha, graded), shares, _depths(alpha, np.ones(1))[:, 0], out
    )
    return out


@kernel
def _unit_depth(alpha: float) -> float:
    """Optical depth of one unit of an opacity."""
    return min(-math.log1p(-alpha), LARGEST_DEPTH) if alpha < 1.0 else LARGEST_DEPTH


@kernel
def _primitive(alpha: float) -> float:
    """Of -ln(1 - alpha)."""
    return (1.0 - alpha) * math.log1p(-alpha) + alpha if alpha < 1.0 else 1.0


@kernel
def _depths(alpha: Array, places: Array) -> Array:
    """Optical depth from each piece's beginning to places in it, 0 to 1, were the piece one unit long."""
    out = np.empty((len(alpha) - 1, len(places)))
    for piece in range(len(alpha) - 1):
        first, last = alpha[piece], alpha[piece + 1]
        change = last - first
        for q in range(len(places)):
            x = places[q]
            at = first + x * change
            if abs(change) < 1e-3 * (1.0 - max(first, last)) or change == 0.0:
                # The difference of primitives would lose its digits; Simpson's rule is exact to 1e-13 here.
                middle = _unit_depth(first + 0.5 * x * change)
                out[piece, q] = x * (_unit_depth(first) + 4.0 * middle + _unit_depth(at)) / 6.0
            else:
                out[piece, q] = (_primitive(at) - _primitive(first)) / change
    return out


@parallel_kernel
def _pairs(
    rgba: Array,
    units: float,
    thin: Array,
    thin_weights: Array,
    graded: Array,
    graded_weights: Array,
    whole: Array,
    out: Any,
) -> None:
    n = len(rgba)
    for front in numba.prange(n):
        for back in range(n):
            if front == back:
                opacity = -math.expm1(-units * _unit_depth(rgba[front, 3]))
                for c in range(3):
                    out[front, back, c] = rgba[front, c] * opacity
                out[front, back, 3] = opacity
                continue
            way = 1 if back > front else -1
            length = units / abs(back - front)
            passed = 0.0
            red = green = blue = 0.0
            for begin in range(front, back, way):
                end = begin + way
                piece = min(begin, end)
                depth = length * whole[piece]
                if depth > 0.0 and passed < SPENT:
                    # 1 - exp(-tau) from the piece's beginning: its mean over the piece. Against the pieces' direction
                    # depths count from the other end; the quadrature's places are symmetric.
                    lost = 0.0
                    if depth < THICK:
                        for q in range(len(thin_weights)):
                            t = thin[piece, q] if way > 0 else whole[piece] - thin[piece, q]
                            lost -= thin_weights[q] * math.expm1(-length * t)
                    else:
                        for q in range(len(graded_weights)):
                            t = graded[piece, q] if way > 0 else whole[piece] - graded[piece, q]
                            lost -= graded_weights[q] * math.expm1(-length * t)
                    left = math.exp(-passed)
                    taken = -math.expm1(-depth)
                    red += left * (rgba[end, 0] * taken - (rgba[end, 0] - rgba[begin, 0]) * lost)
                    green += left * (rgba[end, 1] * taken - (rgba[end, 1] - rgba[begin, 1]) * lost)
                    blue += left * (rgba[end, 2] * taken - (rgba[end, 2] - rgba[begin, 2]) * lost)
                passed += depth
            opacity = -math.expm1(-passed)
            out[front, back, 0] = min(max(red, 0.0), opacity)
            out[front, back, 1] = min(max(green, 0.0), opacity)
            out[front, back, 2] = min(max(blue, 0.0), opacity)
            out[front, back, 3] = opacity
