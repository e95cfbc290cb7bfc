"""Whether the eye may be inside a tube: only then have fragments to look for the wall that one sees from within.

What is looked through is the rectangle of the near plane that the picture shows. Segments are put in groups, each with
the box of its tubes; only the segments of groups that the rectangle's own box touches are looked at, so that it costs
little.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from ...tubes.curves import controls, sample_spheres
from ..view import View

if TYPE_CHECKING:
    from ...tubes.spline_tubes import SplineTubes

_GROUP = 256
Array = npt.NDArray[np.float64]


class EyeInsideTest:
    """The boxes of one set's segments; tubes lie `reach` mm outside the box of the nodes at most."""

    def __init__(self, tubes: SplineTubes, middle: float) -> None:
        self._tubes, self._middle = tubes, middle
        self._groups: Array = np.zeros((0, 2, 3))
        self.reach = 0.0
        if not tubes.n_segments:
            return
        boxes = [self._boxes(first) for first in range(0, tubes.n_segments, _GROUP * 256)]
        starts = [np.arange(0, len(box), _GROUP) for box in boxes]
        low = np.concatenate([np.minimum.reduceat(b[:, 0], s) for b, s in zip(boxes, starts, strict=True)])
        high = np.concatenate([np.maximum.reduceat(b[:, 1], s) for b, s in zip(boxes, starts, strict=True)])
        self._groups = np.stack([low, high], axis=1)
        below = tubes.points.min(axis=0) - low.min(axis=0)
        above = high.max(axis=0) - tubes.points.max(axis=0)
        self.reach = float(max(below.max(), above.max(), 0.0))

    def _boxes(self, first: int, count: int = _GROUP * 256) -> Array:
        """(n, 2, 3) boxes of the balls around the control points of some segments."""
        some = np.arange(first, min(first + count, self._tubes.n_segments))
        halves = controls(self._tubes, some, self._middle)
        balls = halves[:, (0, 0, 1, 1), (0, 1, 1, 2)]  # those of the joint lie between these
        centres, reach = balls[..., :3], balls[..., 3:]
        return np.stack([(centres - reach).min(axis=1), (centres + reach).max(axis=1)], axis=1)

    def touched(self, view: View, min_width: float) -> bool:
        """Say whether a tube may reach the rectangle of the near plane that a view shows."""
        if not len(self._groups):
            return False
        corners = np.array([[x, y, -1.0, 1.0] for x in (-1.0, 1.0) for y in (-1.0, 1.0)])
        try:
            near = np.linalg.solve(view.model_view_projection, corners.T).T
        except np.linalg.LinAlgError:
            return False  # no depth, no inside
        with np.errstate(divide="ignore", invalid="ignore"):
            near = near[:, :3] / near[:, 3:]
        if not np.isfinite(near).all():
            return True
        low, high = near.min(axis=0), near.max(axis=0)
        margin = (1e-6 + min_width / min(view.size)) * float((high - low).max())
        box = np.array([low - margin, high + margin])
        plane = view.model_view_projection[3] + view.model_view_projection[2]
        plane = plane / (np.linalg.norm(plane[:3]) or 1.0)
        for group in np.flatnonzero(_overlap(self._groups, box) & _crosses(self._groups, plane, margin)):
            boxes = self._boxes(int(group) * _GROUP, _GROUP)
            near_it = int(group) * _GROUP + np.flatnonzero(_overlap(boxes, box) & _crosses(boxes, plane, margin))
            if len(near_it) and self._reaches(near_it, box, plane, margin):
                return True
        return False

    def _reaches(self, segments: npt.NDArray[np.int64], box: Array, plane: Array, margin: float) -> bool:
        """Say whether one of some segments reaches a plane within a box, by balls along it; rather yes than no."""
        halves = controls(self._tubes, segments, self._middle)
        balls = sample_spheres(halves, 33)
        # Between two balls of 32 steps the tube is no farther from one than a step of its control polygon.
        steps = np.linalg.norm(np.diff(halves, axis=2), axis=-1).max(axis=2)[..., None] / 16.0
        reach = balls[..., 3] + steps + margin
        near = np.abs(balls[..., :3] @ plane[:3] + plane[3]) <= reach
        beside = (balls[..., :3] >= box[0] - reach[..., None]) & (balls[..., :3] <= box[1] + reach[..., None])
        return bool((near & beside.all(axis=-1)).any())


def _crosses(boxes: Array, plane: Array, margin: float) -> npt.NDArray[np.bool_]:
    """Say which of (n, 2, 3) boxes have a point of a plane, or nearly so."""
    centre, half = boxes.mean(axis=1), (boxes[:, 1] - boxes[:, 0]) / 2.0
    crosses: npt.NDArray[np.bool_] = np.abs(centre @ plane[:3] + plane[3]) <= half @ np.abs(plane[:3]) + margin
    return crosses


def _overlap(boxes: Array, box: Array) -> npt.NDArray[np.bool_]:
    """Say which of (n, 2, 3) boxes have a point of a (2, 3) box."""
    overlap: npt.NDArray[np.bool_] = ((boxes[:, 0] <= box[1]) & (boxes[:, 1] >= box[0])).all(axis=1)
    return overlap
