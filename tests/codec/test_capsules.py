"""The capsules that culling goes by hold all that is drawn, and little more."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import pvfiblets as pf
from pvfiblets import synthetic
from pvfiblets.codec import capsules, layout
from pvfiblets.codec.kernels import capsule_kernels
from pvfiblets.streamlines import Streamlines

from .samples import extremes, noisy, smooth, wandering


def chord_distances(points, a, b):
    """Distances from the segment ab by cases: beside it a height of a triangle, else the distance from an end."""
    length = np.linalg.norm(b - a)
    from_a, from_b = np.linalg.norm(points - a, axis=1), np.linalg.norm(points - b, axis=1)
    nearest = np.minimum(from_a, from_b)
    if length == 0:
        return nearest
    along = (points - a) @ ((b - a) / length)
    beside = (along > 0) & (along < length)
    height = np.linalg.norm(np.cross(points - a, (b - a) / length), axis=1)
    return np.where(beside, height, nearest)


def assert_capsules_are_right(fiblets):
    points = fiblets.decompress(dtype=np.float64).points
    slack = 32 * np.spacing(np.abs(points).max(initial=0.0))  # the origin has been added
    starts, counts = fiblets.fiblet_points(), fiblets.fiblet_counts()
    end, ranks = layout.unpack("end", fiblets.anchors), fiblets.fiblet_ranks()
    assert fiblets.ends.shape == (fiblets.n_ranks,)
    assert fiblets.end_scale > 0
    vectors = layout.unpack_ends(fiblets.ends) * fiblets.end_scale
    spheres = [0.0]
    for f in range(fiblets.n_fiblets):
        mine = points[starts[f] : starts[f] + counts[f]]
        a = mine[0]
        if end[f]:
            b = a + vectors[ranks[f]]
            assert np.abs(b - mine[-1]).max() <= 0.5 * fiblets.end_scale * (1 + 1e-6) + slack, "rounded, not cut off"
        else:
            b = points[starts[f + 1]]
        radius = fiblets.reach[f] * fiblets.reach_scale
        needed = chord_distances(mine, a, b).max()
        assert needed <= radius + slack
        arc = np.linalg.norm(np.diff(np.concatenate([mine, b[None]]), axis=0), axis=1).sum()
        assert radius <= needed + fiblets.reach_scale * (1 + 1e-6) + 2.0**-16 * arc + slack, "tight"
        spheres.append(0.5 * np.linalg.norm(b - a) + radius)
    assert max(spheres) - slack <= fiblets.largest_radius <= max(spheres) * (1 + 1e-6) + slack


@pytest.mark.few(11)
@pytest.mark.parametrize("effort", ["fast", "high", "small"])
@pytest.mark.parametrize("name", extremes())
def test_capsules_hold_extreme_lines(name, effort):
    assert_capsules_are_right(pf.compress(extremes()[name], effort=effort))


def test_capsules_hold_lines_of_all_kinds():
    lines = Streamlines.concatenate([smooth(10, 130), noisy(10, 130), wandering(10, 130)])
    fiblets = pf.compress(lines)
    assert len(np.unique(layout.unpack("kind", fiblets.decoding))) > 1
    assert_capsules_are_right(fiblets)
    assert_capsules_are_right(pf.compress(lines, max_error=1e-7))  # 32-bit anchors


@pytest.mark.more
@settings(max_examples=40)
@given(st.data())
def test_capsules_hold_any_lines(data):
    rng = np.random.default_rng(data.draw(st.integers(0, 2**32 - 1)))
    counts = data.draw(st.lists(st.integers(0, 150), min_size=1, max_size=5))
    scale = 10.0 ** data.draw(st.floats(-6, 6))
    steps = np.exp(data.draw(st.floats(0, 2)) * rng.normal(size=(sum(counts), 1)))
    points = scale * np.cumsum(steps * rng.normal(size=(sum(counts), 3)), axis=0)
    points += scale * data.draw(st.sampled_from([0.0, 1e3, -1e5]))
    assert_capsules_are_right(pf.compress(Streamlines(points, np.concatenate([[0], np.cumsum(counts)]))))


def test_capsules_of_tracking_are_slim():
    """The volume that culling must take for full, beside that of spheres about the chords' middles."""
    fiblets = pf.compress(synthetic.brain_streamlines(500, 0.5))
    points, starts = fiblets.decompress().points, fiblets.fiblet_points()
    full = np.flatnonzero((layout.unpack("end", fiblets.anchors) == 0) & (fiblets.fiblet_counts() == 60))
    chords = np.linalg.norm(points[starts[full + 1]] - points[starts[full]], axis=1)
    radius = fiblets.reach[full] * fiblets.reach_scale
    capsule = np.pi * radius**2 * (chords + 4 / 3 * radius)
    assert np.median(radius / chords) < 0.08
    assert np.median(capsule / (np.pi / 6 * chords**3)) < 0.04


def test_kernels_compute_what_the_reference_says():
    rng = np.random.default_rng(0)
    for n in (1, 2, 3, 60):
        points = np.cumsum(rng.normal(size=(n, 3)), axis=0)
        for b in (points[-1] + rng.normal(size=3), points[0].copy()):
            assert capsule_kernels.capsule_radius(points, 0, n, *b) == pytest.approx(capsules.capsule_radius(points, b))
            np.testing.assert_allclose(
                capsules.distances(points, points[0], b), chord_distances(points, points[0], b), atol=1e-12
            )
    for vector in rng.normal(size=(50, 3)):
        levels = np.rint(vector / 0.01)
        word = capsule_kernels.end_word(*vector, 0.01)
        assert word == layout.pack_ends(levels)[0]
        assert [capsule_kernels.end_part(word, axis) for axis in range(3)] == levels.tolist()
