"""Greatest bends of values within a step of a ray, by the values at its ends, at which one look-up is enough.

A pre-integrated table is exact where the value is linear over a step and both its ends are entries of the table. Two
things take light away from it, and both are of some pairs of values, not of a transfer function as a whole:

* Between entries a texture interpolates. How far that is off is known: opacities in the middle of four entries have a
  closed form. A value that hardly changes meets the same error at every step, so that m steps ``exp(-m tau)`` are
  off by ``|exp(-m tau) - exp(-m tau')|``, for the worst m. Pairs with too large an error are `UNTRUSTED`.
* Values are not linear over a step that crosses from one cell to another. If they make a tent of some height over
  their chord, light is that of two steps half as long; the height at which it differs is the allowed bend.

A ray then goes step by step by its own values (``shaders/volumes/preintegrated.glsl``): one look-up; or `PARTS` shorter
ones where values bend by more; or the light of a stretch that is halved until its halves agree.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt

from .transfer import Transfer
from .volume import RaycastVolume

OFF = 1e-2  # largest error of colours and opacities

DEEP = 9.0
"""Optical depth of a step beyond which the rest of the light at a ray's end does not follow from its opacity. Steps of
half a voxel through a table that ends in opacity 1, as most do, have 8.3."""

PARTS = 4  # parts of a step over which values bend: a power of two, so that they add up to it exactly

KINKS = 5.0
"""Bends up to so many times the allowed one need no shorter parts than a step's: at the worst, a twelfth of them is
left as an error, of either sign."""

UNTRUSTED = -1.0  # in place of the allowed bend: a look-up is off even where values do not bend at all

MOST = 512  # pairs of values along each side of the table of bends; of a larger table, the least of neighbours counts

Array = npt.NDArray[np.float64]


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
def allowed_bends(transfer: Transfer, step: float, low: float = -np.inf, high: float = np.inf) -> npt.NDArray[Any]:
    """Return by how much a value's change may differ from that in the step before, for `OFF` of light at most."""
    from .steepness_kernels import tents

    table = transfer.preintegrated(step)
    span = transfer.clim[1] - transfer.clim[0]
    allowed = tents(table, 0.25 * OFF) * (span / (len(table) - 1))
    allowed[_off_between_entries(transfer, step, table) > 0.5 * OFF] = UNTRUSTED
    for cut in (low, high):
        if np.isfinite(cut) and -np.expm1(-step * float(transfer.extinction(cut))) > OFF:
            place = (cut - transfer.clim[0]) / span * (len(table) - 1)
            before = np.arange(len(table) - 1) <= place  # of an interval, the end before it, or the end of its bend
            after = np.arange(1, len(table)) >= place
            allowed[np.logical_and.outer(before, after) | np.logical_and.outer(after, before)] = UNTRUSTED
    together = -(-len(allowed) // MOST)
    if together > 1:
        starts = np.arange(0, len(allowed), together)
        allowed = np.minimum.reduceat(np.minimum.reduceat(allowed, starts, 0), starts, 1)
    made: npt.NDArray[Any] = np.minimum(allowed, span).astype(np.float32)
    made.flags.writeable = False
    return made


def _off_between_entries(transfer: Transfer, step: float, table: npt.NDArray[np.float32]) -> Array:
    """``(n - 1, n - 1)``: by how much linear interpolation between four entries of a table is off in their middle."""
    from .preintegration import unit_depths

    n = len(table)
    alpha = transfer.lookup(np.linspace(*transfer.clim, 2 * n - 1))[:, 3]
    within = np.append(0.0, np.cumsum(unit_depths(alpha)))  # from the first value on, over half entries
    steady = transfer.extinction(np.linspace(*transfer.clim, 2 * n - 1)) * step
    at = np.arange(2 * n - 1)
    opacity = table[..., 3].astype(np.float64)

    def off(front: npt.NDArray[Any], back: npt.NDArray[Any], found: Array) -> Array:
        apart = (at[back] - at[front][:, None]).astype(np.float64)
        depth = np.divide(within[back] - within[front][:, None], apart, out=np.zeros_like(apart), where=apart != 0.0)
        depth = np.where(apart == 0.0, steady[front][:, None], depth * (step / transfer.unit))
        error = np.abs(-np.expm1(-depth) - found) / np.sqrt(np.maximum(found, 1e-12))
        level = apart == 0.0
        error[level] = np.maximum(
            error[level], _of_many(depth[level], -np.log1p(-np.minimum(found[level], 1.0 - 1e-12)))
        )
        return error

    whole, half = np.arange(0, 2 * n - 1, 2), np.arange(1, 2 * n - 1, 2)
    by_front, by_back = (opacity[1:] + opacity[:-1]) / 2.0, (opacity[:, 1:] + opacity[:, :-1]) / 2.0
    middle = off(half, half, (by_front[:, 1:] + by_front[:, :-1]) / 2.0)
    front, back = off(half, whole, by_front), off(whole, half, by_back)
    edges = np.maximum(np.maximum(front[:, 1:], front[:, :-1]), np.maximum(back[1:], back[:-1]))
    return np.maximum(np.maximum(middle, edges), _colours_off(table))


def _of_many(depth: Array, found: Array) -> Array:
    """Largest error of any number of steps of some depth that are taken as others."""
    tau, other = np.maximum(depth, 1e-300), np.maximum(found, 1e-300)
    apart = tau - other
    same = np.abs(apart) <= 1e-12
    ratio = np.log(np.where(same, 2.0, tau) / np.where(same, 1.0, other)) / np.where(same, 1.0, apart)
    steps = np.clip(ratio, 1.0, 1e6)  # at which the difference is largest
    return np.where(same, 0.0, np.abs(np.exp(-steps * tau) - np.exp(-steps * other)))


def _colours_off(table: npt.NDArray[np.float32]) -> Array:
    """The same of mean colours, by how they bend from entry to entry: by a quarter, if they bend at once."""
    opacity = table[..., 3].astype(np.float64)
    mean = table[..., :3] / np.maximum(opacity, 1e-12)[..., None]
    off = np.zeros_like(opacity)
    for axis in (0, 1):
        inner = [slice(None)] * 2
        inner[axis] = slice(1, -1)
        least = np.minimum.reduce([np.roll(opacity, shift, axis) for shift in (-1, 0, 1)])[tuple(inner)]
        bend = np.abs(np.diff(mean, 2, axis=axis)).max(axis=-1) * np.sqrt(least) / 4.0
        off[tuple(inner)] = np.maximum(off[tuple(inner)], bend)
    return np.maximum(np.maximum(off[1:, 1:], off[1:, :-1]), np.maximum(off[:-1, 1:], off[:-1, :-1]))
