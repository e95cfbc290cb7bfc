"""Table 2 of the paper (Schertzer et al. 2022): milliseconds per frame of every pipeline, with and without culling.

Made-up brains of growing size, the whole of each in the picture, are orbited by 1.14 degrees a frame at 1920x1080, on
a bare OpenGL context. Reported is the mean over the orbit without its first frames: by the clock, with the GPU's work
waited for, and by the GPU's own timer queries, pass by pass. A size that a card cannot hold, and a pipeline that it
does not have, get a row that says so::

    python benchmarks/pipelines.py --segments 1e6 6e6 60e6 --folder /tmp --output docs/benchmarks

writes ``pipelines-CARD.json``, ``.md`` and ``.png``, named after the card.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from pathlib import Path

import numpy as np
from common import (
    DEGREES_PER_FRAME,
    add_places,
    data_bytes,
    machine,
    make_brain,
    on_machine,
    pyplot,
    segments_of,
    write,
)

from pvfiblets.engine.gl.standalone import bare_context
from pvfiblets.report.studies.culling.pictures import views

CULLINGS = ("none", "coverage", "two-phase")


def main() -> None:
    """Measure what is asked for, and write the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--segments", type=float, nargs="+", default=[1e6, 6e6, 60e6])
    parser.add_argument("--step", type=float, default=0.1, help="mm between points; the paper's are 0.1 and 0.05")
    parser.add_argument("--order", choices=("input", "hilbert"), default="input")
    parser.add_argument("--pipelines", nargs="+", help="all that the card has, if left out")
    parser.add_argument("--cullings", nargs="+", choices=CULLINGS, default=list(CULLINGS))
    parser.add_argument("--limit", type=float, help="most segments for all pipelines but the fastest")
    parser.add_argument("--frames", type=int, default=40, help="frames that count")
    parser.add_argument("--seconds", type=float, default=30.0, help="of drawing per cell at most, once 3 frames count")
    add_places(parser)
    options = parser.parse_args()
    ctx = bare_context()
    with tempfile.TemporaryDirectory() as temporary:
        results = measure_all(ctx, options, options.folder or Path(temporary))
    about = {
        **machine(ctx),
        "size": list(options.size),
        "step_mm": options.step,
        "order": options.order,
        "degrees_per_frame": DEGREES_PER_FRAME,
    }
    write("pipelines", about, results, table(about, results), plot, options.output)


def measure_all(ctx, options, folder: Path) -> list[dict]:
    """Measure every cell of the table."""
    from pvfiblets.engine.gl import capabilities

    results = []
    known = capabilities.pipelines(ctx)
    fastest = capabilities.choose(ctx, "auto")
    for segments in options.segments:
        fiblets = make_brain(segments, options.step, folder, options.order)
        for info in known:
            if options.pipelines and info.name not in options.pipelines:
                continue
            for culling in options.cullings:
                cell = {"pipeline": info.name, "culling": culling, "segments": segments_of(fiblets)}
                if info.available and options.limit and segments > options.limit and info.name != fastest:
                    cell["unmeasured"] = f"left out above {options.limit:,.0f} segments: too slow here"
                elif info.available:
                    cell |= measure(ctx, fiblets, info.name, culling, options)
                else:
                    cell["unmeasured"] = info.why_not
                results.append(cell)
                print({key: cell[key] for key in cell if key != "passes"}, flush=True)
    return results


def measure(ctx, fiblets, pipeline: str, culling: str, options) -> dict:
    """Orbit once and return the numbers of one cell."""
    from pvfiblets.engine import EngineError, FibletRenderer

    begin = time.perf_counter()
    try:
        renderer = FibletRenderer(ctx, fiblets, pipeline=pipeline, culling=None if culling == "none" else culling)
    except EngineError as error:
        return {"unmeasured": str(error)}
    ctx.finish()
    upload = time.perf_counter() - begin
    wall, passes = [], []
    try:
        began = time.perf_counter()
        path = views(fiblets.bounds, "far", DEGREES_PER_FRAME, options.frames + 2, tuple(options.size))
        for frame, view in enumerate(path):
            start = time.perf_counter()
            renderer.render(view)
            ctx.finish()
            if frame >= 2:  # the first compiles and sees nothing drawn before; the second still looks at the first
                wall.append(time.perf_counter() - start)
                passes.append({row["name"]: row["ms"] for row in renderer.explain(counts=False)["passes"]})
            if len(wall) >= 3 and time.perf_counter() - began > options.seconds:
                break
        report = renderer.explain()
    finally:
        renderer.release()
    names = list(passes[-1])
    return {
        "ms": 1e3 * float(np.mean(wall)),
        "ms_median": 1e3 * float(np.median(wall)),
        "gpu_ms": float(np.mean([sum(row.values()) for row in passes])),
        "passes": {name: float(np.mean([row.get(name, 0.0) for row in passes])) for name in names},
        "frames": len(wall),
        "segments_per_second": segments_of(fiblets) / float(np.mean(wall)),
        "fiblets": report.get("fiblets", report["fiblets_total"]),
        "gpu_bytes_per_point": data_bytes(report) / fiblets.n_points,
        "upload_seconds": upload,
    }


def table(about: dict, results: list[dict]) -> str:
    """Return the paper's Table 2 in Markdown."""
    sizes = sorted({row["segments"] for row in results})
    found = {(row["pipeline"], row["culling"], row["segments"]): row for row in results}
    width, height = about["size"]
    lines = [
        f"# Pipelines on {about['card']}",
        "",
        f"{on_machine(about)}. Milliseconds per frame, "
        f"mean of an orbit by {about['degrees_per_frame']}° a frame around synthetic brains of "
        f"{about['step_mm']:g} mm steps, "
        f"{width}×{height}; in brackets the GPU's own time where it differs. *unmeasured*: this card does not have "
        "what the pipeline needs.",
        "",
        "| pipeline | culling | " + " | ".join(f"{size / 1e6:,.1f} M segments" for size in sizes) + " |",
        "|---|---|" + "---|" * len(sizes),
    ]
    for pipeline in dict.fromkeys(row["pipeline"] for row in results):
        for culling in dict.fromkeys(row["culling"] for row in results):
            cells = [cell(found.get((pipeline, culling, size))) for size in sizes]
            lines.append(f"| {pipeline} | {culling} | " + " | ".join(cells) + " |")
    reasons = {row["pipeline"]: row["unmeasured"] for row in reversed(results) if "unmeasured" in row}
    lines += ["", *(f"- {name}: {reason}" for name, reason in reasons.items())]
    return "\n".join(lines).rstrip() + "\n"


def cell(row: dict | None) -> str:
    """Return one cell of the table."""
    if row is None:
        return ""
    if "unmeasured" in row:
        return "unmeasured"
    shown = f"{row['ms']:.1f}" if row["ms"] < 100 else f"{row['ms']:.0f}"
    return shown if abs(row["gpu_ms"] - row["ms"]) < 0.1 * row["ms"] else f"{shown} ({row['gpu_ms']:.1f})"


def plot(about: dict, results: list[dict], path: Path) -> None:
    """Draw time per frame over size, a line for each pipeline and culling."""
    plt = pyplot()
    figure, axis = plt.subplots(figsize=(8, 5), layout="constrained")
    styles = {"none": ":", "coverage": "--", "two-phase": "-"}
    measured = [row for row in results if "ms" in row]
    for index, pipeline in enumerate(dict.fromkeys(row["pipeline"] for row in measured)):
        for culling, style in styles.items():
            rows = [row for row in measured if (row["pipeline"], row["culling"]) == (pipeline, culling)]
            if rows:
                x, y = [row["segments"] for row in rows], [row["ms"] for row in rows]
                axis.loglog(x, y, style, marker="o", color=f"C{index}", label=f"{pipeline}, {culling}")
    axis.set_xlabel("segments")
    axis.set_ylabel("ms per frame")
    axis.set_title(about["card"])
    axis.grid(True, which="both", alpha=0.2)
    axis.legend(fontsize="small")
    figure.savefig(path, dpi=110)


if __name__ == "__main__":
    main()
