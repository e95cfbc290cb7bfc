"""Where the camera stands to look at a brain."""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np

__all__ = ["DIRECTIONS", "point_camera"]

DIRECTIONS = {
    "axial": ((0, 0, 1), (0, 1, 0)),
    "inferior": ((0, 0, -1), (0, 1, 0)),
    "coronal": ((0, 1, 0), (0, 0, 1)),
    "posterior": ((0, -1, 0), (0, 0, 1)),
    "sagittal": ((-1, 0, 0), (0, 0, 1)),
    "right": ((1, 0, 0), (0, 0, 1)),
    "oblique": ((-1, 0.8, 0.45), (0, 0, 1)),
}
"""Where the camera stands, and what is up in the picture (RAS+ mm)."""


def point_camera(plotter: Any, view: str) -> None:
    """Look at everything from one of the named directions, as near as the picture's edges allow."""
    direction, up = DIRECTIONS[view]
    plotter.view_vector(direction, viewup=up)
    plotter.reset_camera()
    camera, bounds = plotter.camera, plotter.bounds
    low, high = np.array(bounds[::2]), np.array(bounds[1::2])
    # The middles of the box's edges: exact from the front, and from aslant nearer to a brain's
    # outline than the box's corners are.
    edges = np.array([c for c in product((0.0, 0.5, 1.0), repeat=3) if c.count(0.5) == 1])
    points = np.column_stack([low + edges * (high - low), np.ones(len(edges))])
    width, height = plotter.window_size
    matrix = camera.GetCompositeProjectionTransformMatrix(width / height, -1.0, 1.0)
    seen = points @ np.array([[matrix.GetElement(i, j) for j in range(4)] for i in range(4)]).T
    with np.errstate(divide="ignore", invalid="ignore"):  # of a scene with nothing in it
        reach = np.abs(seen[:, :2] / seen[:, 3:]).max()
    if np.isfinite(reach) and reach > 0.0:
        camera.zoom(0.92 / reach)
