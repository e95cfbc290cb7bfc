"""Compiled kernels that draw made-up vessels and heads, some slices at a time."""

from __future__ import annotations

import math

import numba
import numpy as np

from pvfiblets.codec.jit import kernel, parallel_kernel
from pvfiblets.support.array_types import Float32s, Float64s, Int64s


@kernel
def _uniform(seed: int, index: int) -> float:
    """A number in [0, 1) that depends on these two only (SplitMix64)."""
    x = np.uint64(seed) * np.uint64(0xD1342543DE82EF95) + np.uint64(index) * np.uint64(0x9E3779B97F4A7C15)
    x = (x ^ (x >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    x = (x ^ (x >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    x ^= x >> np.uint64(31)
    return float(x >> np.uint64(11)) * 2.0**-53


@kernel
def _cover(depth: float, edge: float) -> float:
    """Return the share of a voxel that lies inside, smoothly, by its depth behind a surface."""
    share = min(max(0.5 + depth / edge, 0.0), 1.0)
    return share * share * (3.0 - 2.0 * share)


@kernel
def _mix(value: float, other: float, share: float) -> float:
    return value + (other - value) * share


@kernel
def _add_noise(bright: Float32s, noise: float, seed: int, k: int) -> None:
    """Add noise to slice k."""
    n = len(bright)
    for j in range(n):
        for i in range(n):
            at = 2 * ((k * n + j) * n + i)
            value = bright[j, i] + noise * 0.5 * (_uniform(seed, at) + _uniform(seed, at + 1))
            bright[j, i] = min(value, 1.0)


@parallel_kernel
def draw_vessels(segments: Float64s, which: Int64s, offsets: Int64s, half: float, spacing: float, edge: float,
                 noise: float, seed: int, begin: int, out: Float32s) -> None:  # fmt: skip
    """Draw cones with round ends; where several overlap, the brightest shows."""
    n = out.shape[1]
    for each in numba.prange(len(out)):
        k = begin + each
        bright = out[each]
        bright[:] = 0.0
        z = k * spacing - half
        for place in range(offsets[k], offsets[k + 1]):
            ax, ay, az, ar, bx, by, bz, br = segments[which[place]]
            dx, dy, dz = bx - ax, by - ay, bz - az
            square = dx * dx + dy * dy + dz * dz
            reach = max(ar, br) + 0.5 * edge
            first_i = max(math.ceil((min(ax, bx) - reach + half) / spacing), 0)
            last_i = min(math.floor((max(ax, bx) + reach + half) / spacing), n - 1)
            first_j = max(math.ceil((min(ay, by) - reach + half) / spacing), 0)
            last_j = min(math.floor((max(ay, by) + reach + half) / spacing), n - 1)
            for j in range(first_j, last_j + 1):
                y = j * spacing - half
                for i in range(first_i, last_i + 1):
                    x = i * spacing - half
                    t = ((x - ax) * dx + (y - ay) * dy + (z - az) * dz) / square
                    t = min(max(t, 0.0), 1.0)
                    radius = ar + t * (br - ar)
                    away = math.sqrt((x - ax - t * dx) ** 2 + (y - ay - t * dy) ** 2 + (z - az - t * dz) ** 2)
                    # Contrast agent fills wide vessels more evenly.
                    value = (0.6 + 0.4 * min(radius / 2.0, 1.0)) * _cover(radius - away, edge)
                    if value > bright[j, i]:
                        bright[j, i] = value
        if noise > 0.0:
            _add_noise(bright, noise, seed, k)


@parallel_kernel
def draw_head(
    waves: Float64s, half: float, spacing: float, edge: float, noise: float, seed: int, begin: int, out: Float32s
) -> None:
    """Draw shells around the middle, the outer ones first."""
    n = out.shape[1]
    rx, ry, rz = 74.0, 92.0, 72.0  # mm, of the scalp
    scale = math.sqrt(2.0 / len(waves))
    for each in numba.prange(len(out)):
        k = begin + each
        bright = out[each]
        bright[:] = 0.0
        z = k * spacing - half
        for j in range(n):
            y = j * spacing - half
            for i in range(n):
                x = i * spacing - half
                size = math.sqrt(x * x + y * y + z * z)
                rho = math.sqrt((x / rx) ** 2 + (y / ry) ** 2 + (z / rz) ** 2)
                if rho > 1.1:
                    continue
                radius = size / rho if rho > 0.0 else rz  # mm from the middle to the scalp, this way
                value = 0.9 * _cover((1.0 - rho) * radius, edge)
                value = _mix(value, 0.1, _cover((0.94 - rho) * radius, edge))
                value = _mix(value, 0.2, _cover((0.88 - rho) * radius, edge))
                if rho < 0.92:
                    fold = 0.0
                    if rho > (0.35 if abs(x) < 15.0 else 0.62):  # deeper no fold reaches
                        for w in range(len(waves)):
                            angle = (waves[w, 0] * x + waves[w, 1] * y + waves[w, 2] * z) / size + waves[w, 3]
                            fold += scale * math.cos(angle)
                    # Narrow sulci in the cortex' surface, wider ones in the white matter's: the ribbon between them is
                    # some millimetres thick. The fissure parts the halves, but not below.
                    parted = 0.3 * _cover(z + 5.0, 40.0)
                    fissure = parted * math.exp(-((x / 1.5) ** 2))
                    cortex = 0.86 - 0.14 * math.exp(-((fold / 0.22) ** 2)) - fissure
                    ribbon = parted * math.exp(-((x / 4.5) ** 2))
                    white = 0.815 - 0.14 * math.exp(-((fold / 0.55) ** 2)) - ribbon
                    value = _mix(value, 0.45, _cover((cortex - rho) * radius, edge))
                    value = _mix(value, 0.7, _cover((white - rho) * radius, edge))
                    # Ventricles: a bent ellipsoid in each half.
                    side = (abs(x) - 9.0 - 0.004 * y * y) / 5.0
                    inside = math.sqrt(side * side + (y / 30.0) ** 2 + ((z - 8.0) / 9.0) ** 2)
                    value = _mix(value, 0.2, _cover((1.0 - inside) * 5.0, edge))
                bright[j, i] = value
        if noise > 0.0:
            _add_noise(bright, noise, seed, k)
