"""Layers on the screen: blended as arithmetic says, in VTK's passes, and gone where nothing is translucent."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

from pvfiblets.mappers import Colouring
from pvfiblets.mappers.effects.depth_peeling import Layers
from pvfiblets.mappers.effects.line_tubes import Tubes, TubeShading
from pvfiblets.mappers.effects.shading import Halos
from pvfiblets.mappers.frames import windows
from pvfiblets.streamlines import Streamlines

COLOURS = np.array([[255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 255, 0], [255, 0, 255]], np.uint8)


def rows(depths=(0, 10, 20, 30, 40)):
    """Lines along x, one behind the other for who looks along y."""
    x = np.linspace(-40, 40, 161)
    return Streamlines.from_list([np.c_[x, 0 * x + y, 0 * x] for y in depths])


def blended(layers, opacity, background=0.0):
    """Colour of layers, the nearest first, as bytes."""
    colour, through = np.zeros(3), 1.0
    for layer in layers:
        colour += through * opacity * np.asarray(layer, float)
        through *= 1.0 - opacity
    return colour + through * background


@pytest.fixture
def scene(make_plotter, tools):
    """Return a function: a plotter, a mapper and an actor of lines seen along y, with a parallel camera."""

    def make(streamlines, *, opacity=0.4, layers=4, colours=COLOURS, lighting=False, **options):
        fibres = tools.fibres(streamlines)
        if colours is not None:
            options["colouring"] = Colouring("streamline_rgba", values=np.resize(colours, (len(streamlines), 3)))
        mapper, actor = fibres.actor(lighting=lighting, **options)
        actor.GetProperty().SetOpacity(opacity)
        if layers:
            mapper.set_effect("layers", Layers(layers))
        plotter = make_plotter()
        plotter.add_actor(actor, reset_camera=False)
        plotter.enable_parallel_projection()
        # A tenth of a pixel off: rows would lie between two rows of pixels, where a thousandth of a pixel decides.
        off = 0.1 * 100.0 / plotter.window_size[1]
        plotter.camera_position = [(0, -200, off), (0, 20, off), (0, 0, 1)]
        plotter.camera.parallel_scale = 50.0
        plotter.renderer.ResetCameraClippingRange(-100, 100, -150, 150, -100, 100)
        return plotter, mapper, actor

    return make


def engine_of(mapper):
    (slot,) = [context.slots[mapper.GetAddressAsString("")] for context in windows.contexts_with(mapper)]
    return slot.renderer


def holds_layers(mapper):
    return engine_of(mapper)._layers is not None


@pytest.mark.few(2)
@pytest.mark.every("pair")
@pytest.mark.parametrize("peeling", [False, True])
@pytest.mark.parametrize("layers", [2, 4, 5, 8])
@pytest.mark.parametrize("width", [1.0, 6.0])
def test_lines_behind_each_other_blend_as_arithmetic_says(scene, tools, layers, width, peeling):
    plotter, mapper, _ = scene(rows(), layers=layers, line_width=width)
    if peeling:
        plotter.enable_depth_peeling(number_of_peels=20, occlusion_ratio=0.0)
    image = tools.picture(plotter, mapper)
    inside = image[97:104, 60:180].max(axis=0)  # the line is in one of these rows
    assert np.abs(inside - blended(COLOURS[:layers], 0.4)).max() <= 3, inside[50]


@pytest.mark.parametrize("width", [1.0, 4.0])
def test_the_picture_is_that_of_its_layers_composed_by_numpy(scene, tools, width):
    lines = tools.helices(40)
    colours = np.random.default_rng(1).integers(0, 255, (len(lines), 3)).astype(np.uint8)
    plotter, mapper, _ = scene(lines, colours=colours, line_width=width, layers=6, opacity=0.3)
    image = tools.picture(plotter, mapper)
    engine = engine_of(mapper)
    plotter.render_window.MakeCurrent()
    buffer = engine.render_layers(*engine._last, 6)
    width_, height = buffer.size
    depth = np.frombuffer(buffer.depth.read(), "<u4").reshape(6, height, width_)[:, ::-1]
    ids = np.frombuffer(buffer.ids.read(), "<u4").reshape(6, height, width_, 2)[:, ::-1, :, 0]
    expected = np.zeros((height, width_, 3))
    for layer in range(5, -1, -1):  # far to near, in bytes as the framebuffer has them
        drawn = depth[layer] != 0xFFFFFFFF
        expected[drawn] = np.round(0.3 * colours[ids[layer][drawn]] + 0.7 * expected[drawn])
    assert (depth[3] != 0xFFFFFFFF).any()
    assert np.abs(image - expected).max() <= 4


@pytest.mark.parametrize("kind", [None, "tubes", "tube shading"])
def test_every_layer_has_its_own_light(scene, tools, kind):
    """Two lines of different direction cross: the picture is made of both, lit each on its own."""
    t, wide = np.linspace(-40, 40, 161), 14.0 if kind else 7.0
    lines = [np.c_[t, 0 * t - 20, 0.3 * t], np.c_[0.2 * t, (0.2 if kind else 0.9) * t + 25, t]]
    white = np.full((1, 3), 255, np.uint8)

    def shown(*lines, **more):
        plotter, mapper, _ = scene(Streamlines.from_list(lines), lighting=True, colours=white, line_width=wide, **more)
        if kind:
            mapper.set_effect("tubes", Tubes(4.0) if kind == "tubes" else TubeShading())
        return tools.picture(plotter, mapper).astype(float)

    alone = [shown(line, opacity=1.0, layers=None) for line in lines]
    image = shown(*lines, opacity=0.5)
    crossing = tools.covered(alone[0]) & tools.covered(alone[1])
    off = np.abs(image - 0.5 * alone[0] - 0.25 * alone[1])[crossing]
    if kind:
        assert crossing.sum() > 150
        assert np.ptp(alone[1][crossing]) > 40, "lit flat: nothing is shown"
        assert np.percentile(off, 90) <= 4
    else:
        assert crossing.sum() > 30
        assert np.abs(np.median(alone[0][crossing]) - np.median(alone[1][crossing])) > 10, "lit alike"
        assert np.median(off) <= 2


@pytest.mark.parametrize("y", [5.0, 15.0])
def test_peeling_puts_a_translucent_wall_between_layers(scene, tools, y):
    plotter, mapper, _ = scene(rows((0, 10, 20)), layers=4, line_width=6.0)
    plotter.enable_depth_peeling(number_of_peels=20, occlusion_ratio=0.0)
    wall = pv.Plane(center=(0, y, 0), direction=(0, 1, 0), i_size=300, j_size=300)
    plotter.add_mesh(wall, color="white", opacity=0.4, lighting=False, reset_camera=False)
    image = tools.picture(plotter, mapper)
    order = [*COLOURS[:3]]
    order.insert(1 if y < 10 else 2, (255, 255, 255))
    assert np.abs(image[100, 60:180] - blended(order, 0.4)).max() <= 3


def test_an_opaque_mesh_hides_the_layers_behind_it(scene, tools):
    plotter, mapper, _ = scene(rows((0, 10, 20)), line_width=6.0)
    wall = pv.Plane(center=(0, 15, 0), direction=(0, 1, 0), i_size=300, j_size=300)
    plotter.add_mesh(wall, color="white", lighting=False, reset_camera=False)
    image = tools.picture(plotter, mapper)
    assert np.abs(image[100, 60:180] - blended(COLOURS[:2], 0.4, 255.0)).max() <= 3


def test_values_along_a_line_are_those_of_its_layer(scene, tools):
    """The line behind runs the other way: at a pixel its arc length is the rest of the front one's."""
    x = np.linspace(-40, 40, 161)
    lines = Streamlines.from_list([np.c_[x, 0 * x, 0 * x], np.c_[-x, 0 * x + 10, 0 * x]])
    colouring = Colouring("point_scalar", source="arc_length", clim=(0.0, 80.0))
    plotter, mapper, _ = scene(lines, colours=None, colouring=colouring, line_width=6.0, opacity=0.5)
    image = tools.picture(plotter, mapper)[100, 60:180, 0].astype(float)
    front = ((np.arange(60, 180) + 0.5) / 200 * 100 - 20) / 80 * 255  # 200 pixels are 100 mm
    front -= front.mean() - 127.5
    assert np.abs(image - (0.5 * front + 0.25 * (255 - front))).max() < 6


def test_without_layers_nothing_is_left_of_them(scene, tools):
    plotter, mapper, actor = scene(rows(), layers=None, line_width=6.0)
    before, installed = tools.picture(plotter, mapper), mapper._link.installed
    assert mapper.GetInput().GetNumberOfPoints() == 6
    assert not holds_layers(mapper)
    mapper.set_effect("layers", Layers(5))
    assert mapper.GetInput().GetNumberOfPoints() == 30
    assert np.abs(tools.picture(plotter, mapper)[100, 120] - blended(COLOURS, 0.4)).max() <= 3
    assert holds_layers(mapper)
    actor.GetProperty().SetOpacity(1.0)  # an opaque actor pays for no layer
    assert (tools.picture(plotter, mapper)[100, 60:180] == COLOURS[0]).all()
    assert not holds_layers(mapper)
    actor.GetProperty().SetOpacity(0.4)
    mapper.set_effect("layers", None)
    assert (tools.picture(plotter, mapper) == before).all()
    assert mapper._link.installed == installed
    assert mapper.GetInput().GetNumberOfPoints() == 6
    assert not holds_layers(mapper)
    text = "".join(replacement.text for replacement in installed)
    assert "Layer" not in text


def test_the_nearest_is_picked(scene, tools):
    plotter, mapper, actor = scene(rows(), line_width=6.0)
    tools.picture(plotter, mapper)
    assert mapper.pick_at(120, 100)[0] == 0
    # VTK's own selection draws the actor anew, and finds it where the nearest line is.
    from vtkmodules.vtkRenderingCore import vtkPropPicker

    picker = vtkPropPicker()
    assert picker.Pick(120, 100, 0, plotter.renderer)
    assert picker.GetActor() is actor
    assert picker.GetPickPosition()[1] == pytest.approx(0.0, abs=1.0)
    assert np.abs(tools.picture(plotter, mapper)[100, 120] - blended(COLOURS[:4], 0.4)).max() <= 3


@pytest.mark.parametrize("count", [1, 65, 2.5, True])
def test_a_number_of_layers_that_makes_no_sense(count):
    with pytest.raises(ValueError, match="whole number from 2 to 64"):
        Layers(count)


def test_a_halo_is_there_once(scene, tools):
    """Around the front line a halo hides what is behind it, and it is blended with the background once."""
    plotter, mapper, _ = scene(rows((0, 10)), line_width=3.0)
    mapper.set_effect("halo", Halos())
    column = tools.picture(plotter, mapper)[90:112, 120].astype(float)
    line = np.abs(column - blended(COLOURS[:2], 0.4)).max(axis=1) <= 3
    halo = np.abs(column - 0.4 * 255).max(axis=1) <= 3
    assert line.any()
    assert halo.any()
    assert (line | halo | (column == 0).all(axis=1)).all(), column
