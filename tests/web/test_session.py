"""Sessions: what was saved comes back, and nothing that is malformed does anything."""

import contextlib
import copy
import json
import random
import re

import numpy as np
import pytest
import pyvista as pv
from hypothesis import given
from hypothesis import strategies as st

import pvfiblets
from pvfiblets.engine.fiblets.parts import streamed_renderer
from pvfiblets.streamlines import Streamlines
from pvfiblets.web.scene.files.confined import Confined
from pvfiblets.web.scene.files.loading import Files
from pvfiblets.web.scene.scene import Scene
from pvfiblets.web.server.options import Options
from pvfiblets.web.session import files as session
from pvfiblets.web.session.history import History
from pvfiblets.web.session.runs import numbers_in, pack, runs_of, unpack
from pvfiblets.web.session.script import as_script


def fill(scene):
    """Put something of everything into a scene."""
    lines = scene.open("lines.trk")
    scene.set(lines.id, "scalars", "fa")
    scene.set(lines.id, "clim", [0.2, 0.9])
    scene.filters.set_filter(lines.id, "length", 20, None)
    scene.filters.set_subset(lines.id, 0.8, seed=3)
    ball = {"how": "passes", "region": {"kind": "mesh", "path": "ball.ply"}, "sampling": "points"}
    box = {"how": "ends_in", "region": {"kind": "box", "bounds": [-1, 5, -1, 50, -1, 50]}}
    scene.filters.set_regions(lines.id, {"op": "or", "of": [ball, {"op": "not", "of": [box]}, box]})
    scene.selection.select(lines.id, [20, 21, 22, 40])
    part = scene.keep_selection(lines.id)
    scene.set(part.id, "tube_radius", 0.7)
    grouped = scene.open("lines.fiblets")
    scene.filters.set_groups(grouped.id, ["far"])
    scene.show(grouped.id, False)
    mesh = scene.open("ball.ply")
    scene.set(mesh.id, "opacity", 0.5)
    scene.set(scene.open("vessel.vtp").id, "scalars", "radius")
    scene.set(scene.open("head.nii.gz").id, "values", [0.3])
    scene.filters.add_clip("plane", normal=[0, 0, 1], origin=[0, 0, 4], layers=[lines.id, mesh.id])
    scene.filters.add_clip("mesh", inside=False, path="ball.ply")
    scene.set_background("#102030")
    scene.cameras.view("oblique")
    scene.cameras.parallel = True


@pytest.fixture
def other(folder):
    """Return another scene of the same folder."""
    plotter = pv.Plotter(off_screen=True, window_size=(200, 160))
    plotter.disable_anti_aliasing()
    scene = Scene(plotter, folder)
    yield scene
    scene.close()
    plotter.close()


@pytest.mark.more
def test_a_session_brings_everything_back(scene, other, folder):
    fill(scene)
    picture = scene.cameras.screenshot()
    assert len(np.unique(picture.reshape(-1, 3), axis=0)) > 50
    session.save(scene, "view.json")
    text = (folder / "view.json").read_text()
    assert str(folder) not in text  # what lies in the root is named without it
    history = History(other)
    session.load(other, "view.json")
    assert other.state == scene.state
    assert other.cameras.camera() == scene.cameras.camera()
    np.testing.assert_array_equal(other.cameras.screenshot(), picture)
    assert len(history) == 1
    history.undo()
    assert other.layers == ()
    assert session.to_dict(scene) == json.loads(json.dumps(session.to_dict(scene), allow_nan=False))


def test_random_halves_of_many_streamlines_are_saved_small_and_come_back(scene, other, folder):
    """A list of numbers takes 1.3 MB for each half; 200,000 bits take 33 kB."""
    rng = np.random.default_rng(0)
    ends = rng.uniform(0, 50, (200_000, 2, 3)).astype(np.float32)
    pvfiblets.compress(Streamlines(ends.reshape(-1, 3), np.arange(0, 400_001, 2))).save(folder / "many.fiblets")
    layer = scene.open("many.fiblets")
    halves = [np.flatnonzero(rng.random(200_000) < 0.5) for _ in range(3)]
    scene.selection.select(layer.id, halves[0])
    part = scene.keep_selection(layer.id)
    scene.selection.select(part.id, np.arange(0, len(halves[0]), 2))
    scene.bundles.add_bundle(layer.id, halves[1], "half")
    scene.bundles.add_bundle(layer.id, halves[2][:40], "few")
    text = session.to_text(scene)
    assert len(text) < 150_000
    session.from_dict(other, session.from_text(text))
    assert other.state == scene.state
    assert len(other.layer(part.id).selected) == (len(halves[0]) + 1) // 2
    np.testing.assert_array_equal(other.layer(part.id).source.ids.array(), halves[0])
    np.testing.assert_array_equal(other.bundles.of_layer(layer.id)[-2].ids.array(), halves[1])
    script = as_script(scene)
    assert len(script) < 150_000
    names = {}
    text = script[script.index("def unpacked") : script.index("plotter = ")]
    exec(f"import base64\nimport numpy as np\n{text}", names)
    (call,) = re.findall(r"\.bundles\.add\(.half., (unpacked\([^)]*\))", script)
    np.testing.assert_array_equal(eval(call, names), halves[1])


def test_names_that_files_have_are_saved_and_come_back(scene, other, folder, lines):
    name = "x" * 240 + ".fiblets"
    groups = {"of\ntwo lines": np.arange(5), "long" * 50: np.arange(3, 9)}
    pvfiblets.compress(Streamlines(lines.points, lines.offsets, groups=groups)).save(folder / "a.fiblets")
    (folder / "a.fiblets").rename(folder / name)
    layer = scene.open(name)
    scene.bundles.set_bundle(layer.id, "long" * 50, visible=False)
    for _ in range(3):
        scene.selection.select(layer.id, [0, 1, 2, 3])
        layer = scene.keep_selection(layer.id)
    session.from_dict(other, session.from_text(session.to_text(scene)))
    assert other.state == scene.state


@given(st.sets(st.integers(0, 3000), max_size=400), st.integers(0, 2000))
def test_runs_are_packed_and_unpacked(numbers, more):
    numbers = np.array(sorted(numbers), np.int64)
    text = pack(runs_of(numbers))
    count = int(numbers.max(initial=-1)) + 1 + more
    np.testing.assert_array_equal(numbers_in(unpack(text, "ids", count)), numbers)
    ends = runs_of(numbers).ravel().tolist()  # as older files have it
    np.testing.assert_array_equal(numbers_in(unpack(ends, "ids", count)), numbers)
    if len(numbers):
        with pytest.raises(ValueError, match="ids"):
            unpack(text, "ids", int(numbers[-1]))


@pytest.mark.parametrize(
    "value",
    [
        "", "bits", "u2:AA==", "u1:AAA", "u3:AAAA", "u1:AQ==", "u1:!!!!", "u1:\u00e4", "bits:" + 3000 * "AAAA",
        "u1:" + 3000 * "AQEB", "u8:" + 8 * "/////", "u8:AQAAAAAAAAD///////////8=", "u1:AQAB", "u1:AQE=AQE=", None, {},
    ],
)  # fmt: skip
def test_damaged_runs_are_refused(value):
    with pytest.raises(ValueError, match="ids"):
        unpack(value, "ids", 1000)


def test_sessions_of_before_runs_were_packed_still_open(scene, other, folder):
    fill(scene)
    scene.bundles.add_bundle(scene.layers[0].id, [1, 2, 9], "three")
    data = session.to_dict(scene)
    lines, part = data["layers"][:2]
    lines["selected"], part["source"]["ids"] = [20, 23, 40, 41], [20, 23, 40, 41]
    data["bundles"][0]["bundles"][-1]["ids"] = [1, 3, 9, 10]
    session.from_dict(other, data)
    assert other.state == scene.state


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
    other.filters.set_filter(layer.id, "length", 20, 60)
    other.selection.select(layer.id, [1, 2, 3])
    other.keep_selection(layer.id)
    other.open("ball.ply")
    other.filters.add_clip("plane")
    return session.to_dict(other)


@pytest.mark.few(5)
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
        (["layers", 0, "selected"], "u2:AADoAw==", "999"),
        (["layers", 0, "selected"], "u1:AQEAAQ==", "rising"),
        (["layers", 1, "source", "ids"], "bits:AAAAAAAAAIA=", "63"),
        (["layers", 1, "source", "ids"], "bits:" + "/" * 4000, "run"),
        (["layers", 1, "source", "ids"], DELETED, "no ids"),
        (["layers", 1, "source", "ids"], [0, 5000], "4,999"),
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
    state, camera = scene.state, scene.cameras.camera()
    with pytest.raises(session.SessionError, match=says):
        session.from_dict(scene, edited(saved, path, value))
    assert scene.state is state
    assert scene.cameras.camera() == camera
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
    values = [None, True, -1, 1e308, "", "layer1", [], {}, [0, 1], "x" * 1000, 10**30, {"kind": "plane"},
              "bits:Bw==", "bits:" + "////" * 99, "u1:AQI=", "u2:AAEA", "u8:" + "/" * 44]  # fmt: skip
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


@pytest.fixture
def shards(folder, lines):
    """The sixty lines in shards, which alone would be gathered: they keep every bit of so few points."""
    coded = pvfiblets.compress(lines, per_point=["fa"], exact=False)
    coded.save(folder / "many.fiblets", shards=coded.nbytes // 4)
    return folder / "many.fiblets"


@pytest.fixture
def _apart(monkeypatch):
    monkeypatch.setattr(streamed_renderer, "free_host_memory", lambda: 100)
    monkeypatch.setattr(pvfiblets.ShardedSet, "gather", lambda *_: pytest.fail("all shards were put together"))


def test_shards_are_listed_as_a_file_and_stay_in_the_root(folder, shards, tmp_path):
    found = {entry.name: entry for entry in Confined(folder).listing("")}["many.fiblets"]
    assert not found.folder
    assert found.size == sum(file.stat().st_size for file in shards.iterdir())
    assert Confined(folder).existing("many.fiblets") == shards
    assert not any(path == "many.fiblets" for path, _ in Confined(folder).walk())
    assert Options(root=str(folder), files=[str(shards)], token=None, host="127.0.0.1").checked()
    with pytest.raises(FileNotFoundError):
        Options(root=str(folder), files=[str(folder)], token=None, host="127.0.0.1").checked()
    outside = tmp_path / "secret.fiblets"
    (shards / "000001.fiblets").rename(outside)
    (shards / "000001.fiblets").symlink_to(outside)
    with pytest.raises(PermissionError, match="names a file that is not in the folder"):
        Files(folder).resolve("many.fiblets")


@pytest.mark.more
@pytest.mark.usefixtures("_apart")
def test_a_session_of_shards_brings_everything_back(scene, shards, tmp_path):
    layer = scene.open("many.fiblets")
    scene.set(layer.id, "scalars", "fa")
    scene.filters.set_filter(layer.id, "length", 20, None)
    box = {"how": "ends_in", "region": {"kind": "box", "bounds": [-1, 5, -1, 50, -1, 50]}}
    scene.filters.set_regions(layer.id, box)
    scene.filters.set_groups(layer.id, ["far"])
    scene.filters.add_clip("plane", normal=[0, 0, 1], origin=[0, 0, 4], layers=[layer.id])
    scene.cameras.view("axial")
    picture = scene.cameras.screenshot()
    actor = scene.actor(layer.id)
    assert actor.explain()["parts"]["total"] > 3
    assert actor.explain()["share"] == 1.0
    assert scene.selection.select_box(0, 0, 200, 160) > 5
    told = scene.selection.table()
    assert len(told["rows"]) > 5
    scene.selection.export(layer.id, "some.tck")
    assert len(pvfiblets.read(shards.parent / "some.tck")) == scene.selection.count()
    scene.selection.deselect()
    session.save(scene, "a.json")
    plotter = pv.Plotter(off_screen=True, window_size=(200, 160))
    plotter.disable_anti_aliasing()
    other = Scene(plotter, shards.parent)
    session.load(other, "a.json")
    assert (other.cameras.screenshot() == picture).all()
    assert picture.max() > 50
    other.close()
    plotter.close()
