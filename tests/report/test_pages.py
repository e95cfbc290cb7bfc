"""The command, the page and the plots."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest
from PIL import Image

from pvfiblets.cli import main
from pvfiblets.report import plots, studies
from pvfiblets.report.dot_plot import in_rows
from pvfiblets.report.page import page
from pvfiblets.report.pareto import mark_fronts
from pvfiblets.report.record import Axes, Figure, LeftOut, Record, StudyResult, Timing
from pvfiblets.report.report_file import Report

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


def test_a_wrong_study_is_one_clear_error(tmp_path, capsys):
    assert main(["report", "--only", "codec", "colour", "-o", str(tmp_path)]) == 1
    error = capsys.readouterr().err
    assert error.startswith("pvfiblets: there is no study 'colour'; choose among codec, decode, ")
    assert all(name in error for name in studies.chosen_names())
    assert not list(tmp_path.iterdir())


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


def test_the_command_lists_every_study(capsys):
    with pytest.raises(SystemExit):
        main(["report", "--help"])
    said = " ".join(capsys.readouterr().out.split())
    assert ", ".join(studies.MODULES) in said


def test_each_default_is_told_at_its_own_figures_only():
    axes = [Axes("a", "costs/size", "errors/max", "bytes", "mm"), Axes("b", "costs/size", "errors/wrong", "bytes", "%")]
    records = [
        Record(data, "g", "", method, "", {error: Figure(0.5, "mm")}, {"size": Figure(2.0, "bytes")}, default=True)
        for data, method, error in (("points", "ours", "max"), ("pixels", "theirs", "wrong"))
    ]
    text = page(Report(dict(ABOUT), [StudyResult("x", "X", "", [], axes, records)]), {})
    assert "By default: **ours**, **theirs**." in text
    assert "| points | 0.5 / 2 |  |" in text
    assert "| pixels |  | 0.5 / 2 |" in text


@pytest.mark.parametrize(("number", "shown"), [(5.0, "5"), (2e4, "20000"), (1e5, "$10^{5}$"), (1e-6, "$10^{-6}$"),
                                               (2e6, r"$2 \cdot 10^{6}$")])  # fmt: skip
def test_ticks_are_short(number, shown):
    assert plots._short(number) == shown


def test_data_sets_without_a_pairs_figures_take_no_room_in_its_picture(tmp_path):
    def widths(extra):
        records = [Record("points", "g", "", "ours", "", {"max": Figure(0.5, "mm")}, {"size": Figure(2.0, "bytes")})]
        records += [Record(name, "g", "", "ours", "", {"wrong": Figure(0.5, "%")}, {"size": Figure(2.0, "bytes")})
                    for name in extra]  # fmt: skip
        axes = [Axes("a", "costs/size", "errors/max", "bytes", "mm")]
        plots.draw(Report(dict(ABOUT), [StudyResult("x", "X", "", [], axes, records)]), tmp_path)
        with Image.open(tmp_path / "x-a-g.png") as picture:
            return picture.size

    assert widths(["pixels", "voxels"]) == widths([])


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
    picture = plots._picture(study, records[18:], pair, dict.fromkeys((f"method {k}" for k in range(24)), "black"))
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


def test_numbers_of_one_are_singular():
    axes = [Axes("a", "costs/size", "errors/max", "bytes", "mm")]
    one = Record("points", "g", "", "ours", "", {"max": Figure(0.5, "mm")}, {"size": Figure(2.0, "bytes")})
    other = Record("more", "g", "", "ours", "", {"max": Figure(0.5, "mm")}, {"size": Figure(2.0, "bytes")})
    for records, told in (([one], "1 record on 1 data set,"), ([one, other], "2 records on 2 data sets,")):
        assert told in page(Report(dict(ABOUT), [StudyResult("x", "X", "", [], axes, records)]), {})


def test_measuring_needs_no_vtk_and_no_matplotlib():
    code = (
        "import sys, pvfiblets.report.run, pvfiblets.report.codec, pvfiblets.report.decode, pvfiblets.cli_report\n"
        "from pvfiblets.report.data_sets import synthetic_tracking\n"
        "synthetic_tracking(1.0, True, 500, 0)\n"
        "print(sorted({'vtkmodules', 'vtk', 'pyvista', 'matplotlib', 'dipy'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_without_matplotlib_there_is_a_page_without_plots(tmp_path, monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    monkeypatch.delitem(sys.modules, "pvfiblets.report.plots", raising=False)
    made().save(tmp_path)
    assert main(["report", "--from", str(tmp_path), "-o", str(tmp_path)]) == 0
    assert "no plots" in capsys.readouterr().err
    assert not list(tmp_path.glob("*.png"))
