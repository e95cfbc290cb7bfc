"""Tools over the picture: what they do to the page, and what they leave in the picture."""

import numpy as np
import pytest

from pvfiblets.web.panels.tabs.selection_tab import SelectionActions
from tests.web.desk import Desk, scene_of_views


@pytest.fixture
def desk(ball, folder):
    """What the tools act on: the ball from above."""
    desk = Desk(ball, folder)
    desk.selecting = SelectionActions(desk)
    return desk


def amber(picture):
    """Return where the colour of measured distances is."""
    return (np.abs(picture.astype(int) - (255, 204, 0)) < 60).all(axis=-1)


def share(x, y):
    """Return a pixel of 200 by 160, from the lower left, as a share from the upper left."""
    return [x / 199, 1 - y / 159]


def millimetres(desk):
    desk.selecting.refresh()
    found = [text.split() for text in desk.page.measured]
    assert all(unit == "mm" for _, unit in found)
    return [float(number) for number, _ in found]


def test_distances_stay_in_the_picture_until_they_are_removed_or_undone(desk, scene):
    before = scene.cameras.screenshot()
    desk.selecting.point("measure", [share(84, 80), share(116, 80)], False)
    assert millimetres(desk) == [pytest.approx(8.0, abs=0.01)]
    line = amber(scene.cameras.screenshot())
    assert line[79:83, 85:115].any(axis=0).all()
    assert not line[:, :80].any()
    # The next one ends on the ball, not on the line before.
    desk.selecting.point("measure", [share(90, 80), share(110, 80)], False)
    desk.selecting.point("measure", [share(100, 60), share(100, 100)], False)
    assert millimetres(desk) == [pytest.approx(mm, abs=0.01) for mm in (8.0, 5.0, 10.0)]
    three = scene.cameras.screenshot()
    assert amber(three)[90:98, 99:102].any(axis=1).all()
    assert desk.history.undo_label == f"measure {desk.page.measured[-1]}"
    desk.history.undo()
    assert len(millimetres(desk)) == 2
    assert not amber(scene.cameras.screenshot())[90:98, 99:102].any()
    desk.history.redo()
    np.testing.assert_array_equal(scene.cameras.screenshot(), three)
    desk.selecting.remove_distance(1)
    assert millimetres(desk) == [pytest.approx(mm, abs=0.01) for mm in (8.0, 10.0)]
    with pytest.raises(ValueError, match="row of a measurement is 2"):
        desk.selecting.remove_distance(2)
    desk.selecting.clear_distances()
    assert millimetres(desk) == []
    np.testing.assert_array_equal(scene.cameras.screenshot(), before)
    desk.selecting.point("measure", [share(84, 80), share(5, 5)], False)
    assert desk.said == [("info", "Nothing to measure there; click a line, a surface or a slice.")]
    assert not amber(scene.cameras.screenshot()).any()
    desk.selecting.point("measure", [share(84, 80), share(116, 80)], False)
    scene.close()
    assert list(scene.plotter.actors) == []


def test_two_clicks_measure_and_nothing_of_no_length_is_kept(desk, scene):
    from pvfiblets.web.session import files as session

    def click(x, y):
        desk.selecting.point("measure", [share(x, y), share(x + 1, y)], False)

    click(83, 80)
    assert desk.page.measuring
    assert millimetres(desk) == []
    click(115, 80)
    assert millimetres(desk) == [pytest.approx(8.0, abs=0.01)]
    assert not desk.page.measuring
    click(84, 80)
    desk.selecting.end_measuring()  # as Esc does
    click(90, 80)
    assert len(millimetres(desk)) == 1
    with pytest.raises(ValueError, match="same point"):
        click(90, 80)
    click(5, 5)  # on nothing
    assert desk.said[-1][0] == "info"
    assert not desk.page.measuring
    assert len(millimetres(desk)) == 1
    assert desk.history.undo_label == f"measure {desk.page.measured[0]}"
    saved = session.to_dict(scene)
    saved["measurements"].append([[1.0, 2.0, 3.0]] * 2)  # as older versions wrote
    session.from_dict(scene, saved)
    assert len(millimetres(desk)) == 1


def test_distances_in_panes_are_of_their_slices(folder):
    """Compared with where the pane shows two voxels."""
    with scene_of_views(folder) as scene:
        desk = Desk(scene, folder)
        desk.selecting = SelectionActions(desk)
        scene.open("head.nii.gz", "image")
        scene.images.set_slices(layout="axial")
        scene.cameras.screenshot()
        workspace = scene.slicing.workspace
        pane, z = workspace.panes["axial"], workspace.position[2]
        ends = [pane.pixel_of((x, 20.0, z)) for x in (12.0, 40.0)]
        width, height = scene.plotter.window_size
        desk.selecting.point("measure", [[x / (width - 1), 1 - y / (height - 1)] for x, y in ends], False)
        (found,) = scene.state.measurements
        assert found.mm == pytest.approx(28.0, abs=0.1)
        np.testing.assert_allclose([found.begin, found.end], [(12, 20, z), (40, 20, z)], atol=0.1)


def test_a_region_is_placed_on_what_lies_behind_a_measured_line(desk, scene):
    desk.selecting.point("measure", [share(84, 80), share(116, 80)], False)
    layer = scene.open("lines.trk")
    desk.page.chosen, desk.page.chosen_kind = layer.id, layer.kind
    scene.show(layer.id, False)
    desk.regions.add("sphere")
    scene.cameras.screenshot()
    desk.regions.begin_placing(0)
    desk.regions.place(100, 80)
    (row,) = scene.layer(layer.id).filters.regions["of"]
    region = row["region"]
    np.testing.assert_allclose(region["center"], (20, 18, 18), atol=0.3)


def test_sessions_and_scripts_have_all_distances(desk, scene, tmp_path):
    import json

    from pvfiblets.web.session import files as session
    from pvfiblets.web.session.script import as_script

    places = [[share(84, 80), share(116, 80)], [share(100, 60), share(100, 100)]]
    for pair in places:
        desk.selecting.point("measure", pair, False)
    picture, said = scene.cameras.screenshot(), millimetres(desk)
    saved = json.loads(json.dumps(session.to_dict(scene)))
    script = as_script(scene, str(tmp_path / "again.png")).replace("FOLDER = Path('.')", "")
    script = script.replace('FOLDER = Path(".")', f"FOLDER = Path({str(scene.root)!r})")
    exec(compile(script, "script", "exec"), {})
    from PIL import Image

    again = np.asarray(Image.open(tmp_path / "again.png").convert("RGB"))
    np.testing.assert_array_equal(again, picture)
    scene.measurements.clear_measurements()
    session.from_dict(scene, saved)
    assert millimetres(desk) == said
    np.testing.assert_array_equal(scene.cameras.screenshot(), picture)
    for wrong in ([[1, 2]], [[[0, 0, 0], [0, 0, "x"]]], [[[0, 0, 0], [0, 0, 1e30]]], 5, 65 * [[[0, 0, 0], [1, 0, 0]]]):
        with pytest.raises(session.SessionError, match="measurement"):
            session.from_dict(scene, {**saved, "measurements": wrong})
    assert millimetres(desk) == said


def test_tables_and_profiles_are_made_when_what_they_say_has_changed(desk, scene, monkeypatch):
    layer = scene.open("lines.fiblets")
    made = []
    table = type(scene.selection).table
    monkeypatch.setattr(type(scene.selection), "table", lambda self, **rest: made.append(1) or table(self, **rest))
    desk.selecting.refresh()
    assert (made, desk.page.selection) == ([], {"count": 0})
    scene.selection.select(layer.id, [3, 4])
    for _ in range(3):
        desk.selecting.refresh()
    assert len(made) == 1
    scene.set(layer.id, "opacity", 0.5)
    desk.selecting.refresh()
    assert len(made) == 1
    scene.set(layer.id, "scalars", "fa")
    desk.selecting.refresh()
    assert desk.page.selection["columns"] == ["streamline", "points", "mm", "mean of fa"]
    scene.selection.select(layer.id, [3])
    desk.selecting.refresh()
    assert desk.page.selection["title"] == "1 streamline"
    desk.selecting.set_profile("curvature")
    desk.selecting.refresh()
    assert desk.page.selection["profile"] == "curvature"
    scene.selection.deselect()
    desk.selecting.refresh()
    scene.selection.select(layer.id, [3])
    desk.selecting.refresh()
    assert desk.page.selection["count"] == 1
