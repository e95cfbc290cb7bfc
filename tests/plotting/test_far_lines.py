"""A line so far away that all others are drawn visibly off."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import pvfiblets as pf


def helix(far: float) -> list[np.ndarray]:
    """A line of 1 mm radius, and one that may be far away."""
    t = np.linspace(0, 6, 200)
    return [np.stack([np.cos(t), np.sin(t), t / 5], axis=1), np.array([[far, 0, 0], [far + 0.03, 0, 0]])]


def draw(plotter: pf.Plotter, kind: str, far: float) -> None:
    getattr(plotter, kind)(helix(far))
    plotter.screenshot(None, return_img=True)


@pytest.mark.parametrize("kind", ["add_fiblets", "add_halo_lines", "add_spline_tubes"])
def test_a_far_line_that_coarsens_the_others_warns_once(plotter: pf.Plotter, kind: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        draw(plotter, kind, 10.0)
    with pytest.warns(UserWarning, match=r"most points .* reach \[1000000.*leave out the outlying lines") as said:
        draw(plotter, kind, 1e8)
    assert len(said) == 1
