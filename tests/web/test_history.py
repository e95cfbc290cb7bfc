"""Undo and redo: documents come back, and pictures with them."""

from __future__ import annotations

import numpy as np
import pytest

from pvfiblets.web.history import History


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
        scene.view("axial")
        done.append((scene.state, scene.screenshot()))

    do(lambda: None)
    do(lambda: scene.open("lines.fiblets"))
    (layer,) = scene.layers
    do(lambda: scene.set(layer.id, "scalars", "fa"))
    do(lambda: scene.set(layer.id, "line_width", 3))
    do(lambda: scene.set_filter(layer.id, "length", 30, 60))
    do(lambda: scene.set_groups(layer.id, ["far"]))
    do(lambda: scene.select(layer.id, [31, 40]))
    do(lambda: scene.add_clip("sphere", center=[20, 10, 10], radius=18))
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
        scene.view("axial")
        np.testing.assert_array_equal(scene.screenshot(), picture)
    assert history.undo() is None
    for state, picture in done[1:]:
        assert history.redo()
        assert scene.state == state
        scene.view("axial")
        np.testing.assert_array_equal(scene.screenshot(), picture)
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


def test_doing_something_else_forgets_what_was_undone(scene, history, clock):
    layer = scene.open("ball.ply")
    scene.set(layer.id, "opacity", 0.5)
    history.undo()
    scene.set(layer.id, "opacity", 0.25)
    assert history.redo() is None
    history.undo()
    assert scene.layer(layer.id).settings["opacity"] == 1.0


def test_a_setting_to_what_it_is_is_no_step(scene, history):
    layer = scene.open("ball.ply")
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
        scene.set_regions(layer.id, condition)
    assert len(history) == begun + 4  # a ball, where it went, another beside it, and how they are joined
    history.undo()
    assert scene.layers[0].filters.regions["op"] == "and"
    history.undo()
    assert scene.layers[0].filters.regions["region"]["center"][0] == 22.0
    history.undo()
    assert scene.layers[0].filters.regions["region"]["center"][0] == 20.0
