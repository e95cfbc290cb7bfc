"""What must hold of extreme cases does: one test for each of the table that the report prints."""

import pytest

from pvfiblets.report.studies.stability import MODULES, all_cases
from pvfiblets.report.studies.stability.case import Setting

pytestmark = pytest.mark.more

CASES = all_cases()


def named(case):
    return f"{case.system}: {case.name}"


def parameters(draws):
    """Cases to run; what is known not to hold must go on not holding until its mark is taken away."""
    marks = {True: lambda case: [pytest.mark.xfail(reason=case.known, strict=True)], False: lambda case: []}
    return [
        pytest.param(case, id=named(case), marks=marks[bool(case.known)](case)) for case in CASES if case.draws == draws
    ]


@pytest.mark.parametrize("case", parameters(False))
def test_what_must_hold_does(case):
    outcome = case.run(Setting())
    assert outcome.held, f"{outcome.measured:.4g} {outcome.unit}, at most {outcome.limit:.4g}: {outcome.note}"


@pytest.mark.parametrize("case", parameters(True))
def test_what_must_hold_of_pictures_does(gl, case):
    outcome = case.run(Setting(ctx=gl))
    assert outcome.held, f"{outcome.measured:.4g} {outcome.unit}, at most {outcome.limit:.4g}: {outcome.note}"


def test_every_case_says_what_it_does_and_what_must_hold():
    assert len({named(case) for case in CASES}) == len(CASES)
    assert len({case.system for case in CASES}) == len(MODULES)
    assert all(case.name and case.does and case.must for case in CASES)
