"""The study of translucent lines on very little data."""

import pytest

from pvfiblets.report.studies.translucency import study as translucency
from pvfiblets.report.study import Budget

from .little import little


@pytest.fixture
def small(monkeypatch):
    monkeypatch.setattr(translucency, "QUICK_SEGMENTS", 20_000)
    monkeypatch.setattr(translucency, "QUICK_SIZE", (120, 90))


@pytest.mark.more
def test_all_lines_are_nearer_to_the_exact_picture_than_few_layers(small):
    left = []
    records = {(r.group, r.setting): r for r in translucency.STUDY.run(little(left_out=left))}
    assert not left
    groups = {group for group, _ in records}
    assert groups == {f"{name}-{o}" for name in ("whole-brain", "brain-and-a-surface") for o in (0.05, 0.5)}
    for group in groups:
        error = {setting: records[group, setting].value("errors/rms") for setting, _ in translucency.WAYS}
        assert records[group, "all"].default
        assert records[group, "all"].value("costs/counted") > 0.5
        assert error["all"] < (8.0 if group.endswith("0.05") else 16.0)
        assert error["all"] < 0.6 * error["the nearest"]
        if group.endswith("0.05"):
            assert error["all"] < 0.6 * error["4 layers"]
        assert records[group, "all"].value("costs/times opaque") > 0.3


def test_what_there_is_no_time_for_is_named(small):
    left = []
    assert not list(translucency.STUDY.run(little(budget=Budget(0.0), left_out=left)))
    assert [one.what for one in left] == ["whole brain", "brain and a surface"]
