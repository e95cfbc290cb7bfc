"""Gaussian smoothing of volumes before rays are cast (Lesar 2015, III-A): along one axis after the other.

The kernel is the Gaussian at whole voxels up to 4 sigma, its weights summing to 1; beyond the edges the last voxel is
repeated. Where voxels are missing (NaN) the others' weights are scaled up, and missing voxels stay missing.
"""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from .volume import RaycastVolume

TRUNCATE = 4.0  # standard deviations: beyond them lies 6e-5 of a Gaussian

Floats = npt.NDArray[np.float32]


def smoothed(volume: RaycastVolume, sigma: Any, unit: Literal["voxels", "mm"] = "voxels") -> RaycastVolume:
    """Return a float32 volume smoothed by a Gaussian; `sigma` is one number or one along each axis of the grid."""
    if unit not in ("voxels", "mm"):
        raise ValueError(f"the unit of sigma is {unit!r}; choose 'voxels' or 'mm'")
    deviations = _checked(sigma) / (volume.spacing if unit == "mm" else 1.0)
    if not deviations.any():
        return volume
    values = volume.values
    if volume.missing is not None:
        values = np.where(volume.missing, np.float32(np.nan), values)
    colours = volume.colours
    if colours is not None:
        channels = [np.rint(gaussian(colours[..., k], deviations)).astype(np.uint8) for k in range(3)]
        colours = np.stack(channels, axis=-1)
    field = gaussian(values, deviations)
    return RaycastVolume(field, volume.affine, name=volume.name, colours=colours, offset=volume.offset)


def gaussian(values: npt.NDArray[Any], sigma: Any) -> Floats:
    """Return an array smoothed by a Gaussian."""
    deviations = _checked(sigma)
    # Axes from the farthest to the nearest neighbours in memory, so that the kernel runs along memory.
    order = np.argsort([-abs(stride) for stride in values.strides], kind="stable")
    turned = np.ascontiguousarray(values.transpose(order), np.float32)
    missing = np.isnan(turned) if values.dtype.kind == "f" else None
    if missing is None or not missing.any():
        return _filtered(turned, deviations[order]).transpose(np.argsort(order))
    known = np.where(missing, np.float32(0), np.float32(1))
    total = _filtered(np.where(missing, np.float32(0), turned), deviations[order])
    weight = _filtered(known, deviations[order])
    with np.errstate(divide="ignore", invalid="ignore"):
        total /= weight
    total[missing] = np.nan
    return total.transpose(np.argsort(order))


def _checked(sigma: Any) -> npt.NDArray[np.float64]:
    try:
        deviations = np.asarray(sigma, np.float64)
    except (TypeError, ValueError):
        deviations = np.array(np.nan)
    if deviations.shape not in ((), (3,)) or not np.isfinite(deviations).all() or (deviations < 0.0).any():
        raise ValueError(f"sigma={sigma!r}; expected one or three finite numbers, 0 or above")
    return np.broadcast_to(deviations, (3,))


def _filtered(values: Floats, sigma: npt.NDArray[np.float64]) -> Floats:
    """Smooth a contiguous array along its axes."""
    from .smoothing_kernels import along

    for axis in range(3):
        if sigma[axis] == 0.0:
            continue
        reach = max(int(TRUNCATE * sigma[axis] + 0.5), 1)
        with np.errstate(over="ignore"):  # of a sigma so small that only the middle has weight
            weights = np.exp(-0.5 * (np.arange(-reach, reach + 1) / sigma[axis]) ** 2)
        shape = values.shape
        flat = values.reshape(int(np.prod(shape[:axis])), shape[axis], int(np.prod(shape[axis + 1 :])))
        out = np.empty_like(flat)
        along(flat, weights / weights.sum(), out)
        values = out.reshape(shape)
    return values
