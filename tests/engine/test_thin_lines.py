"""Thin lines: the rule of their pixels, against integers, against OpenGL's own lines and against dense samples."""

import numpy as np
import pytest

from pvfiblets.engine import FibletStyle, View

from .cells import SHIFT_256, decided_by, line_cells, thin_lines
from .gl_lines import gl_lines
from .pictures import EMPTY, SIZE, draw, near
from .polylines import DEPTH_ROUNDING, assert_like_samples, to_clip, to_window

VIEWS = {
    "perspective": {},
    "parallel": {"height": 150.0},
    "from inside": {"eye": (3, -2, 1), "target": (30, 10, 0), "near": 0.05, "far": 200.0, "angle": 80.0},
    "close": {"eye": (0, -60, 10), "near": 25.0, "far": 90.0},
}


@pytest.mark.few(2)
@pytest.mark.every("value")
@pytest.mark.parametrize("kind", [1, 2, 3, 4])
@pytest.mark.parametrize("view", VIEWS)
def test_pixels_are_those_of_the_rule(gl, fabricate, random_lines, camera, view, kind):
    """Every pixel, and what it shows to the last bits of float32, but where rounding decides which pixel it is."""
    fiblets = fabricate(random_lines(50, seed=31), kind=kind)
    matrix = camera(SIZE, **VIEWS[view])
    picture = draw(gl, fiblets, View(SIZE, matrix))
    expected = thin_lines(fiblets.lines, matrix, SIZE)
    covered = np.isfinite(expected.depth)
    assert (covered & expected.clear & expected.alone).sum() > 1000
    assert expected.clear[covered].mean() > 0.85
    assert (picture.drawn == covered)[expected.clear].all()
    drawn = covered & expected.clear
    assert np.abs(picture.window_depth - expected.depth)[drawn].max() < DEPTH_ROUNDING
    drawn &= expected.alone
    assert (picture.ids[..., 0] == expected.streamline)[drawn].all()
    # float32 knows a clipped end to 16 * 320 * 2^-24 = 3e-4 pixel, and a segment drawn has a pixel at least
    assert np.abs(picture.position[..., 0] - expected.place)[drawn].max() < 3e-4


def test_segments_of_many_pixels(gl, fabricate, camera):
    """Float32 rounds the pixels of segments of hundreds of pixels: of all, one in a thousand is another, next to it."""
    size, rng = (900, 700), np.random.default_rng(8)
    fiblets = fabricate(rng.uniform(-60, 60, (60, 3, 3)), kind=3)
    matrix = camera(size, height=125.0)
    picture = draw(gl, fiblets, View(size, matrix))
    expected = thin_lines(fiblets.lines, matrix, size)
    covered = np.isfinite(expected.depth)
    assert covered.sum() > 20000
    assert (picture.drawn == covered)[expected.clear].mean() > 0.999
    assert near(covered)[picture.drawn].all()
    assert near(picture.drawn)[covered].all()


def test_the_rule_is_opengls_own(gl):
    """Lines between the shifted pixel centres, each in a tile of its own: OpenGL takes the rule's pixels.

    But where the rule decides by less than 1/256 pixel, the finest that OpenGL tells apart: no segment of up to 20.
    """
    rng = np.random.default_rng(1)
    tile, across = 64, 32
    p, q = rng.integers(2, tile - 2, (2, across * across, 2))
    short = across * across // 2
    q[:short] = (p[:short] + rng.integers(-8, 9, (short, 2))).clip(2, tile - 3)
    corner = np.stack(np.divmod(np.arange(across * across), across), axis=1) * tile
    centres = lambda cells: (cells + corner + 0.5 + SHIFT_256 / 256) / (tile * across) * 2 - 1  # noqa: E731
    lines = np.zeros((across * across, 2, 3))
    lines[:, 0, :2], lines[:, 1, :2] = centres(p), centres(q)
    mask, _ = gl_lines(gl, list(lines), np.eye(4), (tile * across, tile * across))
    n_pixels = 0
    for a, b, (x, y) in zip(p, q, corner, strict=True):
        found = mask[y : y + tile, x : x + tile]
        at, _ = line_cells(a, b)
        expected = np.zeros((tile, tile), bool)
        expected[at[:, 1], at[:, 0]] = True
        n_pixels += len(at)
        if (found != expected).any():
            assert decided_by(a, b) < 1 / 256
            assert np.abs(b - a).max() > 20
            assert (near(found) & near(expected) | ~found & ~expected).all()
    assert n_pixels > 12000


@pytest.mark.parametrize("parallel", [False, True], ids=["perspective", "parallel"])
def test_agrees_with_opengl_lines(gl, fabricate, random_lines, camera, parallel):
    """OpenGL's lines of the points themselves, which no pixel centre holds."""
    size = (640, 480)
    fiblets = fabricate([line for line in random_lines(120) if len(line) > 1], kind=2)
    matrix = camera(size, height=120 if parallel else None)
    picture = draw(gl, fiblets, View(size, matrix))
    mask, z = gl_lines(gl, fiblets.lines, matrix, size)
    assert picture.drawn.sum() > 5000
    assert near(mask)[picture.drawn].mean() >= 0.99
    assert near(picture.drawn)[mask].mean() >= 0.99
    both = picture.drawn & mask
    assert both.sum() > 0.6 * picture.drawn.sum()
    assert np.median(np.abs(picture.window_depth - z)[both]) < 2e-4  # a fraction of a pixel along
    # thin lines are thin: not more pixels than OpenGL's own, but for joints
    assert picture.drawn.sum() < 1.1 * mask.sum()


@pytest.mark.few(2)
@pytest.mark.parametrize("parallel", [False, True], ids=["perspective", "parallel"])
@pytest.mark.parametrize("kind", [1, 2, 3])
def test_pixels_say_what_they_show(gl, fabricate, random_lines, camera, kind, parallel):
    fiblets = fabricate(random_lines(60, seed=kind), kind=kind)
    matrix = camera(SIZE, height=150 if parallel else None)
    assert_like_samples(draw(gl, fiblets, View(SIZE, matrix)), fiblets.lines, matrix, SIZE)


def test_camera_inside_the_data(gl, fabricate, random_lines, camera):
    fiblets = fabricate(random_lines(150, seed=5), kind=2)
    matrix = camera(SIZE, **VIEWS["from inside"])
    picture = draw(gl, fiblets, View(SIZE, matrix))
    assert picture.drawn.sum() > 1000
    assert_like_samples(picture, fiblets.lines, matrix, SIZE, share=0.99)


def test_lines_far_longer_than_the_screen(gl, fabricate, camera):
    lines = [np.array([[-3e4, -5.0, 3.0], [4e4, 12.0, -8.0]]), np.array([[0.0, -900.0, 0.0], [1.0, 4e4, 1.0]])]
    fiblets = fabricate(lines, kind=3, low=True)
    matrix = camera(SIZE)
    assert_like_samples(draw(gl, fiblets, View(SIZE, matrix)), fiblets.lines, matrix, SIZE)


def test_a_million_millimetres_away(gl, fabricate, random_lines, camera):
    offset = np.array([1e6, -2e6, 3e6])
    lines = random_lines(40, seed=7)
    here = fabricate(lines, kind=2)
    there = fabricate([line + offset for line in lines], kind=2)
    matrix = camera(SIZE)
    shift = np.eye(4)
    shift[:3, 3] = -(there.origin - here.origin)
    a, b = draw(gl, here, View(SIZE, matrix)), draw(gl, there, View(SIZE, matrix @ shift))
    assert (a.drawn == b.drawn).mean() > 0.999
    assert_like_samples(b, there.lines, matrix @ shift, SIZE)


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_scales(gl, fabricate, random_lines, camera, scale):
    fiblets = fabricate([line * scale for line in random_lines(40, seed=8)], kind=2)
    matrix = camera(SIZE) @ np.diag([1 / scale, 1 / scale, 1 / scale, 1.0])
    assert_like_samples(draw(gl, fiblets, View(SIZE, matrix)), fiblets.lines, matrix, SIZE)


def test_fine_anchors_keep_their_digits_in_a_close_view(gl, fabricate, camera):
    """Ten micrometres of a 2 km data set, seen from close by: float32 alone would be 100 um off."""
    t = np.linspace(0, 1e-2, 30)
    close = np.stack([t, 0.003 * np.sin(t * 1500), 0 * t], axis=1) + 1000.0
    fiblets = fabricate([np.zeros((1, 3)), close, np.full((1, 3), 2000.0)], kind=2, low=True, lattice=2e-5)
    size, target = (200, 200), np.array([1000.005, 1000.0, 1000.0])
    matrix = camera(
        size, eye=target + np.array([0, 0, 0.03]), target=target, up=(0, 1, 0), near=1e-3, far=1.0, angle=20.0
    )
    picture = draw(gl, fiblets, View(size, matrix))
    assert picture.drawn.sum() > 150
    assert_like_samples(picture, fiblets.lines, matrix, size)


def test_one_point_streamlines_are_dots(gl, fabricate, camera):
    points = np.random.default_rng(3).uniform(-40, 40, (50, 3))
    fiblets = fabricate(points[:, None, :], kind=1)
    matrix = camera(SIZE)
    cells = to_window(to_clip(np.concatenate(fiblets.lines), matrix), SIZE)[:, :2].astype(int)
    for tolerance in (0.0, 0.5):
        picture = draw(gl, fiblets, View(SIZE, matrix), FibletStyle(tolerance=tolerance))
        assert picture.drawn[cells[:, 1], cells[:, 0]].all()
        assert picture.drawn.sum() == len(np.unique(cells, axis=0))
        assert (picture.position[picture.drawn][:, 0] == 0).all()
        wide = draw(gl, fiblets, View(SIZE, matrix), FibletStyle(7.0, tolerance=tolerance))
        area = wide.drawn.sum() / picture.drawn.sum()
        assert 0.8 * np.pi * 3.5**2 < area < 1.1 * np.pi * 3.5**2


@pytest.mark.parametrize("tolerance", [0.0, 0.5])
def test_polylines_have_no_gaps(gl, fabricate, camera, tolerance):
    """Whatever the step: a circle drawn with steps from a fraction of a pixel to many is one closed curve."""
    for n in (7, 100, 900, 5000):
        a = np.linspace(0, 2 * np.pi, n + 1)
        fiblets = fabricate([np.stack([60 * np.cos(a), 0 * a, 60 * np.sin(a)], axis=1)], kind=3)
        view = View(SIZE, camera(SIZE, eye=(0, -260, 0)))
        drawn = draw(gl, fiblets, view, FibletStyle(tolerance=tolerance)).drawn
        # flooding the outside must not reach the middle
        outside = np.zeros_like(drawn)
        outside[0, 0] = True
        while True:
            grown = outside | np.roll(outside, 1, 0) | np.roll(outside, -1, 0)
            grown |= np.roll(outside, 1, 1) | np.roll(outside, -1, 1)
            grown &= ~drawn
            if (grown == outside).all():
                break
            outside = grown
        assert not outside[SIZE[1] // 2, SIZE[0] // 2], f"{n} steps leave a gap"


def test_the_nearest_line_wins(gl, fabricate, camera):
    """A curtain of lines behind another: each pixel shows the front one, whatever the order in the file."""
    x = np.linspace(-60, 60, 300)
    for order in (1, -1):
        lines = [np.c_[[a, a], [y, y], [-60, 60]] for y in (-10.0, 20.0)[::order] for a in x]
        fiblets = fabricate(lines, kind=3)
        picture = draw(gl, fiblets, View(SIZE, camera(SIZE, eye=(0, -260, 0), height=100)))
        columns = (np.arange(SIZE[0]) + 0.5 - SIZE[0] / 2) * 100 / SIZE[1]
        front = picture.ids[:, np.abs(columns) < 58, 0]
        assert (picture.depth[:, np.abs(columns) < 58] != EMPTY).all()
        assert ((front < 300) if order == 1 else (front >= 300)).all()
