"""Session files with wounds: refused with the scene as it was, or shown; in bounded time."""

from __future__ import annotations

import importlib.util
import json
import os
import signal
from pathlib import Path

import numpy as np
import pytest
import pyvista as pv

from pvfiblets.web import session
from pvfiblets.web.scene import Scene

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
        scene.set_filter(lines.id, "length", 20, None)
        scene.select(lines.id, [20, 21, 40])
        scene.add_clip("plane", normal=[0, 0, 1], origin=[0, 0, 4], layers=[lines.id])
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
