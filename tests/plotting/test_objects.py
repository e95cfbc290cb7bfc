"""Sets and actors are used as PyVista's meshes and actors are: plotted, copied, updated, filmed."""

from __future__ import annotations

import copy

import numpy as np
import pytest
import pyvista as pv

import pvfiblets

from .views import shot


@pytest.mark.parametrize("compressed", [False, True])
def test_plot_is_a_plotter_with_the_lines(three_lines, compressed):
    data = pvfiblets.compress(three_lines) if compressed else three_lines
    window = {"window_size": (120, 100)}
    plotter = pv.Plotter(off_screen=True, **window)
    plotter.set_background("black")
    plotter.add_fiblets(data, color="red", lighting=False)
    plotter.add_axes()
    plotter.camera_position = "yz"
    wanted = shot(plotter)
    plotter.close()
    given = {"off_screen": True, "background": "black", "cpos": "yz", "return_img": True, "show_axes": True, **window}
    np.testing.assert_array_equal(data.plot(color="red", lighting=False, **given), wanted)
    with pytest.raises(TypeError, match="unexpected keyword argument 'colour'"):
        data.plot(colour="red", off_screen=True)


@pytest.mark.parametrize("add", ["add_fiblets", "add_spline_tubes", "add_halo_lines"])
def test_deep_copies_draw_the_same_and_go_their_own_way(plotter, three_lines, add):
    actor = getattr(plotter, add)(three_lines.to_polydata(), scalars="height", cmap="jet", show_scalar_bar=False)
    wanted = shot(plotter)
    twin, alike = copy.deepcopy(actor), copy.copy(actor)
    assert twin.prop is not actor.prop
    assert alike.prop is actor.prop
    plotter.remove_actor(actor)
    plotter.add_actor(twin)
    np.testing.assert_array_equal(shot(plotter), wanted)
    twin.cmap = "gray"
    assert actor.cmap == "jet"


def test_updates_draw_the_new_lines_with_the_old_settings(plotter, three_lines):
    actor = plotter.add_fiblets(three_lines, scalars="height", cmap="jet", line_width=2, show_scalar_bar=False)
    shot(plotter)
    moved = three_lines[:]
    moved.points = moved.points + np.float32([1.0, 2.0, 3.0])
    actor.update(moved)
    got = shot(plotter)
    plotter.add_fiblets(moved, scalars="height", cmap="jet", line_width=2, show_scalar_bar=False, name=actor.name)
    np.testing.assert_array_equal(got, shot(plotter))
    before = actor.fiblets
    with pytest.raises(KeyError, match="no array 'height'"):  # a refused update changes nothing
        actor.update([[(0, 0, 0), (1, 1, 1)]])
    assert actor.fiblets is before


def test_datasets_are_the_lines_that_are_drawn(plotter, three_lines):
    for add in ("add_fiblets", "add_halo_lines", "add_spline_tubes"):
        actor = getattr(plotter, add)(three_lines.to_polydata(), scalars="height")
        data = actor.mapper.dataset
        assert isinstance(data, pv.PolyData)
        np.testing.assert_allclose(data.bounds, three_lines.bounds, atol=0.06)
        assert data.n_points == 123
        np.testing.assert_allclose(data["height"], three_lines.per_point["height"], atol=1e-2)
    assert plotter.add_halo_points(np.eye(3)).mapper.dataset.n_points == 3


@pytest.mark.parametrize("add", ["add_fiblets", "add_spline_tubes", "add_halo_lines", "add_raycast_volume"])
def test_changes_in_place_warn_once(plotter, three_lines, add):
    mesh = three_lines.to_polydata()
    if add == "add_raycast_volume":
        mesh = pv.ImageData(dimensions=(4, 4, 4))
        mesh["height"] = np.arange(64.0)
    actor = getattr(plotter, add)(mesh, scalars="height")
    plotter.show(auto_close=False)
    mesh["other"] = np.zeros(mesh.n_points)  # is nobody's business
    mesh.set_active_scalars("other")
    plotter.render()
    mesh["height"][:3] = 0.25
    how = r"actor.update\(mesh\)" if hasattr(actor, "update") else rf"{add}\(mesh, name="
    with pytest.warns(UserWarning, match=rf"array 'height' of the .* changed after {add}\(\) had copied it.*{how}"):
        plotter.render()
    plotter.render()
    if add == "add_fiblets":
        actor = plotter.add_fiblets(mesh, scalars="height", name="anew")
        mesh.points[:, 2] += 5.0
        with pytest.warns(UserWarning, match="points of the PolyData changed"):
            plotter.render()
        actor = plotter.add_fiblets(mesh, scalars="height", name="anew")
        mesh.points[:, 2] += 5.0
        actor.update(mesh)
        plotter.render()
        assert actor.fiblets.bounds[4] == pytest.approx(mesh.bounds[4], abs=0.01)


imageio = pytest.importorskip("imageio.v3")

LINES = [np.linspace([0.0, 0.0, k], [9.0, 5.0 * k, k], 20) for k in range(3)]


@pytest.fixture
def plotter():
    plotter = pv.Plotter(off_screen=True, window_size=(96, 64))  # sizes that films of all codecs may have
    plotter.set_background("black")
    yield plotter
    plotter.close()


def image():
    ball = pv.ImageData(dimensions=(8, 8, 8))
    ball["values"] = np.exp(-(((np.mgrid[:8, :8, :8] - 3.5) ** 2).sum(axis=0)) / 8.0).ravel(order="F")
    return ball


ADDED = {
    "fiblets": lambda plotter: plotter.add_fiblets(LINES, line_width=3, color="red"),
    "tubes": lambda plotter: plotter.add_spline_tubes(LINES, radius=1.0, color="red"),
    "halos": lambda plotter: plotter.add_halo_lines(LINES, light_on_dark=True),
    "volume": lambda plotter: plotter.add_raycast_volume(image(), show_scalar_bar=False),
}


@pytest.mark.few(1)
@pytest.mark.parametrize("what", ADDED)
def test_frames_are_screenshots(plotter, tmp_path, what):
    ADDED[what](plotter)
    plotter.open_gif(str(tmp_path / "a.gif"), loop=0)
    shown = []
    for _ in range(3):
        plotter.camera.azimuth += 40.0
        plotter.write_frame()
        shown.append(plotter.screenshot())
    plotter.close()
    frames = imageio.imread(tmp_path / "a.gif")
    assert len(frames) == 3
    for frame, picture in zip(frames, shown, strict=True):
        assert picture.any()
        assert np.abs(frame[..., :3].astype(int) - picture).mean() < 8.0  # of a palette


def test_lines_that_grow(plotter, tmp_path):
    actor = plotter.add_fiblets([line[:5] for line in LINES], line_width=3, color="red")
    plotter.view_xy()
    plotter.camera.zoom(0.3)
    plotter.open_gif(str(tmp_path / "a.gif"))
    for points in (5, 12, 20):
        actor.update([line[:points] for line in LINES])
        plotter.write_frame()
    plotter.close()
    frames = imageio.imread(tmp_path / "a.gif")[..., :3].astype(int)
    inked = [int((frame.sum(axis=-1) > 60).sum()) for frame in frames]
    assert 0 < inked[0] < inked[1] < inked[2]
