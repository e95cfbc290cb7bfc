"""Lines and points with halos beside VTK's plain ones: time per frame and GPU memory, of one run.

The rows are the paper's (Everts et al. 2009, table 1) by size and kind, of data made by seed; as there, each fills a
window of 812x600 that turns, without anti-aliasing and without a filter. Every method of drawing runs in a process of
its own. One that would take longer than ``--limit`` gets a row that says so::

    python benchmarks/halos.py --folder /tmp --output docs/benchmarks

writes ``halos-CARD.json``, ``.md`` and ``.png``, named after the card.
"""

from __future__ import annotations

import argparse
import json
import re
from typing import Any

from common import add_places, card_of, machine, on_machine, passed_on, pyplot, run_child, to_table, verdict, write
from halos_methods import ABOUT, ROWS, STEREO, AbsentError, make_set, row_of, run

from pvfiblets.halos import HaloLines
from pvfiblets.report.studies.halos.pictures import look_of

TIME, BYTES, MANY = 1.5, 20.0, 1_000_000
"""The goals: as many times as long as VTK's plain lines at so many vertices, bytes a vertex."""

COLUMNS = ("row", "lines", "vertices", "strip", "method", "ms", "× VTK", "frames a second", "paper", "bytes",
           "a vertex")  # fmt: skip


def main() -> None:
    """Measure every method on every row, one process each, and write the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rows", nargs="+", type=known_row, default=list(ROWS), metavar="ROW",
                        help=f"of {', '.join(ROWS)}; or lines-N and points-N, N small ones")  # fmt: skip
    parser.add_argument("--methods", nargs="+", choices=list(ABOUT), default=list(ABOUT))
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--places", type=int, default=6, help="all around the data")
    parser.add_argument("--frames", type=int, default=6, help="at each place")
    parser.add_argument("--seconds", type=float, default=20.0, help="of drawing at most, once each place has a frame")
    parser.add_argument("--limit", type=float, default=600.0, help="seconds that a method may take, its start included")
    parser.add_argument("--run", nargs=2, metavar=("METHOD", "ROW"), help=argparse.SUPPRESS)
    add_places(parser)
    parser.set_defaults(size=(812, 600))  # the paper's
    options = parser.parse_args()
    if options.run:
        print(json.dumps(child(*options.run, options)))
        return
    results = measure_all(options)
    about = {
        **machine(seed=options.seed),
        "size": list(options.size),
        "places": options.places,
        "frames": options.frames,
        "rows": {row["row"]: row["about"] for row in results if "about" in row},
    }
    write("halos", about, results, table(about, results), plot, options.output)


def known_row(name: str) -> str:
    """Return the name of a row if it is one."""
    if name not in ROWS and not re.fullmatch(r"(lines|points)-\d+(-anaglyph)?", name):
        raise argparse.ArgumentTypeError(f"unknown row {name!r}, expected one of {', '.join(ROWS)}, lines-N, points-N")
    return name


def child(method: str, name: str, options: Any) -> dict[str, Any]:
    """Measure one method on one row."""
    row = row_of(name)
    drawn = make_set(row.data, options.seed)
    look = look_of(drawn)
    lines = isinstance(drawn, HaloLines)
    about = {
        "kind": "lines" if lines else "points",
        "lines": drawn.n_lines if lines else None,
        "vertices": drawn.n_points,
        "anaglyph": row.anaglyph,
        "figure": row.figure,
        "paper_fps": row.fps,
        "line_width": look.line_width,
        "strip_width": look.strip_width,
        "max_displacement": look.max_displacement,
    }
    try:
        measured = run(method, row, drawn, look, options)
    except AbsentError as error:
        return {"about": about, "unmeasured": str(error)}
    return {"about": about, **measured, "bytes_per_vertex": measured["gpu_bytes"] / drawn.n_points}


def measure_all(options: Any) -> list[dict[str, Any]]:
    """Return a result for every row and method, each with how it compares with VTK's plain lines or points."""
    results = []
    for name in options.rows:
        methods = [method for method in options.methods if method in STEREO or not row_of(name).anaglyph]
        found = {method: started(method, name, options) for method in methods}
        plain = found.get("vtk", {})
        for method, result in found.items():
            if "ms" in result and "ms" in plain:
                result["times_vtk"] = result["ms"] / plain["ms"]
            results.append({"row": name, "method": method, **result})
            print({key: value for key, value in results[-1].items() if key not in ("about", "passes")}, flush=True)
    return results


def started(method: str, name: str, options: Any) -> dict[str, Any]:
    """Measure one method on one row in a process of its own, for as long as it may take."""
    more = passed_on(options, ("size", "seed", "places", "frames", "seconds"))
    rows, reason = run_child(__file__, ["--run", method, name, *more], options.limit)
    return rows[-1] if rows else {"unmeasured": reason}


def table(about: dict[str, Any], results: list[dict[str, Any]]) -> str:
    """Return the results in Markdown."""
    width, height = about["size"]
    lines = [
        f"# Lines and points with halos beside plain ones on {about['card']}",
        "",
        f"{on_machine(about)}; {width}×{height}, which the data fill; {about['places']} places around them, "
        f"{about['frames']} frames of an animation at each; each method in its own process, no anti-aliasing, no "
        "filter. Data are made by seed, of the paper's numbers of lines and vertices (Everts et al. 2009, table 1); "
        "widths are the program's defaults.",
        "",
        "*ms*: median of the frames, 10th to 90th percentile in brackets; *× VTK*: that over VTK's plain lines or "
        "points of the same data; *bytes*: of the data on the GPU, those a vertex after; *paper*: its frames a second "
        "in 2009, on a GeForce 8800 GTX; *strip*: pixels that a line takes with its halos in the middle of the data.",
        "",
        *(f"- *{method}*: {text}." for method, text in ABOUT.items()),
        "",
        *to_table(COLUMNS, map(line, results)),
        *goals(results),
    ]
    return "\n".join(lines) + "\n"


def line(row: dict[str, Any]) -> str:
    """Return one row of the table."""
    facts = row.get("about")
    counts = "| | "  # of a method that never came as far as making the data
    if facts is not None:
        n_lines = "points" if facts["lines"] is None else f"{facts['lines']:,}"
        counts = f"| {n_lines} | {facts['vertices']:,} "
    strip = f"{row['strip_pixels']:.1f}" if "strip_pixels" in row else ""
    head = f"| {row['row']} {counts}| {strip} | {row['method']} | "
    if "unmeasured" in row:
        return head + f"unmeasured: {row['unmeasured']} | | | | | |"
    low, high = row["ms_spread"]
    times = f"{row['times_vtk']:.2f}" if "times_vtk" in row else ""
    paper = f"{facts['paper_fps']:.0f}" if facts["paper_fps"] else ""
    return head + (
        f"{row['ms']:.1f} ({low:.1f}–{high:.1f}) | {times} | {1e3 / row['ms']:.1f} | {paper} | {row['gpu_bytes']:,} "
        f"| {row['bytes_per_vertex']:.1f} |"
    )


def goals(results: list[dict[str, Any]]) -> list[str]:
    """Say which rows keep to the goals."""
    lines = []
    for row in results:
        if row["method"] == "vtk" or "unmeasured" in row or row["about"]["kind"] != "lines":
            continue
        if row["about"]["vertices"] < MANY:
            continue
        said = [f"{row['bytes_per_vertex']:.1f} bytes a vertex, {verdict(row['bytes_per_vertex'] <= BYTES)}"]
        if "times_vtk" in row:
            said.insert(0, f"{row['times_vtk']:.2f} times VTK's time, {verdict(row['times_vtk'] <= TIME)}")
        lines.append(f"- {row['row']}, {row['method']}: {'; '.join(said)}.")
    if not lines:
        return []
    head = f"The goals, {TIME:g} times the time of VTK's plain lines and {BYTES:g} bytes a vertex at {MANY:,} or more:"
    return ["", head, "", *lines]


def plot(about: dict[str, Any], results: list[dict[str, Any]], path: Any) -> None:
    """Draw time per frame and bytes per vertex of each method, row by row."""
    plt = pyplot()
    rows = list(dict.fromkeys(row["row"] for row in results))
    methods = list(dict.fromkeys(row["method"] for row in results))
    figure, axes = plt.subplots(1, 2, figsize=(11.0, 1.5 + 0.55 * len(rows)), layout="constrained", sharey=True)
    thick = 0.8 / len(methods)
    for axis, key in zip(axes, ("ms", "bytes_per_vertex"), strict=True):
        for place, method in enumerate(methods):
            found = {row["row"]: row for row in results if row["method"] == method and key in row}
            at = [i + (place - 0.5 * (len(methods) - 1)) * thick for i, name in enumerate(rows) if name in found]
            chosen = [found[name] for name in rows if name in found]
            axis.barh(at, [row[key] for row in chosen], thick, label=method)
            for y, row in zip(at, chosen, strict=True):
                if key == "ms" and method != "vtk" and "times_vtk" in row:
                    axis.text(row[key], y, f" ×{row['times_vtk']:.2f}", va="center", size="x-small")
        axis.grid(True, axis="x", which="both", alpha=0.2)
    axes[0].set_xscale("log")
    axes[0].set_xlabel("ms per frame; beside the bars, over VTK's")
    axes[1].set_xlabel("bytes on the GPU per vertex")
    axes[1].axvline(BYTES, color="black", linestyle=":", linewidth=1)
    axes[0].set_yticks(range(len(rows)), rows)
    axes[0].invert_yaxis()
    axes[1].legend(fontsize="small")
    figure.suptitle(f"{card_of(about)}, {about['size'][0]}×{about['size'][1]}", size="medium")
    figure.savefig(path, dpi=110)
    plt.close(figure)


if __name__ == "__main__":
    main()
