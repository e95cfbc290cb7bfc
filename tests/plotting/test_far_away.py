"""Lines at distances that nobody draws on purpose: refused or told of in one sentence, without warnings of NumPy."""

from __future__ import annotations

import numpy as np
import pytest

ADDS = ("add_fiblets", "add_spline_tubes", "add_halo_lines")


def brain(scale=1.0):
    random = np.random.default_rng(0)
    return [np.cumsum(random.normal(size=(20, 3)), axis=0) * scale for _ in range(5)]


def with_outlier(value):
    lines = brain()
    lines[3][5] = value
    return lines


@pytest.mark.few(5)
@pytest.mark.parametrize("add", ADDS)
@pytest.mark.parametrize("lines", [brain(1e30), with_outlier(-1e30), brain(1e18)], ids=["1e30", "outlier", "1e18"])
def test_coordinates_beyond_the_cameras_reach_are_named_once(plotter, add, lines):
    reach = np.abs(np.concatenate(lines)).max()
    with pytest.warns(UserWarning, match="check the units, leave outliers out, or scale the points") as said:
        getattr(plotter, add)(lines)
    plotter.screenshot()  # warns of nothing more
    assert len(said) == 1
    assert said[0].filename == __file__
    named = float(str(said[0].message).split()[2])
    assert reach * 0.99 <= named <= reach * 1.05  # tubes and lines have a width


@pytest.mark.parametrize("add", ADDS)
def test_coordinates_that_float32_cannot_hold_are_refused(plotter, add):
    with pytest.raises(ValueError, match=r"a coordinate of 1e\+300 mm is beyond 1e\+35 mm.*check the units"):
        getattr(plotter, add)(with_outlier(1e300))
