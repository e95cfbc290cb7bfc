"""Writers that hold float32 only name the arrays that this changes, and by how much."""

from __future__ import annotations

import re
import warnings

import nibabel as nib
import numpy as np
import pytest

import pvfiblets
from pvfiblets.streamlines import Streamlines


def test_trk_tells_the_largest_change_of_each_array(tmp_path):
    rng = np.random.default_rng(0)
    points = rng.uniform(0, 80, (60, 3)) + (512345.678, 5423456.789, 312.5)
    times, mild = 1.7e9 + np.linspace(0, 60, 60), np.linspace(0, 1, 60)
    ids = {"id": np.array([1.7e18, 1.7e18 + 1e9])}
    lines = Streamlines(points, np.array([0, 30, 60]), {"time": times, "fa": mild}, ids)
    with pytest.warns(UserWarning, match="float32") as told:
        pvfiblets.write(tmp_path / "a.trk", lines)
    text = str(told[0].message)
    assert "'fa'" not in text
    assert "'id'" in text
    back = nib.streamlines.load(tmp_path / "a.trk").tractogram
    change = float(re.search(r"'time' by up to (\S+)", text)[1])
    assert change == pytest.approx(abs(back.data_per_point["time"].get_data().ravel() - times).max(), rel=0.05)
    moved = float(re.search(r"points by up to (\S+) mm", text)[1])
    assert moved == pytest.approx(abs(back.streamlines.get_data().astype(float) - points).max(), rel=0.2)


def test_ordinary_numbers_are_written_without_a_word(tmp_path):
    points = np.random.default_rng(0).uniform(0, 200, (60, 3))
    lines = Streamlines(points, np.array([0, 60]), {"fa": np.linspace(0, 1, 60)})
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        pvfiblets.write(tmp_path / "a.trk", lines)
