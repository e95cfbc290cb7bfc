"""The colours on the screen are those that matplotlib's maps and plain arithmetic give."""

from __future__ import annotations

import matplotlib as mpl
import numpy as np
import pytest
import pyvista as pv

from pvfiblets.streamlines import Streamlines

FLAT = {"lighting": False, "line_width": 5.0, "show_scalar_bar": False}


def mapped(cmap, fraction, n_colors=256):
    """One colour of a matplotlib map, as VTK's table of ``n_colors`` has it."""
    entry = min(int(fraction * n_colors), n_colors - 1)
    parts = mpl.colormaps[cmap].resampled(n_colors)(entry)[:3]
    return tuple(round(255 * part) for part in parts)


@pytest.fixture
def shown(colours_in):
    """Return a function: the colours that a plotter shows from aslant."""

    def colours(plotter):
        plotter.view_vector((1, 0.4, 0.7))
        return colours_in(plotter.screenshot(None))

    return colours


def close_to(found, wanted, tolerance=2):
    """Whether each colour has a partner in the other set within ``tolerance`` of 255."""
    found, wanted = np.array(sorted(found), int), np.array(sorted(wanted), int)
    distance = np.abs(found[:, None] - wanted[None]).max(axis=2)
    return distance.min(axis=1).max() <= tolerance and distance.min(axis=0).max() <= tolerance


BYTES = np.array([[255, 0, 0], [20, 200, 40], [250, 250, 5]])


@pytest.mark.parametrize(
    ("arguments", "wanted"),
    [
        ({}, [(255, 0, 0), (0, 255, 0), (0, 0, 255)]),  # the absolute direction
        ({"color": "orange"}, [pv.Color("orange").int_rgb]),
        ({"scalars": BYTES.astype(np.uint8)}, BYTES.tolist()),
        ({"scalars": BYTES / 255.0}, BYTES.tolist()),
        ({"scalars": "weight", "cmap": "plasma", "clim": (0, 100)}, [mapped("plasma", f) for f in (0.01, 0.1, 1.0)]),
        ({"scalars": "weight", "cmap": "plasma", "log_scale": True}, [mapped("plasma", f) for f in (0.0, 0.5, 1.0)]),
        ({"scalars": [0.0, 0.4, 1.0], "n_colors": 4}, [mapped("viridis", f, 4) for f in (0.0, 0.4, 1.0)]),
        ({"scalars": np.repeat([0.0, 0.5, 1.0], 41)}, [mapped("viridis", f) for f in (0.0, 0.5, 1.0)]),
        ({"scalars": [np.nan, -5.0, 5.0], "clim": (0, 1), "nan_color": "magenta", "below_color": "cyan",
          "above_color": "yellow"}, [(255, 0, 255), (0, 255, 255), (255, 255, 0)]),
        ({"scalars": [np.nan] * 3, "nan_color": "red"}, [(255, 0, 0)]),
    ],
    ids=["direction", "one", "bytes", "floats", "numbers", "log", "few", "points", "outside", "nan"],
)  # fmt: skip
def test_colours_are_those_of_the_numbers(plotter, three_lines, shown, arguments, wanted):
    plotter.add_fiblets(three_lines, **{"cmap": "viridis", **arguments}, **FLAT)
    assert close_to(shown(plotter), set(map(tuple, wanted)), tolerance=4)


@pytest.mark.parametrize("scalars", ["height", "arc_length"])
def test_values_along_a_line_run_through_the_colour_map(plotter, three_lines, scalars):
    plotter.add_fiblets(three_lines, scalars=scalars, cmap="gray", **FLAT)
    plotter.view_xy()
    picture = plotter.screenshot(None).max(axis=2)
    rows = np.flatnonzero((picture > 0).sum(axis=1) > 60)  # the line along x
    values = picture[rows[len(rows) // 2]]
    inside = np.flatnonzero(values)
    run = values[inside[0] : inside[-1]].astype(int)
    expected = np.linspace(run[0], 255, len(run))
    assert np.abs(run - expected).max() < 12


def test_curvature_of_a_circle_is_one_over_its_radius(plotter):
    angle = np.linspace(0, 6, 300)
    rings = [np.stack([r * np.cos(angle), r * np.sin(angle), 0 * angle], 1) for r in (10.0, 20.0)]
    plotter.add_fiblets(rings, scalars="curvature", clim=(0.0, 0.2), cmap="gray", **FLAT)
    plotter.view_xy()
    picture = plotter.screenshot(None).max(axis=2).astype(float)
    levels = picture[picture > 0] / 255.0 * 0.2
    for wanted in (0.1, 0.05):
        near = levels[np.abs(levels - wanted) < 0.02]
        assert len(near) > 50
        assert np.median(near) == pytest.approx(wanted, abs=0.006)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"scalars": [1.0, 2.0]}, "expected 3 numbers, one per streamline"),
        ({"scalars": np.zeros((3, 2)), "rgb": True}, "2 columns"),
        ({"scalars": np.full((3, 3), 7.0), "rgb": True}, "between 0 and 1"),
        ({"scalars": "weight", "clim": (2, 1)}, "the low one first"),
        ({"scalars": "weight", "clim": "wide"}, "clim is 'wide'"),
        ({"scalars": "weight", "clim": (0, 1), "log_scale": True}, "above zero"),
        ({"scalars": "weight", "n_colors": 0}, "n_colors is 0"),
        ({"opacity": 1.5}, "opacity is 1.5"),
        ({"line_width": 0}, "line_width is 0"),
        ({"line_width": "x"}, "line_width is 'x'; give .* above 0"),
    ],
)
def test_nonsense_is_refused_in_words(plotter, three_lines, arguments, message):
    with pytest.raises(ValueError, match=message):
        plotter.add_fiblets(three_lines, **arguments)
    with pytest.raises(KeyError, match=r"no array 'fa'.*'weight'.*'curvature'"):
        plotter.add_fiblets(three_lines, scalars="fa")
    assert not plotter.actors


def test_no_streamlines_and_equal_values_are_drawn_too(plotter, three_lines, colours_in):
    with pytest.warns(UserWarning, match="no streamlines"):
        plotter.add_fiblets(Streamlines(np.zeros((0, 3)), [0]), scalars="length", show_scalar_bar=False)
    assert not colours_in(plotter.screenshot(None))
    plotter.add_fiblets(three_lines, scalars=[7.0, 7.0, 7.0], **FLAT)
    plotter.render()
    assert len(colours_in(plotter.screenshot(None))) == 1


WRONG = {
    "clim": ["x", [1.0], (2.0, 1.0), (0.0, np.nan), ("a", "b")],
    "n_colors": [0, 2.5, "x", 1e9],
    "nan_color": ["nope", 5],
    "below_color": ["nope"],
    "above_color": ["nope"],
    "log_scale": ["off"],
    "lighting": ["off"],
}


@pytest.mark.few(5)
@pytest.mark.parametrize("add", ["add_fiblets", "add_spline_tubes", "add_halo_lines"])
@pytest.mark.parametrize("name", WRONG)
def test_wrong_settings_fail_at_once_though_one_colour_is_shown(plotter, three_lines, add, name):
    """Else they would fail when numbers colour later, far from where they were given."""
    actor = getattr(plotter, add)(three_lines, color="red")
    for value in WRONG[name]:
        before = getattr(actor, name)
        with pytest.raises(ValueError, match=rf"{name} (is|begins)"):
            setattr(actor, name, value)
        assert getattr(actor, name) == before
        with pytest.raises(ValueError, match=rf"{name} (is|begins)"):
            getattr(plotter, add)(three_lines, color="red", **{name: value})
    actor.scalars = np.arange(3.0)
    plotter.screenshot()
