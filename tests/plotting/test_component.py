"""PyVista's conventions hold for ``plotter.add_fiblets``."""

from __future__ import annotations

import gc
import inspect
import subprocess
import sys

import numpy as np
import pytest
import pyvista as pv

from pvfiblets.codec.compress import compress
from pvfiblets.plotting import FibletActor
from pvfiblets.synthetic import brain_streamlines


def lit(picture):
    """How many pixels are not black."""
    return int((picture.max(axis=2) > 0).sum())


def shot(plotter):
    """Render, and return the picture: PyVista's screenshot alone shows the last render."""
    plotter.show(auto_close=False) if plotter._first_time else plotter.render()
    return plotter.screenshot(None)


@pytest.mark.more
def test_no_import_of_the_package_is_needed():
    code = (
        "import pyvista as pv\n"
        "pl = pv.Plotter(off_screen=True)\n"
        "assert 'add_fiblets' in dir(pl)\n"
        "print(type(pl.add_fiblets([[(0, 0, 0), (1, 1, 1), (2, 0, 0)]])).__name__)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.stdout.strip() == "FibletActor", done.stderr


def test_the_arguments_are_add_meshs_where_both_have_them():
    ours = inspect.signature(pv.Plotter(off_screen=True).add_fiblets).parameters
    theirs = inspect.signature(pv.Plotter.add_mesh).parameters
    shared = set(ours) & set(theirs)
    assert {"scalars", "color", "cmap", "clim", "opacity", "name", "label", "render"} <= shared
    assert all(
        parameter.kind in (parameter.KEYWORD_ONLY, parameter.VAR_KEYWORD)
        for name, parameter in ours.items()
        if name != "source"
    )


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
            "streamlines": three_lines,
            "fiblets": compress(three_lines),
            "polydata": three_lines.to_polydata(),
            "arrays": three_lines.to_list(),
            "array": three_lines[0],
        }[kind]
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


@pytest.mark.parametrize("source", [3, None, b"lines.trk", pv.ImageData(dimensions=(2, 2, 2)), [np.zeros(2)]])
def test_an_unknown_kind_of_source_is_refused_in_words(plotter, source):
    with pytest.raises(TypeError, match=r"expected|has no lines"):
        plotter.add_fiblets(source)


def test_compressing_options_on_compressed_data_are_refused(plotter, three_lines):
    with pytest.raises(ValueError, match="max_error cannot be applied"):
        plotter.add_fiblets(compress(three_lines), max_error=0.1)


def test_unknown_arguments_are_told_of_the_function_that_was_called(plotter, three_lines):
    with pytest.raises(TypeError, match=r"add_fiblets\(\) takes no halos: .*actor.halos = "):
        plotter.add_fiblets(compress(three_lines), halos=True)
    with pytest.raises(TypeError, match=r"add_fiblets\(\) got an unexpected keyword argument 'colour'"):
        plotter.add_fiblets(three_lines, colour="red")


def test_the_same_name_replaces(plotter, three_lines):
    first = plotter.add_fiblets(three_lines, name="lines")
    second = plotter.add_fiblets(three_lines, name="lines", color="red")
    assert plotter.actors["lines"] is second
    assert list(plotter.fiblets) == [second]
    assert first not in plotter.actors.values()


def test_the_camera_is_reset_like_add_meshs(three_lines):
    mesh, ours = pv.Plotter(off_screen=True), pv.Plotter(off_screen=True)
    mesh.add_mesh(pv.wrap(three_lines.to_polydata()))
    ours.add_fiblets(three_lines)
    for plotter in (mesh, ours):
        plotter.screenshot(None)
    np.testing.assert_allclose(ours.camera.position, mesh.camera.position, rtol=1e-2)
    np.testing.assert_allclose(ours.bounds, mesh.bounds, atol=0.05)


def test_properties_take_effect_at_the_next_render(plotter, three_lines, colours_in):
    actor = plotter.add_fiblets(three_lines, lighting=False, line_width=3.0)
    plotter.view_xy()
    before = shot(plotter)
    actor.visibility = False
    assert lit(shot(plotter)) == 0
    actor.visibility = True
    actor.line_width = 9.0
    assert lit(shot(plotter)) > 2 * lit(before)
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


def test_a_refused_change_leaves_the_actor_as_it_was(plotter, three_lines):
    actor = plotter.add_fiblets(three_lines, scalars="weight", clim=(0, 50))
    before = shot(plotter)
    with pytest.raises(ValueError, match="low one first"):
        actor.clim = (3, 1)
    with pytest.raises(KeyError, match="no array 'nothing'"):
        actor.scalars = "nothing"
    with pytest.raises(ValueError, match="n_colors"):
        actor.n_colors = -1
    with pytest.raises(AttributeError):
        actor.colour = "red"
    assert actor.clim == (0, 50)
    assert actor.scalars == "weight"
    np.testing.assert_array_equal(shot(plotter), before)


def test_the_scalar_bar_shows_the_pictures_own_table(plotter, three_lines):
    actor = plotter.add_fiblets(three_lines, scalars="weight", cmap="magma", clim=(1, 50))
    bar = plotter.scalar_bars["weight"]
    assert bar.GetLookupTable() is actor.lookup_table
    actor.clim = (0, 7)
    assert bar.GetLookupTable().GetTableRange() == (0, 7)
    actor.scalars = "length"
    assert list(plotter.scalar_bars.keys()) == ["length [mm]"]
    actor.scalars = "orientation"
    assert len(plotter.scalar_bars) == 0
    actor.scalars = "weight"
    assert list(plotter.scalar_bars.keys()) == ["weight"]
    plotter.remove_actor(actor)
    assert len(plotter.scalar_bars) == 0


def test_pyvistas_own_way_to_change_a_bars_range_changes_the_picture(plotter, three_lines):
    actor = plotter.add_fiblets(three_lines, scalars="weight", clim=(1, 50))
    before = shot(plotter)
    plotter.update_scalar_bar_range((0, 1000), name="weight")
    assert actor.clim == (0, 1000)
    plotter.update_scalar_bar_range((0, 2000))
    assert actor.clim == (0, 2000)
    assert (shot(plotter) != before).any()


def test_two_actors_that_share_a_bar_share_its_range(plotter, three_lines):
    first = plotter.add_fiblets(three_lines, scalars="weight", clim=(0, 10))
    second = plotter.add_fiblets(three_lines, scalars="weight", clim=(5, 90))
    assert first.clim == second.clim == (0, 90)
    assert len(plotter.scalar_bars) == 1


def test_a_bar_at_a_place_of_its_own_goes_with_the_numbers(plotter, three_lines):
    place = {"vertical": True, "position_x": 0.8, "position_y": 0.2, "height": 0.6}
    actor = plotter.add_fiblets(three_lines, scalars="length", scalar_bar_args=place)
    plotter.add_mesh(pv.Sphere(), scalars=np.zeros(842), scalar_bar_args={**place, "title": "of the sphere"})
    actor.color = "gold"
    assert list(plotter.scalar_bars.keys()) == ["of the sphere"]
    actor.scalars = "curvature"
    assert list(plotter.scalar_bars.keys()) == ["of the sphere", "curvature [1/mm]"]
    assert list(plotter.scalar_bars["curvature [1/mm]"].GetPosition()) == [0.8, 0.2]


def test_no_bar_for_colours_or_when_not_wanted(plotter, three_lines):
    plotter.add_fiblets(three_lines)
    plotter.add_fiblets(three_lines, color="red")
    plotter.add_fiblets(three_lines, scalars="weight", show_scalar_bar=False)
    assert len(plotter.scalar_bars) == 0
    plotter.add_fiblets(three_lines, scalars="weight", scalar_bar_args={"title": "Kilograms"})
    assert list(plotter.scalar_bars.keys()) == ["Kilograms"]


def test_a_label_comes_into_the_legend(plotter, three_lines):
    plotter.add_fiblets(three_lines, color="red", label="Tracts")
    legend = plotter.add_legend()
    assert legend.GetEntryString(0) == "Tracts"
    assert legend.GetEntryColor(0) == (1.0, 0.0, 0.0)


def test_user_matrix_moves_the_bounds_and_the_picture(plotter, three_lines):
    matrix = np.diag([2.0, 2.0, 2.0, 1.0])
    matrix[:3, 3] = 100.0
    actor = plotter.add_fiblets(three_lines, user_matrix=matrix)
    expected = 2.0 * np.array(three_lines.bounds) + 100.0
    np.testing.assert_allclose(actor.bounds, expected, atol=0.1)
    plotter.view_xy()
    assert lit(plotter.screenshot(None)) > 100


def test_an_error_while_drawing_is_raised_by_the_call_that_rendered(plotter, three_lines, monkeypatch):
    actor = plotter.add_fiblets(three_lines)
    plotter.show(auto_close=False)

    def broken(*_):
        raise RuntimeError("the engine is on fire")

    monkeypatch.setattr(type(actor.mapper), "_draw", broken)
    with pytest.raises(RuntimeError, match="on fire"):
        plotter.render()
    monkeypatch.undo()
    plotter.render()


def test_removing_an_actor_gives_its_gpu_memory_back(plotter):
    actor = plotter.add_fiblets(brain_streamlines(200))
    plotter.show(auto_close=False)
    assert actor.explain()["gpu_bytes"] > actor.fiblets.n_points
    plotter.remove_actor(actor, render=False)
    assert actor.explain()["gpu_bytes"] == 0
    assert len(plotter.fiblets) == 0
    plotter.add_actor(actor)
    assert lit(plotter.screenshot(None)) > 100


def test_closing_gives_the_gpu_memory_back_and_twice_is_harmless(three_lines):
    plotter = pv.Plotter(off_screen=True)
    actor = plotter.add_fiblets(three_lines)
    plotter.screenshot(None)
    plotter.close()
    assert actor.explain()["gpu_bytes"] == 0
    plotter.close()


def test_a_closed_plotter_is_freed(three_lines):
    import weakref

    plotter = pv.Plotter(off_screen=True)
    actor = plotter.add_fiblets(three_lines, scalars="weight")
    plotter.screenshot(None)
    plotter.close()
    gone = weakref.ref(actor)
    del plotter, actor
    gc.collect()
    assert gone() is None


def test_each_subplot_has_its_own_actors(three_lines):
    plotter = pv.Plotter(shape=(1, 2), off_screen=True, window_size=(400, 200), border=False)
    plotter.set_background("black")
    plotter.add_fiblets(three_lines)
    plotter.subplot(0, 1)
    right = plotter.add_fiblets(three_lines, color="red")
    picture = shot(plotter)
    assert lit(picture[:, :200]) > 50
    assert lit(picture[:, 200:]) > 50
    plotter.remove_actor(right)
    picture = shot(plotter)
    assert lit(picture[:, :200]) > 50
    assert lit(picture[:, 200:]) == 0
    assert len(plotter.fiblets) == 1


def test_a_copy_draws_the_same_and_is_another(plotter, three_lines):
    actor = plotter.add_fiblets(three_lines, scalars="weight", show_scalar_bar=False, line_width=4.0)
    plotter.view_xy()
    before = shot(plotter)
    twin = actor.copy()
    plotter.remove_actor(actor)
    plotter.add_actor(twin, reset_camera=False)
    np.testing.assert_array_equal(shot(plotter), before)
    twin.opacity = 0.25
    assert actor.opacity == 1.0


def test_clearing_the_plotter_gives_the_gpu_memory_back(plotter, three_lines):
    actor = plotter.add_fiblets(three_lines)
    shot(plotter)
    plotter.clear_actors()
    assert actor.explain()["gpu_bytes"] == 0
    assert len(plotter.fiblets) == 0


def test_adding_to_a_shown_plotter_renders_unless_told_not_to(plotter, three_lines):
    plotter.show(auto_close=False)
    plotter.add_fiblets(three_lines, render=False)
    assert lit(plotter.screenshot(None)) == 0
    plotter.add_fiblets(three_lines, render=True)
    assert lit(plotter.screenshot(None)) > 100


def test_explain_names_what_is_active(plotter, three_lines):
    actor = plotter.add_fiblets(three_lines, name="lines")
    shot(plotter)
    report = actor.explain()
    assert {"passes", "features", "buffers", "gpu_bytes", "fiblets_total"} <= set(report)
    assert all(item["ms"] >= 0.0 for item in report["passes"])
    assert plotter.fiblets.explain()[0]["name"] == "lines"


def test_other_fiblets_may_be_put_into_an_actor(plotter, three_lines):
    actor = plotter.add_fiblets(three_lines, scalars="weight", show_scalar_bar=False)
    plotter.view_xy()
    both = lit(shot(plotter))
    actor.fiblets = compress(three_lines[:1])
    assert 0 < lit(shot(plotter)) < both


def test_a_bar_of_a_fixed_title_has_numbers_or_labels(plotter, three_lines):
    three_lines.groups = {"a": np.array([0]), "b": np.array([1])}
    actor = plotter.add_fiblets(three_lines, scalars="group", scalar_bar_args={"title": "T"})
    plotter.show(auto_close=False)
    assert not plotter.scalar_bars["T"].GetDrawTickLabels()
    actor.scalars = "length"
    plotter.render()
    assert plotter.scalar_bars["T"].GetDrawTickLabels()
    actor.scalars = "group"
    assert not plotter.scalar_bars["T"].GetDrawTickLabels()
