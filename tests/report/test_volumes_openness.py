"""How open a surface is, exactly: what few rays are compared with."""

from __future__ import annotations

import numpy as np
import pytest

from pvfiblets.engine.volumes.ray_occlusion import LIFT
from pvfiblets.report.volumes_openness import exact_openness, seen_from
from pvfiblets.volumes import RaycastVolume, reference


def test_the_reference_is_that_of_a_ball():
    """Chords in a ball of radius r, from a little off its wall, that are shorter than R."""
    x = np.arange(33) - 16.0
    field = np.sqrt(x[:, None, None] ** 2 + x[:, None] ** 2 + x**2).astype(np.float32)
    affine = np.eye(4)
    affine[:3, 3] = -16.0
    volume = RaycastVolume(field, affine)
    matrix = seen_from(volume, (8, 8), (0.3, -1.0, 0.2))
    ways = np.random.default_rng(0).normal(size=(6, 3))
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    through = reference.Rays(np.zeros((6, 3)), ways, np.zeros(6), np.full(6, 16.0), matrix)
    hits = reference.isosurface(volume, 12.0, through)
    found = exact_openness(volume, 12.0, through, hits.gradient, hits.t, 9.0)
    start = 12.0 - LIFT
    least = (9.0**2 - 12.0**2 + start**2) / (2 * 9.0 * start)
    assert found == pytest.approx(1.0 - least**2, abs=0.01)
