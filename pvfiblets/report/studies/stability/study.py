"""The study of stability: named extreme cases, what must hold of each, and whether it does."""

from __future__ import annotations

import math
import time
import warnings
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from typing import Any

from ...drawing import drawing_context
from ...record import CaseResult, Figure, Record
from ...study import Options, Study, Unavailable
from . import all_cases
from .case import Case, Setting


def result_of(case: Case, setting: Setting) -> CaseResult:
    """Run one case; an unexpected error is its result. Warnings count as errors."""
    begun = time.perf_counter()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            found = case.run(setting)
    except Exception as error:  # noqa: BLE001 - the report records any error and goes on
        said, figure, limit, held = f"{type(error).__name__}: {error}", Figure(math.nan, ""), math.nan, False
    else:
        said, figure, limit, held = found.note, Figure(found.measured, found.unit), found.limit, found.held
    if setting.ctx is not None and (code := setting.ctx.error) != "GL_NO_ERROR":
        said, held = f"{code} {said}".strip(), False
    if case.known and not held:
        said = f"known: {case.known}" + (f" ({said})" if said else "")
    seconds = round(time.perf_counter() - begun, 2)
    return CaseResult(case.system, case.name, case.does, case.must, figure, limit, held, said, seconds)


def in_turn(cases: Sequence[Case]) -> list[Case]:
    """Return one case of each system after the other, and the long ones last: every system has some in a short time."""
    turn: Counter[str] = Counter()
    order = []
    for case in cases:
        order.append((case.long, turn[case.system]))
        turn[case.system] += 1
    return [cases[i] for i in sorted(range(len(cases)), key=order.__getitem__)]


def run(options: Options) -> Iterator[Record | CaseResult]:
    """Yield a result for every case."""
    late: Counter[str] = Counter()
    count, broken = 0, 0
    with ExitStack() as stack:
        ctx: Any = None
        try:
            ctx = stack.enter_context(drawing_context(options))
        except Unavailable as error:
            options.leave_out("all cases that draw", str(error))
        for case in in_turn(all_cases()):
            if case.draws and ctx is None:
                continue
            if not (options.budget.allows() if case.long else options.budget.left > 0.0):
                late[case.system] += 1
                continue
            found = result_of(case, Setting(not options.quick, ctx))
            count, broken = count + 1, broken + (not found.held)
            if not found.held:
                options.log(f"stability: {case.system}: {case.name}: does not hold ({found.note})")
            yield found
    for system, number in late.items():
        options.leave_out(f"{system}: {number} cases", "the time given was used up")
    options.log(f"stability: {count - broken} of {count} cases hold")


STUDY = Study(
    name="stability",
    title="Stiff and extreme cases",
    approximates=(
        "Conditions on any data, camera or file: each case states one, and judges a measured figure "
        "by an error bound, a formula, or NumPy in float64."
    ),
    axes=(),
    notes=(
        "A figure of *calls not refused* counts wrong input that did not end in the error it must end in; the last "
        "column then has the error's text. Tests run the same cases. The largest are smaller there, and in a quick "
        "report, as they say.",
    ),
    run=run,
)
