"""Glyphs of an image on slices: made for the slices that are shown, when they have moved."""

from __future__ import annotations

import weakref
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt
import pyvista as pv

from pvfiblets.plotting.slices.following import before_render
from pvfiblets.slices import glyphs
from pvfiblets.slices.image import SliceImage
from pvfiblets.slices.vectors import in_scanner_axes

Array = npt.NDArray[np.float64]
Place = Callable[[], "tuple[Array, Array] | None"]
"""Returns a point of a plane and its normal; None where it is not shown."""

MOST_POINTS = 1_500_000
"""Points of a slice's surfaces; the number of glyphs sets the detail of each sphere, from 2,562 points down to 42."""
LINE_PERCENTILE = 99.0  # percentile of the lengths of an image's peaks: it is as long as a voxel
SAMPLED = 200_000
N_COLOURS = 256


class GlyphSet:
    """Glyphs of an image; ``slices.add_glyphs`` makes it. Its properties show with the next render.

    Parameters
    ----------
    image : SliceImage
    kind, size, normalize, line_width, basis, full, tensor, vectors, scalars, length, cmap, clim
        As of ``slices.add_glyphs``; the last four of fixels.
    """

    def __init__(
        self,
        image: SliceImage,
        *,
        kind: str,
        size: float,
        normalize: bool,
        line_width: float,
        basis: str,
        full: bool,
        tensor: str,
        vectors: str | None = None,
        scalars: Any = None,
        length: Any = None,
        cmap: Any = None,
        clim: Any = None,
    ) -> None:
        glyphs.check_glyphs(image, kind, basis, full, tensor)
        if image.fixels is None and not (scalars is None and length is None):
            raise ValueError(f"scalars and length apply to fixels, but {image.name} has {kind}; leave them out")
        self._vectors = glyphs.axes_of_glyphs(kind, tensor, vectors)
        self.image, self.kind = in_scanner_axes(image, self._vectors) if kind == "peaks" else image, kind
        self._basis, self._full, self._tensor = basis, bool(full), tensor
        self._normalize, self._width = bool(normalize), float(line_width)
        self._visible = True
        self._shown: list[_OnPlane] = []
        self._longest: float | None = None
        fixels = image.fixels if kind == "fixels" else None
        self._lengths = None if fixels is None or length is None else fixels.numbers(length)
        self._numbers = None if fixels is None or scalars is None else fixels.numbers(scalars)
        self._table = None if self._numbers is None else _table(self._numbers, cmap, clim)
        self.size = size

    def __repr__(self) -> str:
        return f"<GlyphSet of {self.image.name!r}: {self.kind}>"

    @property
    def size(self) -> float:
        """Size of the greatest glyph, per the smallest side of a voxel."""
        return self._size

    @size.setter
    def size(self, size: float) -> None:
        found = float(size) if isinstance(size, (int, float, np.number)) else np.nan
        if not 0.0 < found < np.inf:
            raise ValueError(f"size is {size!r}; give a number above 0")
        self._size = found
        for one in self._shown:
            one.forget()

    @property
    def visible(self) -> bool:
        """Whether they are shown."""
        return self._visible

    @visible.setter
    def visible(self, visible: bool) -> None:
        self._visible = bool(visible)

    @property
    def n_glyphs(self) -> int:
        """Glyphs on slices now; glyphs of hidden slices have not been made."""
        return sum(one.n for one in self._shown)

    def show_on(self, renderer: pv.Renderer, place: Place) -> None:
        """Show the glyphs on another plane, too."""
        self._shown.append(_OnPlane(self, renderer, place))

    def remove(self) -> None:
        """Remove all glyphs; a second call has no effect."""
        while self._shown:
            self._shown.pop().remove()

    def mesh(self, position: Array, normal: Array) -> tuple[pv.PolyData, int]:
        """Return the glyphs of a plane, with their colours as ``rgb``, and how many there are."""
        image, size = self.image, self._size
        voxels = glyphs.voxels_on_plane(image, position, normal)
        if not len(voxels):
            return pv.PolyData(), 0
        if self.kind in glyphs.LINES:
            found = self._line_glyphs(voxels)
            n = len(found.points)
            lines = np.column_stack([np.full(n, 2), 2 * np.arange(n), 2 * np.arange(n) + 1])
            mesh = pv.PolyData(found.points.reshape(-1, 3), lines=lines)
        else:
            ball = _sphere(len(voxels))
            points = np.asarray(ball.points, np.float64)
            if self.kind == "tensor":
                found = glyphs.ellipsoids(image, voxels, points, size, self._normalize, self._tensor, self._vectors)
            else:
                found = glyphs.lobes(image, voxels, points, size, self._normalize, self._basis, self._full)
            n = len(found.points)
            faces = ball.regular_faces[None] + (len(points) * np.arange(n))[:, None, None]
            mesh = pv.PolyData.from_regular_faces(found.points.reshape(-1, 3), faces.reshape(-1, 3))
        mesh.point_data["rgb"] = found.colours.reshape(-1, 3)
        return mesh, n

    def _line_glyphs(self, voxels: npt.NDArray[np.int64]) -> glyphs.Glyphs:
        """Return lines of peaks, or of fixels in the colours of their numbers."""
        image, size = self.image, self._size
        if self.kind == "peaks":
            return glyphs.lines_of_peaks(image, voxels, size, None if self._normalize else self._long())
        found, fixels = glyphs.lines_of_fixels(image, voxels, size, self._lengths, self._long())
        if self._numbers is None or self._table is None:
            return found
        colours, low, high = self._table
        share = (self._numbers[fixels] - low) / (high - low) * len(colours)
        rows = np.clip(np.nan_to_num(share), 0, len(colours) - 1).astype(np.int64)
        shown = np.where(np.isnan(share)[:, None], np.uint8(128), colours[rows])
        return glyphs.Glyphs(found.points, np.repeat(shown[:, None], 2, axis=1))

    def _long(self) -> float:
        if self._longest is None and self.kind == "fixels":
            self._longest = 1.0 if self._lengths is None else _longest(self._lengths)
        if self._longest is None:
            values = self.image.values.reshape(-1, self.image.n_volumes)
            some = np.asarray(values[:: max(1, len(values) // SAMPLED)], np.float64).reshape(-1, 3)
            self._longest = _longest(np.linalg.norm(some, axis=1))
        return self._longest


def _longest(lengths: npt.NDArray[Any]) -> float:
    """Return the length that is drawn as long as a voxel."""
    there = lengths[np.isfinite(lengths) & (lengths > 0.0)]
    return float(np.percentile(there, LINE_PERCENTILE)) if len(there) else 1.0


def _table(
    numbers: npt.NDArray[np.float32], cmap: Any, clim: Any
) -> tuple[npt.NDArray[np.uint8], float, float]:
    """Return colours ``(n, 3)`` of numbers of fixels, and the numbers of the first and last colour: all by default."""
    finite = numbers[np.isfinite(numbers)]
    given = (finite.min(initial=np.inf), finite.max(initial=-np.inf)) if clim is None else clim
    try:
        low, high = (float(end) for end in given)
    except (TypeError, ValueError):
        raise ValueError(f"clim is {clim!r}; give two numbers, the low one first") from None
    if clim is not None and not (np.isfinite([low, high]).all() and low < high):
        raise ValueError(f"clim is ({low:g}, {high:g}); give two finite numbers, the low one first")
    low, high = (low, high) if low < high else (min(low, 0.0), max(low, 1.0)) if np.isfinite(low) else (0.0, 1.0)
    table = pv.LookupTable(pv.global_theme.cmap if cmap is None else cmap, n_values=N_COLOURS)
    return np.array(table.values, np.uint8).reshape(-1, 4)[:, :3], low, high


def _sphere(n: int) -> pv.PolyData:
    """Return a sphere with the points that a slice of n glyphs affords."""
    level = next((one for one in (4, 3, 2) if n * (10 * 4**one + 2) <= MOST_POINTS), 1)
    return pv.Icosphere(radius=1.0, nsub=level)


class _OnPlane:
    """Glyphs in one renderer."""

    def __init__(self, owner: GlyphSet, renderer: pv.Renderer, place: Place) -> None:
        self._owner = weakref.proxy(owner)
        self._renderer, self._place = renderer, place
        self._state: tuple[Any, ...] | None = None
        self.n = 0
        lines = owner.kind in glyphs.LINES
        self._mesh = pv.PolyData()
        mapper = pv.DataSetMapper(self._mesh)
        mapper.SetScalarModeToUsePointFieldData()
        mapper.SelectColorArray("rgb")
        mapper.SetColorModeToDirectScalars()
        self._actor = pv.Actor(mapper=mapper)
        self._actor.prop.lighting = not lines
        self._actor.prop.line_width = owner._width  # noqa: SLF001
        self._actor.prop.interpolation = "Phong"
        renderer.add_actor(self._actor, reset_camera=False, render=False, pickable=False)
        self._end = before_render(renderer, self.refresh)

    def forget(self) -> None:
        """Make them anew with the next render."""
        self._state = None

    def refresh(self) -> None:
        """Bring them up to date; the renderer is about to draw."""
        place = self._place() if self._owner.visible else None
        self._actor.visibility = place is not None
        if place is None:
            return
        position, normal = place
        state = (round(float(position @ normal), 6), *normal)
        if state == self._state:
            return
        self._state = state
        mesh, self.n = self._owner.mesh(position, normal)
        if self._owner.kind not in glyphs.LINES and mesh.n_points:
            mesh = mesh.compute_normals(cell_normals=False, split_vertices=False, consistent_normals=False)
        self._mesh.copy_from(mesh)

    def remove(self) -> None:
        self._end()
        self._renderer.remove_actor(self._actor, reset_camera=False, render=False)
