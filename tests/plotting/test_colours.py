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


def test_orientation_is_the_absolute_direction_as_red_green_blue(plotter, three_lines, shown):
    plotter.add_fiblets(three_lines, **FLAT)
    assert close_to(shown(plotter), {(255, 0, 0), (0, 255, 0), (0, 0, 255)})


def test_a_solid_colour_is_that_colour(plotter, three_lines, shown):
    plotter.add_fiblets(three_lines, color="orange", **FLAT)
    assert close_to(shown(plotter), {pv.Color("orange").int_rgb})


@pytest.mark.parametrize("kind", [np.uint8, np.float64])
def test_one_colour_per_streamline(plotter, three_lines, kind, shown):
    colours = np.array([[255, 0, 0], [20, 200, 40], [250, 250, 5]])
    given = colours.astype(np.uint8) if kind is np.uint8 else colours / 255.0
    plotter.add_fiblets(three_lines, scalars=given, **FLAT)
    assert close_to(shown(plotter), {tuple(colour) for colour in colours.tolist()})


def test_per_streamline_numbers_go_through_the_colour_map(plotter, three_lines, shown):
    plotter.add_fiblets(three_lines, scalars="weight", cmap="plasma", clim=(0, 100), **FLAT)
    assert close_to(shown(plotter), {mapped("plasma", f) for f in (0.01, 0.1, 1.0)})


def test_a_logarithmic_scale_spreads_decades_evenly(plotter, three_lines, shown):
    plotter.add_fiblets(three_lines, scalars="weight", cmap="plasma", log_scale=True, **FLAT)
    assert close_to(shown(plotter), {mapped("plasma", f) for f in (0.0, 0.5, 1.0)}, tolerance=4)


def test_few_colours_are_few(plotter, three_lines, shown):
    plotter.add_fiblets(three_lines, scalars=[0.0, 0.4, 1.0], cmap="viridis", n_colors=4, **FLAT)
    assert close_to(shown(plotter), {mapped("viridis", f, 4) for f in (0.0, 0.4, 1.0)})


def test_nan_and_what_lies_outside_have_their_own_colours(plotter, three_lines, shown):
    plotter.add_fiblets(
        three_lines,
        scalars=[np.nan, -5.0, 5.0],
        clim=(0, 1),
        nan_color="magenta",
        below_color="cyan",
        above_color="yellow",
        **FLAT,
    )
    assert close_to(shown(plotter), {(255, 0, 255), (0, 255, 255), (255, 255, 0)})


def test_lengths_are_those_of_the_lines(plotter, shown):
    lines = [np.linspace((0, y, 0), (length, y, 0), 60) for y, length in ((0, 30.0), (5, 15.0))]
    actor = plotter.add_fiblets(lines, scalars="length", cmap="viridis", **FLAT)
    assert actor.clim == pytest.approx((15.0, 30.0), rel=1e-3)
    assert close_to(shown(plotter), {mapped("viridis", f) for f in (0.0, 1.0)}, tolerance=4)


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


def test_an_array_with_a_number_per_point(plotter, three_lines, shown):
    values = np.repeat([0.0, 0.5, 1.0], 41)
    plotter.add_fiblets(three_lines, scalars=values, cmap="viridis", **FLAT)
    assert close_to(shown(plotter), {mapped("viridis", f) for f in (0.0, 0.5, 1.0)}, tolerance=4)


def test_all_values_alike_or_all_nan_still_draw(plotter, three_lines, shown):
    plotter.add_fiblets(three_lines, scalars=[7.0, 7.0, 7.0], name="same", **FLAT)
    assert len(shown(plotter)) == 1
    plotter.add_fiblets(three_lines, scalars=[np.nan] * 3, nan_color="red", name="same", **FLAT)
    assert close_to(shown(plotter), {(255, 0, 0)})


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
    ],
)
def test_nonsense_is_refused_in_words(plotter, three_lines, arguments, message):
    with pytest.raises(ValueError, match=message):
        plotter.add_fiblets(three_lines, **arguments)
    assert not plotter.actors


def test_an_unknown_name_lists_those_that_exist(plotter, three_lines):
    with pytest.raises(KeyError, match=r"no array 'fa'.*'weight'.*'curvature'"):
        plotter.add_fiblets(three_lines, scalars="fa")


def test_no_streamlines_is_a_picture_of_nothing(plotter, colours_in):
    with pytest.warns(UserWarning, match="no streamlines"):
        plotter.add_fiblets(Streamlines(np.zeros((0, 3)), [0]), scalars="length", show_scalar_bar=False)
    assert not colours_in(plotter.screenshot(None))


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


@pytest.mark.parametrize("name", ["line_width", "tube_radius"])
def test_a_length_that_is_a_word_is_named(plotter, three_lines, name):
    actor = plotter.add_fiblets(three_lines)
    with pytest.raises(ValueError, match=rf"{name} is 'x'; give .* above 0"):
        setattr(actor, name, "x")
