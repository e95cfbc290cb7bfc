"""PyVista's conventions hold for ``plotter.add_spline_tubes``."""

from __future__ import annotations

import gc
import inspect
import subprocess
import sys
import weakref

import numpy as np
import pytest
import pyvista as pv

LINES = [np.array([(-10.0, 0, z), (0, 0, z + 2), (10, 0, z)]) for z in (-6.0, 0.0, 6.0)]
WEIGHTS = np.array([1.0, 10.0, 100.0])


def lit(picture):
    """How many pixels are not black."""
    return int((picture.max(axis=2) > 0).sum())


def shot(plotter):
    """Render, and return the picture: PyVista's screenshot alone shows the last render."""
    plotter.show(auto_close=False) if plotter._first_time else plotter.render()
    return plotter.screenshot(None)


def add(plotter, **arguments):
    return plotter.add_spline_tubes(LINES, radius=1.0, **arguments)


@pytest.mark.more
def test_no_import_of_the_package_is_needed():
    code = (
        "import pyvista as pv\n"
        "pl = pv.Plotter(off_screen=True)\n"
        "assert 'add_spline_tubes' in dir(pl)\n"
        "print(type(pl.add_spline_tubes([[(0, 0, 0), (1, 1, 1), (2, 0, 0)]])).__name__, len(pl.spline_tubes))\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.stdout.split() == ["TubeActor", "1"], done.stderr


def test_the_arguments_are_add_meshs_where_both_have_them():
    ours = inspect.signature(pv.Plotter(off_screen=True).add_spline_tubes).parameters
    theirs = inspect.signature(pv.Plotter.add_mesh).parameters
    shared = set(ours) & set(theirs)
    assert {"scalars", "color", "cmap", "clim", "opacity", "name", "label", "render", "rgb", "lighting"} <= shared
    assert all(parameter.kind is parameter.KEYWORD_ONLY for name, parameter in ours.items() if name != "source")


def test_the_same_name_replaces(plotter):
    first = add(plotter, name="tubes")
    second = add(plotter, name="tubes", color="red")
    assert plotter.actors["tubes"] is second
    assert list(plotter.spline_tubes) == [second]
    assert first not in plotter.actors.values()


def test_fiblets_and_tubes_are_kept_apart(plotter):
    lines, tubes = plotter.add_fiblets(LINES), add(plotter)
    assert (list(plotter.fiblets), list(plotter.spline_tubes)) == ([lines], [tubes])
    assert lit(shot(plotter)) > 200
    plotter.remove_actor(lines)
    assert (len(plotter.fiblets), len(plotter.spline_tubes)) == (0, 1)


def test_the_camera_is_reset_like_add_meshs():
    mesh, ours = pv.Plotter(off_screen=True), pv.Plotter(off_screen=True)
    actor = add(ours)
    mesh.add_mesh(pv.Box(actor.bounds))
    for plotter in (mesh, ours):
        plotter.screenshot(None)
    np.testing.assert_allclose(ours.camera.position, mesh.camera.position, rtol=1e-6)
    np.testing.assert_allclose(ours.bounds, mesh.bounds)
    mesh.close()
    ours.close()


def test_the_scalar_bar_shows_the_pictures_own_table(plotter):
    actor = add(plotter, scalars=WEIGHTS, cmap="magma", clim=(1, 50))
    bar = plotter.scalar_bars["Data"]
    assert bar.GetLookupTable() is actor.lookup_table
    actor.clim = (0, 7)
    assert bar.GetLookupTable().GetTableRange() == (0, 7)
    actor.scalars = "length"
    assert list(plotter.scalar_bars.keys()) == ["length [mm]"]
    actor.scalars = "radius"
    assert list(plotter.scalar_bars.keys()) == ["radius [mm]"]
    actor.scalars = "orientation"
    assert len(plotter.scalar_bars) == 0
    actor.scalars = np.zeros((3, 3), np.uint8)
    assert len(plotter.scalar_bars) == 0
    actor.scalars = WEIGHTS
    plotter.update_scalar_bar_range((0, 1000), name="Data")
    assert actor.clim == (0, 1000)
    plotter.remove_actor(actor)
    assert len(plotter.scalar_bars) == 0


def test_no_bar_for_colours_or_when_not_wanted(plotter):
    add(plotter)
    add(plotter, color="red")
    add(plotter, scalars=WEIGHTS, show_scalar_bar=False)
    assert len(plotter.scalar_bars) == 0
    add(plotter, scalars=WEIGHTS, scalar_bar_args={"title": "Kilograms"})
    assert list(plotter.scalar_bars.keys()) == ["Kilograms"]


def test_a_label_comes_into_the_legend(plotter):
    add(plotter, color="red", label="Vessels")
    legend = plotter.add_legend()
    assert legend.GetEntryString(0) == "Vessels"
    assert legend.GetEntryColor(0) == (1.0, 0.0, 0.0)


def test_user_matrix_moves_the_bounds_and_the_picture(plotter):
    matrix = np.diag([2.0, 2.0, 2.0, 1.0])
    matrix[:3, 3] = 100.0
    actor = add(plotter, user_matrix=matrix)
    np.testing.assert_allclose(actor.bounds, 2.0 * np.array(actor.tubes.bounds) + 100.0, rtol=1e-6)
    plotter.view_xz()
    assert lit(plotter.screenshot(None)) > 1000


def test_an_error_while_drawing_is_raised_by_the_call_that_rendered(plotter, monkeypatch):
    actor = add(plotter)
    plotter.show(auto_close=False)

    def broken(*_):
        raise RuntimeError("the engine is on fire")

    monkeypatch.setattr(type(actor.mapper), "_draw", broken)
    with pytest.raises(RuntimeError, match="on fire"):
        plotter.render()
    monkeypatch.undo()
    plotter.render()


def test_removing_an_actor_gives_its_gpu_memory_back(plotter):
    actor = add(plotter)
    plotter.show(auto_close=False)
    assert actor.explain()["gpu_bytes"] > 200 * 200 * 24
    plotter.remove_actor(actor, render=False)
    assert actor.explain()["gpu_bytes"] == 0
    assert len(plotter.spline_tubes) == 0
    plotter.add_actor(actor)
    assert lit(plotter.screenshot(None)) > 100


def test_clearing_the_plotter_gives_the_gpu_memory_back(plotter):
    actor = add(plotter)
    shot(plotter)
    plotter.clear_actors()
    assert actor.explain()["gpu_bytes"] == 0
    assert len(plotter.spline_tubes) == 0


def test_closing_gives_the_gpu_memory_back_and_frees_the_plotter():
    plotter = pv.Plotter(off_screen=True)
    actor = add(plotter, scalars=WEIGHTS)
    plotter.screenshot(None)
    plotter.close()
    assert actor.explain()["gpu_bytes"] == 0
    plotter.close()
    gone = weakref.ref(actor)
    del plotter, actor
    gc.collect()
    assert gone() is None


def test_each_subplot_has_its_own_actors():
    plotter = pv.Plotter(shape=(1, 2), off_screen=True, window_size=(400, 200), border=False)
    plotter.set_background("black")
    add(plotter)
    plotter.subplot(0, 1)
    right = add(plotter, color="red")
    picture = shot(plotter)
    assert lit(picture[:, :200]) > 50
    assert lit(picture[:, 200:]) > 50
    plotter.remove_actor(right)
    picture = shot(plotter)
    assert lit(picture[:, :200]) > 50
    assert lit(picture[:, 200:]) == 0
    assert len(plotter.spline_tubes) == 1
    plotter.close()


def test_an_actor_is_drawn_in_a_second_window(plotter):
    actor = add(plotter)
    other = pv.Plotter(off_screen=True, window_size=plotter.window_size)
    other.set_background("black")
    other.add_actor(actor)
    other.camera_position = plotter.camera_position
    for _ in range(2):
        assert lit(shot(plotter)) > 50
        assert lit(other.screenshot(None)) > 50
    other.close()


def test_adding_to_a_shown_plotter_renders_unless_told_not_to(plotter):
    plotter.show(auto_close=False)
    add(plotter, render=False)
    assert lit(plotter.screenshot(None)) == 0
    add(plotter, render=True)
    assert lit(plotter.screenshot(None)) > 100


def test_explain_names_what_is_active(plotter):
    add(plotter, name="tubes", scalars="orientation")
    before = plotter.spline_tubes.explain()[0]
    assert (before["gpu_bytes"], before["silhouettes"], before["solver"]) == (0, None, None)
    shot(plotter)
    report = plotter.spline_tubes.explain()[0]
    assert report["name"] == "tubes"
    assert (report["tubes_total"], report["segments_total"]) == (3, 6)
    assert report["primitives"] >= 2 * 6
    assert {"colour_orientation", "tube_normal"} <= set(report["features"])
    assert {row["name"] for row in report["buffers"]} >= {"nodes", "segments", "gbuffer"}
    assert all(item["ms"] >= 0.0 for item in report["passes"])
    assert report["gpu_bytes"] == sum(row["bytes"] for row in report["buffers"])


OLDER = """
import numpy as np
import pyvista as pv
plotter = pv.Plotter(off_screen=True, window_size=(100, 80))
tubes = plotter.add_spline_tubes([np.array([(0, 0, 0), (5, 0, 3), (10, 0, 0)])], radius=1.0, scalars="arc_length")
lines = plotter.add_fiblets([np.array([(0, 0, 5), (5, 0, 8), (10, 0, 5)])])
lines.select([0], as_tubes=True, radius=0.5)
plotter.show(auto_close=False)
for actor in (tubes, lines):
    actor.raise_pending()
plotter.close()
print("drawn")
"""


@pytest.mark.more
@pytest.mark.parametrize("version", [pytest.param("4.1", marks=pytest.mark.exhaustive), "3.3"])
def test_older_opengl_draws_tubes_too(older_opengl, version):
    """A process of its own: Mesa reads how old it has to be when it is loaded."""
    done = subprocess.run(
        [sys.executable, "-c", OLDER], capture_output=True, text=True, check=False, env=older_opengl(version)
    )
    assert done.stdout.split()[-1:] == ["drawn"], done.stderr[-2000:]


def test_pictures_with_peeling_and_supersampling_have_the_tubes(plotter):
    add(plotter, color="white", lighting=False)
    plotter.view_xz()
    plain = shot(plotter)
    plotter.enable_depth_peeling()
    assert (shot(plotter) == plain).all()
    plotter.disable_depth_peeling()
    plotter.enable_anti_aliasing("ssaa")
    smooth = shot(plotter)
    assert ((smooth > 0) & (smooth < 255)).any()
    assert smooth.sum(dtype=float) == pytest.approx(plain.sum(dtype=float), rel=0.02)
