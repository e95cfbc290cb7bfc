"""Lines and points with halos where it is hard: no length, end on, through the eye, far away, tiny and huge."""

from __future__ import annotations

from typing import Any

import numpy as np

from pvfiblets.engine import View
from pvfiblets.engine.halos import HaloDrawStyle, HaloRenderer
from pvfiblets.halos import HaloLines, HaloPoints, HaloStyle

from ..halos.exact import kinds
from ..halos.reference import NOTHING, picture
from .case import Cases, Outcome, Setting, refused, worst
from .render_checks import Array, camera, moved_camera

CASES = Cases("halos", draws=True)
SIZE = (96, 72)
LOOK = HaloStyle(2.0, 7.0, 2.5, n_tapered=0, min_width=0.0)
EYE = (3.0, -62.0, 14.0)
SURE = "every pixel as in float64 that is 0.03 pixels or more from an edge there, and no holes"
WRONG = "wrong pixels"
NEAR, DEPTH = 0.03, 1e-6  # pixels; window depth


def _of_lines(*lines: Any) -> HaloLines:
    """Lines of several vertices each."""
    parts = [np.asarray(line, np.float64).reshape(-1, 3) for line in lines]
    return HaloLines(np.concatenate(parts), np.cumsum([0, *map(len, parts)]))


def _wandering(n: int = 8, m: int = 7, seed: int = 0) -> HaloLines:
    """Lines of a step of 4 mm about 0 with few sharp bends."""
    rng = np.random.default_rng(seed)
    lines = []
    for _ in range(n):
        d = rng.normal(size=3) + np.cumsum(rng.normal(0.0, 0.05, (m, 3)), axis=0)
        places = np.cumsum(4.0 * d / np.linalg.norm(d, axis=1)[:, None], axis=0)
        lines.append(places - places.mean(axis=0) + rng.uniform(-10.0, 10.0, 3))
    return _of_lines(*lines)


def _kinds(setting: Setting, drawn: HaloLines | HaloPoints, view: View, look: HaloStyle) -> tuple[Any, Array]:
    """Return what each pixel shows, nothing, line or halo, and its window depth."""
    renderer = HaloRenderer(setting.gl, drawn)
    try:
        return kinds(renderer.render(view, HaloDrawStyle(look=look)))
    finally:
        renderer.release()


def _compare(
    setting: Setting,
    drawn: HaloLines | HaloPoints,
    matrix: Array,
    size: tuple[int, int] = SIZE,
    look: HaloStyle = LOOK,
) -> Outcome:
    """Compare a picture with the one in float64."""
    view = View(size, matrix)
    kind, depth = _kinds(setting, drawn, view, look)
    wanted = picture(drawn, look, matrix, size)
    sure = (wanted.margin > NEAR) & (wanted.other > DEPTH)
    wrong = sure & ((kind != wanted.kind) | (np.abs(depth - wanted.depth) > DEPTH))
    holes = (kind == NOTHING) & (wanted.cover > NEAR)
    shown = int((wanted.kind != NOTHING).sum())
    return Outcome(float((wrong | holes).sum()), 0.0, WRONG, f"{int((sure & (kind != NOTHING)).sum())} of {shown} sure")


@CASES.add("segments of no length", "points twice, five times, at both ends; whole lines of one place", SURE)
def _no_length(setting: Setting) -> Outcome:
    drawn = _of_lines(
        [[-9, 0, 0], [0, 0, 0], [0, 0, 0], [9, 1, 0]],
        [[-9, 0, 6], *[[0, 0, 6]] * 5, [2, 0, 9]],
        [[-9, 0, -6], [-9, 0, -6], [9, 0, -6]],
        [[-9, 0, -11], [9, 0, -11], [9, 0, -11], [9, 0, -11]],
        [[3, 1, 12]] * 6,
        [[-3, 1, 12]] * 2,
    )
    return _compare(setting, drawn, camera(SIZE, eye=EYE, near=10.0, far=200.0, height=46.0))


@CASES.add("steps of 1e-9 to 1e-4 mm", "a bend within no length", "the picture without it, but for 1 pixel in 1,000")
def _short(setting: Setting) -> Outcome:
    view = View(SIZE, camera(SIZE, eye=EYE, near=10.0, far=200.0, height=46.0))
    straight, _ = _kinds(setting, _of_lines([[-9, 0, 0], [0, 0, 0], [9, 0, 0]]), view, LOOK)
    found = []
    for step in (1e-9, 1e-6, 1e-4):
        bent, _ = _kinds(setting, _of_lines([[-9, 0, 0], [0, 0, 0], [0, 0, step], [9, 0, 0]]), view, LOOK)
        found.append(Outcome(1e3 * float((bent != straight).mean()), 1.0, "pixels in 1,000", f"{step:g} mm"))
    return worst(found)


@CASES.add("the eye on a line", "a line through the eye and along the view, perspective, among others", SURE)
def _through_the_eye(setting: Setting) -> Outcome:
    drawn = _of_lines([[0, -40, 0], [0, -1, 0], [0, 0, 0], [0, 5, 0], [0, 40, 0]], [[-9, 20, 3], [9, 21, 4]])
    return _compare(setting, drawn, camera(SIZE, eye=(0.0, 0.0, 0.0), target=(0.0, 1.0, 0.0), near=0.1, far=50.0))


@CASES.add("seen end on", "lines along the view's axis, parallel and in perspective", SURE)
def _end_on(setting: Setting) -> Outcome:
    along, bent = [[6, -9, 0], [6, -8, 0], [6, -7, 0]], [[-9, 0, 5], [-2, 0, 5], [-2, 6, 5]]
    drawn = _of_lines([[0, -5, 0], [0, 5, 0]], along, bent)
    return worst(
        [
            _compare(setting, drawn, camera(SIZE, eye=(0.0, -60.0, 0.0), near=10.0, far=200.0, height=height))
            for height in (None, 32.0)
        ]
    )


@CASES.add("nothing to draw", "no lines, lines of one point, no points", "an empty picture")
def _nothing(setting: Setting) -> Outcome:
    view, none = View(SIZE, camera(SIZE, eye=EYE, near=10.0, far=200.0)), np.zeros((0, 3))
    lines = [HaloLines(none, np.zeros(n, np.int64)) for n in (1, 3)]
    sets: list[HaloLines | HaloPoints] = [*lines, _of_lines([[1, 2, 3]], [[4, 5, 6]]), HaloPoints(none)]
    shown = sum(int((_kinds(setting, some, view, LOOK)[0] != NOTHING).sum()) for some in sets)
    return Outcome(float(shown), 0.0, "pixels shown")


@CASES.add("strips wider than the scene", "500 mm wide, that lie 50 mm back", SURE)
def _wide(setting: Setting) -> Outcome:
    look = HaloStyle(1.0, 500.0, 50.0, n_tapered=0, min_width=0.0)
    return _compare(setting, _wandering(6, 2, 1), camera(SIZE, eye=EYE, near=10.0, far=200.0), look=look)


@CASES.add("offsets of ±1e7 mm", "lines and camera moved by 1e7 mm either way", SURE)
def _far_away(setting: Setting) -> Outcome:
    base, matrix, found = _wandering(), camera(SIZE, eye=EYE, near=10.0, far=200.0), []
    for shift in (1e7, -1e7):
        moved = HaloLines(base.points + shift, base.offsets)
        found.append(_compare(setting, moved, moved_camera(matrix, 1.0, shift)))
    return worst(found)


@CASES.add("sizes of 1e-6 and 1e6", "lines, widths and camera scaled by a millionth and by a million", SURE)
def _sizes(setting: Setting) -> Outcome:
    base, matrix, found = _wandering(), camera(SIZE, eye=EYE, near=10.0, far=200.0), []
    for size in (1e-6, 1e6):
        look = HaloStyle(2.0 * size, 7.0 * size, 2.5 * size, n_tapered=0, min_width=0.0)
        scaled = HaloLines(base.points * size, base.offsets)
        found.append(_compare(setting, scaled, moved_camera(matrix, size, 0.0), look=look))
    return worst(found)


@CASES.add("windows of 1 × 1 and one pixel high or wide", "four sizes; lines and points", SURE)
def _small(setting: Setting) -> Outcome:
    points = HaloPoints(np.random.default_rng(0).uniform(-14.0, 14.0, (60, 3)))
    return worst(
        [
            _compare(setting, drawn, camera(size, eye=EYE, near=10.0, far=200.0, height=46.0), size)
            for size in ((1, 1), (1, 50), (70, 1), (3, 2))
            for drawn in (_wandering(), points)
        ]
    )


@CASES.add("looks and points that are none", "NaN, strips thinner than lines, width 0", "an error each", draws=False)
def _bad(_: Setting) -> Outcome:
    return refused(
        ValueError,
        "finite|line_width|strip_width|max_displacement|thresholds",
        lambda: _of_lines([[0, 0, 0], [np.nan, 0, 0]]),
        lambda: HaloPoints(np.full((2, 3), np.inf)),
        lambda: HaloStyle(0.0, 1.0, 1.0),
        lambda: HaloStyle(2.0, 1.0, 1.0),
        lambda: HaloStyle(1.0, np.nan, 1.0),
        lambda: HaloStyle(1.0, 2.0, -1.0),
        lambda: HaloStyle(1.0, 2.0, 1.0, low=2.0, high=1.0),
    )
