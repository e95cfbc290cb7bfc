"""Plots of a report: one picture for each pair of axes and group of data sets, made from the records alone."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure as Picture
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

from .dot_plot import in_rows
from .record import Axes, Record, StudyResult
from .report_file import Report

COLUMNS = 3
LONGEST_TITLE = 54  # letters that a panel is wide
# Distinguishable by colour-blind readers as well (Okabe and Ito), then some more.
COLOURS = (
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000",
    "#8c564b", "#7f7f7f", "#999933", "#882255", "#44aa99",
)  # fmt: skip
MARKERS = "os^DvP*X<>dph"  # unlike ones first: few pictures have more than six
ZERO_BELOW = 10.0  # errors of 0 are drawn so far under the least other one


def draw(report: Report, folder: Path) -> dict[str, list[tuple[str, str]]]:
    """Draw all pictures."""
    made: dict[str, list[tuple[str, str]]] = {}
    for study in report.studies:
        shown = [record for record in study.records if record.group]
        for pair in study.axes:
            for group in dict.fromkeys(record.group for record in shown):
                records = [record for record in shown if record.group == group and _points(record, pair)]
                name = f"{study.name}-{pair.key}-{group}.png"
                if not records:
                    continue
                if pair.alternatives:
                    shows = f"{pair.y_label} against {pair.x_label}: {group}"
                    picture = in_panels(study, records, pair)
                else:
                    shows = f"{pair.x_label} and {pair.y_label} of each: {group}"
                    picture = in_rows(study, records, pair, _assigned([record.method for record in records], COLOURS))
                picture.savefig(folder / name, dpi=90)
                made.setdefault(study.name, []).append((name, shows))
    return made


def _points(record: Record, pair: Axes) -> list[tuple[float, float]]:
    """Places of a record in the plot: one, or a series."""
    if pair.series:
        prefix = pair.y.partition("/")[2]
        numbers = [(name, figure.value) for name, figure in record.errors.items() if name.startswith(prefix)]
        return sorted((float(name[len(prefix) :]), value) for name, value in numbers if math.isfinite(value))
    x, y = record.in_unit(pair.x), record.in_unit(pair.y)
    return [(x, y)] if math.isfinite(x) and math.isfinite(y) and x > 0.0 else []


def _assigned(names: Iterable[str], looks: Sequence[str]) -> dict[str, str]:
    """Give every name a look; some share one where there are more names than looks."""
    return {name: looks[i % len(looks)] for i, name in enumerate(dict.fromkeys(names))}


def in_panels(study: StudyResult, records: list[Record], pair: Axes) -> Picture:
    """Draw records of a study, with a panel for each data set."""
    sets = list(dict.fromkeys(record.data for record in records))
    methods = list(dict.fromkeys(record.method for record in study.records))
    settings = list(dict.fromkeys(record.setting for record in study.records))
    # A method has one colour in all pictures of a study, if there are enough of them; else one that is its own in each.
    of_methods = [name for name in methods if any(record.method == name for record in records)]
    colours = _assigned(of_methods if len(methods) > len(COLOURS) else methods, COLOURS)
    markers = _assigned([s for s in settings if any(record.setting == s for record in records)], MARKERS)
    across = 2 if len(sets) == 4 else min(COLUMNS, len(sets))  # four fill a square
    rows = -(-len(sets) // across)
    of_settings = [name for name in settings if any(record.setting == name for record in records)]
    handles = _legend(of_methods, of_settings, colours, markers, pair)
    columns = min(4, max(2, 2 * across))
    below = 0.3 + 0.2 * -(-len(handles) // columns)  # inches for the legend
    height, width = 3.1 * rows + below + 1.0, 4.3 * across + 0.4
    picture = Picture(figsize=(width, height))
    panels = picture.subplots(rows, across, sharex=True, sharey=True, squeeze=False)
    # Margins in inches: matplotlib's own layout takes as long as all the drawing.
    sides = {"left": 0.75 / width, "right": 1.0 - 0.1 / width}
    picture.subplots_adjust(**sides, bottom=(below + 0.5) / height, top=1.0 - 0.6 / height, wspace=0.06, hspace=0.22)
    ys = [y for record in records for _, y in _points(record, pair)]
    least = min((y for y in ys if y > 0.0), default=1.0)
    floor = least / ZERO_BELOW
    for panel, name in zip(panels.flat, sets, strict=False):
        members = [record for record in records if record.data == name]
        for record in members:
            _mark(panel, record, pair, colours[record.method], markers[record.setting], floor)
        if not pair.series:
            front = sorted(
                (x, max(y, floor)) for record in members if pair.key in record.front for x, y in _points(record, pair)
            )
            panel.plot(*zip(*front, strict=True), color="black", lw=1.0, zorder=1) if front else None
        panel.set_title(name, fontsize=min(9.0, 9.0 * LONGEST_TITLE / len(name)))
        panel.set_xscale("log")
        panel.set_yscale("log")
        panel.grid(color="#e0e0e0", lw=0.5)
    for panel in panels.flat[len(sets) :]:
        panel.set_visible(False)
    _ticks(panels[0, 0], pair, [x for record in records for x, _ in _points(record, pair)], ys, floor)
    for place, panel in enumerate(panels.flat):
        if place < len(sets) <= place + panels.shape[1]:
            panel.tick_params(labelbottom=True)
            panel.set_xlabel(pair.x_label, fontsize=9)
    for panel in panels[:, 0]:
        panel.set_ylabel(pair.y_label, fontsize=9)
    picture.suptitle(study.title, fontsize=11, y=1.0 - 0.08 / height, va="top")
    picture.legend(handles=handles, loc="lower center", ncols=columns, fontsize=8, frameon=False)
    return picture


def _mark(panel: Any, record: Record, pair: Axes, colour: str, marker: str, floor: float) -> None:
    places = [(x, max(y, floor)) for x, y in _points(record, pair)]
    if not places:
        return
    size = 9.0 if record.default else 6.5 if record.ours else 6.0
    panel.plot(
        *zip(*places, strict=True),
        color=colour,
        marker=marker,
        markersize=size,
        markerfacecolor=colour if record.ours else "white",
        markeredgecolor="black" if record.default else colour,
        markeredgewidth=1.3,
        ls="-" if pair.series else "none",
        lw=1.4 if record.ours else 0.7,
        zorder=4 if record.default else 3 if record.ours else 2,
    )


def _ticks(panel: Any, pair: Axes, xs: Sequence[float], ys: Sequence[float], floor: float) -> None:
    """Plain numbers where powers of ten alone would leave one or none; a tick for errors of 0."""
    low, high = min(xs), max(xs)
    subs = (1.0, 2.0, 5.0) if high < 60.0 * low else (1.0, 3.0) if high < 300.0 * low else (1.0,)
    panel.xaxis.set_major_locator(LogLocator(subs=subs))
    panel.xaxis.set_minor_locator(NullLocator())
    panel.yaxis.set_minor_locator(NullLocator())
    panel.xaxis.set_major_formatter(FuncFormatter(lambda x, _: _short(x)))
    panel.set_xlim(low / 1.25, high * 1.25)
    if min(ys) > 0.0 and max(ys) < 30.0 * min(ys):
        narrow = max(ys) < 5.0 * min(ys)
        panel.yaxis.set_major_locator(LogLocator(subs=(1.0, 1.5, 2.0, 3.0, 5.0, 7.0) if narrow else (1.0, 2.0, 5.0)))
        panel.yaxis.set_major_formatter(FuncFormatter(lambda y, _: f"{y:g}"))
    if not pair.series and min(ys) <= 0.0:
        decades = range(math.floor(math.log10(floor * ZERO_BELOW)), math.ceil(math.log10(max(max(ys), floor))) + 1)
        every = max(1, len(decades) // 8)
        ticks = [10.0**k for k in decades[::every] if 10.0**k > 4.0 * floor]
        panel.set_yticks([floor, *ticks], ["0", *(f"$10^{{{k}}}$" for k in decades[::every] if 10.0**k > 4.0 * floor)])


def _short(x: float) -> str:
    """A number as a tick shows it: plain, or by its power of ten where it would be long."""
    if 1e-4 <= x < 99999.5:
        return f"{x:g}"
    mantissa, _, power = f"{x:.0e}".partition("e")
    times = "" if mantissa == "1" else rf"{mantissa} \cdot "
    return f"${times}10^{{{int(power)}}}$"


def _legend(
    methods: Sequence[str], settings: Sequence[str], colours: dict[str, str], markers: dict[str, str], pair: Axes
) -> list[Line2D]:
    handles = [Line2D([], [], color=colours[method], lw=4, label=method) for method in methods]
    handles += [
        Line2D([], [], color="#606060", marker=markers[s], ls="none", label=s or "no setting") for s in settings
    ]
    if not pair.series:
        handles.append(Line2D([], [], color="black", lw=1.0, label="Pareto front"))
    handles.append(
        Line2D([], [], color="#606060", marker="o", ls="none", label="filled: this program (edged: its default)")
    )
    return handles
