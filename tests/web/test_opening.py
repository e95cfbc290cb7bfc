"""What takes long runs beside the page: sessions, files and volumes, with progress, and can be stopped."""

from __future__ import annotations

import asyncio
import json
import threading

import pytest

from pvfiblets.web import session
from pvfiblets.web.document import Source
from pvfiblets.web.session import SessionError
from tests.web.desk import Desk


@pytest.fixture
def desk(scene, folder):
    return Desk(scene, folder)


@pytest.fixture
def threads(monkeypatch, scene):
    """Return the names of the threads that read files, as they do."""
    found = []
    load = type(scene.files).load

    def watched(self, *arguments):
        found.append(threading.current_thread() is threading.main_thread())
        return load(self, *arguments)

    monkeypatch.setattr(type(scene.files), "load", watched)
    return found


def saved(scene):
    """Return a session of lines that a volume colours, and leave the scene empty."""
    scene.open("head.nii.gz")
    layer = scene.open("lines.trk")
    scene.set(layer.id, "scalars", {"volume": {"path": "head.nii.gz"}})
    data = session.to_dict(scene)
    for other in scene.layers:
        scene.remove(other.id)
    scene.forget_unused()
    return data


def test_a_session_is_read_beside_the_page_and_the_page_goes_on(desk, scene, threads):
    text = json.dumps(saved(scene))
    threads.clear()
    jobs, ticks = [], []

    async def test():
        files = desk.files
        files.load_session(text)
        while not scene.layers:
            await asyncio.sleep(0.001)
            ticks.append(1)
            if desk.page.job:
                jobs.append(desk.page.job)
        await desk.done()

    asyncio.run(test())
    assert threads == [False] * len(threads)
    assert len(threads) >= 3
    assert [layer.kind for layer in scene.layers] == ["volume", "tractogram"]
    assert jobs[0]["text"].startswith("session: ")
    assert jobs[0]["cancellable"]
    assert desk.page.job == {}
    assert len(ticks) > 3
    assert desk.history.undo_label == "open a session"


def test_a_session_that_is_stopped_or_wrong_changes_nothing(desk, scene):
    data = saved(scene)
    state, kept = scene.state, dict(scene.store.loaded)

    async def stopped():
        files = desk.files
        files.load_session(json.dumps(data))
        await asyncio.sleep(0)
        await asyncio.sleep(0)
        files.cancel()
        await desk.done()

    asyncio.run(stopped())
    assert desk.said == [("info", "The session was not loaded: cancelled.")]
    data["layers"][1]["settings"]["opacity"] = 7

    async def wrong():
        desk.files.load_session(json.dumps(data))
        await desk.done()

    with pytest.raises(SessionError, match="opacity"):
        asyncio.run(wrong())
    for text in ("{", "[" * 100_000):
        with pytest.raises(ValueError, match="no session file"):
            desk.files.load_session(text)
    assert scene.state is state
    assert scene.store.loaded == kept
    assert desk.page.job == {}


def test_what_changes_while_a_session_is_read_is_one_step_before_it(desk, scene):
    text = json.dumps(saved(scene))

    async def test():
        desk.files.load_session(text)
        await asyncio.sleep(0)
        scene.open("ball.ply")
        scene.forget_unused()
        await desk.done()

    asyncio.run(test())
    assert [layer.name for layer in scene.layers] == ["head.nii.gz", "lines.trk"]
    desk.history.undo()
    assert [layer.name for layer in scene.layers] == ["ball.ply"]


def test_files_are_opened_beside_the_page(desk, scene, threads):
    async def test():
        await desk.files.open("lines.trk")

    asyncio.run(test())
    assert threads == [False]
    assert desk.page.chosen == scene.layers[0].id
    assert desk.refreshed == 1


def test_a_volume_that_colours_lines_is_read_beside_the_page(desk, scene, threads):
    scene.open("head.nii.gz")
    layer = scene.open("lines.fiblets")
    threads.clear()
    value = {"volume": {"path": "head.nii.gz"}}

    async def test():
        await desk.files.colour_by(layer.id, "scalars", value, Source("head.nii.gz"))

    asyncio.run(test())
    assert threads == [False]
    assert scene.layer(layer.id).settings["scalars"] == value
