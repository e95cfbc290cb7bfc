"""Pictures drawn piece by piece: the pixels of those drawn at once, whatever others draw in between."""

import numpy as np
import pytest

from pvfiblets.engine import FibletRenderer, FibletStyle, View
from pvfiblets.engine import pieces as pieces_module
from pvfiblets.engine.gl.passes import Passes
from pvfiblets.engine.pieces import Pieces, finish
from pvfiblets.report.studies.stability.render_checks import camera
from pvfiblets.synthetic import brain_streamlines

from .pictures import SIZE, assert_same, read


@pytest.fixture(autouse=True)
def tiny(monkeypatch):
    """Pieces that end after every dispatch of a group."""
    monkeypatch.setattr(pieces_module, "PIECE", 0.0)
    monkeypatch.setattr(Pieces.__init__, "__defaults__", (0.0,))
    monkeypatch.setattr(pieces_module, "FIRST", 1)


@pytest.fixture(scope="module")
def fiblets():
    from pvfiblets import compress

    return compress(brain_streamlines(200, 0.5, seed=4))


def look(turn, size=SIZE):
    """Return the view of the brain from a side."""
    side = np.array([np.cos(np.radians(turn)), np.sin(np.radians(turn)), 0.3]) / np.hypot(1.0, 0.3)
    eye = np.array([0, -18, 8]) + 300 * side
    return View(size, camera(size, eye=eye, target=(0, -18, 8), near=100.0, far=500.0, angle=35.0))


def drawn_in_pieces(renderer, view, style, between=lambda: None):
    """Draw, do something after each piece, and return the picture and how many pieces there were."""
    count = 0
    for _ in renderer.render_in_pieces(view, style):
        count += 1
        between()
    generation = renderer._generation
    buffer = renderer.render(view, style)
    assert renderer._generation == generation, "render() has drawn what was drawn already"
    return read(buffer), count


@pytest.fixture
def another(gl, fiblets):
    """Return a call that has another renderer draw another picture each time."""
    renderer, turned = FibletRenderer(gl, fiblets[::20]), iter(range(100_000))
    yield lambda: renderer.render(look(next(turned), (64, 48)), FibletStyle(2.0))
    renderer.release()


@pytest.mark.few(1)
@pytest.mark.parametrize(
    ("culling", "style"),
    [
        (None, FibletStyle(values="arc_length")),
        ("two-phase", FibletStyle(edges=True)),
        ("two-phase", FibletStyle(3.0, tolerance=0.7)),
    ],
    ids=["plain", "edges", "wide"],
)
def test_pictures_in_pieces_are_those_drawn_at_once(gl, fiblets, another, culling, style):
    renderer, at_once = (FibletRenderer(gl, fiblets, culling=culling) for _ in range(2))
    for turn in (0.0, 2.0, 90.0):
        found, count = drawn_in_pieces(renderer, look(turn), style, another)
        assert count >= 5
        assert_same(found, read(at_once.render(look(turn), style)))
    renderer.release()
    at_once.release()


def test_a_picture_that_is_given_up_leaves_nothing_behind(gl, fiblets):
    renderer, at_once = (FibletRenderer(gl, fiblets) for _ in range(2))
    for turn, stop in ((0.0, 1), (5.0, 3), (20.0, 5)):
        steps = renderer.render_in_pieces(look(turn), FibletStyle())
        for _ in range(stop):
            next(steps)
        steps.close()
        for then in (turn + 1.0, turn):
            found, expected = (read(one.render(look(then), FibletStyle())) for one in (renderer, at_once))
            assert_same(found, expected)
    renderer.release()
    at_once.release()


def test_a_picture_that_another_one_overtakes_is_given_up(gl, fiblets):
    renderer = FibletRenderer(gl, fiblets)
    small = look(30.0, (100, 80))
    steps = renderer.render_in_pieces(look(0.0), FibletStyle())
    next(steps)
    found = read(renderer.render(small, FibletStyle()))
    assert next(steps, "over") == "over"
    assert_same(read(renderer.render(small, FibletStyle())), found)
    steps = renderer.render_in_pieces(look(0.0), FibletStyle())
    next(steps)
    renderer.release()
    assert next(steps, "over") == "over"


def test_what_cannot_be_drawn_in_pieces_is_left_to_render(gl, fiblets):
    for options, style in (({"pipeline": "geometry"}, FibletStyle()), ({}, FibletStyle(radius=0.4)),
                           ({"culling": "coverage"}, FibletStyle())):  # fmt: skip
        renderer = FibletRenderer(gl, fiblets, **options)
        assert list(renderer.render_in_pieces(look(0.0), style)) == []
        assert renderer._buffer is None
        renderer.release()


def test_pieces_are_as_long_as_is_wanted(gl, monkeypatch):
    """A stage whose groups take a millisecond each, and those of the second half three."""
    now = [0.0]
    passes, again = Passes(gl), []
    monkeypatch.setattr(passes, "clock", lambda: now[0])
    monkeypatch.setattr(pieces_module.time, "perf_counter", lambda: now[0])
    pieces = Pieces(passes, lambda: again.append(1), {}, 0.05)

    def steps(groups):
        done = 0
        while done < groups:
            count = pieces.groups("a", groups - done)
            with pieces.measured("a", count):
                now[0] += count * (0.001 if done < groups // 2 else 0.003)
            done += count
            if pieces.due:
                yield from pieces.pause()
        return done

    lengths, began = [], 0.0
    for _ in steps(600):
        lengths.append(now[0] - began)
        began = now[0]
    assert max(lengths) < 0.16
    assert np.median(lengths) == pytest.approx(0.05, abs=0.011)
    assert len(again) == len(lengths)
    assert finish(steps(3)) == 3
    passes.release()
