"""``opacity`` by transfer functions and by arrays: what is seen against arithmetic, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest

from pvfiblets.streamlines import Streamlines

FLAT = {"lighting": False, "line_width": 6.0, "show_scalar_bar": False}
N = 61


def rows(opacity=None, **data):
    """Three lines along x in the plane of the picture, one over the other on the screen."""
    x = np.linspace(-10, 10, N)
    return Streamlines.from_list([np.c_[x, 0 * x + 5.0 * row, 0 * x] for row in (-1, 0, 1)], **data)


def columns(plotter, at=(0.25, 0.5, 0.75)):
    """(row, column, rgb): colours of the three lines, the lowest first, at places along them."""
    plotter.enable_parallel_projection()
    plotter.view_xy()
    picture = plotter.screenshot(None).astype(float)
    h, w = picture.shape[:2]
    scale = plotter.camera.parallel_scale
    pixel = h / 2 / scale
    y = [round(h / 2 - 5.0 * row * pixel) for row in (-1, 0, 1)]
    x = [round(w / 2 + (20 * a - 10) * pixel) for a in at]
    return picture[np.ix_(y, x)]


def test_one_opacity_per_streamline(plotter):
    actor = plotter.add_fiblets(rows(), opacity=[0.2, 0.5, 1.0], color="white", **FLAT)
    assert np.abs(columns(plotter)[:, 1, 0] - [51, 127.5, 255]).max() <= 2
    actor.opacity = 0.5  # times
    assert np.abs(columns(plotter)[:, 1, 0] - [25.5, 64, 127.5]).max() <= 2
    assert list(actor.opacity_by) == [0.2, 0.5, 1.0]
    assert actor.opacity == 0.5
    twin = actor.copy()
    assert list(twin.opacity_by) == [0.2, 0.5, 1.0]
    assert twin.opacity == 0.5
    actor.opacity_by, actor.opacity = None, 1.0
    assert np.abs(columns(plotter)[:, 1, 0] - 255).max() <= 1


@pytest.mark.few(1)
@pytest.mark.parametrize("transparency", ["all", "layers", None])
def test_one_opacity_per_point(plotter, transparency):
    fade = np.tile(np.linspace(0.0, 1.0, N), 3)
    plotter.add_fiblets(rows(), opacity=fade, color="white", transparency=transparency, **FLAT)
    assert np.abs(columns(plotter)[..., 0] - [[64, 127.5, 191]]).max() <= 6


def test_opacity_by_the_name_of_an_array(plotter):
    streamlines = rows(per_streamline={"weight": np.array([0.1, 0.4, 0.8])})
    streamlines.per_point = {"fa": np.tile(np.linspace(1.0, 0.0, N), 3).astype("f4")}
    actor = plotter.add_fiblets(streamlines, opacity="weight", color="white", per_point=["fa"], **FLAT)
    assert np.abs(columns(plotter)[:, 1, 0] - [25.5, 102, 204]).max() <= 2
    actor.opacity = "fa"
    assert np.abs(columns(plotter)[..., 0] - [[191, 127.5, 64]]).max() <= 6
    actor.scalars = "fa"  # the same number colours
    actor.cmap = ["white", "white"]
    assert np.abs(columns(plotter)[..., 0] - [[191, 127.5, 64]]).max() <= 6
    with pytest.raises(ValueError, match="one number at points goes with a picture"):
        actor.scalars = "arc_length"
    assert actor.scalars == "fa"


@pytest.mark.few(4)
@pytest.mark.parametrize("opacity", ["linear", "sigmoid", "geom_r", [0.0, 0.8, 0.4, 0.0]])
@pytest.mark.parametrize("transparency", ["all", None])
def test_a_transfer_function_fades_along_the_map(plotter, opacity, transparency):
    from matplotlib.colors import LinearSegmentedColormap
    from pyvista.plotting.tools import opacity_transfer_function

    white = LinearSegmentedColormap.from_list("white", ["white", "white"])
    actor = plotter.add_fiblets(
        rows(), scalars=[0.1, 0.5, 0.9], clim=(0, 1), cmap=white, opacity=opacity, transparency=transparency,
        **FLAT,
    )  # fmt: skip
    table = opacity_transfer_function(opacity, 256, kind="quadratic").astype(float)
    expected = [table[int(value * 256)] for value in (0.1, 0.5, 0.9)]
    assert np.abs(columns(plotter)[:, 1, 0] - expected).max() <= 4
    assert actor.opacity == 1.0
    for count in (4, 7, 256):  # PyVista takes as many for bytes: numbers from 0 to 1 would be next to nothing
        actor = plotter.add_fiblets(rows(), scalars=[0.1, 0.5, 0.9], n_colors=4, opacity=np.linspace(1.0, 0.0, count))
        np.testing.assert_allclose(actor.lookup_table.values[:, 3] / 255.0, np.linspace(1.0, 0.0, 4), atol=1.0 / 255.0)


def test_lines_of_different_opacity_behind_each_other(plotter):
    """Four lines in one place: what they let through is the product, and each counts by its own."""
    x = np.linspace(-10, 10, N)
    lines = [np.c_[x, 0 * x, -k + 0 * x] for k in range(4)]
    opacity = np.array([0.3, 0.0, 0.6, 0.2])
    colours = np.array([[255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 255, 255]], np.uint8)
    plotter.add_fiblets(lines, scalars=colours, opacity=opacity, **FLAT)
    plotter.enable_parallel_projection()
    plotter.view_xy()
    found = plotter.screenshot(None)[100, 100].astype(float)
    through, expected = 1.0, np.zeros(3)
    for o, c in zip(opacity, colours.astype(float), strict=True):
        expected += through * o * c
        through *= 1.0 - o
    assert abs(found.sum() - expected.sum()) < 40  # those of a slice are mixed
    assert np.abs(found - expected).max() < 30
    assert found[1] < 40


@pytest.mark.parametrize(
    ("opacity", "error", "message"),
    [("fog", KeyError, "there is no opacity 'fog'"), ("linear", ValueError, "follows the numbers of a colour map"),
     ([0.1, 2.0, 0.3], ValueError, "between 0 and 2"), (np.zeros((3, 3)), ValueError, "one per streamline"),
     (1.5, ValueError, "opacity is 1.5")],
)  # fmt: skip
def test_nonsense_is_refused_in_words(plotter, opacity, error, message):
    with pytest.raises(error, match=message):
        plotter.add_fiblets(rows(), opacity=opacity, **FLAT)
    assert not plotter.actors


@pytest.mark.parametrize("add", ["add_spline_tubes", "add_halo_lines"])
def test_tubes_and_halos_fade_along_the_colour_map(plotter, three_lines, add, colours_in):
    looks = {"radius": 1.5} if add == "add_spline_tubes" else {"line_width": 3.0, "strip_width": 3.0, "smooth": False}
    looks |= {"cmap": ["red", "red"], "lighting": False, "show_scalar_bar": False, "scalars": "weight"}
    looks["log_scale"] = True
    for opacity in ([0.0, 0.5, 1.0], np.array([127, 255], np.uint8)):
        given = {"opacity": opacity} if np.ndim(opacity) else {}
        actor = getattr(plotter, add)(three_lines, n_colors=2, **looks, **given)
        plotter.view_isometric()
        plotter.show(auto_close=False)
        plotter.render()
        reds = {colour[0] for colour in colours_in(plotter.screenshot(None)) if colour[1] == colour[2] == 0}
        assert 255 in reds
        assert reds & {127, 128}
        twin = actor.copy()
        assert np.array_equal(twin.opacity_by, opacity)
        plotter.remove_actor(actor)
    actor = getattr(plotter, add)(three_lines, opacity="linear", **looks)
    assert actor.lookup_table.values[0, 3] == 0
    actor.opacity_by = None
    assert (actor.lookup_table.values[:, 3] == 255).all()
    actor.opacity = 0.25
    assert actor.prop.opacity == actor.opacity == 0.25
    with pytest.raises(ValueError, match="one per point; here there is one per line"):
        actor.opacity_by = np.linspace(0.0, 1.0, 123)
    actor.scalars = None
    with pytest.raises(ValueError, match="follows the numbers of a colour map"):
        getattr(plotter, add)(three_lines, opacity="sigmoid", color="red")
