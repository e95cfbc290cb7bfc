"""The Markdown page of a report."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from .record import FRAME, CaseResult, LeftOut, Record, StudyResult, Timing
from .report_file import Report

MANY = 6  # rows that a table has for one reason

_WHAT = (
    "The approximations of pvfiblets: the distance of each from the exact answer, and its cost, beside other "
    "methods. A study compares methods on several data sets; the program's own default is **bold**. Plots "
    "show cost to the right and error upwards, so that good methods are at the lower left."
)

Pictures = Mapping[str, Sequence[tuple[str, str]]]


def page(report: Report, pictures: Pictures) -> str:
    """Write a report as Markdown."""
    lines = ["# Error against run time", "", _WHAT, "", *_about(report.about), "", *_overview(report.studies)]
    for study in report.studies:
        if not study.unavailable:
            lines += ["", *_study(study, pictures.get(study.name, ()))]
    return "\n".join(lines) + "\n"


def _about(about: Mapping[str, Any]) -> list[str]:
    versions = ", ".join(f"{name} {version}" for name, version in about["versions"].items())
    lines = [
        f"{about['processor']}, {about['cores']} cores; {about['system']}; Python {about['python']}; OpenGL: "
        f"{about['driver']}. {about['date']}, seed {about['seed']}{', quick' if about['quick'] else ''}.",
        "",
        f"{versions}.",
        "",
        "Times are medians of repeats in one run, least and greatest in brackets, read from the processor time of one "
        "process unless said otherwise; compare ratios rather than seconds between machines. *front*: no other method "
        "of the table is at least as good in both figures and better in one.",
    ]
    if about.get("load", 0.0) > 0.5 * (about["cores"] or 1):
        lines += [
            "",
            f"Other programs ran beside this: {about['load']:g} wanted to when it began, on {about['cores']} cores.",
        ]
    return lines


def _overview(studies: Sequence[StudyResult]) -> list[str]:
    lines = ["| study | measured | left out |", "|---|---|---|"]
    for study in studies:
        if study.unavailable:
            lines.append(f"| {study.name} | not available | {_cell(study.unavailable)} |")
            continue
        found = f"{_found(study)}, {study.seconds:.0f} s"
        more = f"{len(study.left_out)}, named there" if study.left_out else ""
        lines.append(f"| [{study.name}](#{_anchor(study.title)}) | {found} | {more} |")
    return lines


def _found(study: StudyResult) -> str:
    if study.cases:
        return f"{sum(case.held for case in study.cases)} of {len(study.cases)} extreme cases hold"
    sets = len({record.data for record in study.records})
    return f"{_count(len(study.records), 'record')} on {_count(sets, 'data set')}"


def _count(number: int, what: str) -> str:
    return f"{number} {what}{'' if number == 1 else 's'}"


def _study(study: StudyResult, pictures: Sequence[tuple[str, str]]) -> list[str]:
    lines = [f"## {study.title}", "", study.approximates]
    for note in study.notes:
        lines += ["", note]
    if study.across and study.records:
        lines += ["", "### All data sets", "", *_across(study)]
    if any(record.default for record in study.records) and any(pair.has_front for pair in study.axes):
        lines += ["", "### The default", "", *_defaults(study)]
    for name, shows in pictures:
        lines += ["", f"![{shows}]({name})"]
    if study.left_out:
        lines += ["", "### Left out", "", *_left_out(study.left_out)]
    lines += _cases(study.cases)
    if not study.records:
        return lines
    lines += ["", "### All figures"]
    for data in dict.fromkeys(record.data for record in study.records):
        records = [record for record in study.records if record.data == data]
        lines += ["", "<details>", f"<summary>{data}</summary>", "", *_table(study, records), "", "</details>"]
    return lines


def _left_out(items: Sequence[LeftOut]) -> list[str]:
    """A table of skipped measurements with reasons; a common reason is written once, with its cases folded below."""
    by_reason: dict[str, list[str]] = {}
    for item in items:
        by_reason.setdefault(item.reason, []).append(item.what)
    lines, folded = ["| what | why |", "|---|---|"], []
    for reason, whats in by_reason.items():
        if len(whats) <= MANY:
            lines += [f"| {_cell(what)} | {_cell(reason)} |" for what in whats]
            continue
        lines.append(f"| {len(whats)} methods, listed below | {_cell(reason)} |")
        folded += ["", "<details>", f"<summary>{len(whats)} left out: {reason}</summary>", ""]
        folded += [*(f"- {' '.join(what.split())}" for what in whats), "", "</details>"]
    return lines + folded


def _defaults(study: StudyResult) -> list[str]:
    """The default on every data set that is drawn, and what beats it."""
    pairs = [pair for pair in study.axes if pair.has_front]
    heads = [f"{pair.y_label} / {pair.x_label}" for pair in pairs]
    shown = [record for record in study.records if record.group]
    labels = dict.fromkeys(record.label for record in study.records if record.default)
    lines = [
        f"By default: {', '.join(f'**{label}**' for label in labels)}. At each pair of figures: its own two, and after "
        "a colon the methods that beat it in both, in time by more than repeats differ.",
        "",
        "| data | " + " | ".join(heads) + " |",
        "|---|" + "---|" * len(heads),
    ]
    for record in (record for record in shown if record.default):
        cells = []
        for pair in pairs:
            x, y = record.in_unit(pair.x), record.in_unit(pair.y)
            if not math.isfinite(y):  # a pair that is for other data sets
                cells.append("")
                continue
            beaten = [
                other.label
                for other in shown
                if (other.data, other.machine) == (record.data, record.machine)
                and all(_less(other, record, path) for path in (pair.x, pair.y))
            ]
            cells.append(f"{_number(y)} / {_number(x)}" + (f": {'; '.join(beaten)}" if beaten else ""))
        lines.append(f"| {_cell(record.data)} | " + " | ".join(map(_cell, cells)) + " |")
    return lines


def _across(study: StudyResult) -> list[str]:
    """Some figures of all data sets, one row each: method beside method."""
    labels = list(dict.fromkeys(record.label for record in study.records))
    heads = []
    for path in study.across:
        kind, _, name = path.partition("/")
        having = [record for record in study.records if math.isfinite(record.value(path))]
        if kind == "times":
            heads.append(f"{name}, M {having[0].times[name].item}s/s" if having else name)
        else:
            heads.append(f"{name}, {_unit(having, kind, name)}" if having else name)
    lines = [
        f"In each cell: {' / '.join(f'**{label}**' if _is_default(study, label) else label for label in labels)}.",
        "",
        "| data | " + " | ".join(heads) + " |",
        "|---|" + "---|" * len(heads),
    ]
    for data in dict.fromkeys(record.data for record in study.records):
        found = {record.label: record for record in study.records if record.data == data}
        cells = []
        for path in study.across:
            numbers = []
            for label in labels:
                value = found[label].value(path) if label in found else math.nan
                numbers.append(_number(1e-6 / value if path.startswith("times/") and value > 0.0 else value) or "–")
            cells.append(" / ".join(numbers))
        lines.append(f"| {_cell(data)} | " + " | ".join(map(_cell, cells)) + " |")
    return lines


def _is_default(study: StudyResult, label: str) -> bool:
    return any(record.default and record.label == label for record in study.records)


def _cases(cases: Sequence[CaseResult]) -> list[str]:
    """A table for each system: input, condition, measured figure, and whether it holds."""
    lines = []
    for system in dict.fromkeys(case.system for case in cases):
        lines += ["", f"### {system[:1].upper()}{system[1:]}", ""]
        lines += [
            "| case | input | must hold | measured | at most | held | |",
            "|---|---|---|---|---|---|---|",
        ]
        for case in (case for case in cases if case.system == system):
            measured = f"{_number(case.measured.value) or 'none'} {case.measured.unit}"
            held = "yes" if case.held else "**no**"
            cells = (case.name, case.does, case.must, measured, _number(case.limit), held, case.note)
            lines.append("| " + " | ".join(map(_cell, cells)) + " |")
    return lines


def _less(a: Record, b: Record, path: str) -> bool:
    """Whether a record's figure is less than another's; of times, by more than both spread."""
    if not a.value(path) < b.value(path):
        return False
    name = path.partition("/")[2]
    return (
        not path.startswith("times/")
        or a.times[name].high / a.times[name].items < b.times[name].low / b.times[name].items
    )


def _table(study: StudyResult, records: Sequence[Record]) -> list[str]:
    series = [pair.y.partition("/")[2] for pair in study.axes if pair.series]
    costs = _names(records, "costs")
    errors = [name for name in _names(records, "errors") if not any(name.startswith(prefix) for prefix in series)]
    times = _names(records, "times")
    default = next((record for record in records if record.default), None)
    units = {name: _unit(records, "costs", name) for name in costs} | {
        name: _unit(records, "errors", name) for name in errors
    }
    heads = ["method", "setting", *(f"{name}, {units[name]}" for name in costs)]
    heads += [name if name.endswith(units[name]) else f"{name}, {units[name]}" for name in errors]
    for name in times:
        item = next(record.times[name].item for record in records if name in record.times)
        head = f"{name}, ms per frame" if item == FRAME else f"{name}, M {item}s/s"
        heads += [head, "× default"] if default else [head]
    fronts = any(pair.has_front for pair in study.axes)
    heads += ["front"] if fronts else []
    lines = ["| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
    for record in records:
        bold = "**" if record.default else ""
        cells = [f"{bold}{record.method}{bold}", record.setting]
        cells += [_number(record.value(f"costs/{name}")) for name in costs]
        cells += [_number(record.value(f"errors/{name}")) for name in errors]
        for name in times:
            timing = record.times.get(name)
            cells.append(_speed(timing))
            if default:
                base = default.times.get(name)
                cells.append(_number(_ratio(timing, base)) if timing and base else "")
        cells += [", ".join(record.front)] if fronts else []
        lines.append("| " + " | ".join(map(_cell, cells)) + " |")
    return lines


def _names(records: Sequence[Record], kind: str) -> list[str]:
    return list(dict.fromkeys(name for record in records for name in getattr(record, kind)))


def _unit(records: Sequence[Record], kind: str, name: str) -> str:
    unit: str = next(getattr(record, kind)[name].unit for record in records if name in getattr(record, kind))
    return unit


def _ratio(timing: Timing, base: Timing) -> float:
    """The figure of the column before, over the default's: of speeds, but of times for pictures."""
    return base.rate / timing.rate if timing.item == FRAME else timing.rate / base.rate


def _speed(timing: Timing | None) -> str:
    if timing is None or not math.isfinite(timing.rate):
        return ""
    if timing.item == FRAME:
        median, low, high = (timing.scale * s / timing.items for s in (timing.median, timing.low, timing.high))
        return f"{_number(median)} ({_number(low)}–{_number(high)})"
    low = timing.items / timing.high if timing.high > 0.0 else math.nan
    high = timing.items / timing.low if timing.low > 0.0 else math.nan
    return f"{_number(timing.rate / 1e6)} ({_number(low / 1e6)}–{_number(high / 1e6)})"


def _number(value: float) -> str:
    if not math.isfinite(value):
        return ""
    return "0" if value == 0.0 else f"{value:.3g}"


def _cell(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|")


def _anchor(title: str) -> str:
    return "".join(c for c in title.lower().replace(" ", "-") if c.isalnum() or c == "-")
