"""PyVista's conventions hold for ``plotter.add_halo_lines`` and ``plotter.add_halo_points``."""

from __future__ import annotations

import gc
import inspect
import subprocess
import sys
import weakref

import numpy as np
import pytest
import pyvista as pv

from pvfiblets.halos import HaloLines, HaloPoints

LINES = [np.array([(-10.0, 0, z), (0, 0, z + 2), (10, 0, z)]) for z in (-6.0, 0.0, 6.0)]
WEIGHTS = np.array([1.0, 10.0, 100.0])
WIDE = {"line_width": 1.0, "strip_width": 4.0}


def add(plotter, kind="lines", **arguments):
    if kind == "lines":
        return plotter.add_halo_lines(LINES, **{**WIDE, "light_on_dark": True, **arguments})
    points = np.concatenate(LINES)
    return plotter.add_halo_points(points, point_size=2.0, halo_size=5.0, light_on_dark=True, **arguments)


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
        "assert {'add_halo_lines', 'halo_lines', 'add_halo_points', 'halo_points'} <= set(dir(pl))\n"
        "lines, points = pl.add_halo_lines([[(0, 0, 0), (1, 1, 1)]]), pl.add_halo_points([(0, 0, 0), (1, 1, 1)])\n"
        "print(type(lines).__name__, type(points).__name__, len(pl.halo_lines), len(pl.halo_points))\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.stdout.split() == ["HaloLineActor", "HaloPointActor", "1", "1"], done.stderr


@pytest.mark.parametrize("name", ["add_halo_lines", "add_halo_points"])
def test_the_arguments_are_add_meshs_where_both_have_them(name):
    ours = inspect.signature(getattr(pv.Plotter(off_screen=True), name)).parameters
    theirs = inspect.signature(pv.Plotter.add_mesh).parameters
    shared = set(ours) & set(theirs)
    assert {"scalars", "color", "cmap", "clim", "opacity", "name", "label", "render", "rgb", "lighting"} <= shared
    assert all(parameter.kind is parameter.KEYWORD_ONLY for name, parameter in ours.items() if name != "source")


def polydata():
    mesh = pv.merge([pv.lines_from_points(line) for line in LINES])
    mesh.cell_data["each"] = np.arange(mesh.n_cells, dtype=float)
    mesh.point_data["height"] = mesh.points[:, 2]
    return mesh


def test_lines_come_from_every_kind_of_source(plotter, three_lines, tmp_path):
    from pvfiblets import compress, write

    write(tmp_path / "lines.tck", three_lines)
    sources = {
        "polydata": polydata(),
        "streamlines": three_lines,
        "fiblets": compress(three_lines),
        "array": LINES[0],
        "list": LINES,
        "segments": (np.concatenate(LINES), np.array([(0, 1), (1, 2), (3, 4)])),
        "lines": HaloLines(np.concatenate(LINES), [0, 3, 6, 9]),
        "path": tmp_path / "lines.tck",
        "name": str(tmp_path / "lines.tck"),
    }
    counts = {name: plotter.add_halo_lines(source).lines.n_segments for name, source in sources.items()}
    assert counts == {
        "polydata": 6, "streamlines": 120, "fiblets": 120, "array": 2, "list": 6, "segments": 3, "lines": 6,
        "path": 120, "name": 120,
    }  # fmt: skip


def test_points_come_from_every_kind_of_source(plotter, three_lines, tmp_path):
    cloud = pv.PolyData(np.concatenate(LINES))
    cloud.save(tmp_path / "cloud.ply")
    sources = {
        "polydata": (cloud, 9),
        "grid": (pv.ImageData(dimensions=(2, 3, 4)), 24),
        "streamlines": (three_lines, 123),
        "array": (LINES[0], 3),
        "points": (HaloPoints(LINES[0]), 3),
        "path": (tmp_path / "cloud.ply", 9),
    }
    for name, (source, count) in sources.items():
        assert plotter.add_halo_points(source).points.n_points == count, name


@pytest.mark.parametrize("name", ["add_halo_lines", "add_halo_points"])
def test_what_is_no_source_is_refused_and_leaves_nothing_behind(plotter, name):
    with pytest.raises(TypeError, match="object"):
        getattr(plotter, name)(object())
    assert not plotter.actors


def test_the_same_name_replaces(plotter):
    first = add(plotter, name="halos")
    second = add(plotter, name="halos", color="red")
    assert plotter.actors["halos"] is second
    assert list(plotter.halo_lines) == [second]
    assert first not in plotter.actors.values()


def test_lines_and_points_are_kept_apart(plotter):
    lines, points = add(plotter), add(plotter, "points")
    assert (list(plotter.halo_lines), list(plotter.halo_points)) == ([lines], [points])
    plotter.remove_actor(lines)
    assert (len(plotter.halo_lines), len(plotter.halo_points)) == (0, 1)


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
    actor.scalars = "arc_length"
    assert list(plotter.scalar_bars.keys()) == ["arc length [mm]"]
    actor.scalars = "orientation"
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
    add(plotter, color="red", label="Tracts")
    legend = plotter.add_legend()
    assert legend.GetEntryString(0) == "Tracts"
    assert legend.GetEntryColor(0) == (1.0, 0.0, 0.0)


def test_user_matrix_moves_the_bounds_and_the_picture(plotter):
    matrix = np.diag([2.0, 2.0, 2.0, 1.0])
    matrix[:3, 3] = 100.0
    actor = add(plotter, user_matrix=matrix)
    wanted = np.array(actor.lines.bounds) + np.tile([-2.0, 2.0], 3)  # half a strip
    np.testing.assert_allclose(actor.bounds, 2.0 * wanted + 100.0, rtol=1e-6)
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


@pytest.mark.parametrize("kind", ["lines", "points"])
def test_removing_an_actor_gives_its_gpu_memory_back(plotter, kind):
    actor = add(plotter, kind)
    plotter.show(auto_close=False)
    assert actor.explain()["gpu_bytes"] > 200 * 200 * 24
    plotter.remove_actor(actor, render=False)
    assert actor.explain()["gpu_bytes"] == 0
    assert len(plotter.halo_lines) + len(plotter.halo_points) == 0
    plotter.add_actor(actor)
    assert lit(plotter.screenshot(None)) > 100


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
    plotter.set_background("black", all_renderers=True)
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
    plotter.close()


def test_explain_names_what_is_active(plotter):
    add(plotter, name="halos", scalars="orientation")
    before = plotter.halo_lines.explain()[0]
    assert (before["gpu_bytes"], before["culling"]) == (0, None)
    shot(plotter)
    report = plotter.halo_lines.explain()[0]
    assert report["name"] == "halos"
    assert (report["lines_total"], report["segments_total"], report["points_total"]) == (3, 6, 9)
    assert {"colour_orientation", "strip"} <= set(report["features"])
    assert "gbuffer" in {row["name"] for row in report["buffers"]}
    assert all(item["ms"] >= 0.0 for item in report["passes"])
    assert report["gpu_bytes"] == sum(row["bytes"] for row in report["buffers"])


def test_adding_to_a_shown_plotter_renders_unless_told_not_to(plotter):
    plotter.show(auto_close=False)
    add(plotter, render=False, halo_color="red")
    assert lit(plotter.screenshot(None)) == 0
    add(plotter, render=True, halo_color="red")
    assert lit(plotter.screenshot(None)) > 100


OLDER = """
import numpy as np
import pyvista as pv
plotter = pv.Plotter(off_screen=True, window_size=(100, 80))
lines = plotter.add_halo_lines([np.array([(0, 0, 0), (5, 0, 3), (10, 0, 0)])], scalars="arc_length")
points = plotter.add_halo_points(np.array([(0, 0, 5), (5, 0, 8), (10, 0, 5)]))
picture = plotter.halo_lines.screenshot()
for actor in (lines, points):
    actor.raise_pending()
plotter.close()
print("drawn", int(picture.min() < 100))
"""


@pytest.mark.more
@pytest.mark.parametrize("version", [pytest.param("4.1", marks=pytest.mark.exhaustive), "3.3"])
def test_older_opengl_draws_halos_too(older_opengl, version):
    """A process of its own: Mesa reads how old it has to be when it is loaded."""
    done = subprocess.run(
        [sys.executable, "-c", OLDER], capture_output=True, text=True, check=False, env=older_opengl(version)
    )
    assert done.stdout.split()[-2:] == ["drawn", "1"], done.stderr[-2000:]
