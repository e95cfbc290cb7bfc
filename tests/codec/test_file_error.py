"""A finished file beside its source: all of it, or a sample; distances and sums against NumPy's."""

import numpy as np
import pytest

import pvfiblets as pf
from pvfiblets.cli.command import main
from pvfiblets.codec.files.file_error import measure_file_error
from pvfiblets.codec.kernels.error_kernels import add_up, distances

from .samples import smooth, wandering


@pytest.mark.parametrize("single", [False, True])
@pytest.mark.parametrize("kind", [np.float32, np.float64])
def test_distances_are_those_of_numpy(kind, single):
    rng = np.random.default_rng(0)
    true, drawn = rng.normal(size=(500, 3)).astype(kind), rng.normal(size=(500, 3)) * 1e3
    found = np.empty(500)
    distances(true, drawn, single, found)
    rounded = drawn.astype(np.float32).astype(np.float64) if single else drawn
    np.testing.assert_allclose(found, np.linalg.norm(true.astype(np.float64) - rounded, axis=1), rtol=1e-14)


@pytest.mark.parametrize("up", [False, True])
def test_sums_and_histograms_are_those_of_numpy(up):
    rng = np.random.default_rng(1)
    values, weights = rng.exponential(size=1000), rng.integers(0, 3, 1000).astype(np.uint8)
    values[3] = np.inf
    weights[3] = 1
    counts = np.zeros(51, np.int64)
    total, largest = add_up(values, weights, 20.0, up, counts)
    assert total == largest == np.inf
    bins = np.minimum(np.ceil(values * 20.0) if up else np.floor(values * 20.0), 50).astype(int)
    np.testing.assert_array_equal(counts, np.bincount(bins, weights, 51))
    total, largest = add_up(values[4:], weights[4:], 20.0, up, counts)
    assert total == pytest.approx(float(values[4:] @ weights[4:]))
    assert largest == values[4:].max()


@pytest.mark.few(1)
@pytest.mark.parametrize("step", ["auto", 0.7])
def test_a_sample_is_of_every_so_many_th_streamline(step, tmp_path, monkeypatch):
    source, target = tmp_path / "a.trx", tmp_path / "a.fiblets"
    lines = wandering(40, 50)
    pf.write(source, lines)
    monkeypatch.setattr("pvfiblets.codec.files.convert.SAMPLE_POINTS", 670)  # of 2,000: every third
    monkeypatch.setattr("pvfiblets.codec.files.convert.CHUNK_POINTS", 400)  # and chunks that three does not divide
    told = pf.compress_file(source, target, step=step, exact=False, verify="sample")
    every = told["compared_every"]
    assert every == round(told["points"] / 670) >= 3
    whole = pf.measure_error(lines, pf.FibletSet.open(target))
    assert told["error_mm"]["max"] == pytest.approx(whole.streamline_max_mm[::every].max(), rel=1e-6)
    assert told["error_mm"]["max"] <= whole.max_mm <= told["promise_mm"] * (1 + 1e-9)
    if step == "auto":
        assert told["error_mm"]["mean"] == pytest.approx(whole.streamline_mean_mm[::every].mean(), rel=1e-6)
    told = pf.compress_file(source, tmp_path / "b.fiblets", step=step, exact=False)
    assert told["compared_every"] == 1
    assert told["error_mm"]["max"] == pytest.approx(whole.max_mm)
    assert (tmp_path / "b.fiblets").read_bytes() == target.read_bytes()


def test_a_sample_finds_what_is_of_another_set(tmp_path):
    pf.write(tmp_path / "a.tck", smooth(9, 50))
    pf.write(tmp_path / "b.tck", smooth(5, 50))
    pf.compress_file(tmp_path / "a.tck", tmp_path / "a.fiblets", exact=False)
    with pytest.raises(ValueError, match="hold 9 streamlines, the original 5"):
        measure_file_error(tmp_path / "a.fiblets", tmp_path / "b.tck")
    with pytest.raises(ValueError, match="verify is 'some'; 'all' or 'sample' is needed"):
        pf.compress_file(tmp_path / "a.tck", tmp_path / "c.fiblets", verify="some")
    assert not (tmp_path / "c.fiblets").exists()


def test_the_command_says_what_a_sample_was_of(tmp_path, monkeypatch, capsys):
    source, target = tmp_path / "a.trx", tmp_path / "a.fiblets"
    pf.write(source, wandering(40, 50))
    monkeypatch.setattr("pvfiblets.codec.files.convert.SAMPLE_POINTS", 1000)
    assert main(["convert", str(source), str(target), "--no-exact", "--verify", "sample"]) == 0
    assert "every 2nd streamline" in capsys.readouterr().out
    assert main(["convert", str(source), str(tmp_path / "a.trk"), "--verify", "sample"]) == 1
    assert "--verify" in capsys.readouterr().err
