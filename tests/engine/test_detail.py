"""Level of detail (``shaders/culling/bounds.glsl``): which fiblets are one segment, and how far that leads away."""

import numpy as np
import pytest

from pvfiblets import Streamlines, compress
from pvfiblets.engine import FibletStyle, View
from pvfiblets.synthetic import brain_streamlines

from .cells import thin_lines
from .pictures import SIZE, assert_same, draw, near
from .polylines import DEPTH_ROUNDING, OFF_LINE, to_clip, to_window

FAR_SIZE = 4.0
VIEWS = {
    "perspective": {},
    "parallel": {"height": 150.0},
    "far": {"eye": (0, -1500, 300), "near": 1000.0, "far": 2000.0, "angle": 10.0},
    "very far": {"eye": (0, -9000, 2000), "near": 5000.0, "far": 20000.0, "angle": 3.0},
    "from inside": {"eye": (3, -2, 1), "target": (30, 10, 0), "near": 0.05, "far": 200.0, "angle": 80.0},
    "close": {"eye": (0, -60, 10), "near": 25.0, "far": 90.0},
}


def one_segment(a, b, r, slip, matrix, size, tolerance):
    """Whether capsules (n, 3), (n, 3), (n,) are thinner or smaller than that many pixels, and by what factor.

    Thin counts only where the end is as near to the last point: that of a streamline is rounded by ``slip`` (n,).
    """
    window = np.array(size)[:, None] / 2 * (matrix[:2] + matrix[3])
    across = max(
        np.linalg.norm(row[:3] - place * matrix[3, :3])
        for row, pixels in zip(window, size, strict=True)
        for place in (0.0, pixels)
    )
    w = np.minimum(to_clip(a, matrix)[:, 3], to_clip(b, matrix)[:, 3]) - r * np.linalg.norm(matrix[3, :3])
    with np.errstate(divide="ignore", invalid="ignore"):
        thin = tolerance * w / (np.maximum(r, slip) * across)
        small = FAR_SIZE * w / ((np.linalg.norm(b - a, axis=1) + 2 * r) * across)
    factor = np.maximum(thin, small)
    return (w > 0) & (factor >= 1.0), factor


def capsules(fiblets):
    """Ends (n, 3), radii, slips, streamlines (n,), indices (n,) of the first and the last point of a segment."""
    streamline = np.repeat(np.arange(fiblets.n_streamlines), np.bincount(np.cumsum(fiblets.starts == 0) - 1))
    starts = fiblets.starts
    last = np.r_[streamline[1:] != streamline[:-1], True]
    stops = np.where(last, [len(fiblets.lines[s]) - 1 for s in streamline], np.r_[starts[1:], 0])
    a = np.array([fiblets.lines[s][i] for s, i in zip(streamline, starts, strict=True)])
    b = np.array([fiblets.lines[s][i] for s, i in zip(streamline, stops, strict=True)])
    word = fiblets.ends[streamline[last]].astype(np.int64)
    vector = np.stack([((word >> shift) & 1023) for shift in (0, 10, 20)], axis=1)
    vector -= 1024 * (vector > 511)
    b[last] = a[last] + vector * fiblets.parameters.end_scale
    slip = 0.867 * fiblets.parameters.end_scale * last
    return a, b, fiblets.reach * fiblets.reach_scale, slip, streamline, starts, stops


def simplified(fiblets, single):
    """Polylines in which the fiblets so marked are one segment, and the index of the point that each vertex was."""
    a, b, _, _, streamline, starts, stops = capsules(fiblets)
    lines = [[] for _ in fiblets.lines]
    index = [[] for _ in fiblets.lines]
    for f, s in enumerate(streamline):
        ends = f + 1 == len(streamline) or streamline[f + 1] != s
        stop = stops[f] + 1 if ends else stops[f]
        if single[f]:
            lines[s].append(a[f : f + 1])
            index[s].append([starts[f]])
            if ends and stops[f] > starts[f]:
                lines[s].append(b[f : f + 1])
                index[s].append([stops[f]])
        else:
            lines[s].append(fiblets.lines[s][starts[f] : stop])
            index[s].append(np.arange(starts[f], stop))
    return [np.concatenate(line) for line in lines], [np.concatenate(i) for i in index]


@pytest.mark.few(3)
@pytest.mark.parametrize("tolerance", [0.5, 2.0])
@pytest.mark.parametrize("view", VIEWS)
def test_pixels_are_those_of_the_simplified_lines(gl, fabricate, random_lines, camera, view, tolerance):
    """Every pixel, as if small and thin fiblets had no points between their ends; places count them evenly."""
    fiblets = fabricate(random_lines(60, seed=41, wander=0.03), kind=3, per_fiblet=9)
    matrix = camera(SIZE, **VIEWS[view])
    single, factor = one_segment(*capsules(fiblets)[:4], matrix, SIZE, tolerance)
    assert (np.abs(factor - 1.0) > 1e-5).all(), "no fiblet may be on the verge"
    lines, index = simplified(fiblets, single)
    picture = draw(gl, fiblets, View(SIZE, matrix), FibletStyle(tolerance=tolerance))
    expected = thin_lines(lines, matrix, SIZE)
    covered = np.isfinite(expected.depth)
    assert (picture.drawn == covered)[expected.clear].all()
    drawn = covered & expected.clear
    assert np.abs(picture.window_depth - expected.depth)[drawn].max() < DEPTH_ROUNDING
    drawn &= expected.alone
    assert drawn.sum() > 50
    assert (picture.ids[..., 0] == expected.streamline)[drawn].all()
    place = [
        np.interp(p, np.arange(len(index[s])), index[s])
        for s, p in zip(expected.streamline[drawn], expected.place[drawn], strict=True)
    ]
    # of a segment of up to nine steps, float32 knows the place to a few parts in a thousand of a pixel
    assert np.abs(picture.position[..., 0][drawn] - place).max() < 5e-3


def distances(points, line):
    """Distance (n,) of points from a polyline (m, 2) in the window."""
    a, b = (line, line) if len(line) == 1 else (line[:-1], line[1:])
    run = b - a
    square = np.maximum((run**2).sum(1), 1e-12)
    t = (((points[:, None] - a) * run).sum(2) / square).clip(0.0, 1.0)
    return np.linalg.norm(points[:, None] - a - t[..., None] * run, axis=2).min(1)


@pytest.mark.parametrize("distance", [130.0, 260.0, 1000.0, 5000.0])
def test_nothing_leads_far_away(gl, camera, distance):
    """No pixel is farther from its streamline than half a pixel, or two of a tiny fiblet, and what pixels take."""
    fiblets = compress(brain_streamlines(150, step=0.4))
    lines = [line.astype(float) for line in fiblets.decompress().to_list()]
    matrix = camera(SIZE, eye=(0, -distance, 0.3 * distance), near=0.2 * distance, far=5 * distance)
    picture = draw(gl, fiblets, View(SIZE, matrix), FibletStyle())
    whole = draw(gl, fiblets, View(SIZE, matrix))
    rows, columns = np.nonzero(picture.drawn)
    streamline = picture.ids[rows, columns, 0]
    worst = 0.0
    for s in np.unique(streamline):
        here = streamline == s
        window = to_window(to_clip(lines[s], matrix), SIZE)[:, :2]
        worst = max(worst, distances(np.c_[columns, rows][here] + 0.5, window).max())
    pixels = SIZE[1] / (2 * np.tan(np.radians(20)) * distance * 1.04)  # of a millimetre, roughly
    tiny = 24.0 * pixels < FAR_SIZE  # every fiblet: 60 steps of 0.4 mm
    assert worst <= OFF_LINE + (FAR_SIZE / 2 if tiny else 0.5)
    assert near(whole.drawn, 3)[picture.drawn].all()
    assert near(picture.drawn, 3)[whole.drawn].all()


@pytest.mark.more
def test_ends_stay_where_they_are(gl, camera):
    """Straight streamlines are one segment however near they are: it must not stick out where they end."""
    rng = np.random.default_rng(1)
    direction = rng.normal(0, 1, (40, 3)) * [1.0, 0.2, 1.0]
    direction[:20] = [1.0, 0.0, 0.0]  # the rounding of such an end vector makes no capsule wider
    direction /= np.linalg.norm(direction, axis=1)[:, None]
    ends = rng.uniform(-3, 3, (40, 3))
    back = [np.arange(n)[::-1, None] * 6.0 for n in rng.integers(8, 31, 40)]
    lines = [end - steps * d for end, steps, d in zip(ends, back, direction, strict=True)]
    fiblets = compress(Streamlines.from_list(lines), max_error=1e-3)
    lines = fiblets.decompress().to_list()
    matrix = camera(SIZE, eye=(0, -300, 0), height=12.0, near=100.0, far=500.0)  # 20 pixels to the millimetre
    picture = draw(gl, fiblets, View(SIZE, matrix), FibletStyle())
    rows, columns = np.nonzero(picture.drawn)
    streamline = picture.ids[rows, columns, 0]
    for s in np.unique(streamline):
        here = streamline == s
        window = to_window(to_clip(lines[s].astype(float), matrix), SIZE)[:, :2]
        assert distances(np.c_[columns, rows][here] + 0.5, window).max() <= OFF_LINE + 0.5


def test_curled_fiblets_are_decoded(gl, fabricate, camera):
    """A fiblet that comes back to where it began is not the point between its ends, unless it is a few pixels large."""
    t = np.linspace(0, 2 * np.pi, 50)
    ring = np.c_[20 * np.cos(t), 0 * t, 20 * np.sin(t)]
    fiblets = fabricate([ring, np.r_[ring[:-1], ring] + [45.0, 0, 0]], kind=3, per_fiblet=60)
    view = View(SIZE, camera(SIZE, eye=(0, -260, 0)))
    assert_same(draw(gl, fiblets, view, FibletStyle()), draw(gl, fiblets, view))
    far = View(SIZE, camera(SIZE, eye=(0, -26000, 0), near=2e4, far=4e4))
    assert 1 <= draw(gl, fiblets, far, FibletStyle()).drawn.sum() <= 2 * FAR_SIZE


def test_streamlines_of_one_point_and_two(gl, fabricate, camera):
    """Fiblets of a single point that end a streamline, and streamlines of one point and two: near and far."""
    rng = np.random.default_rng(4)
    lines = [rng.uniform(-40, 40, 3) + np.cumsum(rng.normal(0, 0.6, (n, 3)), axis=0) for n in [1, 2, 7, 8, 15] * 8]
    fiblets = fabricate(lines, kind=3, per_fiblet=7)
    for distance in (150.0, 600.0, 6000.0):
        matrix = camera(SIZE, eye=(0, -distance, 0), near=distance / 2, far=2 * distance)
        picture = draw(gl, fiblets, View(SIZE, matrix), FibletStyle())
        cells = to_window(to_clip(np.array([line[-1] for line in fiblets.lines]), matrix), SIZE)[:, :2].astype(int)
        assert near(picture.drawn)[cells[:, 1], cells[:, 0]].all(), "every streamline's last point shows"
        steps = np.array([len(line) - 1 for line in lines])
        assert (picture.position[picture.drawn][:, 0] <= steps[picture.ids[picture.drawn][:, 0]]).all()
        assert (picture.position[picture.drawn][:, 0] >= 0.0).all()


@pytest.mark.parametrize("name", ["arc_length", "fa"])
def test_values_of_far_fiblets(gl, random_lines, camera, name):
    """Points are counted as if evenly spread between a fiblet's ends: values are as far off as places are."""
    rng = np.random.default_rng(3)
    brain = brain_streamlines(150, step=0.4)
    fa = np.interp(
        np.arange(len(brain.points)),
        np.arange(0, len(brain.points), 40),
        rng.uniform(0, 1, -(-len(brain.points) // 40)),
    )
    brain = Streamlines(brain.points, brain.offsets, per_point={"fa": fa})
    fiblets = compress(brain, per_point=["fa"])
    lines = [line.astype(float) for line in fiblets.decompress().to_list()]
    matrix = camera(SIZE, eye=(0, -600, 100), near=300.0, far=1000.0, angle=20.0)
    picture = draw(gl, fiblets, View(SIZE, matrix), FibletStyle(1.0, values=name))
    drawn = picture.drawn
    place, value = picture.position[drawn].astype(float).T
    for s in np.unique(picture.ids[drawn][:, 0]):
        here = picture.ids[drawn][:, 0] == s
        line = lines[s]
        if name == "fa":
            truth = fa[brain.offsets[s] : brain.offsets[s + 1]]
        else:
            truth = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))]
        off = np.abs(value[here] - np.interp(place[here], np.arange(len(line)), truth))
        # codes of eight bits; arc length as uneven as the steps within a fiblet are, and an end as rounded as it is
        slip = 0.867 * fiblets.parameters.end_scale
        assert off.max() < (0.5 / 254 + 1e-3 if name == "fa" else uneven(truth) + slip)


def uneven(arc, points=60):
    """How far arc length (n,) strays from even steps between the first points of fiblets and the last point."""
    ends = np.unique(np.r_[np.arange(0, len(arc), points), len(arc) - 1])
    return np.abs(np.interp(np.arange(len(arc)), ends, arc[ends]) - arc).max()
