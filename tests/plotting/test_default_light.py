"""What a picture looks like if nothing is asked for: colours true from every side, and as their legend has them."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

from pvfiblets.synthetic import brain_streamlines


def picture(plotter):
    plotter.show(auto_close=False, interactive=False)
    plotter.render()
    return np.asarray(plotter.screenshot(return_img=True))[..., :3].astype(float)


@pytest.fixture(scope="module")
def brain():
    from pvfiblets import compress

    streamlines = brain_streamlines(400, seed=3)
    lengths = np.diff(streamlines.offsets)
    streamlines.per_point = {"height": streamlines.points[:, 2].astype(np.float32)}
    streamlines.per_streamline = {"bundle": (np.arange(len(lengths)) % 5).astype(np.int32)}
    return compress(streamlines, per_point=("height",))


HEADLIGHTS = {"headlight": {}, "dim": {"intensity": 0.2}, "red": {"color": "red"}}


@pytest.mark.few(3)
@pytest.mark.parametrize("camera", ["xy", "xz", "yz", "iso"])
@pytest.mark.parametrize("lights", ["light kit", "three lights", *HEADLIGHTS])
def test_direction_colours_are_true_from_every_side(brain, camera, lights):
    """Lit beside unlit: most pixels keep nearly all of their brightness, none less than four fifths."""
    shown = {}
    for lighting in (True, False):
        kind = "none" if lights in HEADLIGHTS else lights
        plotter = pv.Plotter(off_screen=True, window_size=(160, 120), lighting=kind)
        if lights in HEADLIGHTS:
            plotter.add_light(pv.Light(light_type="headlight", **HEADLIGHTS[lights]))
        plotter.set_background("black")
        plotter.disable_anti_aliasing()
        plotter.add_fiblets(brain, lighting=lighting)
        plotter.camera_position = camera
        shown[lighting] = picture(plotter)
        plotter.close()
    drawn = shown[False].any(axis=-1)
    ratio = (shown[True].sum(-1) / np.maximum(shown[False].sum(-1), 1))[drawn]
    assert np.median(ratio) >= 0.95
    assert ratio.min() >= 0.79  # of 255 levels
    assert ratio.max() <= 1.01
    assert ratio.std() > 0.025  # and shape is left
    dim = shown[True][drawn] / shown[True][drawn].max(-1, keepdims=True)
    true = shown[False][drawn] / shown[False][drawn].max(-1, keepdims=True)
    assert np.abs(dim - true).max() < 0.02  # no channel loses more than another


@pytest.mark.parametrize("name", ["nv_stroke.trk.gz", "dipy_tracks300.trk"])
def test_real_bundles_keep_their_brightness_from_every_side(shared_data, name):
    from pvfiblets import compress, read

    fiblets = compress(read(shared_data / name))
    for camera in ("xy", "xz", "yz"):
        shown = {}
        for lighting in (True, False):
            plotter = pv.Plotter(off_screen=True, window_size=(320, 240))
            plotter.set_background("black")
            plotter.disable_anti_aliasing()
            plotter.add_fiblets(fiblets, lighting=lighting)
            plotter.camera_position = camera
            shown[lighting] = picture(plotter).sum(axis=-1)
            plotter.close()
        drawn = shown[False] > 0
        assert np.median(shown[True][drawn] / shown[False][drawn]) >= 0.95


@pytest.mark.few(2)
@pytest.mark.parametrize("scalars", ["height", "bundle", "length"])
@pytest.mark.parametrize("lights", ["light kit", "three lights"])
def test_colours_match_their_bar(brain, scalars, lights):
    """Within three levels a channel of an entry of the look-up table, from the side and along the lines."""
    for camera in ("yz", "xy"):
        plotter = pv.Plotter(off_screen=True, window_size=(160, 120), lighting=lights)
        plotter.set_background("black")
        plotter.disable_anti_aliasing()
        actor = plotter.add_fiblets(
            brain, scalars=scalars, categories=scalars == "bundle", line_width=3, show_scalar_bar=False
        )
        plotter.camera_position = camera
        image = picture(plotter)
        table = np.asarray(actor.lookup_table.values, float)[:, :3]
        plotter.close()
        colours = np.unique(image[image.any(axis=-1)], axis=0)
        away = np.abs(colours[:, None] - table).max(-1).min(-1)
        assert away.max() <= 3


def test_the_theme_is_obeyed(three_lines):
    theme = pv.themes.Theme()
    theme.lighting, theme.opacity, theme.line_width, theme.render_lines_as_tubes = False, 0.5, 4.0, True
    plotter = pv.Plotter(off_screen=True, window_size=(100, 80), theme=theme)
    actor = plotter.add_fiblets(three_lines)
    assert (actor.lighting, actor.opacity, actor.line_width, actor.tube_shading) == (False, 0.5, 4.0, True)
    tubes = plotter.add_spline_tubes(three_lines)
    assert (tubes.lighting, tubes.opacity) == (False, 0.5)
    halos = plotter.add_halo_lines(three_lines)
    assert halos.opacity == 0.5
    given = plotter.add_fiblets(three_lines, lighting=True, opacity=1.0, line_width=2)
    assert (given.lighting, given.opacity, given.line_width) == (True, 1.0, 2.0)
    plotter.close()
