"""Spline tubes among VTK's lights, cuts and passes: against unions of VTK's own balls, and closed forms."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv
from vtkmodules.vtkCommonDataModel import vtkPlane
from vtkmodules.vtkRenderingCore import vtkActor

from pvfiblets.mappers import Colouring, TubeMapper, TubeOptions
from pvfiblets.mappers.tubes import tube_renderer
from pvfiblets.tubes.spline_tubes import NodeValues, SplineTubes

ANGLE = np.linspace(-3.0, 3.0, 8)
BENT = np.stack([6 * ANGLE, 7 * np.sin(ANGLE), 6 * np.cos(ANGLE)], axis=1)
TANGENTS = np.stack([6 + 0 * ANGLE, 7 * np.cos(ANGLE), -6 * np.sin(ANGLE)], axis=1) * (ANGLE[1] - ANGLE[0])
RADII = 2.5 + 1.5 * np.sin(2 * ANGLE)
RADIUS_SLOPES = 3.0 * np.cos(2 * ANGLE) * (ANGLE[1] - ANGLE[0])


def tubes_of():
    """One tube of seven segments that bends and swells, derivatives by the parameter."""
    segments = np.stack([np.arange(7), np.arange(1, 8)], axis=1)
    return SplineTubes(BENT, segments, RADII, TANGENTS, RADIUS_SLOPES, False, np.zeros(7, int), 1)


def straight(values=None, n_tubes=1, apart=8.0, length=30.0, radius=2.0):
    """Tubes along x, each of two segments, at x = -length / 2, 0, length / 2."""
    x = np.array([-0.5, 0.0, 0.5]) * length
    points = np.concatenate([np.stack([x, 0 * x, 0 * x + apart * k], axis=1) for k in range(n_tubes)])
    first = 3 * np.arange(n_tubes)
    segments = np.stack([first, first + 1, first + 1, first + 2], axis=1).reshape(-1, 2)
    n = 3 * n_tubes
    return SplineTubes(
        points, segments, np.full(n, radius), np.tile([1.0, 0.0, 0.0], (n, 1)), np.zeros(n), True,
        np.repeat(np.arange(n_tubes), 2), n_tubes, {} if values is None else {"v": values},
    )  # fmt: skip


def cubics(tubes, count=50):
    """Spheres along the cubics, by the textbook's basis: (n, 4)."""
    t = np.linspace(0, 1, count)[:, None]
    basis = 2 * t**3 - 3 * t**2 + 1, t**3 - 2 * t**2 + t, 3 * t**2 - 2 * t**3, t**3 - t**2
    nodes = np.column_stack([tubes.points, tubes.radius])
    slopes = np.column_stack([tubes.tangents, tubes.radius_slopes])
    found = [
        basis[0] * nodes[i] + basis[1] * slopes[i] + basis[2] * nodes[j] + basis[3] * slopes[j]
        for i, j in tubes.segments
    ]
    return np.concatenate(found)


def made(tubes, *, lighting=False, **options):
    mapper, actor = TubeMapper(tubes, **options), vtkActor()
    mapper.attach(actor)
    actor.GetProperty().SetLighting(lighting)
    actor.GetProperty().SetAmbient(0.1)
    actor.GetProperty().SetDiffuse(0.9)
    return mapper, actor


def lit(plotter):
    plotter.remove_all_lights()
    lamp = pv.Light(position=(60, -100, 40), focal_point=(0, 0, 0), light_type="scene light")
    lamp.positional = False
    plotter.add_light(lamp)
    plotter.camera_position = [(20, -70, 25), (0, 0, 0), (0, 0, 1)]
    plotter.camera.clipping_range = 20, 150
    return plotter


def flat(plotter, height=40.0):
    """From -y, parallel: 200 pixels are `height` mm."""
    plotter.camera_position = [(0, -100, 0), (0, 0, 0), (0, 0, 1)]
    plotter.enable_parallel_projection()
    plotter.camera.parallel_scale = height / 2
    plotter.camera.clipping_range = 20, 200
    return plotter


def shown(make_plotter, actor, place=None, view=lit):
    plotter = make_plotter()
    plotter.add_actor(actor, reset_camera=False)
    if place:
        place(actor)
    return view(plotter)


def test_bounds_hold_what_shows_and_the_camera_takes_them(make_plotter, tools):
    mapper, actor = made(tubes_of())
    bounds, spheres = np.array(actor.GetBounds()), cubics(mapper.tubes)
    assert (spheres[:, :3] - spheres[:, 3:] >= bounds[::2] - 1e-9).all()
    assert (spheres[:, :3] + spheres[:, 3:] <= bounds[1::2] + 1e-9).all()
    plotter = make_plotter()
    plotter.add_actor(actor)
    image = tools.covered(tools.picture(plotter, mapper))
    assert image.sum() > 1000
    assert not image[[0, -1]].any()
    assert not image[:, [0, -1]].any()


def test_clipping_planes_of_the_mapper_cut(make_plotter, tools):
    """Half a tube is left, its cut closed; without the plane all of it is back."""
    mapper, actor = made(straight())
    plotter = shown(make_plotter, actor, view=flat)
    whole = tools.covered(tools.picture(plotter, mapper))
    plane = vtkPlane()
    plane.SetNormal(1, 0, 0)
    plane.SetOrigin(5, 0, 0)
    mapper.AddClippingPlane(plane)
    half = tools.covered(tools.picture(plotter, mapper))
    right = np.zeros_like(whole)
    right[:, 120 + 25 :] = True  # 5 pixels a mm
    assert (half == (whole & right)).all()
    plotter.camera_position = [(-100, 0, 0), (0, 0, 0), (0, 0, 1)]  # onto the cut
    assert abs(tools.covered(tools.picture(plotter, mapper)).sum() - np.pi * 10.0**2) < 12
    mapper.RemoveAllClippingPlanes()
    assert (tools.covered(tools.picture(flat(plotter), mapper)) == whole).all()


def test_places_are_picked_as_the_picture_shows_them(make_plotter, tools):
    mapper, actor = made(straight(n_tubes=2))
    plotter = shown(make_plotter, actor, view=flat)
    assert mapper.pick_at(120, 100) is None
    tools.picture(plotter, mapper)
    for tube, row in enumerate((100, 140)):
        for column in (60, 90, 119, 121, 150, 180):
            x = (column + 0.5 - 120) / 5
            segment, t = mapper.pick_at(column, row, tolerance=0)
            assert segment == 2 * tube + (x > 0)
            assert t == pytest.approx((x / 15) % 1, abs=1e-3)
    assert mapper.pick_at(120, 120) is None
    assert mapper.pick_at(120, 114, tolerance=6)[0] in (0, 1)


def colour_at(image, column=150, row=100):
    return image[image.shape[0] - 1 - row, column].tolist()


@pytest.mark.parametrize("opaque", [True, False])
def test_colours_at_nodes_are_interpolated_like_positions(make_plotter, tools, opaque):
    rgba = np.array([[1, 0, 0, 1], [0, 1, 0, 1 if opaque else 0.5], [0, 0, 1, 1]])
    mapper, actor = made(straight(NodeValues(rgba, np.zeros((3, 4)))))
    mapper.colouring = Colouring("point_rgba", source="v", has_alpha=not opaque)
    plotter = shown(make_plotter, actor, view=flat)
    image = tools.picture(plotter, mapper).astype(int)
    assert actor.GetForceTranslucent() is not opaque
    for column in (50, 75, 100, 119):
        s = ((column + 0.5 - 120) / 5 / 15) % 1
        share = 2 * s**2 if s < 0.5 else 1 - 2 * (1 - s) ** 2  # the two halves' parabolas of zero slopes
        seen = 1.0 if opaque else 1 - 0.5 * share
        wanted = [255 * (1 - share) * seen, 255 * share * seen, 0]
        assert np.abs(np.array(colour_at(image, column)) - wanted).max() <= 3


def test_options_reach_the_engine_and_only_those_that_differ(make_plotter, tools):
    asked = []

    def factory(ctx, tubes, **options):
        asked.append(options)
        return tube_renderer(ctx, tubes, **options)

    mapper, actor = made(tubes_of(), renderer_factory=factory)
    plotter = shown(make_plotter, actor)
    first = tools.picture(plotter, mapper)
    assert mapper.pipeline_in_use == "rectangles"
    mapper.options = TubeOptions("boxes", "bisection", 40)
    second = tools.picture(plotter, mapper)
    assert mapper.pipeline_in_use == "boxes"
    assert asked == [{}, {"silhouettes": "boxes", "solver": "bisection", "iterations": 40}]
    assert (first != second).any(-1).mean() < 1e-3
    mapper.set_tubes(straight())
    tools.picture(plotter, mapper)
    assert len(asked) == 3
    assert TubeOptions(culling="none") == TubeOptions(culling=None)
    assert TubeOptions(culling=None).changed() == {"culling": None}
    assert mapper.share == 1.0
