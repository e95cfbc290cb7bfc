"""Streamlines under the mouse, in boxes and in lassos, by events as the windowing system sends them."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

from pvfiblets.engine.fiblets.data.filter_textures import Filter
from pvfiblets.mappers.frames.windows import contexts_with
from pvfiblets.mappers.picking import EMPTY
from pvfiblets.plotting.fiblets.pick_result import Picked
from pvfiblets.synthetic import brain_streamlines

LASSO = np.array([[60, 60], [150, 70], [140, 150], [105, 95], [70, 140]], float)


@pytest.fixture
def brain(plotter):
    """Return a small brain's actor, drawn."""
    actor = plotter.add_fiblets(brain_streamlines(400), lighting=False)
    plotter.show(auto_close=False)
    return actor


def gbuffer(actor):
    """Ids of the picture, bottom row first; -1 where there is none."""
    mapper = actor.mapper
    (context,) = contexts_with(mapper)
    slot = context.slots[mapper.GetAddressAsString("")]
    (drawn,) = slot.drawn.values()
    context.window.MakeCurrent()
    with context.foreign():
        buffer = slot.renderer.render(drawn.view, drawn.style)
        ids = np.frombuffer(buffer.ids.read(), "<u4").reshape(*buffer.size[::-1], 2)[..., 0]
        depth = np.frombuffer(buffer.depth.read(), "<u4").reshape(buffer.size[::-1])
    return np.where(depth == EMPTY, -1, ids.astype(np.int64)), depth / EMPTY


def within(polygon, x, y):
    """Which places lie in a polygon, by crossings of a ray to the right."""
    inside = np.zeros(x.shape, bool)
    for a, b in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        straddles = (a[1] > y) != (b[1] > y)
        with np.errstate(divide="ignore", invalid="ignore"):
            inside ^= straddles & (x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
    return inside


class Mouse:
    """Sends events to a plotter's interactor."""

    def __init__(self, plotter):
        self.interactor = plotter.iren.interactor

    def at(self, x, y, *, control=False, shift=False, key="\0"):
        self.interactor.SetEventInformation(int(x), int(y), int(control), int(shift), key, 0, None)
        return self

    def send(self, *events):
        for event in events:
            self.interactor.InvokeEvent(f"{event}Event")
        return self

    def click(self, x, y, button="Left", **keys):
        self.at(x, y, **keys).send("MouseMove", f"{button}ButtonPress", f"{button}ButtonRelease")

    def drag(self, *places, **keys):
        self.at(*places[0], **keys).send("MouseMove", "LeftButtonPress")
        for place in places[1:]:
            self.at(*place, **keys).send("MouseMove")
        self.send("LeftButtonRelease")

    def press(self, key):
        self.at(*self.interactor.GetEventPosition(), key=key).send("KeyPress", "Char", "KeyRelease")


@pytest.fixture
def mouse(plotter):
    return Mouse(plotter)


def test_a_box_and_a_lasso_give_the_ids_of_the_picture_within(brain):
    ids, depth = gbuffer(brain)
    picked = brain.pick_box((60, 70, 130, 120))
    there = ids[70:121, 60:131]
    assert len(picked) > 20
    assert np.array_equal(np.sort(picked.ids), np.unique(there[there >= 0]))
    assert (np.diff(picked.depths) >= 0).all()
    for i, place, pixel in zip(picked.ids, picked.depths, picked.pixels.astype(int), strict=True):
        assert ids[pixel[1], pixel[0]] == i
        assert place == pytest.approx(depth[70:121, 60:131][there == i].min(), abs=1e-9)
    assert brain.pick_box((130, 120, 60, 70)).ids.tolist() == picked.ids.tolist()
    x, y = np.meshgrid(np.arange(200), np.arange(200))
    there = ids[within(LASSO, x, y)]
    assert len(there[there >= 0]) > 20
    assert np.array_equal(np.sort(brain.pick_polygon(LASSO).ids), np.unique(there[there >= 0]))


def test_places_are_under_the_pixels(brain, plotter):
    brain.user_matrix = pv.transformations.axis_angle_rotation((0, 0, 1), 20) @ np.diag([1.1, 1.1, 1.1, 1.0])
    brain.position = (3, 1, -2)
    plotter.render()
    for through in (False, True):
        picked = brain.pick_polygon(LASSO, through=through)
        world = np.column_stack([picked.points, np.ones(len(picked))])
        matrix = plotter.camera.GetCompositeProjectionTransformMatrix(1.0, -1, 1)
        matrix = np.array([[matrix.GetElement(i, j) for j in range(4)] for i in range(4)])
        clip = world @ matrix.T
        pixels = (clip[:, :2] / clip[:, 3:] + 1) / 2 * 200 - 0.5
        # A thin line is drawn into pixels whose middle is within one of it.
        assert np.abs(pixels - picked.pixels).max() <= (1e-6 if through else 1.0)
        assert np.abs(clip[:, 2] / clip[:, 3] / 2 + 0.5 - picked.depths).max() < (1e-9 if through else 1e-3)


def under(plotter, actor, polygon):
    """Streamlines of which some place on a segment, tried at 21 places each, lies in a polygon of the window.

    By VTK's camera, in float64.
    """
    matrices = [plotter.camera.GetCompositeProjectionTransformMatrix(1.0, -1, 1), actor.GetMatrix()]
    projection, model = (np.array([[m.GetElement(i, j) for j in range(4)] for i in range(4)]) for m in matrices)
    found = []
    for i, line in enumerate(actor.fiblets.decompress(dtype=np.float64).to_list()):
        t = np.linspace(0, 1, 21)[:, None, None]
        dense = (line[:-1] + t * (line[1:] - line[:-1])).reshape(-1, 3)
        clip = np.column_stack([dense, np.ones(len(dense))]) @ (projection @ model).T
        pixels = (clip[:, :2] / clip[:, 3:] + 1) / 2 * 200 - 0.5
        if within(polygon, *pixels.T).any():
            found.append(i)
    return found


def test_through_finds_hidden_ones_too(brain, plotter):
    seen, everything = brain.pick_polygon(LASSO), brain.pick_polygon(LASSO, through=True)
    assert set(seen.ids) < set(everything.ids)
    brute = set(under(plotter, brain, LASSO))
    assert brute <= set(everything.ids)
    # What is more grazes the area by less than a pixel, or by less than a 20th of a segment.
    more = set(everything.ids) - brute
    assert len(more) <= 0.02 * len(brute)


def test_through_honours_filters_cuts_and_regions(brain, plotter):
    from pvfiblets import regions

    everything = set(brain.pick_polygon(LASSO, through=True).ids)
    kept = np.arange(400) % 2 == 0
    brain.mapper.filtering = Filter(kept)
    plotter.render()
    assert set(brain.pick_polygon(LASSO, through=True).ids) == {i for i in everything if kept[i]}
    brain.mapper.filtering = None
    brain.mapper.region = regions.Plane((1.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    plotter.render()
    cut = brain.pick_polygon(LASSO, through=True)
    assert 0 < len(cut) < len(everything)
    assert (cut.points[:, 0] >= -0.2).all()
    brain.mapper.region = None
    brain.mapper.AddClippingPlane(_vtk_plane())
    plotter.render()
    planes = brain.pick_polygon(LASSO, through=True)
    assert (planes.points[:, 0] >= -0.2).all()
    assert len(set(cut.ids) ^ set(planes.ids)) <= 0.02 * len(planes) + 1


def _vtk_plane():
    from vtkmodules.vtkCommonDataModel import vtkPlane

    plane = vtkPlane()
    plane.SetNormal(1.0, 0.0, 0.0)
    return plane


def test_what_an_opaque_mesh_hides_is_not_seen(brain, plotter):
    ids, _ = gbuffer(brain)
    before = brain.pick_box((0, 0, 199, 199))
    plotter.add_mesh(pv.Sphere(radius=30, center=(0, 0, 60)), color="white", lighting=False, reset_camera=False)
    plotter.view_xy(render=False)
    plotter.render()
    picture = plotter.screenshot(return_img=True)[::-1, :, :3]
    ids, _ = gbuffer(brain)
    ours = (ids >= 0) & (picture != 255).any(axis=-1)
    picked = brain.pick_box((0, 0, 199, 199))
    assert set(picked.ids) == set(ids[ours])
    assert set(picked.ids) < set(ids[ids >= 0])
    assert len(brain.pick_box((0, 0, 199, 199), through=True)) >= len(before)


@pytest.mark.parametrize("effect", ["ssaa", "msaa"])
def test_supersampling_and_subplots(effect):
    plotter = pv.Plotter(off_screen=True, window_size=(240, 120), shape=(1, 2))
    plotter.subplot(0, 1)
    actor = plotter.add_fiblets(brain_streamlines(200))
    plotter.enable_anti_aliasing(effect)
    plotter.show(auto_close=False)
    ids, _ = gbuffer(actor)
    enlarged = ids.shape[1] / 120
    assert (enlarged > 1) == (effect == "ssaa")
    picked = actor.pick_box((160, 40, 199, 79))
    columns = (np.arange(ids.shape[1]) + 0.5) / enlarged + 120 - 0.5
    rows = (np.arange(ids.shape[0]) + 0.5) / enlarged - 0.5
    there = ids[(rows > 39.5) & (rows < 79.5)][:, (columns > 159.5) & (columns < 199.5)]
    assert set(picked.ids) == set(there[there >= 0])
    assert set(picked.ids) <= set(actor.pick_box((160, 40, 199, 79), through=True).ids)
    assert actor.pick_box((0, 0, 110, 119)) is None
    assert actor.pick_box((0, 0, 110, 119), through=True) is None
    plotter.close()


def test_values_of_what_is_picked(plotter, three_lines):
    actor = plotter.add_fiblets(three_lines, scalars="height", lighting=False)
    plotter.view_xy()
    plotter.show(auto_close=False)
    for through in (False, True):
        for color in ("height", "arc_length", "weight"):
            actor.scalars = color
            plotter.render()
            picked = actor.pick_box((0, 0, 199, 199), through=through)
            assert sorted(picked.ids) == [0, 1, 2]
            expected = {
                "height": picked.places / 40,
                "arc_length": picked.places * 0.5,
                "weight": np.array([1.0, 10.0, 100.0])[picked.ids],
            }[color]
            assert picked.values == pytest.approx(expected, rel=2e-2, abs=0.02)
    actor.color = "red"
    assert np.isnan(actor.pick_box((0, 0, 199, 199)).values).all()


def test_nothing_drawn_nothing_there_and_bad_input(plotter, three_lines):
    actor = plotter.add_fiblets(three_lines)
    for through in (False, True):
        assert actor.pick_box((0, 0, 10, 10), through=through) is None
    plotter.show(auto_close=False)
    for box in ((0, 0, 3, 3), (-50, -50, -10, -10), (500, 500, 600, 600)):
        for through in (False, True):
            assert actor.pick_box(box, through=through) is None
    with pytest.raises(ValueError, match="four pixels"):
        actor.pick_box((1, 2, 3))
    with pytest.raises(ValueError, match="finite pixels"):
        actor.pick_polygon([[0, np.nan]])
    with pytest.raises(TypeError, match="callback is a int"):
        plotter.fiblets.enable_picking(3)
    for bad, said in (({"mode": "sphere"}, "click, box, lasso"), ({"button": "middle"}, "left, right"),
                      ({"tolerance": -1}, "tolerance")):  # fmt: skip
        with pytest.raises(ValueError, match=said):
            plotter.fiblets.enable_picking(**bad)


def test_a_click_picks_and_selects_and_dragging_turns_the_camera(brain, plotter, mouse):
    found = []
    plotter.fiblets.enable_picking(found.append, show_message=False, tolerance=0)
    ids, _ = gbuffer(brain)
    rows, columns = np.nonzero(ids >= 0)
    y, x = rows[len(rows) // 2], columns[len(rows) // 2]
    mouse.click(x, y)
    (picked,) = found
    assert isinstance(picked, Picked)
    assert picked.actor is brain
    assert picked.ids.tolist() == [ids[y, x]]
    assert brain.selection.tolist() == [ids[y, x]]
    camera = plotter.camera.position
    mouse.drag((x, y), (x + 20, y), (x + 40, y + 10))
    assert len(found) == 1
    assert plotter.camera.position != camera

    def broken(picked):
        raise KeyError("mine")

    plotter.fiblets.enable_picking(broken, show_message=False)
    x, y = brain.pick_box((0, 0, 199, 199)).pixels[0]
    for _ in range(2):  # what a callback raises is told, and picking goes on
        with pytest.warns(UserWarning, match="mine"):
            mouse.click(x, y)


def test_shift_adds_control_toggles_and_the_background_deselects(brain, plotter, mouse):
    plotter.fiblets.enable_picking(show_message=False, tolerance=0)
    ids, _ = gbuffer(brain)
    first, second = np.unique(ids[ids >= 0])[[3, 30]]
    places = {i: np.argwhere(ids == i)[0][::-1] for i in (first, second)}
    mouse.click(*places[first])
    mouse.click(*places[second], shift=True)
    assert brain.selection.tolist() == sorted([first, second])
    mouse.click(*places[first], control=True)
    assert brain.selection.tolist() == [second]
    mouse.click(2, 2, shift=True)
    assert brain.selection.tolist() == [second]
    mouse.click(2, 2)
    assert len(brain.selection) == 0


def test_a_click_picks_of_two_actors_the_one_in_front(plotter, three_lines, mouse):
    far = plotter.add_fiblets(three_lines, color="red", name="far")
    near = plotter.add_fiblets(three_lines, color="blue", name="near")
    near.position = (0, 0, 12)
    plotter.enable_parallel_projection()
    plotter.view_xy()
    plotter.show(auto_close=False)
    found = []
    plotter.fiblets.enable_picking(found.append, show_message=False, select=False)
    mouse.click(100, 100)
    assert [picked.actor for picked in found] == [near]
    assert len(near.selection) == 0
    assert far.pick_box((90, 90, 110, 110)) is None
    near.pickable = False
    plotter.fiblets.enable_picking(found.append, show_message=False, select=False, through=True, mode="click")
    mouse.click(100, 100)
    assert [picked.actor for picked in found] == [near, far]
    assert found[1].through


@pytest.mark.parametrize("button", ["left", "right"])
def test_either_button_clicks_with_any_style(brain, plotter, mouse, button):
    ids, _ = gbuffer(brain)
    y, x = np.argwhere(ids >= 0)[100]
    for style in ("trackball", "terrain", "image", "rubber_band", "trackball_actor"):  # joysticks need a timer
        found = []
        getattr(plotter, f"enable_{style}_style")()
        plotter.fiblets.enable_picking(found.append, button=button, show_message=False, select=False)
        mouse.click(x, y, button=button.capitalize())
        assert len(found) == 1, style
        plotter.fiblets.disable_picking()
        mouse.click(x, y, button=button.capitalize())
        assert len(found) == 1, style


@pytest.mark.parametrize("through", [False, True])
def test_box_by_mouse(brain, plotter, mouse, through):
    found = []
    plotter.fiblets.enable_picking(found.append, mode="box", through=through, show_message=False)
    camera = plotter.camera.position
    expected = brain.pick_box((60, 70, 130, 120), through=through)
    mouse.press("r")
    mouse.drag((60, 70), (100, 100), (130, 120))
    assert plotter.camera.position == camera
    assert np.array_equal(found[0].ids, expected.ids)
    assert np.array_equal(brain.selection, np.sort(expected.ids))
    mouse.press("r")
    mouse.drag((60, 70), (100, 100), (130, 120))
    assert plotter.camera.position != camera
    assert len(found) == 1


def test_lasso_by_mouse_draws_its_outline(brain, plotter, mouse):
    found = []
    plotter.fiblets.enable_picking(found.append, mode="lasso", start=True, show_message=False, color=(0.0, 1.0, 1.0))
    expected = brain.pick_polygon(LASSO)
    mouse.at(*LASSO[0]).send("LeftButtonPress")
    for corner in LASSO[1:]:
        mouse.at(*corner).send("MouseMove")
    picture = plotter.screenshot(return_img=True)[..., :3]
    assert ((picture == (0, 255, 255)).all(axis=-1)).sum() > 50
    mouse.send("LeftButtonRelease")
    picture = plotter.screenshot(return_img=True)[..., :3]
    assert not (picture == (0, 255, 255)).all(axis=-1).any()
    assert np.array_equal(found[0].ids, expected.ids)
    mouse.click(*found[0].pixels[0])
    assert len(found[1]) == 1


def test_disabled_picking_leaves_nothing_behind(brain, plotter, mouse):
    interactor = plotter.iren.interactor
    style, actors = plotter.iren.style, plotter.renderer.GetViewProps().GetNumberOfItems()
    plotter.fiblets.enable_picking(mode="box", tooltip=True, start=True)
    assert plotter.renderer.GetViewProps().GetNumberOfItems() == actors + 1
    mouse.at(60, 60).send("LeftButtonPress", "MouseMove")
    plotter.fiblets.disable_picking()
    plotter.fiblets.disable_picking()
    assert plotter.renderer.GetViewProps().GetNumberOfItems() == actors
    assert plotter.iren.style is style
    camera = plotter.camera.position
    mouse.drag((60, 70), (100, 100), (130, 120))
    assert plotter.camera.position != camera
    assert interactor is plotter.iren.interactor


def test_tooltips(plotter, three_lines, mouse):
    three_lines.groups = {"left": np.array([0, 2]), "right": np.array([1])}
    plotter.add_fiblets(three_lines, scalars="weight", lighting=False)
    plotter.view_xy()
    plotter.show(auto_close=False)
    plotter.fiblets.enable_picking(tooltip=True, show_message=False)
    tooltip = plotter.fiblets._picking.tooltip
    actor = next(iter(plotter.fiblets))
    place = actor.pick_box((0, 0, 199, 199)).pixels[0].astype(int)
    mouse.at(*place).send("MouseMove")
    picked = actor.pick_polygon([place])
    assert f"streamline {picked.ids[0]}" in tooltip.shown
    assert f"weight: {picked.values[0]:.4g}" in tooltip.shown
    assert ("in left" in tooltip.shown) == (picked.ids[0] != 1)
    plotter.fiblets.enable_picking(tooltip=lambda picked: f"<{len(picked)}>", show_message=False)
    mouse.at(*place).send("MouseMove")
    assert plotter.fiblets._picking.tooltip.shown == "<1>"
    tooltip = plotter.fiblets._picking.tooltip
    plotter.fiblets.disable_picking()
    assert tooltip.shown == ""
