"""Samples of a pixel stand for all of it: at edges of every direction, and by the first few of them."""

from functools import cache

import numpy as np
import pytest

from pvfiblets import antialias
from pvfiblets.engine.effects.sample_positions import CENTRED, MOST, energy_distance, sample_positions


@cache
def lines(tilt):
    """Return random lines, uniform in direction and distance as Crofton's formula counts them, and exact shares.

    Some miss the pixel, and count, too. ``tilt``: degrees that they may lie off the pixel's axes.
    """
    rng = np.random.default_rng(0)
    angle = rng.integers(0, 4, 1500) * np.pi / 2.0 + np.radians(rng.uniform(-tilt, tilt, 1500))
    away = rng.uniform(-0.75, 0.75, 1500)
    normals = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    shares = [half_plane_area(normal, distance) for normal, distance in zip(normals, away, strict=True)]
    return normals, away, np.array(shares)


def edge_error(points, tilt=45.0):
    """Return the root mean square error, in levels of 255, of the share of a pixel on one side of random lines.

    The exact one is that of the pixel's square clipped by the line, by the shoelace formula.
    """
    normals, away, exact = lines(tilt)
    found = (np.asarray(points) @ normals.T < away).mean(axis=0)
    return 255.0 * np.sqrt(((found - exact) ** 2).mean())


def half_plane_area(normal, distance):
    """Return the area of the unit square around 0 where ``p . normal < distance``."""
    corners = np.array([[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]])
    kept = []
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        height, next_height = a @ normal - distance, b @ normal - distance
        if height < 0.0:
            kept.append(a)
        if height * next_height < 0.0:
            kept.append(a + (b - a) * height / (height - next_height))
    if len(kept) < 3:
        return 0.0
    x, y = np.array(kept).T
    return 0.5 * abs(x @ np.roll(y, -1) - y @ np.roll(x, -1))


def grid(side):
    at = (np.arange(side) + 0.5) / side - 0.5
    return np.stack(np.meshgrid(at, at), axis=-1).reshape(-1, 2)


@pytest.mark.parametrize("n", [1, 2, 3, 4, 5, 7, 8, 9, 16, 33, 256])
def test_samples_lie_in_the_pixel_around_its_middle(n):
    points = np.array(sample_positions(n))
    assert points.shape == (n, 2)
    assert np.abs(points).max() <= 0.5
    assert len(np.unique(points, axis=0)) == n
    assert np.abs(points.mean(axis=0)).max() < 0.002  # or the picture would be moved
    assert (tuple(points[-1]) == (0.0, 0.0)) or 1 < n < CENTRED
    assert sample_positions(n) is sample_positions(n)


def test_the_energy_distance_is_the_error_at_edges():
    """Crofton's formula: their ratio is the same for any points."""
    rng = np.random.default_rng(1)
    sets = [sample_positions(4), sample_positions(16), grid(3), rng.uniform(-0.5, 0.5, (6, 2)), [(0.0, 0.0)]]
    ratios = [edge_error(points) ** 2 / energy_distance(points) for points in sets]
    np.testing.assert_allclose(ratios, np.mean(ratios), rtol=0.12)
    assert energy_distance(grid(40)) < 1e-3


def test_more_samples_are_better_than_fewer_than_grids_and_than_random_ones():
    rng = np.random.default_rng(2)
    rotated = np.array([[-1, -3], [3, -1], [1, 3], [-3, 1]]) / 8.0
    assert edge_error(sample_positions(4)) < 1.02 * edge_error(rotated)
    assert edge_error(sample_positions(16)) < 1.02 * edge_error(grid(4))
    for n in (4, 8, 16, 64):
        at_random = np.mean([edge_error(rng.uniform(-0.5, 0.5, (n, 2))) for _ in range(5)])
        assert edge_error(sample_positions(n)) < 0.6 * at_random
    # A grid of 16 has four levels at edges along its axes.
    assert edge_error(sample_positions(16), tilt=3.0) < 0.75 * edge_error(grid(4), tilt=3.0)
    errors = [edge_error(sample_positions(n)) for n in (1, 2, 4, 8, 16, 32, 64, 128, 256)]
    assert errors == sorted(errors, reverse=True)
    assert errors[-1] < 1.5
    whole = sample_positions(16)
    for k in (4, 8, 12):
        assert edge_error(whole[:k]) < 1.5 * edge_error(sample_positions(k))
    assert antialias.MOST == MOST
    assert antialias.samples_of("refined") >= CENTRED


@pytest.mark.parametrize("n", [0, -1, MOST + 1])
def test_other_numbers_are_refused(n):
    with pytest.raises(ValueError, match=f"the number of samples is {n}; give one from 1 to 256"):
        sample_positions(n)
