"""Sessions: what was saved comes back, and nothing that is malformed does anything."""

from __future__ import annotations

import contextlib
import copy
import json
import random

import numpy as np
import pytest
import pyvista as pv

from pvfiblets.web import session
from pvfiblets.web.history import History
from pvfiblets.web.scene import Scene


def fill(scene):
    """Put something of everything into a scene."""
    lines = scene.open("lines.trk")
    scene.set(lines.id, "scalars", "fa")
    scene.set(lines.id, "clim", [0.2, 0.9])
    scene.set_filter(lines.id, "length", 20, None)
    scene.set_subset(lines.id, 0.8, seed=3)
    ball = {"how": "passes", "region": {"kind": "mesh", "path": "ball.ply"}}
    box = {"how": "ends_in", "region": {"kind": "box", "bounds": [-1, 5, -1, 50, -1, 50]}}
    scene.set_regions(lines.id, {"op": "or", "of": [ball, {"op": "not", "of": [box]}, box]})
    scene.select(lines.id, [20, 21, 22, 40])
    part = scene.keep_selection(lines.id)
    scene.set(part.id, "tube_radius", 0.7)
    grouped = scene.open("lines.fiblets")
    scene.set_groups(grouped.id, ["far"])
    scene.show(grouped.id, False)
    mesh = scene.open("ball.ply")
    scene.set(mesh.id, "opacity", 0.5)
    scene.set(scene.open("vessel.vtp").id, "scalars", "radius")
    scene.set(scene.open("head.nii.gz").id, "values", [0.3])
    scene.add_clip("plane", normal=[0, 0, 1], origin=[0, 0, 4], layers=[lines.id, mesh.id])
    scene.add_clip("mesh", inside=False, path="ball.ply")
    scene.set_background("#102030")
    scene.view("oblique")
    scene.parallel = True


@pytest.fixture
def other(folder):
    """Return another scene of the same folder."""
    plotter = pv.Plotter(off_screen=True, window_size=(200, 160))
    plotter.disable_anti_aliasing()
    scene = Scene(plotter, folder)
    yield scene
    scene.close()
    plotter.close()


def test_a_session_brings_everything_back(scene, other, folder):
    fill(scene)
    picture = scene.screenshot()
    assert len(np.unique(picture.reshape(-1, 3), axis=0)) > 50
    session.save(scene, "view.json")
    text = (folder / "view.json").read_text()
    assert str(folder) not in text  # what lies in the root is named without it
    history = History(other)
    session.load(other, "view.json")
    assert other.state == scene.state
    assert other.camera() == scene.camera()
    np.testing.assert_array_equal(other.screenshot(), picture)
    assert len(history) == 1
    history.undo()
    assert other.layers == ()
    assert session.to_dict(scene) == json.loads(json.dumps(session.to_dict(scene), allow_nan=False))


def test_files_lie_beside_a_session(scene, folder):
    home = folder / "study"
    home.mkdir()
    (folder / "ball.ply").rename(home / "ball.ply")
    scene.open("study/ball.ply")
    session.save(scene, "study/view.json")
    assert json.loads((home / "view.json").read_text())["layers"][0]["source"]["path"] == "ball.ply"
    scene.remove(scene.layers[0].id)
    home.rename(folder / "moved")
    session.load(scene, "moved/view.json")
    assert scene.layers[0].path == "moved/ball.ply"


def edited(data, path, value):
    found = copy.deepcopy(data)
    place = found
    for key in path[:-1]:
        place = place[key]
    if value is DELETED:
        del place[path[-1]]
    else:
        place[path[-1]] = value
    return found


DELETED = object()


@pytest.fixture
def saved(other):
    """Return a small session."""
    layer = other.open("lines.fiblets")
    other.set_filter(layer.id, "length", 20, 60)
    other.select(layer.id, [1, 2, 3])
    other.keep_selection(layer.id)
    other.open("ball.ply")
    other.add_clip("plane")
    return session.to_dict(other)


@pytest.mark.parametrize(
    ("path", "value", "says"),
    [
        (["version"], 2, "version 1"),
        (["version"], True, "version"),
        (["program"], "other", "pvfiblets"),
        (["layers"], {}, "layers"),
        (["layers"], [{}] * 100, "64 at most"),
        (["surprise"], 1, "surprise"),
        (["background"], "#12", "colour"),
        (["camera", "position"], [0, 0], "3 numbers"),
        (["camera", "up"], [0, 0, 0], "unlike"),
        (["camera", "view_angle"], 500, "view_angle"),
        (["layers", 0, "kind"], "portal", "portal"),
        (["layers", 0, "id"], "../x", "ids are"),
        (["layers", 1, "id"], "layer1", "stands twice"),
        (["layers", 0, "name"], "", "name"),
        (["layers", 0, "visible"], "yes", "true or false"),
        (["layers", 0, "source"], {}, "either"),
        (["layers", 0, "source", "path"], "../outside.fiblets", "outside of the folder"),
        (["layers", 0, "source", "path"], "/etc/passwd", "outside of the folder"),
        (["layers", 0, "source", "path"], "nowhere.fiblets", "no such file"),
        (["layers", 0, "source", "path"], "ball.ply", "ball.ply"),
        (["layers", 0, "source"], {"demo": "tracts", "size": 10**9}, "size"),
        (["layers", 0, "settings", "opacity"], 2.0, "opacity"),
        (["layers", 0, "settings", "scalars"], "no such", "no such"),
        (["layers", 0, "settings", "__dict__"], 1, "__dict__"),
        (["layers", 0, "filters", "criteria", "length"], [3], "two numbers"),
        (["layers", 0, "filters", "criteria", "length"], [9, 1], "low end first"),
        (["layers", 0, "filters", "criteria", "none"], [0, 1], "none"),
        (["layers", 0, "filters", "groups"], ["nobody"], "nobody"),
        (["layers", 0, "filters", "subset"], {"every": 0}, "every"),
        (["layers", 0, "filters", "regions"], {"op": "and", "of": []}, "and"),
        (["layers", 0, "filters", "regions"],
         {"how": "passes", "region": {"kind": "mesh", "path": "../x.ply"}}, "outside"),
        (["layers", 0, "selected"], [0, 1000], "999"),
        (["layers", 0, "selected"], [3, 1], "rising"),
        (["layers", 0, "selected"], [0, 2**70], "run"),
        (["layers", 1, "source", "ids"], DELETED, "no ids"),
        (["layers", 1, "source", "ids"], [0, 5000], "4999"),
        (["layers", 2, "selected"], [0, 1], "tractograms alone"),
        (["clips", 0, "shape"], {"kind": "labels", "path": "atlas.nii.gz"}, "labels"),
        (["clips", 0, "shape"], {"kind": "mesh", "path": "open.ply"}, "surface is open"),
        (["clips", 0, "shape", "normal"], [0, 0, 0], "not 0"),
        (["clips", 0, "layers"], ["layer77"], "layer77"),
        (["clips", 0, "layers"], "layer1", "list of ids"),
    ],
)  # fmt: skip
def test_what_is_malformed_is_refused_whole(scene, saved, path, value, says):
    scene.open("vessel.vtp")
    state, camera = scene.state, scene.camera()
    with pytest.raises(session.SessionError, match=says):
        session.from_dict(scene, edited(saved, path, value))
    assert scene.state is state
    assert scene.camera() == camera
    assert len(list(scene.plotter.fiblets)) == 0


@pytest.mark.parametrize(
    "data", [None, [], "x", 3, {}, {"program": "pvfiblets"}, {"program": "pvfiblets", "version": 1}]
)
def test_what_is_no_session_is_refused(scene, data):
    with pytest.raises(session.SessionError, match="cannot be opened"):
        session.from_dict(scene, data)


@pytest.mark.parametrize("text", ["", "{", "[" * 100_000, "\x00", "null", '{"program": NaN}'])
def test_files_that_are_no_sessions_are_refused(scene, folder, text):
    (folder / "view.json").write_text(text)
    with pytest.raises(session.SessionError):
        session.load(scene, "view.json")
    (folder / "view.json").write_bytes(b"\xff\xfe")
    with pytest.raises(session.SessionError):
        session.load(scene, "view.json")


def places(data, path=()):
    """Yield the path of every value in a session."""
    if path:
        yield list(path)
    for key in data if isinstance(data, dict) else range(len(data)) if isinstance(data, list) else ():
        yield from places(data[key], (*path, key))


def test_whatever_is_changed_is_refused_or_shown(scene, saved):
    """Values of a session put in each other's places: no error but the one, and no half-opened session."""
    rng = random.Random(0)
    everywhere = list(places(saved))
    values = [None, True, -1, 1e308, "", "layer1", [], {}, [0, 1], "x" * 1000, 10**30, {"kind": "plane"}]
    opened = 0
    for _ in range(150):
        broken = saved
        for _ in range(rng.randint(1, 2)):
            with contextlib.suppress(KeyError, IndexError, TypeError):  # the place is gone
                broken = edited(broken, rng.choice(everywhere), rng.choice([*values, DELETED]))
        state = scene.state
        try:
            session.from_dict(scene, broken)
        except session.SessionError:
            assert scene.state is state
        else:
            opened += 1
            assert json.dumps(session.to_dict(scene), allow_nan=False)
    assert 0 < opened < 150
