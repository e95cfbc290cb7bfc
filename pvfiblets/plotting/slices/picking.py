"""The place of a slice under a pixel of the 3-D view."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingCore import vtkRenderer

    from pvfiblets.plotting.slices.plane import SlicePlane


def picked_on_planes(
    renderer: vtkRenderer, planes: Iterable[SlicePlane], x: float, y: float
) -> npt.NDArray[np.float64] | None:
    """Return the place nearest to the viewer where a pixel shows a slice."""
    ends = []
    for depth in (0.0, 1.0):
        renderer.SetDisplayPoint(x, y, depth)
        renderer.DisplayToWorld()
        point = np.array(renderer.GetWorldPoint())
        ends.append(point[:3] / point[3])
    near, ray = ends[0], ends[1] - ends[0]
    hits = []
    for plane in planes:
        pixels, grid = plane.actor.pixels, plane.grid
        across = float(ray @ plane.normal)
        if not plane.visible or grid is None or pixels is None or across == 0.0:
            continue
        share = float((plane.origin - near) @ plane.normal) / across
        hit = near + share * ray
        at = hit - grid.corner
        i, j = int(at @ grid.along // (grid.along @ grid.along)), int(at @ grid.up // (grid.up @ grid.up))
        if 0 <= i < pixels.shape[1] and 0 <= j < pixels.shape[0] and pixels[j, i, 3] and share > 0.0:
            hits.append((share, hit))
    return min(hits, key=lambda one: one[0])[1] if hits else None
