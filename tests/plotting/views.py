"""How the tests look at a plotter: its picture after a render, and a view along y in which lengths are known."""

from __future__ import annotations

import numpy as np


def shot(plotter) -> np.ndarray:
    """Render, and return the picture: PyVista's screenshot alone shows the last render."""
    plotter.show(auto_close=False, interactive=False) if plotter._first_time else plotter.render()
    return plotter.screenshot(None)


def facing(plotter):
    """Look from -y, z upwards, in parallel: the picture is 40 mm high, and the eye 100 mm away."""
    plotter.camera_position = [(0, -100, 0), (0, 0, 0), (0, 0, 1)]
    plotter.enable_parallel_projection()
    plotter.camera.parallel_scale = 20.0
    plotter.camera.clipping_range = 10, 300


def facing_shot(plotter) -> np.ndarray:
    """Return the picture from there, (height, width, 3) integers."""
    facing(plotter)
    return shot(plotter)[..., :3].astype(int)
