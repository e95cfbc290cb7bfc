"""Values of a grid of voxels at points."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

PIECE = 1 << 18  # points at a time: the temporary arrays then stay in the cache

Array = npt.NDArray[np.float64]


def sample(values: npt.NDArray[Any], to_voxel: Array, points: npt.ArrayLike, *, nearest: bool = False) -> Array:
    """Return values at points ``(n, 3)``, ``(n,)``: trilinear between the centres of voxels, or the nearest voxel's."""
    # A voxel reaches half a voxel around its centre; in the outer half of the outermost ones their own values go on.
    # Outside, and where a voxel that takes part is NaN, the value is NaN.
    given = np.asarray(points, np.float64)
    sides = np.array(values.shape)
    found = np.full(len(given), np.nan)
    for start in range(0, len(given), PIECE):
        at = given[start : start + PIECE] @ to_voxel[:3, :3].T + to_voxel[:3, 3]
        within = ((at >= -0.5) & (at <= sides - 0.5)).all(axis=1)
        at = np.clip(at[within], 0.0, sides - 1.0)
        if nearest:
            total = values[tuple(np.minimum(np.floor(at + 0.5).astype(np.int64), sides - 1).T)]
        else:
            low = np.minimum(np.floor(at).astype(np.int64), np.maximum(sides - 2, 0))
            share = at - low
            total = np.zeros(len(at))
            for corner in np.ndindex(2, 2, 2):
                weight = np.prod(np.where(corner, share, 1.0 - share), axis=1)
                voxels = values[tuple(np.minimum(low + corner, sides - 1).T)].astype(np.float64)
                # A voxel without weight must not make NaN of it.
                total += np.multiply(weight, voxels, out=np.zeros(len(at)), where=weight > 0.0)
        found[start : start + PIECE][within] = total
    return found
