"""The study of a card: what is to be known first of a graphics card that can be had for minutes, in order of value.

Every record is saved as soon as it is there. What no longer fits into the time is left out, and said.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import Self

from pvfiblets.engine.fiblets.pipelines.compute import CARD_FORMS
from pvfiblets.engine.gl.capabilities import MESH, MESH_EXT

from ...drawing import drawing_context
from ...machine import CARD_STATE
from ...process import CellProcess, Row
from ...record import FRAME, Axes, CaseResult, Figure, Record
from ...study import Budget, Options, Study
from ...timing import timing
from ..speed.cells import path_of_brain
from ..speed.study import BRAINS, QUICK_SIZES, SIZES, STEP, measured, sections
from .check import MODULE, findings_of
from .findings import MISSING, Finding
from .part import SPEED, parts_of

SEGMENTS, QUICK_SEGMENTS = (60e6, 434e6, 1e9, 5.4e9), (5e4, 1e6)
CHANGED, QUICK_CHANGED = (434e6, 5.4e9), (1e6,)  # of which every step is measured beside its alternatives
STRIPS, QUICK_STRIPS = (8e6, 81e6, 202e6), (5e4,)
WARM, QUICK_WARM = 2.0, 0.1  # s, at most, until the card's clock stands
CHECK_SHARE = 0.25  # of the time, for checking fiblets
CELL_SECONDS = 90.0  # that a cell or a check may take: a driver that hangs is not to use up the time
CHECKED_FIRST = ("fiblets compute", "fiblets mesh")
BYTES = 64  # of a buffer for a fiblet, about
COMPUTE = "fiblets.pipelines.compute"
QUICKER = 7  # bits by which limits are less of a quick run

FORMS: dict[str, Row] = {MESH_EXT: {}, MESH: {"constants": {"gl.capabilities:MESH_EXT": "none"}}}


def alternatives(quick: bool) -> dict[str, Row]:
    """Return steps of a frame of the compute pipeline, done otherwise: none changes a pixel."""
    less = QUICKER if quick else 0
    cards = ("DISCRETE", "INTEGRATED", "SOFTWARE")

    def calls(fiblets: int) -> Row:
        return {"constants": {f"gl.work_limits:{card}": {"listed": fiblets} for card in cards}}

    def switched(form: str) -> Row:
        others = [other for other in CARD_FORMS if other != form]
        return {"constants": {f"{COMPUTE}:CARD_FORMS": others, f"{COMPUTE}:SOFTWARE_FORMS": [form]}}

    return {
        "culling none": {"culling": "none"},
        "32-bit atomics": {"constants": {f"{COMPUTE}:INT64_EXTENSIONS": ["none"]}},
        **{f"{form} switched": switched(form) for form in CARD_FORMS},
        **{f"calls of 2^{n} fiblets": calls(1 << n) for n in (21 - less, 25 - less, 28 - less)},
        **{f"prediction level {n}": {"constants": {"culling.pyramid:PREDICTION_LEVEL": n}} for n in (2, 3, 5)},
        "clusters in all sets": {"constants": {"fiblets.data.chunks:CLUSTERED": 0}},
        "no clusters": {"constants": {"fiblets.data.chunks:CLUSTERED": 1 << 40}},
        **{f"work groups of {n}": {"constants": {"gl.passes:GROUP_SIZE": n}} for n in (32, 128, 256)},
        # Last, because clusters are made anew.
        **{f"buffers of 2^{n} fiblets": {"buffer_bytes": BYTES << n} for n in (25 - less, 23 - less, 21 - less)},
    }


def run(options: Options) -> Iterator[Record | CaseResult]:
    """Yield a record for every cell and a case for every check, the most important first."""
    from pvfiblets.engine.gl import capabilities

    with drawing_context(options) as ctx:
        known = capabilities.pipelines(ctx)
        forms = [form for form in FORMS if form in ctx.extensions]
    yield CaseResult(
        "OpenGL", "the default pipeline", f"a context without a window: {options.driver}", "it is compute",
        Figure(float(known.auto != "compute"), ""), 0.0, known.auto == "compute",
    )  # fmt: skip
    for info in known:
        if not info.available:
            options.leave_out(f"pipeline {info.name}", info.why_not)
    with ExitStack() as stack:
        folder = os.environ.get(BRAINS) or stack.enter_context(tempfile.TemporaryDirectory())
        cells = plan(options.quick, known.auto or "", forms)
        brains = stack.enter_context(_Brains(cells, folder))
        parts = [part for part in parts_of([info.name for info in known if info.available]) if SPEED not in part]
        first = [part for part in CHECKED_FIRST if part in parts]
        yield from _checked(options.share(CHECK_SHARE), first, folder)
        process = CellProcess.for_module("pvfiblets.report.studies.speed.cells")
        stack.callback(process.close)
        others = _checked(options, [part for part in parts if part not in first], folder)
        usual: dict[str, str] = {}
        while cells:
            ready = next((cell for cell in cells if brains.has(cell)), None)
            if ready is None and options.budget.left > 0.0:
                if (case := next(others, None)) is not None:
                    yield case
                else:
                    time.sleep(0.05)
                continue
            cell = ready or cells[0]
            cells.remove(cell)
            own = replace(options, budget=Budget(min(options.budget.left, CELL_SECONDS)))
            done = measured({**cell, "folder": folder}, process, set(), own)
            if done is not None:
                yield from _completed(*done, cell, usual)
        yield from others

def plan(quick: bool, fastest: str, forms: Sequence[str]) -> list[Row]:
    """Return what is measured, the most important first."""
    size = list((QUICK_SIZES if quick else SIZES)[0])
    segments, changed = (QUICK_SEGMENTS, QUICK_CHANGED) if quick else (SEGMENTS, CHANGED)
    flight: Row = {"step": STEP, "view": "far", "size": size, "warm": QUICK_WARM if quick else WARM}
    usual: Row = {"kind": "fiblets", "pipeline": fastest, "culling": "two-phase", **flight}
    mesh = [{**usual, "segments": segments[0], "pipeline": name, "but": f", {form}", **FORMS[form]}
            for form in forms for name in ("mesh", "mesh-serial")]  # fmt: skip
    others = [
        {**usual, "segments": count, "but": "" if "culling" in other else f", {name}", **other}
        for count in changed
        for name, other in alternatives(quick).items()
    ]
    strips = [{**cell, "segments": count} for count in (QUICK_STRIPS if quick else STRIPS)
              for cell in ({"kind": "line strips", **flight}, *([] if count in segments else [usual]))]  # fmt: skip
    _, _, features, rest, *_ = sections(quick, [fastest])
    last = [{**cell, "warm": flight["warm"]} for cell in (*features, *rest)]
    by_size = [{**usual, "segments": count} for count in segments]
    return [*by_size[:1], *mesh, *by_size[1:], *others, *strips, *last]


class _Brains:
    """Synthetic brains, made by a process of low priority while smaller ones are drawn, the smallest first."""

    def __init__(self, cells: Sequence[Row], folder: str) -> None:
        self._folder = folder
        wanted = sorted({(cell["segments"], cell["step"]) for cell in cells if "segments" in cell})
        code = (
            "import os; from pvfiblets.report.studies.speed.cells import stored_brain\n"
            "getattr(os, 'nice', int)(10)\n"
            f"for segments, step in {wanted}: stored_brain(segments, step, {folder!r})"
        )
        threads = {"NUMBA_NUM_THREADS": str(max((os.cpu_count() or 2) // 2, 1))}
        self._process = subprocess.Popen(
            [sys.executable, "-c", code], env={**os.environ, **threads}, stderr=subprocess.DEVNULL
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._process.kill()
        self._process.wait()

    def has(self, cell: Row) -> bool:
        """Return True if a cell's data is there, or nobody makes it."""
        if "segments" not in cell or self._process.poll() is not None:
            return True
        return path_of_brain(cell["segments"], cell["step"], self._folder).exists()


def _checked(options: Options, parts: Sequence[str], folder: str) -> Iterator[CaseResult]:
    """Yield a case for each thing that ``pvfiblets gl --check`` tries of some parts."""
    for part in parts:
        if not options.lasts(f"checks of {part}"):
            continue
        options.log(part)
        process = CellProcess([sys.executable, "-m", MODULE])
        for finding, _ in findings_of(part, Path(folder), process, min(CELL_SECONDS, options.budget.left)):
            yield from _case(finding, options)
            if not options.lasts(f"checks of {part} after {finding.feature}"):
                break


def _case(one: Finding, options: Options) -> Iterator[CaseResult]:
    if one.verdict == MISSING:
        options.leave_out(f"{one.part}: {one.feature}", one.note)
        return
    name = max(one.limits, key=lambda name: one.figures[name] / max(one.limits[name], 1e-300), default="")
    measured = Figure(one.figures.get(name, float(one.bad)), name.partition(", ")[2] or "of 1")
    yield CaseResult(
        one.part, one.feature, "drawn and compared with float64", f"error of {name}" if name else "it is drawn",
        measured, one.limits.get(name, 0.0), not one.bad, one.note or one.verdict,
    )  # fmt: skip


def _completed(record: Record, row: Row, cell: Row, usual: dict[str, str]) -> Iterator[Record | CaseResult]:
    """Yield a cell's record, with all that was read of the card, and whether its frame is that of the default."""
    record.group = ""
    if MESH_EXT in record.setting and "MESH_EXT" not in row["features"]:
        record.setting += f" refused, drawn by {MESH}"
    record.default = cell["kind"] == "fiblets" and "but" not in cell
    record.costs |= {f"pass {name}": Figure(ms, "ms") for name, ms in row["passes"].items()}
    record.costs["steady"] = Figure(float(row["steady"]), "")
    for when, state in (("before", row["before"]), ("", row["after"])):
        record.costs |= {f"{name} {when}".strip(): Figure(value, CARD_STATE[name]) for name, value in state.items()}
    if "in_flight" in row:
        record.times["in flight"] = timing([row["in_flight"]], 1.0, FRAME, "wall")
    if row["clock"] == "wall" and row.get("gpu"):
        record.times["GPU"] = timing(row["gpu"], 1.0, FRAME, "GPU")
    yield record
    if cell["kind"] != "fiblets" or cell["pipeline"] != "compute":
        return
    if "but" not in cell:
        usual[record.data] = row["digest"]
    elif record.data in usual:
        differ = float(row["digest"] != usual[record.data])
        yield CaseResult(
            "compute", f"{record.data}{cell['but']}", "the same frame by other steps", "no pixel differs",
            Figure(differ, "of 1 frame"), 0.0, not differ,
        )  # fmt: skip


STUDY = Study(
    name="card",
    title="A card's first minutes",
    approximates=(
        "No approximation: does each pipeline draw right, and how many milliseconds do frames, their passes and the "
        "alternatives to their steps take? Neither VTK nor a display is needed."
    ),
    axes=(Axes("memory", "times/draw", "costs/memory", "ms per frame", "MB", alternatives=False),),
    notes=(
        "A slow flight around synthetic brains of steps of 0.1 mm, after the card's clock has settled. *draw*: each "
        "frame waited for. *in flight*: the clock's time of a frame while none is waited for; *GPU*: the card's own, "
        "from timestamps. *pass*: medians of the passes of frames waited for. *steady*: 1 where five frames took as "
        "long as the five before them. Clocks, power and temperature are those after the frames; *before* is before.",
        "*switched*: a form of passes that only graphics cards run, left out on a card, or run by software.",
        "Cases compare with float64 (`pvfiblets gl --check`), and frames with those of the default, bit by bit.",
    ),
    run=run,
)
