"""What is measured does not depend on how a set is stored: in memory, exactly, or coded."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest

import pvfiblets as pf
from pvfiblets.query.measures.measures import measure
from pvfiblets.query.measures.table import table

RADIUS = 50.0  # mm


def arcs(step: float, n: int = 1000) -> pf.Streamlines:
    """Arcs of one radius in eight planes."""
    rng = np.random.default_rng(0)
    t = np.arange(n) * step / RADIUS
    circle = RADIUS * np.stack([np.cos(t), np.sin(t), 0 * t], axis=1)
    return pf.Streamlines.from_list([circle @ np.linalg.qr(rng.normal(size=(3, 3)))[0].T for _ in range(8)])


@pytest.mark.parametrize("step", [0.02, 0.1, 0.5])
@pytest.mark.parametrize("exact", [False, True])
def test_curvature_of_arcs_is_that_of_their_circle(step: float, exact: bool) -> None:
    made = pf.compress(arcs(step), exact=exact)
    np.testing.assert_allclose(table(made)["mean_curvature"], 1 / RADIUS, rtol=0.02)
    np.testing.assert_allclose(np.median(measure(made, "curvature").array()), 1 / RADIUS, rtol=0.02)


def test_curvature_hidden_by_a_coarse_bound_warns_with_the_bound_that_shows_it() -> None:
    coarse = pf.compress(arcs(0.1), max_error=0.5)
    with pytest.warns(UserWarning, match=r"points may be 0\.5 mm off.*max_error=0\.01, or exact"):
        table(coarse)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        fine = pf.compress(arcs(0.1), max_error=0.01)
        np.testing.assert_allclose(table(fine)["mean_curvature"], 1 / RADIUS, rtol=0.02)


@pytest.mark.parametrize("exact", [False, True])
def test_density_has_one_grid_however_lines_are_stored(tmp_path: Path, exact: bool) -> None:
    x = np.linspace(0, 40, 401)
    lines = pf.Streamlines.from_list([np.stack([x, np.full(401, 0.1 * i), 0 * x], axis=1) for i in range(6)])
    pf.write(tmp_path / "a.tck", lines)
    plain, stored = pf.density(tmp_path / "a.tck", 2.0), pf.compress(lines, exact=exact).density(2.0)
    np.testing.assert_array_equal(stored.affine, plain.affine)
    np.testing.assert_allclose(stored.values, plain.values, rtol=1e-9)
    assert stored.share_outside == pytest.approx(0.0, abs=1e-12)
