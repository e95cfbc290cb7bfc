"""``style="density"`` and ``scalars="density"``: pictures against counts, and what they leave alone."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

PLAIN = {"show_scalar_bar": False}


@pytest.fixture
def bundles():
    """Lines along x in the plane of the picture: 1, 4 and 16 in the same place, in three rows."""
    x = np.linspace(-10, 10, 41)
    return [np.c_[x, 0 * x + 5.0 * row, 0 * x - k] for row, n in enumerate((1, 4, 16)) for k in range(n)]


def seen(plotter):
    """Picture from the front, by a camera without perspective."""
    plotter.enable_parallel_projection()
    plotter.view_xy()
    return plotter.screenshot(None).astype(float)


def rows_of(picture):
    """Brightest colour of each of the three rows, the lowest first."""
    column = picture[:, picture.shape[1] // 2]
    bright = column.sum(-1)
    rows = np.flatnonzero(bright > 8)
    groups = np.split(rows, np.flatnonzero(np.diff(rows) > 3) + 1)
    assert len(groups) == 3, rows
    return [column[group[np.argmax(bright[group])]] for group in groups[::-1]]


TONES = {
    "log": lambda n, m: np.log1p(n) / np.log1p(m),
    "sqrt": lambda n, m: np.sqrt(n / m),
    "linear": lambda n, m: n / m,
}


@pytest.mark.few(3)
@pytest.mark.parametrize("tone", TONES)
@pytest.mark.parametrize("peeling", [False, True])
def test_brightness_tells_the_number_of_lines(plotter, bundles, tone, peeling):
    if peeling:
        plotter.enable_depth_peeling()
    actor = plotter.add_fiblets(bundles, style="density", color="white", line_width=5, **PLAIN)
    actor.density_tone = tone
    assert actor.style == "density"
    assert actor.copy().density_tone == tone
    expected = [255 * TONES[tone](n, 16) for n in (1, 4, 16)]
    assert np.abs(np.array(rows_of(seen(plotter)))[:, 0] - expected).max() <= 2
    actor.clim = (0, 64)  # lines of full brightness
    expected = [255 * TONES[tone](n, 64) for n in (1, 4, 16)]
    assert np.abs(np.array(rows_of(seen(plotter)))[:, 0] - expected).max() <= 2


def test_directions_keep_their_colours_and_numbers_theirs(plotter, bundles):
    actor = plotter.add_fiblets(bundles, style="density", lighting=True, **PLAIN)
    for colour, n in zip(rows_of(seen(plotter)), (1, 4, 16), strict=True):
        assert np.abs(colour - [255 * TONES["log"](n, 16), 0, 0]).max() <= 2
    actor.scalars = np.repeat([0.0, 1.0], [5, 16])
    actor.cmap = ["red", "blue"]
    low, middle, high = rows_of(seen(plotter))
    assert low[2] == middle[2] == 0
    assert high[0] == 0
    actor.style = "surface"
    assert np.abs(np.array(rows_of(seen(plotter))) - [[255, 0, 0], [255, 0, 0], [0, 0, 255]]).max() <= 2


@pytest.mark.parametrize("style", ["density", "surface"])
def test_a_map_and_a_bar_tell_streamlines_per_pixel(plotter, bundles, style):
    actor = plotter.add_fiblets(bundles, scalars="density", style=style, cmap="gray", scalar_bar_args={"height": 0.01})
    rows = np.array(rows_of(seen(plotter)))[:, 0]
    table = actor.lookup_table
    assert table.scalar_range == (0.0, 16.0)  # of the fullest pixel
    expected = [table.map_value(float(n))[0] for n in (1, 4, 16)]
    assert np.abs(rows - [255 * e if e <= 1 else e for e in expected]).max() <= 2
    assert "streamlines per pixel" in plotter.scalar_bars
    actor.log_scale = True
    column = seen(plotter)[:, 100, 0]  # one line has the first colour, black
    assert table.scalar_range == (1.0, 16.0)
    assert set(column) <= {0.0, 127.0, 128.0, 255.0}
    assert column.max() == 255
    assert (np.abs(column - 127.5) < 1).any()
    actor.log_scale, actor.clim = False, (0, 32)
    rows = np.array(rows_of(seen(plotter)))[:, 0]
    assert table.scalar_range == (0.0, 32.0)
    assert np.abs(rows - [8, 32, 128]).max() <= 3


def test_criteria_cuts_and_picks_work_as_ever(plotter, bundles):
    actor = plotter.add_fiblets(bundles, style="density", color="white", **PLAIN)
    actor.clim = (0, 16)
    actor.density_tone = "linear"
    seen(plotter)
    assert actor.pick_at(100, 100)[0] == 1  # the nearest of the middle row
    actor.show_only(np.arange(0, 21, 2))  # of 16 lines 8, of 4 lines 2
    assert np.abs(np.array(rows_of(seen(plotter)))[:, 0] - [16, 32, 128]).max() <= 3
    actor.clip(((0, 0, 1), (0, 0, -3.5)))  # of them, those in front of the plane
    _, _, high = rows_of(seen(plotter))
    assert abs(high[0] - 32) <= 2


def test_what_is_opaque_hides_lines_behind_it_and_light_adds_over_it(plotter, bundles):
    plotter.add_mesh(pv.Plane(center=(0, 5, -7.5), i_size=30, j_size=12), color="black", lighting=False)
    actor = plotter.add_fiblets(bundles, style="density", color="white", **PLAIN)
    actor.clim, actor.density_tone = (0, 16), "linear"
    assert np.abs(np.array(rows_of(seen(plotter)))[:, 0] - [16, 64, 128]).max() <= 2  # of 16, 8 are in front
    plotter.camera.position = (0, 5, -100)
    plotter.camera.focal_point = (0, 5, 0)
    plotter.camera.up = (0, 1, 0)
    plotter.reset_camera()
    back = plotter.screenshot(None).astype(float)
    assert back.max() == pytest.approx(255 * 8 / 16, abs=2)  # those behind the plane, from behind
    plotter.set_background("blue")
    actor.color = "yellow"
    column = plotter.screenshot(None).astype(float)[:, 100]
    assert any(np.abs(colour - [127, 127, 127]).max() <= 2 for colour in column)


def test_nonsense_is_refused_in_words(plotter, bundles):
    actor = plotter.add_fiblets(bundles, **PLAIN)
    with pytest.raises(ValueError, match="density_tone is 'cubic'"):
        actor.density_tone = "cubic"
    with pytest.raises(ValueError, match="style is 'fog'"):
        plotter.add_fiblets(bundles, style="fog")
