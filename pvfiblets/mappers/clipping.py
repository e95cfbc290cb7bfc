"""Clipping planes of the mapper, with a G-buffer that holds only the nearest layer.

A plane that a ray of sight crosses from the kept side to the cut side is easily obeyed: where the nearest
fiblet lies beyond it, so do all others, and the resolve discards the pixel. A plane crossed the other way
cuts away what is in front, and must do so before the G-buffer keeps the nearest: otherwise there would be
holes in the place of what comes to light. It is made the near plane of the engine's view:

    z' = s (c . p) - w        with p in clip coordinates, c the plane there, w = p.w

is >= -w just where c . p >= 0, and grows with depth along every ray. s = 2 / max(c . p / w) over the view
volume keeps all of it in front of the far plane and spends as little depth resolution as possible (E. Lengyel,
"Oblique View Frustum Depth Projection and Clipping", Journal of Game Development 1(2), 2005, with the
maximum over all corners). The resolve turns z' back into the depth of VTK's own view.

One plane can be the near plane. If several are crossed that way, the one that is deepest in the middle of
the picture is, and the others are left to the resolve, with the holes said above.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pvfiblets.mappers.scene import Frame, Matrix

# Below this share of the depth range a plane is as good as edge on to the view, and hides nothing.
_LEAST_RESOLUTION = 2.0**-12


@dataclass(frozen=True, eq=False)
class Cut:
    """What a set of planes means for one frame.

    Attributes
    ----------
    model_view_projection : numpy.ndarray
        (4, 4) for the engine.
    depth : numpy.ndarray
        (4,) factors of (x, y, 1 - engine's depth, 1), x and y in [-1, 1], whose sum is 1 - window depth.
    planes : numpy.ndarray
        (k, 4) in view coordinates, for the resolve to discard by.
    """

    model_view_projection: Matrix
    depth: Matrix
    planes: Matrix


def cut(frame: Frame, world_planes: Matrix) -> Cut:
    """Return how a frame is drawn with planes in world coordinates; a point is kept where all are >= 0."""
    matrix = frame.model_view_projection
    untouched = np.array([0.0, 0.0, 1.0, 0.0])
    in_view = frame.planes_in_view(world_planes)
    if len(world_planes) == 0:
        return Cut(matrix, untouched, in_view)
    clip = frame.planes_in_clip(world_planes)
    # c . (x, y, z, 1) over the cube [-1, 1]^3: greatest at the corner that the signs of c point to.
    greatest = np.abs(clip[:, :3]).sum(axis=1) + clip[:, 3]
    facing = clip[:, 2] > 0.0
    usable = facing & (2.0 * clip[:, 2] > _LEAST_RESOLUTION * greatest) & (greatest > 0.0)
    if not usable.any():
        return Cut(matrix, untouched, in_view)
    depth_in_the_middle = np.where(usable, -clip[:, 3] / np.where(usable, clip[:, 2], 1.0), -np.inf)
    near = int(depth_in_the_middle.argmax())
    x, y, z, w = clip[near]
    scale = 2.0 / greatest[near]
    oblique = np.eye(4)
    oblique[2] = scale * clip[near]
    oblique[2, 3] -= 1.0
    # z' = 1 - 2 w', z = 1 - 2 w: solve z' = scale * (c . (x, y, z, 1)) - 1 for w.
    factors = np.array([x / (2 * z), y / (2 * z), 1 / (scale * z), 0.5 + w / (2 * z) - 1 / (scale * z)])
    # The near plane is exact in the engine; here its rounding would eat into what is kept.
    others = np.delete(in_view, near, axis=0)
    return Cut(oblique @ matrix, factors, others)
