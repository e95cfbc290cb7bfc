"""Arguments of add_mesh that are the property's are told where they belong, and VTK's light follows them."""

from __future__ import annotations

import inspect
import pickle
from contextlib import nullcontext

import numpy as np
import pytest
import pyvista as pv

ADDS = ("add_fiblets", "add_spline_tubes", "add_halo_lines")
LIGHT = {"ambient": 0.5, "diffuse": 0.3, "specular": 1.0, "interpolation": "pbr", "metallic": 0.9, "roughness": 0.1}


@pytest.mark.parametrize("add", ADDS)
def test_light_is_that_of_the_property(plotter, three_lines, add):
    light = {"specular": 0.4, "ambient": 0.3, "diffuse": 0.2, "metallic": 0.7, "roughness": 0.6, "specular_power": 9.0}
    actor = getattr(plotter, add)(three_lines, pbr=True, smooth_shading=True, **light)
    assert {name: getattr(actor.prop, name) for name in light} == pytest.approx(light)
    assert actor.prop.interpolation.name == "PBR"
    with pytest.raises(TypeError, match="smooth as they are"):
        getattr(plotter, add)(three_lines, smooth_shading=False)
    with pytest.raises(ValueError, match="ambient"):
        getattr(plotter, add)(three_lines, ambient=3.0)
    assert len(plotter.renderer.actors) == 1
    with pytest.raises(TypeError, match="unexpected keyword argument 'spekular'"):
        getattr(plotter, add)(three_lines, spekular=1.0)
    name = {"add_spline_tubes": "depth_cue", "add_halo_lines": "n_tapered", "add_fiblets": "tube_radius"}[add]
    with pytest.raises(TypeError, match=rf"takes no {name}: set it on the actor .*actor\.{name} = "):
        getattr(plotter, add)(three_lines, **{name: 1})
    with pytest.warns(UserWarning, match="nothing is drawn"):
        getattr(plotter, add)([])
    actor = getattr(plotter, add)(three_lines, color="red")
    assert hasattr(actor, name)
    actor.prop.specular_color, actor.prop.specular = "blue", 1.0  # VTK's GetColor mixes the two
    assert actor.color == "red"
    actor.prop.color = "green"
    assert actor.color == "green"


@pytest.mark.parametrize("add", ADDS)
def test_a_column_of_vectors_colours(plotter, add):
    points = np.random.default_rng(0).normal(size=(40, 3)).cumsum(axis=0)
    mesh = pv.MultipleLines(points)
    mesh["speed"] = np.random.default_rng(1).uniform(1.0, 5.0, (40, 3))
    plain = getattr(plotter, add)(mesh, scalars=mesh["speed"][:, 1], copy_mesh=True)
    for scalars in ("speed", mesh["speed"]):
        actor = getattr(plotter, add)(mesh, scalars=scalars, component=1)
        assert actor.clim == plain.clim
        np.testing.assert_array_equal(actor.scalars, plain.scalars)
    for wrong, error, words in ((3, ValueError, "give a column of the scalars, 0 to 2"), (-1, ValueError, "0 to 2")):
        with pytest.raises(error, match=words):
            getattr(plotter, add)(mesh, scalars="speed", component=wrong)
    with pytest.raises(TypeError, match="give one column as scalars"):
        getattr(plotter, add)(mesh, component=1)
    faint = getattr(plotter, add)(mesh, scalars="speed", component=0, nan_color="red", nan_opacity=0.25)
    assert faint.nan_color.float_rgba == pytest.approx((1.0, 0.0, 0.0, 0.25), abs=0.01)
    with pytest.raises(ValueError, match="nan_opacity is 2"):
        getattr(plotter, add)(mesh, nan_opacity=2)


@pytest.mark.parametrize("add", ADDS)
def test_a_copied_mesh_may_change(plotter, add):
    points = np.random.default_rng(0).normal(size=(40, 3)).cumsum(axis=0)
    for copied in (True, False):
        mesh = pv.MultipleLines(points.copy())
        actor = getattr(plotter, add)(mesh, copy_mesh=copied, color="red", name="lines")
        before = actor.bounds
        mesh.points += 100.0
        with nullcontext() if copied else pytest.warns(UserWarning, match="points of the PolyData changed"):
            plotter.render()
        assert actor.bounds == before


def test_outlines_and_round_lines_of_scripts(plotter, three_lines):
    fiblets = plotter.add_fiblets(three_lines, silhouette=True, render_lines_as_tubes=True)
    assert fiblets.halos
    assert fiblets.prop.render_lines_as_tubes
    assert plotter.add_spline_tubes(three_lines, silhouette=True, render_lines_as_tubes=True).silhouette
    with pytest.raises(TypeError, match=r"takes no silhouette: set actor.halos"):
        plotter.add_fiblets(three_lines, silhouette={"color": "red"})
    with pytest.raises(TypeError, match="tubes are round"):
        plotter.add_spline_tubes(three_lines, render_lines_as_tubes=False)


@pytest.mark.parametrize("add", ["add_fiblets", "add_spline_tubes"])
def test_light_of_the_property_is_drawn(plotter, three_lines, add):
    looks = {"radius": 3.0} if add == "add_spline_tubes" else {"line_width": 6, "lighting": True}
    actor = getattr(plotter, add)(three_lines, color="red", **looks)
    before = plotter.screenshot()
    for name, value in LIGHT.items():
        setattr(actor.prop, name, value)
        plotter.render()
        after = plotter.screenshot()
        assert np.abs(after.astype(int) - before).max() > 20, name
        before = after


def test_tables_for_pandas_and_arrow(three_lines):
    table = three_lines.table()
    frame = pytest.importorskip("pandas").DataFrame(table)
    assert table.to_pandas().equals(frame)
    pytest.importorskip("pyarrow")
    assert table.to_arrow().column_names == list(table)
    np.testing.assert_array_equal(table.to_arrow()["weight"], three_lines.per_streamline["weight"])


def test_the_colour_cycler_colours_tubes(plotter, three_lines):
    plotter.set_color_cycler(["red", "lime", "blue"])
    found = [plotter.add_spline_tubes(three_lines).prop.color.name for _ in range(2)]
    assert found == ["red", "lime"]
    assert plotter.add_spline_tubes(three_lines, color="white").prop.color.name == "white"


@pytest.mark.parametrize("add", ["add_fiblets", "add_spline_tubes", "add_halo_lines"])
@pytest.mark.parametrize(("name", "value"), [("style", "wireframe"), ("show_edges", True), ("culling", "front")])
def test_facets_are_none_of_lines(plotter, add, name, value):
    actor = getattr(plotter, add)(np.linspace([0.0, 0.0, 0.0], [9.0, 5.0, 1.0], 20))
    with pytest.warns(UserWarning, match=rf"prop\.{name} changes nothing here: .* have no facets"):
        setattr(actor.prop, name, value)


@pytest.fixture
def add(request, plotter, three_lines):
    """Return a function that adds the data that a method is for."""
    image = pv.ImageData(dimensions=(4, 4, 4))
    image["values"] = np.arange(64.0)
    sources = {"add_raycast_volume": image, "add_halo_points": np.random.default_rng(1).random((20, 3))}
    return lambda **more: getattr(plotter, request.param)(sources.get(request.param, three_lines), **more)


EVERY = [*ADDS, "add_halo_points", "add_raycast_volume"]


WORDS = sorted(set(inspect.signature(pv.Plotter.add_mesh).parameters) - {"self", "mesh", "kwargs"})


@pytest.mark.parametrize("add", EVERY, indirect=True)
def test_every_word_of_add_mesh_is_taken_or_explained(add, request):
    name = request.node.callspec.params["add"]
    with pytest.raises(TypeError, match="name is 3; give a string"):
        add(name=3)
    known = inspect.signature(getattr(pv.Plotter(off_screen=True), name)).parameters
    for word in set(WORDS) - set(known):
        with pytest.raises((TypeError, ValueError), match=rf"takes no {word}: \w|{word} of add_volume \w") as told:
            add(**{word: True})
        if "actor.prop." in str(told.value):  # what it advises is no advice that warns
            actor = add()
            place = str(told.value).partition("actor.prop.")[2].partition(" ")[0]
            setattr(actor.prop, place, {"interpolation": "pbr"}.get(place, getattr(actor.prop, place)))


@pytest.mark.parametrize("add", EVERY, indirect=True)
@pytest.mark.parametrize(("name", "value"), [("texture", pv.Texture), ("backface_prop", pv.Property)])
def test_what_needs_surfaces_says_so_once(add, plotter, name, value):
    actor = add()
    plotter.render()
    given = value(np.zeros((2, 2, 3), np.uint8)) if name == "texture" else value(color="red")
    with pytest.warns(UserWarning, match=rf"actor\.{name} changes nothing here: there are no"):
        setattr(actor, name, given)
    actor.position = 1.0, 0.0, 0.0  # says no more of it
    assert getattr(actor, name) is not None


@pytest.mark.parametrize("add", EVERY, indirect=True)
def test_pickling_says_what_to_pickle(add):
    actor = add()
    with pytest.raises(TypeError, match=r"cannot be pickled, .*pickle its data \(actor\.\w+\)") as told:
        pickle.dumps(actor)
    held = getattr(actor, str(told.value).partition("(actor.")[2].partition(")")[0])
    twin = pickle.loads(pickle.dumps(held))
    assert type(twin) is type(held)
    np.testing.assert_array_equal(np.ravel(twin.bounds), np.ravel(held.bounds))


@pytest.mark.parametrize("add", ADDS, indirect=True)
def test_the_plotter_has_a_mapper_whose_range_can_be_set(add, plotter):
    """Of one colour as well, as after ``add_mesh``."""
    actor = add(color="red")
    assert plotter.mapper is actor.mapper
    with pytest.warns(UserWarning, match=r"the range \(2, 3\) has no effect yet: .* one colour"):
        plotter.update_scalar_bar_range([2, 3])
    actor.scalars = np.arange(3.0)
    assert actor.clim == (2.0, 3.0)


def words_of(mapper):
    """What PyVista adds to a mapper of VTK's, beside what it keeps to itself."""
    vtks = set(dir(next(kind for kind in type(mapper).__mro__ if kind.__module__.startswith("vtkmodules"))))
    return {name for name in dir(type(mapper)) if name[0].islower() and name not in vtks}


@pytest.mark.parametrize("add", EVERY, indirect=True)
def test_words_of_mappers_are_taken_or_explained(add, plotter, request):
    """None is silent: a mapper of VTK's takes any attribute, and nobody would read it."""
    volume = request.node.callspec.params["add"] == "add_raycast_volume"
    image = pv.ImageData(dimensions=(3, 3, 3))
    image["v"] = np.arange(27.0)
    theirs = plotter.add_volume(image).mapper if volume else plotter.add_mesh(pv.Sphere()).mapper
    ours = add().mapper
    kept = {"bounds_size", "check_attribute", "resolve", "static"}  # of bounds, of Python, and of triangles
    if volume:
        actor = add()
        assert actor.mapper.blend_mode == "composite"
        actor.mapper.blend_mode = "maximum"
        assert (actor.mode, actor.mapper.blend_mode) == ("mip", "maximum")
        with pytest.raises(ValueError, match="blending='additive' adds up"):
            actor.mapper.blend_mode = "additive"
    for name in words_of(theirs) - kept:
        assert hasattr(type(ours), name), name
        if hasattr(ours, name):
            continue
        with pytest.raises(AttributeError, match=rf"this mapper has no {name}: \w"):
            getattr(ours, name)
        with pytest.raises(AttributeError, match=rf"this mapper has no {name}: \w"):
            setattr(ours, name, 1)


@pytest.mark.parametrize("add", ADDS, indirect=True)
def test_the_array_and_the_data_of_a_mapper(add, request):
    actor = add()
    assert actor.mapper.array_name == ("orientation" if request.node.callspec.params["add"] == "add_fiblets" else "")
    actor.mapper.array_name = "arc_length"
    assert actor.scalars == actor.mapper.array_name == "arc_length"
    other = pv.lines_from_points(np.linspace([0.0, 0.0, 0.0], [9.0, 5.0, 1.0], 20))
    if hasattr(actor, "update"):
        actor.mapper.dataset = other
        assert actor.fiblets.n_streamlines == 19
    else:
        with pytest.raises(AttributeError, match=r"set actor\.\w+ for other data"):
            actor.mapper.dataset = other
