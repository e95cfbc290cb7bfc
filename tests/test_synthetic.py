"""The made-up brain has the measures it promises, checked with plain NumPy."""

import itertools
import sys

import numpy as np
import pytest

from pvfiblets import synthetic
from pvfiblets.codec import layout
from pvfiblets.codec.editing import copies
from pvfiblets.codec.files import fiblets_format
from pvfiblets.synthetic import tracking


def steps_and_turns(points, offsets):
    """Distances between consecutive points and turns between consecutive steps (degrees)."""
    moves = [np.diff(points[a:b].astype(np.float64), axis=0) for a, b in itertools.pairwise(offsets)]
    steps = np.concatenate([np.linalg.norm(move, axis=1) for move in moves])
    cosines = [
        np.sum(move[1:] * move[:-1], axis=1) / (np.linalg.norm(move[1:], axis=1) * np.linalg.norm(move[:-1], axis=1))
        for move in moves
    ]
    return steps, np.degrees(np.arccos(np.clip(np.concatenate(cosines), -1.0, 1.0)))


@pytest.mark.parametrize(("step", "noise"), [(0.5, 0.0), (0.2, 4.0), (2.0, 1.0)])
def test_steps_are_constant_and_lengths_are_those_of_fibres(step, noise):
    brain = synthetic.brain_streamlines(300, step, seed=3, noise=noise)
    steps, _ = steps_and_turns(brain.points, brain.offsets)
    assert len(brain) == 300
    np.testing.assert_allclose(steps, step, rtol=1e-4, atol=3e-5)
    lengths = (np.diff(brain.offsets) - 1) * step
    assert lengths.min() >= 20.0 - 1e-9
    assert lengths.max() <= 200.0 + 1e-9


def test_noise_turns_like_probabilistic_tracking_and_its_absence_like_smooth_tracking():
    smooth = synthetic.brain_streamlines(300, 0.5, seed=1)
    noisy = synthetic.brain_streamlines(300, 0.2, seed=1, noise=4.0)
    _, smooth_turns = steps_and_turns(smooth.points, smooth.offsets)
    _, noisy_turns = steps_and_turns(noisy.points, noisy.offsets)
    assert smooth_turns.mean() < 3.0
    # Two independent turns of 4 degrees per axis differ by 4*sqrt(2) per axis: Rayleigh's mean.
    assert noisy_turns.mean() == pytest.approx(4.0 * np.sqrt(2.0) * np.sqrt(np.pi / 2.0), rel=0.05)


def test_chunks_join_to_the_whole(monkeypatch):
    monkeypatch.setattr(tracking, "CHUNK", 40)
    whole = synthetic.brain_streamlines(100, seed=2, fa=True)
    chunks = list(synthetic.iter_brain_streamlines(100, seed=2, fa=True))
    assert [len(chunk) for chunk in chunks] == [40, 40, 20]
    np.testing.assert_array_equal(whole.points, np.concatenate([c.points for c in chunks]))
    assert whole.offsets[-1] == len(whole.points)
    assert whole.per_point["fa"].shape == (whole.n_points,)
    members = np.sort(np.concatenate(list(whole.groups.values())))
    np.testing.assert_array_equal(members, np.arange(100))


def test_brains_are_of_the_size_of_a_brain_even_empty_and_nonsense_is_refused():
    brain = synthetic.brain_streamlines(2000, 1.0)
    extent = np.ptp(brain.points, axis=0)
    assert np.all(extent > [120, 150, 110])
    assert np.all(extent < [150, 185, 165])
    assert abs(brain.points[:, 0].mean()) < 3.0
    assert len(synthetic.brain_streamlines(0)) == 0
    with pytest.raises(ValueError, match="n_streamlines is -1"):
        synthetic.brain_streamlines(-1)
    with pytest.raises(ValueError, match="step is 0"):
        synthetic.brain_streamlines(1, step=0)
    first, again, other = (synthetic.brain_streamlines(50, seed=seed) for seed in (5, 5, 6))
    np.testing.assert_array_equal(first.points, again.points)
    assert first.n_points != other.n_points or not np.array_equal(first.points, other.points)


# ---------------------------------------------------------------------------------------------- compressed, any size


@pytest.fixture
def small_pool(monkeypatch):
    """Pools of 12 streamlines, chunks of 7 copies: many copies and many chunks from little work."""
    monkeypatch.setattr(sys.modules["pvfiblets.synthetic.brain"], "TRACKED", 12)
    monkeypatch.setattr(copies, "CHUNK", 7)


def rigid_fit(points, moved):
    """Rotation and translation that bring points nearest to others (Kabsch), and what is left."""
    a, b = points - points.mean(0), moved - moved.mean(0)
    u, _, vt = np.linalg.svd(a.T @ b)
    sign = np.sign(np.linalg.det(u @ vt))
    rotation = (u * [1.0, 1.0, sign]) @ vt
    left = np.linalg.norm(a @ rotation - b, axis=1).max()
    angle = np.degrees(np.arccos(np.clip((np.trace(rotation) - 1) / 2, -1, 1)))
    return left, angle


@pytest.mark.parametrize("step", [0.5, 0.1, 2.0])
def test_copies_are_rigidly_moved_streamlines(small_pool, step):
    whole = synthetic.brain(103, step, seed=4)
    whole.verify()
    base = synthetic.brain_streamlines(12, step, seed=4)
    decoded = whole.decompress(dtype=np.float64)
    turned = 0
    for i in range(103):
        original, copy = base[i % 12].astype(np.float64), decoded[i]
        assert len(copy) == len(original)
        left, angle = rigid_fit(original, copy)
        assert left <= 2 * whole.promise
        assert angle <= 5.1
        turned += angle > 0.5
        middle = 0.5 * (original.min(0) + original.max(0))
        assert np.abs(0.5 * (copy.min(0) + copy.max(0)) - middle).max() <= 4.0 + 0.02 * np.ptp(original, axis=0).max()
        if i < 12:
            assert np.linalg.norm(copy - original, axis=1).max() <= whole.promise, "the first are not moved"
    assert turned > 60


def test_copies_of_one_variant_are_the_same_points_moved(small_pool):
    """A whole period later comes the same streamline: exactly the same but for one move of all its points."""
    whole = synthetic.brain(200, 0.5, seed=1)
    decoded = whole.decompress(dtype=np.float64)
    moves = []
    for i in range(150):
        difference = decoded[i + 48] - decoded[i]
        assert np.ptp(difference, axis=0).max() < 1e-10
        grid = difference[0] / whole.anchor_scale
        assert np.abs(grid - np.rint(grid)).max() < 1e-6
        moves.append(difference[0])
    assert len(np.unique(np.round(moves, 6), axis=0)) == 150


def test_a_brain_is_the_same_in_memory_in_a_file_and_in_other_chunks(small_pool, monkeypatch, tmp_path):
    whole = synthetic.brain(203, 0.5, seed=2)
    mapped = synthetic.brain(203, 0.5, seed=2, path=tmp_path / "a.fiblets", progress=True)
    fiblets_format.verify_file(tmp_path / "a.fiblets")
    monkeypatch.setattr(copies, "CHUNK", 61)
    again = synthetic.brain(203, 0.5, seed=2)
    other = synthetic.brain(203, 0.5, seed=3)
    for name in ("anchors", "decoding", "reach", "codes", "ends", "pages"):
        np.testing.assert_array_equal(getattr(whole, name), getattr(mapped, name))
        np.testing.assert_array_equal(getattr(whole, name), getattr(again, name))
    assert whole.parameters == mapped.parameters == again.parameters
    assert whole.bounds == mapped.bounds == again.bounds
    assert not np.array_equal(whole.anchors[:50], other.anchors[:50])
    np.testing.assert_array_equal(mapped.per_streamline["bundle"], whole.per_streamline["bundle"])
    assert sorted(np.concatenate(list(mapped.groups.values()))) == list(range(203))


def test_an_ordered_brain_holds_the_same_streamlines(small_pool, monkeypatch):
    plain, ordered = (synthetic.brain(103, 0.5, seed=2, order=order) for order in ("input", "hilbert"))
    ordered.verify()
    assert ordered.parameters == plain.parameters
    assert ordered.bounds == plain.bounds
    bundles = [f.per_streamline["bundle"].tolist() for f in (plain, ordered)]
    a, b = ([line.tobytes() for line in f.decompress()] for f in (plain, ordered))
    assert a != b
    assert sorted(zip(a, bundles[0], strict=True)) == sorted(zip(b, bundles[1], strict=True))
    monkeypatch.setattr(copies, "CHUNK", 50)
    again = synthetic.brain(103, 0.5, seed=2, order="hilbert")
    np.testing.assert_array_equal(again.anchors, ordered.anchors)
    with pytest.raises(ValueError, match="order is 'x'"):
        synthetic.brain(1, order="x")


def test_a_brain_keeps_bounds_and_pages(small_pool):
    """More than one page of fiblets, and bounds of the copies themselves."""
    whole = synthetic.brain(6000, 0.5, seed=5)
    assert len(whole.pages) > 2
    whole.verify()
    points = whole.decompress(dtype=np.float64).points
    bounds = np.array(whole.bounds).reshape(3, 2)
    assert np.abs(points.min(0) - bounds[:, 0]).max() <= whole.promise
    assert np.abs(points.max(0) - bounds[:, 1]).max() <= whole.promise
    np.testing.assert_array_equal(layout.unpack("begin", whole.anchors).sum(), 6000)


def test_fine_anchors_are_moved_too(small_pool):
    """Steps so small that anchors take 32 bits: moves carry from their lower into their upper halves."""
    fine = synthetic.brain(80, 0.02, seed=1)
    assert fine.anchors_low is not None
    fine.verify()
    assert len(np.unique(fine.decompress().counts)) > 1
    n_tracked = int(12 * 0.02 / 0.1) or 1
    decoded, period = fine.decompress(dtype=np.float64), 4 * n_tracked
    for i in range(80 - period):
        assert np.ptp(decoded[i + period] - decoded[i], axis=0).max() < 1e-10


@pytest.mark.parametrize("n", [0, 1, 12, 13])
def test_small_brains_are_brains(small_pool, n, tmp_path):
    for path in (None, tmp_path / "a.fiblets"):
        fiblets = synthetic.brain(n, 1.0, path=path)
        assert len(fiblets) == n
        fiblets.verify()
        assert len(fiblets.decompress()) == n
    with pytest.raises(ValueError, match="n_streamlines is -1"):
        synthetic.brain(-1)
    with pytest.raises(ValueError, match="step is 0"):
        synthetic.brain(1, step=0)
