"""Values of points that the engine computes while it draws, stored with a set for a page, which computes none."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from pvfiblets.codec.point_arrays import colours_of_points, with_coded_values

if TYPE_CHECKING:
    from pvfiblets.codec.fibletset import FibletSet

__all__ = ["colours", "with_values"]

_BITS = 16


def with_values(fiblets: FibletSet, source: Any) -> tuple[FibletSet, str]:
    """Return a set that has some values for its points, in 16 bits where it has not, and their name."""
    if isinstance(source, str):
        if source in fiblets.per_point:
            return fiblets, source
        from pvfiblets.query.measures.measures import measure

        return with_coded_values(fiblets, source, measure(fiblets, source).array(), _BITS), source
    from pvfiblets.query.measures.image_samples import sample_image

    points = fiblets.decompress().points
    if source.nearest:  # centres of voxels have the voxels' own values
        voxels = np.rint(points @ source.voxels[:3, :3].T + source.voxels[:3, 3])
        points = voxels @ source.affine[:3, :3].T + source.affine[:3, 3]
    values = sample_image(source.values, source.affine, points)
    return with_coded_values(fiblets, source.name, fiblets.in_coded_order(values), _BITS), source.name


def colours(fiblets: FibletSet, name: str) -> npt.NDArray[np.uint8]:
    """Return ``(n_points, 4)`` uint8: the colours of points in coded order."""
    found = colours_of_points(fiblets, name)
    full = np.full((len(found), 4), 255, np.uint8)
    full[:, : found.shape[1]] = found
    return full
