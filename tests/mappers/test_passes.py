"""VTK's render passes: translucency, ambient occlusion, eye dome lighting, anti-aliasing, stereo."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

from pvfiblets.mappers import Colouring


def scene_with(make_plotter, actor, **options):
    plotter = make_plotter(**options)
    plotter.add_actor(actor, reset_camera=False)
    plotter.camera_position = [(0, -220, 0), (0, 0, 0), (0, 0, 1)]
    return plotter


@pytest.fixture
def yellow_lines(lines):
    mapper, actor = lines.actor(colouring=Colouring("solid", color=(1.0, 1.0, 0.0)))
    return mapper, actor


@pytest.mark.parametrize(("y", "peeling"), [(-60, True), (-60, False), (80, True)])
def test_a_translucent_mesh_tints_fiblets_behind_it_only(make_plotter, yellow_lines, tools, y, peeling):
    mapper, actor = yellow_lines
    plotter = scene_with(make_plotter, actor)
    plotter.renderer.ResetCameraClippingRange()
    alone = tools.covered(tools.picture(plotter, mapper))
    if peeling:
        plotter.enable_depth_peeling()
    box = pv.Box((-60, 60, y, y + 2, -60, 60))
    plotter.add_mesh(box, color="blue", opacity=0.5, lighting=False, reset_camera=False)
    seen = tools.picture(plotter, mapper)[alone]
    if y < 0:  # two faces of blue at one half over yellow: a quarter of the yellow is left
        assert np.allclose(seen.mean(axis=0), (64, 64, 191), atol=4)
    else:
        assert np.array_equal(np.unique(seen, axis=0), [[255, 255, 0]])


@pytest.mark.parametrize("peeling", [True, False])
def test_translucent_fiblets_over_an_opaque_mesh(make_plotter, yellow_lines, tools, peeling):
    mapper, actor = yellow_lines
    plotter = scene_with(make_plotter, actor)
    alone = tools.covered(tools.picture(plotter, mapper))
    if peeling:
        plotter.enable_depth_peeling()
    actor.GetProperty().SetOpacity(0.5)
    plotter.add_mesh(pv.Box((-90, 90, 80, 82, -90, 90)), color="blue", lighting=False, reset_camera=False)
    image = tools.picture(plotter, mapper)
    assert np.allclose(image[alone].mean(axis=0), (127, 127, 127), atol=3)
    # And a translucent mesh sees the nearest layer of fiblets only where it is in front of it.
    plotter.add_mesh(pv.Box((-60, 60, -60, -58, -60, 60)), color="red", lighting=False, reset_camera=False)
    image = tools.picture(plotter, mapper)
    inner = alone & tools.covered(image)
    assert (image[inner] == (255, 0, 0)).all(axis=-1).mean() > 0.9


def test_ambient_occlusion_darkens_fiblets_close_to_a_mesh(make_plotter, lines, tools):
    mapper, actor = lines.actor(colouring=Colouring("solid", color=(1.0, 1.0, 1.0)))
    actor.GetProperty().SetLighting(True)
    actor.GetProperty().SetAmbient(1.0)
    actor.GetProperty().SetDiffuse(0.0)
    plotter = scene_with(make_plotter, actor)
    floor = pv.Plane(center=(0, 0, 0), direction=(0, 1, 0), i_size=300, j_size=300)
    plotter.add_mesh(floor, color="blue", lighting=False, reset_camera=False)
    plain = tools.picture(plotter, mapper)
    plotter.enable_ssao(radius=8, bias=0.5, kernel_size=64)
    shaded = tools.picture(plotter, mapper)
    white = (plain == 255).all(axis=-1)
    assert white.sum() > 300
    values = shaded[white].astype(float)
    # Fiblets are still there and white or grey, and some are darker than without.
    assert values.mean() > 100
    assert np.abs(values[:, 0] - values[:, 1]).mean() < 30
    assert (values.mean(axis=1) < 245).mean() > 0.05
    # Occlusion of the floor follows the fiblets in front of it: it needs their positions.
    near = tools.grown(white) & ~white
    far = ~tools.grown(tools.grown(tools.grown(tools.grown(white))))
    assert shaded[near][:, 2].mean() < shaded[far][:, 2].mean() + 1


def test_eye_dome_lighting_outlines_fiblets(make_plotter, compare, tools):
    def scene(plotter, actor, mapper):
        plotter.reset_camera()
        plotter.enable_eye_dome_lighting()

    ours, theirs = compare(scene)
    assert tools.agreement(tools.covered(ours), tools.covered(theirs)) >= 0.98
    both = tools.covered(ours) & tools.covered(theirs)
    # The pass reads nothing but depth; where depths agree, so does its shading.
    assert np.median(np.abs(ours[both].astype(int) - theirs[both])) <= 8
    assert (ours[both][:, 0] < 250).any()


@pytest.mark.parametrize("technique", ["fxaa", "ssaa", "msaa"])
def test_anti_aliasing(compare, tools, technique):
    def scene(plotter, actor, mapper):
        plotter.reset_camera()
        if technique == "fxaa":
            # PyVista warns that it is not good without a window, and takes another.
            plotter.renderer.SetUseFXAA(True)
        else:
            plotter.enable_anti_aliasing(technique)

    ours, theirs = compare(scene)
    visible = [image.max(axis=-1) > 40 for image in (ours, theirs)]
    assert tools.agreement(*visible) >= 0.97
    if technique != "msaa":
        partial = (ours[..., 0] > 30) & (ours[..., 0] < 225)
        assert partial.sum() > 100, "edges should be blended"


@pytest.mark.parametrize("kind_of_stereo", ["anaglyph", "red_blue", "crystal_eyes"])
def test_stereo_draws_both_eyes(compare, tools, kind_of_stereo):
    def scene(plotter, actor, mapper):
        plotter.reset_camera()
        plotter.render_window.StereoRenderOn()
        {
            "anaglyph": plotter.render_window.SetStereoTypeToAnaglyph,
            "red_blue": plotter.render_window.SetStereoTypeToRedBlue,
            "crystal_eyes": plotter.render_window.SetStereoTypeToSplitViewportHorizontal,
        }[kind_of_stereo]()

    ours, theirs = compare(scene)
    assert tools.agreement(tools.covered(ours), tools.covered(theirs)) >= 0.99
    for channel in range(3):
        one, other = ours[..., channel] > 0, theirs[..., channel] > 0
        if other.any():
            assert tools.agreement(one, other) >= 0.98


def test_fiblets_cast_shadows(make_plotter, make_fibres, tools):
    """Rods under a high lamp darken the floor below them. (VTK's unlit lines fail to compile here.)"""
    along = np.linspace(-30, 30, 121)[:, None] * np.array((1.0, 0.0, 0.0))
    rods = [along + np.array((0, 0.1 * i, 20)) for i in range(-20, 21)]
    fibres = make_fibres(type(tools.helices(1, 2)).from_list(rods))
    mapper, actor = fibres.actor(lighting=True)
    plotter = make_plotter(lighting="none")
    plotter.add_actor(actor)
    floor = pv.Plane(center=(0, 0, -20), i_size=100, j_size=100, i_resolution=10, j_resolution=10)
    plotter.add_mesh(floor, color="white")
    place = {"position": (0, 0, 400), "focal_point": (0, 0, 0), "positional": True, "cone_angle": 20}
    plotter.add_light(pv.Light(light_type="scene light", **place))
    plotter.camera_position = [(0, -150, 150), (0, 0, -10), (0, 0, 1)]
    plotter.renderer.ResetCameraClippingRange()

    def brightness():
        image = tools.picture(plotter, mapper)
        found = []
        for y in (0, 15, -15):
            plotter.renderer.SetWorldPoint(0.0, float(y), -20.0, 1.0)
            plotter.renderer.WorldToDisplay()
            column, row, _ = plotter.renderer.GetDisplayPoint()
            found.append(int(image[image.shape[0] - 1 - int(row), int(column)].max()))
        return found

    assert min(brightness()) > 150
    plotter.enable_shadows()
    below, *beside = brightness()
    assert below == pytest.approx(89, abs=3)  # what a plate of VTK's own in the rods' place leaves of the light
    assert min(beside) > 150
