"""Halos behind others are left out, and the picture is the same to the bit."""

import numpy as np
import pytest

from pvfiblets.engine import View
from pvfiblets.engine.halos import HaloRenderer
from pvfiblets.halos import HaloLines, HaloPoints
from pvfiblets.report.studies.halos.reference import LINE

from .halos import EYES, PLAIN, SIZE, assert_same, buffers, read_halos, scattered, styled, wandering


@pytest.fixture
def few_are_many(monkeypatch):
    """Have culling begin where tests do not take long."""
    monkeypatch.setattr("pvfiblets.engine.hit_drawable.LEAST_SEGMENTS", 500)


def crowd(kind):
    """So many that most are hidden."""
    return wandering(90, 30, seed=6, wander=0.3, step=1.5) if kind == "lines" else scattered(4000, spread=9.0)


@pytest.mark.few(1)
@pytest.mark.usefixtures("few_are_many")
@pytest.mark.parametrize("name", EYES)
@pytest.mark.parametrize("kind", ["lines", "points"])
def test_culling_changes_no_pixel(gl, camera, kind, name):
    """Bit for bit, turn by turn and jump by jump, cut, filtered, and from within."""
    drawn = crowd(kind)
    culled, whole = HaloRenderer(gl, drawn), HaloRenderer(gl, drawn, culling=None)
    plane = [[0.4, 1.0, 0.1, 2.0]]
    usual, wide = styled("number"), styled("number", strip_width=9.0, max_displacement=0.8, **PLAIN)
    filtered = styled("number", filter_by="number", low=0.5, filter_taper=2.0)
    orbit = [(0.0, (), usual), (0.05, (), usual), (0.1, (), usual), (1.7, (), usual), (1.7, (), filtered),
             (1.75, plane, usual), (4.0, (), wide), (4.1, (), wide), (4.1, plane, usual), (0.4, (), usual)]  # fmt: skip
    for angle, planes, style in orbit:
        eye = {**EYES[name], "eye": (62 * np.sin(angle), -62 * np.cos(angle), 14)}
        view = View(SIZE, camera(SIZE, **eye), planes)
        a, b = read_halos(culled.render(view, style)), read_halos(whole.render(view, style))
        assert a.shown.sum() > 300
        assert (a.kind == LINE).any()
        assert_same(a, b)
    inside = View((70, 90), camera((70, 90), eye=(0, -3, 0), near=0.1, far=50.0, angle=80.0))
    for style in (usual, wide):
        assert_same(read_halos(culled.render(inside, style)), read_halos(whole.render(inside, style)))
    said = culled.explain()
    assert said["culling"] == "two-phase"
    assert {"culling", "occlusion"} <= set(buffers(culled))
    assert not {"culling", "occlusion"} & set(buffers(whole))
    assert [p["name"] for p in said["passes"]][:3] == ["last picture", "clear", "seen before"]
    culled.release()
    whole.release()


@pytest.mark.usefixtures("few_are_many")
def test_items_listed_last_are_whole(gl):
    """Where all are listed, the last need not be the data's last, which may have less quads than the others."""
    for n in (901, 907, 1000):
        renderer = HaloRenderer(gl, HaloPoints(np.zeros((n, 3)) + np.arange(n)[:, None]))
        assert buffers(renderer)["indices"] >= -(-n // 8) * 8 * 6 * 2
        renderer.release()


@pytest.mark.usefixtures("few_are_many")
def test_what_stands_before_all_is_found_at_once(gl, camera):
    """After a jump to behind a wall of lines, all that the last picture showed is hidden."""
    x = np.linspace(-20, 20, 300)
    wall = [np.array([[a, 8.0, -20.0], [a, 8.0, 20.0]]) for a in x]
    crowd = [places.reshape(2, 3) for places in wandering(300, 2, seed=2, step=2.0, spread=5.0).points.reshape(-1, 6)]
    points = np.concatenate(wall + crowd)
    drawn = HaloLines(points, np.arange(0, len(points) + 1, 2))
    some = styled(line_width=0.4, strip_width=1.0, **PLAIN)
    culled, whole = HaloRenderer(gl, drawn), HaloRenderer(gl, drawn, culling=None)
    owners = []
    for side in (-1, 1, -1, 1, 1):
        view = View(SIZE, camera(SIZE, **{**EYES["parallel"], "eye": (3, 62 * side, 2), "height": 20.0}))
        a, b = read_halos(culled.render(view, some)), read_halos(whole.render(view, some))
        assert_same(a, b)
        owners.append(np.unique(a.owner[a.kind == LINE]))
    assert (owners[0] >= 600).any()
    assert (owners[1] < 600).all()
    culled.release()
    whole.release()


@pytest.mark.usefixtures("few_are_many")
def test_strips_whose_lines_lie_beside_the_picture_are_not_culled(gl, camera):
    """Strips 12 mm wide reach into a picture that ends 4 mm beside their axes, and are the only ones there."""
    height = np.linspace(-14.0, 14.0, 700)
    points = np.stack([np.stack([20.0 + 0.01 * height, np.full(700, y), height], axis=1) for y in (-3.0, 3.0)], axis=1)
    drawn = HaloLines(points.reshape(-1, 3), np.arange(0, 1401, 2))
    width = 32.0 * SIZE[1] / SIZE[0]
    view = View(SIZE, camera(SIZE, eye=(0, 0, 60), up=(0, 1, 0), height=width))
    some = styled(line_width=11.0, strip_width=12.0, **PLAIN)
    culled, whole = HaloRenderer(gl, drawn), HaloRenderer(gl, drawn, culling=None)
    a, b = read_halos(culled.render(view, some)), read_halos(whole.render(view, some))
    assert culled.explain()["culling"] == "two-phase"
    assert a.shown.sum() > 100
    assert_same(a, b)
    for made in (culled, whole):
        made.release()


@pytest.mark.usefixtures("few_are_many")
def test_what_is_flat_is_not_culled(gl, camera):
    """Equal depths show in the order of the data, which lists of what shows do not keep."""
    crowd = wandering(60, 12, seed=3, step=3.0)
    flat = HaloLines(crowd.points * [1.0, 1.0, 0.0], crowd.offsets, crowd.values)
    view = View(SIZE, camera(SIZE, eye=(0, 0, 60), up=(0, 1, 0), height=30.0))
    renderer, whole = HaloRenderer(gl, flat), HaloRenderer(gl, flat, culling=None)
    for some in (styled(), styled(line_width=2.0), styled()):
        assert_same(read_halos(renderer.render(view, some)), read_halos(whole.render(view, some)))
    assert renderer.explain()["culling"] is None
    for made in (renderer, whole):
        made.release()


def test_few_are_not_culled(gl, camera):
    renderer = HaloRenderer(gl, wandering())
    renderer.render(View(SIZE, camera(SIZE, **EYES["perspective"])), styled())
    assert renderer.explain()["culling"] is None
    renderer.release()
