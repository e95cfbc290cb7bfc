"""Lines and points with halos among VTK's meshes, cuts, passes and pickers, against closed forms."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import pyvista as pv
from vtkmodules.vtkRenderingCore import vtkActor

from pvfiblets.halos import HaloLines, HaloPoints, HaloStyle
from pvfiblets.mappers import Colouring, HaloMapper, HaloOptions
from pvfiblets.mappers.halos import Strips

PIXELS = 5.0  # a mm, in the view `flat`
LOOK = HaloStyle(2.0, 8.0, 4.0, n_tapered=0, min_width=0.0, smooth=False)
GREEN = (0, 255, 0)
WHITE = (255, 255, 255)
BLACK = (0, 0, 0)
BACK = (64, 64, 64)


def lines_of(*lines, **values):
    points = [np.asarray(line, float) for line in lines]
    offsets = np.cumsum([0] + [len(line) for line in points])
    return HaloLines(np.concatenate(points), offsets, {k: np.asarray(v) for k, v in values.items()})


def bar(z=0.0, depth=0.0, **values):
    """A line of two segments along x, from -15 to 15."""
    return lines_of([(-15, depth, z), (0, depth, z), (15, depth, z)], **values)


def made(drawn, look=LOOK, **options):
    options.setdefault("colouring", Colouring("solid", color=(0, 1, 0)))
    mapper, actor = HaloMapper(drawn, look, **options), vtkActor()
    mapper.attach(actor)
    actor.GetProperty().SetLighting(False)
    return mapper, actor


def flat(plotter, height=40.0):
    """From -y, parallel: 200 pixels are `height` mm; depths are y."""
    plotter.camera_position = [(0, -100, 0), (0, 0, 0), (0, 0, 1)]
    plotter.enable_parallel_projection()
    plotter.camera.parallel_scale = height / 2
    plotter.camera.clipping_range = 20, 200
    plotter.set_background([part / 255 for part in BACK])
    return plotter


def shown(make_plotter, *actors, **options):
    plotter = make_plotter(**options)
    for actor in actors:
        plotter.add_actor(actor, reset_camera=False)
    return flat(plotter)


def column_at(image, x):
    """A column of a picture of the view `flat`, and the z of its pixels."""
    height, width = image.shape[:2]
    column = image[:, round(width / 2 + PIXELS * x)]
    return column, (height / 2 - 0.5 - np.arange(height)) / PIXELS


def same(column, colour):
    return (column == np.array(colour, np.uint8)).all(axis=-1)


def test_a_line_has_its_colour_its_halo_another_and_the_rest_is_left_alone(make_plotter, tools):
    mapper, actor = made(bar())
    image = tools.picture(shown(make_plotter, actor), mapper)
    column, z = column_at(image, 7.0)
    across = np.abs(z)
    assert same(column[across < 1.0], GREEN).all()
    assert same(column[(across > 1.0) & (across < 4.0)], WHITE).all()
    assert same(column[across > 4.0], BACK).all()
    column, z = column_at(image, 16.0)  # ends are square
    assert same(column, BACK).all()
    mapper, actor = made(bar(z=21.0))  # beside the picture
    column, z = column_at(tools.picture(shown(make_plotter, actor), mapper), 7.0)
    assert same(column[z > 17.0], WHITE).all()
    assert same(column[z < 17.0], BACK).all()


def test_points_are_discs_in_discs(make_plotter, tools):
    mapper, actor = made(HaloPoints(np.array([(0.0, 0.0, 0.0), (10.0, 0.0, 0.0)])))
    image = tools.picture(shown(make_plotter, actor), mapper)
    rows, columns = np.mgrid[:200, :240]
    for x in (0.0, 10.0):
        r = np.hypot((columns + 0.5 - 120) / PIXELS - x, (99.5 - rows) / PIXELS)
        assert same(image[r < 0.98], GREEN).all()
        assert same(image[(r > 1.02) & (r < 3.98)], WHITE).all()
    assert same(image[(np.hypot(columns - 119.5, rows - 99.5) > 4.1 * PIXELS) & (columns < 140)], BACK).all()


@pytest.mark.parametrize("behind", [0.0, 0.5, 1.5, 2.5, 3.5, 6.0])
def test_halos_have_a_depth_among_meshes(make_plotter, tools, behind):
    """A wall shows through where the halo has gone back further than it: r dmax > behind."""
    mapper, actor = made(bar())
    plotter = shown(make_plotter, actor)
    wall = pv.Plane(center=(0, behind + 1e-3, 0), direction=(0, 1, 0), i_size=60, j_size=60)
    plotter.add_mesh(wall, color="red", lighting=False, reset_camera=False)
    column, z = column_at(tools.picture(flat(plotter), mapper), 7.0)
    r = np.abs(z) / 4.0
    halo = (np.abs(z) > 1.0) & (r < 1.0) & (4.0 * r < behind + 1e-3)
    assert same(column[np.abs(z) < 1.0], GREEN).all()
    assert same(column[halo], WHITE).all()
    assert same(column[~halo & (np.abs(z) > 1.0)], (255, 0, 0)).all()


@pytest.mark.parametrize("apart", [0.5, 2.0, 3.0, 9.0])
def test_two_actors_cut_gaps_into_each_other_as_two_lines_of_one_do(make_plotter, tools, apart):
    upright = [(3, apart, -15), (3, apart, 15)]
    one, lone = made(lines_of([(-15, 0, 0), (15, 0, 0)], upright))
    together = tools.picture(shown(make_plotter, lone), one)
    (first, a), (second, b) = made(lines_of([(-15, 0, 0), (15, 0, 0)])), made(lines_of(upright))
    apart_ = tools.picture(shown(make_plotter, a, b), first, second)
    assert (together != apart_).any(-1).mean() < 1e-3
    column, z = column_at(together, 3.0)
    gap = same(column, WHITE).sum() / PIXELS / 2  # on either side: appendix A
    assert gap == pytest.approx(np.clip((8 * min(apart / 4, 1) - 2) / 2, 0, 3), abs=1.5 / PIXELS)


def test_bounds_hold_the_strips_and_the_camera_takes_them(make_plotter, tools):
    mapper, actor = made(bar(), replace(LOOK, strip_width=12.0))
    assert actor.GetBounds() == pytest.approx((-21, 21, -6, 6, -6, 6), abs=1e-6)
    mapper.look = replace(LOOK, strip_width=20.0)
    assert actor.GetBounds() == pytest.approx((-25, 25, -10, 10, -10, 10), abs=1e-6)
    plotter = make_plotter()
    plotter.add_actor(actor)
    plotter.view_xz()
    image = tools.covered(tools.picture(plotter, mapper))
    assert image.sum() > 1000
    assert not image[[0, -1]].any()
    assert not image[:, [0, -1]].any()


def test_places_are_picked_and_halos_are_not(make_plotter, tools):
    drawn = lines_of([(-15, 0, 0), (0, 0, 0), (15, 0, 0)], [(10, 6, 15), (10, 6, -15)])
    mapper, actor = made(drawn)
    plotter = shown(make_plotter, actor)
    assert mapper.pick_at(120, 100) is None
    tools.picture(plotter, mapper)
    for column in (60, 119, 121, 180):
        line, place = mapper.pick_at(column, 100, tolerance=0)
        assert (line, place) == (0, pytest.approx(((column + 0.5 - 120) / PIXELS + 15) / 15, abs=1e-3))
    assert mapper.pick_at(150, 110, tolerance=0) is None  # the halo
    assert mapper.pick_at(170, 110, tolerance=0) is None  # the halo, before the other line
    assert mapper.pick_at(150, 106, tolerance=2)[0] == 0
    line, place = mapper.pick_at(170, 150)
    assert (line, place) == (1, pytest.approx(((15 - (150.5 - 100) / PIXELS) / 30), abs=1e-3))
    assert mapper.pick_at(170, 150, tolerance=-1) is None
    assert mapper.pick_at(-50, 500) is None
    mapper, actor = made(HaloPoints(np.array([(-10.0, 0, 0), (0.0, 0, 0), (10.0, 0, 0)])))
    tools.picture(shown(make_plotter, actor), mapper)
    assert [mapper.pick_at(70 + 50 * i, 100) for i in range(3)] == [0, 1, 2]  # points by their numbers
    assert mapper.pick_at(130, 100, tolerance=0) is None
    assert mapper.pick_at(130, 100, tolerance=6) == 1


def pixel(image, x, z):
    column, places = column_at(image, x)
    return tuple(column[np.argmin(np.abs(places - z))].tolist())


def test_smooth_lines_turn_into_their_halo_over_a_pixel(make_plotter, tools):
    """A line 10.5 pixels wide covers half of half a pixel more on both sides."""
    look = replace(LOOK, line_width=2.1, smooth=True)
    mapper, actor = made(bar(), look, colouring=Colouring("solid", color=(0, 0, 0)))
    plotter = shown(make_plotter, actor)
    column, z = column_at(tools.picture(plotter, mapper), 7.0)
    ink = np.clip(0.5 - (np.abs(z) * PIXELS - 5.25), 0, 1)
    inside = np.abs(z) < 4.0
    assert np.abs(column[inside, 0] / 255.0 - (1 - ink[inside])).max() < 0.01
    assert ((ink > 0.1) & (ink < 0.9)).any()


def test_halos_of_the_background_take_part_in_its_gradient(make_plotter, tools):
    mapper, actor = made(bar(z=9.0), halo_color=None)
    plotter = shown(make_plotter, actor)
    plotter.set_background("red", top="blue")
    image = tools.picture(plotter, mapper).astype(int)
    column, z = column_at(image, 7.0)
    beside, _ = column_at(image, 20.0)
    assert np.abs(column - beside)[np.abs(z - 9.0) > 1.0].max() <= 1
    assert pixel(image, 7.0, 9.0) == GREEN
    mapper.halo_color = (1.0, 1.0, 0.0)
    assert pixel(tools.picture(plotter, mapper), 7.0, 11.0) == (255, 255, 0)
    assert mapper.halo_color == (1.0, 1.0, 0.0)


def test_what_is_no_colour_or_option_is_refused():
    for color in ((1.0, 2.0, 0.0), (1.0, 0.0)):
        with pytest.raises(ValueError, match="color of halos is "):
            Strips(color)
    assert HaloOptions("none") == HaloOptions(None)
    assert (HaloOptions(None).changed(), HaloOptions().changed()) == ({"culling": None}, {})
    with pytest.raises(ValueError, match="culling is 'coverage'"):
        HaloOptions("coverage")


def test_light_falls_on_lines_and_not_on_halos(make_plotter, tools):
    mapper, actor = made(bar())
    actor.GetProperty().SetLighting(True)
    actor.GetProperty().SetAmbient(0.0)
    plotter = shown(make_plotter, actor)
    plotter.remove_all_lights()
    lamp = pv.Light(position=(0, -100, 100), focal_point=(0, 0, 0), light_type="scene light")
    lamp.positional = False
    plotter.add_light(lamp)
    column, z = column_at(tools.picture(plotter, mapper), 7.0)
    lit = column[np.abs(z) < 1.0]
    assert np.abs(lit[:, 1] - 255 * np.sqrt(0.5)).max() <= 2
    assert same(column[(np.abs(z) > 1.0) & (np.abs(z) < 4.0)], WHITE).all()


def test_translucent_actors_blend_lines_and_halos_alike_and_colours_keep_opaque_halos(make_plotter, tools):
    mapper, actor = made(bar())
    actor.GetProperty().SetOpacity(0.5)
    plotter = shown(make_plotter, actor)
    image = tools.picture(plotter, mapper).astype(int)
    assert np.abs(np.array(pixel(image, 7.0, 0.1)) - [32, 159, 32]).max() <= 2
    assert np.abs(np.array(pixel(image, 7.0, 2.0)) - [159] * 3).max() <= 2
    actor.GetProperty().SetOpacity(1.0)
    mapper.colouring = Colouring("streamline_rgba", values=np.array([[0, 255, 0, 128]], np.uint8))
    image = tools.picture(plotter, mapper).astype(int)
    assert actor.GetForceTranslucent()
    assert np.abs(np.array(pixel(image, 7.0, 0.1)) - [32, 160, 32]).max() <= 2
    assert pixel(image, 7.0, 2.0) == WHITE


def test_actors_that_are_stretched_have_strips_as_wide(make_plotter, tools):
    """Scaled by 2 all around: lengths are of the data, and the picture is that of half the distance."""
    mapper, actor = made(bar())
    actor.SetScale(2.0)
    plotter = shown(make_plotter, actor)
    column, z = column_at(tools.picture(plotter, mapper), 7.0)
    assert same(column[np.abs(z) < 2.0], GREEN).all()
    assert same(column[(np.abs(z) > 2.0) & (np.abs(z) < 8.0)], WHITE).all()
    assert same(column[np.abs(z) > 8.0], BACK).all()


def test_numbers_that_are_not_there_are_refused_when_drawn(make_plotter):
    mapper, actor = made(bar(), replace(LOOK, filter_by="height"))
    plotter = shown(make_plotter, actor)
    plotter.show(auto_close=False)
    with pytest.raises(Exception, match="no values 'height'"):
        mapper.raise_pending()
