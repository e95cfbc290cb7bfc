"""The ways of drawing spline tubes that the benchmark compares, and how each is timed.

Every way draws the same tubes from the same cameras, without anti-aliasing, opaque and of one colour, in the light of
one lamp at the eye. What differs is said with each way in :data:`ABOUT`.
"""

from __future__ import annotations

import re
import time
from typing import Any

import numpy as np
from orbit import context
from tube_reference import Camera, covered, fine_coverage, orbit

ABOUT = {
    "lines-as-tubes": "VTK's lines with tube shading, as wide as the mean radius is in the middle of the picture",
    "tube-SIDES": "VTK's tube filter around the nodes' polylines, with flat caps",
    "tube-SIDESxN": "the same with every segment of the spline sampled N times",
    "tessellated": "hardware tessellation on a bare context: 6 to 30 sides and up to 5 additional samples along a "
    "segment, by size on the screen; open ends",
    "engine": "this program's ray casting on a bare context: a G-buffer, not lit",
    "splines": "`plotter.add_spline_tubes`: the same in a PyVista scene, lit by VTK",
}
MESHES = ("lines-as-tubes", "tube-6", "tube-12", "tube-30", "tube-12x4", "tube-30x4")
DEFAULT = (*MESHES, "tessellated", "engine", "splines")
PICTURE = ("gbuffer", "occlusion", "framebuffer", "depth")  # grow with the picture, not with the data
_TUBE = re.compile(r"tube-(\d+)(?:x(\d+))?")


class TooMuchError(Exception):
    """A way needs more than it may take, or something that is not there."""


def known(way: str) -> str:
    """Return a way's name, or raise ValueError: for the command line."""
    if way not in ("lines-as-tubes", "tessellated", "engine", "splines") and not _TUBE.fullmatch(way):
        raise ValueError(f"unknown way {way!r}, expected one of {', '.join(ABOUT)}")
    return way


def make_set(name: str, seed: int = 0) -> Any:
    """Return a set of spline tubes by name: one of the paper's five, or ``helices-N`` with N small tubes."""
    if name.startswith("helices-"):
        return helices(int(name.partition("-")[2]))
    from pvfiblets.synthetic.tubes import tube_set

    return tube_set(name, seed)


def helices(count: int, nodes: int = 25) -> Any:
    """Return tubes of varying radius around helices, beside each other on a circle."""
    from pvfiblets import SplineTubes

    t = np.linspace(0.0, 4.0 * np.pi, nodes)
    shift = 2.0 * np.pi * np.arange(count)[:, None] / count
    ring = 0.8 * count * np.stack([np.cos(shift), np.sin(shift), 0.0 * shift], axis=2)
    points = ring + np.stack(np.broadcast_arrays(np.cos(t + shift), np.sin(t + shift), 0.5 * t), axis=2)
    slopes = np.stack(np.broadcast_arrays(-np.sin(t + shift), np.cos(t + shift), 0.5), axis=2)
    radius = np.broadcast_to(0.4 + 0.2 * np.sin(2.0 * t), (count, nodes))
    growth = np.broadcast_to(0.4 * np.cos(2.0 * t), (count, nodes))
    first = (np.arange(count)[:, None] * nodes + np.arange(nodes - 1)).ravel()
    return SplineTubes(
        points=points.reshape(-1, 3), segments=np.stack([first, first + 1], axis=1), radius=radius.ravel(),
        tangents=slopes.reshape(-1, 3) * t[1], radius_slopes=growth.ravel() * t[1], scaled=False,
        tubes=np.repeat(np.arange(count), nodes - 1), n_tubes=count,
    )  # fmt: skip


def polylines(tubes: Any, samples: int = 1) -> Any:
    """Return the axes as poly-lines with the array ``radius``: through the nodes, or more samples of each segment."""
    import pyvista as pv

    from pvfiblets.splines import curves

    ends = tubes.segments
    starts = np.ones(len(ends), bool)
    starts[1:] = (ends[1:, 0] != ends[:-1, 1]) | (tubes.tubes[1:] != tubes.tubes[:-1])
    first = np.flatnonzero(starts)
    counts = np.diff([*first, len(ends)]) * samples + 1
    offsets = np.cumsum([0, *counts])
    rows = np.empty((offsets[-1], 4))
    last = np.zeros(offsets[-1], bool)
    last[offsets[1:] - 1] = True
    t = 2.0 * np.arange(samples) / samples
    halves = curves.controls(tubes)
    pieces = [curves.evaluate(halves[:, int(at)], np.array(at % 1.0)) for at in t]
    rows[~last] = np.stack(pieces, axis=1).reshape(-1, 4)
    rows[last] = curves.evaluate(halves[np.append(first[1:], len(ends)) - 1, 1], np.array(1.0))
    cells = np.empty(len(rows) + len(first), np.int64)
    heads = offsets[:-1] + np.arange(len(first))
    cells[heads] = counts
    cells[np.delete(np.arange(len(cells)), heads)] = np.arange(len(rows))
    mesh = pv.PolyData(rows[:, :3], lines=cells)
    mesh["radius"] = rows[:, 3]
    return mesh


def run(way: str, tubes: Any, options: Any) -> list[dict[str, Any]]:
    """Return one row for each view: times, sizes, and under ``covered`` where the first camera's picture shows tubes.

    Raises
    ------
    TooMuchError
        If the way would need more memory than ``options.limit`` allows, or is not there.
    """
    drawn = {"tessellated": _Tessellated, "engine": _Engine, "splines": _Splines}.get(way, _Mesh)(way, tubes, options)
    rows = []
    try:
        for view in options.views:
            cameras = orbit(tubes, view, options.frames, tuple(options.size))
            times = _times(drawn.draw, cameras, options.seconds)
            row = {"view": view, **_spread(times, "ms"), "frames": len(times), **drawn.facts(cameras)}
            drawn.draw(cameras[0])
            row["covered"] = drawn.covered()
            rows.append(row)
    finally:
        drawn.close()
    if not hasattr(drawn, "empty"):
        return rows
    empty = drawn.empty()
    if isinstance(empty, str):
        return [{**row, "no_empty": empty} for row in rows]
    try:
        for row in rows:
            cameras = orbit(tubes, row["view"], options.frames, tuple(options.size))
            row |= _spread(_times(empty.draw, cameras, options.seconds), "empty_ms")
    finally:
        empty.close()
    return rows


def reference(tubes: Any, options: Any) -> dict[str, Any]:
    """Return, for each view, the reference of the first camera's picture, as arrays to be written."""
    found = {}
    for view in options.views:
        drawn = fine_coverage(tubes, orbit(tubes, view, options.frames, tuple(options.size))[0], options.supersampling)
        found |= {f"{view}-{name}": getattr(drawn, name) for name in ("same_size", "shares", "length")}
    return found


def _times(draw: Any, cameras: list[Camera], seconds: float) -> list[float]:
    """Return the seconds of each frame, without two to warm up; fewer than all of them where they take too long."""
    times: list[float] = []
    for camera in (cameras[-2 % len(cameras)], cameras[-1]):
        draw(camera)
    began = time.perf_counter()
    for camera in cameras:
        start = time.perf_counter()
        draw(camera)
        times.append(time.perf_counter() - start)
        if len(times) >= 3 and time.perf_counter() - began > seconds:
            break
    return times


def _spread(times: list[float], name: str) -> dict[str, Any]:
    low, middle, high = (1e3 * float(np.percentile(times, q)) for q in (10, 50, 90))
    return {name: middle, f"{name}_spread": [low, high]}


def _check(needed: float, options: Any) -> None:
    if needed > options.limit[1] * 1e9:
        raise TooMuchError(f"needs about {needed / 1e9:.1f} GB of memory, more than the {options.limit[1]:g} allowed")


class _Plotted:
    """What all ways in a PyVista window share."""

    def __init__(self, options: Any) -> None:
        import pyvista as pv

        self.plotter = pv.Plotter(off_screen=True, window_size=list(options.size), lighting="none")
        self.plotter.disable_anti_aliasing()
        self.plotter.add_light(pv.Light(light_type="headlight"))
        self.plotter.set_background("black")

    def draw(self, camera: Camera) -> None:
        camera.aim(self.plotter)
        self.plotter.render()
        self.plotter.render_window.WaitForCompletion()
        self.plotter.render_window.GetPixelData(0, 0, 0, 0, 0, 0)  # one pixel needs the whole picture

    def covered(self) -> np.ndarray:
        return covered(self.plotter)

    def close(self) -> None:
        self.plotter.close()


class _Mesh(_Plotted):
    """VTK's tube filter, or its lines drawn as tubes."""

    def __init__(self, way: str, tubes: Any, options: Any) -> None:
        super().__init__(options)
        self.radius = float(tubes.radius[tubes.segments].mean())
        self.wide = way == "lines-as-tubes"
        if self.wide:
            mesh = polylines(tubes)
            segments = mesh.n_points - mesh.n_lines
            self.bytes, self.primitives = 12 * mesh.n_points + 8 * segments, 2 * segments
            self.actor = self.plotter.add_mesh(mesh, color="steelblue", render_lines_as_tubes=True)
        else:
            sides, samples = (int(n or 1) for n in _TUBE.fullmatch(way).groups())
            points = (tubes.n_segments * samples + tubes.n_tubes) * sides
            _check(points * 2.5 * (24 + 24), options)  # once as made, once as VTK keeps it for drawing, and indices
            mesh = polylines(tubes, samples)
            lines = mesh.n_lines
            mesh = mesh.tube(scalars="radius", absolute=True, n_sides=sides)
            cells = np.diff(mesh.GetStrips().GetOffsetsArray()) if mesh.n_strips else np.zeros(0, int)
            self.primitives = int((np.asarray(cells) - 2).sum()) + mesh.n_faces_strict
            self.bytes = 24 * mesh.n_points + 12 * self.primitives
            self.note = "" if mesh.n_strips else f"none of {lines} lines drawn"
            self.actor = self.plotter.add_mesh(mesh, color="steelblue", show_scalar_bar=False)
            self.actor.prop.interpolation = "Phong"
        self.actor.mapper.scalar_visibility = False
        self.plotter.show(auto_close=False)

    def draw(self, camera: Camera) -> None:
        if self.wide:
            distance = float(np.linalg.norm(camera.eye - camera.centre))
            self.actor.prop.line_width = max(1.0, 2.0 * self.radius * camera.pixels / distance)
        super().draw(camera)

    def facts(self, _: list[Camera]) -> dict[str, Any]:
        return {"gpu_bytes": self.bytes, "primitives": self.primitives}


class _Splines(_Plotted):
    """Spline tubes by this program in a PyVista scene."""

    def __init__(self, _: str, tubes: Any, options: Any) -> None:
        super().__init__(options)
        if not hasattr(self.plotter, "add_spline_tubes"):
            self.plotter.close()
            raise TooMuchError("there is no plotter.add_spline_tubes here")
        choices = {name: value for name in ("silhouettes", "solver") if (value := getattr(options, name))}
        self.actor = self.plotter.add_spline_tubes(tubes, color="steelblue", **choices)
        self.plotter.show(auto_close=False)

    def facts(self, _: list[Camera]) -> dict[str, Any]:
        return _told(self.actor.explain())


class _Engine:
    """Spline tubes by this program without VTK."""

    def __init__(self, _: str, tubes: Any, options: Any, **more: Any) -> None:
        try:
            from pvfiblets.engine.splines import SplineRenderer
        except ImportError as error:
            raise TooMuchError(f"the engine draws no spline tubes: {error}") from error
        choices = {name: value for name in ("silhouettes", "solver") if (value := getattr(options, name))}
        self.given = tubes, options
        self.ctx = context()
        self.renderer = SplineRenderer(self.ctx, tubes, **choices, **more)
        self.gbuffer: Any = None

    def draw(self, camera: Camera) -> None:
        from pvfiblets.engine import Style, View

        self.gbuffer = self.renderer.render(View(camera.size, camera.model_view_projection), Style())
        self.ctx.finish()

    def facts(self, _: list[Camera]) -> dict[str, Any]:
        return _told(self.renderer.explain())

    def covered(self) -> np.ndarray:
        width, height = self.gbuffer.size
        keys = np.frombuffer(self.gbuffer.depth.read(), np.uint32).reshape(height, width)
        return keys != 0xFFFFFFFF

    def empty(self) -> _Engine | str:
        """Return the same that discards every fragment first thing, or why there is none."""
        try:
            return _Engine("engine", *self.given, discard=True)
        except TypeError as error:
            return f"not to be had: {error}"

    def close(self) -> None:
        self.renderer.release()
        self.ctx.release()


class _Tessellated:
    """The paper's rival."""

    def __init__(self, _: str, tubes: Any, options: Any, **more: Any) -> None:
        from tessellated import TessellatedTubes

        self.given = tubes, options
        self.ctx = context()
        self.tubes = TessellatedTubes(self.ctx, tubes, tuple(options.size), **more)

    def draw(self, camera: Camera) -> None:
        self.tubes.render(camera.model_view_projection)
        self.ctx.finish()

    def facts(self, cameras: list[Camera]) -> dict[str, Any]:
        """Return sizes; the triangles are the mean over an orbit, as the paper's are."""
        counts = []
        for camera in cameras[:: max(1, len(cameras) // 8)]:
            self.tubes.render(camera.model_view_projection, count=True)
            counts.append(self.tubes.triangles)
        return {"gpu_bytes": self.tubes.nbytes, "primitives": round(float(np.mean(counts)))}

    def covered(self) -> np.ndarray:
        return self.tubes.covered()

    def empty(self) -> _Tessellated:
        return _Tessellated("tessellated", *self.given, discard=True)

    def close(self) -> None:
        self.tubes.release()
        self.ctx.release()


def _told(report: dict[str, Any]) -> dict[str, Any]:
    sizes = [buffer["bytes"] for buffer in report["buffers"] if buffer["name"] not in PICTURE]
    return {"gpu_bytes": sum(sizes), "primitives": report.get("primitives")}
