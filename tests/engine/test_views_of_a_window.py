"""Pictures of several views of a window by one renderer: each stays until its own view changes, within a bound."""

import numpy as np
import pytest

from pvfiblets import compress
from pvfiblets.engine import FibletRenderer, FibletStyle, View
from pvfiblets.engine.fiblets.data.filter_textures import Filter
from pvfiblets.report.studies.stability.render_checks import camera
from pvfiblets.synthetic import brain_streamlines

from .pictures import assert_same, draw, read

STYLE = FibletStyle(2.0)
SIZES = {"axial": (96, 64), "coronal": (96, 64), "3d": (160, 128)}
PIXELS = sum(width * height for width, height in SIZES.values())


@pytest.fixture(scope="module")
def fiblets():
    return compress(brain_streamlines(200, 0.5, seed=4))


@pytest.fixture
def renderer(gl, fiblets):
    made = FibletRenderer(gl, fiblets)
    yield made
    made.release()


def look(name, depth=0.0):
    """Return one of three views of the brain; two of them show a slab alone."""
    side = {"axial": (0, 0.1, 1), "coronal": (0.1, 1, 0), "3d": (1, 0.3, 0.3)}[name]
    eye = np.array([0, -18, 8]) + 300 * np.array(side) / np.linalg.norm(side)
    size = SIZES[name]
    matrix = camera(size, eye=eye, target=(0, -18, 8), near=100.0, far=500.0, angle=35.0)
    planes = {"axial": [(0, 0, 1, 8 - depth), (0, 0, -1, depth + 4)], "coronal": [(0, 1, 0, 20), (0, -1, 0, 4)]}
    return View(size, matrix, planes.get(name, []))


def shown(renderer, name, view, room=PIXELS):
    """Draw a view of the window; return its picture, and whether it was drawn anew."""
    before = renderer._generation
    renderer.switch_to(name, room)
    return read(renderer.render(view, STYLE)), renderer._generation > before


def test_a_view_is_drawn_again_when_it_has_changed(gl, fiblets, renderer):
    views = {name: look(name) for name in SIZES}
    first = {name: draw(gl, fiblets, view, STYLE) for name, view in views.items()}
    assert all(picture.drawn.sum() > 500 for picture in first.values())
    for again in (True, False, False):
        for name, view in views.items():
            found, anew = shown(renderer, name, view)
            assert anew == again, name
            assert_same(found, first[name])
    views["axial"] = look("axial", 12.0)
    moved = draw(gl, fiblets, views["axial"], STYLE)
    for name, view in views.items():
        found, anew = shown(renderer, name, view)
        assert anew == (name == "axial")
        assert_same(found, moved if name == "axial" else first[name])
    counts = renderer.explain()["fiblets"]  # of the frame that was drawn last
    assert counts["visible"] == len(set(moved.owner[moved.drawn].tolist()))


def test_pictures_together_have_no_more_pixels_than_there_is_room_for(fiblets, renderer):
    views = {name: look(name) for name in SIZES}
    (width, height), texel = SIZES["3d"], 24
    for name, view in views.items():
        shown(renderer, name, view, width * height)
    sizes = {row["name"]: row["bytes"] for row in renderer.explain()["buffers"]}
    assert sizes["gbuffer"] == texel * width * height
    assert shown(renderer, "axial", views["axial"], PIXELS)[1]
    assert not shown(renderer, "3d", views["3d"], PIXELS)[1]
    assert not shown(renderer, "axial", views["axial"], PIXELS)[1]
    assert {row["name"]: row["bytes"] for row in renderer.explain()["buffers"]}["gbuffer"] == texel * (
        width * height + 96 * 64
    )


def test_a_filter_outdates_the_pictures_of_all_views(gl, fiblets, renderer):
    views = {name: look(name) for name in SIZES}
    for name, view in views.items():
        shown(renderer, name, view)
    mask = np.arange(fiblets.n_streamlines) % 3 == 0
    renderer.filtering = Filter(streamlines=mask)
    only = FibletRenderer(gl, fiblets)
    only.filtering = Filter(streamlines=mask)
    for name, view in views.items():
        found, anew = shown(renderer, name, view)
        assert anew
        assert_same(found, read(only.render(view, STYLE)))
    only.release()


def test_a_view_that_is_left_half_drawn_is_drawn_anew(gl, fiblets, renderer, monkeypatch):
    monkeypatch.setattr("pvfiblets.engine.pieces.Pieces.due", property(lambda _: True))
    views = {name: look(name) for name in SIZES}
    shown(renderer, "3d", views["3d"])
    renderer.switch_to("axial", PIXELS)
    steps = renderer.render_in_pieces(views["axial"], STYLE)
    next(steps)
    assert not shown(renderer, "3d", views["3d"])[1]  # in between, as when somebody points at it
    assert list(steps) == []
    found, anew = shown(renderer, "axial", views["axial"])
    assert anew
    assert_same(found, draw(gl, fiblets, views["axial"], STYLE))
    assert not shown(renderer, "3d", views["3d"])[1]
