"""Selected streamlines as tubes: spline tubes, or the fiblets' own where those cannot do."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv
from vtkmodules.vtkCommonDataModel import vtkPlane

import pvfiblets as pf
from pvfiblets.mappers import FibletMapper, TubeMapper
from pvfiblets.plotting.fiblets import selection_overlay

from .views import facing_shot

RADIUS = 1.6


@pytest.fixture
def scene(plotter):
    """Return an actor of three bars along x at z = -10, 0, 10, coloured, and a function that takes its picture."""
    x = np.linspace(-15.0, 15.0, 61)
    lines = pf.Streamlines.from_list([np.stack([x, 0 * x, 0 * x + z], axis=1) for z in (-10.0, 0.0, 10.0)])
    lines.per_point = {"along": np.tile(np.linspace(0.0, 1.0, 61), 3)}
    lines.per_streamline = {"weight": np.array([0.0, 1.0, 2.0])}
    actor = plotter.add_fiblets(lines, per_point=("along",), lighting=False, show_scalar_bar=False, cmap="gray")
    actor.selection_style(as_tubes=True, radius=RADIUS, dim=0.0)
    return actor, lambda: facing_shot(plotter)


def at(picture, x, z):
    """The pixel of a place in the plane of the picture."""
    return picture[99 - int(np.floor(5 * z)), 100 + int(np.floor(5 * x))]


def rows(picture, z):
    """How many rows of pixels a bar takes in its middle."""
    middle = picture[:, 100].max(axis=1) > 0
    return middle[99 - round(5 * z) - 20 : 99 - round(5 * z) + 22].sum()


def drawn_by(actor):
    return type(actor._standout.mapper)


@pytest.mark.more
def test_tubes_follow_what_their_actor_does_by_whichever_way_can(scene):
    actor, front = scene
    actor.selection_style(as_tubes=False)
    with pytest.raises(ValueError, match="radius is -1"):
        actor.select([1], as_tubes=True, radius=-1)
    assert len(actor.selection) == 0
    actor.select([0, 2], as_tubes=True, radius=RADIUS)
    first = front()
    assert drawn_by(actor) is TubeMapper
    assert [rows(first, z) for z in (-10, 0, 10)] == [16, 1, 16]

    actor.clip(pv.Sphere(radius=12, center=(0, 0, 0)))  # a region
    cut = front()
    assert drawn_by(actor) is TubeMapper
    assert at(first, 6.0, 11.0).any()
    assert not at(cut, 6.0, 11.0).any()
    actor.show_all()
    assert (front() == first).all()
    assert drawn_by(actor) is TubeMapper

    actor.criterion("along", (0.0, 0.5))  # point by point
    half = front()
    assert drawn_by(actor) is TubeMapper
    assert not half[:, 130:].any()
    actor.show_all()
    assert (front() == first).all()

    actor.criterion("weight", (1.0, 2.0))  # whole streamlines
    fewer = front()
    assert drawn_by(actor) is TubeMapper
    assert [rows(fewer, z) for z in (-10, 0, 10)] == [0, 1, 16]
    y, x = 149 - 100, 100
    assert actor.pick_polygon([(x, 199 - y)], tolerance=0.6).ids.tolist() == [2]
    actor.criterion("weight", (1.0, 1.0))
    assert [rows(front(), z) for z in (-10, 0, 10)] == [0, 1, 0]
    actor.show_all()
    assert (front() == first).all()

    actor.visibility = False
    assert not front().any()
    actor.visibility = True
    plane = vtkPlane()
    plane.SetNormal(1, 0, 0)
    actor.mapper.AddClippingPlane(plane)
    right = front()
    assert drawn_by(actor) is TubeMapper
    assert (right[:, 100:] == first[:, 100:]).all()
    assert not right[:, :100].any()
    actor.mapper.RemoveAllClippingPlanes()
    actor.user_matrix = np.diag([1.0, 1.0, 0.5, 1.0])
    moved = front()
    assert moved[99 - 25 - 3, 100].any()
    assert not moved[99 - 50 - 3, 100].any()
    actor.user_matrix = np.eye(4)
    assert (front() == first).all()
    actor.deselect()
    assert rows(front(), 10) == 1


@pytest.mark.few(3)
@pytest.mark.parametrize("scalars", [None, "weight", "along", "arc_length", "curvature", "colours"])
def test_tubes_have_their_actors_colours(scene, scalars):
    actor, front = scene
    colours = np.array([[255, 0, 0], [0, 255, 0], [20, 40, 60]], np.uint8)
    actor.scalars = colours if scalars == "colours" else scalars
    if scalars == "curvature":
        actor.clim = (0.0, 1.0)
        actor.cmap = ["red", "blue"]
    before = front()
    actor.select([0, 1, 2])
    picture = front()
    assert drawn_by(actor) is TubeMapper
    for z in (-10.0, 0.0, 10.0):
        line = before[[99 - int(5 * z), 100 - int(5 * z)]].max(axis=0)
        for x in (-13.0, -2.0, 7.0):
            assert np.abs(at(picture, x, z + 0.7) - line[100 + int(np.floor(5 * x))]).max() <= 3
    actor.selection_style(color="orange")
    assert at(front(), 0.0, 10.7).tolist() == list(pv.Color("orange").int_rgb)


def test_a_volume_colours_tubes_of_fiblets(scene):
    actor, front = scene
    affine = np.diag([2.0, 2.0, 2.0, 1.0])
    affine[:3, 3] = -20.0
    actor.select([1])
    front()
    assert drawn_by(actor) is TubeMapper
    actor.scalars = np.indices((21, 21, 21))[0].astype(np.float32), affine
    assert at(front(), 10.0, 0.7)[0] == pytest.approx(255 * 15 / 20, abs=4)
    assert drawn_by(actor) is FibletMapper
    actor.scalars = "along"
    assert at(front(), 0.0, 0.7)[0] == pytest.approx(128, abs=4)
    assert drawn_by(actor) is TubeMapper
    assert actor.explain()["selection"]["gpu_bytes"] > 200 * 200 * 24
    actor.clip(pv.Sphere(radius=12))
    front()
    actor.deselect()
    front()
    assert actor.explain()["selection"] == {"streamlines": 0, "passes": [], "features": [], "gpu_bytes": 0}


def test_very_many_points_stay_compressed(scene, monkeypatch):
    actor, front = scene
    monkeypatch.setattr(selection_overlay, "MOST_POINTS", 100)
    actor.select([0])
    front()
    assert drawn_by(actor) is TubeMapper
    actor.select([0, 1])
    front()
    assert drawn_by(actor) is FibletMapper


def test_places_on_tubes_are_the_streamlines(scene):
    actor, front = scene
    actor.select([0, 2])
    front()
    for z, line in ((-10, 0), (10, 2)):
        for x in (-12.3, 0.1, 9.9):
            pixel = 100 + int(np.floor(5 * x)), 100 + 5 * z + 4
            picked = actor.pick_polygon([pixel], tolerance=0.6)
            assert picked.ids.tolist() == [line]
            assert picked.places == pytest.approx([(x + 15) / 0.5], abs=1.0)
            assert picked.points[0] == pytest.approx([x, 0, z], abs=0.5)


@pytest.mark.parametrize("style", [{"as_tubes": True, "radius": 2.0}, {"as_tubes": False, "width": 16}])
def test_an_outline_goes_around_what_is_drawn(scene, style):
    actor, front = scene
    actor.select([1])
    actor.selection_style(**style, color="lime", silhouette="magenta")
    picture = front()
    half = 2.0 if style["as_tubes"] else 1.6
    assert at(picture, 0.0, half - 0.3).tolist() == [0, 255, 0]
    assert at(picture, 0.0, half + 0.2).tolist() == [255, 0, 255]
    actor.selection_style(silhouette=False)
    assert (front() != [255, 0, 255]).any(axis=2).all()


@pytest.mark.parametrize("spline", [True, False])
def test_shading_of_the_actor_is_that_of_its_tubes(scene, monkeypatch, spline):
    """The cue's default distances are those of all bars, of which the selected one is in the middle."""
    actor, front = scene
    if not spline:
        monkeypatch.setattr(selection_overlay, "MOST_POINTS", 0)
    actor.position = (0.0, 30.0, 0.0)
    actor.orientation = (90.0, 0.0, 0.0)  # z away from the viewer
    actor.select([1])
    actor.selection_style(color="white")
    actor.depth_cue = {"color": "black", "strength": 1.0}
    shade = front()[80:120, 95:105, 1].max()  # of the selected one: lines are red
    assert drawn_by(actor) is (TubeMapper if spline else FibletMapper)
    assert 90 < shade < 165
    actor.depth_cue = False
    assert front()[80:120, 95:105, 1].max() == 255
