"""Numbers far from 0 for their range are drawn, filtered and picked as the same numbers near 0."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

from pvfiblets import Streamlines
from pvfiblets.support.value_reference import relative, value_reference
from pvfiblets.volumes import as_raycast_volume

UNIX, JULIAN = 1.7e9, 2460000.5
T = np.linspace(0, 6, 60)
LINE = np.stack([np.cos(T), np.sin(T), T / 5], 1)
LINES = [LINE, LINE + 1]


def picture(draw, clim=None, picks=None, **settings):
    plotter = pv.Plotter(off_screen=True, window_size=(150, 110))
    plotter.picture.antialias = "off"
    actor = draw(plotter, clim=clim, show_scalar_bar=False, **settings)
    image = plotter.screenshot(return_img=True).astype(int)
    if picks is not None:
        picks.append(actor.pick_at(75, 55))
    plotter.close()
    return image, actor


def halos(plotter, **settings):
    return plotter.add_halo_lines(LINES, line_width=0.1, strip_width=0.3, **settings)


def tubes(plotter, **settings):
    return plotter.add_spline_tubes(LINES, radius=0.1, **settings)


def fiblets(plotter, **settings):
    return plotter.add_fiblets(LINES, line_width=5, **settings)


@pytest.mark.parametrize("offset", [UNIX, JULIAN])
@pytest.mark.parametrize("draw", [halos, tubes])
def test_colours_of_points(draw, offset):
    near, _ = picture(draw, scalars=[LINE[:, 2]] * 2)
    far, actor = picture(draw, scalars=[LINE[:, 2] + offset] * 2)
    assert (abs(near - far).max(-1) > 3).sum() == 0
    assert actor.clim == pytest.approx((offset, offset + 1.2), rel=1e-15)
    assert len(np.unique(far.reshape(-1, 3), axis=0)) > 60


@pytest.mark.parametrize("kind", ["int32", "int64", "float64"])
@pytest.mark.parametrize("steps", [16, 70000])
def test_colours_of_fiblets_by_an_image(kind, steps):
    numbers = np.linspace(0, steps, 16**3).reshape(16, 16, 16).round().astype(kind)
    affine = np.diag([0.2, 0.2, 0.2, 1.0])
    affine[:3, 3] = -1.0
    near, _ = picture(fiblets, scalars=(numbers, affine))
    far, actor = picture(fiblets, scalars=(numbers + type(numbers.flat[0])(10**8), affine))
    assert actor.clim == (1e8, 1e8 + steps)
    assert (abs(near - far).max(-1) > 3).sum() == 0
    assert len(np.unique(far.reshape(-1, 3), axis=0)) > 15


@pytest.mark.parametrize("looks", [{"style": "density"}, {"opacity": 0.3}], ids=str)
@pytest.mark.parametrize("kind", ["image", "array"])
def test_colours_of_all_lines_of_a_pixel(kind, looks):
    lines = [LINE + 0.02 * i for i in range(8)]
    numbers = np.linspace(0, 64, 16**3).reshape(16, 16, 16).round()
    affine = np.diag([0.2, 0.2, 0.2, 1.0])
    affine[:3, 3] = -1.0

    def drawn(offset):
        values = [line[:, 2] + offset for line in lines]
        image = kind == "image"
        streamlines = Streamlines.from_list(lines, per_point=None if image else {"z": np.concatenate(values)})
        scalars = (numbers + offset, affine) if image else "z"
        return picture(lambda plotter, **more: plotter.add_fiblets(streamlines, scalars=scalars, **more), **looks)[0]

    near, far = drawn(0.0), drawn(1e8)
    assert (abs(near - far).max(-1) > 3).sum() == 0
    assert len(np.unique(far.reshape(-1, 3), axis=0)) > 15


@pytest.mark.parametrize("draw", [fiblets, halos, tubes])
def test_colours_of_lines(draw):
    near, _ = picture(draw, scalars=[0.0, 2.0])
    far, actor = picture(draw, scalars=[UNIX, UNIX + 2.0])
    assert actor.clim == (UNIX, UNIX + 2.0)
    assert (near == far).all()


def test_halo_threshold():
    values = [LINE[:, 2]] * 2
    near, _ = picture(halos, filter_by=values, threshold=0.5)
    far, _ = picture(halos, filter_by=[v + UNIX for v in values], threshold=UNIX + 0.5)
    whole, _ = picture(halos)
    assert (abs(near - far).max(-1) > 3).sum() == 0
    assert (near != whole).any()


def test_logarithms_of_far_values():
    # Over a range so narrow, logarithms are linear to 1e-9.
    straight, _ = picture(tubes, scalars=[LINE[:, 2] + UNIX] * 2)
    log, _ = picture(tubes, scalars=[LINE[:, 2] + UNIX] * 2, log_scale=True)
    assert (abs(straight - log).max(-1) > 3).sum() == 0


@pytest.mark.parametrize("kind", ["int32", "float64"])
@pytest.mark.parametrize("settings", [{"mode": "isosurface", "values": 50}, {"mode": "mip"}, {}])
def test_volume(kind, settings):
    x = np.linspace(-1, 1, 16)
    ball = (100 * (1 - np.sqrt(x[:, None, None] ** 2 + x[:, None] ** 2 + x**2))).round().astype(kind)

    def add(plotter, clim, offset=0, **more):
        return plotter.add_raycast_volume(ball + type(ball[0, 0, 0])(offset), clim=clim, **more)

    picks = []
    near, here = picture(add, (0, 100), picks, **settings)
    moved = {name: value + 10**8 if name == "values" else value for name, value in settings.items()}
    far, there = picture(add, (1e8, 1e8 + 100), picks, offset=10**8, **moved)
    assert (abs(near - far).max(-1) > 2).sum() == 0
    assert there.volume.value_range == tuple(end + 1e8 for end in here.volume.value_range)
    assert (there.volume.numbers == ball.astype(float) + 1e8).all()
    assert picks[1].value == pytest.approx(picks[0].value + 1e8, abs=1e-3)


def test_cell_data_of_a_volume():
    grid = pv.ImageData(dimensions=(4, 4, 4))
    grid.cell_data["v"] = 10**8 + np.arange(27)
    volume = as_raycast_volume(grid)
    assert volume.value_range == (1e8, 1e8 + 26)
    assert volume.least_positive == 1e8


def test_reference_of_ordinary_arrays_is_zero():
    assert value_reference(np.arange(1000.0)) == 0.0
    assert value_reference(np.r_[-9999.0, np.linspace(0, 1, 999)]) == 0.0
    assert value_reference(np.full(9, 7.0)) == 0.0
    assert value_reference(np.array([np.nan, np.inf])) == 0.0
    times = np.r_[-9999, 1_700_000_000 + np.arange(999)]
    reference = value_reference(times)
    assert reference == int(reference)
    assert (relative(times, reference).astype(np.float32)[1:].astype(float) + reference == times[1:]).all()
