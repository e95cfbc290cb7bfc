"""Regions painted on slices: voxels, undo, sessions, files, and the streamlines that pass them."""

import nibabel
import numpy as np
import pytest

from pvfiblets.web.session import files as session
from pvfiblets.web.session.history import History
from pvfiblets.web.session.script import as_script
from tests.web.desk import assert_script_draws
from tests.web.test_slicing import scene  # noqa: F401 - a fixture


@pytest.fixture
def painted(scene):  # noqa: F811
    """Return a scene with sixty lines and an image of 16 voxels of 4 mm, and one empty region."""
    scene.open("lines.fiblets")
    scene.open("head.nii.gz", "image")
    assert scene.painting.add_painted().name == "region 1"
    return scene


def shown(scene):  # noqa: F811
    return np.flatnonzero(scene.actor(scene.layers[0].id).shown)


def test_a_brush_filters_streamlines_at_once_and_one_gesture_is_one_step(painted):
    history = History(painted, together=0.0)
    assert len(shown(painted)) == 60  # of no voxel nothing is asked
    # Lines lie at y = 0, 4, ... 36 and z = 0, 4, ... 20, from x = 0 on: voxels of the image's grid.
    history.held = True
    for y in (8.0, 12.0, 16.0):
        painted.painting.paint("brush", "region 1", [[4.0, y, 8.0]], 1.0, None, "first")
    history.held = False
    ids = [10 * 2 + k for k in (2, 3, 4)]
    assert shown(painted).tolist() == ids
    assert painted.painting.voxels_of("region 1") == 3
    painted.painting.paint("erase", "region 1", [[4.0, 8.0, 8.0]], 1.0, 2, "second")
    assert shown(painted).tolist() == ids[1:]
    painted.painting.set_painted("region 1", use="misses")
    assert len(shown(painted)) == 58
    for wanted in (ids[1:], ids, range(60)):
        history.undo()
        assert shown(painted).tolist() == list(wanted)
    history.redo()
    assert shown(painted).tolist() == ids
    painted.painting.set_painted("region 1", use="ends_in")
    assert not len(shown(painted))  # all begin at x = 0 and end at 10 or more


def test_slices_show_what_is_painted_in_its_colour(painted):
    painted.painting.set_painted("region 1", color="#ff0000", name="left <i>arm</i>")
    image = next(layer for layer in painted.layers if layer.kind == "image")
    painted.show(image.id, False)
    painted.show(painted.layers[0].id, False)
    painted.painting.paint("brush", "left <i>arm</i>", [[30.0, 30.0, 30.0]], 6.0)
    painted.images.set_slices(position=[30.0, 30.0, 30.0], cross_hair=False, layout="axial")

    def red():
        picture = painted.cameras.screenshot().astype(int)
        return int(((picture[..., 0] > 100) & (picture[..., 1] < 40)).sum())

    workspace = painted.slicing.workspace
    pixels = np.count_nonzero(painted.canvas.painter.labels[:, :, 8]) * (4.0 / workspace.panes["axial"].scale) ** 2
    assert workspace.values().images["painted"] == (1, "left <i>arm</i>")
    # Slices go through the middle of voxel 7.5 here: either of both.
    assert red() == pytest.approx(pixels, rel=0.3)
    painted.painting.set_painted("left <i>arm</i>", visible=False)
    assert red() == 0
    painted.painting.remove_painted("left <i>arm</i>")
    assert painted.state.painting is None
    assert [one.name for one in workspace.slices.layers] == ["head.nii.gz"]


def test_fills_stay_in_their_slice_and_tools_are_checked(painted):
    corners = [[8.0, 8.0, 20.0], [40.0, 8.0, 20.0], [40.0, 40.0, 20.0], [8.0, 40.0, 20.0], [8.0, 8.0, 20.0]]
    painted.painting.paint("brush", "region 1", corners, 1.0, 2)
    painted.painting.paint("fill", "region 1", [[20.0, 20.0, 20.0]], 1.0, 2)
    assert painted.painting.voxels_of("region 1") == 81
    second = painted.painting.add_painted().name
    painted.painting.paint("fill", second, [[20.0, 20.0, 20.0]], 1.0, 2)
    assert (painted.painting.voxels_of("region 1"), painted.painting.voxels_of(second)) == (0, 81)
    with pytest.raises(ValueError, match="no tool"):
        painted.painting.paint("spray", second, corners, 1.0)
    with pytest.raises(KeyError, match="no painted region"):
        painted.painting.paint("brush", "other", corners, 1.0)
    with pytest.raises(ValueError, match="radius"):
        painted.painting.paint("brush", second, corners, -1.0)
    with pytest.raises(ValueError, match="already"):
        painted.painting.set_painted(second, name="region 1")
    with pytest.raises(ValueError, match="use"):
        painted.painting.set_painted(second, use="likes")


def test_regions_are_saved_as_labels_with_names(painted, folder):
    painted.painting.paint("brush", "region 1", [[20.0, 20.0, 20.0]], 5.0)
    painted.painting.save_painting("mine.nii.gz")
    image = nibabel.load(folder / "mine.nii.gz")
    np.testing.assert_array_equal(image.affine, np.diag([4.0, 4.0, 4.0, 1.0]))
    np.testing.assert_array_equal(np.asarray(image.dataobj), painted.canvas.painter.labels)
    assert "region 1" in (folder / "mine.tsv").read_text()
    with pytest.raises(PermissionError, match="outside"):
        painted.painting.save_painting("../mine.nii.gz")
    with pytest.raises(ValueError, match=r"\.nii"):
        painted.painting.save_painting("mine.txt")
    assert sorted(path.name for path in folder.iterdir() if path.name.startswith(".")) == []


def test_sessions_and_scripts_have_the_regions(painted, folder):
    painted.painting.set_painted("region 1", use="passes", color="#00ff00")
    painted.painting.paint("brush", "region 1", [[4.0, 8.0, 8.0], [4.0, 16.0, 8.0]], 1.0)
    painted.images.set_slices(position=[6.0, 14.0, 8.0])
    wanted, labels = shown(painted), painted.canvas.painter.labels.copy()
    told, picture = session.to_dict(painted), painted.cameras.screenshot()
    assert_script_draws(painted, folder, picture)
    painted.painting.remove_painted("region 1")
    assert len(shown(painted)) == 60
    session.from_dict(painted, told)
    np.testing.assert_array_equal(painted.canvas.painter.labels, labels)
    assert shown(painted).tolist() == wanted.tolist()
    one = told["painting"]["regions"][0]
    for wrong, said in (
        ({"shape": [4, 4]}, "shape"), ({"affine": [0.0] * 16}, "inverted"), ({"regions": []}, "regions"),
        ({"regions": [one, one]}, "same name"), ({"regions": [one, {**one, "name": "b"}]}, "one at most"),
        ({"regions": [{**one, "runs": [5, 3]}]}, "rising"), ({"regions": [{**one, "runs": [0, 10**9]}]}, "runs"),
        ({"regions": [{**one, "use": "x"}]}, "use"),
    ):  # fmt: skip
        with pytest.raises(session.SessionError, match=said):
            session.from_dict(painted, {**told, "painting": {**told["painting"], **wrong}})
    assert shown(painted).tolist() == wanted.tolist()


def test_outlines_balls_and_growing(painted):
    # The image falls off from its middle, voxel (7.5, 7.5, 7.5) of 4 mm, so that values of a range are shells.
    around = [[18.0, 18.0, 32.0], [42.0, 18.0, 32.0], [42.0, 42.0, 32.0], [18.0, 42.0, 32.0]]
    painted.painting.paint("outline", "region 1", around, 1.0, 2)
    labels = painted.canvas.painter.labels
    wanted = np.zeros((16, 16, 16), bool)
    wanted[5:11, 5:11, 8] = True
    np.testing.assert_array_equal(labels > 0, wanted)
    painted.painting.add_painted()
    painted.painting.paint("sphere", "region 2", [[30.0, 30.0, 30.0], [30.0, 30.0, 39.0]], 1.0)
    at = np.stack(np.meshgrid(*[np.arange(16)] * 3, indexing="ij"), axis=-1) * 4.0 - 30.0
    np.testing.assert_array_equal(labels == 2, np.linalg.norm(at, axis=-1) <= 9.0)
    painted.painting.add_painted()
    image = next(layer for layer in painted.layers if layer.kind == "image")
    values = painted.data(image).data.values[..., 0]
    painted.set(image.id, "clim", [-1.0, 1.0])
    painted.painting.paint("grow", "region 3", [[32.0, 32.0, 32.0]], 1.0, share=0.1)
    near = abs(values - values[8, 8, 8]) <= 0.2  # of a window of 2
    np.testing.assert_array_equal(labels == 3, near)
    with pytest.raises(ValueError, match="three places"):
        painted.painting.paint("outline", "region 1", around[:2], 1.0, 2)
    painted.remove(image.id)
    with pytest.raises(ValueError, match="no image lies on the voxels"):
        painted.painting.paint("grow", "region 3", [[32.0, 32.0, 32.0]], 1.0)


def test_waypoints_are_passed_in_the_order_of_the_list(painted):
    for y in (0, 1):
        painted.painting.paint("brush", "region 1", [[4.0, 4.0 * y, 0.0]], 1.0)
    painted.painting.add_painted()
    painted.painting.paint("brush", "region 2", [[8.0, 0.0, 0.0], [8.0, 4.0, 0.0]], 1.0)
    painted.painting.add_painted()
    painted.painting.paint("brush", "region 3", [[0.0, 0.0, 0.0], [0.0, 4.0, 0.0]], 1.0)
    history = History(painted, together=0.0)
    for name in ("region 1", "region 2", "region 3"):
        painted.painting.set_painted(name, use="in_order")
    assert not len(shown(painted))  # 4, 8, 0 mm is no way along x
    painted.painting.move_painted("region 3", -1)
    painted.painting.move_painted("region 3", -1)
    assert [one.name for one in painted.state.painting.regions] == ["region 3", "region 1", "region 2"]
    assert shown(painted).tolist() == [0, 1]
    text = as_script(painted)
    assert "include_painted(live, in_order=['region 3', 'region 1', 'region 2'])" in text
    kept = session.to_dict(painted)
    history.undo()
    history.undo()
    assert not len(shown(painted))
    session.from_dict(painted, kept)
    assert shown(painted).tolist() == [0, 1]


def test_labels_of_a_file_become_regions(painted, folder):
    (folder / "atlas.tsv").write_text("index\tname\tcolor\n3\tputamen\t#ff0000\n5\tinsula\t#00ff00\n")
    affine = np.diag([4.0, 4.0, 4.0, 1.0])
    labels = np.zeros((16, 16, 16), np.int16)
    labels[:2], labels[12:] = 3, 5
    nibabel.save(nibabel.Nifti1Image(labels, affine), folder / "atlas.nii.gz")
    history = History(painted)
    made = painted.painting.add_labels(painted.load("atlas.nii.gz", "image"))
    assert [(one.name, one.color) for one in made] == [("putamen", "#ff0000"), ("insula", "#00ff00")]
    found = painted.canvas.painter.labels
    np.testing.assert_array_equal(found == made[0].label, labels == 3)
    np.testing.assert_array_equal(found == made[1].label, labels == 5)
    painted.painting.set_painted("insula", use="ends_in")
    assert shown(painted)[-15:].tolist() == list(range(37, 52))  # those that end at x from 46 to 62 mm
    assert len(shown(painted)) <= 16  # one ends on the face
    history.undo()
    history.undo()
    assert not painted.canvas.painter.labels.any()
    nibabel.save(nibabel.Nifti1Image(labels[:8], affine), folder / "other.nii.gz")
    with pytest.raises(ValueError, match="remove these regions first"):
        painted.painting.add_labels(painted.load("other.nii.gz", "image"))
    with pytest.raises(ValueError, match="holds no labels"):
        painted.painting.add_labels(painted.load("head.nii.gz", "image"))
