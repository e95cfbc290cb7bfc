"""Openness of volumes' surfaces (Lesar 2015, equation 10): the scenes, and the right values, in float64."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from pvfiblets.synthetic.vessels import brain_like, vessel_tree
from pvfiblets.volumes import RaycastVolume

from ...cameras import Camera, unit
from . import reference

BESIDE = 0.05  # mm
DIRECTIONS = 48  # along each side of the rule of directions

Array = npt.NDArray[np.float64]


def opened_head(n: int) -> RaycastVolume:
    """Return a head without its upper third, so that the brain's folds show from above."""
    head = brain_like(n)
    return RaycastVolume(head.values[:, :, : round(0.66 * n)], head.affine)


SETS: dict[str, tuple[Callable[[int], RaycastVolume], float, tuple[float, float, float]]] = {
    "vessels": (vessel_tree, 90.0, (0.25, -1.0, 0.35)),
    "head": (opened_head, 85.0, (0.2, -0.4, 1.0)),
}
"""What to draw, the value of its surface, and where to look at it from."""


def seen_from(volume: RaycastVolume, size: tuple[int, int], away: tuple[float, float, float]) -> Array:
    """Return a matrix that shows a volume from a direction, and fills the picture with it."""
    bounds = np.array(volume.bounds).reshape(3, 2)
    middle, reach = bounds.mean(axis=1), float(np.ptp(bounds, axis=1).max())
    eye, slant = middle + 2.2 * reach * unit(np.array(away)), float(np.tan(np.radians(27.0) / 2.0))
    return Camera(size, eye, middle, 1.2 * reach, 3.4 * reach, slant).model_view_projection


def exact_openness(
    volume: RaycastVolume, value: float, through: Any, gradients: Array, t: Array, radius: float, n: int = DIRECTIONS
) -> Array:
    """Return equation 10 at hits of rays, by a rule of n x n stratified directions, in float64."""
    from pvfiblets.engine.volumes.ray_occlusion import LIFT

    # The open side is the viewer's by the field next to the hit, not by differences over two voxels.
    before, after = (reference.sample(volume, through.points(t + beside)) for beside in (-BESIDE, BESIDE))
    normals = gradients / np.linalg.norm(gradients, axis=-1, keepdims=True)
    above = before > after
    normals *= np.where(above, 1.0, -1.0)[:, None]
    turn = volume.inverse[:3, :3]
    hits = through.points(t)
    starts = hits + LIFT * normals / np.linalg.norm(normals @ turn.T, axis=-1, keepdims=True)
    wrong = (reference.sample(volume, starts) >= value) != above
    back = hits - LIFT * through.directions / np.linalg.norm(through.directions @ turn.T, axis=-1, keepdims=True)
    starts = np.where(wrong[:, None], back, starts)
    right = np.cross(normals, np.where(np.abs(normals[:, :1]) < 0.7, [[1.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]]))
    right /= np.linalg.norm(right, axis=-1, keepdims=True)
    u, v = (side.ravel()[:, None] for side in np.meshgrid(*[(np.arange(n) + 0.5) / n] * 2))
    x, y = np.sqrt(u) * np.cos(2.0 * np.pi * v), np.sqrt(u) * np.sin(2.0 * np.pi * v)
    directions = right[:, None] * x + np.cross(normals, right)[:, None] * y + normals[:, None] * np.sqrt(1.0 - u)
    origins = np.broadcast_to(starts[:, None], directions.shape)
    voxels, steps = origins @ turn.T + volume.inverse[:3, 3], directions @ turn.T
    with np.errstate(divide="ignore"):
        ends = np.where(steps > 0.0, (np.array(volume.shape) - 1.0 - voxels) / steps, -voxels / steps)
    far = np.minimum(np.where(steps == 0.0, np.inf, ends).min(axis=-1), radius)
    gone = far <= 0.0
    rays = reference.Rays(origins, directions, np.where(gone, np.nan, 0.0), np.where(gone, np.nan, far), through.matrix)
    return (reference.isosurface(volume, value, rays).value < 0).mean(axis=1)
