"""Three linked panes and the 3-D view: what they show, by events as the windowing system sends them."""

from __future__ import annotations

import nibabel as nib
import numpy as np
import pytest
import pyvista as pv

import pvfiblets.plotting  # noqa: F401 - registers the components
from pvfiblets.streamlines import Streamlines

AFFINE = np.array([[-2.0, 0.0, 0.0, 30.0], [0.0, 2.0, 0.3, -40.0], [0.0, -0.3, 2.0, -20.0], [0.0, 0.0, 0.0, 1.0]])
SHAPE = (30, 36, 28)
RAMP = np.array([0.03, -0.02, 0.05])


def ramp():
    at = nib.affines.apply_affine(AFFINE, np.stack(np.mgrid[: SHAPE[0], : SHAPE[1], : SHAPE[2]], axis=-1))
    return (at @ RAMP).astype(np.float32)


@pytest.fixture
def four():
    plotter = pv.Plotter(off_screen=True, window_size=(400, 400), shape=(2, 2), border=False)
    plotter.set_background("black", all_renderers=True)
    yield plotter
    plotter.close()


@pytest.fixture
def workspace(four):
    made = four.slices.workspace((ramp(), AFFINE), clim=(-2, 2))
    four.show(auto_close=False)
    return made


class Mouse:
    """Sends events to a plotter's interactor."""

    def __init__(self, plotter):
        self.interactor = plotter.iren.interactor

    def send(self, event, x=100, y=300, control=False, shift=False, key="\0", symbol=None):
        self.interactor.SetEventInformation(int(x), int(y), int(control), int(shift), key, 0, symbol)
        self.interactor.InvokeEvent(event)

    def drag(self, button, *pixels, **held):
        self.send(f"{button}ButtonPressEvent", *pixels[0], **held)
        for pixel in pixels[1:]:
            self.send("MouseMoveEvent", *pixel, **held)
        self.send(f"{button}ButtonReleaseEvent", *pixels[-1], **held)

    def press(self, symbol, key="\0", **at):
        for event in ("KeyPressEvent", "CharEvent"):
            self.send(event, key=key, symbol=symbol, **at)


@pytest.mark.more
@pytest.mark.parametrize("convention", ["radiological", "neurological"])
def test_every_pixel_of_a_pane_shows_what_lies_at_its_position(four, workspace, convention):
    workspace.convention, workspace.cross_hair, workspace.told = convention, False, False
    workspace.position = (3.0, -5.0, 9.0)
    workspace.panes["coronal"].zoom = 2.5
    four.render()
    picture = four.screenshot(return_img=True)[::-1].astype(float)
    right = {"radiological": -1.0, "neurological": 1.0}[convention]
    for name, (left, bottom), across, up in (
        ("axial", (0, 200), (right, 0, 0), (0, 1, 0)),
        ("coronal", (200, 200), (right, 0, 0), (0, 0, 1)),
        ("sagittal", (0, 0), (0, right, 0), (0, 0, 1)),
    ):
        pane = workspace.panes[name]
        y, x = np.mgrid[bottom + 26 : bottom + 174, left + 26 : left + 174]  # letters stand at the edges
        at = np.stack([pane.position_at(*pixel) for pixel in zip(x.ravel(), y.ravel(), strict=True)])
        step = pane.position_at(left + 51, bottom + 50) - pane.position_at(left + 50, bottom + 50)
        np.testing.assert_allclose(step / np.linalg.norm(step), across, atol=1e-12)
        step = pane.position_at(left + 50, bottom + 51) - pane.position_at(left + 50, bottom + 50)
        np.testing.assert_allclose(step / np.linalg.norm(step), up, atol=1e-12)
        voxels = nib.affines.apply_affine(np.linalg.inv(AFFINE), at)
        inside = ((voxels > 0) & (voxels < np.array(SHAPE) - 1)).all(axis=1)
        assert inside.sum() > 3000
        wanted = np.clip(255.0 * (at @ RAMP + 2.0) / 4.0, 0, 255)
        found = picture[y.ravel(), x.ravel(), 0]
        assert abs(found - wanted)[inside].max() < 5.0


def test_the_cross_hair_is_where_its_position_is(four, workspace):
    workspace.position = (5.0, 7.0, 3.0)
    four.render()
    picture = four.screenshot(return_img=True)[::-1]
    for pane in workspace.panes.values():
        x, y = pane.pixel_of(workspace.position)
        np.testing.assert_allclose(pane.position_at(x, y), workspace.position, atol=1e-9)
        assert workspace.pane_at(x, y) is pane
        for dx, dy in ((20, 0), (-20, 0), (0, 20), (0, -20)):
            block = picture[round(y + dy) - 1 : round(y + dy) + 2, round(x + dx) - 1 : round(x + dx) + 2].astype(int)
            assert (block[..., 0] - block[..., 2] > 60).any()  # yellow


def test_letters_say_the_sides_and_turn_with_the_convention(workspace):
    sides = {name: "".join(pane.sides[side] for side in ("left", "right", "top", "bottom"))
             for name, pane in workspace.panes.items()}  # fmt: skip
    assert sides == {"axial": "RLAP", "coronal": "RLSI", "sagittal": "APSI"}
    workspace.convention = "neurological"
    sides = {name: "".join(pane.sides[side] for side in ("left", "right")) for name, pane in workspace.panes.items()}
    assert sides == {"axial": "LR", "coronal": "LR", "sagittal": "PA"}


def test_a_click_and_a_drag_move_the_cross_hair_in_its_plane_only(four, workspace):
    pane, mouse = workspace.panes["axial"], Mouse(four)
    before = workspace.position
    heard = []
    workspace.on_move(heard.append)
    wanted = pane.position_at(80, 310)
    mouse.drag("Left", (80, 310))
    np.testing.assert_allclose(workspace.position, wanted)
    assert workspace.position[2] == before[2]
    mouse.drag("Left", (80, 310), (90, 300), (120, 280))
    np.testing.assert_allclose(workspace.position, pane.position_at(120, 280))
    np.testing.assert_allclose(heard[-1], workspace.position)
    moved = workspace.position
    mouse.drag("Left", (300, 100), (340, 120))  # of the 3-D view
    np.testing.assert_array_equal(workspace.position, moved)


def test_the_wheel_goes_through_slices_and_with_control_zooms(four, workspace):
    mouse, before = Mouse(four), workspace.position
    mouse.send("MouseWheelForwardEvent", 300, 300)
    moved = workspace.position - before
    assert moved[[0, 2]].tolist() == [0.0, 0.0]
    voxels = np.linalg.inv(AFFINE)[:3, :3] @ moved
    np.testing.assert_allclose(abs(voxels).max(), 1.0)
    mouse.send("MouseWheelBackwardEvent", 300, 300)
    np.testing.assert_allclose(workspace.position, before, atol=1e-9)
    mouse.send("MouseWheelForwardEvent", 300, 300, control=True)
    assert workspace.panes["coronal"].zoom == pytest.approx(1.15)
    assert workspace.panes["axial"].zoom == pytest.approx(1.0)


def test_other_buttons_pan_zoom_and_change_the_window(four, workspace):
    mouse, pane, layer = Mouse(four), workspace.panes["axial"], workspace.slices.layers[0]
    at = pane.position_at(100, 300)
    mouse.drag("Middle", (100, 300), (130, 310))
    np.testing.assert_allclose(pane.position_at(130, 310), at)
    mouse.drag("Right", (100, 300), (500, 300))
    assert layer.clim == pytest.approx((-4.0, 4.0))
    mouse.drag("Right", (100, 300), (100, 350))
    assert layer.clim == pytest.approx((-5.0, 3.0))
    mouse.drag("Right", (100, 300), (100, 340), control=True)
    assert pane.zoom == pytest.approx(1.15**2)
    pane.reset()
    assert pane.zoom == 1.0


def test_keys_step_and_positions_are_typed(four, workspace):
    mouse, before = Mouse(four), workspace.position
    mouse.press("Right")
    assert workspace.position[0] < before[0]  # the patient's left is on the right
    mouse.press("Left")
    mouse.press("Up")
    assert workspace.position[1] > before[1]
    mouse.press("Down")
    mouse.press("Prior")
    # The viewer of an axial slice of this convention looks from below.
    assert workspace.position[2] < before[2]
    for typed, wanted in (("-3.5 7,2", (-3.5, 7.0, 2.0)), ("v 4 5 6", AFFINE[:3] @ (4, 5, 6, 1))):
        mouse.press("g", "g")
        for letter in typed:
            mouse.press({" ": "space"}.get(letter, letter), letter)
        mouse.press("x", "x")
        mouse.press("BackSpace")
        mouse.press(typed[-1], typed[-1])
        mouse.press("Return", "\r")
        np.testing.assert_allclose(workspace.position, wanted)
    mouse.press("g", "g")
    mouse.press("7", "7")
    mouse.press("Escape")
    mouse.press("g", "g")
    mouse.press("7", "7")
    mouse.press("Return", "\r")  # one number is no position
    np.testing.assert_allclose(workspace.position, AFFINE[:3] @ (4, 5, 6, 1))


def test_a_click_on_a_slice_of_the_3d_view_moves_the_cross_hair_there(four, workspace):
    four.subplot(1, 1)
    four.view_xy()
    four.render()
    before = workspace.position
    found = workspace.picked_in_view(320, 120)
    assert found[2] == pytest.approx(before[2])
    four.renderer.SetWorldPoint(*found, 1.0)
    four.renderer.WorldToDisplay()
    np.testing.assert_allclose(four.renderer.GetDisplayPoint()[:2], (320, 120), atol=1e-3)
    Mouse(four).drag("Left", (320, 120))
    np.testing.assert_allclose(workspace.position, found)
    assert workspace.picked_in_view(201, 1) is None


@pytest.fixture
def lines():
    """Four streamlines that lie in planes of z: at 0, 1, 4 and 20 mm."""
    steps = np.linspace(-15.0, 15.0, 61)
    made = [np.stack([steps, np.full(61, y), np.full(61, z)], axis=1) for y, z in ((-8, 0), (0, 1), (8, 4), (16, 20))]
    return Streamlines.from_list(made)


def test_a_pane_shows_streamlines_of_its_slab_and_the_3d_view_all(four, workspace, lines):
    actor = four.add_fiblets(lines, color="red", lighting=False, line_width=3)
    workspace.position, workspace.thickness, workspace.cross_hair = (0.0, 0.0, 0.0), 3.0, False
    four.render()
    alone = actor.explain()["gpu_bytes"]

    def red():
        four.render()
        picture = four.screenshot(return_img=True)[::-1].astype(int)
        return (picture[..., 0] > 200) & (picture[..., 1] < 60)

    def lies(place):
        found, shown = workspace.panes["axial"], red()
        result = []
        for y, z in ((-8, 0), (0, 1), (8, 4), (16, 20)):
            px, py = found.pixel_of(np.array([0.0, y, z]))
            result.append(bool(shown[round(py) - 3 : round(py) + 4, round(px)].any()))
        return result

    assert lies("axial") == [True, True, False, False]
    workspace.thickness = 10.0
    assert lies("axial") == [True, True, True, False]
    workspace.position = (0.0, 0.0, 20.0)
    assert lies("axial") == [False, False, False, True]
    assert red()[:200, 200:].any()  # the 3-D view
    assert actor.mapper.region is None
    # One upload serves all four views; each has a picture of its own.
    assert actor.explain()["gpu_bytes"] == alone
    four.remove_actor(actor)
    assert not red().any()


def test_values_under_the_cross_hair_are_those_of_images_and_near_streamlines(four, workspace, lines):
    actor = four.add_fiblets(lines, name="lines")
    workspace.position = (1.5, 0.5, 0.5)
    found = workspace.values(radius=4.0)
    assert found.images["image"] == pytest.approx(RAMP @ (1.5, 0.5, 0.5), abs=1e-5)
    assert found.voxel == tuple(np.rint(np.linalg.inv(AFFINE) @ (1.5, 0.5, 0.5, 1.0))[:3].astype(int))
    points = [np.asarray(one) for one in actor.fiblets]
    near = [n for n, one in enumerate(points) if (np.linalg.norm(one - (1.5, 0.5, 0.5), axis=1) <= 4.0).any()]
    assert found.streamlines["lines"].tolist() == near == [1]
    actor.user_matrix = np.array([[1, 0, 0, 0], [0, 1, 0, 8], [0, 0, 1, 0], [0, 0, 0, 1.0]])
    assert workspace.values(radius=4.0).streamlines["lines"].tolist() == [0]
    with pytest.raises(ValueError, match="radius"):
        workspace.values(radius=0)


def test_meshes_are_cut_to_contours(four, workspace):
    workspace.position, workspace.cross_hair = (0.0, 0.0, 6.0), False
    workspace.slices.layers[0].visible = False
    name = workspace.add_contours(pv.Sphere(radius=10.0, theta_resolution=60, phi_resolution=60), "lime")
    four.render()

    def radius():
        picture = four.screenshot(return_img=True)[::-1].astype(int)[200:, :200]
        y, x = np.nonzero((picture[..., 1] > 200) & (picture[..., 0] < 60))
        if not len(x):
            return None
        pane = workspace.panes["axial"]
        at = np.array([pane.position_at(px, py + 200) for px, py in zip(x, y, strict=True)])
        return np.linalg.norm(at[:, :2], axis=1).mean()

    assert radius() == pytest.approx(8.0, abs=0.4)
    workspace.position = (0.0, 0.0, 0.0)
    four.render()
    assert radius() == pytest.approx(10.0, abs=0.4)
    workspace.remove_contours(name)
    four.render()
    assert radius() is None
    with pytest.raises(TypeError, match="mesh is a str"):
        workspace.add_contours("brain.vtp")


def test_what_has_no_meaning_is_refused(four):
    one = pv.Plotter(off_screen=True)
    with pytest.raises(ValueError, match=r"shape=\(2, 2\)"):
        one.slices.workspace(np.ones((4, 4, 4)))
    one.close()
    for arguments, said in (
        ({"thickness": 0}, "thickness is"), ({"convention": "left"}, "convention is"), ({"layout": "x"}, "layout is"),
        ({"clim": (1, 0)}, "clim is"),
    ):  # fmt: skip
        with pytest.raises(ValueError, match=said):
            four.slices.workspace(np.ones((4, 4, 4)), **arguments)
        assert not len(four.slices)
    workspace = four.slices.workspace(np.ones((4, 4, 4)))
    with pytest.raises(KeyError, match="there is no layer"):
        workspace.active = "other"
    with pytest.raises(ValueError, match="zoom is"):
        workspace.panes["axial"].zoom = 0
    workspace.remove()
    workspace.remove()
    assert [list(renderer.actors) for renderer in four.renderers] == [[], [], [], []]


def test_slices_lie_below_the_3d_view_in_a_window_that_is_higher_than_wide(four, workspace):
    workspace.layout = "coronal"
    assert workspace.panes["coronal"].pixels == (400, 400)
    assert workspace.pane_at(10, 10) is workspace.panes["coronal"]
    with pytest.raises(ValueError, match="layout is"):
        workspace.layout = "heap"
    workspace.layout = "beside"
    views = dict(zip(("axial", "coronal", "sagittal", "3d"), four.renderers, strict=True))
    width, height = four.window_size
    assert views["3d"].GetViewport() == pytest.approx((0.0, 0.0, 0.7, 1.0))
    four.window_size = 200, 400
    assert views["3d"].GetViewport() == pytest.approx((0.0, 0.2, 1.0, 1.0))
    assert views["coronal"].GetViewport() == pytest.approx((1 / 3, 0.0, 2 / 3, 0.2))
    four.window_size = width, height
    assert views["3d"].GetViewport() == pytest.approx((0.0, 0.0, 0.7, 1.0))
    workspace.remove()
    four.window_size = 200, 400
    assert views["3d"].GetViewport() == pytest.approx((0.0, 0.0, 0.7, 1.0))
