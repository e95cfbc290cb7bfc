"""Whole tractograms and their pixels: tables 1 and figure 8 of the fiblets paper, on very little data."""

import numpy as np
import pytest

from pvfiblets import compress, formats
from pvfiblets.report import run
from pvfiblets.report.page import page
from pvfiblets.report.record import Figure
from pvfiblets.report.report_file import Report
from pvfiblets.report.studies.codec import pixels
from pvfiblets.report.studies.codec.data_sets import DataSet
from pvfiblets.report.studies.codec.pixels import STUDY as PIXELS
from pvfiblets.report.studies.codec.pixels import beyond
from pvfiblets.report.studies.codec.tractograms import STUDY
from pvfiblets.synthetic.trackers import ALGORITHMS, tracked_streamlines

from .little import little


def turns_of(streamlines):
    """Return steps, and angles between them in degrees."""
    steps, angles = [], []
    for line in streamlines:
        run_ = np.diff(np.asarray(line, np.float64), axis=0)
        size = np.linalg.norm(run_, axis=1)
        u = run_ / size[:, None]
        steps.append(size)
        angles.append(np.degrees(np.arccos(np.clip((u[1:] * u[:-1]).sum(1), -1.0, 1.0))))
    return np.concatenate(steps), np.concatenate(angles)


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_made_up_tracking_turns_as_its_algorithm_does(algorithm):
    made = tracked_streamlines(algorithm, 40, 0.5, seed=3)
    steps, angles = turns_of(made)
    noisy = algorithm.startswith("iFOD")
    assert np.median(steps) == pytest.approx(0.5, rel=2e-3)
    assert (steps.std() > 2e-4) == (algorithm == "iFOD2"), "chords of arcs vary, steps of others do not"
    assert (np.median(angles) > 4.0) == noisy
    if not noisy:  # EuDX turns where voxels end, a smooth field everywhere
        assert (np.quantile(angles, 0.999) > 8.0 * np.median(angles)) == (algorithm == "EuDX")
    again = tracked_streamlines(algorithm, 40, 0.5, seed=3)
    np.testing.assert_array_equal(made.points, again.points)


def test_whole_sets_and_whole_files(tmp_path):
    lines = tracked_streamlines("SD_STREAM", 12, 0.2)
    formats.write(tmp_path / "some.tck", lines)
    left_out = []
    records = list(STUDY.run(little(points=2000, files=(tmp_path,), left_out=left_out)))
    assert left_out == []
    assert {record.data for record in records} >= {"iFOD1-like, 0.1 mm", "EuDX-like, 0.5 mm", "some.tck"}
    (ours,) = [record for record in records if record.data == "some.tck" and record.default]
    read = formats.read(tmp_path / "some.tck")
    fiblets = compress(read, exact=False)
    off = np.linalg.norm(fiblets.decompress().points.astype(np.float64) - read.points, axis=1)
    assert ours.errors["max"] == Figure(pytest.approx(off.max()), "mm")
    assert ours.errors["mean of a step"] == Figure(pytest.approx(100.0 * off.mean() / 0.2, rel=1e-3), "%")
    raw = 12 * (read.n_points + len(read))
    assert ours.costs["ratio"].value == pytest.approx(raw / fiblets.nbytes, rel=1e-3)


def test_one_table_shows_all_data_sets(tmp_path):
    result = run.one_study("tractograms", little(points=2000))
    assert result.across
    about = {
        "processor": "p", "cores": 2, "system": "s", "python": "3", "driver": "d", "date": "today", "seed": 0,
        "quick": True, "versions": {}, "load": 0.0, "name": "m",
    }  # fmt: skip
    report = Report(about, [result])
    report.save(tmp_path)
    assert Report.load(tmp_path).studies[0].across == result.across
    rows = page(report, {}).splitlines()
    assert "In each cell: **fiblets (default)** / QFib (8 bits) / paper's fiblets." in rows
    (row,) = [row for row in rows if row.startswith("| EuDX-like, 0.5 mm | ") and row.count(" / ") > 6]
    ours = next(r for r in result.records if r.data == "EuDX-like, 0.5 mm" and r.default)
    assert row.split(" | ")[1].startswith(f"{ours.costs['ratio'].value:.3g} / ")


def test_pixels_that_have_none_beside_them():
    shown, other = np.zeros((2, 6, 7), bool)
    shown[2, 2] = shown[5, 6] = other[3, 3] = True
    assert np.argwhere(beyond(shown, other)).tolist() == [[5, 6]]
    assert not beyond(shown, shown).any()


def test_compressed_lines_are_nowhere_more_than_a_pixel_off(monkeypatch):
    lines = tracked_streamlines("iFOD1", 8, 0.2)
    monkeypatch.setattr(pixels, "_sets", lambda options: [DataSet("few", "few", lines)])
    monkeypatch.setattr(pixels, "QUICK_SIZE", (120, 90))
    records = list(PIXELS.run(little()))
    assert {record.setting for record in records} >= {"drawn", "by VTK"}
    assert {record.data for record in records} == {"few, far", "few, close"}
    for record in records:
        if record.method == "fiblets":
            assert record.errors["beyond a pixel"].value == 0.0
        if (record.method, record.setting) == ("fiblets", "by VTK"):
            assert record.errors["other"].value < 3.0
