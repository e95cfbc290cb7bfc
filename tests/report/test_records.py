"""The form of all measurements: kept whole by the file, fronts against brute force, errors and times measured right."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvfiblets.errors import FormatError
from pvfiblets.report.drawing import timing
from pvfiblets.report.errors_and_times import Turns, distances, error_figures, median_step
from pvfiblets.report.pareto import mark_fronts, pareto
from pvfiblets.report.record import Axes, Figure, LeftOut, Record, StudyResult, Timing
from pvfiblets.report.report_file import Report


def a_record(method="a", data="d", size=1.0, error=0.5, **rest):
    return Record(
        data=data, group="g", approximation="points", method=method, setting="8 bits",
        errors={"max": Figure(error, "mm")}, costs={"size": Figure(size, "bytes/point")},
        times={"pack": Timing(2.0, 1.0, 3.0, 5, 100.0, "point", "cpu")}, **rest,
    )  # fmt: skip


def a_report():
    axes = Axes("size", "costs/size", "errors/max", "bytes", "mm")
    study = StudyResult(
        "codec", "Codec", "points", ["a note"], [axes], [a_record(front=["size"]), a_record("b", error=math.nan)],
        [LeftOut("zstd", "not installed")], seconds=1.5,
    )  # fmt: skip
    away = StudyResult("volume", "Volume", "", unavailable="no graphics")
    return Report({"name": "m", "versions": {"numpy": "2"}, "quick": True}, [study, away])


def test_a_time_is_the_median_of_its_repeats():
    """Of 1, 2 and 9 seconds it is 2: one call that something disturbed does not show."""
    ends = iter([0.0, 1.0, 1.0, 10.0, 10.0, 12.0])
    turns = Turns(lambda: next(ends), "test")
    turns.add(lambda: None)
    turns.run(3)
    assert turns.timing(0, 4.0) == Timing(2.0, 1.0, 9.0, 3, 4.0, "point", "test")
    assert timing([9.0, 1.0, 2.0, 2.5, 1.5], 4.0, "segment", "test") == Timing(2.0, 1.0, 9.0, 5, 4.0, "segment", "test")


def test_a_report_comes_back_whole_from_its_file(tmp_path):
    report = a_report()
    path = report.save(tmp_path / "new folder")
    for source in (path, path.parent):
        loaded = Report.load(source)
        assert math.isnan(loaded.studies[0].records[1].errors["max"].value)
        loaded.studies[0].records[1].errors["max"] = report.studies[0].records[1].errors["max"]
        assert loaded == report
    json.loads(path.read_text(), parse_constant=lambda name: pytest.fail(f"{name} is not JSON"))


@pytest.mark.parametrize(
    "text", ["not JSON", "[]", '{"format": "something else"}', '{"format": "pvfiblets report 1", "about": {}}',
             '{"format": "pvfiblets report 1", "about": {}, "studies": [{"name": "codec"}]}'],
)  # fmt: skip
def test_what_is_no_report_is_said_so(tmp_path, text):
    path = tmp_path / "other.json"
    path.write_text(text)
    with pytest.raises(FormatError, match=r"other\.json"):
        Report.load(path)


def test_numbers_of_a_record_by_name():
    record = a_record()
    assert record.value("costs/size") == 1.0
    assert record.value("times/pack") == 0.02
    assert math.isnan(record.value("errors/none"))
    assert record.times["pack"].rate == 50.0
    with pytest.raises(ValueError, match="must begin with"):
        record.value("size")


def dominated(points, i):
    return any(q[0] <= points[i][0] and q[1] <= points[i][1] and q != points[i] for j, q in enumerate(points) if j != i)


@given(st.lists(st.tuples(st.integers(0, 6), st.integers(0, 6)), max_size=30))
def test_fronts_against_brute_force(points):
    assert pareto(points) == [not dominated(points, i) for i in range(len(points))]


def test_what_is_not_finite_is_on_no_front():
    assert pareto([(1.0, math.nan), (math.inf, 0.0), (2.0, 3.0)]) == [False, False, True]
    assert pareto([]) == []


def test_fronts_are_of_one_data_set_and_machine():
    axes = [Axes("k", "costs/size", "errors/max", "", ""), Axes("s", "", "errors/", "", "", series=True)]
    worse = a_record(size=2.0, error=1.0)
    others = a_record(size=2.0, error=1.0, data="e"), a_record(size=2.0, error=1.0, machine="m")
    mark_fronts([a_record(), worse, *others], axes)
    assert worse.front == []
    assert [record.front for record in others] == [["k"], ["k"]]


def test_errors_of_a_made_up_decoder():
    rng = np.random.default_rng(0)
    points = rng.uniform(-100, 100, (5000, 3)).astype(np.float32)
    move = rng.normal(size=(5000, 3))
    move /= np.linalg.norm(move, axis=1, keepdims=True)
    length = np.full(5000, 0.25)
    length[:3] = 1.0  # fewer than a thousandth
    apart = distances(points, points.astype(np.float64) + length[:, None] * move)
    np.testing.assert_allclose(apart, length, rtol=1e-12)
    figures = error_figures(apart, 0.5)
    assert figures["max"].value == pytest.approx(1.0)
    assert figures["max"].unit == "mm"
    assert figures["mean"].value == pytest.approx((0.25 * 4997 + 3.0) / 5000)
    assert figures["p99.9"].value == pytest.approx(0.25)
    assert figures["mean in steps"] == Figure(2.0 * figures["mean"].value, "steps")


def test_points_that_are_lost_or_broken_are_no_small_error():
    points = np.zeros((4, 3))
    with pytest.raises(ValueError, match="4 points were coded and 3 came back"):
        distances(points, points[:3])
    broken = points.copy()
    broken[2, 1] = np.nan
    with pytest.raises(ValueError, match="1 of 4 decoded points are not finite"):
        distances(points, broken)


def test_the_median_step_knows_where_streamlines_end():
    points = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [50, 0, 0], [50, 1, 0], [50, 1, 0]], float)
    assert median_step(points, np.array([0, 3, 6])) == 1.0
    assert median_step(points, np.array([0, 3, 3, 6])) == 1.0
    assert math.isnan(median_step(points[:1], np.array([0, 1])))
    assert math.isnan(median_step(points[:0], np.array([0])))


class Clock:
    """Time that passes only when something says that it takes some."""

    def __init__(self):
        self.now = 0.0

    def __call__(self):
        return self.now


def taking(clock, seconds):
    """A call that takes such times, the last one for ever, and how often it was made."""
    calls = []

    def work():
        clock.now += seconds[min(len(calls), len(seconds) - 1)]
        calls.append(clock.now)

    return work, calls


def test_times_are_medians_of_calls_that_take_turns():
    clock = Clock()
    turns = Turns(clock, "fake")
    (first, at_first), (second, at_second) = taking(clock, [0.1, 0.3, 0.2, 0.4, 0.2]), taking(clock, [0.05])
    assert [turns.add(first), turns.add(second)] == [0, 1]
    turns.run(5)
    timing = turns.timing(0, 10, "ray")
    assert (timing.repeats, timing.items, timing.item, timing.clock) == (5, 10.0, "ray", "fake")
    assert (timing.median, timing.low, timing.high) == pytest.approx((0.2, 0.1, 0.4))
    assert timing.each == pytest.approx(0.02)
    order = sorted([(at, 0) for at in at_first] + [(at, 1) for at in at_second])
    assert [which for _, which in order] == [0, 1] * 5


def test_short_calls_are_put_together_and_long_ones_made_less_often():
    clock = Clock()
    turns = Turns(clock)
    (short, shorts), (long, longs) = taking(clock, [1e-3, 1e-5]), taking(clock, [2.0])
    turns.add(short)
    turns.add(long)
    turns.run(9)
    assert turns.timing(0, 1).high == pytest.approx(1e-5)  # what could not be told from the grain is forgotten
    assert turns.timing(0, 1).repeats == 8
    assert len(shorts) == 1 + 8 * 2
    assert turns.timing(1, 1).repeats == len(longs) == 3


def test_turns_stop_when_they_are_told_to():
    clock = Clock()
    turns = Turns(clock)
    work, _ = taking(clock, [0.1])
    turns.add(work)
    turns.run(9, lambda: clock.now < 0.35)
    assert turns.timing(0, 1).repeats == 4
    turns.run(9, lambda: False)
    assert turns.timing(0, 1).repeats == 4


@pytest.mark.parametrize(
    "name", ["amd-epyc", "amd-epyc-drawing", "amd-epyc-tractograms", "amd-epyc-volumes", "intel-xeon"]
)
def test_committed_reports_are_read_and_written_under_their_names(name):
    path = Path(__file__).resolve().parents[2] / "docs/benchmarks/report" / name / "report.json"
    report, written = Report.load(path), json.loads(path.read_text(encoding="utf-8"))
    for study, before in zip(report.to_json()["studies"], written["studies"], strict=True):
        for key in ("axes", "records"):
            for row, old in zip(study[key], before[key], strict=True):
                assert {field: row[field] for field in old} == old
    first = next(study for study in report.studies if study.records)
    assert first.records[0].method == next(s for s in written["studies"] if s["records"])["records"][0]["way"]
