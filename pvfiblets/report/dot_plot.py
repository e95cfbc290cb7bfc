"""Plots of what methods add to a plain one: a row for each, and how far its figures are from the plain method's."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from matplotlib.figure import Figure as Picture
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

from .record import Axes, Record, StudyResult

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def in_rows(study: StudyResult, records: Sequence[Record], pair: Axes, colours: Mapping[str, str]) -> Figure:
    """Draw a picture of two panels: a row for each record, for each of its two figures a dot."""
    sets = list(dict.fromkeys(record.data for record in records))
    titled = [(name, [record for record in records if record.data == name]) for name in sets]
    rows = sum(len(members) for _, members in titled)
    height, width = 0.21 * rows + 0.35 * len(sets) + 1.2, 9.4
    picture = Picture(figsize=(width, height))
    heights = [len(members) + 1.0 for _, members in titled]
    panels = picture.subplots(len(sets), 2, sharex="col", squeeze=False, height_ratios=heights)
    picture.subplots_adjust(
        left=2.75 / width, right=1.0 - 0.15 / width, bottom=0.55 / height, top=1.0 - 0.65 / height, wspace=0.05
    )
    for line, (name, members) in zip(panels, titled, strict=True):
        for panel, path in zip(line, (pair.x, pair.y), strict=True):
            _panel(panel, members, path, colours)
        line[0].set_yticks(range(len(members)), [_label(record) for record in members], fontsize=8)
        line[0].set_title(name, fontsize=9, loc="left")
        line[1].tick_params(labelleft=False)
    for panel, label in zip(panels[-1], (pair.x_label, pair.y_label), strict=True):
        panel.set_xlabel(label, fontsize=9)
    picture.suptitle(f"{study.title}; dashed: without any", fontsize=11, y=1.0 - 0.08 / height, va="top")
    return picture


def _label(record: Record) -> str:
    return ": ".join(part for part in (record.method, record.setting) if part)


def _panel(panel: Any, records: Sequence[Record], path: str, colours: Mapping[str, str]) -> None:
    values = [record.in_unit(path) for record in records]
    plain = next((value for record, value in zip(records, values, strict=True) if record.default), None)
    known = [value for value in values if value > 0.0]
    start = plain if plain else min(known, default=1.0)
    for row, (record, value) in enumerate(zip(records, values, strict=True)):
        if value > 0.0:  # no number is not
            panel.plot([start, value], [row, row], color=colours[record.method], lw=2.0, solid_capstyle="butt")
            panel.plot([value], [row], color=colours[record.method], marker="o", markersize=6.0)
    if plain:
        panel.axvline(plain, color="black", lw=0.8, ls="--", zorder=1)
    panel.set_xscale("log")
    low, high = min(known, default=1.0), max(known, default=1.0)
    panel.set_xlim(low / 1.3, high * 1.3)
    narrow = high < 4.0 * low
    subs = (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0) if narrow else (1.0, 2.0, 5.0) if high < 300.0 * low else (1.0,)
    panel.xaxis.set_major_locator(LogLocator(subs=subs))
    panel.xaxis.set_minor_locator(NullLocator())
    panel.xaxis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:g}"))
    panel.tick_params(labelsize=8)
    panel.set_ylim(len(records) - 0.4, -0.6)
    panel.grid(color="#e0e0e0", lw=0.5, axis="x")
    panel.set_axisbelow(True)
