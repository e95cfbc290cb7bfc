"""The methods of drawing spline tubes in a PyVista window: this program's, and VTK's meshes and lines."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from pvfiblets.tubes import SplineTubes, curves

from ...cameras import Camera
from ...drawing import data_bytes
from ...window import Window
from .drawings import Drawing, VisibleDepths

MESHES = ((6, 1), (12, 1), (30, 1), (12, 4), (30, 4))  # sides, samples of each segment
MOST_CORNERS = 12_000_000  # of a mesh: VTK holds 115 bytes of each


class _TubeWindow(Window):
    """A window of tubes in one colour with a lamp at the eye."""

    ours, default = False, False

    def __init__(self, size: tuple[int, int]) -> None:
        super().__init__(size, headlight=True)

    def visible(self, _: Camera) -> VisibleDepths:
        """Return what the frame's depths mean, with the planes that VTK drew it by."""
        near, far = self.plotter.camera.clipping_range
        depth = self.depths().astype(np.float64).ravel()
        return far * near / (far - depth * (far - near)), depth < 1.0


class WindowTubes(_TubeWindow):
    """`plotter.add_spline_tubes`, of tubes that are not widened."""

    method, setting, ours = "ray cast", "in a window", True

    def __init__(self, tubes: SplineTubes, size: tuple[int, int]) -> None:
        super().__init__(size)
        actor = self.plotter.add_spline_tubes(tubes, color="steelblue", min_width=0.0)
        self.show()
        self.nbytes = data_bytes(actor.explain())


class FilteredTubes(_TubeWindow):
    """VTK's tube filter around polylines, with flat caps."""

    method = "VTK's tube filter"

    def __init__(self, tubes: SplineTubes, size: tuple[int, int], sides: int, samples: int) -> None:
        super().__init__(size)
        self.setting = f"{sides} sides" + (f", {samples} samples a segment" if samples > 1 else "")
        mesh = polylines(tubes, samples).tube(scalars="radius", absolute=True, n_sides=sides)
        triangles = int((np.diff(np.asarray(mesh.GetStrips().GetOffsetsArray())) - 2).sum())
        self.nbytes = 24 * mesh.n_points + 12 * triangles  # positions and normals in float32, and indices
        actor = self.plotter.add_mesh(mesh, color="steelblue", show_scalar_bar=False)
        actor.prop.interpolation = "Phong"
        actor.mapper.scalar_visibility = False
        self.show()


class ShadedLines(_TubeWindow):
    """VTK's lines shaded as tubes, as wide as the mean radius is in the middle of the frame."""

    method, setting = "VTK's lines as tubes", ""

    def __init__(self, tubes: SplineTubes, size: tuple[int, int]) -> None:
        super().__init__(size)
        self._radius = float(tubes.radius[tubes.segments].mean())
        mesh = polylines(tubes)
        self.nbytes = 12 * mesh.n_points + 8 * (mesh.n_points - mesh.n_lines)
        self._actor = self.plotter.add_mesh(mesh, color="steelblue", render_lines_as_tubes=True)
        self._actor.mapper.scalar_visibility = False
        self.show()

    def draw(self, camera: Camera) -> None:
        """Draw lines of the width that fits the camera."""
        distance = float(np.linalg.norm(camera.eye - camera.centre))
        self._actor.prop.line_width = max(1.0, 2.0 * self._radius * camera.pixels / distance)
        super().draw(camera)


def window_drawings(tubes: SplineTubes, size: tuple[int, int]) -> list[Callable[[], Drawing]]:
    """Return what makes each method, this program's first, without meshes that would take gigabytes."""

    def meshed(sides: int, samples: int) -> Callable[[], Drawing]:
        return lambda: FilteredTubes(tubes, size, sides, samples)

    fitting = [mesh for mesh in MESHES if mesh[0] * (tubes.n_segments * mesh[1] + tubes.n_tubes) <= MOST_CORNERS]
    return [lambda: WindowTubes(tubes, size), lambda: ShadedLines(tubes, size), *(meshed(*mesh) for mesh in fitting)]


def polylines(tubes: SplineTubes, samples: int = 1) -> Any:
    """Return the axes as polylines with the array ``radius``: through the nodes, or more samples of each segment."""
    import pyvista as pv

    ends = tubes.segments
    starts = np.ones(len(ends), bool)
    starts[1:] = (ends[1:, 0] != ends[:-1, 1]) | (tubes.tubes[1:] != tubes.tubes[:-1])
    first = np.flatnonzero(starts)
    counts = np.diff([*first, len(ends)]) * samples + 1
    offsets = np.cumsum([0, *counts])
    rows = np.empty((offsets[-1], 4))
    last = np.zeros(offsets[-1], bool)
    last[offsets[1:] - 1] = True
    halves = curves.controls(tubes)
    pieces = [curves.evaluate(halves[:, int(at)], np.array(at % 1.0)) for at in 2.0 * np.arange(samples) / samples]
    rows[~last] = np.stack(pieces, axis=1).reshape(-1, 4)
    rows[last] = curves.evaluate(halves[np.append(first[1:], len(ends)) - 1, 1], np.array(1.0))
    mesh = pv.PolyData(rows[:, :3], lines=np.insert(np.arange(len(rows)), offsets[:-1], counts))
    mesh["radius"] = rows[:, 3]
    return mesh
