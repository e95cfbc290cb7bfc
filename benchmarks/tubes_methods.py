"""The methods of drawing spline tubes that the benchmark compares, and how each is timed.

Every method draws the same tubes from the same cameras, without anti-aliasing, opaque and of one colour, in the light
of one lamp at the eye. What differs is said with each method in :data:`ABOUT`.
"""

from __future__ import annotations

import functools
import re
import time
from types import SimpleNamespace
from typing import Any

import numpy as np
from common import Window, data_bytes, percentiles
from tubes_reference import covered, fine_coverage

from pvfiblets.engine.gl.standalone import bare_context
from pvfiblets.report.cameras import Camera, orbit
from pvfiblets.report.studies.codec.baselines.tessellated import TessellatedTubes
from pvfiblets.report.studies.tubes.pictures import helices

ABOUT = {
    "lines-as-tubes": "VTK's lines with tube shading, as wide as the mean radius is in the middle of the picture",
    "tube-SIDES": "VTK's tube filter around the nodes' polylines, with flat caps",
    "tube-SIDESxN": "the same with every segment of the spline sampled N times",
    "tessellated": "hardware tessellation on a bare context: 6 to 30 sides and up to 5 additional samples along a "
    "segment, by size on the screen; open ends",
    "tessellated-culled": "the same without back faces: faster, but one looks through the open ends",
    "engine": "this program's ray casting on a bare context: a G-buffer, not lit; its triangles are those without "
    "culling, and empty fragments leave nothing to hide behind",
    "engine-unculled": "the same without culling, as the paper has it",
    "engine-exact": "the same with tubes thinner than a pixel left as thin as they are",
    "plotter": "`plotter.add_spline_tubes`: the same in a PyVista scene, lit by VTK",
}
MESHES = ("lines-as-tubes", "tube-6", "tube-12", "tube-30", "tube-12x4", "tube-30x4")
TESSELLATED = ("tessellated", "tessellated-culled")
DEFAULT = (*MESHES, *TESSELLATED, "engine", "engine-unculled", "engine-exact", "plotter")
TUBE = re.compile(r"tube-(\d+)(?:x(\d+))?")


class TooMuchError(Exception):
    """A method needs more than it may take, or something that is not there."""


def make_set(name: str, seed: int = 0) -> Any:
    """Return a set of spline tubes by name: one of the paper's five, or ``helices-N`` with N small tubes."""
    if name.startswith("helices-"):
        return helices(int(name.partition("-")[2]))
    from pvfiblets.synthetic.tubes import tube_set

    return tube_set(name, seed)


def polylines(tubes: Any, samples: int = 1) -> Any:
    """Return the axes as poly-lines with the array ``radius``: through the nodes, or more samples of each segment."""
    import pyvista as pv

    from pvfiblets.tubes import curves

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


def run(method: str, tubes: Any, options: Any) -> list[dict[str, Any]]:
    """Return one row for each view: times, sizes, and under ``covered`` where the first camera's picture shows tubes.

    Raises
    ------
    TooMuchError
        If the method would need more memory than ``options.limit`` allows, or is not there.
    """
    kinds = {"tessellated": _Tessellated, "engine": _Engine, "plotter": _Plotter}
    drawn = kinds.get(method.split("-")[0], _Mesh)(method, tubes, options)
    rows: list[dict[str, Any]] = []
    try:
        empty = drawn.empty()
        for view in options.views:
            cameras = orbit(tubes, view, options.frames, tuple(options.size))
            draws = {"ms": drawn.draw} if empty is None else {"ms": drawn.draw, "empty_ms": empty.draw}
            times = _times(draws, cameras, options.seconds)
            row = {"view": view, "frames": len(times["ms"]), **drawn.facts(cameras)}
            for name, seconds in times.items():
                row |= percentiles(seconds, name)
            drawn.draw(cameras[0])
            rows.append({**row, "covered": drawn.covered()})
    finally:
        drawn.close()
    return rows


def reference(tubes: Any, options: Any) -> dict[str, Any]:
    """Return, for each view, the reference of the first camera's picture, as arrays to be written."""
    found = {}
    for view in options.views:
        drawn = fine_coverage(tubes, orbit(tubes, view, options.frames, tuple(options.size))[0], options.supersampling)
        found |= {f"{view}-{name}": getattr(drawn, name) for name in ("same_size", "shares", "length")}
    return found


def _times(draws: dict[str, Any], cameras: list[Camera], seconds: float) -> dict[str, list[float]]:
    """Return the seconds of each frame, without two to warm up; fewer than all of them where they take too long.

    Methods that are compared with each other take turns, so that whatever else the machine does hits both.
    """
    times: dict[str, list[float]] = {name: [] for name in draws}
    began = time.perf_counter()
    for frame, camera in enumerate([cameras[-2 % len(cameras)], cameras[-1], *cameras]):
        if frame == 2:
            began = time.perf_counter()
        elif frame > 4 and time.perf_counter() - began > seconds:
            break
        for name, draw in draws.items():
            start = time.perf_counter()
            draw(camera)
            if frame >= 2:
                times[name].append(time.perf_counter() - start)
    return times


def _check(needed: float, options: Any) -> None:
    if needed > options.limit[1] * 1e9:
        raise TooMuchError(f"needs about {needed / 1e9:.1f} GB of memory, more than the {options.limit[1]:g} allowed")


class _Window(Window):
    """A PyVista window that knows what its picture covers."""

    def empty(self) -> None:
        """VTK has no way to leave out the fragments alone."""

    def covered(self) -> np.ndarray:
        return covered(self.plotter)


class _Mesh(_Window):
    """VTK's tube filter, or its lines drawn as tubes."""

    def __init__(self, method: str, tubes: Any, options: Any) -> None:
        super().__init__(options.size)
        self.radius = float(tubes.radius[tubes.segments].mean())
        self.wide = method == "lines-as-tubes"
        if self.wide:
            mesh = polylines(tubes)
            segments = mesh.n_points - mesh.n_lines
            self.bytes, self.primitives = 12 * mesh.n_points + 8 * segments, 2 * segments
            self.actor = self.plotter.add_mesh(mesh, color="steelblue", render_lines_as_tubes=True)
        else:
            sides, samples = (int(n or 1) for n in TUBE.fullmatch(method).groups())
            points = (tubes.n_segments * samples + tubes.n_tubes) * sides
            _check(0.7e9 + 115.0 * points, options)  # measured: an empty window, and what VTK holds of each corner
            mesh = polylines(tubes, samples).tube(scalars="radius", absolute=True, n_sides=sides)
            strips = np.asarray(mesh.GetStrips().GetOffsetsArray())
            self.primitives = int((np.diff(strips) - 2).sum())
            self.bytes = 24 * mesh.n_points + 12 * self.primitives  # positions and normals in float32, and indices
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


class _Plotter(_Window):
    """Spline tubes by this program in a PyVista scene."""

    def __init__(self, _: str, tubes: Any, options: Any) -> None:
        super().__init__(options.size)
        self.actor = self.plotter.add_spline_tubes(tubes, color="steelblue", **_choices(options))
        self.plotter.show(auto_close=False)

    def facts(self, _: list[Camera]) -> dict[str, Any]:
        return _facts(self.actor.explain())


class _Engine:
    """Spline tubes by this program without VTK."""

    def __init__(self, method: str, tubes: Any, options: Any) -> None:
        from pvfiblets.engine.tubes import TubeRenderer, TubeStyle

        self.ctx = bare_context()
        self.made: list[Any] = []
        more = {"engine-exact": {"min_width": 0.0}, "engine-unculled": {"culling": None}}.get(method, {})
        choices = _choices(options) | more
        self.style = TubeStyle(min_width=choices.pop("min_width", 1.0))
        self.make = functools.partial(TubeRenderer, self.ctx, tubes, **choices)
        self.renderer = self._add()

    def _add(self, **more: Any) -> Any:
        self.made.append(self.make(**more))
        return self.made[-1]

    def draw(self, camera: Camera) -> None:
        self._draw(self.renderer, camera)

    def _draw(self, renderer: Any, camera: Camera) -> None:
        from pvfiblets.engine import View

        self.gbuffer = renderer.render(View(camera.size, camera.model_view_projection), self.style)
        self.ctx.finish()

    def facts(self, _: list[Camera]) -> dict[str, Any]:
        return _facts(self.renderer.explain())

    def covered(self) -> np.ndarray:
        width, height = self.gbuffer.size
        keys = np.frombuffer(self.gbuffer.depth.read(), np.uint32).reshape(height, width)
        return keys != 0xFFFFFFFF

    def empty(self) -> SimpleNamespace:
        """Return what draws the same and discards every fragment first thing."""
        renderer = self._add(discard=True)
        return SimpleNamespace(draw=lambda camera: self._draw(renderer, camera))

    def close(self) -> None:
        for renderer in self.made:
            renderer.release()
        self.ctx.release()


class _Tessellated:
    """The paper's baseline."""

    def __init__(self, method: str, tubes: Any, options: Any) -> None:
        self.ctx = bare_context()
        self.made: list[TessellatedTubes] = []
        self.make = functools.partial(
            TessellatedTubes, self.ctx, tubes, tuple(options.size), cull=method == "tessellated-culled"
        )
        self.tubes = self._add()

    def _add(self, **more: Any) -> TessellatedTubes:
        self.made.append(self.make(**more))
        return self.made[-1]

    def draw(self, camera: Camera) -> None:
        self._draw(self.tubes, camera)

    def _draw(self, tubes: TessellatedTubes, camera: Camera) -> None:
        tubes.render(camera.model_view_projection)
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

    def empty(self) -> SimpleNamespace:
        """Return what draws the same and discards every fragment first thing."""
        tubes = self._add(discard=True)
        return SimpleNamespace(draw=lambda camera: self._draw(tubes, camera))

    def close(self) -> None:
        for tubes in self.made:
            tubes.release()
        self.ctx.release()


def _choices(options: Any) -> dict[str, Any]:
    """Return this program's settings that the command line asks for."""
    return {
        name: value for name in ("silhouettes", "solver", "min_width") if (value := getattr(options, name)) is not None
    }


def _facts(report: dict[str, Any]) -> dict[str, Any]:
    return {"gpu_bytes": data_bytes(report), "primitives": report.get("primitives")}
