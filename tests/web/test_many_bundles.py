"""Thousands of bundles: the page lists some and finds the others, and the colour bar does not name them all."""

from __future__ import annotations

import numpy as np
import pytest

import pvfiblets
from pvfiblets.plotting.colours.colours import MOST_WORDS
from pvfiblets.web.panels.tabs.bundles_tab import LISTED
from pvfiblets.web.view.sent_scene import SentScenes
from tests.web.desk import Desk


@pytest.fixture
def desk(scene, folder, lines):
    def save(name, count):
        groups = {f"Edge {i}": [i % 60] for i in range(count)}
        held = pvfiblets.Streamlines(lines.points, lines.offsets, groups=groups)
        pvfiblets.compress(held).save(folder / name)
        return scene.open(name)

    made = Desk(scene, folder)
    made.layers = save("many.fiblets", 5000), save("few.fiblets", MOST_WORDS)
    made.choose(made.layers[0])
    made.bundles.refresh()
    return made


def test_bundles_beyond_the_list_are_found_by_name(desk):
    assert len(desk.page.bundles["rows"]) == LISTED
    assert desk.page.bundles["count"] == 5000
    desk.bundles.seek("edge 499")
    assert [row["name"] for row in desk.page.bundles["rows"]] == ["Edge 499", *(f"Edge {i}" for i in range(4990, 5000))]
    desk.bundles.set("Edge 4999", "visible", False)
    desk.bundles.refresh()
    assert [row["name"] for row in desk.page.bundles["rows"] if not row["visible"]] == ["Edge 4999"]
    for layer in (desk.layers[1], desk.layers[0]):  # what was looked for is forgotten
        desk.choose(layer)
        desk.bundles.refresh()
    assert len(desk.page.bundles["rows"]) == LISTED


def test_a_bar_names_as_many_bundles_as_there_is_room_for(desk, scene):
    tables = []
    for layer in desk.layers:
        scene.set(layer.id, "scalars", "group")
        tables.append(scene.actor(layer.id).mapper.lookup_table)
    assert tables[0].annotations == {}
    assert tables[1].annotations == {float(i): f"Edge {i}" for i in range(MOST_WORDS)}
    assert np.asarray(tables[0].values).shape[0] == 5000
    many, few = SentScenes(scene).make().content["bars"]
    assert (len(many["colours"]), many["names"]) == (5000, [])
    assert len(few["colours"]) == len(few["names"]) == MOST_WORDS
