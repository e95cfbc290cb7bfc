"""Culling that is chosen by what pictures take: the choice, its price, and that no pixel changes by it."""

import contextlib

import pytest

from pvfiblets import compress
from pvfiblets.engine import FibletRenderer, FibletStyle, View
from pvfiblets.engine.culling.choice import LONGEST, CullingChoice
from pvfiblets.engine.gl.moderngl_extras import GLExtras
from pvfiblets.engine.gl.picture_clock import TimestampClock
from pvfiblets.synthetic import brain_streamlines
from tests.drivers import MESH

from .pictures import assert_same, read


class Pretended:
    """A clock that knows beforehand, and tells some pictures late."""

    def __init__(self, culled, plain, late=3):
        self.seconds, self.late = {True: culled, False: plain}, late
        self.told, self.drawn = [], 0

    @contextlib.contextmanager
    def timed(self, what):
        yield
        self.told.append((self.drawn + self.late, what, self.seconds[what[1]]))

    def finished(self):
        self.drawn += 1
        found = [(what, seconds) for due, what, seconds in self.told if due <= self.drawn]
        self.told = [row for row in self.told if row[0] > self.drawn]
        return found

    def release(self):
        pass


def flown(choice, clock, pictures, key="same"):
    """Which pictures were culled, and seconds of all."""
    culled = []
    for _ in range(pictures):
        culled.append(choice.next(key))
        with choice.drawing():
            pass
    return culled, sum(clock.seconds[one] for one in culled)


@pytest.mark.parametrize("first", [True, False])
@pytest.mark.parametrize(("culled", "plain"), [(1.0, 2.0), (2.0, 1.0), (1.0, 8.0)])
def test_the_faster_one_is_kept(culled, plain, first):
    clock = Pretended(culled, plain)
    choice = CullingChoice(clock, first)
    flown(choice, clock, 40)
    assert choice.culling == (culled < plain)
    _, seconds = flown(choice, clock, 2000)
    assert seconds <= 2000 * min(culled, plain) * (1.0 + 0.02 * abs(culled - plain) / min(culled, plain))


def test_what_is_equal_stays(monkeypatch):
    for first in (True, False):
        clock = Pretended(1.0, 1.02)
        choice = CullingChoice(clock, first)
        flown(choice, clock, 3 * LONGEST)
        assert choice.culling == first


def test_a_change_of_the_visible_scene_is_noticed():
    clock = Pretended(2.0, 1.0)
    choice = CullingChoice(clock, True)
    flown(choice, clock, 1000)
    assert not choice.culling
    clock.seconds = {True: 1.0, False: 4.0}
    flown(choice, clock, 30, key="another")
    assert choice.culling
    clock.seconds = {True: 4.0, False: 1.0}  # as when one flies inside: nobody tells
    flown(choice, clock, LONGEST + 20, key="another")
    assert not choice.culling


def test_times_of_a_trial_that_was_given_up_do_not_count():
    clock = Pretended(2.0, 1.0, late=6)
    choice = CullingChoice(clock, True)
    for number in range(60):  # a new key in the middle of each trial
        flown(choice, clock, 5, key=number)
    assert choice.culling
    flown(choice, clock, 60, key="rest")
    assert not choice.culling


@pytest.mark.few(1)
@pytest.mark.parametrize("pipeline", ["compute", "geometry", *MESH])
def test_no_pixel_changes_by_the_choice(gl, camera, pipeline, monkeypatch):
    monkeypatch.setattr("pvfiblets.engine.fiblets.renderer.FEW_FIBLETS", 1)
    fiblets = compress(brain_streamlines(150, step=0.5, seed=4))
    auto, plain = (FibletRenderer(gl, fiblets, pipeline=pipeline, culling=name) for name in ("auto", None))
    used = set()
    try:
        for turn in range(14):
            view = View((160, 120), camera((160, 120), eye=(3.0 * turn, -260.0, 60.0)))
            pictures = [read(one.render(view, FibletStyle())) for one in (auto, plain)]
            assert_same(*pictures)
            used.add(any(row["name"] == "pyramid" for row in auto.explain(counts=False)["passes"]))
    finally:
        auto.release()
        plain.release()
    assert used == {True, False}


def test_timestamps_come_back_later_and_in_order(gl):
    clock = TimestampClock(GLExtras(gl))
    target = gl.framebuffer([gl.texture((64, 64), 4)])
    for number in range(5):
        with clock.timed((number, True)):
            target.clear()
    gl.finish()
    found = clock.finished()
    assert [what for what, _ in found] == [(number, True) for number in range(5)]
    assert all(0.0 <= seconds < 1.0 for _, seconds in found)
    assert clock.finished() == []
    with clock.timed((9, False)):
        pass
    clock.release()
    clock.release()
    target.release()
