"""Per-point values in the G-buffer against NumPy on the decoded points."""


import numpy as np
import pytest

from pvfiblets.codec.point_values import PointValues, linear_table
from pvfiblets.engine import FibletRenderer, FibletStyle, View

from .pictures import SIZE, read


def arc_length(line):
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])


def curvature(line):
    """Angle between neighbouring segments over half their joint length; ends copy; fewer than three points: 0."""
    values = np.zeros(len(line))
    for i in range(1, len(line) - 1):
        a, b = line[i] - line[i - 1], line[i + 1] - line[i]
        la, lb = np.linalg.norm(a), np.linalg.norm(b)
        if la > 0 and lb > 0:
            values[i] = np.arccos(np.clip(a @ b / la / lb, -1, 1)) / ((la + lb) / 2)
    if len(line) > 2:
        values[0], values[-1] = values[1], values[-2]
    return values


def draw_values(gl, fiblets, matrix, name, *, tolerance=0.0, **limits):
    """Streamline, place and value of every drawn pixel, and the renderer's range."""
    renderer = FibletRenderer(gl, fiblets, **limits)
    picture = read(renderer.render(View(SIZE, matrix), FibletStyle(1.0, values=name, tolerance=tolerance)))
    found_range = renderer.value_range(name)
    renderer.release()
    drawn = picture.drawn
    place, value = picture.position[drawn].astype(float).T
    return picture.ids[drawn][:, 0], place, value, found_range


def interpolated(values, place):
    i = np.minimum(place.astype(int), max(len(values) - 2, 0))
    j = np.minimum(i + 1, len(values) - 1)
    return values[i] + (place - i) * (values[j] - values[i])


@pytest.mark.few(2)
@pytest.mark.every("value")
@pytest.mark.parametrize("per_fiblet", [1, 2, 7, 60])
@pytest.mark.parametrize(("name", "truth"), [("arc_length", arc_length), ("curvature", curvature)])
def test_built_in_values(gl, fabricate, random_lines, camera, name, truth, per_fiblet):
    fiblets = fabricate(random_lines(60, seed=21), kind=2, per_fiblet=per_fiblet)
    streamline, place, value, found_range = draw_values(gl, fiblets, camera(SIZE), name)
    expected = [truth(line) for line in fiblets.lines]
    for s in np.unique(streamline):
        here = streamline == s
        assert np.abs(value[here] - interpolated(expected[s], place[here])).max() < 2e-3 * max(1.0, np.max(expected[s]))
    every = np.concatenate(expected)
    assert np.allclose(found_range, (every.min(), every.max()), rtol=1e-3, atol=1e-3)


@pytest.mark.few(1)
@pytest.mark.every("value")
@pytest.mark.parametrize("name", ["arc_length", "curvature"])
@pytest.mark.parametrize("tolerance", [0.0, 0.5])
def test_built_in_values_across_chunks(gl, fabricate, camera, name, tolerance):
    t = np.linspace(0, 60, 40000)
    line = np.stack([50 * np.cos(t), 50 * np.sin(t * 1.1), t - 30], axis=1)
    fiblets = fabricate([line], kind=2, per_fiblet=2)
    whole = draw_values(gl, fiblets, camera(SIZE), name, tolerance=tolerance)
    pieces = draw_values(gl, fiblets, camera(SIZE), name, tolerance=tolerance, max_buffer_bytes=12 * 16385)
    for a, b in zip(whole, pieces, strict=True):
        assert np.allclose(a, b, rtol=1e-5, atol=1e-4)


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_stored_values(gl, fabricate, random_lines, camera, dtype):
    fiblets = fabricate(random_lines(60, seed=22), kind=2, per_fiblet=7)
    rng = np.random.default_rng(5)
    top = np.iinfo(dtype).max
    codes = rng.integers(0, top, fiblets.n_points).astype(dtype)
    fiblets.per_point["fa"] = PointValues(codes, -2.0, 3.0, 0.0, table=linear_table(-2.0, 3.0, 8 * codes.itemsize))
    streamline, place, value, found_range = draw_values(gl, fiblets, camera(SIZE), "fa")
    truth = -2.0 + 5.0 * codes / (top - 1)
    starts = np.cumsum([0] + [len(line) for line in fiblets.lines])
    for s in np.unique(streamline):
        here = streamline == s
        assert np.abs(value[here] - interpolated(truth[starts[s] : starts[s + 1]], place[here])).max() < 2e-3
    assert found_range == (-2.0, 3.0)


def test_values_that_are_not_numbers_stay_so(gl, fabricate, random_lines, camera):
    lines = random_lines(40, seed=23)
    fiblets = fabricate(lines, kind=2, per_fiblet=7)
    missing = np.concatenate([np.full(len(line), s % 2) for s, line in enumerate(lines)])
    codes = np.where(missing, 255, 100).astype(np.uint8)
    fiblets.per_point["fa"] = PointValues(codes, 0.0, 1.0, 0.0, table=linear_table(0.0, 1.0, 8))
    streamline, _, value, _ = draw_values(gl, fiblets, camera(SIZE), "fa")
    assert (np.isnan(value) == (streamline % 2 == 1)).all()
