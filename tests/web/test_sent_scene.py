"""What a browser is sent to draw, and whether it is to, without a browser."""

import asyncio
import zlib
from dataclasses import replace
from types import SimpleNamespace

import nibabel
import numpy as np
import pytest
import pyvista as pv

from pvfiblets.web.scene.scene import Scene
from pvfiblets.web.scene.slices.slicing import LAYOUTS, ready_views
from pvfiblets.web.server.options import Options
from pvfiblets.web.view.browser_drawing import BrowserDrawing
from pvfiblets.web.view.sent_scene import LARGEST, SentScene, SentScenes
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
    scene.filters.set_filter(layer.id, "length", 40.5)
    filtered = scenes.make()
    (kept,) = filtered.blobs.keys() - first.blobs.keys()
    assert np.array_equal(np.frombuffer(filtered.blobs[kept], np.uint8), np.arange(10, 70) > 40.5)
    scene.selection.select(layer.id, [3, 59])
    selected = scenes.make()
    (chosen,) = selected.blobs.keys() - filtered.blobs.keys()
    assert np.flatnonzero(np.frombuffer(selected.blobs[chosen], np.uint8)).tolist() == [3, 59]


def test_colours_by_values_of_points_send_those_alone(scene):
    layer = scene.open("lines.fiblets")
    scenes = SentScenes(scene)
    sent = [scenes.make()]
    points = scene.actor(layer.id).fiblets.n_points
    for name in ("fa", "curvature", "fa"):
        scene.set(layer.id, "scalars", name)
        sent.append(scenes.make())
        codes, blobs = sent[-1].content["layers"][0]["colours"]["codes"], list(sent[-1].blobs.values())
        assert len(blobs[codes["data"]]) == points * codes["bits"] // 8
        assert len(blobs[codes["table"]]) == 4 << codes["bits"]
        assert len(sent[-1].blobs.keys() - sent[0].blobs.keys()) == 2
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
    scene.cameras.view("axial")
    assert scenes.make().content == first.content


def tubes(scene, name=None, value=None):
    layer = scene.open("vessel.vtp", kind="tubes")
    if name is not None:
        scene.set(layer.id, name, value)
    return layer


def test_spline_tubes_are_sent_as_surfaces_and_once(scene, monkeypatch):
    layer = tubes(scene, "scalars", "radius")
    scenes = SentScenes(scene)
    first, again = scenes.make(), scenes.make()
    assert again.content == first.content
    (surface,), blobs = first.content["layers"], list(first.blobs.values())
    places = np.frombuffer(blobs[surface["places"]], np.float32).reshape(-1, 3)
    curve = pv.read(scene.files.resolve("vessel.vtp"))
    along = pv.Spline(curve.points, 3000).points
    gaps = np.linalg.norm(places[:, None] - along, axis=2)
    nodes = np.linalg.norm(curve.points[:, None] - along, axis=2).argmin(axis=1)
    radius = np.interp(gaps.argmin(axis=1), nodes, curve["radius"])
    round_ends = (places[:, 0] > 1.0) & (places[:, 0] < 39.0)
    np.testing.assert_allclose(gaps.min(axis=1)[round_ends], radius[round_ends], atol=0.05)
    assert [bar["title"] for bar in first.content["bars"]] == ["radius [mm]"]
    scene.set(layer.id, "radius_scale", 2.0)
    wider = scenes.make()
    assert wider.blobs.keys() != first.blobs.keys()
    monkeypatch.setattr("pvfiblets.plotting.page.page_scene.MOST_TUBE_POINTS", 100)
    assert scenes.make() == "the tubes 'vessel.vtp'"


@pytest.mark.parametrize(
    ("change", "why"),
    [
        (lambda scene: scene.open("head.nii.gz", kind="volume"), "the volume 'head.nii.gz'"),
        (lambda scene: tubes(scene, "ambient_occlusion", True), "ambient occlusion of 'vessel.vtp'"),
        (lambda scene: tubes(scene, "silhouette", True), "silhouette of 'vessel.vtp'"),
        (lambda scene: tubes(scene, "opacity", 0.5), "the opacity of 'vessel.vtp'"),
        (lambda scene: scene.set(scene.layers[0].id, "halos", True), "halos of 'lines.fiblets'"),
        (
            lambda scene: scene.set(scene.layers[0].id, "ambient_occlusion", True),
            "ambient occlusion of 'lines.fiblets'",
        ),
        (
            lambda scene: scene.filters.add_clip("mesh", path="ball.ply"),
            "the cut of 'lines.fiblets' by a closed surface",
        ),
        (lambda scene: scene.remove(scene.layers[0].id), ""),
    ],
)
def test_what_cannot_be_drawn_is_named(scene, change, why):
    scene.open("lines.fiblets")
    change(scene)
    assert SentScenes(scene).make() == why


def test_measured_distances_go_along_and_are_no_layers(scene):
    scene.open("lines.fiblets")
    before = SentScenes(scene).make()
    scene.measurements.add_measurement([0, 0, 0], [9, 0, 0])
    sent = SentScenes(scene).make()
    assert sent.content["distances"] == [{"from": (0.0, 0.0, 0.0), "to": (9.0, 0.0, 0.0), "text": "9 mm"}]
    assert {**sent.content, "distances": []} == before.content


def test_a_selection_as_tubes_is_named_once(scene):
    layer = scene.open("lines.fiblets")
    scene.selection.select(layer.id, [3])
    scene.set(layer.id, "selection_as_tubes", True)
    assert SentScenes(scene).make() == "the width or the tubes of the selection of 'lines.fiblets'"


@pytest.fixture
def sliced(folder):
    """Return a scene of lines and an image, whose slices are in the 3-D view."""
    plotter = pv.Plotter(off_screen=True, window_size=(200, 160), shape=(2, 2), border=False)
    ready_views(plotter)
    scene = Scene(plotter, folder)
    scene.open("lines.fiblets")
    scene.open("head.nii.gz", kind="image")
    scene.images.set_slices(layout="3d")
    yield scene
    scene.close()
    plotter.close()


def test_panes_and_glyphs_are_the_servers(sliced):
    scenes = SentScenes(sliced)
    for layout in LAYOUTS:
        sliced.slicing.view = replace(sliced.slicing.view, layout=layout)
        alone = sliced.slicing.workspace.layout in ("axial", "coronal", "sagittal")
        assert (scenes.make() == "panes of slices") is alone
        assert sliced.slicing.beside is (layout != "3d")
    sliced.images.set_slices(layout="3d")
    sent = scenes.make()
    assert [layer["kind"] for layer in sent.content["layers"]] == ["fiblets", "image", "image", "image"]
    peaks = nibabel.Nifti1Image(np.zeros((4, 4, 4, 3), np.float32), np.diag([16.0, 16.0, 16.0, 1.0]))
    nibabel.save(peaks, sliced.files.resolve("peaks.nii.gz", new=True))
    image = sliced.open("peaks.nii.gz", kind="image")
    sliced.set(image.id, "glyphs", "peaks")
    assert scenes.make() == "the glyphs of 'peaks.nii.gz'"
    sliced.show(image.id, False)
    assert isinstance(scenes.make(), SentScene)


def test_a_slice_that_moves_sends_its_pixels_alone(sliced):
    scenes = SentScenes(sliced)
    x, y, z = sliced.slicing.view.position
    sliced.images.set_slices(
        position=(x + 4.0, y + 8.0, z + 12.0)
    )  # the image is round: in its middle slices are alike
    first = scenes.make()
    assert len(first.pixels) == 3
    sliced.images.set_slices(position=(x + 4.0, y + 8.0, z + 20.0))
    moved = scenes.make()
    (pixels,) = moved.blobs.keys() - first.blobs.keys()
    assert pixels in moved.pixels
    found = np.frombuffer(moved.blobs[pixels], np.uint8)
    assert np.array_equal(found, sliced.slicing.workspace.slices["axial"].actor.pixels.ravel())
    sliced.images.set_slices(planes=False)
    assert scenes.make().pixels == frozenset()


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
    assert desk.page.there_camera == {"camera": scene.cameras.camera(), "from": "", "turn": 1}
    moved = {**scene.cameras.camera(), "position": [300.0, 20.0, 10.0]}
    desk.drawing.moved(moved, "one page", False, 1)
    assert scene.cameras.camera()["position"] == [300.0, 20.0, 10.0]
    desk.page.there_camera = {}
    desk.drawing.draws()
    assert desk.page.there_camera == {}  # the browser knows
    desk.drawing.moved(moved, "one page", True, 1)
    assert desk.page.there_camera["from"] == "one page"  # others do not
    scene.cameras.view("axial")
    desk.drawing.draws()
    assert desk.page.there_camera == {"camera": scene.cameras.camera(), "from": "", "turn": 3}
    with pytest.raises(ValueError, match="position"):
        desk.drawing.moved({**moved, "position": ["far", 0, 0]}, "one page", False, 3)


def test_a_move_that_a_browser_made_before_it_knew_of_another_is_left_out(scene, folder):
    scene.open("lines.fiblets")
    desk = drawing(scene, folder)
    desk.drawing.report(True, CARD)
    desk.drawing.draws()
    moved = {**scene.cameras.camera(), "position": [300.0, 20.0, 10.0]}
    desk.drawing.moved(moved, "one page", False, 1)
    scene.cameras.view("axial")
    axial = scene.cameras.camera()
    desk.drawing.moved(moved, "one page", False, 1)  # no page has been sent the view yet
    assert scene.cameras.camera() == axial
    desk.drawing.draws()
    sent = dict(desk.page.there_camera)
    desk.drawing.moved(moved, "one page", True, 1)  # on its way when the view was sent
    assert scene.cameras.camera() == axial
    assert desk.page.there_camera == sent
    desk.drawing.moved(moved, "one page", True, sent["turn"])
    desk.drawing.moved(sent["camera"], "another page", True, sent["turn"])
    assert scene.cameras.camera() == moved
    assert desk.page.there_camera["from"] == "one page"


def test_a_browser_that_draws_again_is_sent_the_camera_again(scene, folder):
    """Else a move that it made while the server drew would leave them apart: equal states are not sent."""
    layer = scene.open("lines.fiblets")
    desk = drawing(scene, folder)
    desk.drawing.report(True, CARD)
    desk.drawing.draws()
    before = desk.page.there_camera
    scene.set(layer.id, "halos", True)
    assert not desk.drawing.draws()
    desk.drawing.moved({**scene.cameras.camera(), "position": [300.0, 20.0, 10.0]}, "one page", True, before["turn"])
    scene.set(layer.id, "halos", False)
    assert desk.drawing.draws()
    assert desk.page.there_camera["camera"] == before["camera"]
    assert desk.page.there_camera != before


def test_only_data_of_the_scene_can_be_fetched(scene, folder):
    from aiohttp import web

    scene.open("lines.fiblets")
    desk = drawing(scene, folder)
    desk.drawing.report(True, CARD)
    desk.drawing.draws()

    def fetch(name):
        return asyncio.run(desk.drawing.send(SimpleNamespace(match_info={"name": name}, headers={})))

    name = desk.page.there["scene"]["data"][0]["file"].rpartition("/")[2]
    assert len(fetch(name).body) == desk.page.there["scene"]["data"][0]["bytes"]
    with pytest.raises(web.HTTPNotFound):
        fetch("0" * len(name))


@pytest.mark.parametrize("accepted", ["gzip, deflate, br", "identity"])
def test_pixels_of_slices_are_packed_on_their_way(accepted, sliced, folder):
    desk = drawing(sliced, folder)
    desk.drawing.report(True, CARD)
    assert desk.drawing.draws()
    scene = desk.page.there["scene"]
    at = next(layer["pixels"] for layer in scene["layers"] if layer["kind"] == "image")
    asked = SimpleNamespace(
        match_info={"name": scene["data"][at]["file"].rpartition("/")[2]}, headers={"Accept-Encoding": accepted}
    )
    answer = asyncio.run(desk.drawing.send(asked))
    packed = answer.headers.get("Content-Encoding") == "deflate"
    assert packed is ("deflate" in accepted)
    assert len(zlib.decompress(answer.body) if packed else answer.body) == scene["data"][at]["bytes"]


@pytest.mark.parametrize("other", [{"shared": True}, {"cluster": "tcp://127.0.0.1:8786"}])
def test_views_that_others_draw_or_see_are_the_servers(other, scene, folder):
    with pytest.raises(ValueError, match="--draw there"):
        Options(root=str(folder), draw="there", **other).checked()
    desk = drawing(scene, folder, **other)
    scene.open("lines.fiblets")
    desk.drawing.report(True, CARD)
    assert not desk.drawing.draws()
