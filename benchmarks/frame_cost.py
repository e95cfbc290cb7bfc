"""CPU milliseconds that the library's own Python takes for a picture, by number of chunks.

Calls of OpenGL are counted and do nothing (``tests/gl_calls.py``), so that what is left of a frame is Python's and
moderngl's time in this thread, whatever the graphics card. Sets of tiny fiblets are cut into 1 to 100 chunks: what a
chunk holds changes no call. Two cases: the engine alone, and with PyVista the time in the mapper's callback, where
VTK's own share of it (setting uniforms) counts too.

The goal is 2 ms at 8 GB of fiblets, as full as they can be: 97 million of them, in 12 chunks on a card of its own and
in 93 on an integrated one (``pvfiblets/engine/gl/work_limits.py``)::

    python benchmarks/frame_cost.py --output docs/benchmarks
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from unittest.mock import patch

sys.path.append(str(Path(__file__).resolve().parents[1]))

import moderngl
import numpy as np
from common import add_places, machine, on_machine, percentiles, pyplot, to_table, write

from pvfiblets import Streamlines, compress
from pvfiblets.codec import layout
from pvfiblets.engine import FibletRenderer
from pvfiblets.engine.fiblets.pipelines import compute, limits, textured
from pvfiblets.engine.fiblets.pipelines.constants import VISIBILITY_WORDS
from pvfiblets.engine.gl.capabilities import pipelines
from pvfiblets.engine.gl.standalone import bare_context
from pvfiblets.engine.gl.work_limits import DISCRETE, INTEGRATED, WorkLimits
from pvfiblets.report.studies.culling.pictures import views
from tests.gl_calls import Calls, possible, recording

CHUNKS = (1, 2, 4, 12, 24, 48, 93, 100)
CULLINGS = ("two-phase", "none")
FIBLET_BYTES = (
    4 * (layout.WORDS["anchors"] + layout.WORDS["decoding"]) + 2 + layout.MAX_POINTS - 2
    + (VISIBILITY_WORDS + compute.CLASSES) / 8
)  # fmt: skip
"""On the card, of one with as many points as it can have: 82.4."""
MOST_BYTES = 8e9
GOAL = 2.0
"""Milliseconds at so many bytes."""
CASES = ("engine", "mapper")
WARM = 4  # frames that are drawn: what they compile and allocate comes once


def chunks_of(nbytes: float, fiblets: int) -> int:
    """Return into how many chunks of so many fiblets a set of some bytes is cut."""
    return -(-int(nbytes / FIBLET_BYTES) // fiblets)


def main() -> None:
    """Measure what is asked for, and write the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--chunks", type=int, nargs="+", default=list(CHUNKS))
    parser.add_argument("--cases", choices=CASES, nargs="+", default=list(CASES))
    parser.add_argument("--pipelines", nargs="+", help="all that the card has, if left out")
    parser.add_argument("--frames", type=int, default=150, help="that count")
    add_places(parser)
    options = parser.parse_args()
    if not possible():
        parser.error("calls of OpenGL can be left out on x86-64 and Linux only; run this there")
    context = bare_context()
    names = options.pipelines or [info.name for info in pipelines(context) if info.available]
    about = {**machine(context), "goal_ms": GOAL, "goal_bytes": MOST_BYTES, "fiblet_bytes": FIBLET_BYTES,
             "chunks": {"discrete": chunks_of(MOST_BYTES, DISCRETE.fiblets),
                        "integrated": chunks_of(MOST_BYTES, INTEGRATED.fiblets)}}  # fmt: skip
    results = []
    for chunks in options.chunks:
        fiblets = tiny_fiblets(chunks)
        for pipeline in names:
            for case in options.cases:
                for culling in CULLINGS if case == "engine" else CULLINGS[:1]:
                    measure = engine if case == "engine" else mapper
                    row = {"case": case, "pipeline": pipeline, "culling": culling}
                    with as_on_a_card(), recording() as calls:
                        row |= measure(calls, fiblets, row, options)
                    results.append(row)
                    print(row, flush=True)
    write("frame-cost", about, results, page(about, results), plot, options.output)


def tiny_fiblets(pages: int) -> Any:
    """Return a set of so many pages, of fiblets of three points each."""
    rng = np.random.default_rng(4)
    n = pages * layout.PAGE
    start, steps = rng.uniform(-60.0, 60.0, (n, 1, 3)), rng.normal(size=(n, 1, 3))
    steps = np.concatenate([steps, steps + 0.1 * rng.normal(size=(n, 1, 3))], axis=1)
    steps *= 0.5 / np.linalg.norm(steps, axis=2, keepdims=True)
    points = np.concatenate([start, start + np.cumsum(steps, axis=1)], axis=1).reshape(-1, 3)
    return compress(Streamlines(points.astype("f4"), 3 * np.arange(n + 1)), exact=False)


@contextmanager
def as_on_a_card() -> Iterator[None]:
    """Cut nothing that is cut for software OpenGL only, and put a page into a chunk."""
    with (
        patch.object(compute, "is_software", lambda _: False),
        patch.object(textured, "is_software", lambda _: False),
        patch.object(limits.WorkLimits, "of", lambda _: WorkLimits(layout.PAGE, 1 << 62)),
    ):
        yield


def flown(calls: Calls, draw: Callable[[int], float], frames: int) -> dict[str, Any]:
    """Draw from a moving camera, the first pictures in earnest; `draw` returns CPU seconds."""
    for number in range(WARM):
        draw(number)
    calls.silent = True
    try:
        draw(WARM)
        calls.forget()
        taken = [draw(WARM + 1 + number) for number in range(frames)]
        return {**percentiles(taken), "calls": sum(calls.counts.values()) / frames}
    finally:
        calls.silent = False


def engine(calls: Calls, fiblets: Any, case: dict[str, Any], options: Any) -> dict[str, Any]:
    """Measure a renderer without VTK."""
    below = bare_context()  # a window that VTK closes takes the display of older ones along
    moderngl.init_context()
    ctx = moderngl.get_context()
    ctx.clear_errors()
    culling = None if case["culling"] == "none" else case["culling"]
    renderer = FibletRenderer(ctx, fiblets, pipeline=case["pipeline"], culling=culling)
    path = views(fiblets.bounds, "far", 0.5, options.frames + WARM + 1, (640, 360))

    def draw(number: int) -> float:
        begin = time.thread_time()
        renderer.render(path[number])
        return time.thread_time() - begin

    row = {"chunks": len(renderer._chunks), **flown(calls, draw, options.frames)}  # noqa: SLF001
    renderer.release()
    below.release()
    return row


def mapper(calls: Calls, fiblets: Any, case: dict[str, Any], options: Any) -> dict[str, Any]:
    """Measure what a mapper does when VTK draws its actor."""
    import pyvista as pv

    from pvfiblets.mappers.engine_mapper import EngineMapper

    plotter = pv.Plotter(off_screen=True, window_size=(640, 360))
    actor = plotter.add_fiblets(fiblets, pipeline=case["pipeline"], culling=case["culling"])
    plotter.picture.antialias = "off"
    spent = [0.0]
    honest = EngineMapper._update  # noqa: SLF001

    def timed(self: Any, program: Any) -> None:
        begin = time.thread_time()
        honest(self, program)
        spent[0] += time.thread_time() - begin

    def draw(number: int) -> float:
        spent[0] = 0.0
        plotter.camera.azimuth += 0.5 if number % 2 else -0.5  # two views, of which each has its programs after WARM
        plotter.render()
        return spent[0]

    with patch.object(EngineMapper, "_update", timed):
        plotter.show(auto_close=False)
        plotter.render_window.SetDesiredUpdateRate(15.0)  # a hand moves the camera
        row = flown(calls, draw, options.frames)
    (slot,) = (slot for context in contexts_with(actor.mapper) for slot in [context.slot(actor.mapper)])
    row["chunks"] = len(slot.renderer._chunks)  # noqa: SLF001
    plotter.close()
    return row


def contexts_with(mapper: Any) -> Any:
    """Return the contexts of the windows that a mapper was drawn in."""
    from pvfiblets.mappers.windows import contexts_with as found

    return found(mapper)


def page(about: dict[str, Any], results: list[dict[str, Any]]) -> str:
    """Return the table in Markdown."""
    chunks = sorted({row["chunks"] for row in results})
    at = about["chunks"]
    lines = [
        "# CPU time of a picture", "",
        f"{on_machine(about)}. Milliseconds of this thread for a picture of a moving camera, median; calls of OpenGL "
        f"do nothing. {MOST_BYTES / 1e9:g} GB of fiblets of {FIBLET_BYTES:.1f} bytes are "
        f"{MOST_BYTES / FIBLET_BYTES / 1e6:.0f} million: {at['discrete']} chunks on a card of its own, "
        f"{at['integrated']} on an integrated one.", "",
    ]  # fmt: skip
    kinds = list(dict.fromkeys((row["case"], row["pipeline"], row["culling"]) for row in results))
    body = []
    for kind in kinds:
        rows = {row["chunks"]: row for row in results if (row["case"], row["pipeline"], row["culling"]) == kind}
        cells = [f"{rows[n]['ms']:.2f}" if n in rows else "" for n in chunks]
        last, first = rows[max(rows)], rows[min(rows)]
        more = (last["calls"] - first["calls"]) / max(last["chunks"] - first["chunks"], 1)
        body.append(f"| {' | '.join(kind)} | {' | '.join(cells)} | {first['calls']:.0f} + {more:.0f} a chunk more |")
    lines += to_table(["what", "pipeline", "culling", *map(str, chunks), "calls of OpenGL"], body)
    lines += ["", *verdicts(about, results)]
    return "\n".join(lines) + "\n"


def verdicts(about: dict[str, Any], results: list[dict[str, Any]]) -> list[str]:
    """Return whether the goal is reached, for each kind of card of which there is a row."""
    found = []
    for card, n in about["chunks"].items():
        rows = [row for row in results if row["chunks"] == n and row["case"] == "engine"]
        if rows:
            worst = max(rows, key=lambda row: row["ms"])
            word = "kept" if worst["ms"] <= GOAL else f"missed by {worst['ms'] - GOAL:.1f} ms"
            most = f"{worst['ms']:.2f} ms at most ({worst['pipeline']}, {worst['culling']})"
            found.append(f"- {card}, {n} chunks: {most}; the goal of {GOAL:g} ms is {word}.")
    return found


def plot(about: dict[str, Any], results: list[dict[str, Any]], path: Path) -> None:
    """Draw milliseconds over chunks."""
    plt = pyplot()
    figure, axis = plt.subplots(figsize=(8, 5), layout="constrained")
    for kind in dict.fromkeys((row["case"], row["pipeline"], row["culling"]) for row in results):
        rows = [row for row in results if (row["case"], row["pipeline"], row["culling"]) == kind]
        style = ":" if kind[2] == "none" else "-" if kind[0] == "engine" else "--"
        x, y = [row["chunks"] for row in rows], [row["ms"] for row in rows]
        axis.plot(x, y, style, marker="o", label=", ".join(kind))
    axis.axhline(GOAL, color="black", linewidth=0.8)
    axis.set_xlabel("chunks")
    axis.set_ylabel("CPU ms a picture")
    axis.set_title(f"{about['cores']} CPU cores, calls of OpenGL left out")
    axis.grid(True, alpha=0.2)
    axis.set_ylim(bottom=0.0)
    axis.legend(fontsize="small")
    figure.savefig(path, dpi=110)


if __name__ == "__main__":
    main()
