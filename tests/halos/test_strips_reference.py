"""The strips of the float64 reference of halos against closed forms: ends, filters, bends and cuts."""

from __future__ import annotations

import numpy as np
import pytest

from pvfiblets.halos import HaloPoints, HaloStyle
from pvfiblets.report.studies.halos.reference import HALO, LINE, NOTHING, picture
from pvfiblets.report.studies.halos.strips_reference import mask, places_along

from .views import CAMERAS, NEAR, PLAIN, SIZE, centres, kinds, line, lines, parallel, perspective, window_depth

# ------------------------------------------------------------------------------------------------------------- ends


def test_places_along_the_mask():
    """Of the paper's: n = 2, t = 0.2; short lines go as far as their middle from both ends."""
    wanted = {
        1: [0.5], 2: [0, 1], 3: [0, 0.5, 1], 4: [0, 0.1, 0.9, 1], 5: [0, 0.1, 0.5, 0.9, 1],
        6: [0, 0.1, 0.2, 0.8, 0.9, 1], 7: [0, 0.1, 0.2, 0.5, 0.8, 0.9, 1], 8: [0, 0.1, 0.2, 0.4, 0.6, 0.8, 0.9, 1],
    }  # fmt: skip
    for count, u in wanted.items():
        assert np.abs(places_along(count, 2, 0.2) - u).max() <= 0.5 / 65535
    assert np.abs(places_along(6, 1, 0.5) - [0, 0.5, 0.5, 0.5, 0.5, 1]).max() <= 0.5 / 65535
    far = places_along(100_001, 1000, 1e-3)
    assert (np.diff(far) >= 0).all()
    assert far[0] == 0
    assert far[-1] == 1
    assert (far[1:-1] > 0).all()
    assert (far[1:-1] < 1).all()
    assert np.abs(mask(np.array([0.0, 0.5, 1.0, 3.0])) - [0, np.sqrt(0.75), 1, 1]).max() < 1e-12


def test_tapered_ends_are_round():
    """With the ends of the mask on the first segment, half an ellipse; the line narrows as its strip does."""
    x, y = centres()
    look = HaloStyle(10.0, 30.0, 20.0, n_tapered=1, t_tapered=0.2, min_width=0.0, smooth=False)
    found = picture(line([-30, 0, 100], [-10, 0, 100], [20, 0, 100], [30, 0, 100]), look, parallel(), SIZE)
    end = np.where(x < -10, (x + 30) / 20, np.where(x > 20, (30 - x) / 10, 1.0))
    m = np.sqrt(np.clip(end * (2 - end), 0, 1)) * (end > 0)
    clear = found.margin > 1e-3  # u has 16 bits
    assert clear.mean() > 0.99
    assert (found.kind == kinds(abs(y) < 5 * m, abs(y) < 15 * m))[clear].all()
    ellipse = ((x + 10) / 20) ** 2 + (y / 15) ** 2 < 1
    left = (x < -10) & clear
    assert ((found.kind != NOTHING) == ellipse)[left].all()


def test_filtered_lines_end_where_their_numbers_do_and_narrow_over_their_mm():
    x, y = centres()
    scene = line([-30, 0, 100], [0, 0, 100], [30, 0, 100], n=[0.0, 6.0, 0.0])
    for low, high in ((2.0, np.inf), (-np.inf, 3.35), (2.0, 3.35), (0.0, 6.0), (7.0, 8.0)):
        look = HaloStyle(10.0, 30.0, 20.0, filter_by="n", low=low, high=high, **PLAIN)
        found = picture(scene, look, parallel(), SIZE)
        number = 6 - abs(x) / 5
        there = (number >= low) & (number <= high) & (abs(x) < 30) & (abs(y) < 15)
        assert (found.kind == kinds(abs(y) < 5, there)).all()
        assert there.any() == (low < 7)
    scene = line([-30, 0, 100], [30, 0, 100], n=[0.0, 6.0])
    look = HaloStyle(10.0, 30.0, 20.0, filter_by="n", low=2.0, high=5.0, filter_taper=8.0, **PLAIN)
    found = picture(scene, look, parallel(), SIZE)
    end = np.clip(np.minimum(x + 10, 20 - x) / 8, 0, 1)
    m = np.sqrt(end * (2 - end))
    assert (found.kind == kinds((abs(y) < 5 * m), (abs(y) < 15 * m) & (end > 0))).all()
    scene = line(*([10 * i, 0, 100] for i in range(-3, 4)), n=[1, 1, 1, np.nan, 1, 1, 1])
    found = picture(scene, HaloStyle(10.0, 30.0, 20.0, filter_by="n", **PLAIN), parallel(), SIZE)
    assert ((found.kind != NOTHING) == ((abs(x) > 10) & (abs(x) < 30) & (abs(y) < 15))).all()


# ------------------------------------------------------------------------------------------------------------- bends


def bent(degrees, *, length=25.0):
    turn = np.radians(degrees)
    return line([-length, -5, 100], [0, -5, 100], [length * np.cos(turn), -5 + length * np.sin(turn), 100])


@pytest.mark.parametrize("degrees", [0.0, 20.0, 59.0, -59.0, 61.0, 90.0, 150.0, 180.0])
def test_bends(degrees):
    """Either segment goes on round; up to 60 degrees it ends at the bisector, where the other is as near."""
    look = HaloStyle(6.0, 16.0, 5.0, **PLAIN)
    found = picture(bent(degrees), look, parallel(), SIZE)
    x, y = centres()
    turn = np.radians(degrees)
    e = np.array([np.cos(turn), np.sin(turn)])
    first, second = (x, y + 5), (x * e[0] + (y + 5) * e[1], (y + 5) * e[0] - x * e[1])
    off = np.hypot(x, y + 5)
    one = np.where(first[0] < 0, abs(first[1]), off) + 99 * (first[0] < -25)
    two = np.where(second[0] > 0, abs(second[1]), off) + 99 * (second[0] > 25)
    away = np.minimum(one, two)
    assert (found.kind == kinds(away < 3, away < 8)).all()
    assert np.abs(found.depth - window_depth(100 + 5 * away / 8 * (away > 3)))[found.kind != NOTHING].max() < 1e-12
    # What lies next behind the line may be the other segment as line; halos are farther.
    assert (found.other >= 0.999 * window_depth(NEAR + 5 * 3 / 8))[found.kind == LINE].all()
    assert ((found.cover > 0) == (away < 8)).all()
    inner = (away < 8) & (off < 16)
    assert (found.cover <= 8 - away + 1e-9)[inner].all()
    side = (x * (1 + e[0]) + (y + 5) * e[1]) / np.hypot(1 + e[0], e[1]) if abs(degrees) < 60 else np.inf
    # Just beside a bisector the other segment is a little farther away.
    close = inner & (abs(side) < 0.1) & (away < 7.5)
    assert (found.cover > 8 - away - 0.1)[close].all()
    far = inner & (abs(side) > 8 - away)
    assert far.sum() > 50
    assert np.abs(found.cover - (8 - away))[far].max() < 1e-9
    if abs(degrees) < 60:
        assert (found.owner == np.where(away < 8, side > 0, -1)).all()


@pytest.mark.parametrize("degrees", [45.0, 120.0])
def test_bends_take_everything_from_the_foot(degrees):
    """Beyond a segment's end all is as at its end: depth, width, number."""
    turn = np.radians(degrees)
    far = [25 * np.cos(turn), -5 + 25 * np.sin(turn), 130]
    look = HaloStyle(6.0, 16.0, 5.0, min_width=0.0, smooth=False, n_tapered=1, t_tapered=0.1, width_cue=0.4)
    found = picture(line([-25, -5, 100], [0, -5, 115], far), look, parallel(), SIZE)
    x, y = centres()
    off = np.hypot(x, y + 5)
    beyond = (x > 0.1) & (x * np.cos(turn) + (y + 5) * np.sin(turn) < -0.1) & (found.kind != NOTHING)
    assert beyond.sum() > (3 if degrees < 60 else 30)
    # The vertex has u = 0.5: the middle of three; of the depth there is half, and of the cue.
    assert ((found.kind == LINE) == (off < 3 * 0.8))[beyond].all()
    assert np.abs(found.depth - window_depth(115 + 5 * off / 8 * (off > 2.4)))[beyond].max() < 1e-12
    assert np.isin(found.owner + found.t, [1.0])[beyond].all()


def test_repeated_points_and_segments_seen_end_on_are_round_and_lines_without_extent_nothing():
    """With the segments beside them, a disc."""
    look = HaloStyle(6.0, 16.0, 5.0, **PLAIN)
    for scene in (lines(np.zeros((0, 3))), line([0, 0, 100]), HaloPoints(np.zeros((0, 3)))):
        assert not picture(scene, look, parallel(), SIZE).kind.any()
    x, y = centres()
    for middle in ([[0, 0, 100], [0, 0, 100]], [[0, 0, 100], [0, 0, 100], [0, 0, 100]], [[0, 0, 100], [0, 0, 150]]):
        found = picture(line([-20, 0, 100], *middle), look, parallel(), SIZE)
        away = np.where(x < 0, abs(y), np.hypot(x, y)) + 99 * (x < -20)
        assert (found.kind == kinds(away < 3, away < 8)).all()


# -------------------------------------------------------------------------------------------------------------- cuts


@pytest.mark.parametrize("camera", CAMERAS)
def test_planes_cut_the_axis_square(camera):
    look = HaloStyle(6.0, 16.0, 5.0, n_tapered=0, min_width=0.0)
    k = 1.0 if camera == "parallel" else 0.8
    slanting = [[1, 0.7, 0, 9.0], [-1, 3.0, 0, 20.0]]
    found = picture(
        line([-30, 0, 125], [-5, 0, 125], [30, 0, 125]), look, CAMERAS[camera](), SIZE, clip_planes=slanting
    )
    x, y = (n / k for n in centres())
    assert ((found.kind != NOTHING) == ((x > -9) & (x < 20) & (abs(y) < 8))).all()


def test_what_lies_behind_the_eye_is_not_there():
    """A line through the near plane, and the eye's own, shows up to where it meets the near plane."""
    look = HaloStyle(2.0, 6.0, 5.0, **PLAIN)
    found = picture(line([10, 0, 150], [2, 0, -90]), look, perspective(), SIZE)
    x, _ = centres()
    at_near = 100 * np.interp(NEAR, [-90, 150], [2, 10]) / NEAR
    shown = x[found.kind != NOTHING]
    assert shown.min() == pytest.approx(np.floor(100 * 10 / 150) + 0.5, abs=1)
    assert shown.max() == pytest.approx(at_near, abs=1)
    assert not picture(line([10, 0, -50], [2, 0, -90]), look, perspective(), SIZE).kind.any()


# ------------------------------------------------------------------------------------------- too sharp for their width


def test_where_bisectors_cross_it_is_open_what_is_beyond():
    """A segment far shorter than its strip is wide, between bends to one side: it ends where they meet, or not."""
    turn = np.radians(40)
    steps = np.cumsum([[np.cos(a), np.sin(a)] for a in (0, turn, 2 * turn)] * np.array([[20.0], [4.0], [20.0]]), axis=0)
    points = [[0.0, 0, 100], *([x, y, 100.0] for x, y in steps)]
    scene = line(*([x - 20, y - 12, z] for x, y, z in points))
    look = HaloStyle(2.0, 24.0, 60.0, **PLAIN)
    found = picture(scene, look, parallel(), SIZE)
    x, y = (n + d for n, d in zip(centres(), (20, 12), strict=True))
    normals = [(np.cos(turn / 2), np.sin(turn / 2)), (np.cos(1.5 * turn), np.sin(1.5 * turn))]
    after, before = (x - 20) * normals[0][0] + y * normals[0][1], (x - steps[1][0]) * normals[1][0]
    before = -(before + (y - steps[1][1]) * normals[1][1])
    middle = found.owner == 1
    assert middle.sum() > 50
    assert (after[middle] >= 0).all()
    assert (before[middle] >= 0).all()
    # On the wrong side of both it may be there or not, and the pixel is not sure.
    wrong = (after < -0.1) & (before < -0.1) & (np.hypot(x - steps[0][0], y) < 11) & (found.kind == HALO)
    assert wrong.sum() > 5
    assert (found.margin[wrong] < 1e-9).all()
    assert (found.margin > 0.1).mean() > 0.4
