"""Lines in memory are asked as compressed ones are: regions by NumPy and by dense samples, measures by formulas."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from pvfiblets import Streamlines, regions
from pvfiblets.query.measures.measures import Distance, measure, measure_names
from pvfiblets.query.selection.line_flags import line_flags
from pvfiblets.query.selection.predicates import ends_in, passes, select, stays_in
from tests.engine.region_shapes import made
from tests.query.test_passing import expected_flags

SHAPES = [name for name in made() if "label" not in name and "voxel" not in name]


@pytest.fixture(scope="module")
def lines():
    """Crooked lines of a unit box, some without points or with one."""
    rng = np.random.default_rng(2)
    parts = [rng.normal(0.0, 0.12, (n, 3)).cumsum(axis=0) + rng.uniform(-0.3, 0.3, 3) for n in rng.integers(2, 9, 200)]
    parts[3], parts[50], parts[199] = np.zeros((0, 3)), np.array([[0.05, 0.0, 0.02]]), np.zeros((0, 3))
    return Streamlines.from_list(parts)


def samples(lines, count=200):
    """Each line with so many places on each of its segments."""
    dense = []
    for line in lines:
        share = np.linspace(0.0, 1.0, count)[:, None]
        steps = [a + share * (b - a) for a, b in pairwise(line)]
        dense.append(np.concatenate(steps) if steps else line)
    return Streamlines.from_list(dense)


@pytest.mark.parametrize("name", SHAPES)
def test_points_are_those_of_numpy_and_segments_those_of_dense_samples(lines, name):
    region = made()[name]
    by_points = line_flags(lines.points, lines.offsets, region, "points")
    np.testing.assert_array_equal(by_points, expected_flags(lines.points, lines.offsets, region.contains))
    found = line_flags(lines.points, lines.offsets, region)
    dense = samples(lines)
    expected = expected_flags(dense.points, dense.offsets, region.contains)
    np.testing.assert_array_equal(found & 12, expected & 12)
    # Samples may step over a corner that a segment just touches, and over no more.
    assert not (expected & ~found & 1).any()
    assert not (found & ~expected & 2).any()
    assert ((found ^ expected) & 3 != 0).sum() <= 2
    assert 0 < (found & 1).sum() < len(lines)


def test_conditions_hold_as_for_the_compressed_set(lines):
    from pvfiblets import compress

    coded = compress(lines, exact=True)
    ball, box = regions.Sphere((0.1, 0.0, 0.0), 0.2), regions.Box(center=(0.0, 0.1, 0.0), size=0.3)
    for condition in (passes(ball) & ~ends_in(box), stays_in(ball | box) | ends_in(ball, "both"), ~passes(box)):
        decoded = coded.decompress(dtype=np.float64)
        np.testing.assert_array_equal(select(decoded, condition), select(coded, condition))
    with pytest.raises(ValueError, match="a mask of streamlines has the shape"):
        select(lines, regions.passes(ball) & _mask(3))


def _mask(count):
    from pvfiblets.query.selection.predicates import Listed

    return Listed(np.ones(count, bool))


def test_measures_are_formulas(lines):
    lines.per_point = {"fa": np.linspace(0.0, 1.0, lines.n_points), "rgb": np.zeros((lines.n_points, 3))}
    lines.per_streamline = {"w": np.arange(200.0)}
    steps = [np.linalg.norm(np.diff(line, axis=0), axis=1) for line in lines]
    np.testing.assert_allclose(measure(lines, "length").array(), [step.sum() for step in steps], rtol=1e-12)
    np.testing.assert_array_equal(measure(lines, "n_points").array(), lines.counts)
    apart = [np.linalg.norm(line[-1] - line[0]) if len(line) else np.nan for line in lines]
    np.testing.assert_allclose(measure(lines, "end_distance").array(), apart)
    along = np.concatenate([np.r_[0.0, step.cumsum()] for step, line in zip(steps, lines, strict=True) if len(line)])
    np.testing.assert_allclose(measure(lines, "arc_length").array(), along, rtol=1e-6)
    curvature = measure(lines, "mean_curvature").array()
    np.testing.assert_array_equal(np.isnan(curvature), lines.counts == 0)
    np.testing.assert_array_equal(measure(lines, "fa").array(), lines.per_point["fa"])
    np.testing.assert_array_equal(measure(lines, "w").array(), np.arange(200.0))
    np.testing.assert_array_equal(measure(lines, np.arange(lines.n_points)).array(), np.arange(lines.n_points))
    place = np.array([0.1, 0.2, 0.0])
    away = np.linalg.norm(lines.points - place, axis=1)
    np.testing.assert_allclose(measure(lines, Distance(place, "point")).array(), away, rtol=1e-6)
    least = [away[a:b].min() if b > a else np.nan for a, b in zip(lines.offsets[:-1], lines.offsets[1:], strict=True)]
    np.testing.assert_allclose(measure(lines, Distance(place)).array(), least)
    assert "coding_error" not in measure_names(lines)
    assert "rgb" not in measure_names(lines)
    for name in ("coding_error", "rgb", "nothing"):
        with pytest.raises(KeyError, match="there are length, n_points"):
            measure(lines, name)


def test_a_circle_has_its_curvature():
    angles = np.linspace(0.0, np.pi, 181)
    circle = Streamlines.from_list([np.c_[5.0 * np.cos(angles), 5.0 * np.sin(angles), 0.0 * angles]])
    np.testing.assert_allclose(measure(circle, "curvature").array(), 0.2, rtol=1e-3)
