"""Tools over the picture: what they do to the page, and what they leave in the picture."""

from __future__ import annotations

import numpy as np
import pytest

from pvfiblets.web.selection_tab import SelectionActions
from tests.web.desk import Desk


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
    number, unit = desk.page.measured.split()
    assert unit == "mm"
    return float(number)


def test_a_distance_stays_in_the_picture_until_it_is_cleared(desk, scene):
    before = scene.screenshot()
    desk.selecting.point("measure", [share(84, 80), share(116, 80)], False)
    assert millimetres(desk) == pytest.approx(8.0, abs=0.01)
    line = amber(scene.screenshot())
    assert line[79:83, 85:115].any(axis=0).all()
    assert not line[:, :80].any()
    # The next one ends on the ball, not on the line before; the document knows of neither.
    desk.selecting.point("measure", [share(90, 80), share(110, 80)], False)
    assert millimetres(desk) == pytest.approx(5.0, abs=0.01)
    assert len(desk.history) == 0
    desk.selecting.clear_distance()
    assert desk.page.measured == ""
    np.testing.assert_array_equal(scene.screenshot(), before)
    desk.selecting.point("measure", [share(84, 80), share(5, 5)], False)
    assert desk.said == [("info", "Begin and end on something that is drawn.")]
    assert not amber(scene.screenshot()).any()
    desk.selecting.point("measure", [share(84, 80), share(116, 80)], False)
    scene.close()
    assert list(scene.plotter.actors) == []


def test_tables_and_profiles_are_made_when_what_they_say_has_changed(desk, scene, monkeypatch):
    layer = scene.open("lines.fiblets")
    made = []
    table = type(scene).table
    monkeypatch.setattr(type(scene), "table", lambda self, **rest: made.append(1) or table(self, **rest))
    desk.selecting.refresh()
    assert (made, desk.page.selection) == ([], {"count": 0})
    scene.select(layer.id, [3, 4])
    for _ in range(3):
        desk.selecting.refresh()
    assert len(made) == 1
    scene.set(layer.id, "opacity", 0.5)
    desk.selecting.refresh()
    assert len(made) == 1
    scene.set(layer.id, "scalars", "fa")
    desk.selecting.refresh()
    assert desk.page.selection["columns"] == ["streamline", "points", "mm", "mean of fa"]
    scene.select(layer.id, [3])
    desk.selecting.refresh()
    assert desk.page.selection["title"] == "1 streamline"
    desk.selecting.set_profile("curvature")
    desk.selecting.refresh()
    assert desk.page.selection["profile"] == "curvature"
    scene.deselect()
    desk.selecting.refresh()
    scene.select(layer.id, [3])
    desk.selecting.refresh()
    assert desk.page.selection["count"] == 1
