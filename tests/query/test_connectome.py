"""Connectomes against the search about the ends by NumPy, dipy's matrix, and sums by hand."""

import itertools
import json

import nibabel
import numpy as np
import pytest

import pvfiblets
from pvfiblets import Streamlines, compress, regions
from pvfiblets.cli.command import main
from pvfiblets.plotting.filtering.region_sources import as_region
from pvfiblets.query.connectome.matrix import connectome, end_labels

SHEARED = np.array([[2.0, 0.4, 0.0, -30.0], [0.0, -1.5, 0.3, 22.0], [0.2, 0.0, 2.5, -28.0], [0.0, 0.0, 0.0, 1.0]])


@pytest.fixture(scope="module")
def atlas():
    """Labels 3, 5, 8 and 11 here and there, on a sheared and flipped grid."""
    rng = np.random.default_rng(1)
    volume = rng.choice([0, 0, 0, 0, 0, 0, 3, 5, 8, 11], (30, 30, 24)).astype(np.int16)
    return volume, SHEARED


@pytest.fixture(scope="module")
def streamlines():
    rng = np.random.default_rng(2)
    lines = []
    for count in rng.integers(1, 40, 300):
        steps = rng.normal(size=3) * 0.6 + 0.1 * rng.normal(size=(count, 3))
        lines.append(rng.uniform(-35, 35, 3) + np.cumsum(steps, axis=0))
    made = Streamlines.from_list([*lines, np.zeros((0, 3))])
    made.per_streamline = {"fa": np.linspace(0.1, 0.9, len(made))}
    return made


def nearest(point, volume, affine, radius):
    """The label of the nearest labelled voxel centre within a radius, by looking at every one."""
    if not np.isfinite(point).all():
        return 0
    if radius == 0.0:
        v = np.floor(np.linalg.inv(affine)[:3] @ np.r_[point, 1.0] + 0.5).astype(int)
        inside = (v >= 0).all() and (v < volume.shape).all()
        return int(volume[tuple(v)]) if inside else 0
    where = np.argwhere(volume != 0)
    away = np.linalg.norm(where @ affine[:3, :3].T + affine[:3, 3] - point, axis=1)
    best = away.argmin()
    return int(volume[tuple(where[best])]) if away[best] <= radius else 0


def ends_of(streamlines):
    return [(line[0], line[-1]) if len(line) else (np.full(3, np.nan),) * 2 for line in map(np.asarray, streamlines)]


@pytest.mark.parametrize("radius", [0.0, 0.9, 3.0, 6.0])
def test_ends_have_the_nearest_parcel(streamlines, atlas, radius):
    found = end_labels(streamlines, atlas, radius)
    expected = [[nearest(end, *atlas, radius) for end in pair] for pair in ends_of(streamlines)]
    np.testing.assert_array_equal(found, expected)
    assert (found != 0).any()
    assert (found[:-1] == 0).any() or radius > 3.0
    assert (found[-1] == 0).all()


@pytest.mark.parametrize("more", [(1,), (1, 1)])
def test_axes_of_one_behind_the_third_are_none(streamlines, atlas, more, tmp_path):
    """Many programs write labels as a series of one volume."""
    volume, affine = atlas
    longer = nibabel.Nifti1Image(volume.reshape(volume.shape + more), affine)
    nibabel.save(longer, tmp_path / "labels.nii")
    expected = end_labels(streamlines, atlas, 3.0)
    for given in (longer, tmp_path / "labels.nii", (longer.get_fdata(), affine)):
        np.testing.assert_array_equal(end_labels(streamlines, given, 3.0), expected)
    fiblets, parcel = compress(streamlines, exact=True), regions.Labels(volume, affine, labels=[5])
    whole = fiblets.select(regions.passes(parcel))
    for region in (regions.Labels(longer.get_fdata(), affine, labels=[5]), as_region(longer) & parcel):
        np.testing.assert_array_equal(fiblets.select(regions.passes(region)), whole)
    assert set(np.unique(regions.RegionPainter.open(tmp_path / "labels.nii").labels)) == {0, 3, 5, 8, 11}


def test_progress_is_told_and_can_end_the_work(streamlines, atlas, monkeypatch):
    from pvfiblets.query.connectome import matrix as module

    whole, told = end_labels(streamlines, atlas, 3.0), []
    monkeypatch.setattr(module, "TOGETHER", 100)
    found = connectome(streamlines, atlas, radius=3.0, progress=lambda *said: told.append(said))
    np.testing.assert_array_equal(found.ends, whole)
    assert len(told) == 1 + -(-2 * len(streamlines) // 100)
    assert [share for _, share in told] == sorted(share for _, share in told)

    def stop(what, share):
        if share > 0.3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        end_labels(streamlines, atlas, 3.0, progress=stop)


def by_hand(ends, labels, value, weight, how):
    """The matrix, pair by pair."""
    n = len(labels)
    found = np.zeros((n, n)) if how == "sum" else np.full((n, n), np.nan)
    for (i, a), (j, b) in itertools.product(enumerate(labels), repeat=2):
        mine = np.array([sorted(pair) == sorted((a, b)) for pair in ends.tolist()])
        if not mine.any():
            continue
        if how == "sum":
            found[i, j] = (value * weight)[mine].sum()
        elif how == "mean":
            found[i, j] = np.average(value[mine], weights=weight[mine])
        else:
            found[i, j] = getattr(value[mine], how)()
    return found


@pytest.mark.parametrize("how", ["sum", "mean", "min", "max"])
def test_numbers_are_those_put_together_by_hand(streamlines, atlas, how):
    fiblets = compress(streamlines)
    weight = np.random.default_rng(3).uniform(0.1, 2.0, len(streamlines))
    value = np.random.default_rng(4).normal(size=len(streamlines))
    found = fiblets.connectome(atlas, weights=weight, contrast=value, statistic=how)
    assert found.labels.tolist() == [3, 5, 8, 11]
    np.testing.assert_allclose(found.matrix, by_hand(found.ends, [3, 5, 8, 11], value, weight, how), rtol=1e-12)
    assert found.counts[np.triu_indices(4)].sum() == found.n_connecting == (found.ends != 0).all(1).sum()
    for a, b in ((3, 8), (5, 5)):
        i, j = found.index(a), found.index(b)
        ids = found.streamlines(a, b)
        assert len(ids) == found.counts[i, j] == found.counts[j, i]
        assert all(sorted(found.ends[s]) == sorted((a, b)) for s in ids)
    assert set(found.streamlines(3)) == {s for s, pair in enumerate(found.ends.tolist()) if 3 in pair}


def test_voxels_of_ends_are_counted_as_dipy_counts_them(streamlines):
    utils = pytest.importorskip("dipy.tracking.utils", reason="dipy is not installed")
    volume = np.random.default_rng(5).integers(0, 5, (40, 40, 40))
    affine = np.diag([2.0, 2.0, 2.0, 1.0])
    affine[:3, 3] = -40.0
    kept = [line for line in map(np.asarray, streamlines) if len(line) and np.abs(line).max() < 38]
    theirs = utils.connectivity_matrix(kept, affine, volume, inclusive=False, symmetric=True)
    ours = connectome(Streamlines.from_list(kept), (volume, affine), radius=0.0)
    np.testing.assert_array_equal(ours.matrix, theirs[1:, 1:])


def test_lengths_names_and_stored_arrays(streamlines, atlas):
    names = {3: "left", 8: "right"}
    lengths = pvfiblets.table(streamlines)["length"]
    fiblets = compress(streamlines)
    for data in (streamlines, fiblets):
        found = connectome(data, atlas, contrast="length", names=names)
        expected = by_hand(found.ends, found.labels, lengths, np.ones(len(lengths)), "mean")
        np.testing.assert_allclose(found.matrix, expected, atol=0.1)
        assert found.names == ["left", "5", "right", "11"]
        assert found.index("right") == 2
        fa = connectome(data, atlas, contrast="fa", weights="fa", statistic="sum")
        np.testing.assert_allclose(
            fa.matrix, by_hand(fa.ends, fa.labels, streamlines.per_streamline["fa"],
                               streamlines.per_streamline["fa"], "sum"), rtol=1e-6
        )  # fmt: skip
    with pytest.raises(KeyError, match="no parcel is called 'middle'; there are left, 5"):
        found.index("middle")


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"radius": -1.0}, "radius is -1.0; give mm, 0 or more"),
        ({"radius": 5000.0}, "voxels lie about an end; give a smaller radius"),
        ({"statistic": "median"}, "statistic is 'median'; expected one of 'sum', 'mean'"),
        ({"weights": [1.0, 2.0]}, "weights have the shape .2,.; give one for each of 301 streamlines"),
        ({"weights": -np.ones(301)}, "weights must be finite numbers of 0 or more"),
    ],
)
def test_bad_input_is_one_sentence(streamlines, atlas, changes, message):
    with pytest.raises(ValueError, match=message):
        connectome(streamlines, atlas, **changes)
    with pytest.raises(ValueError, match="the labels hold no parcel"):
        connectome(streamlines, (np.zeros((4, 4, 4), int), np.eye(4)))


@pytest.mark.filterwarnings("ignore:.*have no points")
def test_the_command_writes_every_kind_of_matrix(streamlines, atlas, tmp_path, capsys):
    pvfiblets.write(tmp_path / "some.trk", streamlines)
    image = nibabel.Nifti1Image(atlas[0], atlas[1])
    nibabel.save(image, tmp_path / "atlas.nii.gz")
    expected = connectome(tmp_path / "some.trk", tmp_path / "atlas.nii.gz").matrix
    for suffix in (".csv", ".tsv", ".txt", ".npy"):
        target = tmp_path / f"matrix{suffix}"
        command = ["connectome", str(tmp_path / "some.trk"), str(tmp_path / "atlas.nii.gz"), str(target), "--json"]
        assert main(command) == 0
        told = json.loads(capsys.readouterr().out)
        assert (told["parcels"], told["streamlines"], told["contrast"]) == (4, len(streamlines), "count")
        if suffix == ".npy":
            found = np.load(target)
        elif suffix == ".txt":
            found = np.loadtxt(target)
        else:
            rows = [line.split("," if suffix == ".csv" else "\t") for line in target.read_text().splitlines()]
            assert rows[0] == ["", "3", "5", "8", "11"] == ["", *(row[0] for row in rows[1:])]
            found = np.array([row[1:] for row in rows[1:]], float)
        np.testing.assert_allclose(found, expected)
    assert main([*command[:3], str(tmp_path / "matrix.png")]) == 1
    assert "use one of .csv, .tsv, .txt, .npy" in capsys.readouterr().err


@pytest.mark.parametrize("coding", ["exact", "coded", "plain"])
def test_numbers_of_points_and_images_are_means_along_streamlines(streamlines, atlas, coding):
    lines = Streamlines(streamlines.points, streamlines.offsets, {"x": streamlines.points[:, 0].astype(float)})
    options = {"exact": True} if coding == "exact" else {"max_error": 1e-3, "max_value_error": 1e-3}
    data = lines if coding == "plain" else compress(lines, per_point=["x"], **options)
    wanted = []
    for line in lines:  # as tcksample -stat_tck mean
        steps = np.linalg.norm(np.diff(line.astype(float), axis=0), axis=1)
        weights = np.convolve(steps, [0.5, 0.5]) if len(line) > 1 else np.ones(len(line))
        wanted.append(np.average(line[:, 0], weights=weights) if len(line) else np.nan)
    grid = np.broadcast_to(np.arange(200.0)[:, None, None] - 100.0, (200, 200, 200))
    image = (grid, np.array([[1.0, 0, 0, -100], [0, 1, 0, -100], [0, 0, 1, -100], [0, 0, 0, 1]]))
    for contrast in ("x", image):
        found = connectome(data, atlas, contrast=contrast)
        expected = by_hand(found.ends, found.labels, np.array(wanted), np.ones(len(lines)), "mean")
        np.testing.assert_allclose(found.matrix, expected, atol=5e-3)
