"""The study of smooth edges on very little data."""

import numpy as np
import pytest

from pvfiblets.report.pareto import mark_fronts
from pvfiblets.report.studies.antialias import study as antialias
from pvfiblets.report.study import Budget

from .little import little

SIZE = (90, 70)


@pytest.fixture
def small(monkeypatch):
    for name, value in {"SEGMENTS": (3000,), "BUNDLE": 8, "TUBES": 4, "SIZE": SIZE, "REFERENCE": 4}.items():
        monkeypatch.setattr(antialias, f"QUICK_{name}", value)


@pytest.fixture
def measured(small):
    left = []
    records = list(antialias.STUDY.run(little(left_out=left)))
    assert not left
    mark_fronts(records, antialias.STUDY.axes)
    return {(record.group, record.setting): record for record in records}


@pytest.mark.more
def test_refined_pictures_are_the_nearest_to_the_mean_and_cost_as_many_frames(measured):
    groups = {group for group, _ in measured}
    assert groups == {"brain-of-3000-segments", "bundle", "tubes", "halos", "bundle-and-surface", "lines-drawn-by-VTK"}
    for group in groups:
        refined, off = measured[group, "refined"], measured[group, "off"]
        assert refined.default
        assert refined.costs["samples"].value == 16
        assert off.costs["samples"].value == 1
        assert off.value("errors/at rest") == off.value("errors/moving")
        # Halos blend with their lines without smoothing too, and pixels are large here.
        slack = 1.4 if group == "halos" else 1.0
        assert 8.0 < refined.value("errors/moving") <= slack * off.value("errors/moving")
        assert refined.value("errors/at rest") < 0.5 * slack * off.value("errors/at rest")
        assert refined.value("errors/at rest") < measured[group, "refined, 4"].value("errors/at rest")
        assert all(refined.value("errors/at rest") < one.value("errors/at rest")
                   for (of, name), one in measured.items() if of == group and not name.startswith("refined"))
        singly = measured[group, "refined, singly"]
        # Pixels are large here, and of a bent line each lights one sample for several.
        assert refined.value("errors/at rest") < 1.3 * singly.value("errors/at rest")
        assert 2.0 < refined.value("times/at rest") / refined.value("times/moving") < 60.0
        assert off.value("times/at rest") == off.value("times/moving")
        assert "rest" in {*refined.front, *singly.front}
    # VTK's multisampling smooths meshes, no lines of this program.
    for group in ("bundle", "tubes"):
        assert measured[group, "MSAA 8"].value("errors/at rest") == measured[group, "off"].value("errors/at rest")
    for group in ("bundle-and-surface", "lines-drawn-by-VTK"):
        assert measured[group, "MSAA 8"].value("errors/at rest") < measured[group, "off"].value("errors/at rest")


def test_differences_are_of_pixels_that_show_something():
    picture, reference = np.zeros((4, 5, 3)), np.zeros((4, 5, 3))
    assert antialias.differences(picture, reference) == {"rms": 0.0, "mean": 0.0, "p99": 0.0, "max": 0.0}
    picture[0, 0], reference[1, 1] = 30.0, 40.0
    found = antialias.differences(picture, reference)
    assert found["rms"] == pytest.approx(np.sqrt((30.0**2 + 40.0**2) / 2))
    assert found["mean"] == 35.0
    assert found["max"] == 40.0


def test_what_there_is_no_time_for_is_named(small):
    left = []
    assert not list(antialias.STUDY.run(little(budget=Budget(0.0), left_out=left)))
    assert [one.what for one in left][:2] == ["brain of 3,000 segments", "bundle"]
