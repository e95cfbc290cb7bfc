"""Images as slices: layers, panes, sessions, undo and scripts."""

import nibabel
import numpy as np
import pytest
import pyvista as pv

from pvfiblets.plotting.slices.oblique import HANDLE
from pvfiblets.web.scene.scene import Scene
from pvfiblets.web.scene.slices.slicing import NAMES, angles_of, normal_of
from pvfiblets.web.session import files as session
from pvfiblets.web.session.history import History
from pvfiblets.web.view.touch import Fingers
from tests.web.desk import assert_script_draws, scene_of_views


@pytest.fixture
def scene(folder):
    with scene_of_views(folder) as scene:
        yield scene


def shown(scene):
    """Return which views are drawn."""
    return {name for name, one in zip(NAMES, scene.plotter.renderers, strict=True) if one.GetDraw()}


def test_an_image_is_shown_as_slices_beside_the_3d_view(scene):
    scene.open("lines.trk")
    assert shown(scene) == {"3d"}
    image = scene.open("head.nii.gz", "image")
    assert shown(scene) == {"axial", "coronal", "sagittal", "3d"}
    scene.set(image.id, "clim", [-1.0, 1.0])
    scene.images.set_slices(position=[30.0, 30.0, 30.0], cross_hair=False)
    picture = scene.cameras.screenshot()
    # The head is 1 in the middle of 16 voxels of 4 mm, and falls by the distance; the axial pane shows that.
    pane = scene.slicing.workspace.panes["axial"]
    x, y = (round(part) for part in pane.pixel_of(np.array([30.0, 30.0, 30.0])))
    assert (abs(picture[159 - y, x].astype(int) - 240) < 5).all()
    assert scene.slicing.workspace.values().images["head.nii.gz"] == pytest.approx(0.885, abs=0.02)


def test_the_3d_view_is_there_again_when_the_last_image_goes_out_of_a_large_pane(scene):
    scene.open("lines.trk")
    image = scene.open("head.nii.gz", kind="image")
    scene.images.set_slices(layout="axial")
    assert shown(scene) == {"axial"}
    scene.remove(image.id)
    assert shown(scene) == {"3d"}
    assert scene.plotter.renderer.GetInteractive()


def test_settings_undo_and_order_are_those_of_layers(scene):
    history = History(scene, together=0.0)
    first = scene.open("head.nii.gz", "image")
    atlas = scene.open("atlas.nii.gz", "image")
    stack = scene.slicing.workspace.slices
    assert atlas.settings["meaning"] == "scalars"
    scene.set(atlas.id, "meaning", "labels")
    assert [one.kind for one in stack.layers] == ["scalars", "labels"]
    scene.set(first.id, "cmap", "hot")
    scene.set(first.id, "below", 0.25)
    assert (stack.layers[0].cmap, stack.layers[0].below) == ("hot", 0.25)
    with pytest.raises(ValueError, match="percentages"):
        scene.set(first.id, "percentiles", [5.0, 5.0])
    assert stack.layers[0].percentiles == (1.0, 99.0)
    scene.show(first.id, False)
    assert not stack.layers[0].visible
    for _ in range(4):
        history.undo()
    assert [one.kind for one in stack.layers] == ["scalars", "scalars"]
    assert stack.layers[0].cmap == "gray"
    history.undo()
    history.undo()
    assert not scene.layers
    assert shown(scene) == {"3d"}
    history.redo()
    assert shown(scene) == {"axial", "coronal", "sagittal", "3d"}


def test_labels_have_the_names_of_a_table(scene, folder):
    (folder / "names.tsv").write_text("index\tname\tcolor\n3\tleft <b>part</b>\t#ff0000\n5\tright\t#00ff00\n")
    (folder / "empty.tsv").write_text("nothing\n")
    atlas = scene.open("atlas.nii.gz", "image")
    named = scene.images.name_labels(atlas.id, scene.images.load_labels(atlas.id, "names.tsv"))
    assert named.settings["meaning"] == "labels"
    scene.images.set_slices(position=[4.0, 30.0, 30.0])
    assert scene.slicing.workspace.values().images["atlas.nii.gz"] == (3, "left <b>part</b>")
    with pytest.raises(ValueError, match="columns index and name"):
        scene.images.load_labels(atlas.id, "empty.tsv")
    with pytest.raises(PermissionError, match="outside"):
        scene.images.load_labels(atlas.id, "../names.tsv")


def test_sessions_keep_images_and_how_they_are_looked_at(scene, folder):
    image = scene.open("head.nii.gz", "image")
    scene.set(image.id, "cmap", "hot")
    scene.images.set_slices(layout="sagittal", convention="neurological", thickness=7.0, position=[10.0, 20.0, 30.0])
    told = session.to_dict(scene)
    scene.remove(image.id)
    assert "slices" not in session.to_dict(scene)
    scene.images.set_slices(layout="3d", position=[0.0, 0.0, 0.0])
    session.from_dict(scene, told)
    workspace = scene.slicing.workspace
    assert (workspace.layout, workspace.convention, workspace.thickness) == ("sagittal", "neurological", 7.0)
    assert workspace.position.tolist() == [10.0, 20.0, 30.0]
    assert workspace.slices.layers[0].cmap == "hot"
    for name, value in (("layout", "heap"), ("thickness", -1), ("position", [1, 2]), ("planes", 1), ("other", 1)):
        with pytest.raises(session.SessionError, match=name):
            session.from_dict(scene, {**told, "slices": {name: value}})
    assert workspace.layout == "sagittal"


def test_the_script_makes_the_same_picture(scene, folder):
    scene.open("lines.trk")
    image = scene.open("head.nii.gz", "image")
    scene.set(image.id, "clim", [-1.0, 1.0])
    (folder / "names.tsv").write_text("index\tname\n3\tone\n5\tother\n")
    atlas = scene.open("atlas.nii.gz", "image")
    scene.images.name_labels(atlas.id, scene.images.load_labels(atlas.id, "names.tsv"))
    scene.set(atlas.id, "opacity", 0.3)
    scene.images.set_slices(position=[18.0, 22.0, 12.0], thickness=9.0)
    picture = scene.cameras.screenshot()
    assert_script_draws(scene, folder, picture)


def test_two_fingers_move_a_slice_and_reset_shows_all_of_it(scene):
    scene.open("head.nii.gz", "image")
    scene.images.set_slices(layout="axial")
    scene.cameras.screenshot()
    pane, fingers = scene.slicing.workspace.panes["axial"], Fingers(scene.plotter, scene.slicing.pane_at)
    camera = scene.cameras.camera()
    under = pane.position_at(100.0, 70.0)

    def send(kind, *xs):
        positions = {str(k): {"x": x, "y": 70.0} for k, x in enumerate(xs)}
        assert fingers.take({"type": kind, "positions": positions})

    send("StartPinch", 80.0, 120.0)
    send("Pinch", 90.0, 170.0)
    send("EndPinch", 90.0, 170.0)
    assert pane.zoom == pytest.approx(2.0)
    np.testing.assert_allclose(pane.position_at(130.0, 70.0), under, atol=1e-9)
    assert scene.cameras.camera() == camera
    scene.slicing.show_all()
    assert pane.zoom == 1.0


def test_images_are_not_cut_and_need_four_views(scene, folder, plotter):
    image = scene.open("head.nii.gz", "image")
    with pytest.raises(ValueError, match="not cut"):
        scene.filters.add_clip("plane", layers=[image.id])
    one = Scene(plotter, folder)
    with pytest.raises(ValueError, match=r"shape=\(2, 2\)"):
        one.open("head.nii.gz", "image")
    assert not one.layers
    one.close()
    with pytest.raises(ValueError, match="slices are of images"):
        scene.open("lines.trk", "image")
    assert scene.queries.histogram(image.id)["name"]
    assert scene.queries.info(image.id)["facts"]["voxels"] == [16, 16, 16]


def test_an_image_of_colours_and_one_of_several_volumes(scene, folder):
    many = np.stack([np.full((6, 6, 6), value, np.float32) for value in (1.0, 2.0, 3.0)], axis=-1)
    nibabel.save(nibabel.Nifti1Image(many, np.eye(4)), folder / "many.nii")
    image = scene.open("many.nii", "image")
    scene.set(image.id, "index", 2)
    scene.images.set_slices(position=[2.0, 2.0, 2.0])
    assert scene.slicing.workspace.values().images["many.nii"] == 3.0
    with pytest.raises(ValueError, match="index"):
        scene.set(image.id, "index", 3)
    scene.set(image.id, "meaning", "direction")
    assert scene.slicing.workspace.slices.layers[0].kind == "direction"


def test_directions_are_as_bright_as_another_image_of_the_scene(scene, folder):
    affine = np.diag([4.0, 4.0, 4.0, 1.0])
    vectors = np.zeros((16, 16, 16, 3), np.float32)
    vectors[..., 0] = -1.0
    fa = np.full((16, 16, 16), 0.5, np.float32)
    nibabel.save(nibabel.Nifti1Image(vectors, affine), folder / "v1.nii.gz")
    nibabel.save(nibabel.Nifti1Image(fa, affine), folder / "fa.nii.gz")
    weights = scene.open("fa.nii.gz", "image")
    image = scene.open("v1.nii.gz")
    assert image.kind == "image"
    history = History(scene)
    scene.set(image.id, "meaning", "direction")
    choices = {one["name"]: one for one in scene.queries.properties(image.id)}["modulate"]["choices"]
    value = next(one["value"] for one in choices if one["title"] == "fa.nii.gz")
    scene.set(image.id, "modulate", value)
    scene.set(image.id, "clim", [0.0, 1.0])
    scene.images.set_slices(position=[30.0, 30.0, 30.0], cross_hair=False, layout="axial")
    picture = scene.cameras.screenshot()
    assert (abs(picture[80, 120].astype(int) - [128, 0, 0]) <= 2).all()  # right to left is red, by half
    scene.remove(weights.id)
    assert (scene.cameras.screenshot()[80, 120] == picture[80, 120]).all()
    kept = session.to_dict(scene)
    assert_script_draws(scene, folder, picture)
    while history.undo():
        pass
    assert scene.cameras.screenshot()[80, 120].tolist() != picture[80, 120].tolist()
    session.from_dict(scene, kept)
    assert (scene.cameras.screenshot()[80, 120] == picture[80, 120]).all()


def test_vectors_of_fsl_are_turned_on_the_page(scene, folder):
    affine = np.array([[0.0, 0, -4, 30], [4, 0, 0, -30], [0, 4, 0, -30], [0, 0, 0, 1.0]])  # i front, j up, k left
    vectors = np.zeros((16, 16, 16, 3), np.float32)
    vectors[..., 0] = 1.0
    nibabel.save(nibabel.Nifti1Image(vectors, affine), folder / "v1.nii.gz")
    image = scene.open("v1.nii.gz")
    scene.set(image.id, "meaning", "direction")
    scene.images.set_slices(position=[0.0, 0.0, 0.0], cross_hair=False, layout="axial")
    assert scene.cameras.screenshot()[80, 120].tolist() == [255, 0, 0]
    scene.set(image.id, "vectors", "fsl")
    picture = scene.cameras.screenshot()
    assert picture[80, 120].tolist() == [0, 255, 0]
    scene.set(image.id, "glyphs", "peaks")
    scene.set(image.id, "image_under", True)
    picture = scene.cameras.screenshot()
    assert_script_draws(scene, folder, picture)
    session.from_dict(scene, session.to_dict(scene))
    assert (scene.cameras.screenshot() == picture).all()


def test_a_table_beside_labels_is_taken_and_other_tables_are_not(scene, folder):
    (folder / "atlas.tsv").write_text("index\tname\tcolor\n3\tputamen\t#ff0000\n5\tinsula\t#00ff00\n")
    (folder / "head.tsv").write_text("index\tname\n1\tone\n")  # beside numbers that are no labels
    atlas = scene.open("atlas.nii.gz", "image")
    assert atlas.settings["meaning"] == "labels"
    scene.images.set_slices(position=[2.0, 8.0, 8.0])
    assert scene.slicing.workspace.values().images["atlas.nii.gz"] == (3, "putamen")
    assert scene.open("head.nii.gz", "image").settings["meaning"] == "scalars"
    (folder / "atlas.tsv").write_text("subject\tage\n1\t40\n")
    scene.remove(atlas.id)
    assert scene.open("atlas.nii.gz", "image").settings["meaning"] == "scalars"


def glyph_image(folder, n):
    """Write an image of n numbers a voxel, which mean something as peaks, a tensor and harmonics alike."""
    values = np.zeros((16, 16, 16, n), np.float32)
    values[5:11, 5:11, 5:11, 0] = 1.0
    values[5:11, 5:11, 5:11, 1] = 0.5
    nibabel.save(nibabel.Nifti1Image(values, np.diag([4.0, 4.0, 4.0, 1.0])), folder / "glyphs.nii.gz")


@pytest.mark.few(1)
@pytest.mark.parametrize(("n", "kind"), [(3, "peaks"), (6, "tensor"), (15, "sh")])
def test_glyphs_of_an_image_are_those_of_python(scene, folder, n, kind):
    glyph_image(folder, n)
    history = History(scene, together=0.0)
    image = scene.open("glyphs.nii.gz")
    choices = {one["name"]: one for one in scene.queries.properties(image.id)}["glyphs"]["choices"]
    assert {one["value"] for one in choices} == {3: {None, "peaks"}, 6: {None, "peaks", "tensor", "sh"},
                                                  15: {None, "peaks", "sh"}}[n]  # fmt: skip
    scene.images.set_slices(position=[30.0, 30.0, 30.0], cross_hair=False)
    before = scene.cameras.screenshot()
    scene.set(image.id, "glyphs", kind)
    scene.set(image.id, "glyph_size", 0.9)
    picture = scene.cameras.screenshot()
    assert (abs(picture.astype(int) - before).max(axis=2) > 30).any()
    assert (picture.max(axis=2) > 30).sum() < (before.max(axis=2) > 30).sum()  # lines and lobes, no faces of voxels
    assert_script_draws(scene, folder, picture)
    kept = session.to_dict(scene)
    scene.show(image.id, False)
    hidden = scene.cameras.screenshot().astype(int)
    assert (picture.astype(int)[..., 0] - picture[..., 1] > 60).any()
    assert not (hidden[..., 0] - hidden[..., 1] > 60).any()  # letters are yellow
    history.undo()
    history.undo()
    history.undo()
    assert np.abs(scene.cameras.screenshot().astype(int) - before).max() <= 2
    session.from_dict(scene, kept)
    assert np.abs(scene.cameras.screenshot().astype(int) - picture).max() <= 2


@pytest.mark.parametrize(
    "normal", [(0, 0, 1), (0.3, -0.5, 0.8), (-0.9, 0.1, 0.2), (1, 0, 0), (0.2, 0.4, -0.9), (0, -1, 0)]
)
def test_angles_of_a_normal_give_it_again(normal):
    tilt, turn = angles_of(normal)
    assert -90.0 <= turn <= 90.0
    np.testing.assert_allclose(normal_of((tilt, turn)), np.array(normal) / np.linalg.norm(normal), atol=2e-4)


def test_turning_an_oblique_slice_by_hand_is_undone_and_done_again(scene):
    scene.open("head.nii.gz", "image")
    history = History(scene, clock=lambda: 0.0)
    scene.images.set_slices(oblique=[30.0, 0.0], layout="oblique")
    workspace = scene.slicing.workspace
    pane = workspace.panes["oblique"]
    np.testing.assert_allclose(pane.toward, [0.0, -0.5, -np.sqrt(0.75)], atol=1e-12)  # mirrored: from below
    assert [box["name"] for box in scene.slicing.boxes()] == ["oblique"]
    scene.images.set_slices(layout="grid")
    trace = workspace.oblique.traces["sagittal"]
    start = trace.pane.pixel_of(workspace.position)
    workspace.oblique.normal = trace.normal_towards(start[0] + 30, start[1] + 30, 1)  # as a drag does
    angles = scene.state.oblique
    assert angles != (30.0, 0.0)
    np.testing.assert_allclose(workspace.oblique.normal, normal_of(angles), atol=1e-12)
    assert scene.slicing.view.oblique == angles
    history.undo()  # both at once: they are within a second
    assert scene.state.oblique is None
    assert not workspace.oblique.visible
    assert "oblique" not in [box["name"] for box in scene.slicing.boxes()]
    history.redo()
    assert workspace.oblique.visible
    history.close()


def test_a_drag_of_a_handle_is_one_step_to_undo_however_long_it_pauses(scene):
    scene.open("head.nii.gz", "image")
    clock = iter(range(0, 10000, 100))  # seconds: no two changes are near each other
    history = History(scene, clock=lambda: next(clock))
    scene.images.set_slices(oblique=[30.0, 0.0], layout="grid")
    steps, (pane, oblique) = len(history), (scene.slicing.workspace.panes["sagittal"], scene.slicing.workspace.oblique)
    for begin, end in ((30.0, 60.0), (60.0, 45.0)):
        drag_handle(scene.plotter, pane, oblique, end)
        assert scene.state.oblique == pytest.approx((end, 0.0), abs=5.0)  # in whole pixels
        assert scene.state.oblique[0] != begin
    assert len(history) == steps + 2
    turned = scene.state.oblique
    history.undo()
    assert scene.state.oblique == pytest.approx((60.0, 0.0), abs=5.0)
    history.undo()
    assert scene.state.oblique == (30.0, 0.0)
    assert oblique.drag is None
    history.redo()
    history.redo()
    assert scene.state.oblique == turned
    history.close()


def drag_handle(plotter, pane, oblique, tilt):
    """Drag a handle of the line in the sagittal pane to where a tilt has it, in five steps."""
    middle = np.array(pane.pixel_of(pane.stack.position))
    right, up = pane.axes
    reach = HANDLE * min(pane.pixels)
    now = angles_of(oblique.normal)[0]
    interactor = plotter.iren.interactor
    for k, angle in enumerate(np.radians(np.linspace(now, tilt, 6))):
        along = np.array([0.0, np.cos(angle), -np.sin(angle)])  # across the normal, in the sagittal plane
        x, y = np.rint(middle + reach * np.array([along @ right, along @ up])).astype(int).tolist()
        interactor.SetEventInformation(x, y)
        interactor.InvokeEvent("MouseMoveEvent" if k else "LeftButtonPressEvent")
    interactor.InvokeEvent("LeftButtonReleaseEvent")


def test_an_oblique_slice_lies_as_its_angles_say(scene, folder):
    scene.open("head.nii.gz", "image")
    scene.images.set_slices(position=[30.0, 30.0, 30.0], oblique=[30.0, 90.0])
    plane = scene.slicing.workspace.slices["oblique"]
    np.testing.assert_allclose(plane.normal, [-0.5, 0.0, np.sqrt(0.75)], atol=1e-12)
    np.testing.assert_allclose(plane.origin, [30.0, 30.0, 30.0])
    scene.images.set_slices(planes=False, cross_hair=False)
    assert [one.name for one in scene.slicing.workspace.slices if one.visible] == ["oblique"]
    picture = scene.cameras.screenshot()
    assert_script_draws(scene, folder, picture)
    kept = session.to_dict(scene)
    scene.images.set_slices(oblique=None)
    assert not plane.visible
    session.from_dict(scene, kept)
    assert scene.slicing.view.oblique == (30.0, 90.0)
    with pytest.raises(ValueError, match="degrees from -180 to 180"):
        scene.images.set_slices(oblique=[30.0, 200.0])


CENTRE = np.array([100.0, 80.0])  # of the plotter's 200 by 160 pixels


def send(fingers, kind, *places):
    positions = {str(k): {"x": float(x), "y": float(y), "z": 0} for k, (x, y) in enumerate(places)}
    return fingers.take({"type": kind, "positions": positions})


def gesture(fingers, kind, begin, end):
    """Send a gesture of two fingers in four steps."""
    begin, end = np.array(begin, float), np.array(end, float)
    assert send(fingers, f"Start{kind}", *begin)
    for share in (0.25, 0.5, 0.75, 1.0):
        assert send(fingers, kind, *((1 - share) * begin + share * end))
    assert send(fingers, f"End{kind}", *end)


def seen(plotter, point):
    """Return the pixel that shows a point."""
    renderer = plotter.renderer
    renderer.SetWorldPoint(*point, 1.0)
    renderer.WorldToDisplay()
    return np.array(renderer.GetDisplayPoint()[:2])


@pytest.fixture(params=[False, True], ids=["perspective", "parallel"])
def looking(request, plotter):
    plotter.add_mesh(pv.Sphere())
    plotter.camera.parallel_projection = request.param
    plotter.show(auto_close=False, interactive=False)
    return plotter, Fingers(plotter)


def test_fingers_that_part_magnify_as_far_as_they_part(looking):
    plotter, fingers = looking
    camera = plotter.camera
    focus = np.array(camera.focal_point)
    right = np.cross(np.subtract(focus, camera.position), camera.up)
    point = focus + 0.1 * right / np.linalg.norm(right)
    before = seen(plotter, point) - seen(plotter, focus)
    gesture(fingers, "Pinch", [CENTRE - (20, 0), CENTRE + (20, 0)], [CENTRE - (50, 0), CENTRE + (50, 0)])
    assert np.allclose(seen(plotter, point) - seen(plotter, focus), 2.5 * before, atol=1e-3)
    assert np.allclose(seen(plotter, focus), CENTRE, atol=0.6)


def test_what_lies_between_the_fingers_goes_with_them(looking):
    plotter, fingers = looking
    focus = plotter.camera.focal_point
    before = seen(plotter, focus)
    gesture(fingers, "Pan", [(60, 60), (80, 60)], [(90, 40), (110, 40)])
    assert np.allclose(seen(plotter, focus) - before, (30, -20), atol=1e-3)


def test_a_turn_of_the_fingers_turns_the_picture(looking):
    plotter, fingers = looking
    above = np.add(plotter.camera.focal_point, 0.1 * np.array(plotter.camera.up))
    turned = np.array([[0.0, -40.0], [0.0, 40.0]])
    straight = np.array([[-40.0, 0.0], [40.0, 0.0]])
    begin = seen(plotter, above) - CENTRE
    steps = [straight * np.cos(a) + turned * np.sin(a) for a in np.linspace(0.0, np.pi / 2, 9)]
    send(fingers, "StartRotate", *(CENTRE + steps[0]))
    for step in steps[1:]:
        send(fingers, "Rotate", *(CENTRE + step))
    send(fingers, "EndRotate", *(CENTRE + steps[-1]))
    end = seen(plotter, above) - CENTRE
    assert np.allclose(end, [-begin[1], begin[0]], atol=0.7)  # a quarter turn to the left, as the fingers made


def test_a_gesture_begins_where_the_fingers_come_down(looking):
    plotter, fingers = looking
    gesture(fingers, "Pan", [(60, 60), (80, 60)], [(60, 60), (80, 60)])
    before = seen(plotter, plotter.camera.focal_point)
    gesture(fingers, "Pinch", [(10, 10), (150, 150)], [(10, 10), (150, 150)])
    assert np.allclose(seen(plotter, plotter.camera.focal_point), before, atol=1e-3)


def test_other_events_and_odd_fingers_move_nothing(looking):
    plotter, fingers = looking
    before = plotter.camera.position
    assert not fingers.take({"type": "MouseMove", "x": 3, "y": 4})
    assert send(fingers, "StartPinch", (10, 10))
    assert send(fingers, "Pinch", (90, 90))
    assert fingers.take({"type": "Pinch"})
    assert send(fingers, "StartPinch", (50, 50), (50, 50))
    assert send(fingers, "Pinch", (50, 50), (51, 50))
    assert np.allclose(plotter.camera.position, before, atol=0.02)
    assert np.isfinite(plotter.camera.position).all()


def shares(scene):
    """Return how much of the 3-D view's width and height its picture takes; nothing may be at its borders."""
    box = next(one for one in scene.slicing.boxes() if one["name"] == "3d")
    picture = scene.cameras.screenshot()
    height, width = picture.shape[:2]
    left, top = round(box["x"] * width), round(box["y"] * height)
    view = picture[top : top + round(box["h"] * height), left : left + round(box["w"] * width)]
    lit = view[2:-2, 2:-2].max(axis=2) > 30
    assert not lit[[0, -1]].any()
    assert not lit[:, [0, -1]].any()
    across, down = (np.flatnonzero(lit.any(axis=axis)) for axis in (0, 1))
    return np.ptp(across) / lit.shape[1], np.ptp(down) / lit.shape[0]


def test_the_3d_view_fits_windows_and_layouts_beside_slices(folder):
    with scene_of_views(folder) as scene:
        scene.open("lines.fiblets")
        scene.open("head.nii.gz", "image")
        for size in ((600, 400), (200, 400), (500, 300)):
            scene.plotter.window_size = size
            scene.plotter.render()
            scene.cameras.refit()
            for layout in ("beside", "3d", "grid"):
                scene.images.set_slices(layout=layout)
                assert max(shares(scene)) > 0.7
        camera = scene.cameras.camera()
        scene.cameras.set_camera({**camera, "position": [one + 50.0 for one in camera["position"]]})
        moved = scene.cameras.camera()
        scene.images.set_slices(layout="beside")  # a view that was chosen stays
        assert scene.cameras.camera() == moved
        scene.cameras.reset()
        scene.plotter.window_size = 300, 500
        scene.plotter.render()
        scene.cameras.refit()
        assert max(shares(scene)) > 0.5
