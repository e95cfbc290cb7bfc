"""The cells of the studies of speed and of cards: each draws one thing from a slow flight on a bare context of its own.

``python -m pvfiblets.report.studies.speed.cells`` measures the cells that it reads (:mod:`pvfiblets.report.process`).
A cell with ``warm`` draws for so many seconds, or until frames are as fast as they get, before frames count, and flies
once more without waiting for any frame. ``constants`` are other values of the engine's constants (:mod:`.constants`).
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from hashlib import sha1
from pathlib import Path
from typing import TYPE_CHECKING, Any
from unittest.mock import patch

import numpy as np

from pvfiblets.engine.gbuffer import EMPTY
from pvfiblets.engine.gl.moderngl_extras import GLExtras
from pvfiblets.engine.gl.picture_clock import TimestampClock
from pvfiblets.engine.view import View

from ...cameras import orbit
from ...drawing import data_bytes
from ...machine import card_state
from ...process import Row, serve
from ...timing import clock_of
from ..culling.pictures import views
from .constants import replaced

if TYPE_CHECKING:
    import moderngl

    from pvfiblets.codec.fibletset import FibletSet

DEGREES_PER_FRAME = 1.14  # Schertzer et al. 2022, section 4.5: 90 degrees a second at 80 frames
TURN = 315  # frames of a whole turn, 1.14 degrees apart
WARM = 2  # frames that do not count: the first compiles, the second still looks at the first


def path_of_brain(segments: float, step: float, folder: str | Path) -> Path:
    """Return the file of a set of about so many segments."""
    from pvfiblets.synthetic import streamline_count

    return Path(folder) / f"brain-{streamline_count(segments, step)}-{step:g}.fiblets"


def stored_brain(segments: float, step: float, folder: str | Path) -> FibletSet:
    """Return a set of about so many segments, from a file in a folder if it is there already."""
    from pvfiblets import FibletSet
    from pvfiblets.synthetic import brain, streamline_count

    path = path_of_brain(segments, step, folder)
    if not path.exists():
        unfinished = path.with_suffix(".part")
        brain(streamline_count(segments, step), step, path=unfinished, progress=sys.stderr.isatty())
        unfinished.rename(path)
    return FibletSet.open(path)


@dataclass(frozen=True)
class Drawing:
    """Something to be drawn from a flight."""

    draw: Callable[[Any], Any]  # Draws from a place of the path
    path: Sequence[Any]
    nbytes: Callable[[], int]  # On the GPU that grow with the data
    release: Callable[[], object]
    explain: Callable[[], Mapping[str, Any]] = dict  # Passes and features of the last frame
    waits: bool = False  # Whether each frame waits for its end


def _flown(ctx: moderngl.Context, drawing: Drawing, seconds: float, warm: float = 0.0) -> Row:
    """Draw along a path for so many seconds, three frames at least, each waited for."""
    clock, name = clock_of(ctx)
    taken: list[float] = []
    passes: dict[str, list[float]] = {}
    steady, begun = None, time.perf_counter()
    for place in drawing.path:
        start = clock()
        drawing.draw(place)
        ctx.finish()
        taken.append(clock() - start)
        if len(taken) > WARM:
            for one in drawing.explain().get("passes", ()):
                passes.setdefault(one["name"], []).append(one["ms"])
        elif len(taken) == WARM:
            steady = _warmed(ctx, drawing, warm) if warm else None
            begun = time.perf_counter()
        if len(taken) >= WARM + 3 and time.perf_counter() - begun > seconds:
            break
    middle = {name: float(np.median(ms)) for name, ms in passes.items()}
    return {"seconds": taken[WARM:], "first": taken[0], "clock": name, "steady": steady, "passes": middle}


def _warmed(ctx: moderngl.Context, drawing: Drawing, seconds: float) -> bool:
    """Draw until five frames take as long as the five before, within 2 %; return whether they came to that."""
    end, last = time.perf_counter() + seconds, 0.0
    while time.perf_counter() < end:
        start = time.perf_counter()
        for place in [*drawing.path[1:6], drawing.path[0]][:5]:
            drawing.draw(place)
        ctx.finish()
        now = time.perf_counter() - start
        if abs(now - last) < 0.02 * now:
            return True
        last = now
    return False


def in_flight(ctx: moderngl.Context, drawing: Drawing, frames: int) -> Row:
    """Draw frames without waiting for any, as a window does: seconds a frame, and those of the GPU."""
    queue = TimestampClock(GLExtras(ctx))
    start = time.perf_counter()
    for place in drawing.path[:frames]:
        with queue.timed((0, False)):
            drawing.draw(place)
    ctx.finish()
    spent = (time.perf_counter() - start) / frames
    try:
        return {"in_flight": spent, "gpu": [seconds for _, seconds in queue.finished()]}
    finally:
        queue.release()


def digest(target: Any) -> str:
    """Return a short name for what a G-buffer shows: depths, lines and places of all pixels with a line."""
    shown = np.frombuffer(target.depth.read(), np.uint32) != EMPTY
    found = sha1(usedforsecurity=False)
    for texture in (target.depth, target.owner, target.ids, target.position):
        words = np.frombuffer(texture.read(), np.uint32).reshape(len(shown), -1)
        found.update(np.ascontiguousarray(words[shown]).tobytes())
    return found.hexdigest()[:12]


_CLUSTERS: dict[tuple[Any, ...], list[Any]] = {}


@contextmanager
def _clusters_kept(cell: Row) -> Iterator[None]:
    """Keep the clusters of a set until another has any: those of billions of segments take half a minute."""
    from pvfiblets.engine.fiblets.data import clusters

    made, of = clusters.cluster_words, (cell["segments"], cell["step"])

    def kept(fiblets: FibletSet, first: int, last: int) -> Iterator[Any]:
        key = (*of, first, last)
        if key not in _CLUSTERS:
            for other in [other for other in _CLUSTERS if other[:2] != of]:
                del _CLUSTERS[other]
            _CLUSTERS[key] = list(made(fiblets, first, last))
        yield from _CLUSTERS[key]

    with patch.object(clusters, "cluster_words", kept):
        yield


def fiblets(ctx: moderngl.Context, cell: Row) -> Drawing:
    """Fiblets by one pipeline and culling: the paper's table 2, and the last column of its table 3."""
    from pvfiblets.engine import FibletRenderer

    brain = stored_brain(cell["segments"], cell["step"], cell["folder"])
    culling = None if cell["culling"] == "none" else cell["culling"]
    with _clusters_kept(cell):
        renderer = FibletRenderer(
            ctx, brain, pipeline=cell["pipeline"], culling=culling, max_buffer_bytes=cell.get("buffer_bytes")
        )
    path = views(brain.bounds, cell["view"], DEGREES_PER_FRAME, cell["frames"] + WARM, tuple(cell["size"]))
    return _of_renderer(renderer, renderer.render, path)


def _of_renderer(renderer: Any, draw: Callable[[Any], Any], path: Sequence[Any]) -> Drawing:
    def explain() -> Mapping[str, Any]:
        explained: Mapping[str, Any] = renderer.explain(counts=False)
        return explained

    return Drawing(draw, path, lambda: data_bytes(explain()), renderer.release, explain)


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


def _line_strips(ctx: moderngl.Context, cell: Row) -> Drawing:
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
    colour, depth = ctx.texture(size, 4), ctx.depth_renderbuffer(size)
    target = ctx.framebuffer([colour], depth)
    matrix: Any = program["matrix"]

    def draw(view: View) -> None:
        target.use()
        ctx.enable_only(moderngl.DEPTH_TEST)
        target.clear()
        matrix.write(np.ascontiguousarray(view.model_view_projection.T, np.float32))
        array.render(moderngl.LINE_STRIP)

    def release() -> None:
        for thing in (array, places, indices, program, target, colour, depth):
            thing.release()

    path = views(brain.bounds, "far", DEGREES_PER_FRAME, cell["frames"] + WARM, size)
    size_of_data = places.size + indices.size
    return Drawing(draw, path, lambda: size_of_data, release)


def feature(ctx: moderngl.Context, cell: Row) -> Drawing:
    """One feature of fiblets alone: the paper's section 5 and figures 1, 11 and 12."""
    from ..features.scenes import Drawn
    from ..features.subjects import brain_subject

    subject = brain_subject(stored_brain(cell["segments"], cell["step"], cell["folder"]))
    (wanted,) = (one for one in subject.features if f"{one.group} {one.name}".strip() == cell["feature"])
    path = subject.path(cell["frames"] + WARM, tuple(cell["size"]))
    drawn = Drawn(ctx, subject, wanted, path[:1])
    return Drawing(drawn.render, path, lambda: drawn.nbytes, drawn.release, waits=True)


def tubes(ctx: moderngl.Context, cell: Row) -> Drawing:
    """Spline tubes: Russig et al. 2020, figure 5, this program's bars."""
    from pvfiblets.engine.tubes import TubeRenderer, TubeStyle
    from pvfiblets.synthetic.tubes import tube_set

    made = tube_set(cell["set"])
    path = orbit(made, cell["view"], TURN, tuple(cell["size"]))
    return _by_cameras(TubeRenderer(ctx, made), TubeStyle(), path, cell)


def halos(ctx: moderngl.Context, cell: Row) -> Drawing:
    """Lines and points with halos: the sets of Everts et al. 2009, table 1."""
    from pvfiblets.engine.halos import HaloRenderer
    from pvfiblets.synthetic.halos import halo_set

    from ..halos.pictures import finer, look_of
    from ..halos.pictures import orbit as around

    drawn = halo_set(cell["set"])
    path = around(drawn, 1, cell["frames"] + WARM, tuple(cell["size"]))[0]
    return _by_cameras(HaloRenderer(ctx, drawn), finer(look_of(drawn), 1), path, cell)


def volume(ctx: moderngl.Context, cell: Row) -> Drawing:
    """A tree of vessels, ray cast in one mode."""
    from pvfiblets.engine.volumes import VolumeRenderer, VolumeStyle
    from pvfiblets.synthetic.vessels import vessel_tree

    from ..volumes.scene import circle, look_of

    data = vessel_tree(cell["voxels"], 0, "uint16")
    path = circle(data, cell["frames"] + WARM, tuple(cell["size"]))
    style = VolumeStyle(casting=look_of(data, cell["mode"]).casting())
    return _by_cameras(VolumeRenderer(ctx, data), style, path, cell)


def _by_cameras(renderer: Any, style: Any, path: Sequence[Any], cell: Row) -> Drawing:
    def draw(camera: Any) -> None:
        renderer.render(View(camera.size, camera.model_view_projection), style)

    return _of_renderer(renderer, draw, path[: cell["frames"] + WARM])


CELLS: dict[str, Callable[[Any, Row], Drawing]] = {
    "fiblets": fiblets, "line strips": _line_strips, "feature": feature, "tubes": tubes, "halos": halos,
    "volume": volume,
}  # fmt: skip


def measure_cell(cell: Row) -> Row:
    """Draw one cell on a context of its own."""
    from pvfiblets.engine import EngineError
    from pvfiblets.engine.gl.standalone import bare_context

    ctx = bare_context()
    try:
        with ctx, replaced(cell.get("constants", {})):
            drawing = CELLS[cell["kind"]](ctx, cell)
            try:
                return _measured(ctx, drawing, cell)
            finally:
                drawing.release()
    except (EngineError, MemoryError) as error:
        return {"unmeasured": (str(error) or type(error).__name__).splitlines()[0]}
    finally:
        ctx.release()


def _measured(ctx: moderngl.Context, drawing: Drawing, cell: Row) -> Row:
    warm = cell.get("warm", 0.0)
    before = card_state() if warm else {}
    row = _flown(ctx, drawing, cell["limit"], warm)
    row |= {"gpu_bytes": drawing.nbytes(), "features": list(drawing.explain().get("features", ()))}
    if warm:
        if not drawing.waits:
            row |= in_flight(ctx, drawing, len(row["seconds"]))
        row |= {"before": before, "after": card_state()}
        if cell["kind"] == "fiblets":
            row["digest"] = digest(drawing.draw(drawing.path[0]))
    return row


if __name__ == "__main__":
    serve(measure_cell)
