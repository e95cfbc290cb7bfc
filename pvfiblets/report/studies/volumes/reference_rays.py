"""The rays of a picture's pixels, and from where to where they are in a volume, in float64.

Source: Lesar, "Real-time ray casting of volumetric data" (2015), section III-B, equation 1.

A pixel's ray is where two planes of space meet, ``X = x W`` and ``Y = y W`` in clip coordinates. It begins on the near
plane, and is parametrised by mm from there. Nothing of this inverts the matrix, which is nearly singular where the far
plane is far away.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from pvfiblets.volumes.volume import RaycastVolume

Array = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Rays:
    """Rays through a volume, of any shape ``...``; of a picture ``(height, width)``, row 0 at the bottom."""

    # `(..., 3)` float64, mm. Directions are unit vectors, so that lengths along rays are mm.
    origins: Array
    directions: Array
    # `(...)` float64: the stretch of each ray within the volume. NaN for rays that miss it.
    near: Array
    far: Array
    matrix: Array  # `(4, 4)` data coordinates in mm to clip coordinates

    def points(self, t: npt.ArrayLike) -> Array:
        """Places ``(..., 3)`` at `t` mm along the rays."""
        return self.origins + np.asarray(t, np.float64)[..., None] * self.directions

    def depth(self, t: npt.ArrayLike) -> Array:
        """Window depths, 0 to 1, at `t` mm along the rays; 1 where `t` is NaN."""
        z, w = np.moveaxis(self.points(t) @ self.matrix[2:, :3].T + self.matrix[2:, 3], -1, 0)
        return np.where(np.isnan(w), 1.0, np.clip((z / w + 1.0) / 2.0, 0.0, 1.0))

    def __getitem__(self, which: Any) -> Rays:
        """Some of the rays, by NumPy's indices."""
        return Rays(self.origins[which], self.directions[which], self.near[which], self.far[which], self.matrix)


def rays(
    matrix: npt.ArrayLike,
    size: tuple[int, int],
    volume: RaycastVolume,
    *,
    clip_planes: npt.ArrayLike = (),
    depths: npt.ArrayLike | None = None,
    box: Sequence[float] | None = None,
) -> Rays:
    """Rays through the centres of a picture's pixels (equation 1), from the near plane on."""
    matrix = np.array(matrix, np.float64)
    width, height = (int(n) for n in size)
    planes = np.array(clip_planes, np.float64)
    planes = planes.reshape(0, 4) if planes.size == 0 else planes
    if matrix.shape != (4, 4) or not np.isfinite(matrix).all():
        raise ValueError(f"the matrix must be a finite (4, 4) one, got {matrix.tolist()}")
    if width < 1 or height < 1:
        raise ValueError(f"size is {size}; give a width and a height of at least one pixel")
    if planes.ndim != 2 or planes.shape[1] != 4 or not np.isfinite(planes).all():
        raise ValueError(f"clip_planes must be finite rows (a, b, c, d), got {planes.tolist()}")
    origins, directions = _through_pixels(matrix, width, height)

    def along(plane: Array) -> tuple[Array, Array]:
        """Heights over a plane at the rays' origins, and their change per mm."""
        return origins @ plane[:3] + plane[3], directions @ plane[:3]

    bounds = [along(matrix[3] - matrix[2]), *(along(plane) for plane in planes)]
    low, high = np.zeros(3), np.array(volume.shape) - 1.0
    if box is not None:
        sides = np.array(box, np.float64)
        if sides.shape != (6,) or not np.isfinite(sides).all():
            raise ValueError(f"box is {box}; give (xmin, xmax, ymin, ymax, zmin, zmax) in voxels")
        low, high = np.maximum(low, sides[::2]), np.minimum(high, sides[1::2])
    for axis, row in enumerate(volume.inverse[:3]):
        at, change = along(row)
        bounds += [(at - low[axis], change), (high[axis] - at, -change)]
    if depths is not None:
        depths = np.array(depths, np.float64)
        if depths.shape != (height, width) or not np.isfinite(depths).all():
            raise ValueError(f"depths must be finite and of the shape {(height, width)}, got {depths.shape}")
        (z, dz), (w, dw) = along(matrix[2]), along(matrix[3])
        before = 2.0 * depths - 1.0
        # At a depth of 1 nothing is there, and the far plane ends the ray.
        at, change = before * w - z, before * dw - dz
        bounds.append((np.where(depths < 1.0, at, 1.0), np.where(depths < 1.0, change, 0.0)))
    near, far = np.zeros((height, width)), np.full((height, width), np.inf)
    for at, change in bounds:
        with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
            crossed = -at / change
        near = np.where(change > 0.0, np.maximum(near, crossed), near)
        far = np.where(change < 0.0, np.minimum(far, crossed), far)
        far = np.where((change == 0.0) & (at < 0.0), -np.inf, far)
    inside = near < far
    return Rays(origins, directions, np.where(inside, near, np.nan), np.where(inside, far, np.nan), matrix)


def _through_pixels(matrix: Array, width: int, height: int) -> tuple[Array, Array]:
    """Where the rays of pixels are on the near plane, and their unit directions away from the eye."""
    y, x = np.mgrid[:height, :width] + 0.5
    columns = matrix[0] - (2.0 * x[..., None] / width - 1.0) * matrix[3]
    rows = matrix[1] - (2.0 * y[..., None] / height - 1.0) * matrix[3]
    first = matrix[2] + matrix[3]
    directions = np.cross(columns[..., :3], rows[..., :3])
    lengths = np.linalg.norm(directions, axis=-1, keepdims=True)
    rise = directions @ first[:3]
    if not (lengths > 0.0).all() or not rise.all():
        raise ValueError(f"the matrix {matrix.tolist()} flattens space; give an invertible one")
    directions *= np.sign(rise)[..., None] / lengths
    planes = np.stack([columns, rows, np.broadcast_to(first, columns.shape)], axis=-2)
    # Rows of very different lengths are usual; scaled, they do not matter to the solution.
    planes = planes / np.linalg.norm(planes[..., :3], axis=-1, keepdims=True)
    origins = np.linalg.solve(planes[..., :3], -planes[..., 3:])[..., 0]
    return origins, directions
