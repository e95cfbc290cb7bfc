"""Integer vectors are drawn by magnitude, and no exposure turns white black."""

from __future__ import annotations

import numpy as np
import pytest

from pvfiblets.plotting.colours.scalars import are_colours


@pytest.mark.parametrize("kind", ["int16", "int64", "uint16", "float64"])
@pytest.mark.parametrize("add", ["add_fiblets", "add_halo_lines", "add_spline_tubes"])
def test_vectors_of_any_type_are_mapped_by_their_magnitude(plotter, add, kind):
    x = np.arange(30)
    line = np.c_[x, 0 * x, 0 * x].astype(float)
    vectors = np.c_[3 * x, 4 * x, 0 * x].astype(kind)
    widths = {"add_halo_lines": {"line_width": 1.0, "strip_width": 2.0}, "add_spline_tubes": {"radius": 1.0}}
    actor = getattr(plotter, add)([line], scalars=vectors, **widths.get(add, {}))
    assert actor.clim == pytest.approx((0.0, 145.0))


def test_bytes_are_colours():
    assert are_colours(np.zeros((3, 3), np.uint8), None)
    assert are_colours(np.zeros((3, 3), np.int64), True)
    assert not are_colours(np.zeros((3, 3), np.int64), None)
