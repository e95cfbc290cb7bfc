"""Pictures of halos: their samples and tiles, widths, and how far one is from another."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest

from pvfiblets.engine.halos import HaloRenderer
from pvfiblets.halos import HaloLines, HaloStyle
from pvfiblets.report.cameras import Camera
from pvfiblets.report.halos_pictures import differences, helices, look_of, orbit, picture


def across(size=(64, 48)):
    """Return one line across a picture, its look and a camera that shows it 64 x 16 pixels wide."""
    camera = Camera(size, np.array([0.0, -100.0, 0.0]), np.zeros(3), 50.0, 150.0)
    k = camera.pixels / 100.0
    line = HaloLines([[-80.0, 0.0, 0.0], [80.0, 0.0, 0.0]], [0, 2])
    return line, HaloStyle(16.0 / k, 24.0 / k, 1.0, n_tapered=0, smooth=False, min_width=0.0), camera


@pytest.mark.parametrize("times", [1, 2, 3])
def test_a_picture_is_as_dark_as_its_line_is_wide(gl, times):
    line, look, camera = across()
    renderer = HaloRenderer(gl, line)
    shown = picture(renderer, camera, look, times)
    assert shown.shape == (48, 64)
    np.testing.assert_array_equal(np.flatnonzero(shown.mean(axis=1) == 1.0), np.arange(16, 32))
    assert shown.sum() == 64 * 16
    renderer.release()


def test_the_least_width_is_in_pixels_of_the_picture(gl):
    line, look, camera = across()
    thin = HaloStyle(1e-3, 1.0, 1.0, n_tapered=0, smooth=False, min_width=4.0)
    renderer = HaloRenderer(gl, line)
    for times in (1, 4):
        assert picture(renderer, camera, thin, times).sum() == 64 * 4
    renderer.release()


def test_tiles_make_the_whole_picture(gl):
    lines = helices(6)
    camera = orbit(lines, 1, 1, (64, 48))[0][0]
    look = look_of(lines)
    renderer = HaloRenderer(gl, lines)
    whole = picture(renderer, camera, look, 4)
    tiled = picture(renderer, camera, look, 4, most=64 * 48)
    assert whole.mean() > 0.02
    # Coordinates are rounded otherwise, so that samples on an edge may turn out otherwise.
    assert abs(tiled - whole).max() <= 1.0 / 16.0 + 1e-6
    assert abs(tiled - whole).mean() < 1e-3
    with pytest.raises(ValueError, match="a picture of 64 x 49 pixels, 4x4 samples each, has no tiles of 100 samples"):
        picture(renderer, SimpleNamespace(size=(64, 49)), look, 4, most=100)
    renderer.release()


def test_errors_of_pictures():
    right = np.zeros((2, 10, 10))
    shown = right.copy()
    shown[0, 0, :4] = 0.5
    told = differences(list(shown), list(right))
    assert told["mean"] == pytest.approx(0.01)
    assert told["rms"] == pytest.approx(math.sqrt(0.25 * 4 / 200))
    assert (told["max"], told["wrong"]) == (0.5, 0.02)
