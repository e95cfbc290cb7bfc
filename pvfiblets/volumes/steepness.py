"""Whether a transfer function is so steep, or so dense, that one look-up for each step of a ray is not enough.

A pre-integrated table is exact where the value is linear over a step and both its ends are entries of the table.
Between entries a texture interpolates, and what it is off by is told by how the table bends. Light of steps is put
together along the ray: a value that hardly changes meets the same error at every step, so that of m steps
``exp(-m tau)`` is off by ``|exp(-m tau) - exp(-m tau')|``, whichever m is worst. And a table tells nothing of parts of
a step that are so dense that its opacity is 1 but for rounding.

Values are not linear over a step that crosses from one cell to another: from the chord they are up to a quarter of the
step times the change of their slope away. Of what is smooth that is hardly anything. Of edges it is much, and a step is
taken in `PARTS` where its values bend (``shaders/volumes/preintegrated.glsl``). Of noise as thick as fog it is too much
everywhere.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from .transfer import Transfer
from .volume import RaycastVolume

__all__ = ["DENSE", "OFF", "PARTS", "allowed_bend", "is_steep", "largest_bend", "typical_bend"]

OFF = 1e-2
"""What colours and opacities may be off by."""

DENSE = 9.0
"""Optical depth of a step beyond which its parts are not told from its opacity. The denser, the more a bend of the
values within a step counts, such as where a field begins: at 10, light of a ball is off by 0.012. Steps of half a voxel
through a table that ends in opacity 1, as most do, have 8.3, and one look-up is enough for them."""

THICK = 2.0
"""Optical depth of a step up to which the parts of steps are enough for what bends everywhere, such as noise. Beyond, a
corner that a ray passes within one step, unseen, counts for too much."""

PARTS = 4
"""Parts of a step over which values bend: a power of two, so that they add up to it exactly."""

KINKS = 5.0
"""Bends up to so many times what is allowed need no parts: at the worst, a twelfth of them is left as an error, of
either sign."""

FINE = 64
"""Part of the colours, one by this, over which it is looked at how fast light changes with the value."""

STEPS = 3.0
"""What errors of steps add up to, as they have either sign, in errors of one."""

TAKEN = 20_000
"""Voxels that the typical bend is found from."""


def typical_bend(volume: RaycastVolume) -> float:
    """Return by how much the slope of values changes at a voxel, per voxel: the median over some voxels and axes."""
    values, rng = volume.values, np.random.default_rng(0)
    bends = [np.zeros(1)]
    for axis in range(3):
        if volume.shape[axis] < 3:
            continue
        at = [rng.integers(1 if k == axis else 0, n - (k == axis), TAKEN) for k, n in enumerate(volume.shape)]
        before, after = list(at), list(at)
        before[axis], after[axis] = at[axis] - 1, at[axis] + 1
        near = (values[tuple(before)].astype(np.float64), values[tuple(after)].astype(np.float64))
        bends.append(np.abs(near[0] + near[1] - 2.0 * values[tuple(at)].astype(np.float64)))
    return float(np.median(np.concatenate(bends[1:] or bends)))


def largest_bend(volume: RaycastVolume) -> float:
    """Return by how much the slope of values changes at a voxel, per voxel, at the most: of all voxels and axes."""
    # Slices across the axis along which neighbours lie farthest apart in memory are read as they lie.
    slices = np.moveaxis(volume.values, int(np.argmax(np.abs(volume.values.strides))), 0)
    largest, last, change = 0.0, slices[0].astype(np.float32), None
    for k in range(len(slices)):
        this = slices[k].astype(np.float32)
        found = [np.diff(this, 2, axis=axis) for axis in (0, 1)]
        if k > 0:
            before, change = change, this - last
            found += [] if before is None else [change - before]
        largest = max([largest, *(float(np.abs(bend).max()) for bend in found if bend.size)])
        last = this
    return largest


@lru_cache(maxsize=8)
def allowed_bend(transfer: Transfer, step: float) -> float:
    """Return by how much a value's change may differ from that in the step before, for `OFF` of a step's light at most.

    Parameters
    ----------
    transfer : Transfer
    step : float
        mm.
    """
    table = transfer.preintegrated(step)
    apart = max(1, len(table) // FINE)
    level = table[np.arange(len(table)), np.arange(len(table))].astype(np.float64)
    rise = float(np.abs(level[apart:] - level[:-apart]).max()) / apart * (len(table) - 1)
    return OFF * (transfer.clim[1] - transfer.clim[0]) / max(rise, OFF)  # never more than all


@lru_cache(maxsize=8)
def is_steep(transfer: Transfer, step: float, low: float = -np.inf, high: float = np.inf, chord: float = 0.0) -> bool:
    """Say whether light of steps in which the value is linear would be off by more than `OFF` with one look-up a step.

    Parameters
    ----------
    transfer : Transfer
    step : float
        mm.
    low, high : float
        Values that are there; opacity jumps where others begin.
    chord : float
        How far values within a step typically are from its chord; it counts where a step is `THICK`.
    """
    cuts = np.array([value for value in (low, high) if np.isfinite(value)])
    if (-np.expm1(-step * transfer.extinction(cuts)) > OFF).any():
        return True
    table = transfer.preintegrated(step)
    fine = transfer.extinction(np.linspace(*transfer.clim, 2 * len(table) - 1)) * step
    if fine.max() > DENSE:
        return True
    # Between two entries linear interpolation is off by a quarter of what the table bends by, if it bends at once.
    bend = max(float(np.abs(np.diff(table, 2, axis=axis)).max()) for axis in (0, 1)) / 4.0
    off = round(min(chord / (transfer.clim[1] - transfer.clim[0]), 1.0) * (len(table) - 1))
    if off > 0 and fine.max() > THICK:
        level = table[np.arange(len(table)), np.arange(len(table))]
        if STEPS * float(np.abs(level[off:] - level[:-off]).max()) > OFF:
            return True
    return max(bend, _of_level_values(table[..., 3].astype(np.float64), fine[1::2])) > OFF


def _of_level_values(opacity: np.ndarray, depth: np.ndarray) -> float:
    """Largest error of any number of steps in which the value stays half way between two entries."""
    n = np.arange(len(depth))
    between = (opacity[n, n] + opacity[n + 1, n + 1] + opacity[n, n + 1] + opacity[n + 1, n]) / 4.0
    found = -np.log1p(-np.minimum(between, 1.0 - 1e-12))
    there = np.flatnonzero(np.abs(depth - found) > 1e-12)
    tau, off = np.maximum(depth[there], 1e-300), np.maximum(found[there], 1e-300)
    steps = np.maximum(np.log(tau / off) / (tau - off), 1.0)  # at which the difference is largest
    return float(np.abs(np.exp(-steps * tau) - np.exp(-steps * off)).max(initial=0.0))
