"""What the tests of the PyVista side share."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

from pvfiblets.streamlines import Streamlines


@pytest.fixture
def three_lines():
    """Three straight streamlines along x, y and z, 10 mm apart, with data of each sort."""
    steps = np.linspace(0.0, 20.0, 41)[:, None]
    lines = [
        np.array([-10.0, -10.0, 0.0]) + steps * np.array([1.0, 0.0, 0.0]),
        np.array([0.0, -5.0, 0.0]) + steps * np.array([0.0, 1.0, 0.0]),
        np.array([8.0, 5.0, -10.0]) + steps * np.array([0.0, 0.0, 1.0]),
    ]
    return Streamlines(
        np.concatenate(lines),
        [0, 41, 82, 123],
        per_point={"height": np.tile(np.linspace(0.0, 1.0, 41), 3)},
        per_streamline={"weight": np.array([1.0, 10.0, 100.0])},
    )


@pytest.fixture
def plotter():
    """Return an off-screen plotter on black, without anti-aliasing, so that colours are pure."""
    plotter = pv.Plotter(off_screen=True, window_size=(200, 200))
    plotter.set_background("black")
    plotter.disable_anti_aliasing()
    yield plotter
    plotter.close()


@pytest.fixture
def colours_in():
    """Return a function: the colours of a picture as a set, the black background left out."""

    def found(picture):
        colours = np.unique(picture.reshape(-1, picture.shape[-1])[:, :3], axis=0)
        return {tuple(int(part) for part in colour) for colour in colours if colour.any()}

    return found
