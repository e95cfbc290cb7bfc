"""What a browser is sent to draw, and whether it is to, without a browser."""

from __future__ import annotations

import asyncio
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import pyvista as pv

from pvfiblets.web.browser_drawing import BrowserDrawing
from pvfiblets.web.options import Options
from pvfiblets.web.scene import Scene
from pvfiblets.web.sent_scene import LARGEST, SentScene, SentScenes
from pvfiblets.web.slicing import LAYOUTS, ready_views
from tests.web.desk import Desk

CARD = "ANGLE (NVIDIA GeForce RTX 3060)"


def drawing(scene, folder, **options):
    """Return who draws for a page, which has not said anything yet."""
    desk = Desk(scene, folder, **options)
    desk.stream.leave = lambda: None
    desk.drawing = BrowserDrawing(desk)
    return desk


def test_a_filter_and_a_selection_send_a_byte_for_each_streamline(scene):
    layer = scene.open("lines.fiblets")
    scenes = SentScenes(scene)
    first, again = scenes.make(), scenes.make()
    assert isinstance(first, SentScene)
    assert again.content == first.content
    scene.set_filter(layer.id, "length", 40.5)
    filtered = scenes.make()
    (kept,) = filtered.blobs.keys() - first.blobs.keys()
    assert np.array_equal(np.frombuffer(filtered.blobs[kept], np.uint8), np.arange(10, 70) > 40.5)
    scene.select(layer.id, [3, 59])
    selected = scenes.make()
    (chosen,) = selected.blobs.keys() - filtered.blobs.keys()
    assert np.flatnonzero(np.frombuffer(selected.blobs[chosen], np.uint8)).tolist() == [3, 59]


def test_colours_by_values_of_points_send_those_alone(scene):
    layer = scene.open("lines.fiblets")
    scenes = SentScenes(scene)
    sent = [scenes.make()]
    points = scene.actor(layer.id).fiblets.n_points
    for name, size in (("fa", 1), ("curvature", 2), ("fa", 1)):
        scene.set(layer.id, "scalars", name)
        sent.append(scenes.make())
        (values,) = sent[-1].blobs.keys() - sent[0].blobs.keys()
        assert len(sent[-1].blobs[values]) == size * points
        assert sent[0].blobs.keys() < sent[-1].blobs.keys()
    assert sent[3].content == sent[1].content


def test_bars_say_what_lines_are_coloured_by(scene):
    layer = scene.open("lines.fiblets")
    scene.set(layer.id, "scalars", "group")
    sent = SentScenes(scene).make()
    (bar,), (lines,) = sent.content["bars"], sent.content["layers"]
    colours = list(sent.blobs.values())[lines["colours"]["data"]]
    colours = np.frombuffer(colours, np.uint8).reshape(60, 4)[:, :3]
    near, far = (bar["colours"][bar["names"].index(name)] for name in ("near", "far"))
    assert np.array_equal(colours, [near] * 30 + [far] * 30)
    scene.set(layer.id, "scalars", "length")
    (bar,) = SentScenes(scene).make().content["bars"]
    assert (bar["title"], bar["log"]) == ("length [mm]", False)
    assert bar["clim"] == pytest.approx([10.0, 69.0], abs=0.01)
    scene.set(layer.id, "show_bar", False)
    assert SentScenes(scene).make().content["bars"] == []


def test_the_camera_is_no_part_of_the_scene(scene):
    scene.open("lines.fiblets")
    scenes = SentScenes(scene)
    first = scenes.make()
    scene.view("axial")
    assert scenes.make().content == first.content


@pytest.mark.parametrize(
    ("change", "why"),
    [
        (lambda scene: scene.open("head.nii.gz", kind="volume"), "the volume 'head.nii.gz'"),
        (lambda scene: scene.open("vessel.vtp", kind="tubes"), "the tubes 'vessel.vtp'"),
        (lambda scene: scene.set(scene.layers[0].id, "halos", True), "halos of 'lines.fiblets'"),
        (
            lambda scene: scene.set(scene.layers[0].id, "ambient_occlusion", True),
            "ambient occlusion of 'lines.fiblets'",
        ),
        (lambda scene: scene.set(scene.open("ball.ply").id, "show_edges", True), "the edges of 'ball.ply'"),
        (lambda scene: scene.set(scene.open("ball.ply").id, "culling", "front"), "the culling of 'ball.ply'"),
        (lambda scene: scene.set(scene.layers[0].id, "opacity", 0.5), "the opacity of 'lines.fiblets'"),
        (lambda scene: scene.add_clip("mesh", path="ball.ply"), "the cut of 'lines.fiblets' by a closed surface"),
        (lambda scene: scene.add_measurement([0, 0, 0], [9, 0, 0]), "measured distances"),
        (lambda scene: scene.remove(scene.layers[0].id), ""),
    ],
)
def test_what_cannot_be_drawn_is_named(scene, change, why):
    scene.open("lines.fiblets")
    change(scene)
    assert SentScenes(scene).make() == why


def test_a_selection_as_tubes_is_named_once(scene):
    layer = scene.open("lines.fiblets")
    scene.select(layer.id, [3])
    scene.set(layer.id, "selection_as_tubes", True)
    assert SentScenes(scene).make() == "the width or the tubes of what is selected of 'lines.fiblets'"


def test_slices_are_the_servers_in_every_layout(folder):
    plotter = pv.Plotter(off_screen=True, window_size=(200, 160), shape=(2, 2), border=False)
    ready_views(plotter)
    scene = Scene(plotter, folder)
    scene.open("lines.fiblets")
    image = scene.open("head.nii.gz", kind="image")
    for layout in LAYOUTS:
        scene.slicing.view = replace(scene.slicing.view, layout=layout)
        assert SentScenes(scene).make() == "slices of images"
    scene.remove(image.id)
    assert isinstance(SentScenes(scene).make(), SentScene)
    scene.close()
    plotter.close()


@pytest.mark.parametrize(
    ("asked", "webgl", "card", "on"),
    [
        ("auto", True, CARD, True),
        ("auto", True, "ANGLE (Google, Vulkan 1.3.0 (SwiftShader Device (Subzero)))", False),
        ("auto", True, "Mesa/X.org, llvmpipe (LLVM 15.0.7, 256 bits)", False),
        ("auto", False, "", False),
        ("there", True, "llvmpipe", True),
        ("there", False, "", False),
        ("here", True, CARD, False),
    ],
)
def test_who_draws_follows_from_what_is_asked_and_what_the_browser_has(scene, folder, asked, webgl, card, on):
    scene.open("lines.fiblets")
    desk = drawing(scene, folder, draw=asked)
    assert not desk.drawing.draws()  # until a browser has said what it has
    desk.drawing.report(webgl, card)
    assert desk.drawing.draws() is on
    assert desk.page.there["on"] is on
    told = [text for _, text in desk.said]
    assert told == (["The server draws: this browser has no WebGL 2."] if asked == "there" and not webgl else [])


def test_large_scenes_are_sent_only_if_that_is_asked(scene, folder, monkeypatch):
    scene.open("lines.fiblets")
    monkeypatch.setattr(SentScene, "bytes", LARGEST + 1_000_000)
    for asked in ("auto", "there"):
        desk = drawing(scene, folder, draw=asked)
        desk.drawing.report(True, CARD)
        assert desk.drawing.draws() is (asked == "there")
        assert ("65 MB, more than the 64 MB" in desk.page.drawing) is (asked == "auto")


def test_nothing_is_made_of_sets_that_are_too_large(scene, monkeypatch):
    layer = scene.open("lines.fiblets")
    monkeypatch.setattr(type(scene.actor(layer.id).fiblets), "nbytes", 2_000_000_000)
    monkeypatch.setattr("pvfiblets.page.fiblet_bytes.fiblet_bytes", lambda *_: pytest.fail("it was made"))
    said = "2,000 MB of streamlines, more than the 1,000 MB that are sent to it"
    assert SentScenes(scene).make() == said


def test_the_camera_goes_both_ways_and_only_when_it_has_moved(scene, folder):
    scene.open("lines.fiblets")
    desk = drawing(scene, folder)
    desk.drawing.report(True, CARD)
    desk.drawing.draws()
    assert desk.page.there_camera == {"camera": scene.camera(), "from": ""}
    moved = {**scene.camera(), "position": [300.0, 20.0, 10.0]}
    desk.drawing.moved(moved, "one page", False)
    assert scene.camera()["position"] == [300.0, 20.0, 10.0]
    desk.page.there_camera = {}
    desk.drawing.draws()
    assert desk.page.there_camera == {}  # the browser knows
    desk.drawing.moved(moved, "one page", True)
    assert desk.page.there_camera["from"] == "one page"  # others do not
    scene.view("axial")
    desk.drawing.draws()
    assert desk.page.there_camera == {"camera": scene.camera(), "from": ""}
    with pytest.raises(ValueError, match="position"):
        desk.drawing.moved({**moved, "position": ["far", 0, 0]}, "one page", False)


def test_only_data_of_the_scene_can_be_fetched(scene, folder):
    from aiohttp import web

    scene.open("lines.fiblets")
    desk = drawing(scene, folder)
    desk.drawing.report(True, CARD)
    desk.drawing.draws()

    def fetch(name):
        return asyncio.run(desk.drawing.send(SimpleNamespace(match_info={"name": name})))

    name = desk.page.there["scene"]["data"][0]["file"].rpartition("/")[2]
    assert len(fetch(name).body) == desk.page.there["scene"]["data"][0]["bytes"]
    with pytest.raises(web.HTTPNotFound):
        fetch("0" * len(name))


@pytest.mark.parametrize("other", [{"shared": True}, {"cluster": "tcp://127.0.0.1:8786"}])
def test_views_that_others_draw_or_see_are_the_servers(other, scene, folder):
    with pytest.raises(ValueError, match="--draw there"):
        Options(root=str(folder), draw="there", **other).checked()
    desk = drawing(scene, folder, **other)
    scene.open("lines.fiblets")
    desk.drawing.report(True, CARD)
    assert not desk.drawing.draws()
