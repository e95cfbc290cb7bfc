"""Tubes and round shading among VTK's lights and meshes, against VTK's own surfaces and closed forms."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
import pyvista as pv

from pvfiblets.mappers import Colouring
from pvfiblets.mappers.effects.line_tubes import Tubes, TubeShading

RADIUS = 3.0
RODS = [[(-18, 0, 0), (18, 4, 6)], [(5, -12, -10), (0, 10, 12)]]


@pytest.fixture
def rods(tools):
    """Return a function: actor and mapper of two straight rods that pass through each other, white."""

    def make(effect, line_width=1.0, curves=RODS):
        lines = [np.linspace(a, b, 31) for a, b in curves]
        fibres = tools.fibres(type(tools.helices(1, 2)).from_list(lines))
        mapper, actor = fibres.actor(
            lighting=True, line_width=line_width, colouring=Colouring("solid", color=(1, 1, 1))
        )
        actor.GetProperty().SetAmbient(0.1)
        actor.GetProperty().SetDiffuse(0.9)
        mapper.set_effect("tubes", effect)
        return fibres, mapper, actor

    return make


def scene(make_plotter, actor, place=None, light=(60, -100, 40)):
    plotter = make_plotter(lighting="none")
    lamp = pv.Light(position=light, focal_point=(0, 0, 0), light_type="scene light")
    lamp.positional = False
    plotter.add_light(lamp)
    plotter.add_actor(actor, reset_camera=False)
    if place:
        place(actor)
    plotter.camera_position = [(20, -70, 25), (0, 0, 0), (0, 0, 1)]
    plotter.camera.clipping_range = 20, 150
    return plotter


def capsules(fibres):
    """Yield the rods as VTK's surfaces, finely cut: cylinders and balls."""
    offsets, points = fibres.reference.offsets, fibres.reference.points.astype(float)
    for s, e in itertools.pairwise(offsets):
        a, b = points[s], points[e - 1]
        height = np.linalg.norm(b - a)
        yield pv.Cylinder(
            center=(a + b) / 2, direction=b - a, radius=RADIUS, height=height, resolution=240, capping=False
        )
        for end in (a, b):
            yield pv.Sphere(radius=RADIUS, center=end, theta_resolution=120, phi_resolution=120)


@pytest.mark.parametrize(
    "place",
    [None, lambda actor: actor.SetScale(1.5, 1.0, 0.7),
     lambda actor: (actor.SetScale(1, 1, -1), actor.SetOrientation(0, 0, 30))],
    ids=["plain", "stretched", "mirrored"],
)  # fmt: skip
def test_tubes_look_as_vtks_cylinders_and_balls(rods, make_plotter, tools, place):
    """Outline, light, and where they cut into each other, for actors placed in any way."""
    fibres, mapper, actor = rods(Tubes(RADIUS))
    ours = tools.picture(scene(make_plotter, actor, place), mapper).astype(int)
    other = make_plotter(lighting="none")
    matrix = np.array([[actor.GetMatrix().GetElement(i, j) for j in range(4)] for i in range(4)])
    for mesh in capsules(fibres):
        # placed by its points: a mirrored actor turns VTK's own meshes inside out
        placed = mesh.extract_surface(algorithm=None).transform(matrix, inplace=False)
        placed = placed.compute_normals(auto_orient_normals=True, split_vertices=False)
        other.add_mesh(placed, color="white", ambient=0.1, diffuse=0.9, specular=0.0, smooth_shading=True)
    other.remove_all_lights()
    lamp = pv.Light(position=(60, -100, 40), focal_point=(0, 0, 0), light_type="scene light")
    lamp.positional = False
    other.add_light(lamp)
    other.camera_position = [(20, -70, 25), (0, 0, 0), (0, 0, 1)]
    other.camera.clipping_range = 20, 150
    theirs = tools.picture(other).astype(int)
    mask = tools.covered(ours) & tools.covered(theirs)
    assert mask.sum() > 2000
    assert (tools.covered(ours) ^ tools.covered(theirs)).sum() < 0.01 * mask.sum()
    assert (np.abs(ours - theirs).max(-1)[mask] <= 6).mean() > 0.985  # VTK's facets


def test_wide_lines_shaded_as_tubes(rods, make_plotter, tools):
    """A rod across the view, lit from above: light falls with the cosine around it."""
    width = 30.0
    _, mapper, actor = rods(TubeShading(), width, [[(-30, 0, 0), (30, 0, 0)]])
    plotter = scene(make_plotter, actor, light=(0, -100, 100))
    plotter.camera_position = [(0, -100, 0), (0, 0, 0), (0, 0, 1)]
    plotter.enable_parallel_projection()
    plotter.camera.clipping_range = 20, 150
    column = tools.picture(plotter, mapper)[:, 120, 0].astype(float)
    lit = np.nonzero(column)[0]
    middle = (lit.min() + lit.max()) / 2
    assert abs(lit.max() - lit.min() + 1 - width) <= 1
    across = (middle - lit) / (width / 2)  # rows run downwards
    cosine = np.clip((np.sqrt(1 - across**2) + across) / np.sqrt(2), 0, 1)
    assert np.abs(column[lit] - 255 * (0.1 + 0.9 * cosine)).max() < 12
    assert np.median(np.abs(column[lit] - 255 * (0.1 + 0.9 * cosine))) < 3


@pytest.mark.parametrize("direction", [(-1, 0, 0), (0.6, 0, -0.8)])
def test_round_shading_faces_the_light_whatever_the_direction(rods, make_plotter, tools, direction):
    """The half nearer to the light is brighter, in every direction of a line and for a mirrored actor."""
    d = np.array(direction, float)
    for place in (None, lambda actor: actor.SetScale(-1, 1, 1)):
        _, mapper, actor = rods(TubeShading(), 16.0, [[-12 * d, 12 * d]])
        plotter = scene(make_plotter, actor, place, light=(100, -30, 100))
        plotter.camera_position = [(0, -100, 0), (0, 0, 0), (0, 0, 1)]
        plotter.enable_parallel_projection()
        plotter.camera.clipping_range = 20, 150
        image = tools.picture(plotter, mapper)[..., 0].astype(float)
        rows, columns = np.nonzero(image)
        seen = d * (-1 if place else 1, 1, 1)
        left = np.array([-seen[2], seen[0]])  # of the line, in x and z of the picture
        away = (columns - columns.mean()) * left[0] - (rows - rows.mean()) * left[1]
        toward = np.sign(left @ (1, 1))
        values = image[rows, columns]
        assert toward == 0 or values[away * toward > 2].mean() > values[away * toward < -2].mean() + 20


def test_live_and_back_without_a_trace(rods, make_plotter, tools):
    """Tubes, other tubes, round shading, and plain lines again, in one window: nothing stays."""
    _, mapper, actor = rods(None)
    plotter = scene(make_plotter, actor)
    bounds = np.array(actor.GetBounds())
    before = tools.picture(plotter, mapper)
    names = {buffer["name"] for buffer in mapper.explain()["windows"][0]["buffers"]}
    size = {b["name"]: b["bytes"] for b in mapper.explain()["windows"][0]["buffers"]}["gbuffer"]
    areas = []
    for effect in (Tubes(1.0), Tubes(RADIUS), TubeShading()):
        mapper.set_effect("tubes", effect)
        areas.append(tools.covered(tools.picture(plotter, mapper)).sum())
        reach = getattr(effect, "radius", 0.0)
        np.testing.assert_allclose(np.array(actor.GetBounds()) - bounds, reach * np.array([-1, 1] * 3), atol=1e-6)
    assert areas[1] > 2 * areas[0] > 2 * areas[2]
    mapper.set_effect("both", Tubes(1.0))  # its normals, not the lines' shading
    assert tools.covered(tools.picture(plotter, mapper)).sum() == areas[0]
    mapper.set_effect("both", None)
    mapper.set_effect("tubes", None)
    assert (tools.picture(plotter, mapper) == before).all()
    assert {buffer["name"] for buffer in mapper.explain()["windows"][0]["buffers"]} == names
    assert {b["name"]: b["bytes"] for b in mapper.explain()["windows"][0]["buffers"]}["gbuffer"] == size
    mapper.set_effect("tubes", TubeShading())  # which leaves thin lines as they are
    mapper.line_width = 1.0
    thin = tools.picture(plotter, mapper)
    mapper.set_effect("tubes", None)
    assert (tools.picture(plotter, mapper) == thin).all()
    for radius in (0.0, -1.0, np.nan, np.inf):
        with pytest.raises(ValueError, match=f"radius of tubes is {radius}; give a finite number"):
            Tubes(radius)


def test_tubes_are_picked_where_they_show(rods, make_plotter, tools):
    fibres, mapper, actor = rods(Tubes(RADIUS))
    plotter = scene(make_plotter, actor)
    mask = tools.covered(tools.picture(plotter, mapper))
    rows, columns = np.nonzero(mask)
    height = mask.shape[0]
    for k in range(0, len(rows), 977):
        found = mapper.pick_at(int(columns[k]), int(height - 1 - rows[k]), tolerance=0)
        assert found is not None
        assert found[0] in (0, 1)
        assert 0.0 <= found[1] <= 30.0
    assert mapper.pick_at(2, 2) is None
