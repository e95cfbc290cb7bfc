"""Halos in PyVista windows, beside VTK's plain lines and points."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from pvfiblets.halos import HaloLines, HaloPoints, HaloStyle

from ...cameras import Camera, by_turns
from ...drawing import data_bytes
from ...record import Figure, Record
from ...study import Options
from ...timing import Comparison
from ...window import Window
from ..codec.pixels import lines_of
from .pictures import helices, look_of, orbit

SETS = (
    "shape-small", "fibres-subset", "office", "shape-large", "fibres", "water", "terrain", "water-dense",
)  # fmt: skip
SIZE, QUICK_SIZE = (812, 600), (160, 120)  # the paper's
PLACES, QUICK_PLACES = 6, 1  # all around the data
QUICK_HELICES = 30


class HaloWindow(Window):
    """Lines or points with halos of this program, which look as given."""

    method, ours = "halos", True

    def __init__(self, drawn: HaloLines | HaloPoints, look: HaloStyle, camera: Camera) -> None:
        super().__init__(camera.size, "white")
        lines = isinstance(drawn, HaloLines)
        add = self.plotter.add_halo_lines if lines else self.plotter.add_halo_points
        widths = ("line_width", "strip_width") if lines else ("point_size", "halo_size")
        given = dict(zip(widths, (look.line_width, look.strip_width), strict=True))
        self._actor = add(drawn, max_displacement=look.max_displacement, width_cue=look.width_cue, **given)
        self.show()

    @property
    def nbytes(self) -> int:
        """Bytes on the GPU that grow with the data."""
        return data_bytes(self._actor.explain())


class PlainWindow(Window):
    """VTK's lines, one pixel wide, or its points, of the size of points with halos in the middle of the frame."""

    method, ours = "VTK, plain", False

    def __init__(self, drawn: HaloLines | HaloPoints, look: HaloStyle, camera: Camera) -> None:
        super().__init__(camera.size, "white")
        import pyvista as pv

        common = {"color": "black", "lighting": False, "show_scalar_bar": False}
        if isinstance(drawn, HaloLines):
            self.plotter.add_mesh(lines_of(pv, drawn.points, np.asarray(drawn.offsets)), line_width=1, **common)
            # Polylines are drawn as pairs of indices, four bytes each; points are three float32.
            self.nbytes = 12 * drawn.n_points + 8 * drawn.n_segments
        else:
            pixels = look.line_width * camera.pixels / float(np.linalg.norm(camera.eye - camera.centre))
            mesh = pv.PolyData(drawn.points)
            self.plotter.add_mesh(mesh, style="points", point_size=max(1.0, round(pixels)), **common)
            self.nbytes = (12 + 4) * drawn.n_points
        self.show()


def beside_plain(options: Options) -> Iterator[Record]:
    """Yield times and bytes of the paper's sets, with halos and plain."""
    from pvfiblets.synthetic.halos import halo_set

    for name in ("helices",) if options.quick else SETS:
        if not options.allows(f"{name}, in a window"):
            continue
        drawn = helices(QUICK_HELICES) if options.quick else halo_set(name, options.seed)
        yield from _measured(f"{name}, {drawn.n_points:,} vertices, in a window", drawn, options)


def _measured(data: str, drawn: Any, options: Options) -> Iterator[Record]:
    places, size = (QUICK_PLACES, QUICK_SIZE) if options.quick else (PLACES, SIZE)
    cameras = [place[0] for place in orbit(drawn, places, 1, size)]
    look = look_of(drawn)
    made: list[HaloWindow | PlainWindow] = []
    try:
        for kind in (HaloWindow, PlainWindow):
            made.append(kind(drawn, look, cameras[0]))
            for camera in cameras:  # compiles programs and makes everything that is made once
                made[-1].draw(camera)
        compared = Comparison(data, options, made[0].turns, len(cameras))
        for window in made:
            record = Record(
                data=data,
                group="",
                approximation="pictures with halos",
                method=window.method,
                setting="",
                errors={},
                costs={"memory": Figure(window.nbytes / drawn.n_points, "bytes/point")},
                ours=window.ours,
                default=window.ours,
            )
            compared.add(record, draw=by_turns(window.draw, cameras))
        yield from compared.finish()
    finally:
        for window in made:
            window.release()
