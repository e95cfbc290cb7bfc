"""The methods of drawing lines and points that the benchmark of halos compares, and how each is timed.

Every method draws the same data from the same cameras, black on white, without anti-aliasing, light or filter. What
differs is said with each method in :data:`ABOUT`.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any

import numpy as np
from common import Window, data_bytes, percentiles

from pvfiblets.engine.gl.standalone import bare_context
from pvfiblets.halos import HaloLines, HaloPoints, HaloStyle
from pvfiblets.report.cameras import Camera
from pvfiblets.report.studies.halos.pictures import darkness_of, helices, orbit

ABOUT = {
    "vtk": "VTK's plain lines, one pixel wide, or its plain points, as large as ours are in the middle of the "
    "picture: no halos",
    "plotter": "`plotter.add_halo_lines`, `plotter.add_halo_points`: lines and points with halos in a PyVista scene",
    "engine": "the same on a bare context, without VTK: a G-buffer",
    "engine-unculled": "the same without culling, as the paper has it",
}
STEREO = ("vtk", "plotter")
"""Methods that draw anaglyphs."""


class AbsentError(Exception):
    """A method is not there."""


@dataclass(frozen=True)
class Row:
    """A row of the paper's table 1: which data, whether as an anaglyph, the paper's figure and its frames a second."""

    data: str
    anaglyph: bool
    figure: str
    fps: float | None


ROWS = {
    "shape-small": Row("shape-small", False, "15(a)", 190.0),
    "fibres-subset": Row("fibres-subset", False, "1", 123.0),
    "fibres-subset-anaglyph": Row("fibres-subset", True, "8(b)", 65.0),
    "office": Row("office", False, "11", 290.0),
    "office-anaglyph": Row("office", True, "8(a)", 163.0),
    "shape-large": Row("shape-large", False, "15(b)", 65.0),
    "fibres": Row("fibres", False, "10(a)", 24.0),
    "water": Row("water", False, "12", 43.0),
    "terrain": Row("terrain", False, "14", 12.0),
    "water-dense": Row("water-dense", False, "13", 11.0),
}
"""Of the paper, in its order."""


def row_of(name: str) -> Row:
    """Return a row by name: one of the paper's, or ``lines-N`` and ``points-N``, N small ones, with ``-anaglyph``."""
    if name in ROWS:
        return ROWS[name]
    return Row(name.removesuffix("-anaglyph"), name.endswith("-anaglyph"), "", None)


def make_set(name: str, seed: int = 0) -> HaloLines | HaloPoints:
    """Return data by the name in a row."""
    kind, _, count = name.partition("-")
    if kind in ("lines", "points") and count.isdigit():
        return helices(int(count)) if kind == "lines" else HaloPoints(helices(int(count), 10).points)
    from pvfiblets.synthetic.halos import halo_set

    return halo_set(name, seed)


def run(method: str, row: Row, drawn: HaloLines | HaloPoints, look: HaloStyle, options: Any) -> dict[str, Any]:
    """Return times and sizes of one method.

    Raises
    ------
    AbsentError
        If the method is not there.
    """
    kinds = {"vtk": _VTK, "plotter": _Plotter, "engine": _Engine, "engine-unculled": _Engine}
    cameras = orbit(drawn, options.places, options.frames, tuple(options.size))
    drawn_by = kinds[method](method, row, drawn, look, options, cameras[0][0])
    try:
        times = timed(drawn_by.draw, cameras, options.seconds)
        facts = drawn_by.facts()
        drawn_by.draw(cameras[0][1])
        dark = drawn_by.darkness()
    finally:
        drawn_by.close()
    scale = scale_of(cameras[0][0])
    strip = look.strip_width * scale + max(look.min_width - look.line_width * scale, 0.0)
    return {**percentiles(times), "frames": len(times), "darkness": dark, "strip_pixels": strip, **facts}


def scale_of(camera: Camera) -> float:
    """Return how many pixels 1 mm takes in the middle of the data."""
    return camera.pixels / float(np.linalg.norm(camera.eye - camera.centre))


def timed(draw: Any, cameras: list[list[Camera]], seconds: float) -> list[float]:
    """Return the seconds of each frame but the first at each place; one at each place where all would take too long."""
    times: list[float] = []
    for camera in cameras[0]:  # programs are compiled, and what is made when first needed is made
        draw(camera)
    for place in cameras:
        draw(place[0])
        began = time.perf_counter()
        for camera in place[1:]:
            start = time.perf_counter()
            draw(camera)
            times.append(time.perf_counter() - start)
            if time.perf_counter() - began > seconds / len(cameras):
                break
    return times


def polydata(drawn: HaloLines | HaloPoints) -> Any:
    """Return the same as a PyVista mesh."""
    import pyvista as pv

    if isinstance(drawn, HaloPoints):
        return pv.PolyData(drawn.points)
    cells = np.insert(np.arange(drawn.n_points), drawn.offsets[:-1], np.diff(drawn.offsets))
    return pv.PolyData(drawn.points, lines=cells)


class _Window(Window):
    """Black on white in a PyVista window, as an anaglyph if the row says so."""

    def __init__(self, row: Row, options: Any) -> None:
        super().__init__(options.size, "white", headlight=False)
        self.anaglyph = row.anaglyph

    def show(self) -> None:
        self.plotter.show(auto_close=False)
        if self.anaglyph:
            self.plotter.enable_stereo_render()

    def darkness(self) -> float:
        """Return the mean of the picture, 0 white, 1 black."""
        return 1.0 - float(np.asarray(self.plotter.screenshot(None))[..., :3].mean()) / 255.0


class _VTK(_Window):
    """VTK's lines and points."""

    def __init__(self, _: str, row: Row, drawn: Any, look: HaloStyle, options: Any, camera: Camera) -> None:
        super().__init__(row, options)
        common = {"color": "black", "lighting": False, "show_scalar_bar": False}
        if isinstance(drawn, HaloLines):
            self.plotter.add_mesh(polydata(drawn), line_width=1, **common)
            # Poly-lines are drawn as pairs of indices, four bytes each; points are three float32.
            self.bytes, self.size = 12 * drawn.n_points + 8 * drawn.n_segments, 1.0
        else:
            self.size = max(1.0, round(look.line_width * scale_of(camera)))
            self.plotter.add_mesh(polydata(drawn), style="points", point_size=self.size, **common)
            self.bytes = (12 + 4) * drawn.n_points
        self.show()

    def facts(self) -> dict[str, Any]:
        return {"gpu_bytes": self.bytes, "pixels_wide": self.size}


class _Plotter(_Window):
    """Halos by this program in a PyVista scene."""

    def __init__(self, _: str, row: Row, drawn: Any, look: HaloStyle, options: Any, __: Camera) -> None:
        super().__init__(row, options)
        lines = isinstance(drawn, HaloLines)
        name, widths = ("add_halo_lines", ("line_width", "strip_width")) if lines else (
            "add_halo_points", ("point_size", "halo_size"))  # fmt: skip
        # Its own defaults, measured already.
        given = dict(zip(widths, (look.line_width, look.strip_width), strict=True))
        given |= {"max_displacement": look.max_displacement, "width_cue": look.width_cue}
        self.actor = getattr(self.plotter, name)(drawn, **given)
        self.show()

    def facts(self) -> dict[str, Any]:
        return _facts(self.actor.explain())


class _Engine:
    """Halos by this program without VTK."""

    def __init__(self, method: str, row: Row, drawn: Any, look: HaloStyle, _: Any, __: Camera) -> None:
        from pvfiblets.engine.halos import HaloDrawStyle, HaloRenderer

        if row.anaglyph:
            raise AbsentError("stereo is VTK's")
        self.ctx = bare_context()
        self.style = HaloDrawStyle(look=look)
        self.renderer = HaloRenderer(self.ctx, drawn, culling=None if method == "engine-unculled" else "two-phase")

    def draw(self, camera: Camera) -> None:
        from pvfiblets.engine import View

        self.gbuffer = self.renderer.render(View(camera.size, camera.model_view_projection), self.style)
        self.ctx.finish()

    def facts(self) -> dict[str, Any]:
        return _facts(self.renderer.explain())

    def darkness(self) -> float:
        """Return the mean of the picture that this G-buffer means, 0 white, 1 black."""
        return float(darkness_of(self.gbuffer).mean())

    def close(self) -> None:
        self.renderer.release()
        self.ctx.release()


def _facts(report: dict[str, Any]) -> dict[str, Any]:
    return {"gpu_bytes": data_bytes(report), "passes": report["passes"], "culling": report.get("culling")}
