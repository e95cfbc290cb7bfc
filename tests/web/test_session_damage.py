"""Session files with wounds: refused with the scene as it was, or shown; in bounded time."""

import importlib.util
import json
import os
import signal
import time
from pathlib import Path

import numpy as np
import pytest
import pyvista as pv

from pvfiblets.web.scene.scene import Scene
from pvfiblets.web.session import files as session

N = int(os.environ.get("PVFIBLETS_FUZZ", "20"))


@pytest.fixture
def damage():
    """Return the function that wounds files of all formats."""
    path = Path(__file__).resolve().parents[1] / "formats" / "fuzzing.py"
    spec = importlib.util.spec_from_file_location("fuzzing_of_formats", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.damage


def test_damaged_session_files_are_refused_or_shown(folder, damage):
    plotter = pv.Plotter(off_screen=True, window_size=(60, 60))
    scene = Scene(plotter, folder)

    def hung(*_):
        raise AssertionError("reading a session took more than 5 s")

    before = signal.signal(signal.SIGALRM, hung)
    refused = 0
    try:
        lines = scene.open("lines.fiblets")
        scene.filters.set_filter(lines.id, "length", 20, None)
        scene.selection.select(lines.id, [20, 21, 40])
        scene.bundles.add_bundle(lines.id, np.flatnonzero(np.random.default_rng(0).random(60) < 0.5), "half")
        scene.filters.add_clip("plane", normal=[0, 0, 1], origin=[0, 0, 4], layers=[lines.id])
        whole = session.save(scene, "a.json").read_bytes()
        session.load(scene, "a.json")
        for i in range(N):
            (folder / "b.json").write_bytes(damage(whole, np.random.default_rng(i)))
            state = scene.state
            signal.alarm(5)
            try:
                session.load(scene, "b.json")
            except session.SessionError:
                assert scene.state is state
                refused += 1
            else:
                assert json.dumps(session.to_dict(scene), allow_nan=False)
            finally:
                signal.alarm(0)
    finally:
        signal.signal(signal.SIGALRM, before)
        scene.close()
        plotter.close()
    assert refused > N // 10


def _nested(depth):
    condition = {"how": "passes", "region": {"kind": "sphere", "center": [0, 0, 0], "radius": 1.0}}
    for _ in range(depth):
        condition = {"op": "and", "of": [condition]}
    return condition


BOMBS = {
    "deep": lambda layer: {"layers": [{**layer, "filters": {"regions": _nested(400)}}]},
    "many layers": lambda layer: {"layers": [{**layer, "id": f"layer{k}"} for k in range(5000)]},
    "many cuts": lambda layer: {"layers": [layer], "clips": 100_000 * [{}]},
    "many runs": lambda layer: {"layers": [{**layer, "selected": list(range(2, 8_000_000, 7))}]},
    "many packed runs": lambda layer: {"layers": [{**layer, "selected": "u1:" + "AQEB" * 4_000_000}]},
    "many bits": lambda layer: {"layers": [{**layer, "selected": "bits:" + "////" * 4_000_000}]},
    "far packed runs": lambda layer: {"layers": [{**layer, "selected": "u8:AAAAAAAAAAD///////8f"}]},
    "a huge selection": lambda layer: {
        "layers": [{**layer, "kind": "selection", "source": {**layer["source"], "ids": "u8:AAAAAAAAAAD///////8f"}}]
    },
    "huge painted regions": lambda layer: {
        "layers": [layer],
        "painting": {
            "shape": [640, 640, 640],
            "affine": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1],
            "regions": [{"name": f"{k}", "color": "red", "runs": "u4:AAAAAAAAoA8="} for k in range(32)],
        },
    },
    "far runs": lambda layer: {"layers": [{**layer, "selected": [0, 2**61]}]},
    "huge numbers": lambda layer: {"layers": [{**layer, "settings": {"opacity": 10**400}}]},
    "long names": lambda layer: {"layers": [{**layer, "name": "x" * 10_000_000}]},
    "a huge demo": lambda layer: {"layers": [{**layer, "source": {"demo": "tracts", "size": 10**9}}]},
    "many measurements": lambda layer: {"layers": [layer], "measurements": 200_000 * [[[0, 0, 0], [1, 1, 1]]]},
    "devices": lambda layer: {"layers": [{**layer, "source": {"path": "/dev/zero"}}]},
    "up": lambda layer: {"layers": [{**layer, "source": {"path": "../../etc/passwd"}}]},
    "itself": lambda layer: {"layers": [{**layer, "source": {"path": "bomb.json"}}]},
}


@pytest.mark.few(3)
@pytest.mark.parametrize("name", BOMBS)
def test_session_files_that_are_bombs_are_refused_soon(scene, folder, name):
    scene.open("lines.fiblets")
    (layer,) = session.to_dict(scene)["layers"]
    saved = {**session.to_dict(scene), **BOMBS[name](layer)}
    (folder / "bomb.json").write_text(json.dumps(saved), encoding="utf-8")
    state = scene.state
    started = time.monotonic()
    with pytest.raises(session.SessionError) as refused:
        session.load(scene, "bomb.json")
    assert time.monotonic() - started < 20
    assert len(str(refused.value)) < 1000
    assert scene.state is state


@pytest.mark.parametrize("text", ["[" * 200_000, '{"a":' * 200_000, "1" * 1_000_000, "\x00", '{"layers": NaN}'])
def test_texts_that_are_bombs_are_refused_soon(scene, folder, text):
    (folder / "bomb.json").write_text(text, encoding="utf-8")
    with pytest.raises(session.SessionError):
        session.load(scene, "bomb.json")
