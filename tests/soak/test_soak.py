"""Frames of whatever a plotter offers, at random: no error of OpenGL, and nothing is left behind."""

import ctypes
import os

import numpy as np
import pytest
import pyvista as pv

from pvfiblets import compress
from pvfiblets.mappers.frames import windows
from pvfiblets.streamlines import Streamlines

from . import acts, walk

FRAMES = int(os.environ.get("PVFIBLETS_SOAK", "60"))
PER_ROUND = max(FRAMES // 5, 10)

MOST_OBJECTS = 30
"""That VTK keeps of passes that were switched off: framebuffers, their textures, queries. A round makes hundreds."""

MOST_GROWTH = 40.0
"""MB of resident memory from the second round on. A window alone, of 100 pixels, takes 30."""


@pytest.fixture(scope="module", autouse=True)
def aliased():
    """Smooth edges are an act of their own: as the default they would take most of the time."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PVFIBLETS_ANTIALIAS", "off")
        yield


@pytest.fixture(scope="module")
def walked():
    """Walk once; an error ends it, and says what was done."""
    return walk.walk(FRAMES, PER_ROUND, seed=3, size=100)


@pytest.mark.more
def test_most_kinds_of_acts_were_done(walked):
    soak, rounds = walked
    assert soak.frames == FRAMES
    assert len(soak.acts) >= 0.8 * len(acts.WEIGHTS)
    assert sum(soak.refused.values()) <= 0.05 * sum(soak.acts.values()), soak.refused


@pytest.mark.more
def test_all_objects_of_opengl_are_given_back(walked):
    kinds = [kind for kind in walk.KINDS if kind != "Program"]  # VTK keeps programs as long as the window is
    for row in walked[1]:
        more = sum(row["after"][kind] - row["before"][kind] for kind in kinds)
        assert more <= MOST_OBJECTS, row
        assert row["ours"] == 0, row
        assert row["after"]["bytes"] <= row["before"]["bytes"] + 200 * row["size"] ** 2, row


@pytest.mark.more
def test_nothing_is_kept_of_actors(walked):
    for row in walked[1]:
        assert row["contexts"] == 0
        assert row["actors"] == 0


@pytest.mark.more
def test_resident_memory_stays_after_the_first_rounds(walked):
    memory = [row["resident_mb"] for row in walked[1]]
    assert memory[-1] - memory[1] < MOST_GROWTH, memory


@pytest.mark.more
@pytest.mark.exhaustive
def test_the_same_seed_does_the_same():
    log = []
    for _ in range(2):
        soak = walk.Soak(5, 64)
        soak.round(4)
        log.append(soak.log)
    assert log[0] == log[1]
    assert len(log[0]) > 4


@pytest.mark.more
def test_a_failing_act_is_reported_with_those_before_it(monkeypatch):
    soak = walk.Soak(5, 64)
    soak.open()

    def broken(*_):
        raise RuntimeError("no such thing")

    soak.log.append("1: something before")
    monkeypatch.setattr(soak, "_kinds", [broken] * len(soak._kinds))
    with pytest.raises(walk.SoakError, match=r"(?s)frame 1 of seed 5: RuntimeError: no such thing.*something be"):
        soak.frame()
    soak.windows.pop().close()


@pytest.mark.more
def test_what_leaks_is_found():
    """A texture that nobody gives back, and an actor that somebody keeps."""
    soak = walk.Soak(5, 64)
    soak._kinds, soak._shares = [acts.turn], np.ones(1)
    kept = []

    def leak(self, rng):
        window = self.window(rng)
        kept.append(window.plotter.add_fiblets(self.data.fiblets[0]))
        window.plotter.render_window.MakeCurrent()
        make = ctypes.CFUNCTYPE(None, ctypes.c_uint, ctypes.c_int, ctypes.POINTER(ctypes.c_uint))
        name = ctypes.c_uint()
        make(walk.loader()("glCreateTextures"))(0x0DE1, 1, ctypes.byref(name))
        return "leak"

    clean = soak.round(2)
    soak._kinds = [leak]
    leaking = soak.round(5)
    assert clean["after"]["Texture"] - clean["before"]["Texture"] <= 3
    assert leaking["after"]["Texture"] - leaking["before"]["Texture"] >= 5
    assert clean["actors"] == 0
    assert leaking["actors"] >= 5
    kept.clear()


@pytest.mark.more
def test_an_error_that_vtk_left_behind_is_not_taken_for_ours():
    """Depth peeling in a multi-sampled window leaves one; making the first buffer was then said to lack memory."""
    others = sum(walk.unreleased().values())
    points = np.linspace(-5.0, 5.0, 60)[:, None] * (1.0, 0.2, 0.0)
    lines = Streamlines(points, [0, 30, 60])
    plotter = pv.Plotter(off_screen=True, window_size=(64, 64))
    try:
        plotter.add_fiblets(compress(lines), color="blue")
        plotter.show(auto_close=False)

        def err(_renderer, _event):
            ctypes.CFUNCTYPE(None, ctypes.c_uint)(walk.loader()("glEnable"))(0xFFFF)

        plotter.renderer.AddObserver("StartEvent", err)
        plotter.add_fiblets(compress(lines), color="red", line_width=3, lighting=False)
        plotter.view_xy()
        plotter.render()
        picture = plotter.screenshot(return_img=True).astype(int)
        assert (picture[..., 0] - picture[..., 1] > 80).sum() > 30
        assert sum(walk.unreleased().values()) > others + 5
    finally:
        plotter.close()
    assert not windows._contexts
    assert sum(walk.unreleased().values()) == others
