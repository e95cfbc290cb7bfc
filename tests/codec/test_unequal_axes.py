"""Sets whose axes have different units: what is promised shows in no view along an axis."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import pvfiblets as pf
from pvfiblets import formats


def walks(scale: tuple[float, float, float]) -> pf.Streamlines:
    """Random walks, of each axis scaled."""
    rng = np.random.default_rng(0)
    walk = [np.cumsum(rng.normal(0, 1, (200, 3)), axis=0) + rng.normal(0, 100, 3) for _ in range(40)]
    return pf.Streamlines.from_list([points * scale for points in walk])


@pytest.mark.parametrize("scale", [(4e-5, 4e-5, 1.0), (1e3, 1.0, 1e3), (1.0, 1.0, 1.0)])
def test_no_point_moves_by_half_a_pixel_or_a_tenth_of_a_step_in_a_view_along_an_axis(
    tmp_path: Path, scale: tuple[float, float, float]
) -> None:
    lines = walks(scale)
    coded = pf.compress(lines, exact=False)
    true, drawn = lines.points, coded.decompress(dtype=np.float64).points
    for axis, name in enumerate("xyz"):
        seen = [i for i in range(3) if i != axis]
        moved = np.linalg.norm((drawn - true)[:, seen], axis=1).max()
        pixel = np.linalg.norm(np.ptp(true[:, seen], axis=0)) / 2000
        steps = np.linalg.norm(np.diff(true[:, seen], axis=0).reshape(-1, 2), axis=1)
        assert moved <= 0.5 * pixel
        assert moved <= 0.1 * np.median(steps) * 1.3  # views of equal axes shorten steps a little
        coded.save(tmp_path / "a.fiblets")
        said = formats.info(tmp_path / "a.fiblets")["promise_pixels"][f"along_{name}"]
        assert moved / pixel <= said <= 0.5 + 1e-9
