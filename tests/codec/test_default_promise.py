"""What is promised where nobody says: a tenth of the step, and no more than shows where lines are coarse or uneven."""

import numpy as np
import pytest

import pvfiblets as pf
from pvfiblets.codec.layout import DIRECTION, unpack
from pvfiblets.streamlines import Streamlines

from .samples import smooth, wandering


def diagonal(lines: Streamlines) -> float:
    """Of the bounds as seen along the axis that has the least."""
    extent = np.ptp(np.asarray(lines.points, np.float64), axis=0)
    return float(min(np.linalg.norm(np.delete(extent, axis)) for axis in range(3)))


@pytest.mark.parametrize("step", [0.1, 0.5, 2.0])
def test_constant_steps_keep_their_byte(step):
    lines = smooth(40, 150, step)
    fiblets = pf.compress(lines)
    assert fiblets.promise == pytest.approx(0.1 * step, rel=1e-6)
    assert (unpack("kind", fiblets.decoding) == DIRECTION).all()


def test_varying_steps_err_by_half_a_pixel_at_most():
    lines = wandering(60, 40)
    coarse = Streamlines(np.concatenate([lines.points * 10.0, [[-5000.0] * 3, [5000.0] * 3]]), [*lines.offsets, 2402])
    for made, extent_rules in ((lines, True), (coarse, False)):
        steps = np.concatenate([np.linalg.norm(np.diff(line, axis=0), axis=1) for line in made])
        promise = pf.compress(made).promise
        expected = diagonal(made) / 4000.0 if extent_rules else 0.1 * np.median(steps)
        assert promise == pytest.approx(expected, rel=1e-9)
        assert promise <= min(diagonal(made) / 4000.0, 0.1 * np.median(steps)) * (1.0 + 1e-9)


def test_coarse_steps_err_by_half_a_pixel_though_they_are_constant():
    lines = smooth(3, 6, 14.5)
    assert 14.5 > diagonal(lines) / 20.0
    fiblets = pf.compress(lines)
    assert fiblets.promise == pytest.approx(diagonal(lines) / 4000.0, rel=1e-9)
    assert pf.measure_error(lines, fiblets).max_mm <= fiblets.promise


def test_real_coarse_and_uneven_files_are_within_half_a_pixel(shared_data):
    for name in ("nv_tract.IFOF_R.trk", "nv_tract.SLF1_R.tck", "nv_stroke.trk.gz", "trxpy_small.trx"):
        lines = pf.read(shared_data / name)
        error = pf.measure_error(lines, pf.compress(lines))
        assert error.max_mm <= diagonal(lines) / 4000.0


@pytest.mark.parametrize(
    ("name", "most"),
    [("gen_fibercup_det_0.25mm.tck", 1.39), ("ukf_2T_fw_fiber.vtk", 1.38), ("wma_brain_0002.vtk", 1.40)],
)
def test_real_constant_steps_keep_their_bytes(shared_data, name, most):
    fiblets = pf.compress(pf.read(shared_data / name))
    assert (fiblets.nbytes - fiblets.pages.nbytes) / fiblets.n_points <= most
