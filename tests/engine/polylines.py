"""Polylines in the window, in float64: what a picture must show, sampled densely or asked of each pixel.

A thin segment is drawn from pixel centre to pixel centre (``shaders/fiblets/segments/thin_line_rule.glsl``). How far
that may lead away, in pixels:

* from the true line: each end moves by at most 1/2 along each axis, and a pixel lies at most 1/2 beside the moved line
  along its minor axis. For a line of direction (c, s), c >= s, that is (c + s) / 2 + c / 2, at most sqrt(5) / 2, and
  the length of CELL_SHIFT for the moved lines' shift: ``OFF_LINE``.
* from the place that the pixel names: sqrt(1/2) for the ends' move and 1/2 across, and the shift: ``OFF_PLACE``.
* in depth: that of the place, but for the shift along the line, ``SHIFT`` pixels' worth of its slope.
"""

from itertools import pairwise

import numpy as np

from .pictures import near, unpacked_tangent
from .tangents import tangents_at

SHIFT = 2.0**0.5 * 23.0 / 256.0
OFF_LINE = 5.0**0.5 / 2.0 + SHIFT
OFF_PLACE = 0.5**0.5 + 0.5 + SHIFT
DEPTH_ROUNDING = 16 * float(np.finfo(np.float32).eps)
"""Of a depth near 1 that is the quotient of two sums of four products, each of which may be a few times larger."""


def to_clip(points, matrix):
    """(n, 4) clip coordinates."""
    return np.c_[points, np.ones(len(points))] @ matrix.T


def to_window(clip, size):
    """(n, 4): x, y in pixels from the lower left corner, depth in 0..1, w."""
    w = clip[:, 3:]
    return np.c_[(clip[:, :2] / w + 1) / 2 * size, (clip[:, 2:3] / w + 1) / 2, w]


def inside_part(a, b):
    """Range (m,) of t in which a + t (b - a), (m, 4) each, is inside the view volume, and whether there is any."""
    low, high, any_part = np.zeros(len(a)), np.ones(len(a)), np.ones(len(a), bool)
    for axis in range(3):
        for sign in (-1.0, 1.0):
            da, db = a[:, 3] + sign * a[:, axis], b[:, 3] + sign * b[:, axis]
            any_part &= (da >= 0) | (db >= 0)
            with np.errstate(divide="ignore", invalid="ignore"):
                t = da / (da - db)
            low = np.where((da < 0) & (db >= 0), np.fmax(low, t), low)
            high = np.where((db < 0) & (da >= 0), np.fmin(high, t), high)
    return low, high, any_part & (low <= high)


def segments(lines):
    """(m, 3) both ends of all segments, (m,) streamline and index of the first point; a point is one of no length."""
    a, b, streamline, first = [], [], [], []
    for s, line in enumerate(lines):
        one = len(line) == 1
        a.append(line if one else line[:-1])
        b.append(line if one else line[1:])
        streamline.append(np.full(len(a[-1]), s))
        first.append(np.arange(len(a[-1])))
    return np.concatenate(a), np.concatenate(b), np.concatenate(streamline), np.concatenate(first)


def sampled(lines, matrix, size, per_pixel=16):
    """Points along all polylines, evenly in the window: x, y, depth, streamline, place along it."""
    a, b, streamline, first = segments(lines)
    a, b = to_clip(a, matrix), to_clip(b, matrix)
    low, high, kept = inside_part(a, b)
    rows = []
    for i in np.flatnonzero(kept):
        ends = a[i] + np.array([[low[i]], [high[i]]]) * (b[i] - a[i])
        if not (ends[:, 3] > 0).all():
            continue
        span = np.abs(np.diff(ends[:, :2] / ends[:, 3:], axis=0)[0] * size).max() / 2
        s = np.linspace(0.0, 1.0, int(max(span, 1.0) * per_pixel) + 2)[:, None]
        t = low[i] + (high[i] - low[i]) * s * ends[0, 3] / ((1 - s) * ends[1, 3] + s * ends[0, 3])
        rows.append(
            np.c_[to_window(a[i] + t * (b[i] - a[i]), size)[:, :3], np.full_like(t, streamline[i]), first[i] + t]
        )
    return np.concatenate(rows)


def places(lines, streamline, place):
    """(m, 3) data positions of places along streamlines, and the ends (m, 3) of their segments."""
    line = [lines[s] for s in streamline]
    i = np.array([min(int(p), max(len(points) - 2, 0)) for p, points in zip(place, line, strict=True)])
    a = np.array([points[k] for k, points in zip(i, line, strict=True)]).reshape(-1, 3)
    b = np.array([points[min(k + 1, len(points) - 1)] for k, points in zip(i, line, strict=True)]).reshape(-1, 3)
    return a + (np.asarray(place) - i)[:, None] * (b - a), a, b


def some_pixels(picture, most=2000):
    """Rows and columns of at most that many drawn pixels."""
    rows, columns = np.nonzero(picture.drawn)
    pick = np.random.default_rng(0).permutation(len(rows))[:most]
    return rows[pick], columns[pick]


def assert_pixels_name_places(picture, lines, matrix, size, *, cut=False, per_fiblet=60):
    """The place that a pixel names is at the pixel, at its depth, and has its tangent; planes may have cut segments."""
    rows, columns = some_pixels(picture)
    streamline, place = picture.ids[rows, columns, 0], picture.position[rows, columns, 0].astype(float)
    points, a, b = places(lines, streamline, place)
    window = to_window(to_clip(points, matrix), size)
    away = np.linalg.norm(window[:, :2] - np.c_[columns, rows] - 0.5, axis=1)
    # float32 tells places along a streamline and along a segment of many pixels apart by so many pixels
    ca, cb = to_clip(a, matrix), to_clip(b, matrix)
    low, high, _ = inside_part(ca, cb)
    wa, wb = (to_window(ca + t[:, None] * (cb - ca), size) for t in (low, high))
    run = np.linalg.norm((wb - wa)[:, :2], axis=1)
    step = np.maximum(place, 1.0) * np.finfo(np.float32).eps / np.maximum(high - low, 1e-9)
    skew = np.maximum(wa[:, 3], wb[:, 3]) / np.minimum(wa[:, 3], wb[:, 3])  # how unevenly perspective spreads places
    rounding = 4.0 * step * skew
    assert (away <= OFF_PLACE + rounding * run + 1e-3).all(), away.max()
    slope = np.abs(wb[:, 2] - wa[:, 2])
    error = np.abs(window[:, 2] - picture.window_depth[rows, columns])
    # the drawn line is at most sqrt(2) pixels shorter, if it is not cut, and one pixel long at least
    drawn = np.ones(len(run)) if cut else np.maximum(run - 2.0**0.5, 1.0)
    allowed = DEPTH_ROUNDING + slope * (SHIFT / drawn + rounding)
    assert (error <= allowed).all(), (error - allowed).max()
    shown = unpacked_tangent(picture.ids[rows, columns, 1])
    expected = tangents_at(lines, streamline, place, per_fiblet)
    assert np.mean((shown * expected).sum(1) > 1 - 1e-5) > 0.99


def assert_like_samples(picture, lines, matrix, size, *, share=0.999):
    """Each pixel drawn shows a polyline point near it, and each polyline point has a pixel near it."""
    samples = sampled(lines, matrix, size)
    cells = samples[:, :2].astype(int).clip(0, np.array(size) - 1)
    touched = np.zeros(picture.depth.shape, bool)
    touched[cells[:, 1], cells[:, 0]] = True
    assert near(touched)[picture.drawn].mean() >= share
    assert near(picture.drawn)[touched].mean() >= share
    assert_pixels_name_places(picture, lines, matrix, size)


def feet(window, size):
    """Return the nearest place (h, w) of a polyline in the window to every pixel's centre, and its distance."""
    y, x = np.mgrid[: size[1], : size[0]] + 0.5
    nearest, place = np.full(x.shape, np.inf), np.zeros(x.shape)
    for k, (a, b) in enumerate(pairwise(window)):
        run = b - a
        t = np.clip(((x - a[0]) * run[0] + (y - a[1]) * run[1]) / (run @ run), 0, 1)
        away = np.hypot(x - a[0] - t * run[0], y - a[1] - t * run[1])
        nearer = away < nearest
        nearest[nearer], place[nearer] = away[nearer], (k + t)[nearer]
    return nearest, place
