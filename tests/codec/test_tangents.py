"""Angles between true and drawn directions: closed forms, and the compiled kernel beside plain NumPy."""

import numpy as np
import pytest

import pvfiblets as pf
from pvfiblets.codec.kernels.tangent_kernels import tangent_angles
from pvfiblets.codec.tangents import pixel
from pvfiblets.report.studies.codec.errors import direction_angles
from pvfiblets.streamlines import Streamlines

from .samples import extremes, noisy, smooth, wandering


def measured(true, drawn, offsets, shortest=0.0, firsts=()):
    """Angles at both ends of each segment that counts, in the order of points."""
    degrees, uses, first = np.empty(len(true)), np.empty(len(true), np.uint8), np.zeros(len(true), bool)
    first[np.asarray(firsts, np.int64)] = True
    tangent_angles(true, drawn, np.asarray(offsets, np.int64), first, shortest, degrees, uses)
    return np.repeat(degrees, uses)


def test_a_turned_line_is_off_by_the_turn():
    line = np.random.default_rng(0).normal(size=(20, 3)) * [1.0, 1.0, 0.0]
    for turn in (1e-6, 0.3, 17.0, 90.0, 179.0):
        c, s = np.cos(np.radians(turn)), np.sin(np.radians(turn))
        turned = line @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
        found = measured(line, turned, [0, 20])
        assert len(found) == 38
        np.testing.assert_allclose(found, turn, rtol=1e-6)


def test_a_tangent_is_the_mean_of_two_directions():
    true = np.array([[0.0, 0, 0], [3, 0, 0], [3, 5, 0]])
    drawn = np.array([[0.0, 0, 0], [3, 0, 0], [8, 0, 0]])  # the second segment is 90 degrees off
    np.testing.assert_allclose(measured(true, drawn, [0, 3]), [0.0, 45.0, 45.0, 90.0], atol=1e-12)
    np.testing.assert_allclose(measured(true, drawn, [0, 3], 4.0), [45.0, 90.0])  # the first is too short
    np.testing.assert_allclose(measured(true, drawn, [0, 2, 3]), [0.0, 0.0], atol=1e-12)


def test_segments_of_no_length_have_no_direction():
    true = np.array([[0.0, 0, 0], [1, 0, 0], [1, 0, 0], [1, 1, 0]])
    np.testing.assert_allclose(measured(true, true, [0, 4]), 0.0)
    drawn = np.array([[0.0, 0, 0], [1, 0, 0], [1, 0, 0], [1, 0, 0]])
    np.testing.assert_allclose(measured(true, drawn, [0, 4]), [0.0, 0.0, 90.0, 90.0])


def test_a_line_that_turns_back_has_no_tangent_there():
    true = np.array([[0.0, 0, 0], [1, 0, 0], [0, 0, 0]])
    assert measured(true, true + [0.0, 0.0, 1.0], [0, 3]).tolist() == [0.0, 0.0]
    straight = np.array([[0.0, 0, 0], [1, 0, 0], [2, 1e-9, 0]])
    back = np.array([[0.0, 0, 0], [1, 0, 0], [0, 0, 0]])
    np.testing.assert_allclose(measured(straight, back, [0, 3]), [0.0, 0.0, 0.0, 180.0], atol=1e-6)


@pytest.mark.few(2)
@pytest.mark.parametrize("name", [*extremes(), "smooth", "noisy", "wandering"])
def test_the_kernel_agrees_with_numpy(name):
    lines = {"smooth": smooth(), "noisy": noisy(), "wandering": wandering(), **extremes()}[name]
    fiblets = pf.compress(lines)
    drawn = fiblets.decompress(dtype=np.float64).points
    offsets, firsts = np.asarray(lines.offsets, np.int64), fiblets.fiblet_points()
    with np.errstate(over="ignore"):
        expected = direction_angles(lines.points, drawn, offsets, firsts)
    found = measured(lines.points, drawn, offsets, pixel(fiblets.bounds), firsts)
    if "denormal" not in name:  # NumPy's squares of them are 0
        assert len(found) == len(expected)
        np.testing.assert_allclose(np.sort(found), np.sort(expected), atol=1e-6, rtol=1e-9)
    error = pf.measure_error(lines, fiblets)
    if not len(found):
        assert np.isnan([error.max_degrees, error.mean_degrees, error.p99_degrees]).all()
        return
    assert error.max_degrees == found.max()
    assert error.mean_degrees == pytest.approx(found.mean(), rel=1e-12)
    exact = np.quantile(found, 0.99, method="inverted_cdf")
    assert exact <= error.p99_degrees <= min(exact + 0.01, error.max_degrees)


def test_a_fiblet_begins_with_the_direction_of_its_first_segment():
    """As the shaders draw it: half of the turn is missing there, though nothing was moved."""
    line = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [2, 1, 0], [2, 2, 0]])
    np.testing.assert_allclose(measured(line, line, [0, 5], 0.0, [0, 2]), [0, 0, 0, 45, 45, 0, 0, 0], atol=1e-12)
    np.testing.assert_allclose(measured(line, line, [0, 5], 0.0, [0, 3, 4]), 0.0, atol=1e-12)
    expected = direction_angles(line, line, np.array([0, 5]), np.array([0, 2]))
    np.testing.assert_allclose(np.sort(expected), [0, 0, 0, 0, 0, 0, 45, 45], atol=1e-12)


def test_sets_out_of_order_are_measured_as_those_in_order():
    lines = noisy(40, 150)
    plain, hilbert = (pf.measure_error(lines, pf.compress(lines, order=order)) for order in ("input", "hilbert"))
    assert hilbert.summary()["error_degrees"] == pytest.approx(plain.summary()["error_degrees"])


def test_the_pixel_is_a_share_of_the_diagonal():
    assert pixel((-1.0, 2.0, 0.0, 4.0, 5.0, 17.0)) == pytest.approx(13.0 / 2000.0)


def test_float32_originals_are_taken_as_they_are():
    lines = wandering(5, 30)
    single = Streamlines(lines.points.astype(np.float32), lines.offsets)
    found = measured(single.points, lines.points, lines.offsets)
    assert 0.0 < found.max() < 1e-2
