"""The form of all measurements: kept whole by the file, fronts against brute force, errors and times measured right."""

import json
import math
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from pvfiblets.cli.command import main
from pvfiblets.errors import FormatError
from pvfiblets.report import plots
from pvfiblets.report.dot_plot import in_rows
from pvfiblets.report.page import page
from pvfiblets.report.pareto import mark_fronts, pareto
from pvfiblets.report.record import Axes, Figure, LeftOut, Record, StudyResult, Timing
from pvfiblets.report.report_file import Report
from pvfiblets.report.studies.codec.errors import distances, error_figures, median_step
from pvfiblets.report.timing import Turns, timing


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


def dominated(points, i):
    return any(q[0] <= points[i][0] and q[1] <= points[i][1] and q != points[i] for j, q in enumerate(points) if j != i)


@given(st.lists(st.tuples(st.integers(0, 6), st.integers(0, 6)), max_size=30))
def test_fronts_against_brute_force(points):
    assert pareto(points) == [not dominated(points, i) for i in range(len(points))]


def test_fronts_against_brute_force_without_what_is_not_finite():
    assert pareto([(1.0, math.nan), (math.inf, 0.0), (2.0, 3.0)]) == [False, False, True]
    assert pareto([]) == []
    axes = [Axes("k", "costs/size", "errors/max", "", ""), Axes("s", "", "errors/", "", "", series=True)]
    worse = a_record(size=2.0, error=1.0)
    others = a_record(size=2.0, error=1.0, data="e"), a_record(size=2.0, error=1.0, machine="m")
    mark_fronts([a_record(), worse, *others], axes)
    assert worse.front == []
    assert [record.front for record in others] == [["k"], ["k"]]


def test_errors_of_a_made_up_decoder_and_of_points_that_are_lost_or_broken():
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
    points = np.zeros((4, 3))
    with pytest.raises(ValueError, match="4 points were coded and 3 came back"):
        distances(points, points[:3])
    broken = points.copy()
    broken[2, 1] = np.nan
    with pytest.raises(ValueError, match="1 of 4 decoded points are not finite"):
        distances(points, broken)
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


def test_times_are_medians_of_calls_that_take_turns_until_told_to_stop():
    clock = Clock()
    turns = Turns(clock, "fake")
    (first, at_first), (second, at_second) = taking(clock, [0.1, 0.3, 0.2, 0.4, 0.2]), taking(clock, [0.05])
    assert [turns.add(first), turns.add(second)] == [0, 1]
    turns.run(5)
    told = turns.timing(0, 10, "ray")
    assert (told.repeats, told.items, told.item, told.clock) == (5, 10.0, "ray", "fake")
    assert (told.median, told.low, told.high) == pytest.approx((0.2, 0.1, 0.4))
    assert told.each == pytest.approx(0.02)
    order = sorted([(at, 0) for at in at_first] + [(at, 1) for at in at_second])
    assert [which for _, which in order] == [0, 1] * 5
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
    clock = Clock()
    turns = Turns(clock)
    work, _ = taking(clock, [0.1])
    turns.add(work)
    turns.run(9, lambda: clock.now < 0.35)
    assert turns.timing(0, 1).repeats == 4
    turns.run(9, lambda: False)
    assert turns.timing(0, 1).repeats == 4
    # Of 1, 2 and 9 seconds it is 2: one call that something disturbed does not show.
    ends = iter([0.0, 1.0, 1.0, 10.0, 10.0, 12.0])
    turns = Turns(lambda: next(ends), "test")
    turns.add(lambda: None)
    turns.run(3)
    assert turns.timing(0, 4.0) == Timing(2.0, 1.0, 9.0, 3, 4.0, "point", "test")
    assert timing([9.0, 1.0, 2.0, 2.5, 1.5], 4.0, "segment", "test") == Timing(2.0, 1.0, 9.0, 5, 4.0, "segment", "test")


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


ABOUT = {
    "name": "m", "processor": "Some CPU", "cores": 2, "system": "Linux", "python": "3.11", "driver": "none",
    "versions": {"numpy": "2.0"}, "seed": 7, "quick": False, "date": "2026-01-01", "load": 9.0,
}  # fmt: skip


def made():
    """A study of two sets with known numbers: the default is beaten on the first by rival 1, in both figures."""
    axes = [
        Axes("size", "costs/size", "errors/max", "bytes per point", "largest error, mm"),
        Axes("time", "times/pack", "errors/max", "pack, ns per point", "largest error, mm"),
        Axes("drift", "", "errors/mean at point ", "point", "mean error", series=True),
    ]
    records = []
    for data, group in (("one", "g"), ("two|2", "g"), ("tiny", "")):
        for i, (size, error, seconds) in enumerate([(2.0, 0.5, 1.0), (1.0, 0.25, 2.0), (4.0, 0.0, 0.5)]):
            records.append(
                Record(
                    data, group, "points", "ours" if i == 0 else f"rival {i}", "",
                    {"max": Figure(error, "mm"), "mean at point 1": Figure(0.1, "mm"),
                     "mean at point 9": Figure(0.2 + i, "mm")},
                    {"size": Figure(size, "bytes/point")},
                    {"pack": Timing(seconds, 0.9 * seconds, 1.1 * seconds, 5, 1e6, "point", "cpu")},
                    ours=i == 0, default=i == 0,
                )
            )  # fmt: skip
    mark_fronts(records, axes)
    study = StudyResult("codec", "Kept points", "Points.", ["Note."], axes, records, [LeftOut("x.tck", "it | is bad")])
    return Report(dict(ABOUT), [study, StudyResult("tubes", "Tubes", "", unavailable="no context")])


def test_the_page_says_what_the_numbers_say():
    text = page(made(), {"codec": [("a.png", "errors")]})
    assert "Some CPU" in text
    assert "seed 7" in text
    assert "Other programs ran beside this: 9 wanted to" in text
    assert "| tubes | not available | no context |" in text
    assert "![errors](a.png)" in text
    assert "| x.tck | it \\| is bad |" in text
    assert "| one | 0.5 / 2: rival 1 | 0.5 / 1e+03: rival 2 |" in text
    assert "| **ours** |  | 2 | 0.5 | 1 (0.909–1.11) | 1 |  |" in text
    assert "| rival 1 |  | 1 | 0.25 | 0.5 (0.455–0.556) | 0.5 | size |" in text
    assert "| rival 2 |  | 4 | 0 | 2 (1.82–2.22) | 2 | size, time |" in text
    assert "mean at point" not in text.replace("mean error", "")


def test_page_and_plots_are_made_again_from_the_file_alone(tmp_path):
    made().save(tmp_path / "first")
    assert main(["report", "--from", str(tmp_path / "first" / "report.json"), "-o", str(tmp_path / "again")]) == 0
    names = sorted(path.name for path in (tmp_path / "again").iterdir())
    assert names == [
        "codec-drift-g.png", "codec-size-g.png", "codec-time-g.png", "report.json", "report.md",
    ]  # fmt: skip
    assert (tmp_path / "again" / "report.json").read_bytes() == (tmp_path / "first" / "report.json").read_bytes()
    for name in names[:3]:
        assert f"]({name})" in (tmp_path / "again" / "report.md").read_text()
        picture = np.asarray(Image.open(tmp_path / "again" / name).convert("RGB"))
        assert (picture == [0x00, 0x72, 0xB2]).all(axis=2).sum() > 50  # the default's colour is there
        assert picture.std() > 5


def test_other_wrong_calls_are_told_before_anything_is_measured(tmp_path, capsys):
    assert main(["report", "--only", "codec", "--data", str(tmp_path / "no.tck"), "-o", str(tmp_path)]) == 1
    assert "no.tck" in capsys.readouterr().err
    assert main(["report", "--from", str(tmp_path / "none.json"), "-o", str(tmp_path)]) == 1
    assert "none.json" in capsys.readouterr().err
    assert main(["report", "--from", "x.json", "--quick", "-o", str(tmp_path)]) == 1
    assert "--from" in capsys.readouterr().err
    assert main(["report", "--only", "codec", "--minutes", "-1", "-o", str(tmp_path)]) == 1
    assert "minutes is -1.0; give a number above 0" in capsys.readouterr().err
    with pytest.raises(SystemExit):
        main(["report"])


def test_pictures_are_told_in_milliseconds_per_frame():
    axes = [Axes("time", "times/draw", "errors/wrong", "ms per frame", "wrong pixels, %")]
    records = [
        Record("brain", "g", "pictures", method, "", {"wrong": Figure(error, "%")},
               times={"draw": Timing(seconds, 0.5 * seconds, 2.0 * seconds, 3, 4, "frame", "cpu")},
               ours=ours, default=ours)
        for method, error, seconds, ours in (("ours", 0.5, 0.1, True), ("rival", 0.25, 0.02, False))
    ]  # fmt: skip
    text = page(Report(dict(ABOUT), [StudyResult("culling", "Culling", "", [], axes, records)]), {})
    assert "| method | setting | wrong, % | draw, ms per frame | × default | front |" in text
    assert "| **ours** |  | 0.5 | 25 (12.5–50) | 1 |  |" in text
    assert "| rival |  | 0.25 | 5 (2.5–10) | 0.2 |  |" in text
    assert "| brain | 0.5 / 25: rival |" in text
    assert records[0].in_unit("times/draw") == 25.0
    assert records[0].in_unit("errors/wrong") == 0.5


def each_adds():
    """What costs what, beside a plain method: nothing of it is an alternative."""
    axes = [Axes("cost", "times/draw", "costs/memory", "ms per frame", "memory, MB", alternatives=False)]
    records = [
        Record("scene", "s", "nothing", method, setting, {}, {"memory": Figure(memory, "MB")},
               {"draw": Timing(seconds, seconds, seconds, 3, 1, "frame", "cpu")}, ours=True, default=method == "plain")
        for method, setting, memory, seconds in (
            ("plain", "", 5.0, 0.02), ("lines", "wide", 5.0, 0.04), ("cut", "mesh", 20.0, 0.03),
            ("cut", "ball", 4.0, 0.01),
        )
    ]  # fmt: skip
    mark_fronts(records, axes)
    return StudyResult("features", "Costs", "", [], axes, records)


def test_where_nothing_is_a_rival_there_is_no_front_and_nothing_beats_the_default(tmp_path):
    study = each_adds()
    assert not any(record.front for record in study.records)
    text = page(Report(dict(ABOUT), [study]), {}).split("## Costs")[1]
    assert "### The default" not in text
    assert "front" not in text
    assert "| method | setting | memory, MB | draw, ms per frame | × default |" in text
    assert "| cut | mesh | 20 | 30 (30–30) | 1.5 |" in text
    made = plots.draw(Report(dict(ABOUT), [study, *synthetic_baselines()]), tmp_path)
    assert made["features"] == [("features-cost-s.png", "ms per frame and memory, MB of each: s")]
    assert made["codec"][0][1] == "largest error, mm against bytes per point: g"
    kept = Report.from_json(Report(dict(ABOUT), [study]).to_json()).studies[0]
    assert kept.axes == study.axes


def synthetic_baselines():
    return made().studies[:1]


def test_rows_show_each_figure_from_the_plain_one_on():
    study = each_adds()
    picture = in_rows(study, study.records, study.axes[0], dict.fromkeys(("plain", "lines", "cut"), "#0072b2"))
    times, memory = picture.axes
    assert [label.get_text() for label in times.get_yticklabels()] == ["plain", "lines: wide", "cut: mesh", "cut: ball"]
    for panel, figures in ((times, [20.0, 40.0, 30.0, 10.0]), (memory, [5.0, 5.0, 20.0, 4.0])):
        drawn = [line.get_xydata().tolist() for line in panel.get_lines()]
        for row, value in enumerate(figures):
            assert [[figures[0], row], [value, row]] in drawn
            assert [[value, row]] in drawn
        assert len(panel.get_xticks()) >= 3
    assert (times.get_xlabel(), memory.get_xlabel()) == ("ms per frame", "memory, MB")


def test_no_two_methods_of_a_picture_have_one_colour_and_its_titles_fit():
    """However many methods other pictures of the study show, and however long the name of a file is."""
    name = "a_name_of_a_file_that_somebody_thought_about_for_long.trk.gz, 3,379 of 20,505 streamlines"
    records = [
        Record(name if k < 12 else "other", "g" if k < 12 else "h", "", f"method {k % 24}", f"setting {k}",
               {"max": Figure(0.5 + k, "mm")}, {"size": Figure(2.0 + k, "bytes")})
        for k in (*range(12, 30), *range(12))
    ]  # fmt: skip
    pair = Axes("a", "costs/size", "errors/max", "bytes", "mm")
    study = StudyResult("x", "X", "", [], [pair], records)
    picture = plots.in_panels(study, records[18:], pair)
    marks = [line for line in picture.axes[0].get_lines() if len(line.get_xdata()) == 1]
    looks = {(line.get_color(), line.get_marker()) for line in marks}
    assert len({colour for colour, _ in looks}) == len({marker for _, marker in looks}) == 12
    picture.canvas.draw()
    title, whole = picture.axes[0].title.get_window_extent(), picture.bbox
    assert whole.x0 <= title.x0
    assert title.x1 <= whole.x1


def test_what_many_things_were_left_out_for_is_told_once():
    left = [LeftOut(f"method {k}", "no time | left") for k in range(9)] + [LeftOut("x.tck", "empty")]
    text = page(Report(dict(ABOUT), [StudyResult("x", "X", "", left_out=left)]), {})
    assert "| 9 methods, listed below | no time \\| left |" in text
    assert "| x.tck | empty |" in text
    assert text.count("no time") == 2
    assert all(f"- method {k}\n" in text for k in range(9))
    assert text.index("| x.tck") < text.index("<details>") < text.index("- method 0") < text.index("</details>")


def test_measuring_needs_no_vtk_and_no_matplotlib(tmp_path, monkeypatch, capsys):
    code = (
        "import sys, pvfiblets.report.run, pvfiblets.cli.report\n"
        "import pvfiblets.report.studies.codec.study, pvfiblets.report.studies.decode.study\n"
        "from pvfiblets.report.studies.codec.data_sets import synthetic_tracking\n"
        "synthetic_tracking(1.0, True, 500, 0)\n"
        "print(sorted({'vtkmodules', 'vtk', 'pyvista', 'matplotlib', 'dipy'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    monkeypatch.delitem(sys.modules, "pvfiblets.report.plots", raising=False)
    made().save(tmp_path)
    assert main(["report", "--from", str(tmp_path), "-o", str(tmp_path)]) == 0
    assert "no plots" in capsys.readouterr().err
    assert not list(tmp_path.glob("*.png"))
