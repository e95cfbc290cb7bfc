"""The cells of ``benchmarks/card.py``: each draws one thing from a slow flight, and returns its times and a picture."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from common import DEGREES_PER_FRAME, data_bytes, make_brain, percentiles, segments_of

from pvfiblets.engine.view import View
from pvfiblets.report.cameras import orbit
from pvfiblets.report.studies.culling.pictures import colours, views, visible

__all__ = ["CELLS", "draw_cell"]

TURN = 315  # pictures of a whole turn, 1.14 degrees apart
WARM = 2  # pictures that do not count: the first compiles, the second still looks at the first
PICTURE = (480, 270)

Row = dict[str, Any]
Draw = Callable[[Any], Any]


def flown(ctx: Any, draw: Draw, path: Sequence[Any], seconds: float) -> tuple[Row, Any]:
    """Draw along a path, each picture waited for; return times, and the last G-buffer."""
    taken: list[float] = []
    begin = time.perf_counter()
    last = None
    for number, place in enumerate(path):
        start = time.perf_counter()
        last = draw(place)
        ctx.finish()
        if number == 0:
            first = time.perf_counter() - start
        if number >= WARM:
            taken.append(time.perf_counter() - start)
        if len(taken) >= 3 and time.perf_counter() - begin > seconds:
            break
    return {**percentiles(taken), "mean_ms": 1e3 * float(np.mean(taken)), "first_ms": 1e3 * first,
            "frames": len(taken)}, last  # fmt: skip


def fiblets(ctx: Any, cell: Row, folder: Path) -> tuple[Row, Any]:
    """Fiblets by one pipeline and culling: the paper's table 2, and the last column of its table 3."""
    from pvfiblets.engine import FibletRenderer

    brain = make_brain(cell["segments"], cell["step"], folder)
    size, culling = tuple(cell["size"]), cell["culling"]
    begin = time.perf_counter()
    renderer = FibletRenderer(ctx, brain, pipeline=cell["pipeline"], culling=None if culling == "none" else culling)
    ctx.finish()
    upload = time.perf_counter() - begin
    try:
        path = views(brain.bounds, cell.get("view", "far"), DEGREES_PER_FRAME, cell["frames"] + WARM, size)
        row, last = flown(ctx, renderer.render, path, cell["seconds"])
        row["passes"] = {one["name"]: one["ms"] for one in renderer.explain(counts=False)["passes"]}
        row |= {"segments": segments_of(brain), "gpu_bytes": data_bytes(renderer.explain(counts=False)),
                "file_bytes": brain.nbytes, "upload_seconds": upload, "pipeline": renderer.pipeline}  # fmt: skip
        return row, colours(visible(last))
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


def raw_lines(ctx: Any, cell: Row, folder: Path) -> tuple[Row, Any]:
    """Decoded points as line strips, 16 bytes a point with their indices: what a basic OpenGL program draws."""
    import moderngl

    brain = make_brain(cell["segments"], cell["step"], folder)
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
    row, _ = flown(ctx, draw, path, cell["seconds"])
    return {**row, "segments": segments_of(brain), "gpu_bytes": places.size + indices.size}, None


def feature(ctx: Any, cell: Row, folder: Path) -> tuple[Row, Any]:
    """One feature of fiblets alone: the paper's section 5 and figures 1, 11 and 12."""
    from pvfiblets.report.studies.features.scenes import Drawn
    from pvfiblets.report.studies.features.subjects import brain_subject

    brain = make_brain(cell["segments"], cell["step"], folder)
    subject = brain_subject(brain)
    (wanted,) = (one for one in subject.features if f"{one.group} {one.name}".strip() == cell["feature"])
    path = subject.path(cell["frames"] + WARM, tuple(cell["size"]))
    drawn = Drawn(ctx, subject, wanted, path[:1])
    try:
        row, _ = flown(ctx, drawn.render, path, cell["seconds"])
        return {**row, "segments": segments_of(brain), "gpu_bytes": drawn.nbytes}, colours(visible(drawn.last))
    finally:
        drawn.release()


def tubes(ctx: Any, cell: Row, _folder: Path) -> tuple[Row, Any]:
    """Spline tubes: Russig et al. 2020, figure 5, this program's bars."""
    from pvfiblets.engine.tubes import TubeRenderer, TubeStyle
    from pvfiblets.synthetic.tubes import tube_set

    made = tube_set(cell["set"])
    path = orbit(made, cell["view"], TURN, tuple(cell["size"]))[: cell["frames"] + WARM]
    renderer = TubeRenderer(ctx, made)
    try:
        row, last = flown(ctx, lambda camera: renderer.render(View(camera.size, camera.model_view_projection),
                                                              TubeStyle()), path, cell["seconds"])  # fmt: skip
        return {**row, "segments": made.n_segments}, colours(visible(last))
    finally:
        renderer.release()


def halos(ctx: Any, cell: Row, _folder: Path) -> tuple[Row, Any]:
    """Lines and points with halos: the sets of Everts et al. 2009, table 1."""
    from pvfiblets.engine.halos import HaloRenderer
    from pvfiblets.report.studies.halos.pictures import darkness_of, finer, look_of
    from pvfiblets.report.studies.halos.pictures import orbit as around
    from pvfiblets.synthetic.halos import halo_set

    drawn = halo_set(cell["set"])
    look = finer(look_of(drawn), 1)
    path = around(drawn, 1, cell["frames"] + WARM - 1, tuple(cell["size"]))[0]
    renderer = HaloRenderer(ctx, drawn)
    try:
        row, last = flown(ctx, lambda camera: renderer.render(View(camera.size, camera.model_view_projection), look),
                          path, cell["seconds"])  # fmt: skip
        return {**row, "points": drawn.n_points}, np.repeat(1.0 - darkness_of(last)[..., None], 3, axis=2)
    finally:
        renderer.release()


def volume(ctx: Any, cell: Row, _folder: Path) -> tuple[Row, Any]:
    """A ray-cast volume in one mode."""
    from pvfiblets.engine.volumes import VolumeRenderer, VolumeStyle
    from pvfiblets.report.studies.volumes.pictures import colours_of
    from pvfiblets.report.studies.volumes.scene import circle, look_of
    from pvfiblets.synthetic.vessels import vessel_tree

    data = vessel_tree(int(cell["set"].partition("-")[2]), 0, "uint16")
    look = look_of(data, cell["mode"])
    path = circle(data, cell["frames"] + WARM, tuple(cell["size"]))
    renderer, style = VolumeRenderer(ctx, data), VolumeStyle(casting=look.casting())
    try:
        row, last = flown(ctx, lambda camera: renderer.render(View(camera.size, camera.model_view_projection), style),
                          path, cell["seconds"])  # fmt: skip
        return {**row, "voxels": data.values.size}, colours_of(last, look, path[min(row["frames"] + 1, len(path) - 1)])
    finally:
        renderer.release()


CELLS: dict[str, Callable[[Any, Row, Path], tuple[Row, Any]]] = {
    "fiblets": fiblets, "raw lines": raw_lines, "feature": feature, "tubes": tubes, "halos": halos, "volume": volume,
}  # fmt: skip


def draw_cell(cell: Row, folder: Path) -> Row:
    """Draw one cell on a context of its own; its picture, if there is one, goes into ``cell["picture"]``."""
    from pvfiblets.engine import EngineError
    from pvfiblets.engine.gl.standalone import bare_context

    ctx = bare_context()
    try:
        row, picture = CELLS[cell["kind"]](ctx, cell, folder)
    except (EngineError, MemoryError) as error:
        return {"unmeasured": (str(error) or type(error).__name__).splitlines()[0]}
    if picture is not None and cell.get("picture"):
        np.save(cell["picture"], small(picture))
    return row


def small(picture: Any) -> Any:
    """Return means of blocks of pixels, as bytes, that fill a picture of the sheet from its middle."""
    times = max(1, min(picture.shape[1] // PICTURE[0], picture.shape[0] // PICTURE[1]))
    height, width = (side // times for side in picture.shape[:2])
    part = picture[: height * times, : width * times].reshape(height, times, width, times, 3).mean(axis=(1, 3))
    found = np.zeros((PICTURE[1], PICTURE[0], 3), np.uint8)
    rows, columns = min(height, PICTURE[1]), min(width, PICTURE[0])
    y, x = (height - rows) // 2, (width - columns) // 2
    to_y, to_x = (PICTURE[1] - rows) // 2, (PICTURE[0] - columns) // 2
    shown = 255.0 * np.clip(part[y : y + rows, x : x + columns], 0.0, 1.0)
    found[to_y : to_y + rows, to_x : to_x + columns] = shown.astype(np.uint8)
    return found
