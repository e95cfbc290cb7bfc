"""The made-up brain has the measures it promises, checked with plain NumPy."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from pvfiblets import synthetic


def steps_and_turns(points, offsets):
    """Distances between consecutive points and turns between consecutive steps (degrees)."""
    moves = [np.diff(points[a:b].astype(np.float64), axis=0)
             for a, b in itertools.pairwise(offsets)]
    steps = np.concatenate([np.linalg.norm(move, axis=1) for move in moves])
    cosines = [
        np.sum(move[1:] * move[:-1], axis=1)
        / (np.linalg.norm(move[1:], axis=1) * np.linalg.norm(move[:-1], axis=1))
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


def test_a_seed_fixes_every_number_and_another_gives_others():
    first, again, other = (synthetic.brain_streamlines(50, seed=seed) for seed in (5, 5, 6))
    np.testing.assert_array_equal(first.points, again.points)
    assert first.n_points != other.n_points or not np.array_equal(first.points, other.points)


def test_chunks_join_to_the_whole(monkeypatch):
    monkeypatch.setattr(synthetic, "CHUNK", 40)
    whole = synthetic.brain_streamlines(100, seed=2, fa=True)
    chunks = list(synthetic.iter_brain_streamlines(100, seed=2, fa=True))
    assert [len(chunk) for chunk in chunks] == [40, 40, 20]
    np.testing.assert_array_equal(whole.points, np.concatenate([c.points for c in chunks]))
    assert whole.offsets[-1] == len(whole.points)
    assert whole.per_point["fa"].shape == (whole.n_points,)
    members = np.sort(np.concatenate(list(whole.groups.values())))
    np.testing.assert_array_equal(members, np.arange(100))


def test_it_is_the_size_of_a_brain_and_left_right_even():
    brain = synthetic.brain_streamlines(2000, 1.0)
    extent = np.ptp(brain.points, axis=0)
    assert np.all(extent > [120, 150, 110])
    assert np.all(extent < [150, 185, 165])
    assert abs(brain.points[:, 0].mean()) < 3.0


def test_none_is_a_tractogram_too_and_nonsense_is_refused():
    assert len(synthetic.brain_streamlines(0)) == 0
    with pytest.raises(ValueError, match="n_streamlines is -1"):
        synthetic.brain_streamlines(-1)
    with pytest.raises(ValueError, match="step is 0"):
        synthetic.brain_streamlines(1, step=0)
