"""The study of speed: frames of every drawable on a bare context, up to billions of segments."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numpy as np

from ...drawing import drawing_context
from ...process import CellProcess, Row
from ...record import FRAME, Axes, Figure, Record
from ...study import Options, Study
from ...timing import timing
from .cells import stored_brain

SEGMENTS, QUICK_SEGMENTS = (1e6, 6e6, 60e6, 434e6, 1e9, 5.4e9), (5e4, 2e5)  # Schertzer et al. 2022, table 2
STRIPS, QUICK_STRIPS = (8e6, 81e6, 202e6, 434e6), (5e4,)  # and table 3
STEP = 0.1  # mm between points; the paper's are 0.1 and 0.05
SIZES, QUICK_SIZES = ((1920, 1080), (3840, 2160)), ((320, 180),)
CULLINGS = ("two-phase", "coverage", "none")
FEATURES = ("plain", "lines 3 pixels wide, shaded", "lines tubes of 0.5 mm", "lines 4 layers", "lines all, in slices",
            "cut mesh", "cut sphere", "filter half of the streamlines", "effects ambient occlusion",
            "effects halos")  # fmt: skip
FEATURED = 60e6  # segments
TUBES = ("fibers", "hotroom", "bundle", "brain", "furball")
HALOS = ("fibres-subset", "office", "shape-small")
VOXELS, QUICK_VOXELS = (256, 512), (48,)
MODES = ("composite", "mip", "isosurface")
FRAMES, QUICK_FRAMES = 40, 5
SECONDS, QUICK_SECONDS = 10.0, 0.5  # of drawing a cell, three frames at least
LIMIT = 300.0  # seconds that a cell may take in all
HOPELESS = 3.0  # seconds a frame, beyond which a pipeline draws no larger set
BRAINS = "PVFIBLETS_BRAINS"  # names a folder that keeps synthetic brains: 12 GB of them in a whole run


def run(options: Options) -> Iterator[Record]:
    """Yield a record for every cell, the most important first."""
    from pvfiblets.engine.gl import capabilities

    with drawing_context(options) as ctx:
        known = capabilities.pipelines(ctx)
        fastest = capabilities.choose(ctx, "auto")
    for info in known:
        if not info.available:
            options.leave_out(f"pipeline {info.name}", info.why_not)
    pipelines = sorted((info.name for info in known if info.available), key=lambda name: name != fastest)
    with ExitStack() as stack:
        folder = os.environ.get(BRAINS) or stack.enter_context(tempfile.TemporaryDirectory())
        process = CellProcess.for_module("pvfiblets.report.studies.speed.cells")
        stack.callback(process.close)
        hopeless: set[tuple[Any, ...]] = set()
        parts = sections(options.quick, pipelines)
        for number, cells in enumerate(parts):
            part = options.share(1.0 / (len(parts) - number))
            found: list[Record] = []
            for cell in cells:
                done = measured({**cell, "folder": folder}, process, hopeless, part)
                if done is not None:
                    record, _ = done
                    record.default = (cell.get("pipeline"), cell.get("culling")) == (fastest, CULLINGS[0])
                    found.append(record)
                    yield record
            yield from by_size(found)

def sections(quick: bool, pipelines: list[str]) -> list[list[Row]]:
    """Return what is measured, the most important first; the first pipeline is the default."""
    sizes = [list(size) for size in (QUICK_SIZES if quick else SIZES)]
    segments, low = QUICK_SEGMENTS if quick else SEGMENTS, sizes[0]
    flight = {"step": STEP, "view": "far"}
    fiblets = {"kind": "fiblets", "pipeline": pipelines[0], "culling": CULLINGS[0], **flight}
    by_size = [
        [{**fiblets, "segments": count, "size": size, "pipeline": pipeline, "culling": culling}
         for count in segments for pipeline in pipelines for culling in CULLINGS]
        for size in sizes
    ]  # fmt: skip
    strips = [{**cell, "segments": count, "size": low} for count in (QUICK_STRIPS if quick else STRIPS)
              for cell in ({"kind": "line strips", **flight}, *([] if count in segments else [fiblets]))]  # fmt: skip
    brain = {"segments": min(FEATURED, max(segments)), "size": low}
    figures: list[Row] = [{"kind": "feature", "feature": name, **flight, **brain} for name in FEATURES]
    figures += [{**fiblets, **brain, "view": view} for view in ("close", "inside")]
    others: list[Row] = [{"kind": "tubes", "set": name, "view": view, "size": low}
                         for name in (TUBES[:1] if quick else TUBES) for view in ("far", "close")]  # fmt: skip
    others += [{"kind": "halos", "set": name, "size": low} for name in (HALOS[-1:] if quick else HALOS)]
    others += [{"kind": "volume", "voxels": side, "mode": mode, "size": low}
               for side in (QUICK_VOXELS if quick else VOXELS) for mode in MODES]  # fmt: skip
    return [by_size[0], strips, figures, others, *by_size[1:]]


def measured(
    cell: Row, process: CellProcess, hopeless: set[tuple[Any, ...]], options: Options
) -> tuple[Record, Row] | None:
    """Return the record of one cell and its row, if there are; its data is made before, outside its time."""
    data, method, setting = named(cell)
    what = ", ".join(part for part in (data, method, setting) if part)
    key = tuple(str(cell.get(name)) for name in ("kind", "size", "pipeline", "culling"))
    if key in hopeless:
        options.leave_out(what, "far too slow at fewer segments")
        return None
    if not options.allows(what):
        return None
    if "segments" in cell:
        try:
            stored_brain(cell["segments"], cell["step"], Path(cell["folder"]))
        except (OSError, MemoryError) as error:
            options.leave_out(what, f"its data was not made: {error or type(error).__name__}")
            return None
    frames, seconds = (QUICK_FRAMES, QUICK_SECONDS) if options.quick else (FRAMES, SECONDS)
    row = process.measure({**cell, "frames": frames, "limit": seconds}, min(LIMIT, max(options.budget.left, 1.0)))
    if "segments" in cell and not np.median(row.get("seconds", HOPELESS)) < HOPELESS:
        hopeless.add(key)
    if "unmeasured" in row:
        options.leave_out(what, row["unmeasured"])
        return None
    options.log(f"speed: {what}")
    record = Record(
        data=data,
        group="" if cell["kind"] != "fiblets" or cell["view"] != "far" else "fiblets",
        approximation="nothing",
        method=method,
        setting=setting,
        errors={},
        costs={"memory": Figure(row["gpu_bytes"] / 1e6, "MB"), "first": Figure(1e3 * row["first"], "ms")},
        times={"draw": timing(row["seconds"], 1.0, FRAME, row["clock"])},
        ours=cell["kind"] != "line strips",
    )
    return record, row


def named(cell: Row) -> tuple[str, str, str]:
    """Return data, method and setting of a cell's record."""
    at = f"{cell['size'][0]}×{cell['size'][1]}"
    match cell["kind"]:
        case "fiblets" | "line strips" | "feature":
            view = "" if cell["view"] == "far" else f", {cell['view']}"
            data = f"{cell['segments'] / 1e6:,g} M segments{view}, {at}"
            if cell["kind"] == "fiblets":
                return data, cell["pipeline"], f"culling {cell['culling']}{cell.get('but', '')}"
            return data, str(cell.get("feature", cell["kind"])), ""
        case "volume":
            return f"vessels of {cell['voxels']}³ voxels, {at}", "volume", cell["mode"]
    return f"{cell['kind']}: {cell['set']}, {at}", cell["kind"], cell.get("view", "")


def by_size(records: list[Record]) -> Iterator[Record]:
    """Yield milliseconds as lines over the number of segments, of each pipeline and culling."""
    shown: dict[tuple[str, str], dict[str, Figure]] = {}
    for record in records:
        if record.group:
            number, _, size = record.data.partition(" M segments, ")
            label = f"{record.method}, {record.setting}"
            shown.setdefault((size, label), {})[f"ms at M segments {number.replace(',', '')}"] = Figure(
                1e3 * record.value("times/draw"), "ms"
            )
    for (size, label), figures in shown.items():
        if len(figures) > 1:
            yield Record(f"by segments, {size}", "segments", "nothing", label, "", figures, ours=True)


STUDY = Study(
    name="speed",
    title="Speed",
    approximates=(
        "No approximation: milliseconds and bytes of pipelines by the number of segments, beside line strips of the "
        "same points; of features, spline tubes, halos and volumes. Neither VTK nor a display is needed."
    ),
    axes=(Axes("size", "", "errors/ms at M segments ", "million segments", "ms per frame", series=True),),
    notes=(
        "A slow flight, 1.14° a frame, around synthetic brains of steps of 0.1 mm, each frame waited for; one process "
        "draws cell after cell, and a driver that dies costs one cell. Where OpenGL is software, times are of the "
        "processor, all threads; those of cards are by the clock. *first*: the first frame, which compiles programs. "
        "Brackets: least and greatest frame.",
        "Schertzer et al. 2022: table 2 (pipelines and culling; its mesh pipeline takes 33.9 ms for 5.4 billion "
        "segments on an RTX 2080 Ti), table 3 (*line strips*: 16 bytes a point), section 5 (features). Russig et al. "
        "2020: the sets of spline tubes. Everts et al. 2009: those of halos.",
    ),
    run=run,
)
