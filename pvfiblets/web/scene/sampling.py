"""Values of a volume along streamlines, for tables, profiles and histograms; the picture samples on the GPU.

By the same rules (:mod:`pvfiblets.engine.fiblets.data.sampled_volume`): trilinear between voxel centres, of labels the
nearest voxel's; the outermost voxels reach half a voxel beyond their centres; NaN outside and next to NaN.
"""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np

__all__ = ["sampled"]


def sampled(volume: Any, points: Any) -> np.ndarray:
    """Return a volume's values at points."""
    places = np.asarray(points, np.float64) @ volume.voxels[:3, :3].T + volume.voxels[:3, 3]
    sides = np.array(volume.values.shape)
    found = np.full(len(places), np.nan)
    inside = ((places >= -0.5) & (places <= sides - 0.5)).all(axis=1)
    at = places[inside]
    if volume.nearest:
        i, j, k = np.minimum(np.floor(at + 0.5).astype(np.int64), sides - 1).T
        found[inside] = volume.values[i, j, k]
        return found
    at = np.clip(at, 0.0, sides - 1.0)
    first = np.minimum(np.floor(at).astype(np.int64), np.maximum(sides - 2, 0))
    part = at - first
    total = np.zeros(len(at))
    for corner in product((0, 1), repeat=3):
        weight = np.where(corner, part, 1.0 - part).prod(axis=1)
        i, j, k = np.minimum(first + corner, sides - 1).T
        values = np.asarray(volume.values[i, j, k], np.float64)
        total += weight * np.where(weight > 0.0, values, 0.0)
    found[inside] = total
    return found
