"""Similarity and clusters against dipy's, and against distances in NumPy."""

import numpy as np
import pytest

from pvfiblets import Streamlines, bundles, compress, read


@pytest.fixture(scope="module")
def lines():
    """Three bundles of bent lines of different lengths, half of them turned round."""
    rng = np.random.default_rng(5)
    made = []
    for k in range(180):
        t = np.linspace(0.0, 1.0, rng.integers(5, 60))[:, None]
        bundle = k % 3
        course = np.hstack([60 * t, 25 * bundle + 12 * t * (bundle - 1), 20 * np.sin(3 * t) * (1 + bundle)])
        line = course + rng.normal(0, 2.5, 3)
        made.append(line[::-1] if k % 2 else line)
    return [line.astype(np.float32) for line in made]


def resampled(line, m):
    """The same by cumulative lengths and interpolation."""
    line = np.asarray(line, np.float64)
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    return np.stack([np.interp(np.linspace(0, arc[-1], m), arc, line[:, axis]) for axis in range(3)], axis=1)


def distance(a, b, m=12):
    a, b = resampled(a, m), resampled(b, m)
    return min(np.linalg.norm(a - b, axis=1).mean(), np.linalg.norm(a - b[::-1], axis=1).mean())


@pytest.mark.more
def test_distances_are_dipys_and_numpys(lines):
    from dipy.tracking.distances import bundles_distances_mdf
    from dipy.tracking.streamline import set_number_of_points

    found = bundles.mdf(lines[:20], lines)
    few = set_number_of_points(lines, nb_points=12)
    assert np.allclose(found, bundles_distances_mdf(few[:20], few), atol=1e-4)
    assert np.allclose(found[:3, :9], [[distance(a, b) for b in lines[:9]] for a in lines[:3]], atol=1e-4)


@pytest.mark.parametrize("n_points", [2, 7, 12, 40])
def test_similar_ones_are_those_within_the_distance(lines, n_points):
    fiblets = compress(Streamlines.from_list([*lines, np.zeros((0, 3), np.float32)]))
    decoded = fiblets.decompress().to_list()[:-1]
    found = fiblets.similar([7, 3], 5.0, n_points=n_points)
    apart = np.array([[distance(line, decoded[like], n_points) for like in (7, 3)] for line in decoded])
    assert sorted(found.ids.tolist()) == np.flatnonzero(apart.min(axis=1) <= 5.0).tolist()
    assert 2 < len(found) < 100
    assert np.allclose(found.distances, apart[found.ids].min(axis=1), atol=1e-4)
    assert (np.diff(found.distances) >= 0.0).all()
    assert found.nearest.tolist() == apart[found.ids].argmin(axis=1).tolist()
    assert len(fiblets[found]) == len(found) == found.mask.sum()
    assert np.isnan(found.values()[~found.mask]).all()


def test_lines_of_ones_own_and_parts_of_the_set(lines):
    fiblets = compress(Streamlines.from_list(lines))
    by_line = fiblets.similar(lines[4], 4.0)
    assert 4 in by_line.ids
    assert np.array_equal(by_line.ids, fiblets.similar([lines[4]], 4.0).ids)
    assert np.array_equal(by_line.ids, Streamlines.from_list(lines).similar(lines[4], 4.0).ids)
    among = fiblets.similar(lines[4], 4.0, ids=np.arange(0, 180, 2))
    assert sorted(among.ids.tolist()) == sorted(i for i in by_line.ids.tolist() if i % 2 == 0)


@pytest.mark.parametrize("threshold", [4.0, 10.0, 30.0])
def test_clusters_are_dipys(lines, threshold):
    from dipy.segment.clustering import QuickBundles

    found = bundles.clusters(Streamlines.from_list(lines), threshold)
    theirs = QuickBundles(threshold).cluster(lines)
    assert [cluster.ids.tolist() for cluster in found] == [sorted(cluster.indices) for cluster in theirs]
    for mine, other in zip(found.centroids, theirs.centroids, strict=True):  # which end comes first is nobody's choice
        assert min(np.abs(mine - other).max(), np.abs(mine[::-1] - other).max()) < 1e-3
    assert found.counts.sum() == len(lines)


def test_clusters_of_a_real_brain_are_dipys(shared_data):
    from dipy.segment.clustering import QuickBundles

    fiblets = compress(read(shared_data / "dipy_tracks300.trk"))
    found = fiblets.clusters(12.0)
    theirs = QuickBundles(12.0).cluster(fiblets.decompress().to_list())
    assert [cluster.ids.tolist() for cluster in found] == [sorted(cluster.indices) for cluster in theirs]


def test_clusters_of_many_chunks_and_more_than_there_is_room_for(lines, monkeypatch):
    from pvfiblets.query.bundles import clusters, resampled

    whole = bundles.clusters(Streamlines.from_list(lines), 1.5)
    assert len(whole) > 16
    monkeypatch.setattr(clusters, "ROOM", 2)
    monkeypatch.setattr(resampled, "CHUNK", 200)
    parts = bundles.clusters(compress(Streamlines.from_list(lines), exact=True), 1.5)
    assert np.array_equal(whole.labels, parts.labels)
    turned = bundles.clusters(Streamlines.from_list(lines), 1.5, ids=np.arange(180)[::-1])
    assert np.array_equal(turned.labels[::-1], bundles.clusters(Streamlines.from_list(lines[::-1]), 1.5).labels)


def test_clusters_are_limited_and_sorted_and_become_groups(lines):
    from dipy.segment.clustering import QuickBundles

    made = Streamlines.from_list([*lines, np.zeros((0, 3))])
    few = bundles.clusters(made, 4.0, max_clusters=5)
    theirs = QuickBundles(4.0, max_nb_clusters=5).cluster(lines)
    assert [cluster.ids.tolist() for cluster in few] == [sorted(cluster.indices) for cluster in theirs]
    assert few.labels[-1] == -1
    large = few.by_size(at_least=20)
    assert (np.diff(large.counts) <= 0).all()
    assert large.counts.min() >= 20
    for cluster in large:
        assert len(set(few.labels[cluster.ids].tolist())) == 1
    groups = few.groups(at_least=20)
    assert list(groups) == [f"cluster {i + 1}" for i in range(len(large))]
    assert np.array_equal(groups["cluster 1"], large[0].ids)
    colours = large.colors()
    assert colours.shape == (181, 3)
    assert colours[-1].tolist() == [128] * 3
    assert (colours[large[0].ids] == colours[large[0].ids[0]]).all()
    assert np.allclose(large.lines()[0], large[0].centroid)


@pytest.mark.parametrize(
    ("ask", "says"),
    [
        (lambda f: f.clusters(0.0), "threshold is 0.0"),
        (lambda f: f.clusters(5.0, n_points=1), "n_points is 1"),
        (lambda f: f.clusters(5.0, max_clusters=0), "max_clusters is 0"),
        (lambda f: f.clusters(5.0, ids=[1, 1]), "twice"),
        (lambda f: f.similar([0], float("nan")), "distance is nan"),
        (lambda f: f.similar([]), "no reference"),
        (lambda f: f.similar(np.zeros((0, 3))), "without points"),
    ],
)
def test_bad_numbers_are_reported(lines, ask, says):
    with pytest.raises(ValueError, match=says):
        ask(compress(Streamlines.from_list(lines[:9])))


@pytest.mark.parametrize("what", ["clustering", "comparing"])
def test_progress_is_told_and_can_end_the_work(lines, monkeypatch, what):
    from pvfiblets.query.bundles import resampled

    monkeypatch.setattr(resampled, "CHUNK", 1000)  # points
    whole, told = Streamlines.from_list(lines), []

    def find(**options):
        if what == "clustering":
            return bundles.clusters(whole, 5.0, **options)
        return bundles.similar(whole, [3], 5.0, **options)

    found = find(progress=lambda *said: told.append(said))
    assert {said for said, _ in told} == {what}
    shares = [share for _, share in told]
    assert len(shares) > 3
    assert shares[0] == 0.0
    assert shares == sorted(shares)
    assert shares[-1] < 1.0
    assert len(found) == len(find())

    def stop(*_):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        find(progress=stop)
