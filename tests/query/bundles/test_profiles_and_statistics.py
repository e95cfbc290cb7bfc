"""Tract profiles and tables of bundles against dipy's, SciPy's and sums by hand."""

import csv
import itertools

import numpy as np
import pytest

from pvfiblets import FibletSet, Streamlines, bundles, compress
from pvfiblets.query.bundles.students import student_quantile

AFFINE = np.array([[2.0, 0.1, 0.0, -30.0], [0.0, -1.5, 0.2, 40.0], [0.1, 0.0, 2.5, -25.0], [0.0, 0.0, 0.0, 1.0]])


@pytest.fixture(scope="module")
def lines():
    rng = np.random.default_rng(1)
    made = []
    for k in range(30):
        t = np.linspace(0, 1, rng.integers(15, 60))[:, None]
        line = np.hstack([40 * t - 20, 15 * np.sin(3 * t), 5 * t]) + rng.normal(0, [1.0, 2.0, 0.5], 3)
        made.append(line[::-1] if k % 3 == 1 else line)
    return made


@pytest.fixture(scope="module")
def image():
    i, j, k = np.meshgrid(*[np.arange(n) for n in (34, 52, 30)], indexing="ij")
    return np.sin(0.2 * i) + 0.03 * j + 0.001 * k**2, AFFINE


def test_a_profile_is_dipys_with_the_same_weights(lines, image):
    from dipy.stats.analysis import afq_profile
    from dipy.tracking.streamline import orient_by_streamline, set_number_of_points

    streamlines = Streamlines.from_list(lines)
    turned = orient_by_streamline(lines, lines[0], n_points=100)
    places = np.array(set_number_of_points(turned, nb_points=100), float)
    for weights in ("core", "equal"):
        found = bundles.tract_profile(streamlines, slice(None), image, 100, weights=weights)
        weight = bundles.core_weights(places) if weights == "core" else np.full((30, 100), 1 / 30)
        theirs = afq_profile(image[0], turned, image[1], n_points=100, weights=weight)
        assert np.allclose(found.mean, theirs, atol=2e-3)
        assert np.allclose(found.core, places.mean(axis=0), atol=1e-3)
        assert found.count == 30


def test_core_weights_are_inverse_mahalanobis_distances(lines):
    from scipy.spatial.distance import mahalanobis

    rng = np.random.default_rng(2)
    places = rng.normal(size=(12, 4, 3)) * [1.0, 3.0, 0.2]
    found = bundles.core_weights(places)
    for j in range(4):
        inverse = np.linalg.inv(np.cov(places[:, j].T, ddof=0))
        expected = 1 / np.array([mahalanobis(p, places[:, j].mean(axis=0), inverse) for p in places[:, j]])
        assert np.allclose(found[:, j], expected / expected.sum())
    flat = places * [1.0, 1.0, 0.0]
    flat[:, 0] = 5.0  # all in one place, and the rest in a plane
    weight = bundles.core_weights(flat)
    assert np.allclose(weight.sum(axis=0), 1.0)
    assert np.allclose(weight[:, 0], 1 / 12)
    inverse = np.linalg.inv(np.cov(flat[:, 1, :2].T, ddof=0))
    expected = 1 / np.array([mahalanobis(p, flat[:, 1, :2].mean(axis=0), inverse) for p in flat[:, 1, :2]])
    assert np.allclose(weight[:, 1], expected / expected.sum())


def test_the_band_is_that_of_students_distribution(lines, image):
    from scipy import stats

    found = bundles.tract_profile(Streamlines.from_list(lines), range(30), image, 20, weights="equal", confidence=0.9)
    rows = np.stack([bundles.tract_profile(Streamlines.from_list(lines), [k], image, 20, orient_by=lines[0]).mean
                     for k in range(30)])  # fmt: skip
    low, high = stats.t.interval(0.9, 29, loc=rows.mean(axis=0), scale=stats.sem(rows))
    assert np.allclose(found.low, low, atol=1e-6)
    assert np.allclose(found.high, high, atol=1e-6)
    assert np.allclose(found.std, rows.std(axis=0, ddof=1))
    three = [bundles.tract_profile(Streamlines.from_list(lines[k : k + 10]), range(10), image, 20, orient_by=lines[0])
             for k in (0, 10, 20)]  # fmt: skip
    group = bundles.average_profiles(three, bundle="patients")
    means = np.stack([p.mean for p in three])
    low, high = stats.t.interval(0.95, 2, loc=means.mean(axis=0), scale=stats.sem(means))
    assert np.allclose([group.low, group.high], [low, high])
    assert np.isnan(bundles.average_profiles(three[:1]).low).all()


@pytest.mark.parametrize("freedom", [1, 2, 3, 4, 7, 30, 999])
@pytest.mark.parametrize("share", [0.5, 0.95, 0.999])
def test_quantiles_are_scipys(freedom, share):
    from scipy import stats

    assert student_quantile(share, freedom) == pytest.approx(stats.t.ppf(0.5 + share / 2, freedom), rel=1e-9)


def test_arrays_measures_and_groups_have_profiles(lines):
    made = Streamlines.from_list(lines, groups={"tract": np.arange(5)})
    made.per_point = {"x": made.points[:, :1].copy()}
    by_name = bundles.tract_profile(made, "tract", "x", 30, weights="equal")
    assert np.allclose(by_name.mean, by_name.core[:, 0], atol=1e-6)
    assert (by_name.bundle, by_name.name) == ("tract", "x")
    own = bundles.tract_profile(made, "tract", made.points[:, 0], 30, weights="equal")
    assert np.allclose(own.mean, by_name.mean)
    arc = bundles.tract_profile(made, [0], "arc_length", 11)
    assert np.allclose(arc.mean, np.linspace(0, made.lengths()[0], 11), rtol=1e-3)
    assert np.isnan(arc.low).all()  # of one streamline nothing is known about others
    axes = by_name.plot()
    assert axes.get_ylabel() == "x"
    assert np.allclose(axes.lines[0].get_ydata(), by_name.mean)
    import matplotlib.pyplot as plt

    plt.close(axes.figure)


def test_plots_break_where_values_are_missing():
    import matplotlib.pyplot as plt

    x, mean = np.linspace(0.0, 1.0, 7), np.array([0.0, 1.0, np.nan, 3.0, 4.0, np.nan, 2.0])
    axes = bundles.TractProfile(mean, mean, mean - 1, mean + 1, x, np.zeros((7, 3)), "fa").plot()
    try:
        (band,) = axes.collections
        ends = [(path.vertices[:, 0].min(), path.vertices[:, 0].max()) for path in band.get_paths()]
        np.testing.assert_allclose(ends, [(x[0], x[1]), (x[3], x[4]), (x[6], x[6])])
        line, dots = axes.lines
        np.testing.assert_array_equal(line.get_ydata(), mean)  # matplotlib draws nothing to a NaN
        assert dots.get_xydata().tolist() == [[x[6], 2.0]]  # nor a value between two of them
        assert dots.get_color() == line.get_color()
        axes.figure.canvas.draw()
        shown = np.asarray(axes.figure.canvas.buffer_rgba())[..., :3].astype(int)
        column = round(axes.transData.transform((x[2], 0.0))[0])
        inside = slice(None), slice(column - 3, column + 3)
        assert (shown[inside].max(axis=2) - shown[inside].min(axis=2)).max() < 20  # no colour
    finally:
        plt.close(axes.figure)


def test_what_has_no_profile_is_told(lines, image):
    made = Streamlines.from_list([*lines[:3], np.zeros((0, 3))])
    for call, error, says in (
        (lambda: bundles.tract_profile(made, [3], image), ValueError, "no streamline with points"),
        (lambda: bundles.tract_profile(made, "x", image), KeyError, "no group 'x'"),
        (lambda: bundles.tract_profile(made, [0], "length"), ValueError, "per streamline"),
        (lambda: bundles.tract_profile(made, [0], np.zeros(3)), ValueError, "one for each of"),
        (lambda: bundles.tract_profile(made, [0], image, weights="x"), ValueError, "weights is 'x'"),
        (lambda: bundles.tract_profile(made, [0], image, 1), ValueError, "n is 1; give"),
        (lambda: bundles.tract_profile(made, [0], image, confidence=1.0), ValueError, "confidence is 1.0; give"),
        (lambda: bundles.average_profiles([]), ValueError, "at least one"),
    ):
        with pytest.raises(error, match=says):
            call()


def test_images_are_sampled_as_dipy_does(image):
    from dipy.tracking.streamline import values_from_volume

    rng = np.random.default_rng(4)
    voxels = rng.uniform(0, 1, (200, 3)) * (np.array(image[0].shape) - 1)
    points = voxels @ AFFINE[:3, :3].T + AFFINE[:3, 3]
    from pvfiblets.images.sources import as_image

    found = as_image(image).at(points)
    assert np.allclose(found, values_from_volume(image[0], [points], AFFINE)[0])
    outside = np.array([[-0.6, 0, 0], [0, 0, 29.6]]) @ AFFINE[:3, :3].T + AFFINE[:3, 3]
    assert np.isnan(as_image(image).at(outside)).all()
    holed = image[0].copy()
    holed[3, 3, 3] = np.nan
    corner = np.array([[4.0, 3.0, 3.0], [3.5, 3.0, 3.0]]) @ AFFINE[:3, :3].T + AFFINE[:3, 3]
    assert np.isnan(as_image((holed, AFFINE)).at(corner)).tolist() == [False, True]


@pytest.mark.parametrize("compressed", [False, True])
def test_bundles_are_measured(lines, image, tmp_path, compressed):
    made = Streamlines.from_list(lines, groups={"some": np.arange(12), "none": np.zeros(0, int)})
    made.per_streamline = {"weight": np.arange(30.0)}
    made.per_point = {"x": made.points[:, 0].copy()}
    data = compress(made, exact=True, per_point=["x"]) if compressed else made
    table = bundles.bundle_table(data, images={"fa": image}, voxel_size=2.0, weights="points")
    assert table["bundle"].tolist() == ["some", "none"]
    assert table["count"].tolist() == [12, 0]
    lengths = [np.linalg.norm(np.diff(line, axis=0), axis=1).sum() for line in lines[:12]]
    for name, value in (("mean", np.mean(lengths)), ("std", np.std(lengths)), ("total", np.sum(lengths))):
        assert table[f"length_{name}"][0] == pytest.approx(value, rel=1e-6)
    fine = np.concatenate([a + (b - a) * np.linspace(0, 1, 60)[:, None] for line in lines[:12]
                           for a, b in itertools.pairwise(line)])  # fmt: skip
    seen = len(np.unique(np.floor(fine / 2.0), axis=0))
    assert seen <= table["volume_voxels"][0] <= seen + 3  # corners that are cut between the samples
    assert table["volume_mm3"][0] == 8.0 * table["volume_voxels"][0]
    from pvfiblets.images.sources import as_image

    values = as_image(image).at(np.concatenate(lines[:12]))
    assert table["mean_fa"][0] == pytest.approx(np.nanmean(values), rel=1e-5)
    assert table["std_fa"][0] == pytest.approx(np.nanstd(values), rel=1e-4)
    assert table["mean_weight"][0] == np.arange(12).mean()
    assert table["mean_x"][0] == pytest.approx(np.concatenate(lines[:12])[:, 0].mean(), abs=0.1)
    assert np.isnan(table["length_mean"][1])
    assert np.isnan(table["mean_fa"][1])
    own = bundles.bundle_table(data, {"two": [0, 1]}, like=image)
    assert own["count"].tolist() == [2]
    assert own["volume_mm3"][0] == pytest.approx(own["volume_voxels"][0] * abs(np.linalg.det(AFFINE[:3, :3])))
    for suffix, delimiter in ((".csv", ","), (".tsv", "\t")):
        table.save(tmp_path / f"t{suffix}")
        rows = list(csv.DictReader((tmp_path / f"t{suffix}").read_text().splitlines(), delimiter=delimiter))
        assert rows[0]["bundle"] == "some"
        assert float(rows[0]["mean_fa"]) == table["mean_fa"][0]
        assert rows[1]["mean_fa"] == ""
    from pyarrow import parquet

    table.save(tmp_path / "t.parquet")
    back = parquet.read_table(tmp_path / "t.parquet").to_pydict()
    assert back["count"] == [12, 0]
    assert back["mean_fa"][0] == table["mean_fa"][0]


def test_without_pyarrow_there_is_one_clear_error(lines, tmp_path, monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "pyarrow.parquet", None)
    with pytest.raises(ImportError, match="pip install pyarrow"):
        Streamlines.from_list(lines).table().save(tmp_path / "t.parquet")


def test_profiles_come_as_one_table(lines, image):
    made = Streamlines.from_list(lines)
    some = [bundles.tract_profile(made, range(k, k + 5), image, 10, name="fa", bundle=f"b{k}") for k in (0, 5)]
    table = bundles.profile_table(some)
    assert table.n_rows == 20
    assert table["bundle"].tolist() == ["b0"] * 10 + ["b5"] * 10
    assert np.array_equal(table["mean"][10:], some[1].mean)
    assert isinstance(compress(made), FibletSet)


def test_values_along_a_bundle_are_at_dipys_positions(lines):
    """In float64 by NumPy, of streamlines that dipy has turned, and the profile of these values is the profile."""
    from dipy.tracking.streamline import orient_by_streamline

    profile = np.cos(np.linspace(0.0, 5.0, 40))
    streamlines = Streamlines.from_list(lines)
    found = bundles.values_along(streamlines, slice(None), profile)
    turned = orient_by_streamline(lines, lines[0], n_points=40)
    wanted = []
    for line, theirs in zip(lines, turned, strict=True):
        steps = np.linalg.norm(np.diff(theirs, axis=0), axis=1)
        share = np.concatenate([[0.0], np.cumsum(steps)]) / steps.sum()
        values = np.interp(share, np.linspace(0.0, 1.0, 40), profile)
        wanted.append(values if np.allclose(theirs[0], line[0], atol=1e-4) else values[::-1])
    assert np.allclose(found, np.concatenate(wanted), atol=1e-5)
    fine = Streamlines.from_list([np.array([np.interp(np.linspace(0, 1, 2000), np.linspace(0, 1, len(line)), axis)
                                            for axis in line.T]).T for line in lines])  # fmt: skip
    again = bundles.tract_profile(fine, slice(None), bundles.values_along(fine, slice(None), profile), 40)
    assert np.allclose(again.mean, profile, atol=1e-3)
    assert np.isnan(again.std).sum() == 0
    against = bundles.values_along(streamlines, slice(None), profile, orient_by=lines[0][::-1])
    assert np.allclose(against, bundles.values_along(streamlines, slice(None), profile[::-1]))


def test_positions_without_a_value_and_other_streamlines_have_none(lines):
    streamlines = Streamlines.from_list([np.zeros((0, 3)), *lines], groups={"two": np.array([1, 2])})
    profile = np.array([1.0, 2.0, np.nan, 4.0, 5.0])
    for data in (streamlines, compress(streamlines, exact=True)):
        found = bundles.values_along(data, "two", profile)
        first, second = (found[streamlines.offsets[k] : streamlines.offsets[k + 1]] for k in (1, 2))
        assert np.isnan(found[streamlines.offsets[3] :]).all()
        steps = np.linalg.norm(np.diff(lines[0], axis=0), axis=1)
        share = np.concatenate([[0.0], np.cumsum(steps)]) / steps.sum()
        assert np.isnan(first).tolist() == (np.abs(share - 0.5) < 0.125).tolist()
        assert (first[0], first[-1], second[0], second[-1]) == pytest.approx((1.0, 5.0, 5.0, 1.0))
    with pytest.raises(ValueError, match="shape"):
        bundles.values_along(streamlines, "two", np.zeros((2, 2)))
    with pytest.raises(KeyError, match="'one'"):
        bundles.values_along(streamlines, "one", profile)
    with pytest.raises(ValueError, match="2 or more"):
        bundles.values_along(streamlines, "two", [1.0])
