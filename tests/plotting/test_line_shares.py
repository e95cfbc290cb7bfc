"""Smooth edges: a pixel shows as much of a line as the line covers of it, by whatever the line is drawn.

The truth is a closed form. A line of width w covers of a pixel what lies between two half planes; of a square with
sides along the axes, whose centre is d beyond a half plane's border along its normal n, the half plane takes

    (r(h)^2 - r(h - a)^2 - r(h - b)^2 + r(h - a - b)^2) / 2ab,
    a = |n_x|, b = |n_y|, h = (a + b) / 2 - d, r(x) = max(x, 0).
"""

from __future__ import annotations

import moderngl
import numpy as np
import pytest

SIZE = (64, 48)
HALF = 18.3  # pixels, half the line's length
ANGLES = (0.0, 7.0, 26.6, 45.0, 71.0, 90.0, 122.0)
PIPELINES = ("compute", "tessellation", "geometry")
STEP = 1.0 / 16.0  # of shares


def share_below(normal, away):
    """Return the share of pixels whose centres are some pixels away from a half plane's border, outwards."""
    a, b = np.abs(normal)
    h = 0.5 * (a + b) - np.asarray(away)
    if min(a, b) < 1e-9:
        return np.clip(h / max(a, b), 0.0, 1.0)
    square = [np.maximum(x, 0.0) ** 2 for x in (h, h - a, h - b, h - a - b)]
    return np.clip((square[0] - square[1] - square[2] + square[3]) / (2.0 * a * b), 0.0, 1.0)


def line_at(degrees):
    """Return where a line begins, and its unit vector, in pixels from the picture's middle."""
    along = np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees))])
    return np.array([0.13, 0.37]) - HALF * along, along


def exact(degrees, width):
    """Return pixels' shares, row 0 below, and where neither end of the line has a part in them."""
    begin, along = line_at(degrees)
    normal = np.array([-along[1], along[0]])
    y, x = np.mgrid[: SIZE[1], : SIZE[0]] + 0.5 - np.array(SIZE[::-1])[:, None, None] / 2.0
    away = (x - begin[0]) * normal[0] + (y - begin[1]) * normal[1]
    place = (x - begin[0]) * along[0] + (y - begin[1]) * along[1]
    margin = 0.5 * width + 3.0
    shares = share_below(normal, away - 0.5 * width) - share_below(normal, away + 0.5 * width)
    return shares, (place > margin) & (place < 2.0 * HALF - margin)


def add_lines(plotter, points, width, pipeline):
    plotter.add_fiblets([points], line_width=width, pipeline=pipeline, **WHITE)


def add_line_tubes(plotter, points, width, pipeline):
    plotter.add_fiblets([points], pipeline=pipeline, **WHITE).tube_radius = width / 2.0


def add_halos(plotter, points, width, _):
    plotter.add_halo_lines(
        [points], color="white", halo_color="black", line_width=width, strip_width=width + 6.0, min_width=0,
        width_cue=0.0, name="line",
    )  # fmt: skip


def add_spline_tubes(plotter, points, width, _):
    plotter.add_spline_tubes([points], radius=width / 2.0, min_width=0, **WHITE)


WHITE = {"color": "white", "lighting": False, "show_scalar_bar": False, "name": "line"}


CASES = [(add_lines, pipeline) for pipeline in PIPELINES] + [(add_line_tubes, pipeline) for pipeline in PIPELINES]
CASES += [(add_halos, "strips"), (add_spline_tubes, "rays")]
ONE_PIPELINE = [CASES[0], CASES[3], *CASES[6:]]


@pytest.mark.few(2)
@pytest.mark.parametrize("width", [0.6, 1.0, 4.0])
@pytest.mark.parametrize(("add", "pipeline"), [*CASES[3:6], CASES[7]])
def test_tubes_that_are_slanted_to_the_view_are_as_wide(plotter, add, pipeline, width):
    """Nearest points of slanted tubes lie ahead of where the silhouette is; the truth is the mean of many pictures."""
    along = np.array([np.cos(0.5), np.sin(0.5), 0.5])
    add(plotter, np.linspace(-18.0, 18.0, 60)[:, None] * along, width, pipeline)
    plotter.window_size = SIZE
    plotter.enable_parallel_projection()
    plotter.camera_position = [(0, 0, 100), (0, 0, 0), (0, 1, 0)]
    plotter.camera.parallel_scale = SIZE[1] / 2
    plotter.renderer.ResetCameraClippingRange()
    shown = {}
    for how in ("coverage", 64):
        plotter.picture.antialias = how
        plotter.show(auto_close=False) if plotter._first_time else plotter.render()
        shown[how] = np.asarray(plotter.screenshot(None))[..., 0] / 255.0
    touched = shown[64] > 0.0
    assert np.sqrt(((shown["coverage"] - shown[64])[touched] ** 2).mean()) < 0.15
    assert shown["coverage"].sum() == pytest.approx(shown[64].sum(), rel=0.12)


@pytest.mark.parametrize("add", ["halos", "tapering halos", "tubes"])
def test_crowded_lines_err_much_less_than_hard_edges(plotter, add):
    """Lines before lines, ends of lines, and lines that taper; the truth is the mean of pictures with hard edges."""
    lines = smooth_lines(60, seed=5)
    if add == "tubes":
        plotter.add_spline_tubes(lines, radius=1.0, **WHITE | {"lighting": True})
    else:
        colours = {"color": "white", "halo_color": "gray"}
        tapering = add == "tapering halos"
        plotter.add_halo_lines(lines, line_width=2, strip_width=10, tapering=tapering, smooth=False, **colours)
    plotter.window_size = 160, 120
    plotter.enable_parallel_projection()
    plotter.camera_position = [(0, 0, 200), (0, 0, 0), (0, 1, 0)]
    plotter.camera.parallel_scale = 60
    plotter.renderer.ResetCameraClippingRange()
    shown = {}
    for how in ("off", "coverage", 64):
        plotter.picture.antialias = how
        plotter.show(auto_close=False) if plotter._first_time else plotter.render()
        shown[how] = np.asarray(plotter.screenshot(None)).astype(float)
    off, coverage = (np.sqrt(((shown[how] - shown[64]) ** 2).mean()) for how in ("off", "coverage"))
    assert coverage < 0.6 * off


def smooth_lines(n, *, seed):
    """Return curved lines in a box of 120 mm, of 40 points each, which cross each other."""
    random = np.random.default_rng(seed)
    t = np.linspace(-1.0, 1.0, 40)[:, None]
    curves = random.normal(size=(n, 4, 3)) * np.array([25.0, 30.0, 10.0, 10.0])[:, None]
    return [a + t * b + t**2 * c + t**3 * d for a, b, c, d in curves]


@pytest.fixture
def found(plotter):
    """Return a function: the shares that a picture shows, one pixel to a millimetre."""
    plotter.window_size = SIZE
    plotter.enable_parallel_projection()
    plotter.camera_position = [(0, 0, 100), (0, 0, 0), (0, 1, 0)]
    plotter.camera.parallel_scale = SIZE[1] / 2

    def draw(add, degrees, width, pipeline, antialias):
        begin, along = line_at(degrees)
        points = np.zeros((40, 3))
        points[:, :2] = begin + np.linspace(0.0, 2.0 * HALF, 40)[:, None] * along
        add(plotter, points, width, pipeline)
        plotter.picture.antialias = antialias
        plotter.camera_position = [(0, 0, 100), (0, 0, 0), (0, 1, 0)]
        plotter.camera.parallel_scale = SIZE[1] / 2
        plotter.renderer.ResetCameraClippingRange()
        plotter.show(auto_close=False) if plotter._first_time else plotter.render()
        return np.asarray(plotter.screenshot(None))[::-1, :, 0] / 255.0

    return draw


def hold(found, add, width, pipeline, antialias, angles=ANGLES):
    """Compare pictures of lines of several slopes with the exact shares."""
    shown = wanted = 0.0
    for degrees in angles:
        picture, (shares, middle) = found(add, degrees, width, pipeline, antialias), exact(degrees, width)
        error = (picture - shares)[middle]
        touched = shares[middle] > 0.0
        assert np.abs(error).max() < 2.0 * STEP, degrees
        assert np.sqrt((error[touched] ** 2).mean()) < 0.5 * STEP, degrees
        assert (picture[middle & (shares > 0.1)] > 0.0).all(), degrees
        shown, wanted = shown + picture[middle].sum(), wanted + shares[middle].sum()
    assert shown == pytest.approx(wanted, rel=0.04)


@pytest.mark.few(2)
@pytest.mark.parametrize("width", [0.5, 1.0, 3.0, 8.0])
@pytest.mark.parametrize(("add", "pipeline"), CASES, ids=[f"{add.__name__[4:]}-{name}" for add, name in CASES])
def test_a_pixel_shows_the_share_that_a_line_covers_while_the_camera_moves(found, add, pipeline, width):
    hold(found, add, width, pipeline, "coverage")


@pytest.mark.few(2)
@pytest.mark.parametrize("width", [0.5, 1.0])
@pytest.mark.parametrize(("add", "pipeline"), ONE_PIPELINE, ids=["lines", "tubes", "halos", "splines"])
def test_pictures_at_rest_are_as_strong(found, add, pipeline, width):
    """OpenGL's own rule makes a slanted line of one pixel thinner, by up to 0.71 at 45 degrees."""
    hold(found, add, width, pipeline, 16, (26.6, 45.0, 122.0))


def test_no_framebuffer_is_made_while_the_camera_moves(plotter, monkeypatch):
    plotter.window_size = SIZE
    add_lines(plotter, np.array([[-10.0, 0.0, 0.0], [0.0, 4.0, 0.0], [10.0, 0.0, 0.0]]), 1.0, "compute")
    plotter.picture.antialias = "coverage"
    plotter.show(auto_close=False)
    made, framebuffer = [], moderngl.Context.framebuffer
    monkeypatch.setattr(
        moderngl.Context, "framebuffer", lambda *given, **more: made.append(1) or framebuffer(*given, **more)
    )
    for turn in range(5):
        if turn == 2:
            made.clear()  # the first frames may make what all others use
        plotter.camera.Azimuth(3.0)
        plotter.render()
    assert made == []


def test_the_closed_form_is_the_area():
    """By counting a fine grid of points."""
    u = (np.arange(400) + 0.5) / 400.0 - 0.5
    x, y = np.meshgrid(u, u)
    for degrees in (3.0, 31.0, 90.0, 140.0):
        n = np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees))])
        for away in (-0.6, -0.2, 0.05, 0.4, 0.7):
            counted = (n[0] * x + n[1] * y + away <= 0.0).mean()
            assert share_below(n, away) == pytest.approx(counted, abs=0.004)
