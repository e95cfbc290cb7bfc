"""The made-up sets of lines and points are of the sizes and kinds that they are named after."""

import functools

import numpy as np
import pytest

from pvfiblets.halos import HaloLines, HaloPoints
from pvfiblets.synthetic.halos import HALO_SETS, SLICE, halo_set

PAPER = {"shape-small": (None, 172973), "fibres-subset": (11306, 260836), "office": (786, 278849),
         "shape-large": (None, 437645), "fibres": (150352, 1625472), "water": (1400, 2603605),
         "terrain": (None, 4440900), "water-dense": (4475, 7910911)}  # fmt: skip  # Everts et al. 2009, table 1
VALUES = {"fibres-subset": "fa", "fibres": "fa", "office": "speed", "water": "speed", "water-dense": "speed"}


@pytest.fixture(scope="module")
def made():
    """Return a function that makes each set once."""
    return functools.cache(halo_set)


def beginning(lines, points=200_000):
    """Return the first lines, of about so many points."""
    n = int(np.searchsorted(lines.offsets, points))
    n = min(n, lines.n_lines)
    end = lines.offsets[n]
    return HaloLines(lines.points[:end], lines.offsets[: n + 1], {key: v[:end] for key, v in lines.values.items()})


def within(lines):
    """Return which neighbouring points belong to one line."""
    same = np.ones(lines.n_points - 1, bool)
    same[lines.offsets[1:-1] - 1] = False
    return same


@pytest.mark.few(1)
@pytest.mark.parametrize("name", HALO_SETS)
def test_sizes_are_the_papers(name, made):
    drawn = made(name)
    n_lines, n_points = PAPER[name]
    assert drawn.n_points == n_points
    assert isinstance(drawn, HaloPoints if n_lines is None else HaloLines)
    if n_lines is not None:
        assert drawn.n_lines == n_lines
        assert np.diff(drawn.offsets).min() >= 2


@pytest.mark.parametrize("name", HALO_SETS)
def test_all_is_finite_and_can_be_filtered(name, made):
    drawn = made(name)
    assert drawn.points.dtype == np.float32
    assert np.isfinite(drawn.points).all()
    ((key, values),) = drawn.values.items()
    assert key == VALUES.get(name, "height")
    assert values.dtype == np.float32
    assert np.isfinite(values).all()
    assert values.min() >= 0.0
    assert np.percentile(values[::20], 95) > 1.5 * np.percentile(values[::20], 5)


@pytest.mark.parametrize("name", VALUES)
def test_lines_are_followed_by_even_steps_along_which_numbers_change_little(name, made):
    lines = beginning(made(name))
    there = within(lines)
    lengths = np.linalg.norm(np.diff(lines.points.astype(np.float64), axis=0), axis=1)[there]
    expected = {"office": 45.0, "water": 3.0, "water-dense": 3.0}.get(name, 2.5)
    assert np.median(lengths) == pytest.approx(expected, rel=0.01)
    assert lengths.min() > 0.5 * expected
    assert lengths.max() < 1.05 * expected
    ((_, values),) = made(name).values.items()
    assert values.max() <= 1.0
    assert np.percentile(abs(np.diff(values[: lines.n_points])[there]), 90) < 0.1  # so that filters end lines well


def test_flows_stay_in_their_box_and_swirl(made):
    air = made("office")
    low, high = np.array(air.bounds).reshape(3, 2).T
    sides = np.array([6000.0, 4000.0, 3000.0])
    assert (low >= 0.0).all()
    assert (high <= sides).all()
    assert (high - low > 0.95 * sides).all()
    # Lines turn right round rather than going through the room: their ends are near for their lengths.
    counts = np.diff(air.offsets)
    between = np.linalg.norm(air.points[air.offsets[1:] - 1] - air.points[air.offsets[:-1]], axis=1)
    assert np.median(between / (45.0 * (counts - 1))) < 0.4


def test_both_sets_of_water_show_one_flow(made):
    directions = []
    for lines in (beginning(made("water"), 800_000), beginning(made("water-dense"), 800_000)):
        # Steps of lines in the same cells of the tank go the same way.
        inside = within(lines)
        cell = (lines.points[:-1][inside] // 25.0).astype(int) @ [1, 40, 800]
        way = np.diff(lines.points, axis=0)[inside]
        directions.append(np.stack([np.bincount(cell, way[:, i], minlength=16000) for i in range(3)], axis=1))
    size = np.linalg.norm(directions, axis=2)
    both = (size > 300.0).all(axis=0)
    assert both.sum() > 500
    first, second = (way[both] / length[both, None] for way, length in zip(directions, size, strict=True))
    assert np.median(np.einsum("ij,ij->i", first, second)) > 0.98


def test_the_subset_crosses_its_slice(made):
    fibres = made("fibres-subset")
    right = fibres.points[:, 0] > SLICE
    begins = fibres.offsets[:-1]
    crossing = np.logical_or.reduceat(right, begins) & ~np.logical_and.reduceat(right, begins)
    # They were chosen before each was moved by some millimetres.
    assert crossing.mean() > 0.8
    assert made("fibres").bounds[0] < -60.0  # the whole brain, both halves


def test_points_lie_evenly_on_surfaces(made):
    shape, land = made("shape-small"), made("terrain")
    # Neighbours in memory are neighbours in space, as a scan has them.
    for points in (shape.points, land.points):
        jump = np.linalg.norm(np.diff(points[:20000].astype(float), axis=0), axis=1)
        assert np.median(jump) < 0.03 * np.ptp(points, axis=0).max()
    square = np.minimum(land.points[:, :2] // 1e4, 99).astype(int) @ [1, 100]  # of 10 m
    np.testing.assert_allclose(np.bincount(square, minlength=10000), land.n_points / 1e4, rtol=0.05)
    # On the sphere of directions a shape's radius has one value: a closed surface around its middle.
    radius = np.linalg.norm(shape.points, axis=1)
    assert radius.min() > 40.0
    assert radius.max() < 160.0


@pytest.mark.few(1)
@pytest.mark.parametrize("name", ["shape-small", "fibres-subset", "office"])
def test_a_seed_fixes_every_number(name):
    first, again, other = halo_set(name, 3), halo_set(name, 3), halo_set(name, 4)
    np.testing.assert_array_equal(first.points, again.points)
    for key, values in first.values.items():
        np.testing.assert_array_equal(values, again.values[key])
    if isinstance(first, HaloLines):
        np.testing.assert_array_equal(first.offsets, again.offsets)
    assert not np.array_equal(first.points, other.points)
