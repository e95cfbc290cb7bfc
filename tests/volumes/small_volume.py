"""A small oblique volume that tests of sources write in every format and read again."""

from __future__ import annotations

import numpy as np
import pyvista as pv

SHAPE = (3, 4, 5)
VALUES = np.random.default_rng(3).integers(-300, 300, SHAPE).astype(np.int16)
AXES = np.linalg.qr(np.random.default_rng(4).normal(size=(3, 3)))[0]  # columns: an oblique frame
SPACING = np.array([2.0, 0.5, 1.25])
ORIGIN = np.array([10.0, -20.0, 30.0])
AFFINE = np.eye(4)  # RAS+
AFFINE[:3, :3], AFFINE[:3, 3] = AXES * SPACING, ORIGIN


def image(**extra):
    """The volume as PyVista has it."""
    grid = pv.ImageData(dimensions=SHAPE, spacing=SPACING, origin=ORIGIN, direction_matrix=AXES)
    grid["ct"] = VALUES.ravel(order="F")
    for name, values in extra.items():
        grid[name] = values
    return grid


def assert_is_the_volume(volume, name=None, atol=1e-12):
    np.testing.assert_array_equal(volume.values, VALUES)
    np.testing.assert_allclose(volume.affine, AFFINE, atol=atol)
    if name is not None:
        assert volume.name == name
