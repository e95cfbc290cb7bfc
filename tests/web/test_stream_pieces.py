"""Whole pictures that are drawn in pieces and given up when somebody acts; test_stream.py has all else."""

from __future__ import annotations

import asyncio
import io

import numpy as np
import pytest
from PIL import Image

from pvfiblets.engine.pieces import Pieces
from pvfiblets.mappers.ahead import draw_ahead
from pvfiblets.synthetic import brain_streamlines
from pvfiblets.web import stream as stream_module
from pvfiblets.web.stream import REST

from .streams import Streamer, drag, slow_stream


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
        for _ in draw_ahead(window, **how):
            counts[-1] += 1
            if len(counts) == 1 and counts[0] == 2:
                act()
            yield

    monkeypatch.setattr(stream_module, "draw_ahead", pieces)
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
        async with asyncio.timeout(60):
            while not sent or streamer.sizes[-1] != (200, 120):
                await asyncio.sleep(0.002)
        await asyncio.sleep(2 * REST)
        await stream.close()

    asyncio.run(run())
    return sent


def move(stream):
    keys = {"ctrlKey": False, "altKey": False, "shiftKey": False}
    for kind, x in (("LeftButtonPress", 40), ("MouseMove", 60)):
        stream.on_interaction("", {"type": kind, "x": x, "y": 50, "w": 200, "h": 120, **keys})


def test_a_whole_picture_is_given_up_when_somebody_acts_and_comes_later(pieced, monkeypatch):
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
