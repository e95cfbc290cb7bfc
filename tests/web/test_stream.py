"""The sequence of pictures, without a browser."""

import asyncio
import io
import itertools
import time
from types import SimpleNamespace

import numpy as np
import pytest
import pyvista as pv
from PIL import Image
from scipy import ndimage

from pvfiblets.engine.pieces import Pieces
from pvfiblets.mappers.frames.incremental_frame import draw_in_pieces
from pvfiblets.mappers.frames.scene import reduce_detail, slack
from pvfiblets.synthetic import brain_streamlines
from pvfiblets.web.view import stream as stream_module
from pvfiblets.web.view.encoding import encode
from pvfiblets.web.view.pace import BUDGET, LEVELS, Pace
from pvfiblets.web.view.stream import PictureStream

from .desk import scene_of_views
from .streams import Streamer, doing, drag, rests, slow_stream


def test_a_session_is_warm_before_anybody_looks(plotter):
    plotter.add_mesh(pv.Sphere())
    stream = PictureStream(plotter, "view")
    stream.warm()
    assert stream.frames == 1
    stream.warm()
    assert stream.frames == 1
    assert stream.milliseconds > 0.0


def test_what_fails_while_warming_is_told(plotter, monkeypatch):
    told = []
    stream = PictureStream(plotter, "view", failed=told.append)
    error = RuntimeError("no memory")

    def fail():
        raise error

    monkeypatch.setattr(plotter, "render", fail)
    stream.warm()
    assert told == [error]
    assert stream.frames == 0


@pytest.mark.parametrize("codec", ["jpeg", "png", "webp"])
def test_pictures_of_every_codec_are_pictures(plotter, codec):
    pixels = np.zeros((40, 60, 3), np.uint8)
    pixels[:20] = 200, 30, 90
    found = np.asarray(Image.open(io.BytesIO(encode(pixels, codec, 92))).convert("RGB")).astype(int)
    assert found.shape == pixels.shape
    assert abs(found - pixels)[2:18].max() <= (0 if codec == "png" else 12)


def test_letters_are_as_large_on_screens_with_small_pixels(plotter):
    stream = PictureStream(plotter, "view")
    usual = plotter.render_window.GetDPI()
    for ratio in (2.0, 1.5, 1.0):
        stream.update_size("", {"w": 200, "h": 120, "p": ratio})
        assert plotter.render_window.GetDPI() == ratio * usual
        stream.picture()
        assert plotter.render_window.GetSize() == (200 * ratio, 120 * ratio)


def test_a_view_that_somebody_else_draws_is_left_out_until_it_is_asked_for():
    plotter = pv.Plotter(off_screen=True, window_size=(200, 120), shape=(1, 2), border=False)
    actors = []
    for column in (0, 1):
        plotter.subplot(0, column)
        plotter.set_background("black", all_renderers=False)
        actors.append(plotter.add_mesh(pv.Plane(i_size=9.0, j_size=9.0), color="white", lighting=False))
        plotter.view_xy()
    elsewhere, sent = [None], []
    stream = PictureStream(plotter, "view", codec="png", left_out=lambda: elsewhere[0])
    stream.update_size("", {"w": 200, "h": 120, "p": 1.0})

    async def frame():
        stream.set_streamer(SimpleNamespace(push_content=lambda _name, _meta, content: sent.append(content)))
        known = len(sent)
        stream.request()
        async with asyncio.timeout(120):
            while len(sent) == known:
                await asyncio.sleep(0.01)

    def middles(content):
        pixels = np.asarray(Image.open(io.BytesIO(content)).convert("RGB"))
        return [tuple(pixels[60, x].tolist()) for x in (50, 150)]

    async def run():
        await frame()
        for actor in actors:
            actor.prop.color = "red"
        elsewhere[0] = plotter.renderers[0]
        await frame()
        await stream.close()

    asyncio.run(run())
    assert middles(sent[0]) == [(255, 255, 255)] * 2
    assert middles(sent[-1]) == [(255, 255, 255), (255, 0, 0)]
    assert plotter.renderers[0].GetDraw()
    stream.settle()
    assert middles(encode(stream._read(), "png", 100)) == [(255, 0, 0)] * 2
    plotter.close()


def test_moves_of_the_cross_hair_show_panes_first_and_the_3d_view_next(folder):
    with scene_of_views(folder) as scene:
        scene.open("lines.fiblets")
        scene.open("head.nii.gz", "image")
        scene.images.set_slices(layout="beside")
        scene.plotter.window_size = size = 400, 240
        stream = PictureStream(scene.plotter, "view", codec="png", postpones=scene.slicing.postpones_3d)
        stream.update_size("", {"w": size[0], "h": size[1], "p": 1.0})
        sent, drawn, view = [], [], scene.slicing.view_3d
        view.AddObserver("StartEvent", lambda *_: drawn.append(len(sent)))

        class Taking(Streamer):
            def push_content(self, name, meta, content):
                sent.append(np.asarray(Image.open(io.BytesIO(content))))

        async def run():
            stream.set_streamer(Taking())
            stream.request()
            await rests(stream)
            first = len(sent)
            drawn.clear()
            x, y, z = scene.slicing.workspace.position
            scene.slicing.workspace.position = x + 12.0, y - 8.0, z + 12.0
            stream.request()
            await rests(stream)
            moved = len(sent)
            scene.slicing.workspace.position = x, y, z
            stream.hasten()  # as clicks in panes do
            await rests(stream)
            np.testing.assert_array_equal(sent[-1], sent[first - 1])
            del sent[moved:]
            await stream.close()
            return first

        first = asyncio.run(run())
        before, panes, whole = sent[first - 1], sent[first], sent[-1]
        assert first not in drawn  # no 3-D view was drawn for the panes
        box = next(one for one in scene.slicing.boxes() if one["name"] == "3d")
        in_3d = np.zeros(size[::-1], bool)
        in_3d[round(box["y"] * size[1]) : round((box["y"] + box["h"]) * size[1]),
              round(box["x"] * size[0]) : round((box["x"] + box["w"]) * size[0])] = True  # fmt: skip
        np.testing.assert_array_equal(panes[in_3d], before[in_3d])
        np.testing.assert_array_equal(panes[~in_3d], whole[~in_3d])
        assert (panes[~in_3d] != before[~in_3d]).any()
        assert (whole[in_3d] != before[in_3d]).any()


def test_slow_scenes_have_fewer_pixels_while_the_camera_moves_and_all_at_rest(plotter):
    plotter.add_mesh(pv.Sphere())
    stream, streamer = slow_stream(plotter), Streamer()
    drag(stream, streamer)
    assert streamer.sizes[0] == (200, 120)
    assert {(100, 60), (70, 42)} & set(streamer.sizes)
    assert streamer.sizes[-1] == (200, 120)
    assert streamer.qualities[-1] == stream.still_quality
    assert tuple(plotter.render_window.GetSize()) == (200, 120)
    assert plotter.render_window.GetMultiSamples() == stream._sharp[0]


def test_a_picture_that_is_waited_for_comes_coarse_and_then_whole(plotter):
    plotter.add_mesh(pv.Sphere())
    stream, streamer = slow_stream(plotter, seconds=1.0), Streamer()
    stream.warm()

    async def run():
        stream.set_streamer(streamer)
        stream.hasten()
        async with asyncio.timeout(120):
            while not streamer.sizes or streamer.sizes[-1] != (200, 120):
                await asyncio.sleep(0.01)
        await stream.close()

    asyncio.run(run())
    assert streamer.sizes[0][0] < 200
    assert streamer.qualities[0] < streamer.qualities[-1] == stream.still_quality


def test_quick_scenes_keep_their_pixels(plotter):
    plotter.add_mesh(pv.Sphere())
    stream, streamer = slow_stream(plotter, 0.01), Streamer()
    drag(stream, streamer)
    assert set(streamer.sizes) == {(200, 120)}
    assert stream.frames <= len(streamer.sizes)  # the last is coded again, not drawn again


def test_fewer_pixels_turn_the_camera_as_far(plotter):
    """The same way of the pointer, over pictures of either size."""
    plotter.add_mesh(pv.Cube())
    places = []
    for seconds in (0.01, 1.0):
        plotter.camera_position = "xy"
        plotter.reset_camera()
        stream = slow_stream(plotter, seconds)
        drag(stream, Streamer(), moves=8)
        places.append(np.array(plotter.camera.position))
    moved = np.linalg.norm(places[0] - np.array([0.0, 0.0, np.linalg.norm(places[0])]))
    assert moved > 0.5
    np.testing.assert_allclose(places[0], places[1], atol=0.05 * moved)


def test_a_picture_that_is_asked_for_is_whole(plotter):
    plotter.add_mesh(pv.Sphere())
    stream = PictureStream(plotter, "view")
    stream.update_size("", {"w": 200, "h": 120, "p": 1.0})
    whole = stream._draw()
    assert stream._draw(LEVELS[1]).shape == (60, 100, 3)
    assert stream.settle() == (200, 120)
    assert tuple(plotter.render_window.GetSize()) == (200, 120)
    stream._draw(LEVELS[1])
    np.testing.assert_array_equal(np.asarray(Image.open(io.BytesIO(stream.picture()))), whole)


def test_letters_keep_their_size_on_the_page(plotter):
    """Of half the pixels letters cover about the same share."""
    plotter.background_color = "white"
    plotter.add_text("tractogram", font_size=30, color="black", position=(0.1, 0.4), viewport=True)
    stream = PictureStream(plotter, "view")
    stream.update_size("", {"w": 400, "h": 240, "p": 1.0})
    whole, reduced = stream._draw(), stream._draw(LEVELS[1])
    shares = [float((pixels < 128).any(-1).mean()) for pixels in (whole, reduced)]
    columns = [
        float(np.ptp(np.nonzero((pixels < 128).any((0, 2)))[0])) / pixels.shape[1] for pixels in (whole, reduced)
    ]
    assert shares[1] == pytest.approx(shares[0], rel=0.25)
    assert columns[1] == pytest.approx(columns[0], rel=0.1)


def test_wide_lines_keep_their_width_on_the_page(plotter):
    line = np.stack([np.linspace(-1.0, 1.0, 50), np.zeros(50), np.zeros(50)], 1)
    plotter.add_fiblets([line], line_width=8, color="black")
    plotter.background_color = "white"
    plotter.view_xy()
    stream = PictureStream(plotter, "view")
    stream.update_size("", {"w": 400, "h": 240, "p": 1.0})
    shares = [float((stream._draw(level) < 128).any(-1).mean()) for level in LEVELS[:2]]
    assert shares[0] > 0.01
    assert shares[1] == pytest.approx(shares[0], rel=0.1)


def test_fewer_pixels_zoom_as_far_as_fingers_do(plotter):
    """Fingers close to half their distance; the picture is reduced in between, and whole again."""
    plotter.add_mesh(pv.Sphere())
    stream = PictureStream(plotter, "view")
    stream.update_size("", {"w": 400, "h": 240, "p": 1.0})
    stream._draw()
    before = plotter.camera.distance
    for kind, half, level in (("StartPinch", 100, 1), ("Pinch", 80, 1), ("Pinch", 60, 0), ("EndPinch", 50, 0)):
        places = {"1": {"x": 200 - half, "y": 120}, "2": {"x": 200 + half, "y": 120}}
        stream.on_interaction("", {"type": kind, "w": 400, "h": 240, "positions": places})
        stream._draw(LEVELS[level])
    assert plotter.camera.distance == pytest.approx(before / 0.6, rel=0.03)  # an end moves nothing
    assert np.linalg.norm(np.array(plotter.camera.focal_point)) < 0.01 * before


def rest(stream, streamer):
    """Ask for one picture, and wait until it is finished."""

    async def run():
        stream.set_streamer(streamer)
        stream.request()
        await rests(stream)
        await stream.close()

    asyncio.run(run())


@pytest.fixture
def refined(plotter, monkeypatch):
    """A plotter with fiblets whose samples are drawn one by one, and a list that grows with its frames."""
    monkeypatch.delenv("PVFIBLETS_ANTIALIAS")
    monkeypatch.setattr(Pace, "untried", False)  # frames that are drawn in advance depend on time
    plotter.add_fiblets([[(0, 0, 0), (9, 4, 0)], [(0, 5, 0), (9, 1, 2)]], color="white", lighting=False)
    plotter.picture.antialias_seconds = 1e6
    frames = []
    plotter.render_window.AddObserver("EndEvent", lambda *_: frames.append(1))
    return plotter, frames


# The last of those one by one has whole thin lines: depths are theirs.
@pytest.mark.parametrize(("limit", "drawn"), [(1e6, 18), (None, 2)])
def test_at_rest_the_refined_picture_is_sent_and_nothing_after_it(refined, limit, drawn):
    plotter, frames = refined
    plotter.picture.antialias_seconds = limit
    stream, streamer = PictureStream(plotter, "view"), Streamer()
    sent = []
    streamer.push_content = lambda name, meta, content: (sent.append(content), streamer.sizes.append(meta))
    plotter.camera.Azimuth(10.0)
    frames.clear()
    rest(stream, streamer)
    assert stream.sent == 2
    assert stream.frames == 1
    assert len(frames) == drawn
    first, last = (np.asarray(Image.open(io.BytesIO(content)).convert("L")).astype(int) for content in sent)
    assert plotter.picture.samples == 16
    assert (first != last).any()


def test_an_event_stops_refining_and_it_begins_anew(refined):
    plotter, _ = refined
    stream, streamer = PictureStream(plotter, "view"), Streamer()
    refine, steps = plotter.picture.refine, []

    def once():
        steps.append(plotter.picture.samples)
        if len(steps) == 5:
            plotter.camera.Azimuth(10.0)
            stream.request()
            return True
        return refine()

    stream._plotter = Stand(plotter, once)
    plotter.camera.Azimuth(10.0)
    rest(stream, streamer)
    assert steps[:6] == [1, 1, 2, 3, 4, 1]
    assert stream.frames == 2
    assert stream.sent == 3
    assert plotter.picture.samples == 16


def test_samples_of_slow_frames_wait_until_nobody_has_acted_for_a_while(refined, monkeypatch):
    plotter, _ = refined
    monkeypatch.setattr(stream_module, "HEAVY", 0.0)
    monkeypatch.setattr(stream_module, "LONGEST_REST", 1.0)
    monkeypatch.setattr(stream_module, "RESTS", 1e6)
    stream, streamer = PictureStream(plotter, "view"), Streamer()
    refine, begun = plotter.picture.refine, []

    def once():
        begun.append(time.monotonic())
        return refine()

    stream._plotter = Stand(plotter, once)
    plotter.camera.Azimuth(10.0)
    before = time.monotonic()
    rest(stream, streamer)
    assert begun[0] - before > 1.0
    assert plotter.picture.samples == 16
    assert np.median(np.diff(begun)) > 1.5 * stream_module.HEARD


class Stand:
    """A plotter of which one method is another's."""

    def __init__(self, plotter, refine):
        self._plotter, self._refine = plotter, refine

    def __getattr__(self, name):
        return getattr(self._plotter, name)

    @property
    def picture(self):
        return Picture(self._plotter.picture, self._refine)


class Picture:
    def __init__(self, picture, refine):
        self._picture, self.refine = picture, refine

    def __getattr__(self, name):
        return getattr(self._picture, name)


def test_the_picture_that_is_saved_is_finished(refined):
    plotter, _ = refined
    stream = PictureStream(plotter, "view")
    saved = np.asarray(Image.open(io.BytesIO(stream.picture())))
    assert plotter.picture.samples == 16
    assert np.array_equal(saved[..., :3], np.asarray(plotter.screenshot(None)))


def test_pictures_of_any_size_have_lines_and_bars_as_the_page_has_them(plotter):
    ball = pv.Sphere()
    ball["height"] = ball.points[:, 2]
    line = plotter.add_fiblets([[(-1, -0.7, 0), (1, -0.7, 0)]], color="red", line_width=6)
    line.lighting = False
    plotter.add_mesh(ball, scalars="height", show_scalar_bar=False, lighting=False)
    stream = PictureStream(plotter, "view")
    stream.update_size("", {"w": 200, "h": 160, "p": 1.0})
    page = np.asarray(Image.open(io.BytesIO(stream.picture())).convert("RGB")).astype(int)
    np.testing.assert_array_equal(stream.picture_of(200, 160), page)

    def thick(picture):
        red = (picture[..., 0] > 200) & (picture[..., 1:3].max(axis=-1) < 60)
        return red.sum(axis=0).max()

    usual = thick(page)
    assert usual in (6, 7)
    for width, height in ((401, 319), (600, 480), (100, 80), (333, 480)):
        found = stream.picture_of(width, height)
        assert found.shape == (height, width, 3)
        assert thick(found) == pytest.approx(usual * height / 160, abs=1.5)
    larger = np.asarray(Image.fromarray(stream.picture_of(600, 480)).resize((200, 160), Image.Resampling.BOX))
    assert np.abs(larger.astype(int) - page).mean() < 3
    clear = stream.picture_of(300, 240, transparent=True)
    assert clear.shape == (240, 300, 4)
    assert clear[0, 0].tolist() == [0, 0, 0, 0]
    assert clear[120, 150, 3] == 255
    assert plotter.render_window.GetSize() == (200, 160)
    np.testing.assert_array_equal(np.asarray(Image.open(io.BytesIO(stream.picture())).convert("RGB")), page)


def test_haste_ends_at_rest(plotter):
    """Lines of reduced pictures may be off by a drawn pixel or two, no more, and by nothing at rest."""
    rng = np.random.default_rng(3)
    lines = [np.cumsum(rng.normal(size=(400, 3)) * 0.02 + rng.normal(size=3) * 0.05, axis=0) for _ in range(5)]
    actor = plotter.add_fiblets(lines, color="black")
    plotter.background_color = "white"
    stream = PictureStream(plotter, "view")
    stream.update_size("", {"w": 400, "h": 240, "p": 1.0})
    whole = stream._draw()
    for level, pixels in ((LEVELS[1], 1.0), (LEVELS[3], 2.0)):
        hasty = (stream._draw(level) < 250).any(-1)
        assert slack(plotter.renderer) == pixels
        reduce_detail(plotter.render_window, 0.0)
        actor.mapper.Modified()
        true = (stream._draw(level) < 250).any(-1)
        reach = ndimage.generate_binary_structure(2, 2)
        assert true.sum() > 100
        for one, other in ((hasty, true), (true, hasty)):
            assert not (one & ~ndimage.binary_dilation(other, reach, round(pixels) + 1)).any()
        stream._resize(LEVELS[0])
    assert slack(plotter.renderer) == 0.0
    np.testing.assert_array_equal(stream._draw(), whole)


def test_a_stream_is_closed_at_the_very_moment_of_an_event(plotter, monkeypatch):
    """What waits for the event swallows the cancelling, once."""
    monkeypatch.setattr(stream_module, "REST", 60.0)
    plotter.add_mesh(pv.Sphere())
    stream = PictureStream(plotter, "view")

    async def run():
        stream.set_streamer(Streamer())
        stream.request()
        async with asyncio.timeout(120):
            while doing(stream)[-3:] != ["_refine", "_wanted_within", "wait"]:
                await asyncio.sleep(0.002)
        stream.request()
        await asyncio.sleep(0)  # the event has come, and who waits for it has not been told
        async with asyncio.timeout(120):
            await stream.close()
        assert stream._task.done()

    asyncio.run(run())


@pytest.fixture
def pieced(plotter, monkeypatch):
    """A plotter of a brain whose pieces end after a group of fiblets each, and its stream, whose frames seem slow."""
    monkeypatch.setattr(Pieces.__init__, "__defaults__", (0.0,))
    plotter.add_fiblets(brain_streamlines(150, 0.5, seed=2))
    return plotter, slow_stream(plotter, codec="png")


def act_at(monkeypatch, stream, act):
    """Have something happen after the second piece of the first whole picture; return the pieces of each."""
    counts = []

    def pieces(window, **how):
        counts.append(0)
        for _ in draw_in_pieces(window, **how):
            counts[-1] += 1
            if len(counts) == 1 and counts[0] == 2:
                act()
            yield

    monkeypatch.setattr(stream_module, "draw_in_pieces", pieces)
    return counts


def pictures_of(stream, streamer):
    """Let a picture be drawn for somebody who moves the camera, wait until it is whole, and return what was sent."""
    sent = []

    def push(name, meta, content):
        Streamer.push_content(streamer, name, meta, content)
        sent.append(np.asarray(Image.open(io.BytesIO(content))))

    streamer.push_content = push

    async def run():
        stream.set_streamer(streamer)
        stream.hasten()
        await rests(stream)
        await stream.close()

    asyncio.run(run())
    return sent


def move(stream):
    keys = {"ctrlKey": False, "altKey": False, "shiftKey": False}
    for kind, x in (("LeftButtonPress", 40), ("MouseMove", 60)):
        stream.on_interaction("", {"type": kind, "x": x, "y": 50, "w": 200, "h": 120, **keys})


def test_a_full_resolution_frame_is_dropped_on_input_and_drawn_later(pieced, monkeypatch):
    plotter, stream = pieced
    streamer = Streamer()
    stream.warm()
    counts = act_at(monkeypatch, stream, lambda: move(stream))
    sent = pictures_of(stream, streamer)
    assert stream.given_up == 1
    assert counts[0] == 2
    assert counts[1] > 3
    assert [size[0] < 200 for size in streamer.sizes] == [True, True, False]  # before the move, after it, at rest
    assert len(sent) == 3
    plotter.camera.Azimuth(1.0)  # drawn anew, at once
    plotter.render()
    plotter.camera.Azimuth(-1.0)
    plotter.render()
    assert np.array_equal(sent[-1], stream._read())


def test_a_whole_picture_is_finished_at_once_when_others_than_the_camera_want_one(pieced, monkeypatch):
    _, stream = pieced
    streamer = Streamer()
    stream.warm()
    counts = act_at(monkeypatch, stream, stream.request)
    pictures_of(stream, streamer)
    assert stream.given_up == 0
    assert counts[0] == 2
    assert streamer.sizes[0][0] < 200
    assert streamer.sizes[1] == (200, 120)


def test_quick_scenes_are_not_drawn_in_pieces(plotter, monkeypatch):
    monkeypatch.setattr(Pieces.__init__, "__defaults__", (0.0,))
    plotter.add_fiblets(brain_streamlines(150, 0.5, seed=2))
    stream = slow_stream(plotter, 0.01)
    stream.warm()
    counts = act_at(monkeypatch, stream, lambda: None)
    drag(stream, Streamer())
    assert not counts


def settled(seconds, frames=40, slower=1.0):
    """Return the levels of frames that take a time in proportion to their costs; the tenth and on take more."""
    pace, found = Pace(), []
    for k in range(frames):
        level = pace.choose()
        pace.took(level, seconds * level.cost * (slower if k >= 10 else 1.0))
        found.append(LEVELS.index(level))
    return found


def test_quick_scenes_are_fine_and_slow_ones_find_their_level_at_once():
    assert set(settled(0.5 * BUDGET)) == {0}
    pace = Pace()
    for level, seconds in ((LEVELS[0], 4.0), (LEVELS[2], 0.8), (LEVELS[2], 0.8), (LEVELS[1], 3.0), (LEVELS[1], 3.0)):
        pace.took(level, seconds * BUDGET)
    assert pace.choose() is LEVELS[2]
    pace = Pace()
    pace.took(LEVELS[0], 4.0 * BUDGET)
    assert pace.untried
    pace.took(pace.level, 0.9 * BUDGET)
    assert not pace.untried


@pytest.mark.parametrize(("seconds", "level"), [(1.5, 1), (4.0, 2), (7.0, 3), (14.0, 4), (1000.0, 4)])
def test_one_slow_frame_is_enough_to_find_the_level(seconds, level):
    assert settled(seconds * BUDGET)[1:] == [level] * 39


def test_levels_change_once_and_stay():
    found = settled(7.0 * BUDGET, slower=0.05)
    assert found[9] == 3
    assert found[-5:] == [0] * 5
    assert sum(a != b for a, b in itertools.pairwise(found)) <= 5
    for share in (0.9, 0.98, 1.02, 1.1):
        found = settled(share * BUDGET / LEVELS[1].cost, frames=60)
        assert len(set(found[5:])) == 1
    pace = Pace()
    for k in range(20):
        pace.took(pace.choose(), 5.0 * BUDGET if k == 12 else 0.3 * BUDGET)
        assert pace.choose() is LEVELS[0]
    pace, level = Pace(), LEVELS[4]
    pace.took(LEVELS[0], 16.0 * BUDGET)
    for k in range(60):
        assert pace.choose() is level
        pace.took(level, BUDGET * (0.2 if k % 4 == 1 else 0.9))
    pace = Pace()
    pace.took(LEVELS[0], 1.5 * BUDGET)
    assert pace.choose() is LEVELS[1]
    pace.took(LEVELS[1], 1.2 * BUDGET)  # compiles and copies
    pace.took(LEVELS[0], 0.4 * BUDGET, moved=False)  # the camera is where it was
    for seconds in (0.3, 0.31, 0.29, 0.3, 0.3, 0.32, 0.3):
        assert pace.choose() is LEVELS[1]
        pace.took(LEVELS[1], seconds * BUDGET)
