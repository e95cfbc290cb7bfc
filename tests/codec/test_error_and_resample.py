"""Measured errors against a plain computation; resampling against closed forms; bad arguments."""

import numpy as np
import pytest

import pvfiblets as pf
from pvfiblets.codec.decompress import iter_chunks
from pvfiblets.codec.encoding.resample import resample
from pvfiblets.codec.point_values import code_values
from pvfiblets.streamlines import Streamlines

from .samples import smooth, wandering


@pytest.mark.more
def test_errors_are_those_of_a_plain_computation(monkeypatch):
    lines = Streamlines.concatenate([wandering(30, 50), Streamlines(np.empty((0, 3)), [0, 0]), smooth(30, 100)])
    fiblets = pf.compress(lines, max_error=0.03)
    error = pf.measure_error(lines, fiblets)
    distance = np.linalg.norm(lines.points - fiblets.decompress().points.astype(float), axis=1)
    assert error.max_mm == pytest.approx(distance.max(), rel=1e-12)
    assert error.mean_mm == pytest.approx(distance.mean(), rel=1e-12)
    assert error.p999_mm == pytest.approx(
        np.percentile(distance, 99.9, method="inverted_cdf"), abs=1e-4 * fiblets.promise
    )
    assert error.max_steps == pytest.approx(error.max_mm / fiblets.step)
    assert np.isnan(error.streamline_max_mm[30])
    per = [distance[a:b] for a, b in zip(lines.offsets[:-1], lines.offsets[1:], strict=True)]
    np.testing.assert_allclose(error.streamline_max_mm, [d.max() if len(d) else np.nan for d in per])
    np.testing.assert_allclose(error.streamline_mean_mm, [d.mean() if len(d) else np.nan for d in per])
    chunks = list(iter_chunks(fiblets, 100, np.float64))
    monkeypatch.setattr("pvfiblets.codec.error.iter_chunks", lambda fiblets, dtype: iter(chunks))
    again = pf.measure_error(lines, fiblets)
    assert (again.max_mm, again.p999_mm) == (error.max_mm, error.p999_mm)
    assert (again.max_degrees, again.p99_degrees) == (error.max_degrees, error.p99_degrees)
    assert again.mean_mm == pytest.approx(error.mean_mm, rel=1e-12)


def test_errors_against_other_lines_are_refused():
    fiblets = pf.compress(smooth(5, 50))
    with pytest.raises(TypeError, match="in this order; got FibletSet and Streamlines"):
        pf.measure_error(fiblets, smooth(5, 50))
    with pytest.raises(ValueError, match="5 streamlines of 250 points, the original 4 of 200"):
        pf.measure_error(smooth(4, 50), fiblets)
    other = smooth(5, 50)
    moved = Streamlines(other.points, [0, 50, 101, 150, 200, 250])
    with pytest.raises(ValueError, match="streamline 1 has another number of points"):
        pf.measure_error(moved, fiblets)


def test_resampled_points_lie_a_step_apart_on_the_line():
    angle = np.linspace(0, np.pi, 2001)
    circle = 10 * np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    lines = Streamlines.from_list([circle, circle[:1], np.empty((0, 3))])
    fresh = resample(lines, 0.5)
    first = fresh[0]
    np.testing.assert_allclose(first[[0, -1]], circle[[0, -1]])
    arc = 10 * np.unwrap(np.arctan2(first[:, 1], first[:, 0]))
    np.testing.assert_allclose(np.diff(arc)[:-1], 0.5, rtol=1e-5)
    assert 0 < np.diff(arc)[-1] <= 0.5 + 1e-5
    assert [len(f) for f in fresh] == [len(first), 1, 0]


def test_resampling_carries_values_along():
    lines = Streamlines.from_list([np.array([[0.0, 0, 0], [1, 0, 0], [4, 0, 0]])])
    lines = Streamlines(
        lines.points, lines.offsets, per_point={"v": np.array([0.0, 1.0, 4.0])}, per_streamline={"w": [7]}
    )
    fresh = resample(lines, 0.5)
    np.testing.assert_allclose(fresh.per_point["v"], fresh.points[:, 0])
    assert fresh.n_points == 9
    assert fresh.per_streamline["w"].tolist() == [7]


def test_a_zero_length_streamline_resamples_to_its_ends():
    fresh = resample(Streamlines.from_list([np.zeros((5, 3))]), 1.0)
    assert fresh.points.tolist() == [[0, 0, 0], [0, 0, 0]]


@pytest.mark.more
def test_compress_resamples_only_when_asked():
    lines = smooth(5, 50)
    assert pf.compress(lines).n_points == lines.n_points
    coarse = pf.compress(lines, step=2.0)
    assert coarse.n_points == resample(lines, 2.0, 0.25 * coarse.promise).n_points < lines.n_points
    assert 0.0 < coarse.step <= 2.0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"step": -1.0}, r"step is -1.0; 'auto' or a positive length"),
        ({"step": float("nan")}, r"step is nan"),
        ({"max_error": 0.0}, r"max_error is 0.0; a positive length"),
        ({"max_error": float("inf")}, r"max_error is inf"),
        ({"max_error": 1e-12}, r"the finest promise is"),
        ({"max_angle": 0.0}, r"max_angle is 0.0; degrees above 0 and up to 90"),
        ({"max_angle": 120.0}, r"max_angle is 120.0; .* or None for any"),
        ({"max_angle": float("nan")}, r"max_angle is nan"),
        ({"effort": "slow"}, r"effort is 'slow'; 'fast', 'high' or 'small'"),
        ({"per_point": ["fa"]}, r"no per-point array 'fa'; the streamlines have: none"),
        ({"per_point": "fa"}, r"a list of names is needed: \['fa'\]"),
        ({"per_point_bits": 12}, r"per_point_bits is 12; 8 or 16"),
    ],
)
def test_bad_arguments_say_what_is_needed(arguments, message):
    with pytest.raises(ValueError, match=message):
        pf.compress(smooth(2, 20), **arguments)


def test_bad_points_are_named():
    points = np.array(smooth(2, 20).points)
    points[7, 1] = np.nan
    with pytest.raises(ValueError, match="point 7 is .*nan.*remove or repair"):
        pf.compress(Streamlines(points, [0, 20, 40]), nan="error")
    points[7, 1] = 1e300
    with pytest.raises(ValueError, match=r"1e\+300 mm is beyond"):
        pf.compress(Streamlines(points, [0, 20, 40]))
    with pytest.raises(TypeError, match=r"takes pvfiblets.Streamlines, got list"):
        pf.compress([points])


RNG = np.random.default_rng(0)
FA = np.clip(0.4 + 0.0015 * np.cumsum(RNG.normal(size=100_000)), 0.0, 1.0)


def with_one(value):
    values = FA.astype(np.float32)
    values[77] = value
    return values


@pytest.mark.parametrize(
    ("values", "bits"),
    [
        (FA, 8), (with_one(-9999.0), 8), (with_one(1e6), 8), (with_one(np.nan), 8), (RNG.normal(size=100_000), 8),
        (np.exp(3.0 * RNG.normal(size=100_000)), 16), (10.0 ** RNG.uniform(-12.0, 0.0, 100_000), 16),
        (1.7e9 + RNG.uniform(0.0, 60.0, 100_000), 8), (FA * 1e-30, 8), (np.where(FA > 0.4, np.inf, FA), 8),
    ],
)  # fmt: skip
def test_no_value_is_off_by_more_than_a_level_of_the_middle_98_percent(values, bits):
    finite = np.isfinite(values)
    coded = code_values(values)
    decoded = coded.values()
    assert (coded.codes.dtype.itemsize, decoded.dtype) == (bits // 8, values.dtype)
    assert np.isnan(decoded[~finite]).all()
    off = np.abs(decoded[finite].astype(float) - values[finite])
    assert (coded.max_error, coded.mean_error) == pytest.approx((off.max(), off.mean()), rel=1e-6)
    low, high = np.quantile(values[finite], [0.01, 0.99])
    assert off.max() <= (high - low) / 255.0 * 1.01
    if values.min() > 0.0 and high > 100.0 * low:  # colours on a log scale
        levels = np.log(decoded[finite] / values[finite]) / np.log(high / low) * 255.0
        assert np.abs(levels).max() < 1.01


@pytest.mark.parametrize(
    ("values", "size"),
    [
        (np.repeat([2, 10, 41, 1035], 50), 1), (RNG.integers(0, 3000, 9000), 2), (np.arange(70_000), 8),
        (2**60 + np.arange(300), 2), (FA > 0.4, 1), (np.full(5, 3.25), 1), (np.array([0.1, 0.2, np.nan]), 1),
        (np.zeros(0), 1), (np.full(5, np.nan), 1),
    ],
)  # fmt: skip
def test_integers_categories_and_few_numbers_are_exact_in_value_and_type(values, size):
    coded = code_values(values)
    np.testing.assert_array_equal(coded.values(), values)
    assert (coded.values().dtype, coded.codes.dtype.itemsize, coded.max_error) == (values.dtype, size, 0.0)


def test_exact_sets_keep_every_bit_of_values_and_others_the_bound_that_is_asked_for():
    lines = Streamlines(np.cumsum(RNG.normal(size=(100_000, 3)), axis=0), np.arange(0, 100_001, 1000), {"fa": FA})
    exact = pf.compress(lines, per_point=["fa"], exact=True)
    np.testing.assert_array_equal(exact.decompress().per_point["fa"], FA)
    coded = pf.compress(lines, per_point=["fa"], max_value_error={"fa": 1e-5})
    off = np.abs(coded.decompress().per_point["fa"] - FA).max()
    assert coded.per_point["fa"].max_error == pytest.approx(off)
    assert off <= 1e-5
    with pytest.raises(ValueError, match="max_value_error of 'fa' is -1; a positive number in the array's unit"):
        pf.compress(lines, per_point=["fa"], max_value_error={"fa": -1})
