"""PyVista's conventions hold for all that plotters add: fiblets, tubes, lines and points with halos, volumes."""

from __future__ import annotations

import gc
import inspect
import subprocess
import sys
import weakref

import numpy as np
import pytest
import pyvista as pv

from pvfiblets.codec.encoding.compress import compress
from pvfiblets.plotting import FibletActor

from .views import shot

LINES = [np.array([(-10.0, 0, z), (0, 0, z + 2), (10, 0, z)]) for z in (-6.0, 0.0, 6.0)]
WEIGHTS = np.array([1.0, 10.0, 100.0])
IMAGE = pv.ImageData(dimensions=(8, 8, 8), spacing=(2, 2, 2), origin=(-7, -7, -7))
IMAGE["density"] = 12.0 - np.linalg.norm(IMAGE.points, axis=1)

ADDERS = {
    "fiblets": ("add_fiblets", LINES, {"line_width": 3.0}),
    "spline_tubes": ("add_spline_tubes", LINES, {"radius": 1.0}),
    "halo_lines": ("add_halo_lines", LINES, {"line_width": 1.0, "strip_width": 4.0, "light_on_dark": True}),
    "halo_points": ("add_halo_points", np.concatenate(LINES), {"point_size": 2.0, "halo_size": 5.0, "color": "lime"}),
    "raycast_volumes": ("add_raycast_volume", IMAGE, {"mode": "isosurface", "values": 4.0, "show_scalar_bar": False}),
}
OF_LINES = ("fiblets", "spline_tubes", "halo_lines")
of_lines = pytest.mark.parametrize("kind", OF_LINES)
of_all = pytest.mark.parametrize("kind", ADDERS)


def add(plotter, kind, **arguments):
    name, source, settings = ADDERS[kind]
    return getattr(plotter, name)(source, **{**settings, **arguments})


def lit(picture):
    """How many pixels are not black."""
    return int((picture.max(axis=2) > 0).sum())


@pytest.mark.more
def test_no_import_of_the_package_is_needed():
    code = (
        "import numpy as np, pyvista as pv\n"
        "pl, line = pv.Plotter(off_screen=True), [(0, 0, 0), (1, 1, 1), (2, 0, 0)]\n"
        "for add, source, kept in (('add_fiblets', [line], 'fiblets'), ('add_spline_tubes', [line], 'spline_tubes'),\n"
        "    ('add_halo_lines', [line], 'halo_lines'), ('add_halo_points', line, 'halo_points'),\n"
        "    ('add_raycast_volume', np.eye(3)[None] + np.zeros((3, 1, 1)), 'raycast_volumes')):\n"
        "    assert {add, kept} <= set(dir(pl))\n"
        "    print(type(getattr(pl, add)(source)).__name__, len(getattr(pl, kept)))\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    kinds = ["FibletActor", "TubeActor", "HaloLineActor", "HaloPointActor", "VolumeActor"]
    assert done.stdout.split() == [word for kind in kinds for word in (kind, "1")], done.stderr


OLDER = """
import numpy as np
import pyvista as pv
plotter = pv.Plotter(off_screen=True, window_size=(100, 80))
line = np.array([(0, 0, 0), (5, 0, 3), (10, 0, 0)])
tubes = plotter.add_spline_tubes([line], radius=1.0, scalars="arc_length")
halos = plotter.add_halo_lines([line + (0, 0, 3)], scalars="arc_length")
points = plotter.add_halo_points(line + (0, 0, 5))
lines = plotter.add_fiblets([line + (0, 0, 8)], lighting=True)
lines.select([0], as_tubes=True, radius=0.5)
lines.illuminated = lines.ambient_occlusion = lines.depth_cue = lines.halos = True
assert plotter.halo_lines.screenshot().min() < 100
for actor in (tubes, halos, points, lines):
    actor.raise_pending()
plotter.close()
print("drawn")
"""


@pytest.mark.more
@pytest.mark.parametrize("version", [pytest.param("4.1", marks=pytest.mark.exhaustive), "3.3"])
def test_older_opengl_draws_them_too(older_opengl, version):
    """A process of its own: Mesa reads how old it has to be when it is loaded."""
    done = subprocess.run(
        [sys.executable, "-c", OLDER], capture_output=True, text=True, check=False, env=older_opengl(version)
    )
    assert done.stdout.split()[-1:] == ["drawn"], done.stderr[-2000:]


@of_all
def test_the_arguments_are_pyvistas_where_both_have_them(kind):
    ours = inspect.signature(getattr(pv.Plotter(off_screen=True), ADDERS[kind][0])).parameters
    volumes = kind == "raycast_volumes"
    theirs = inspect.signature(pv.Plotter.add_volume if volumes else pv.Plotter.add_mesh).parameters
    shared = {"scalars", "cmap", "clim", "opacity", "n_colors", "name", "render"}
    shared |= {"opacity_unit_distance"} if volumes else {"color", "label", "lighting"}
    assert shared <= set(ours) & set(theirs)
    named = inspect.Parameter.KEYWORD_ONLY, inspect.Parameter.VAR_KEYWORD
    assert all(parameter.kind in named for name, parameter in ours.items() if name != "source")


@of_all
def test_the_same_name_replaces(plotter, kind):
    first = add(plotter, kind, name="one")
    second = add(plotter, kind, name="one", color="red")
    assert plotter.actors["one"] is second
    assert list(getattr(plotter, kind)) == [second]
    assert first not in plotter.actors.values()


def test_each_component_has_its_own_actors(plotter):
    made = {kind: add(plotter, kind) for kind in ADDERS}
    assert {kind: list(getattr(plotter, kind)) for kind in ADDERS} == {kind: [one] for kind, one in made.items()}
    assert lit(shot(plotter)) > 200
    plotter.remove_actor(made.pop("fiblets"))
    assert [len(getattr(plotter, kind)) for kind in ADDERS] == [0, 1, 1, 1, 1]


@of_all
def test_the_camera_is_reset_as_by_add_mesh(kind):
    mesh, ours = pv.Plotter(off_screen=True), pv.Plotter(off_screen=True)
    mesh.add_mesh(pv.Box(add(ours, kind).bounds))
    for plotter in (mesh, ours):
        plotter.screenshot(None)
    np.testing.assert_allclose(ours.camera.position, mesh.camera.position, rtol=1e-6)
    np.testing.assert_allclose(ours.bounds, mesh.bounds)
    mesh.close()
    ours.close()


@of_lines
def test_the_scalar_bar_shows_the_pictures_own_table(plotter, kind):
    actor = add(plotter, kind, scalars=WEIGHTS, cmap="magma", clim=(1, 50))
    before, bar = shot(plotter), plotter.scalar_bars["Data"]
    assert bar.GetLookupTable() is actor.lookup_table
    actor.clim = (0, 7)
    assert bar.GetLookupTable().GetTableRange() == (0, 7)
    for scalars, titles in (
        ("length", ["length [mm]"]), ("orientation", []), (np.zeros((3, 3), np.uint8), []), (WEIGHTS, ["Data"]),
    ):  # fmt: skip
        actor.scalars = scalars
        assert list(plotter.scalar_bars.keys()) == titles
    plotter.update_scalar_bar_range((0, 1000), name="Data")
    assert actor.clim == (0, 1000)
    plotter.update_scalar_bar_range((0, 2000))
    assert actor.clim == (0, 2000)
    assert (shot(plotter) != before).any()
    plotter.remove_actor(actor)
    assert len(plotter.scalar_bars) == 0


@of_lines
def test_no_bar_for_colours_or_when_not_wanted_and_a_label_in_the_legend(plotter, kind):
    add(plotter, kind)
    add(plotter, kind, color="red", label="Tracts")
    add(plotter, kind, scalars=WEIGHTS, show_scalar_bar=False)
    assert len(plotter.scalar_bars) == 0
    add(plotter, kind, scalars=WEIGHTS, scalar_bar_args={"title": "Kilograms"})
    assert list(plotter.scalar_bars.keys()) == ["Kilograms"]
    legend = plotter.add_legend()
    assert legend.GetEntryString(0) == "Tracts"
    assert legend.GetEntryColor(0) == (1.0, 0.0, 0.0)


@of_all
def test_user_matrix_moves_the_bounds_and_the_picture(plotter, kind):
    matrix = np.diag([2.0, 2.0, 2.0, 1.0])
    matrix[:3, 3] = 100.0
    plain = np.array(add(plotter, kind, name="one").bounds)
    actor = add(plotter, kind, name="one", user_matrix=matrix)
    np.testing.assert_allclose(actor.bounds, 2.0 * plain + 100.0, rtol=1e-6)
    plotter.view_xz()
    assert lit(plotter.screenshot(None)) > 100


@of_all
def test_an_error_while_drawing_is_raised_by_the_call_that_rendered(plotter, kind, monkeypatch):
    actor = add(plotter, kind)
    plotter.show(auto_close=False)

    def broken(*_):
        raise RuntimeError("the engine is on fire")

    monkeypatch.setattr(type(actor.mapper), "_draw", broken)
    with pytest.raises(RuntimeError, match="on fire"):
        plotter.render()
    monkeypatch.undo()
    plotter.render()


@of_all
def test_removing_clearing_and_closing_give_memory_back_and_free_the_actor(kind):
    plotter = pv.Plotter(off_screen=True, window_size=(200, 200))
    for remove in ("remove_actor", "clear_actors", "close"):
        actor = add(plotter, kind)
        assert list(getattr(plotter, kind)) == [actor]
        assert lit(shot(plotter)) > 100
        assert actor.explain()["gpu_bytes"] > 200 * 200 * 8
        getattr(plotter, remove)(*[actor] * (remove == "remove_actor"))
        assert actor.explain()["gpu_bytes"] == 0
        assert remove == "close" or len(getattr(plotter, kind)) == 0
        if remove == "remove_actor":
            plotter.add_actor(actor)
            assert lit(shot(plotter)) > 100
            plotter.remove_actor(actor)
    plotter.close()
    gone = weakref.ref(actor)
    del plotter, actor
    gc.collect()
    assert gone() is None


@of_lines
def test_each_subplot_has_its_own_actors(kind):
    plotter = pv.Plotter(shape=(1, 2), off_screen=True, window_size=(400, 200), border=False)
    plotter.set_background("black", all_renderers=True)
    add(plotter, kind)
    plotter.subplot(0, 1)
    right = add(plotter, kind, color="red")
    for there in (True, False):
        picture = shot(plotter)
        assert lit(picture[:, :200]) > 50
        assert (lit(picture[:, 200:]) > 50) == there
        if there:
            plotter.remove_actor(right)
    assert lit(picture[:, 200:]) == 0
    assert len(getattr(plotter, kind)) == 1
    plotter.close()


@of_lines
def test_adding_to_a_shown_plotter_renders_unless_render_is_false(plotter, kind):
    plotter.camera_position = [(0, -60, 0), (0, 0, 0), (0, 0, 1)]
    plotter.show(auto_close=False)
    add(plotter, kind, render=False)
    assert lit(plotter.screenshot(None)) == 0
    add(plotter, kind, render=True)
    assert lit(plotter.screenshot(None)) > 100


@pytest.mark.parametrize(
    ("kind", "numbers", "features", "buffers"),
    [
        ("fiblets", {"pipeline": "compute"}, {"colour_orientation"}, {"gbuffer"}),
        ("spline_tubes", {"tubes_total": 3, "segments_total": 6}, {"colour_orientation", "tube_normal"},
         {"nodes", "segments", "gbuffer"}),
        ("halo_lines", {"lines_total": 3, "segments_total": 6, "points_total": 9}, {"colour_orientation", "strip"},
         {"gbuffer"}),
    ],
)  # fmt: skip
def test_explain_names_what_is_active(plotter, kind, numbers, features, buffers):
    add(plotter, kind, name="one", scalars="orientation")
    assert getattr(plotter, kind).explain()[0]["gpu_bytes"] == 0
    shot(plotter)
    report = getattr(plotter, kind).explain()[0]
    assert report["name"] == "one"
    assert {name: report[name] for name in numbers} == numbers
    assert features <= set(report["features"])
    assert buffers <= {row["name"] for row in report["buffers"]}
    assert all(item["ms"] >= 0.0 for item in report["passes"])
    assert report["gpu_bytes"] == sum(row["bytes"] for row in report["buffers"])


# Fiblets alone


@pytest.mark.parametrize("kind", ["streamlines", "fiblets", "polydata", "arrays", "trk", "compressed", "array"])
def test_every_kind_of_source_gives_the_same_picture(plotter, three_lines, tmp_path, kind):
    from pvfiblets import formats

    if kind == "trk":
        source = str(tmp_path / "lines.trk")
        formats.write(source, three_lines)
    elif kind == "compressed":
        source = tmp_path / "lines.fiblets"
        compress(three_lines).save(source)
    else:
        source = {
            "streamlines": three_lines, "fiblets": compress(three_lines), "polydata": three_lines.to_polydata(),
            "arrays": three_lines.to_list(), "array": three_lines[0],
        }[kind]  # fmt: skip
    actor = plotter.add_fiblets(source, lighting=False)
    assert isinstance(actor, FibletActor)
    assert actor.fiblets.n_streamlines == (1 if kind == "array" else 3)
    plotter.view_xy()
    if kind != "array":
        mesh = pv.Plotter(off_screen=True, window_size=plotter.window_size)
        mesh.set_background("black")
        mesh.disable_anti_aliasing()
        mesh.add_mesh(pv.wrap(three_lines.to_polydata()), color="white", lighting=False)
        mesh.camera = plotter.camera.copy()
        ours, theirs = plotter.screenshot(None), mesh.screenshot(None)
        mesh.close()
        assert lit(ours) == pytest.approx(lit(theirs), rel=0.05)


def test_what_cannot_be_added_is_refused_in_words(plotter, three_lines):
    for source in (3, None, b"lines.trk", pv.ImageData(dimensions=(2, 2, 2)), [np.zeros(2)]):
        with pytest.raises(TypeError, match=r"expected|has no lines"):
            plotter.add_fiblets(source)
    for name in ("add_halo_lines", "add_halo_points"):
        with pytest.raises(TypeError, match="object"):
            getattr(plotter, name)(object())
    with pytest.raises(ValueError, match="max_error cannot be applied"):
        plotter.add_fiblets(compress(three_lines), max_error=0.1)
    with pytest.raises(TypeError, match=r"add_fiblets\(\) takes no halos: .*actor.halos = "):
        plotter.add_fiblets(compress(three_lines), halos=True)
    with pytest.raises(TypeError, match=r"add_fiblets\(\) got an unexpected keyword argument 'colour'"):
        plotter.add_fiblets(three_lines, colour="red")
    three_lines.per_point["fa"] = np.arange(float(three_lines.n_points))
    # All that the source has, before any of it is left behind by compression.
    with pytest.raises(KeyError, match="no array 'md'. Per point: 'height', 'fa'; per streamline: 'weight'; built in"):
        plotter.add_fiblets(three_lines, scalars="md")
    assert not plotter.actors


def test_properties_take_effect_at_the_next_render(plotter, three_lines, colours_in):
    actor = plotter.add_fiblets(three_lines, lighting=False, line_width=3.0)
    plotter.view_xy()
    before = lit(shot(plotter))
    actor.visibility = False
    assert lit(shot(plotter)) == 0
    actor.visibility = True
    actor.line_width = 9.0
    assert lit(shot(plotter)) > 2 * before
    actor.color = "lime"
    assert colours_in(shot(plotter)) == {(0, 255, 0)}
    actor.opacity = 0.5
    assert colours_in(shot(plotter)) <= {(0, 127, 0), (0, 128, 0)}
    actor.opacity = 1.0
    actor.scalars = "weight"
    actor.cmap = ["blue", "red"]
    actor.clim = (0.0, 20.0)
    actor.n_colors = 2
    plotter.view_vector((1, 0.4, 0.7))
    assert {(0, 0, 255), (255, 0, 0)} <= colours_in(shot(plotter))
    actor.scalars = None
    actor.color = None
    plotter.view_xy()
    assert {(255, 0, 0), (0, 255, 0)} <= colours_in(shot(plotter))
    both = lit(shot(plotter))
    actor.fiblets = compress(three_lines[:1])
    assert 0 < lit(shot(plotter)) < both


def test_a_refused_change_leaves_the_actor_as_it_was(plotter, three_lines):
    actor = plotter.add_fiblets(three_lines, scalars="weight", clim=(0, 50))
    before = shot(plotter)
    with pytest.raises(ValueError, match="low one first"):
        actor.clim = (3, 1)
    with pytest.raises(KeyError, match="no array 'nothing'"):
        actor.scalars = "nothing"
    with pytest.raises(ValueError, match="n_colors"):
        actor.n_colors = -1
    with pytest.raises(ValueError, match="above zero"):
        actor.log_scale = True
    with pytest.raises(AttributeError):
        actor.colour = "red"
    assert (actor.clim, actor.scalars, actor.log_scale) == ((0, 50), "weight", False)
    np.testing.assert_array_equal(shot(plotter), before)


def test_a_bar_keeps_its_place_and_its_title_whatever_colours(plotter, three_lines):
    place = {"vertical": True, "position_x": 0.8, "position_y": 0.2, "height": 0.6}
    actor = plotter.add_fiblets(three_lines, scalars="length", scalar_bar_args=place)
    plotter.add_mesh(pv.Sphere(), scalars=np.zeros(842), scalar_bar_args={**place, "title": "of the sphere"})
    actor.color = "gold"
    assert list(plotter.scalar_bars.keys()) == ["of the sphere"]
    actor.scalars = "curvature"
    assert list(plotter.scalar_bars.keys()) == ["of the sphere", "curvature [1/mm]"]
    assert list(plotter.scalar_bars["curvature [1/mm]"].GetPosition()) == [0.8, 0.2]
    three_lines.groups = {"a": np.array([0]), "b": np.array([1])}
    actor = plotter.add_fiblets(three_lines, scalars="group", scalar_bar_args={"title": "T"})
    plotter.show(auto_close=False)
    for scalars, ticks in (("group", False), ("length", True), ("group", False)):
        actor.scalars = scalars
        plotter.render()
        assert bool(plotter.scalar_bars["T"].GetDrawTickLabels()) == ticks
