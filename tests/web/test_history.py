"""Undo and redo: documents come back, and pictures with them."""

import numpy as np
import pytest

from pvfiblets.web.session.document import LINES
from pvfiblets.web.session.history import History
from pvfiblets.web.view.region_marks import Sight, dragged, mark
from tests.web.desk import Desk, scene_of_views


@pytest.fixture
def clock():
    class Clock:
        now = 0.0

        def __call__(self):
            return self.now

    return Clock()


@pytest.fixture
def history(scene, clock):
    history = History(scene, clock=clock)
    yield history
    history.close()


@pytest.mark.more
def test_everything_that_was_done_is_undone_and_done_again(scene, history, clock):
    done = []

    def do(step):
        clock.now += 10.0
        step()
        scene.cameras.view("axial")
        done.append((scene.state, scene.cameras.screenshot()))

    do(lambda: None)
    do(lambda: scene.open("lines.fiblets"))
    (layer,) = scene.layers
    do(lambda: scene.set(layer.id, "scalars", "fa"))
    do(lambda: scene.set(layer.id, "line_width", 3))
    do(lambda: scene.filters.set_filter(layer.id, "length", 30, 60))
    do(lambda: scene.filters.set_groups(layer.id, ["far"]))
    do(lambda: scene.selection.select(layer.id, [31, 40]))
    do(lambda: scene.filters.add_clip("sphere", center=[20, 10, 10], radius=18))
    do(lambda: scene.open("ball.ply"))
    do(lambda: scene.set_background("#203040"))
    do(lambda: scene.duplicate(layer.id))
    do(lambda: scene.keep_selection(layer.id))
    do(lambda: scene.set(scene.layers[-1].id, "tube_radius", 1.5))
    do(lambda: scene.remove(layer.id))
    assert len(history) == len(done) - 1
    for state, picture in reversed(done[:-1]):
        assert history.undo()
        assert scene.state == state
        scene.cameras.view("axial")
        np.testing.assert_array_equal(scene.cameras.screenshot(), picture)
    assert history.undo() is None
    for state, picture in done[1:]:
        assert history.redo()
        assert scene.state == state
        scene.cameras.view("axial")
        np.testing.assert_array_equal(scene.cameras.screenshot(), picture)
    assert history.redo() is None


def test_labels_say_what_comes_next(scene, history):
    assert (history.undo_label, history.redo_label) == (None, None)
    layer = scene.open("ball.ply")
    scene.rename(layer.id, "ball")
    assert history.undo_label == "rename ball.ply"
    history.undo()
    assert (history.undo_label, history.redo_label) == ("open ball.ply", "rename ball.ply")


def test_a_slider_is_one_step(scene, history, clock):
    layer = scene.open("ball.ply")
    for opacity in (0.9, 0.8, 0.7):
        clock.now += 0.1
        scene.set(layer.id, "opacity", opacity)
    assert len(history) == 2
    scene.set(layer.id, "specular", 0.5)
    assert len(history) == 3
    clock.now += 5.0
    scene.set(layer.id, "specular", 0.6)
    assert len(history) == 4
    for _ in range(3):
        history.undo()
    assert scene.layer(layer.id).settings["opacity"] == 1.0
    history.redo()
    assert scene.layer(layer.id).settings["opacity"] == 0.7
    scene.set(layer.id, "opacity", 0.1)  # at once after it, but what was undone lies between
    history.undo()
    assert scene.layer(layer.id).settings["opacity"] == 0.7


def test_a_slider_that_is_held_is_one_step_however_long_it_takes(scene, history, clock):
    layer = scene.open("ball.ply")
    history.held = True
    for opacity in (0.9, 0.5, 0.2):
        clock.now += 10.0
        scene.set(layer.id, "opacity", opacity)
    scene.set(layer.id, "specular", 0.5)  # of another slider
    history.held = False
    clock.now += 10.0
    scene.set(layer.id, "specular", 0.6)
    assert len(history) == 4
    history.undo()
    history.undo()
    history.undo()
    assert scene.layer(layer.id).settings["opacity"] == 1.0


def test_labels_say_what_comes_next_and_something_else_forgets_what_was_undone(scene, history, clock):
    layer = scene.open("ball.ply")
    scene.set(layer.id, "opacity", 0.5)
    history.undo()
    scene.set(layer.id, "opacity", 0.25)
    assert history.redo() is None
    history.undo()
    assert scene.layer(layer.id).settings["opacity"] == 1.0
    scene.set(layer.id, "opacity", 1.0)
    scene.show(layer.id, True)
    assert len(history) == 1


def test_steps_are_bounded_and_data_goes_with_them(scene, clock):
    history = History(scene, limit=3, clock=clock)
    ball = scene.open("ball.ply")
    source = "mesh", ball.source
    scene.remove(ball.id)
    assert source in scene.store.loaded  # undo may want it
    layer = scene.open("lines.fiblets")
    for width in range(1, 6):
        clock.now += 10.0
        scene.set(layer.id, "line_width", width)
    assert len(history) == 3
    assert source not in scene.store.loaded
    while history.undo():
        pass
    assert scene.layer(layer.id).settings["line_width"] == 2.0
    history.clear()
    assert (len(history), history.redo()) == (0, None)
    with pytest.raises(ValueError, match="limit"):
        History(scene, limit=0)


def test_undo_that_cannot_be_done_changes_nothing(scene, history, folder):
    ball = scene.open("ball.ply")
    scene.remove(ball.id)
    scene.store.loaded.clear()  # as after a restart: the file must be read again, and is gone
    (folder / "ball.ply").unlink()
    with pytest.raises(FileNotFoundError):
        history.undo()
    assert scene.layers == ()
    assert len(history) == 2


def test_moving_a_region_is_one_step_and_joining_another_is_its_own(scene, history, clock):
    layer = scene.open("lines.fiblets")

    def ball(x):
        return {"how": "passes", "region": {"kind": "sphere", "center": [x, 18.0, 10.0], "radius": 8.0}}

    begun = len(history)
    for condition in (ball(20.0), ball(21.0), ball(22.0), {"op": "and", "of": [ball(22.0), ball(30.0)]},
                      {"op": "or", "of": [ball(22.0), ball(30.0)]}):  # fmt: skip
        clock.now += 0.1
        scene.filters.set_regions(layer.id, condition)
    assert len(history) == begun + 4  # a ball, where it went, another beside it, and how they are joined
    history.undo()
    assert scene.layers[0].filters.regions["op"] == "and"
    history.undo()
    assert scene.layers[0].filters.regions["region"]["center"][0] == 22.0
    history.undo()
    assert scene.layers[0].filters.regions["region"]["center"][0] == 20.0


SPHERE = {"kind": "sphere", "center": [10.0, 18.0, 10.0], "radius": 6.0}
BOX = {"kind": "box", "bounds": [5.0, 15.0, 12.0, 20.0, 2.0, 9.0]}


@pytest.fixture
def desk(scene, folder):
    scene.open("lines.trk")
    desk = Desk(scene, folder)
    desk.page.chosen, desk.page.chosen_kind = scene.layers[0].id, "tractogram"
    return desk


def oblique(plotter, parallel):
    plotter.camera_position = [(60.0, -80.0, 70.0), (12.0, 16.0, 8.0), (0.1, 0.2, 1.0)]
    plotter.camera.parallel_projection = parallel
    plotter.renderer.reset_camera_clipping_range()
    return Sight(plotter.camera, *plotter.window_size)


def seen(plotter, point):
    """Return where VTK sees a point, as shares from the upper left."""
    plotter.renderer.SetWorldPoint(*point, 1.0)
    plotter.renderer.WorldToView()
    x, y, _ = plotter.renderer.GetViewPoint()
    return [0.5 + 0.5 * x, 0.5 - 0.5 * y]


@pytest.mark.parametrize("parallel", [False, True])
def test_handles_lie_where_vtk_sees_them_and_go_where_they_are_dragged(scene, parallel):
    plotter = scene.plotter
    scene.open("lines.trk")
    sight = oblique(plotter, parallel)
    for shape in (SPHERE, BOX):
        found = {handle["name"]: handle for handle in mark(shape, sight)["handles"]}
        middle = shape.get("center") or [10.0, 16.0, 5.5]
        expected = seen(plotter, middle)
        np.testing.assert_allclose([found["center"]["x"], found["center"]["y"]], np.multiply(expected, 100), atol=0.01)
        for name, handle in found.items():
            place = [handle["x"] / 100 + 0.05, handle["y"] / 100 - 0.02]
            new = {**shape, **dragged(shape, name, place, sight)}
            assert new != shape
            again = {one["name"]: one for one in mark(new, sight)["handles"]}[name]
            if name == "center":
                np.testing.assert_allclose([again["x"] / 100, again["y"] / 100], place, atol=1e-4)
            elif shape is BOX:  # one face moves, along its axis
                assert np.count_nonzero(np.array(new["bounds"]) != BOX["bounds"]) == 1
    radius = dragged(SPHERE, "radius", [0.9, 0.5], sight)["radius"]
    outline = np.array(mark({**SPHERE, "radius": radius}, sight)["lines"][0].replace(",", " ").split(), float)
    x, y = 0.001 * outline.reshape(-1, 2).T  # the outline goes by the pointer, but for what perspective does
    width, height = plotter.window_size
    near = np.hypot((x - 0.9) * width, (y - 0.5) * height).min()
    assert near < (1e-6 if parallel else 0.05) * width + 12.0  # pixels: between two corners of the outline


def test_regions_are_outlined_small_and_their_faces_never_pass(scene):
    scene.open("lines.trk")
    sight = oblique(scene.plotter, False)
    rng = np.random.default_rng(1)
    points = rng.normal(size=(4000, 3))
    points = np.add(SPHERE["center"], 6.0 * points / np.linalg.norm(points, axis=1)[:, None])
    cloud = 1000.0 * sight.shares(points)
    outline = np.array(mark(SPHERE, sight)["lines"][0].replace(",", " ").split(), float).reshape(-1, 2)
    np.testing.assert_allclose(outline.min(axis=0), cloud.min(axis=0), atol=3.0)
    np.testing.assert_allclose(outline.max(axis=0), cloud.max(axis=0), atol=3.0)
    sight = oblique(scene.plotter, True)
    for name in ("xmin", "xmax", "zmin", "zmax"):
        for place in ([-0.9, -0.9], [1.9, 1.9], [1.9, -0.9]):
            low, high = np.reshape(dragged(BOX, name, place, sight)["bounds"], (3, 2)).T
            assert (low < high).all()


def test_new_regions_are_small_lie_apart_and_have_names(desk, scene):
    for _ in range(3):
        desk.regions.add("sphere")
    rows = desk.regions.described(scene.layers[0])["regions"]
    assert [row["name"] for row in rows] == ["A", "B", "C"]
    shapes = [part["region"] for part in scene.layers[0].filters.regions["of"]]
    assert {shape["radius"] for shape in shapes} == {5.0}  # the lines reach 69 mm
    a, b = (np.array(shape["center"]) for shape in shapes[:2])
    np.testing.assert_allclose(np.linalg.norm(a - b), 15.0)
    assert (np.array(shapes[2]["center"]) <= [69.0, 36.0, 20.0]).all()


def test_a_region_is_typed_renamed_and_negated_in_words(desk, scene):
    desk.regions.add("box")
    desk.regions.set_end(0, "x", 1, "31,5 mm")
    assert scene.layers[0].filters.regions["of"][0]["region"]["bounds"][1] == 31.5
    desk.regions.rename(0, " motor strip ")
    desk.regions.add("sphere")
    desk.regions.set_not(1, True)
    assert desk.regions.described(scene.layers[0])["sentence"] == "through motor strip and not through A"
    with pytest.raises(ValueError, match="there is a region 'motor strip' already"):
        desk.regions.rename(1, "motor strip")
    with pytest.raises(ValueError, match="1 to 40 printable"):
        desk.regions.rename(1, "x" * 41)
    with pytest.raises(ValueError, match="is not a number"):
        desk.regions.set_end(0, "x", 1, "wide")


def test_layers_share_a_region_and_lose_it_again(desk, scene, lines):
    other = scene.duplicate(scene.layers[0].id)
    desk.regions.add("sphere")
    assert scene.regions.sharing("A") == [scene.layers[0].id]
    ids = [layer.id for layer in scene.layers if layer.kind in LINES]
    desk.regions.set_layers(0, ids)
    assert scene.regions.sharing("A") == ids
    desk.regions.set_end(0, "radius", 0, "9")  # for both of them, and in one step
    radii = [layer.filters.regions["of"][0]["region"]["radius"] for layer in scene.layers]
    assert radii == [9.0, 9.0]
    assert np.array_equal(scene.actor(ids[0]).shown, scene.actor(ids[1]).shown)
    desk.history.undo()
    assert {layer.filters.regions["of"][0]["region"]["radius"] for layer in scene.layers} == {5.0}
    desk.regions.set_layers(0, [ids[0]])
    assert scene.layer(other.id).filters.regions is None
    with pytest.raises(ValueError, match="at least one layer"):
        desk.regions.set_layers(0, [])


def test_named_regions_are_in_sessions_and_scripts(desk, scene):
    from pvfiblets.web.session import files as session
    from pvfiblets.web.session.script import as_script

    desk.regions.add("sphere")
    desk.regions.rename(0, "A'; import os")
    kept = session.to_dict(scene)
    before = scene.state.layers[0].filters
    desk.regions.drop(0)
    session.from_dict(scene, kept)
    assert scene.state.layers[0].filters == before
    text = as_script(scene)
    compile(text, "scene.py", "exec")
    assert "import os" not in text
    kept["layers"][0]["filters"]["regions"]["of"][0]["region"]["name"] = "two\nlines"
    with pytest.raises(session.SessionError, match="printable"):
        session.from_dict(scene, kept)


def test_marks_lie_in_the_3d_view_beside_slices(folder):
    with scene_of_views(folder) as scene:
        lines = scene.open("lines.fiblets")
        scene.open("head.nii.gz", "image")
        scene.images.set_slices(layout="beside")
        scene.cameras.screenshot()
        desk = Desk(scene, folder)
        desk.page.chosen, desk.page.chosen_kind = lines.id, "tractogram"
        sphere = {"kind": "sphere", "center": [30.0, 12.0, 8.0], "radius": 4.0, "name": "A"}
        scene.filters.set_regions(lines.id, {"op": "and", "of": [{"how": "passes", "region": sphere}]})
        desk.regions.refresh_marks()
        (mark,) = desk.page.marks
        found = next(one for one in mark["handles"] if one["name"] == "center")
        renderer = scene.plotter.renderer
        renderer.SetWorldPoint(*sphere["center"], 1.0)
        renderer.WorldToDisplay()
        x, y, _ = renderer.GetDisplayPoint()
        # The 3-D view is the left 70 per cent of the picture; marks are shares of it, from its upper left.
        assert found["x"] == pytest.approx(100.0 * x / (0.7 * 240), abs=0.5)
        assert found["y"] == pytest.approx(100.0 * (1.0 - y / 160), abs=0.5)
