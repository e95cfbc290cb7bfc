"""A run of studies, which writes ``report.json``, the page and the plots."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path

from . import machine, studies
from .pareto import mark_fronts
from .record import CaseResult, StudyResult
from .report_file import Report
from .studies.codec.data_sets import files_of
from .study import Budget, Options, Unavailable

QUICK_SECONDS = 120.0  # of a quick report, plots included
PLOT_SECONDS = 30.0  # of these, kept for the page and the plots
QUICK_REPEATS = 3
SAVE_SHARE = 0.02  # of the time, for saving what a study has found so far: a run may be cut short

Log = Callable[[str], None]


def to_stderr(line: str) -> None:
    """Print a line to standard error."""
    print(line, file=sys.stderr, flush=True)


def make_report(
    folder: Path,
    *,
    only: Sequence[str] | None = None,
    data: Sequence[Path] = (),
    quick: bool = False,
    minutes: float | None = None,
    seed: int = 0,
    log: Log = to_stderr,
    clock: Callable[[], float] = time.monotonic,
) -> Report:
    """Run studies and collect their records."""
    names = studies.chosen_names(only)
    if minutes is not None and not minutes > 0.0:
        raise ValueError(f"minutes is {minutes}; give a number above 0")
    if seed < 0:
        raise ValueError(f"seed is {seed}; give a whole number, 0 or more")
    files_of(data)  # a wrong name is an error before any measurement
    report = Report(machine.about(seed, quick))
    seconds = 60.0 * minutes if minutes is not None else QUICK_SECONDS - PLOT_SECONDS if quick else float("inf")
    whole = Budget(seconds, clock)
    next_save = clock()

    def keep(so_far: StudyResult) -> None:
        nonlocal next_save
        if (begun := clock()) >= next_save:
            Report(report.about, [*report.studies, so_far]).save(folder)
            next_save = clock() + (clock() - begun) / SAVE_SHARE

    for done, name in enumerate(names):
        options = Options(
            quick=quick,
            budget=Budget(whole.left / (len(names) - done), clock),
            files=tuple(data),
            seed=seed,
            machine=report.about["name"],
            log=log,
        )
        if quick:
            options.repeats = QUICK_REPEATS
        report.studies.append(one_study(name, options, keep))
        if options.driver:
            report.about["driver"] = options.driver
        report.save(folder)
    return report


def one_study(name: str, options: Options, keep: Callable[[StudyResult], None] = lambda _: None) -> StudyResult:
    """Run one study; where it cannot be done, return the reason. ``keep`` is called after each record."""
    study = studies.find(name)
    result = StudyResult(study.name, study.title, study.approximates, list(study.notes), list(study.axes))
    result.across, result.left_out = list(study.across), options.left_out
    options.log(f"{name}: {study.title}")
    try:
        for found in study.run(options):
            if isinstance(found, CaseResult):
                result.cases.append(found)
            else:
                found.machine = options.machine
                result.records.append(found)
            keep(result)
    except Unavailable as error:
        result.unavailable = str(error)
        options.log(f"{name}: {error}")
    mark_fronts(result.records, result.axes)
    result.seconds = round(options.budget.spent, 1)
    return result


def write_pages(report: Report, folder: Path, log: Log = to_stderr) -> Path:
    """Make the plots and the page of a report, from its numbers alone, and return the page's path."""
    from .page import page

    folder.mkdir(parents=True, exist_ok=True)
    try:
        from .plots import draw
    except ImportError as error:
        log(f"no plots: {error.name} is not installed")
        pictures = {}
    else:
        pictures = draw(report, folder)
    path = folder / "report.md"
    path.write_text(page(report, pictures), encoding="utf-8")
    return path
