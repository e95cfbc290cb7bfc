"""The polydata that VTK believes it draws: its bounds are right, and no VTK leaves its triangles out."""

from __future__ import annotations

import numpy as np
import pytest

from pvfiblets.mappers.proxy import proxy_polydata

BOUNDS = {
    "plain": (-1, 2, -3, 4, -5, 6),
    "far away": (1e6, 1e6 + 10, 1e6, 1e6 + 20, -1e6, -1e6 + 5),
    "tiny": (0, 1e-6, 0, 2e-6, 0, 3e-6),
    "flat": (0, 10, 0, 10, 3, 3),
    "one point": (7, 7, 8, 8, 9, 9),
    "at the origin": (0, 0, 0, 0, 0, 0),
}


@pytest.mark.parametrize("name", BOUNDS)
def test_vertices_differ_and_keep_the_bounds(name: str) -> None:
    """VTK before 9.7 drops triangles of coinciding vertices, and with them the whole picture."""
    bounds = np.array(BOUNDS[name], dtype=float)
    proxy = proxy_polydata(bounds)
    points = np.array([proxy.GetPoint(i) for i in range(6)])
    for triangle in (points[:3], points[3:]):
        assert len(np.unique(triangle, axis=0)) == 3
    size = max(np.ptp(bounds.reshape(3, 2), axis=1).max(), 1e-9 * np.abs(bounds).max())
    np.testing.assert_allclose(proxy.GetBounds(), bounds, rtol=0, atol=1e-5 * size + 1e-11)
    assert proxy.GetNumberOfCells() == 2


def test_layers_repeat_its_triangles_and_nothing_to_draw_is_empty() -> None:
    assert proxy_polydata(None).GetNumberOfCells() == 0
    one, many = proxy_polydata(BOUNDS["plain"]), proxy_polydata(BOUNDS["plain"], 5)
    np.testing.assert_allclose(many.GetBounds(), one.GetBounds())
    assert many.GetNumberOfCells() == 10
    assert [many.GetPoint(i) for i in range(30)] == [one.GetPoint(i % 6) for i in range(30)]
