"""Compiled pre-integration of transfer functions: see :meth:`pvfiblets.volumes.transfer.Transfer.preintegrated`."""

from __future__ import annotations

import math

import numba
import numpy as np
import numpy.typing as npt

from pvfiblets.codec.jit import kernel, parallel_kernel
from pvfiblets.support.array_types import Float32s

LARGEST_DEPTH = 24.0 * np.log(2.0)  # as of transfer.py, which loads this module only when it is needed
SPENT = 40.0  # optical depth that no visible light passes: exp(-40) is 4e-18
THICK = 0.5  # optical depth of a piece beyond which exp(-tau) falls too fast for one panel of the quadrature
GRADES = 14  # panels of a thick piece shrink to 2^-14 of it towards both ends

Array = npt.NDArray[np.float64]


def preintegrate(rgba: Array, units: float) -> npt.NDArray[np.float32]:
    """Colour and opacity of a step between all pairs of entries."""
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


def unit_depths(alpha: Array) -> Array:
    """Optical depth of each piece between two opacities, which is linear there, were the piece one unit long."""
    depths: Array = _depths(np.ascontiguousarray(alpha, np.float64), np.ones(1))[:, 0]
    return depths


@kernel
def _unit_depth(alpha: float) -> float:
    """Optical depth of one unit of an opacity."""
    return min(-math.log1p(-alpha), LARGEST_DEPTH) if alpha < 1.0 else LARGEST_DEPTH


@kernel
def _primitive(alpha: float) -> float:
    """Return the integral of -ln(1 - alpha)."""
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
def _pairs(rgba: Array, units: float, thin: Array, thin_weights: Array, graded: Array, graded_weights: Array,
           whole: Array, out: Float32s) -> None:  # fmt: skip
    """Fill the table by how many pieces lie between front and back: how long each then is does not depend on where."""
    n = len(rgba)
    for apart in numba.prange(n):
        if apart == 0:
            for entry in range(n):
                opacity = -math.expm1(-units * _unit_depth(rgba[entry, 3]))
                for c in range(3):
                    out[entry, entry, c] = rgba[entry, c] * opacity
                out[entry, entry, 3] = opacity
            continue
        length = units / apart
        taken = np.empty(n - 1)
        lost = np.empty((2, n - 1))  # 1 - exp(-tau) from the piece's beginning, its mean over the piece: up, down
        for piece in range(n - 1):
            depth = length * whole[piece]
            taken[piece] = -math.expm1(-depth)
            lost[0, piece] = lost[1, piece] = 0.0
            if depth <= 0.0:
                continue
            # Against the pieces' direction depths count from the other end; the quadrature's places are symmetric.
            if depth < THICK:
                for q in range(len(thin_weights)):
                    t = thin[piece, q]
                    lost[0, piece] -= thin_weights[q] * math.expm1(-length * t)
                    lost[1, piece] -= thin_weights[q] * math.expm1(-length * (whole[piece] - t))
            else:
                for q in range(len(graded_weights)):
                    t = graded[piece, q]
                    lost[0, piece] -= graded_weights[q] * math.expm1(-length * t)
                    lost[1, piece] -= graded_weights[q] * math.expm1(-length * (whole[piece] - t))
        for front in range(n):
            for down in range(2):
                way = -1 if down else 1
                back = front + way * apart
                if back < 0 or back >= n:
                    continue
                passed = 0.0
                red = green = blue = 0.0
                for begin in range(front, back, way):
                    end = begin + way
                    piece = min(begin, end)
                    if whole[piece] > 0.0 and passed < SPENT:
                        left = math.exp(-passed)
                        much, less = taken[piece], lost[down, piece]
                        red += left * (rgba[end, 0] * much - (rgba[end, 0] - rgba[begin, 0]) * less)
                        green += left * (rgba[end, 1] * much - (rgba[end, 1] - rgba[begin, 1]) * less)
                        blue += left * (rgba[end, 2] * much - (rgba[end, 2] - rgba[begin, 2]) * less)
                    passed += length * whole[piece]
                opacity = -math.expm1(-passed)
                out[front, back, 0] = min(max(red, 0.0), opacity)
                out[front, back, 1] = min(max(green, 0.0), opacity)
                out[front, back, 2] = min(max(blue, 0.0), opacity)
                out[front, back, 3] = opacity
