"""The made-up tube sets are of the sizes and kinds that they are named after."""

import time

import numpy as np
import pytest

from pvfiblets.synthetic import TUBE_SETS, tube_set

PAPER = {
    "fibers": (241, 3530),
    "hotroom": (722, 30948),
    "bundle": (1250, 105640),
    "brain": (1701, 114489),
    "furball": (10000, 787327),
}  # Russig et al. 2020, section 4


@pytest.fixture(scope="module", params=TUBE_SETS)
def made(request):
    began = time.process_time()
    tubes = tube_set(request.param)
    return request.param, tubes, time.process_time() - began


def test_sizes_are_the_papers(made):
    name, tubes, seconds = made
    assert (tubes.n_tubes, tubes.n_segments) == PAPER[name]
    # Each tube has segments, one after the other.
    assert np.bincount(tubes.tubes, minlength=tubes.n_tubes).min() >= 5
    inner = tubes.tubes[1:] == tubes.tubes[:-1]
    np.testing.assert_array_equal(tubes.segments[1:, 0][inner], tubes.segments[:-1, 1][inner])
    assert tubes.n_nodes == tubes.n_segments + tubes.n_tubes
    assert seconds < 5.0  # the largest takes 0.7 s


def test_shapes_are_fit_to_be_drawn(made):
    name, tubes, _ = made
    assert tubes.scaled
    assert tubes.radius.min() > 0
    assert tubes.lengths().min() > 0
    value = tubes.values["value"].values
    assert value.min() >= 0
    assert value.max() <= 1
    assert np.ptp(value) > 0.4
    same = np.ptp(tubes.radius) == 0
    assert same == (name == "brain")
    if not same:
        first = np.flatnonzero(np.diff(tubes.tubes, prepend=-1))
        least = np.minimum.reduceat(tubes.radius[tubes.segments[:, 0]], first)
        assert np.all(np.maximum.reduceat(tubes.radius[tubes.segments[:, 0]], first) > 1.05 * least)
    bounds = np.array(tubes.bounds).reshape(3, 2)
    assert np.median(tubes.radius) < 0.05 * np.ptp(bounds, axis=1).max()


def test_the_hot_rooms_segments_are_much_shorter_than_its_radii():
    tubes = tube_set("hotroom")
    proportion = tubes.lengths() / tubes.radius[tubes.segments].mean(axis=1)
    assert np.median(proportion) < 0.6
    # Some start in a ball of dozens of segments: all their nodes lie within the first one's radius.
    owner = np.zeros(tubes.n_nodes, int)
    owner[tubes.segments] = tubes.tubes[:, None]
    start = tubes.segments[np.searchsorted(tubes.tubes, np.arange(tubes.n_tubes)), 0]
    inside = np.linalg.norm(tubes.points - tubes.points[start[owner]], axis=1) < tubes.radius
    assert np.mean(np.bincount(owner, inside) >= 20) > 0.3
    assert np.median(tube_set("fibers").lengths()) > 5 * np.median(tube_set("fibers").radius)


@pytest.mark.parametrize("name", ["fibers", "hotroom", "bundle", "brain"])
def test_a_seed_fixes_every_number(name):
    first, again, other = tube_set(name, 3), tube_set(name, 3), tube_set(name, 4)
    for part in ("points", "segments", "radius", "tangents", "radius_slopes"):
        np.testing.assert_array_equal(getattr(first, part), getattr(again, part))
    assert not np.array_equal(first.points, other.points)
