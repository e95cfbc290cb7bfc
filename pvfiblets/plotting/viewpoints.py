"""Standard cameras for a brain."""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import pyvista as pv

DIRECTIONS = {
    "axial": ((0, 0, 1), (0, 1, 0)),
    "inferior": ((0, 0, -1), (0, 1, 0)),
    "coronal": ((0, 1, 0), (0, 0, 1)),
    "posterior": ((0, -1, 0), (0, 0, 1)),
    "sagittal": ((-1, 0, 0), (0, 0, 1)),
    "right": ((1, 0, 0), (0, 0, 1)),
    "oblique": ((-1, 0.8, 0.45), (0, 0, 1)),
}
"""Direction of the camera, and the picture's upward direction (RAS+ mm)."""


def visible_bounds(plotter: pv.BasePlotter) -> tuple[float, ...]:
    """Return (xmin, xmax, ymin, ymax, zmin, zmax) of all visible actors, mm; from -1 to 1 where there is none."""
    found = tuple(float(end) for end in plotter.renderer.ComputeVisiblePropBounds())
    return found if all(found[k] <= found[k + 1] for k in (0, 2, 4)) else (-1.0, 1.0) * 3


def point_camera(plotter: pv.BasePlotter, view: str) -> None:
    """Look at all that is visible from one of the named directions, as near as the picture's edges allow."""
    # Nothing is rendered.
    direction, up = DIRECTIONS[view]
    plotter.renderer.view_vector(direction, viewup=up, render=False)  # the plotter's own methods render
    plotter.renderer.reset_camera(render=False)
    camera, bounds = plotter.camera, visible_bounds(plotter)
    low, high = np.array(bounds[::2]), np.array(bounds[1::2])
    # The middles of the box's edges: exact from the front, and from aslant nearer to a brain's
    # outline than the box's corners are.
    edges = np.array([c for c in product((0.0, 0.5, 1.0), repeat=3) if c.count(0.5) == 1])
    points = np.column_stack([low + edges * (high - low), np.ones(len(edges))])
    width, height = plotter.window_size
    left, bottom, right, top = plotter.renderer.GetViewport()
    aspect = width * (right - left) / (height * (top - bottom))
    matrix = camera.GetCompositeProjectionTransformMatrix(aspect, -1.0, 1.0)
    seen = points @ np.array([[matrix.GetElement(i, j) for j in range(4)] for i in range(4)]).T
    with np.errstate(divide="ignore", invalid="ignore"):  # of a scene with nothing in it
        reach = np.abs(seen[:, :2] / seen[:, 3:]).max()
    if np.isfinite(reach) and reach > 0.0:
        camera.zoom(0.92 / reach)
