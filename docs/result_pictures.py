"""Makes plots of docs/benchmarks/README.md from the records beside it: ``python docs/result_pictures.py``."""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

from pvfiblets.report.plots import in_panels
from pvfiblets.report.report_file import Report

FOLDER = Path(__file__).resolve().parent / "benchmarks"
COLOURS = {
    "fiblets": "#0072b2", "page, interactive": "#0072b2", "page, full resolution": "#56b4e9", "page": "#0072b2",
    "VTK lines by add_mesh": "#d55e00", "VTK lines, aliased": "#e69f00",
    "VTK tubes": "#cc79a7", "FURY": "#009e73", "NiiVue": "#000000", "PyVista": "#d55e00",
    "OpenGL line strips": "#e69f00",
}  # fmt: skip
WAYS = {
    "fiblets": "fiblets",
    "polylines": "VTK lines by add_mesh",
    "polylines-aliased": "VTK lines, aliased",
    "tubes": "VTK tubes",
}
SCENES = ("brain of 1,100,000 segments", "brain of 6,000,000 segments", "tubes", "halos")


def panels(rows: int, columns: int) -> tuple[Figure, Any]:
    """Return a figure and its panels."""
    figure = Figure(figsize=(9.0, 3.0 * rows), layout="constrained")
    return figure, figure.subplots(rows, columns).flat


def axes(panel: Any, x: str, y: str, title: str) -> None:
    """Name the axes of a panel, both logarithmic."""
    panel.set(xscale="log", yscale="log", xlabel=x, ylabel=y)
    panel.set_title(title, fontsize=10)
    panel.grid(color="#e0e0e0", lw=0.5)
    low, high = panel.get_ylim()
    panel.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if high < 100.0 * low else (1.0,)))
    panel.yaxis.set_major_formatter(FuncFormatter(lambda number, _: f"{number:,g}"))
    for axis in (panel.xaxis, panel.yaxis):
        axis.set_minor_locator(NullLocator())


def line(panel: Any, name: str, points: Iterable[tuple[float, float]]) -> None:
    """Draw the numbers of one program."""
    drawn = sorted(points)
    if drawn:
        panel.plot(*zip(*drawn, strict=True), "o-", color=COLOURS[name], label=name, ms=5)


def errors() -> Figure:
    """Error against run time of a finished image, for each kind of line that the record has."""
    study = Report.load(FOLDER / "report" / "intel-xeon-antialias").studies[0]
    records = [one for one in study.records if one.data.startswith(tuple(f"{name}," for name in SCENES))]
    (finished,) = (pair for pair in study.axes if pair.key == "rest")
    return in_panels(study, records, finished)


def frames() -> Figure:
    """Time of a frame by number of segments, on the processor and on the card."""
    figure, (*row,) = panels(2, 2)
    for name, points in by_way(lambda one: one["ms_per_frame"]).items():
        line(row[0], name, points)
    axes(row[0], "segments", "ms", "CPU, 1920×1080")
    fury = record("other-viewers")["fury"]
    for program in ("fiblets", "VTK lines, aliased", "FURY"):
        line(row[1], program, [(n, sum(ms) / len(ms)) for n, name, ms in fury["rows"] if name == program])
    axes(row[1], "segments", "CPU time, ms", "FURY, CPU, 1280×720")
    line(row[2], "page, full resolution", in_browser("page", "full_frame_ms"))
    line(row[2], "page, interactive", in_browser("page", "interactive_frame_ms"))
    line(row[2], "NiiVue", in_browser("NiiVue", "full_frame_ms"))
    axes(row[2], "points", "ms", "NiiVue in Chromium, CPU, 800×600")
    card = [one for one in record("card-nvidia-h100-80gb-hbm3")["results"] if one.get("ms")]
    compute = [one for one in card if one.get("pipeline") == "compute" and one["culling"] == "two-phase"]
    line(row[3], "fiblets", [(one["segments"], one["ms"]) for one in compute])
    strips = [one for one in card if one["kind"] == "raw lines"]
    line(row[3], "OpenGL line strips", [(one["segments"], one["ms"]) for one in strips])
    axes(row[3], "segments", "ms", "NVIDIA H100, 1920×1080")
    return figure


def memory() -> Figure:
    """Memory and load time by number of segments."""
    figure, (*row,) = panels(1, 3)
    for name, points in by_way(lambda one: one["gpu_bytes_per_point"]).items():
        line(row[0], name, points)
    axes(row[0], "segments", "bytes per point", "GPU memory")
    for name, points in by_way(lambda one: one["peak_memory_bytes"] / 1e6).items():
        line(row[1], name, points)
    axes(row[1], "segments", "MB", "process memory")
    for name, points in by_way(lambda one: one["load_seconds"]).items():
        line(row[2], name, points)
    axes(row[2], "segments", "s", "load time")
    return figure


def pages() -> Figure:
    """Weight of a page, and the time until it shows something."""
    figure, (*row,) = panels(1, 2)
    for panel, column, y, title in zip(
        row, ("page_mb", "first_frame_s"), ("MB", "s"), ("weight", "time to the first frame"), strict=True
    ):
        for program in ("page", "NiiVue", "PyVista"):
            line(panel, program, in_browser(program, column))
        axes(panel, "points", y, title)
    return figure


def record(name: str) -> Any:
    """Return a record."""
    return json.loads((FOLDER / f"{name}.json").read_text(encoding="utf-8"))


def by_way(number: Any) -> dict[str, list[tuple[float, float]]]:
    """Return the numbers of each way to draw lines, by segments."""
    results = record("lines-llvmpipe")["results"]
    return {
        name: [(one["segments"], number(one)) for one in results if one["way"] == way] for way, name in WAYS.items()
    }


def in_browser(program: str, column: str) -> list[tuple[float, float]]:
    """Return a column of the record of pages, by points."""
    found = record("other-viewers")["niivue"]
    rows = [dict(zip(found["columns"], row, strict=True)) for row in found["rows"]]
    return [(one["points"], one[column]) for one in rows if one["program"] == program and one[column] is not None]


def main() -> None:
    """Write the plots."""
    for plot in (errors, frames, memory, pages):
        path = FOLDER / f"results-{plot.__name__}.png"
        figure = plot()
        if not figure.legends:
            lines = {one.get_label(): one for panel in figure.axes for one in panel.get_lines()}
            figure.legend(handles=lines.values(), loc="outside lower center", ncols=5, fontsize=8, frameon=False)
        figure.savefig(path, dpi=100)
        print(path)


if __name__ == "__main__":
    main()
