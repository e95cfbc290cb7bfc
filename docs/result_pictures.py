"""Makes the plots of docs/benchmarks from their records: ``python docs/result_pictures.py``."""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

from pvfiblets.report.plots import COLOURS as PALETTE
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
TUBES = {
    "splines": "pvfiblets",
    "tube-6": "VTK, 6 sides",
    "tube-12": "VTK, 12 sides",
    "tube-30": "VTK, 30 sides",
    "lines-as-tubes": "VTK, lines as tubes",
    "tessellated-culled": "hardware tessellation",
}
MODES = {"composite": "light", "mip": "greatest value", "isosurface": "surface"}
VOLUMES = {"plotter": "pvfiblets", "vtk-gpu": "VTK, same step", "vtk-gpu-equal": "VTK, same error"}
SCENES = ("brain of 1,100,000 segments", "brain of 6,000,000 segments", "tubes", "halos")


def panels(rows: int, columns: int) -> tuple[Figure, Any]:
    """Return a figure and its panels."""
    figure = Figure(figsize=(7.6, 2.7 * rows), layout="constrained")
    return figure, figure.subplots(rows, columns).flat


def axes(panel: Any, x: str, y: str, title: str) -> None:
    """Name the axes of a panel, both logarithmic."""
    panel.set(xscale="log", yscale="log", xlabel=x, ylabel=y)
    panel.set_title(title, fontsize=10)
    panel.grid(color="#e0e0e0", lw=0.5)
    for axis in (panel.xaxis, panel.yaxis):
        low, high = axis.get_view_interval()
        axis.set_minor_locator(NullLocator())
        if low > 1e-4 and high < 1e5:
            subs = (1.0, 2.0, 5.0) if high < 20.0 * low else (1.0, 3.0) if high < 300.0 * low else (1.0,)
            axis.set_major_locator(LogLocator(subs=subs, numticks=12))
            axis.set_major_formatter(FuncFormatter(lambda number, _: f"{number:,g}"))


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
    figure = in_panels(study, records, finished)
    for text in figure.legends[0].get_texts():
        text.set_fontsize(9.5)
    return figure


def size() -> Figure:
    """Largest error against bytes of a point, of methods that lose something."""
    study = Report.load(FOLDER / "report" / "amd-epyc").studies[0]
    axis = study.axes[0]
    lossy = ("fiblets", "QFib", "paper's fiblets", "float16", "int16 over bounds", "dipy linearised")
    sets = [f"noisy, {step} mm" for step in (0.1, 0.2, 0.5, 1)]
    drawn = [one for one in study.records if one.data in sets and one.method in lossy]
    found = arranged(drawn, lambda one: (one.data, one.method, one.in_unit(axis.x), one.in_unit(axis.y)))
    for one in drawn:
        if one.default:
            found[one.data]["default"] = [(one.in_unit(axis.x), one.in_unit(axis.y))]
    return grid(found, axis.x_label, axis.y_label, "none")


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


def tubes() -> Figure:
    """Error against time of tubes: the whole set in view, and from a third of that distance."""
    drawn = [one for way in TUBES for one in results("tubes") if one["way"] == way and "ms" in one]
    found = arranged(drawn, lambda one: (one["set"], TUBES[one["way"]], one["ms"], one["off_pixels"]))
    return grid(found, "ms per frame", "mean error, pixels")


def tube_errors() -> Figure:
    """Error against time of solvers, with more iterations from point to point."""
    drawn = [one for one in results("tube-errors") if one.get("of") in ("thin", "bent", "brain", "furball")]
    found = arranged(drawn, lambda one: (one["of"], one["way"], one["ns"], one["p99.9"]))
    for one in drawn:
        if one["default"]:
            found[one["of"]]["default"] = [(one["ns"], one["p99.9"])]
    return grid(found, "ns per ray", "error, radii")


def volume() -> Figure:
    """Time of a frame by size of the volume."""
    drawn = [one for one in results("volume") if one["way"] in VOLUMES and "error" in one and one["data"] != "brain"]
    found = arranged(
        drawn,
        lambda one: (MODES[one["mode"]], VOLUMES[one["way"]], int(one["data"].split("-")[1]), one["circle"]["cpu_ms"]),
    )
    return grid(found, "voxels along an edge", "CPU ms per frame")


def volume_errors() -> Figure:
    """Error of colours against time, by the changed setting."""
    drawn = [one for one in results("volume-errors") if one["filter"] == "trilinear"]
    found = arranged(drawn, lambda one: (MODES[one["mode"]], one["varied"], one["cpu_ms"], one["rms"]))
    return grid(found, "CPU ms per frame", "rms error of colours", "none")


def volume_integrators() -> Figure:
    """Largest error against the optical depth of a step."""
    worst: dict[Any, float] = {}
    for one in results("volume-integrators"):
        if one.get("step") == 0.5:
            key = one["transfer"], one["integrator"], one["kappa_step"]
            worst[key] = max(worst.get(key, 0.0), one["max"])
    found = arranged(list(worst.items()), lambda one: (*one[0], one[1]))
    return grid(found, "optical depth of a step", "largest error")


def halo_errors() -> Figure:
    """Error against time with 1, 4, 9 and 16 samples a pixel."""
    drawn = [one for one in results("halo-errors") if not one["reference"]]
    edges = {True: "smooth edges", False: "hard edges"}
    found = arranged(drawn, lambda one: (one["set"], edges[one["smooth"]], one["ms"], one["mean"]))
    return grid(found, "ms per frame", "mean error")


def arranged(records: list[Any], place: Any) -> dict[str, dict[str, list[tuple[float, float]]]]:
    """Return points by panel and line, in the order of the records."""
    found: dict[str, dict[str, list[tuple[float, float]]]] = {}
    for panel, name, x, y in map(place, records):
        found.setdefault(panel, {}).setdefault(name, []).append((x, y))
    return found


def grid(found: dict[str, dict[str, list[tuple[float, float]]]], x: str, y: str, ls: str = "-") -> Figure:
    """Draw the points of each panel, two or three panels a row."""
    columns = 2 if len(found) == 4 else 3
    figure, row = panels(-(-len(found) // columns), columns)
    names = dict.fromkeys(name for members in found.values() for name in members if name != "default")
    colours = {**dict(zip(names, PALETTE, strict=False)), "default": "#000000"}
    for place, (title, members) in enumerate(found.items()):
        for name, points in members.items():
            marker = {"marker": "*", "ms": 13, "zorder": 3} if name == "default" else {"marker": "o", "ms": 5}
            row[place].plot(*zip(*points, strict=True), color=colours[name], label=name, ls=ls, **marker)
        axes(row[place], x, "" if place % columns else y, title)
    for panel in row[len(found) :]:
        panel.set_visible(False)
    return figure


def results(name: str) -> Any:
    """Return the results of a record of software OpenGL."""
    return record(f"{name}-llvmpipe")["results"]


def record(name: str) -> Any:
    """Return a record."""
    return json.loads((FOLDER / f"{name}.json").read_text(encoding="utf-8"))


def by_way(number: Any) -> dict[str, list[tuple[float, float]]]:
    """Return the numbers of each way to draw lines, by segments."""
    return {
        name: [(one["segments"], number(one)) for one in results("lines") if one["way"] == way]
        for way, name in WAYS.items()
    }


def in_browser(program: str, column: str) -> list[tuple[float, float]]:
    """Return a column of the record of pages, by points."""
    found = record("other-viewers")["niivue"]
    rows = [dict(zip(found["columns"], row, strict=True)) for row in found["rows"]]
    return [(one["points"], one[column]) for one in rows if one["program"] == program and one[column] is not None]


def main() -> None:
    """Write the plots."""
    drawn = {f"results-{plot.__name__}": plot for plot in (errors, size, frames, memory, pages)}
    for plot in (tubes, tube_errors, volume, volume_errors, volume_integrators, halo_errors):
        drawn[f"{plot.__name__.replace('_', '-')}-llvmpipe"] = plot
    for name, plot in drawn.items():
        path = FOLDER / f"{name}.png"
        figure = plot()
        if not figure.legends:
            lines = {one.get_label(): one for panel in figure.axes for one in panel.get_lines()}
            figure.legend(handles=lines.values(), loc="outside lower center", ncols=4, fontsize=9, frameon=False)
        figure.savefig(path, dpi=100)
        print(path)


if __name__ == "__main__":
    main()
