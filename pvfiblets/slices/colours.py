"""Colours of values on a plane, and layers over each other.

Colours are float32 ``(height, width, 4)``, red, green and blue multiplied by the opacity, from 0 to 1.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float32]
Mask = npt.NDArray[np.bool_]

TINY = 1e-38


def shown(values: npt.NDArray[Any], below: float | None, above: float | None) -> Mask:
    """Return which values are numbers and within both thresholds; nothing is NaN where there is no voxel."""
    found: Mask = np.isfinite(values)
    if below is not None:
        found &= values >= below
    if above is not None:
        found &= values <= above
    return found


def mapped(values: npt.NDArray[Any], table: npt.NDArray[np.uint8], clim: tuple[float, float], log: bool) -> Floats:
    """Return the colours of numbers."""
    low, high = clim
    with np.errstate(all="ignore"):
        if log:
            low, high = (math.log(max(float(end), TINY)) for end in clim)
            values = np.log(values)
        share = (values - low) * (len(table) / max(high - low, TINY))
        at = np.nan_to_num(share, nan=0.0, posinf=len(table), neginf=0.0).clip(0, len(table) - 1).astype(np.intp)
    return (table.astype(np.float32) / np.float32(255.0))[at]


def direction_colours(vectors: npt.NDArray[Any], weights: npt.NDArray[Any] | None, clim: tuple[float, float]) -> Floats:
    """Return red, green and blue by the size of a vector's parts, brighter where a weight is greater."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    with np.errstate(all="ignore"):
        unit = np.where(length > 0.0, vectors / length, 0.0)
        if weights is not None:
            unit = unit * np.clip((weights - clim[0]) / (clim[1] - clim[0]), 0.0, 1.0)[..., None]
    out = np.ones((*vectors.shape[:2], 4), np.float32)
    out[..., :3] = np.nan_to_num(unit)
    return out


def table_colours(codes: npt.NDArray[Any], table: npt.NDArray[np.uint8]) -> Floats:
    """Return the colours of rows of a table; codes below 0 have the first."""
    return (table.astype(np.float32) / np.float32(255.0))[np.maximum(codes, 0)]


def outlines(codes: npt.NDArray[Any]) -> Mask:
    """Return which pixels have another code beside, above or below them."""
    edge = np.zeros(codes.shape, bool)
    across, down = codes[:, 1:] != codes[:, :-1], codes[1:] != codes[:-1]
    edge[:, 1:] |= across
    edge[:, :-1] |= across
    edge[1:] |= down
    edge[:-1] |= down
    return edge


def blend(under: Floats | None, colours: Floats, visible: Mask, opacity: float, how: str) -> Floats:
    """Blend a layer over the others, or add it."""
    share = np.where(visible, colours[..., 3] * np.float32(opacity), np.float32(0.0))[..., None]
    top = np.concatenate([colours[..., :3] * share, share], axis=-1)
    if under is None:
        return top
    if how == "over":
        under *= 1.0 - share
        under += top
    else:
        under[..., 3:] += share * (1.0 - under[..., 3:])
        under[..., :3] += top[..., :3]
        np.minimum(under[..., :3], under[..., 3:], out=under[..., :3])
    return under


def to_bytes(colours: Floats) -> npt.NDArray[np.uint8]:
    """Return ``(height, width, 4)`` uint8, as textures want them: not multiplied by the opacity."""
    alpha = colours[..., 3:]
    with np.errstate(all="ignore"):
        plain = np.where(alpha > 0.0, colours[..., :3] / alpha, 0.0)
    found = np.concatenate([plain, alpha], axis=-1)
    return (np.clip(found, 0.0, 1.0) * np.float32(255.0) + np.float32(0.5)).astype(np.uint8)
