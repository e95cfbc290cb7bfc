"""``style="ends"``: end points of streamlines beside VTK's own points, and beside float64."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv
from vtkmodules.vtkRenderingCore import vtkPropPicker

from pvfiblets.mappers import readable
from pvfiblets.streamlines import Streamlines
from pvfiblets.synthetic import brain_streamlines
from tests.engine.pictures import near

SIZE = (300, 240)


def end_points(lines):
    """(2n, 3) the first and the last point of each."""
    offsets = np.asarray(lines.offsets)
    return np.asarray(lines.points)[np.stack([offsets[:-1], offsets[1:] - 1], axis=1).ravel()]


@pytest.fixture
def brain():
    return brain_streamlines(80, seed=4)


@pytest.fixture
def window():
    """Return a maker of plotters on black, without anti-aliasing."""
    made = []

    def make():
        plotter = pv.Plotter(off_screen=True, window_size=SIZE)
        plotter.set_background("black")
        plotter.disable_anti_aliasing()
        plotter.picture.antialias = "off"
        made.append(plotter)
        return plotter

    yield make
    for plotter in made:
        plotter.close()


def picture(plotter):
    plotter.render()
    return plotter.screenshot(return_img=True).astype(int)


def in_window(plotter, points):
    """(n, 2) pixels from the lower left corner, in float64."""
    camera = plotter.camera
    matrix = pv.array_from_vtkmatrix(
        camera.GetCompositeProjectionTransformMatrix(SIZE[0] / SIZE[1], -1, 1)
    )
    clip = np.c_[points, np.ones(len(points))] @ matrix.T
    return (clip[:, :2] / clip[:, 3:] + 1) / 2 * SIZE


def test_ends_cover_what_points_of_vtk_cover(window, brain):
    """Round points of VTK of the same size and colours, at the same places; half a pixel apart at most."""
    theirs = window()
    cloud = pv.PolyData(end_points(brain))
    cloud["height"] = cloud.points[:, 2]
    looks = {"clim": (-50.0, 60.0), "cmap": "viridis", "show_scalar_bar": False, "point_size": 9}
    theirs.add_mesh(cloud, style="points", render_points_as_spheres=True, lighting=False, **looks)
    wanted = picture(theirs)
    ours = window()
    height = np.asarray(brain.points)[:, 2]
    actor = ours.add_fiblets(brain, scalars=height, style="ends", lighting=False, **looks)
    ours.camera_position = theirs.camera_position
    ours.camera.clipping_range = theirs.camera.clipping_range
    found = picture(ours)
    assert actor.style == "ends"
    assert actor.point_size == actor.prop.point_size == 9
    drawn, expected = found.any(-1), wanted.any(-1)
    assert expected.sum() > 5000
    assert not (drawn & ~near(expected)).any()
    assert not (expected & ~near(drawn)).any()
    both = drawn & expected
    assert both.sum() > 0.93 * (drawn | expected).sum()
    assert (np.abs(found - wanted).max(-1) <= 3)[both].mean() > 0.95  # elsewhere another point is in front


def test_size_and_style_are_live_and_widths_and_tubes_return(window, three_lines):
    plotter = window()
    actor = plotter.add_fiblets(three_lines, color="white", lighting=False, line_width=3)
    lines = picture(plotter)
    actor.tube_radius = 1.0
    tubes = picture(plotter)
    actor.style = "ends"
    areas = []
    for size in (4, 12):
        actor.point_size = size
        discs = picture(plotter).any(-1)
        areas.append(discs.sum())
        rows, columns = np.nonzero(discs)
        places = in_window(plotter, end_points(three_lines))
        pixels = np.stack([columns + 0.5, SIZE[1] - rows - 0.5], axis=1)
        away = np.linalg.norm(pixels[:, None] - places, axis=-1)
        assert (away.min(1) < size / 2 + 0.01).all()
        assert (away.min(0) < 1.0).all()
    assert areas[1] > 6 * areas[0]
    actor.prop.point_size = 4
    assert picture(plotter).any(-1).sum() == areas[0]
    assert actor.tube_radius == 1.0
    actor.tube_radius = 2.0
    assert picture(plotter).any(-1).sum() == areas[0]
    actor.tube_radius = 1.0
    actor.style = "surface"
    np.testing.assert_array_equal(picture(plotter), tubes)
    actor.tube_radius = None
    np.testing.assert_array_equal(picture(plotter), lines)


def test_bad_sizes_are_refused(window, three_lines):
    plotter = window()
    with pytest.raises(ValueError, match="point_size is 0; give pixels from 1 to 64"):
        plotter.add_fiblets(three_lines, style="ends", point_size=0)
    actor = plotter.add_fiblets(three_lines, style="ends")
    assert actor.point_size == pv.global_theme.point_size
    with pytest.raises(ValueError, match="from 1 to 64"):
        actor.point_size = 65
    twin = actor.copy()
    assert (twin.style, twin.point_size, twin.mapper.ends) == ("ends", actor.point_size, True)


def test_picks_find_ends_and_nothing_between(window, brain):
    plotter = window()
    actor = plotter.add_fiblets(brain, style="ends", point_size=7)
    picture(plotter)
    places = in_window(plotter, end_points(brain))
    counts = np.diff(brain.offsets)
    hits = 0
    for number, (x, y) in enumerate(places):
        found = actor.pick_at(int(x), int(y))
        assert found is not None
        streamline, place = found
        assert place in (0.0, counts[streamline] - 1.0)
        hits += streamline == number // 2
    assert hits > 0.5 * len(places)
    box = (60, 60, 160, 150)
    through = actor.pick_box(box, through=True)
    inside = (
        np.maximum(np.array(box[:2]) - 0.5 - places, places - np.array(box[2:]) - 0.5).clip(0.0) ** 2
    ).sum(-1) ** 0.5 <= 3.5
    assert sorted(through.ids) == sorted(set(np.flatnonzero(inside) // 2))
    at_ends = (through.places == 0) | (through.places == counts[through.ids] - 1)
    assert at_ends.all()
    visible = actor.pick_box(box)
    assert set(visible.ids) <= set(through.ids)
    assert len(visible.ids) > 3


def test_picks_through_leave_out_hidden_and_cut_ends(window, brain):
    plotter = window()
    actor = plotter.add_fiblets(brain, style="ends", point_size=7)
    actor.clip(((1, 0, 0), (5, 0, 0)))
    actor.criterion("length", (60.0, 500.0))
    drawn = picture(plotter).any(-1)
    found = actor.pick_box((0, 0, *SIZE), through=True)
    ends = end_points(brain).reshape(-1, 2, 3)
    wanted = (ends[..., 0] >= 5).any(-1) & (brain.lengths() >= 60.0)
    assert 3 < wanted.sum() < len(wanted)
    assert sorted(found.ids) == np.flatnonzero(wanted).tolist()
    rows, columns = np.nonzero(drawn)
    kept = (ends[..., 0] > 4.5) & (brain.lengths() >= 60.0)[:, None]
    places = in_window(plotter, ends[kept])
    away = np.linalg.norm(np.stack([columns + 0.5, SIZE[1] - rows - 0.5], 1)[:, None] - places, axis=-1).min(1)
    assert (away < 3.51).all()


def test_exports_have_vertices_at_ends(window, three_lines):
    plotter = window()
    actor = plotter.add_fiblets(three_lines, style="ends")
    picture(plotter)
    with readable(plotter.render_window):
        data = pv.wrap(actor.mapper.GetInput())
        assert data.n_verts == 6
        assert data.n_lines == 0
        assert data.cell_data["streamline"].tolist() == [0, 0, 1, 1, 2, 2]
        np.testing.assert_allclose(data.points, end_points(three_lines), atol=1e-3)
    picker = vtkPropPicker()
    x, y = in_window(plotter, end_points(three_lines))[0]
    assert picker.PickProp(int(x), int(y), plotter.renderer)
    assert not picker.PickProp(*map(int, in_window(plotter, np.array([[0.0, -10.0, 0.0]]))[0]), plotter.renderer)


def test_smooth_edges_keep_the_area(window):
    """The mean of samples, and coverage while something moves: of single discs the area of a circle."""
    rng = np.random.default_rng(0)
    lines = [np.array([[x, 0.0, z], [x + 8.0, 0.0, z + 3.0]]) for x in (-40, -10, 20) for z in (-30, 0, 30)]
    lines = Streamlines.from_list([line + rng.uniform(-0.5, 0.5, 3) for line in lines])
    for antialias in ("coverage", 16, "refined"):
        plotter = window()
        plotter.add_fiblets(lines, color="white", lighting=False, style="ends", point_size=11)
        plotter.view_xz()
        plotter.picture.antialias = antialias
        area = picture(plotter)[..., 0].sum() / 255.0
        assert area == pytest.approx(18 * np.pi * 5.5**2, rel=0.02), antialias


def test_selected_streamlines_of_a_width_show_whole(window, three_lines):
    plotter = window()
    actor = plotter.add_fiblets(three_lines, color="white", lighting=False, style="ends")
    discs = picture(plotter).any(-1)
    actor.select([0])
    actor.selection_style(width=3.0, dim=0.0)
    found = picture(plotter).any(-1)
    middle = np.floor(in_window(plotter, np.array([[0.0, -10.0, 0.0], [0.0, 5.0, 0.0]]))).astype(int)
    shown = [bool(found[SIZE[1] - 1 - y, x]) for x, y in middle]
    assert shown == [True, False]
    assert not discs[SIZE[1] - 1 - middle[:, 1], middle[:, 0]].any()
    assert found[discs].all()
