"""The table of extreme cases in the report: run, written, read again and printed."""

import json
import math

import pytest

from pvfiblets.report.page import page
from pvfiblets.report.record import StudyResult
from pvfiblets.report.report_file import FORMAT, Report
from pvfiblets.report.run import one_study
from pvfiblets.report.studies.stability import study
from pvfiblets.report.studies.stability.case import Case, Cases, Outcome, Setting, refused, worst
from pvfiblets.report.study import Budget, Options, Unavailable

from .test_records import ABOUT


def some_cases():
    cases = Cases("roots")
    cases.add("of nothing", "the root of 0", "0")(lambda setting: Outcome(0.0, 0.0, "mm"))
    cases.add("too far", "the root of 1", "at most 0.5")(lambda setting: Outcome(1.0, 0.5, "mm", "a note"))
    cases.add("not a number", "the root of a|b", "finite")(lambda setting: Outcome(math.nan, 1.0, "mm"))
    cases.add("broken", "the root of -1", "an error")(lambda setting: Outcome(math.sqrt(-1.0), 1.0, "mm"))
    cases.add("drawn", "a picture", "there", draws=True)(lambda setting: Outcome(float(setting.gl is None), 0.0, "px"))
    return cases


def no_context(options):
    raise Unavailable("no OpenGL here")


@pytest.fixture
def result(monkeypatch):
    """The study over the synthetic cases, where no context can be made."""

    monkeypatch.setattr(study, "all_cases", some_cases)
    monkeypatch.setattr(study, "drawing_context", no_context)
    return one_study("stability", Options(quick=True, log=lambda line: None))


def test_failed_and_unrunnable_cases_are_reported(result):
    assert [case.held for case in result.cases] == [True, False, False, False]
    assert "math domain error" in result.cases[3].note
    assert math.isnan(result.cases[3].measured.value)
    assert [(item.what, item.reason) for item in result.left_out] == [("all cases that draw", "no OpenGL here")]
    assert not result.records


def test_the_table_is_printed_and_survives_the_file(result, tmp_path):
    report = Report(dict(ABOUT), [result])
    report.save(tmp_path)
    again = Report.load(tmp_path)
    text = page(again, {})
    assert text == page(report, {})
    assert again.studies[0].cases[:2] == result.cases[:2]
    assert "1 of 4 extreme cases hold" in text
    assert "### Roots" in text
    assert "| of nothing | the root of 0 | 0 | 0 mm | 0 | yes |  |" in text
    assert "| too far | the root of 1 | at most 0.5 | 1 mm | 0.5 | **no** | a note |" in text
    assert "| not a number | the root of a\\|b | finite | none mm | 1 | **no** |  |" in text
    assert "All figures" not in text


def test_reports_of_before_there_were_cases_are_read(tmp_path):
    old = Report(dict(ABOUT), [StudyResult("codec", "Kept", "Points.")]).to_json()
    assert old["format"] == FORMAT
    del old["studies"][0]["cases"]
    (tmp_path / "report.json").write_text(json.dumps(old))
    assert Report.load(tmp_path).studies[0].cases == []


def test_an_exhausted_budget_is_reported(monkeypatch):
    monkeypatch.setattr(study, "all_cases", lambda: list(some_cases())[:2])
    monkeypatch.setattr(study, "drawing_context", no_context)
    clock = iter([0.0, 0.0, 99.0, 99.0, 99.0, 99.0]).__next__
    result = one_study("stability", Options(budget=Budget(10.0, clock), log=lambda line: None))
    assert [case.name for case in result.cases] == ["of nothing"]
    assert [item.what for item in result.left_out if "time" in item.reason] == ["roots: 1 cases"]


def test_cases_budgets_and_refusals_are_reported():
    some = [Case(system, name, "", "", len, long=name == "long") for system in "ab" for name in ("long", "x", "y")]
    assert [case.system + case.name for case in study.in_turn(some)] == ["ax", "bx", "ay", "by", "along", "blong"]
    some = [Outcome(1.0, 2.0, "mm"), Outcome(math.nan, 2.0, "mm"), Outcome(3.0, 2.0, "mm")]
    assert math.isnan(worst(some).measured)
    assert worst(some[::2]).measured == 3.0


def test_an_opengl_error_is_no_success(gl):
    case = some_cases()[0]

    class Broken:
        error = "GL_INVALID_VALUE"

    assert study.result_of(case, Setting(ctx=gl)).held
    found = study.result_of(case, Setting(ctx=Broken()))
    assert not found.held
    assert found.note == "GL_INVALID_VALUE"


def test_refusals_are_judged_by_kind_and_text():
    def fails():
        raise ValueError("step is 0; give a number above 0")

    assert refused(ValueError, "above 0", fails, fails).held
    assert refused(ValueError, "above 0", fails).note == "step is 0; give a number above 0"
    assert refused(TypeError, "above 0", fails).measured == 1.0
    assert refused(ValueError, "below 0", fails, fails).measured == 2.0
    assert refused(ValueError, "", lambda: None).note == "no error"
