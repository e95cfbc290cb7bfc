"""What takes long runs beside the page: sessions, files and volumes, with progress, and can be stopped."""

import asyncio
import json
import threading
from dataclasses import replace

import numpy as np
import pytest
import pyvista as pv

from pvfiblets.cli.command import main
from pvfiblets.web.server.access import LARGEST_SESSION
from pvfiblets.web.server.options import Options
from pvfiblets.web.server.scratch import Notes
from pvfiblets.web.session import files as session
from pvfiblets.web.session.document import Source
from pvfiblets.web.session.files import SessionError
from tests.web.desk import Desk, assert_script_draws
from tests.web.visitors import until


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


@pytest.mark.parametrize("kind", ["tractogram", "tubes", "mesh"])
@pytest.mark.parametrize(("suffix", "names"), [(".vtk", False), (".vtp", False), (".vtp", True)])
async def test_the_dialog_says_the_space_of_files_that_name_none(desk, scene, folder, kind, suffix, names):
    """A line or a ball at x = 5, y = 7 of the file, which DIPY 1.11 meant as 5 mm to the left and 7 mm to the back."""
    data = (
        pv.Sphere(radius=2.0, center=(5, 7, 9)) if kind == "mesh" else pv.Spline([[4, 7, 9], [5, 7, 9], [6, 7, 9.0]], 9)
    )
    data.clear_data()
    if kind == "tubes":
        data["radius"] = np.full(data.n_points, 0.5)
    if names:
        data.field_data["SPACE"] = ["RAS"]
    data.save(folder / f"one{suffix}")
    files = desk.files
    files.browse("")
    assert next(entry for entry in desk.page.entries if entry["name"] == f"one{suffix}")["spaced"]
    assert desk.page.open_space == "RAS"
    desk.page.open_space = "LPS"
    files.take(f"one{suffix}", False)
    await desk.done()
    (layer,) = scene.layers
    assert (layer.kind, layer.source.space) == (kind, "LPS")
    sign = 1.0 if names else -1.0  # a name counts for more than the choice
    bounds = np.array(scene.actor(layer.id).bounds).reshape(3, 2).mean(axis=1)
    np.testing.assert_allclose(bounds, [5 * sign, 7 * sign, 9], atol=0.2)
    kept = session.to_dict(scene)
    assert kept["layers"][0]["source"]["space"] == "LPS"
    picture = scene.cameras.screenshot()
    assert_script_draws(scene, folder, picture)
    scene.remove(layer.id)
    session.from_dict(scene, kept)
    assert scene.layers[0].source.space == "LPS"
    np.testing.assert_array_equal(scene.cameras.screenshot(), picture)
    files.browse("")  # opened anew, the dialog is at its default
    assert desk.page.open_space == "RAS"
    kept["layers"][0]["source"]["space"] = "LAS"
    with pytest.raises(SessionError, match="space of a source is 'LAS'; choose RAS or LPS"):
        session.from_dict(scene, kept)


@pytest.mark.parametrize("suffix", [".vtk", ".vtp", ".ply"])
async def test_the_dialog_says_the_space_of_cuts_and_regions(desk, scene, folder, suffix):
    """A ball about the lines' middle by LPS: its file has x and y negated. PLY is no file of VTK: it is left alone."""
    pv.Sphere(radius=8.0, center=(-20, -18, 10)).save(folder / f"lps{suffix}")
    layer = scene.open("lines.fiblets")
    desk.choose(layer)
    for purpose in ("clip", "region"):
        desk.files.browse("", purpose)
        desk.page.open_space = "LPS"
        desk.files.take(f"lps{suffix}", False)
        await desk.done()
    space = {} if suffix == ".ply" else {"space": "LPS"}
    shape = {"kind": "mesh", "path": f"lps{suffix}", **space}
    assert scene.state.clips[0].shape == shape
    assert scene.layer(layer.id).filters.regions["of"][0]["region"] == {**shape, "name": "A"}
    shown = scene.actor(layer.id).shown
    scene.filters.set_regions(layer.id, {"how": "passes", "region": {"kind": "mesh", "path": "ball.ply"}})
    np.testing.assert_array_equal(shown, scene.actor(layer.id).shown if space else np.zeros(60, bool))
    assert shown.any() == bool(space)
    desk.history.undo()
    kept, picture = session.to_dict(scene), scene.cameras.screenshot()
    assert_script_draws(scene, folder, picture)
    scene.remove(layer.id)
    session.from_dict(scene, kept)
    np.testing.assert_array_equal(scene.cameras.screenshot(), picture)
    kept["clips"][0]["shape"]["space"] = "LAS"
    with pytest.raises(SessionError, match="space of cut is 'LAS'; choose RAS or LPS"):
        session.from_dict(scene, kept)


async def test_the_server_says_the_space_of_the_files_that_it_is_given(desk, scene, folder, monkeypatch):
    pv.Sphere(radius=2.0, center=(5, 7, 9)).save(folder / "ball.vtk")
    started = []
    monkeypatch.setattr("pvfiblets.cli.serve._run", lambda options, _: started.append(options) or 0)
    given = ["--mesh", str(folder / "ball.vtk"), "--mesh", str(folder / "ball.ply"), "--root", str(folder)]
    assert main(["serve", *given, "--space", "lps", "--port", "0"]) == 0
    desk.options = Options.from_dict(started[0].as_dict())
    desk.files.open_given()
    await desk.done()
    assert [layer.source.space for layer in scene.layers] == ["LPS", None]
    assert np.allclose(scene.actor(scene.layers[0].id).center, [-5, -7, 9], atol=0.1)


async def test_a_session_is_read_beside_the_page_and_the_page_goes_on(desk, scene, threads):
    text = json.dumps(saved(scene))
    threads.clear()
    jobs, ticks = [], []
    files = desk.files
    files.load_session(text)
    while not scene.layers:
        await asyncio.sleep(0.001)
        ticks.append(1)
        if desk.page.job:
            jobs.append(desk.page.job)
    await desk.done()
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
    for text in ("{", b"[" * 100_000, b"\xff"):
        with pytest.raises(SessionError, match="no session file"):
            desk.run(lambda text=text: desk.files.load_session(text))
    assert scene.state is state
    assert scene.store.loaded == kept
    assert desk.page.job == {}


def test_what_a_process_keeps_is_restored_by_the_next_after_its_first_files(desk, scene, tmp_path, monkeypatch):
    monkeypatch.setattr("pvfiblets.web.panels.files.session_actions.QUIET", 0.0)
    desk.notes = Notes(tmp_path)
    layer = scene.open("lines.trk")
    scene.selection.select(layer.id, [4, 5, 9])

    async def dies():
        desk.files.keep_soon()
        await until((tmp_path / "session.json").exists)

    async def next_one():
        desk.options = replace(desk.options, files=["ball.ply"])
        desk.files.open_given()
        desk.files.restore()
        scene.watch(lambda _: desk.files.keep_soon())
        await desk.done()

    asyncio.run(dies())
    state = scene.state
    (tmp_path / "session.json").rename(tmp_path / "restore.json")
    scene.remove(layer.id)
    asyncio.run(next_one())
    assert scene.state == state
    assert (tmp_path / "session.json").read_text() == session.to_text(scene)
    assert desk.history.undo_label == "open a session"


async def test_what_changes_while_a_session_is_read_is_one_step_before_it(desk, scene):
    text = json.dumps(saved(scene))
    desk.files.load_session(text)
    await asyncio.sleep(0)
    scene.open("ball.ply")
    scene.forget_unused()
    await desk.done()
    assert [layer.name for layer in scene.layers] == ["head.nii.gz", "lines.trk"]
    desk.history.undo()
    assert [layer.name for layer in scene.layers] == ["ball.ply"]


async def test_files_and_volumes_that_colour_lines_are_read_beside_the_page(desk, scene, threads):
    await desk.files.open("lines.trk")
    assert threads == [False]
    assert desk.page.chosen == scene.layers[0].id
    assert desk.refreshed == 1
    scene.open("head.nii.gz")
    layer = scene.open("lines.fiblets")
    threads.clear()
    value = {"volume": {"path": "head.nii.gz"}}
    await desk.files.with_volume(Source("head.nii.gz"), lambda: scene.set(layer.id, "scalars", value))
    assert threads == [False]
    assert scene.layer(layer.id).settings["scalars"] == value


async def test_sessions_in_the_served_folder_are_files_like_others(desk, scene, folder):
    home = folder / "study"
    home.mkdir()
    (folder / "ball.ply").rename(home / "ball.ply")
    scene.open("study/ball.ply")
    scene.open("lines.fiblets")
    desk.files.store_session("study/mine")
    with pytest.raises(ValueError, match="exists already"):
        desk.files.store_session("study/mine.json")
    for outside in ("../mine", "/tmp/mine", "nowhere/mine"):
        with pytest.raises(ValueError, match="folder"):
            desk.files.store_session(outside)
    for layer in scene.layers:
        scene.remove(layer.id)
    desk.files.browse("study")
    assert [entry["name"] for entry in desk.page.entries] == ["ball.ply", "mine.json"]
    desk.files.take("study/mine.json", False)
    await desk.done()
    assert desk.said[0] == ("success", "The session is saved in the served folder as study/mine.json.")
    assert [layer.path for layer in scene.layers] == ["study/ball.ply", "lines.fiblets"]
    with (folder / "long.json").open("wb") as file:
        file.truncate(LARGEST_SESSION + 1)
    with pytest.raises(SessionError, match="at most"):
        desk.files.take("long.json", False)


def test_what_a_file_is_chosen_for_says_which_are_shown(desk):
    def names(purpose):
        desk.page.dialog = ""
        desk.files.browse("", purpose)
        return {entry["name"] for entry in desk.page.entries}

    assert names("clip") == {"ball.ply", "open.ply", "vessel.vtp"}
    assert names("region") == names("clip") | {"head.nii.gz", "atlas.nii.gz"}
    assert {"lines.trk", "lines.fiblets", "head.nii.gz", "ball.ply"} <= names("")
    assert names("something else") == names("")


def test_meshes_and_labels_are_regions_and_cuts_read_beside_the_page(desk, scene, threads):
    layer = scene.open("lines.fiblets")
    desk.page.chosen, desk.page.chosen_kind = layer.id, layer.kind
    threads.clear()

    async def choose(purpose, name):
        desk.files.browse("", purpose)
        desk.files.take(name, False)
        await desk.done()

    asyncio.run(choose("region", "ball.ply"))
    asyncio.run(choose("region", "atlas.nii.gz"))
    asyncio.run(choose("clip", "ball.ply"))
    assert threads == [False, False]  # the mesh is there already
    ball, labels = scene.layer(layer.id).filters.regions["of"]
    assert ball["region"] == {"kind": "mesh", "path": "ball.ply", "name": "A"}
    assert labels["region"] == {"kind": "labels", "path": "atlas.nii.gz", "labels": None, "name": "B"}
    assert scene.state.clips[0].shape == {"kind": "mesh", "path": "ball.ply"}
    desk.regions.drop(0)
    everywhere = int(scene.actor(layer.id).shown.sum())
    desk.regions.set_labels(0, "5; 7")
    assert scene.layer(layer.id).filters.regions["of"][0]["region"]["labels"] == [5, 7]
    assert 0 < scene.actor(layer.id).shown.sum() < everywhere
    desk.regions.set_labels(0, " ")
    assert scene.actor(layer.id).shown.sum() == everywhere
    with pytest.raises(ValueError, match="not a number"):
        desk.regions.set_labels(0, "five")
    for bad, says in (("head.nii.gz", "fractions"), ("open.ply", "open")):
        with pytest.raises(ValueError, match=says):
            asyncio.run(choose("region", bad))
    assert len(scene.layer(layer.id).filters.regions["of"]) == 1


def test_a_cut_goes_through_the_layers_that_are_chosen(desk, scene):
    lines, ball = scene.open("lines.fiblets"), scene.open("ball.ply")
    clip = scene.filters.add_clip("plane")
    desk.cuts.refresh()
    (shown,) = desk.page.clips
    assert shown["layers"] == ["*"]
    assert [item["title"] for item in shown["items"]] == ["all tractograms", "lines.fiblets", "ball.ply"]

    def cut():
        return scene.state.clip(clip.id).layers

    desk.cuts.set_layers(clip.id, ["*", ball.id])  # one more than all tractograms
    assert cut() == (lines.id, ball.id)
    desk.cuts.set_layers(clip.id, [ball.id])
    assert cut() == (ball.id,)
    desk.cuts.set_layers(clip.id, [])
    assert cut() == ()
    desk.cuts.set_layers(clip.id, ["*"])
    assert cut() is None
    for wrong in ("layer1", None, 3):
        with pytest.raises(ValueError, match="list of layers"):
            desk.cuts.set_layers(clip.id, wrong)


async def test_the_demo_is_made_beside_the_page(desk, scene, threads, monkeypatch):
    monkeypatch.setattr(type(scene).load_demo, "__defaults__", (20, 8))
    desk.files.open_demo()
    await desk.done()
    assert threads == [False, False]
    assert [(layer.kind, layer.visible) for layer in scene.layers] == [("tractogram", True), ("volume", False)]


async def test_the_tractogram_stays_chosen_when_a_volume_or_a_mesh_is_opened(desk, scene):
    names = []
    for name in ("ball.ply", "lines.trk", "head.nii.gz", "ball.ply", "lines.fiblets"):
        await desk.files.open(name)
        names.append(scene.layer(desk.page.chosen).name)
    assert names == ["ball.ply", "lines.trk", "lines.trk", "lines.trk", "lines.fiblets"]


async def test_undo_starts_empty(desk, scene, folder):
    desk.options = replace(desk.options, files=(str(folder / "lines.trk"),), mesh=(str(folder / "ball.ply"),))
    desk.stream.warm = lambda: None
    desk.files.open_given()
    await desk.done()
    assert [layer.name for layer in scene.layers] == ["lines.trk", "ball.ply"]
    assert (len(desk.history), desk.history.undo_label) == (0, None)
    scene.rename(scene.layers[0].id, "tract")
    desk.history.undo()
    assert [layer.name for layer in scene.layers] == ["lines.trk", "ball.ply"]


async def test_what_was_done_while_given_files_were_opened_can_be_undone(desk, scene, folder):
    desk.options = replace(desk.options, files=(str(folder / "lines.trk"),))
    desk.files.open_given()
    await asyncio.sleep(0)
    scene.open("ball.ply")
    await desk.done()
    assert [layer.name for layer in scene.layers] == ["ball.ply", "lines.trk"]
    desk.history.undo()
    desk.history.undo()
    assert scene.layers == ()
