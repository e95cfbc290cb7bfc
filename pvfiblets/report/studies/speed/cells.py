"""The cells of the study of speed: each draws one thing from a slow flight on a bare context of its own.

``python -m pvfiblets.report.studies.speed.cells`` measures the cells that it reads (:mod:`pvfiblets.report.process`).
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from pvfiblets.engine.view import View

from ...cameras import orbit
from ...drawing import data_bytes
from ...process import Row, serve
from ...timing import clock_of
from ..culling.pictures import views

__all__ = ["CELLS", "measure_cell", "stored_brain"]

DEGREES_PER_FRAME = 1.14  # Schertzer et al. 2022, section 4.5: 90 degrees a second at 80 frames
PER_STREAMLINE = 94.0  # mm, on average, of pvfiblets.synthetic.brain
TURN = 315  # frames of a whole turn, 1.14 degrees apart
WARM = 2  # frames that do not count: the first compiles, the second still looks at the first


def stored_brain(segments: float, step: float, folder: str | Path) -> Any:
    """Return a set of about so many segments, from a file in a folder if it is there already."""
    from pvfiblets import FibletSet
    from pvfiblets.synthetic import brain

    count = max(1, round(segments * step / PER_STREAMLINE))
    path = Path(folder) / f"brain-{count}-{step:g}.fiblets"
    if not path.exists():
        unfinished = path.with_suffix(".part")
        brain(count, step, path=unfinished, progress=sys.stderr.isatty())
        unfinished.rename(path)
    return FibletSet.open(path)


def flown(ctx: Any, draw: Callable[[Any], Any], path: Sequence[Any], seconds: float) -> Row:
    """Draw along a path for so many seconds, three frames at least, each waited for."""
    clock, name = clock_of(ctx)
    taken: list[float] = []
    begun = time.perf_counter()
    for place in path:
        start = clock()
        draw(place)
        ctx.finish()
        taken.append(clock() - start)
        if len(taken) >= WARM + 3 and time.perf_counter() - begun > seconds:
            break
    return {"seconds": taken[WARM:], "first": taken[0], "clock": name}


def fiblets(ctx: Any, cell: Row) -> Row:
    """Fiblets by one pipeline and culling: the paper's table 2, and the last column of its table 3."""
    from pvfiblets.engine import FibletRenderer

    brain = stored_brain(cell["segments"], cell["step"], cell["folder"])
    culling = None if cell["culling"] == "none" else cell["culling"]
    renderer = FibletRenderer(ctx, brain, pipeline=cell["pipeline"], culling=culling)
    try:
        path = views(brain.bounds, cell["view"], DEGREES_PER_FRAME, cell["frames"] + WARM, tuple(cell["size"]))
        row = flown(ctx, renderer.render, path, cell["limit"])
        return {**row, "gpu_bytes": data_bytes(renderer.explain(counts=False))}
    finally:
        renderer.release()


VERTEX = """
#version 330
uniform mat4 matrix;
in vec3 place;
out vec3 shown;
void main() { gl_Position = matrix * vec4(place, 1.0); shown = place; }
"""
FRAGMENT = """
#version 330
in vec3 shown;
out vec4 colour;
void main() { colour = vec4(abs(fract(0.02 * shown)), 1.0); }
"""
RESTART = 0xFFFFFFFF
"""Ends a strip; moderngl has restarts by this index on in every context."""


def line_strips(ctx: Any, cell: Row) -> Row:
    """Decoded points as line strips, 16 bytes a point with their indices: what a basic OpenGL program draws."""
    import moderngl

    brain = stored_brain(cell["segments"], cell["step"], cell["folder"])
    size = tuple(cell["size"])
    points, strips, begin = [], [], 0
    for chunk in brain.iter_chunks():
        points.append(np.asarray(chunk.points, np.float32))
        index = np.arange(begin, begin + chunk.n_points, dtype=np.uint32)
        strips.append(np.insert(index, np.asarray(chunk.offsets)[1:], RESTART))
        begin += chunk.n_points
    program = ctx.program(vertex_shader=VERTEX, fragment_shader=FRAGMENT)
    places, indices = ctx.buffer(np.concatenate(points)), ctx.buffer(np.concatenate(strips))
    array = ctx.vertex_array(program, [(places, "3f", "place")], index_buffer=indices)
    target = ctx.framebuffer([ctx.texture(size, 4)], ctx.depth_renderbuffer(size))
    target.use()
    ctx.enable_only(moderngl.DEPTH_TEST)

    def draw(view: View) -> None:
        target.clear()
        program["matrix"].write(np.ascontiguousarray(view.model_view_projection.T, np.float32))
        array.render(moderngl.LINE_STRIP)

    path = views(brain.bounds, "far", DEGREES_PER_FRAME, cell["frames"] + WARM, size)
    return {**flown(ctx, draw, path, cell["limit"]), "gpu_bytes": places.size + indices.size}


def feature(ctx: Any, cell: Row) -> Row:
    """One feature of fiblets alone: the paper's section 5 and figures 1, 11 and 12."""
    from ..features.scenes import Drawn
    from ..features.subjects import brain_subject

    subject = brain_subject(stored_brain(cell["segments"], cell["step"], cell["folder"]))
    (wanted,) = (one for one in subject.features if f"{one.group} {one.name}".strip() == cell["feature"])
    path = subject.path(cell["frames"] + WARM, tuple(cell["size"]))
    drawn = Drawn(ctx, subject, wanted, path[:1])
    try:
        return {**flown(ctx, drawn.render, path, cell["limit"]), "gpu_bytes": drawn.nbytes}
    finally:
        drawn.release()


def tubes(ctx: Any, cell: Row) -> Row:
    """Spline tubes: Russig et al. 2020, figure 5, this program's bars."""
    from pvfiblets.engine.tubes import TubeRenderer, TubeStyle
    from pvfiblets.synthetic.tubes import tube_set

    made = tube_set(cell["set"])
    path = orbit(made, cell["view"], TURN, tuple(cell["size"]))
    return _by_renderer(ctx, TubeRenderer(ctx, made), TubeStyle(), path, cell)


def halos(ctx: Any, cell: Row) -> Row:
    """Lines and points with halos: the sets of Everts et al. 2009, table 1."""
    from pvfiblets.engine.halos import HaloRenderer
    from pvfiblets.synthetic.halos import halo_set

    from ..halos.pictures import finer, look_of
    from ..halos.pictures import orbit as around

    drawn = halo_set(cell["set"])
    path = around(drawn, 1, cell["frames"] + WARM, tuple(cell["size"]))[0]
    return _by_renderer(ctx, HaloRenderer(ctx, drawn), finer(look_of(drawn), 1), path, cell)


def volume(ctx: Any, cell: Row) -> Row:
    """A tree of vessels, ray cast in one mode."""
    from pvfiblets.engine.volumes import VolumeRenderer, VolumeStyle
    from pvfiblets.synthetic.vessels import vessel_tree

    from ..volumes.scene import circle, look_of

    data = vessel_tree(cell["voxels"], 0, "uint16")
    path = circle(data, cell["frames"] + WARM, tuple(cell["size"]))
    style = VolumeStyle(casting=look_of(data, cell["mode"]).casting())
    return _by_renderer(ctx, VolumeRenderer(ctx, data), style, path, cell)


def _by_renderer(ctx: Any, renderer: Any, style: Any, path: Sequence[Any], cell: Row) -> Row:
    def draw(camera: Any) -> None:
        renderer.render(View(camera.size, camera.model_view_projection), style)

    try:
        row = flown(ctx, draw, path[: cell["frames"] + WARM], cell["limit"])
        return {**row, "gpu_bytes": data_bytes(renderer.explain())}
    finally:
        renderer.release()


CELLS: dict[str, Callable[[Any, Row], Row]] = {
    "fiblets": fiblets, "line strips": line_strips, "feature": feature, "tubes": tubes, "halos": halos,
    "volume": volume,
}  # fmt: skip


def measure_cell(cell: Row) -> Row:
    """Draw one cell on a context of its own."""
    from pvfiblets.engine import EngineError
    from pvfiblets.engine.gl.standalone import bare_context

    ctx = bare_context()
    try:
        return CELLS[cell["kind"]](ctx, cell)
    except (EngineError, MemoryError) as error:
        return {"unmeasured": (str(error) or type(error).__name__).splitlines()[0]}


if __name__ == "__main__":
    serve(measure_cell)
