"""Sliders that are dragged: the picture follows, the page's record waits, and all of it is one step."""

from __future__ import annotations

import asyncio

import pytest

from pvfiblets.web import sliders
from pvfiblets.web.sliders import SlideActions
from tests.web.desk import Desk


@pytest.fixture
def desk(scene, folder):
    layer = scene.open("lines.fiblets")
    desk = Desk(scene, folder)
    desk.page.chosen, desk.page.chosen_kind = layer.id, layer.kind
    desk.sliders = SlideActions(desk)
    scene.watch(lambda _: desk.sliders.moving or desk.refresh())
    return desk


def drag(desk, *moves, release=True):
    async def test():
        for move in moves:
            desk.sliders.slide(*move)
        if release:
            desk.sliders.release()
        else:
            await asyncio.sleep(2.0 * sliders.SETTLED)

    before = desk.refreshed
    asyncio.run(test())
    return desk.refreshed - before


def test_every_value_acts_and_the_page_is_brought_in_step_once(desk, scene):
    (layer,) = scene.layers
    refreshed = drag(desk, *(("property", layer.id, "opacity", value) for value in (0.9, 0.5, 0.25)))
    assert refreshed == 1
    assert scene.actor(layer.id).opacity == 0.25
    assert desk.page.held == {}
    assert len(desk.history) == 1
    drag(desk, ("property", layer.id, "opacity", 0.5))
    assert desk.history.undo() == "opacity of lines.fiblets"
    desk.history.undo()
    assert scene.actor(layer.id).opacity == 1.0


def test_a_slider_that_rests_without_being_let_go_is_shown_as_it_is(desk, scene, monkeypatch):
    monkeypatch.setattr(sliders, "SETTLED", 0.05)
    assert drag(desk, ("property", scene.layers[0].id, "line_width", 3.0), release=False) == 1


def test_cuts_filters_and_regions_slide(desk, scene):
    (layer,) = scene.layers
    clip = scene.add_clip("box")
    drag(desk, ("clip", clip.id, "x", [1.0, 5.0]), ("clip", clip.id, "x", [1.0, 7.0]))
    assert scene.state.clip(clip.id).shape["bounds"][:2] == [1.0, 7.0]
    scene.remove_clip(clip.id)
    desk.filtering.add("length")

    async def held():
        desk.sliders.slide("criterion", "of", "length", [40.25, 69.5])
        return dict(desk.page.held)

    assert asyncio.run(held()) == {
        "at": "criterion of length", "shown": ["40.25", "69.5"], "counted": "29 of 60 streamlines"
    }  # fmt: skip
    desk.filtering.remove("length")
    drag(desk, ("share", "of", "streamlines", 50))
    assert scene.layer(layer.id).filters.subset["amount"] == 0.5
    desk.regions.add("sphere")
    drag(desk, ("region", 0, "radius", 7.0))
    assert scene.layer(layer.id).filters.regions["of"][0]["region"]["radius"] == 7.0


@pytest.mark.parametrize(
    ("move", "says"),
    [
        (("camera", "x", "y", 1.0), "no sliders of 'camera'"),
        (([], "x", "y", 1.0), "no sliders of"),
        (("property", "layer99", "opacity", 1.0), "layer99"),
        (("property", "layer1", "opacity", 7.0), "from 0 to 1"),
        (("property", "layer1", "opacity", [1.0]), "opacity"),
        (("region", 3, "radius", 7.0), "no region 3"),
    ],
)
def test_what_no_slider_sends_is_refused_and_changes_nothing(desk, scene, move, says):
    state = scene.state
    with pytest.raises((ValueError, KeyError), match=says):
        drag(desk, move)
    assert scene.state is state
    assert not desk.sliders.moving
