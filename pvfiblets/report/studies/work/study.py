"""The study of work: fiblets, bytes and calls of a frame, pass by pass, counted without a graphics card."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.engine import FibletRenderer, FibletStyle, View
from pvfiblets.engine.errors import EngineError
from pvfiblets.engine.gbuffer import EMPTY

from ...drawing import drawing_context
from ...record import Axes, Figure, Record
from ...study import Options, Study
from ..culling.pictures import views
from .counts import ROUNDS, Calls, counted, frame_lanes, pass_work

if TYPE_CHECKING:
    import moderngl

    from pvfiblets.codec.fibletset import FibletSet

SEGMENTS, QUICK_SEGMENTS = (6e6, 60e6, 434e6, 600e6), (2e5,)  # of synthetic brains
STEP = 0.1  # mm between points
SIZE, QUICK_SIZE = (1920, 1080), (320, 180)
SLOW, JUMP = 1.14, 120.0  # degrees a frame; and at once
STEADY = 3  # frames before the one that is counted
SCENES = ("first", "far", "close", "inside", "jump")


def run(options: Options) -> Iterator[Record]:
    """Yield a record for every pass of every scene, and one of the frame."""
    from pvfiblets.synthetic import brain, streamline_count

    size = QUICK_SIZE if options.quick else SIZE
    with drawing_context(options) as ctx:
        for segments in QUICK_SEGMENTS if options.quick else SEGMENTS:
            name = f"{segments / 1e6:g} M segments"
            if not options.allows(name):
                continue
            try:
                fiblets = brain(streamline_count(segments, STEP), STEP, options.seed)
                for scene in SCENES:
                    if options.allows(f"{name}, {scene}"):
                        yield from measured(ctx, fiblets, name, scene, size)
            except (EngineError, MemoryError) as error:
                options.leave_out(name, error or "memory does not suffice")

def flight(bounds: Any, scene: str, size: tuple[int, int]) -> list[View]:
    """Return the views of a scene; the last is counted."""
    if scene == "first":
        return views(bounds, "far", SLOW, 1, size)
    kind = "far" if scene == "jump" else scene
    path = views(bounds, kind, SLOW, STEADY + 1, size)
    return [*path[:-1], views(bounds, kind, JUMP, 2, size)[1]] if scene == "jump" else path


def measured(
    ctx: moderngl.Context, fiblets: FibletSet, name: str, scene: str, size: tuple[int, int]
) -> Iterator[Record]:
    """Draw a scene, and yield the records of its last frame."""
    renderer = FibletRenderer(ctx, fiblets, pipeline="compute", culling="two-phase")
    try:
        *before, last = flight(fiblets.bounds, scene, size)
        for view in before:
            renderer.render(view, FibletStyle())
        began = time.perf_counter()
        with counted() as calls:
            target = renderer.render(last, FibletStyle())
        ctx.finish()
        spent = time.perf_counter() - began
        owners = np.frombuffer(target.owner.read(), "<u4")
        seen = np.unique(owners[owners != EMPTY])
        yield from records(renderer, calls, f"{name}, {scene}", owners, len(seen), spent)
    finally:
        renderer.release()


def records(
    renderer: FibletRenderer, calls: Calls, data: str, owners: Any, visible: int, spent: float
) -> Iterator[Record]:
    """Yield a record for each pass, and one of the whole frame."""
    work = pass_work(renderer, owners.size, int((owners != EMPTY).sum()))
    passes = {str(one["name"]): float(one["ms"]) for one in renderer.explain(counts=False)["passes"]}
    estimate = 0.0
    for name in [name for name in work if name in passes or name.partition(":")[0] in passes]:
        dispatches = calls.dispatches[name] + calls.full_screen_draws[name]
        seconds = work[name].seconds(dispatches)
        estimate += seconds
        costs = {
            "fiblets": Figure(work[name].fiblets, ""),
            "read": Figure(work[name].read / 1e6, "MB"),
            "written": Figure(work[name].written / 1e6, "MB"),
            "dispatches": Figure(dispatches, ""),
            "H100": Figure(1e6 * seconds, "µs"),
            "here": Figure(passes.get(name, math.nan), "ms"),
        }
        if name in ROUNDS:
            costs |= {
                f"lanes of {width}": Figure(frame_lanes(renderer, ROUNDS[name], width), "") for width in (8, 32, 64)
            }
        yield Record(data, "", "work", name, "", {}, costs)
    drawn = sum(work[name].fiblets for name in ("visible", "predicted", "depth") if name in work)
    tested = sum(work[name].fiblets for name in ("cull", "predicted: tests", "occlusion") if name in work)
    costs = {
        "fiblets": Figure(float(renderer.explain(counts=False)["fiblets_total"]), ""),
        "tested": Figure(tested, ""),
        "drawn": Figure(drawn, ""),
        "visible": Figure(float(visible), ""),
        "read": Figure(sum(one.read for one in work.values()) / 1e6, "MB"),
        "written": Figure(sum(one.written for one in work.values()) / 1e6, "MB"),
        "dispatches": Figure(calls.dispatches.total(), ""),
        "barriers": Figure(calls.barriers.total(), ""),
        "chunk binds": Figure(calls.chunk_binds.total(), ""),
        "full-screen draws": Figure(calls.full_screen_draws.total(), ""),
        "H100": Figure(1e6 * estimate, "µs"),
        "here": Figure(1e3 * spent, "ms"),
    }
    yield Record(data, "", "work", "frame", "", {}, costs, ours=True, default=True)


STUDY = Study(
    name="work",
    title="Work of a frame",
    approximates=(
        "No approximation: fiblets tested and drawn, bytes, calls and milliseconds of a frame of the compute pipeline."
    ),
    axes=(Axes("work", "costs/read", "costs/fiblets", "MB read", "fiblets", alternatives=False),),
    notes=(
        "*first*: the first frame, from outside. *far*, *close*, *inside*: a frame of a flight of 1.14° a frame, from "
        "where the set fits the frame, from a third of that, from near the middle. *jump*: 120° from the frame "
        "before, from outside.",
        "Fiblets are counted, and the same on every driver; so are calls, but for pyramids, which software draws and "
        "cards compute by two dispatches, and for what cards with 64-bit atomics leave out. Bytes follow from the "
        "layouts, each read or written once. *H100*: these bytes at 3.35 TB/s and 5 µs a dispatch, an estimate. "
        "*here*: this machine. *lanes*: the share of lanes that have a fiblet, in subgroups of 8, 32 and 64.",
    ),
    run=run,
)
