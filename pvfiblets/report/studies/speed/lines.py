"""The study of lines in windows: fiblets beside VTK's polylines and tubes, each in a process of its own.

``python -m pvfiblets.report.studies.speed.lines`` measures the cells that it reads (:mod:`pvfiblets.report.process`).
"""

from __future__ import annotations

import math
import tempfile
import time
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...drawing import data_bytes
from ...process import CellProcess, Row, serve
from ...record import FRAME, Axes, Figure, Record
from ...study import Options, Study, Unavailable
from ...timing import timing
from ...window import Window
from .cells import DEGREES_PER_FRAME, WARM
from .study import FRAMES, LIMIT, QUICK_FRAMES, QUICK_SECONDS, by_size

if TYPE_CHECKING:
    from pvfiblets.codec.fibletset import FibletSet

SEGMENTS, QUICK_SEGMENTS = (1e5, 3e5, 1e6, 3e6, 6e6, 1e7), (2e4,)
SIZE, QUICK_SIZE = (1920, 1080), (320, 180)
SECONDS = 60.0  # of drawing, three frames at least
STEP = 0.5  # mm
MOST_OF_TUBES = 1e6  # segments: of more a frame takes minutes
POLYLINES, TUBES, FIBLETS = "VTK's polylines", "VTK's tubes", "fiblets"
METHODS = ((FIBLETS, ""), (POLYLINES, ""), (POLYLINES, "without multi-sampling"), (TUBES, ""))


def run(options: Options) -> Iterator[Record]:
    """Yield a record for every size and method."""
    from pvfiblets import formats
    from pvfiblets.synthetic import brain_streamlines, streamline_count

    if find_spec("pyvista") is None:
        raise Unavailable("pyvista is not installed")
    size, frames, seconds = (
        (QUICK_SIZE, QUICK_FRAMES, QUICK_SECONDS) if options.quick else (SIZE, FRAMES, SECONDS)
    )
    found = []
    with tempfile.TemporaryDirectory() as folder:
        for segments in QUICK_SEGMENTS if options.quick else SEGMENTS:
            brain = brain_streamlines(streamline_count(segments, STEP), STEP, seed=options.seed)
            path = Path(folder) / "brain.tck"
            formats.write(path, brain)
            exact = brain.n_points - len(brain)
            del brain
            data = f"{exact / 1e6:,.3g} M segments, {size[0]}×{size[1]}"
            for method, setting in METHODS:
                what = ", ".join(part for part in (data, method, setting) if part)
                if method == TUBES and segments > MOST_OF_TUBES:
                    continue
                if not options.allows(what):
                    continue
                cell = {"method": method, "aliased": bool(setting), "path": str(path), "size": size,
                        "frames": frames, "limit": seconds}  # fmt: skip
                process = CellProcess.for_module("pvfiblets.report.studies.speed.lines")
                row = process.measure(cell, LIMIT)
                process.close()
                if "unmeasured" in row:
                    options.leave_out(what, row["unmeasured"])
                    continue
                options.driver = row["driver"]
                options.log(f"lines: {what}")
                found.append(_record(data, method, setting, row))
                yield found[-1]
    yield from by_size(found)

def _record(data: str, method: str, setting: str, row: Row) -> Record:
    return Record(
        data=data,
        group="lines",
        approximation="nothing",
        method=method,
        setting=setting,
        errors={},
        costs={
            "memory": Figure(row["gpu_bytes"] / row["points"], "bytes/point"),
            "peak": Figure(row["peak_bytes"] / 1e6, "MB"),
            "load": Figure(row["load"], "s"),
        },
        times={"draw": timing(row["seconds"], 1.0, FRAME, row["clock"])},
        ours=method == FIBLETS,
        default=method == FIBLETS,
    )


def measure_lines(cell: Row) -> Row:
    """Load a file by one method, and turn it."""
    from pvfiblets import formats

    window = Window(cell["size"], multisampled=not cell["aliased"])
    plotter, load = window.plotter, time.perf_counter()
    if cell["method"] == FIBLETS:
        from pvfiblets.codec.encoding.compress import compress
        from pvfiblets.synthetic import brain_streamlines

        compress(brain_streamlines(10), exact=False)  # the codec compiles itself when first used
        load = time.perf_counter()
        fiblets: FibletSet = compress(formats.read(cell["path"]), exact=False)
        points, actor = fiblets.n_points, plotter.add_fiblets(fiblets, render=False)
    else:
        import pyvista as pv

        lines = pv.wrap(formats.read(cell["path"]).to_polydata())
        points = lines.n_points
        tangents = np.abs(np.gradient(lines.points, axis=0))
        tangents /= np.linalg.norm(tangents, axis=1, keepdims=True) + 1e-12
        lines["orientation"] = (255 * tangents).astype(np.uint8)
        if cell["method"] == TUBES:
            lines = lines.tube(radius=0.25 * STEP, n_sides=6)
        actor = plotter.add_mesh(lines, scalars="orientation", rgb=True, render=False)
    plotter.view_vector((-1, 0.8, 0.45), viewup=(0, 0, 1))
    window.show()
    window.wait()
    load = time.perf_counter() - load
    taken: list[float] = []
    begun = time.perf_counter()
    while len(taken) < cell["frames"] + WARM:
        plotter.camera.azimuth += DEGREES_PER_FRAME
        plotter.renderer.ResetCameraClippingRange()
        start = window.clock()
        window.render()
        taken.append(window.clock() - start)
        if len(taken) >= WARM + 3 and time.perf_counter() - begun > cell["limit"]:
            break
    nbytes = data_bytes(actor.explain()) if cell["method"] == FIBLETS else _vertex_bytes(lines)
    window.release()
    return {"points": points, "seconds": taken[WARM:], "clock": window.clock_name, "driver": window.driver,
            "load": load, "gpu_bytes": nbytes, "peak_bytes": _peak_bytes()}  # fmt: skip


def _peak_bytes() -> float:
    """Return the most memory that this process ever had; NaN where there is no /proc."""
    try:
        status = dict(line.split(":", 1) for line in Path("/proc/self/status").read_text().splitlines())
    except OSError:
        return math.nan  # getrusage would count the process that started this one as well
    return 1024.0 * int(status["VmHWM"].split()[0])


def _vertex_bytes(mesh: Any) -> int:
    """Return what VTK holds on the GPU: float32 points and normals, RGBA bytes, indices of segments and triangles."""
    segments = mesh.lines.size - 2 * mesh.n_lines if mesh.n_lines else 0
    triangles = int((np.diff(np.asarray(mesh.GetStrips().GetOffsetsArray())) - 2).sum()) if mesh.n_strips else 0
    normals = 12 if mesh.point_data.active_normals is not None else 0
    return int(mesh.n_points * (12 + 4 + normals) + 4 * (2 * segments + 3 * triangles))


STUDY = Study(
    name="lines",
    title="Lines in a window",
    approximates="No approximation: frames, memory and time to load of lines, beside VTK's own.",
    axes=(
        Axes("size", "", "errors/ms at M segments ", "million segments", "ms per frame", series=True),
        Axes("memory", "times/draw", "costs/memory", "ms per frame", "bytes per point on the GPU"),
    ),
    notes=(
        f"An orbit of {DEGREES_PER_FRAME}° a frame around a synthetic brain, steps of {STEP:g} mm, lit and coloured by "
        "orientation, lines one pixel wide. A plotter multi-samples by default: that smooths VTK's lines and costs "
        "them time, but not fiblets. *without multi-sampling* gives the same picture as fiblets. Each method draws in "
        "a process of its own: *peak* is its resident memory, *load* the time from the .tck file to the first frame, "
        "coding included.",
    ),
    run=run,
)

if __name__ == "__main__":
    serve(measure_lines)
