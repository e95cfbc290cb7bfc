"""Reading streamlines back from the G-buffer: near a pixel, and in a whole area of the window.

Window pixels are whole numbers at the middles of pixels, counted from the window's lower left corner, as VTK's events
give them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkFloatArray

from pvfiblets.mappers.frames.scene import switch_view
from pvfiblets.mappers.frames.shifted_cameras import with_exact_depths
from pvfiblets.mappers.frames.windows import WindowContext, contexts_with

if TYPE_CHECKING:
    import moderngl
    from vtkmodules.vtkRenderingCore import vtkRenderer

EMPTY = 0xFFFFFFFF
DEPTH_ERROR = 3e-7  # window depth: as much as a depth buffer of 24 bits and the shader's float32 round


@dataclass(frozen=True, eq=False)
class Drawn:
    """The last picture of one renderer."""

    renderer: Any  # the vtkRenderer
    # viewport in pixels of the framebuffer, which supersampling makes larger than the window's
    viewport: tuple[int, int, int, int]
    view: Any  # as given to the engine
    style: Any


@dataclass(frozen=True, eq=False)
class Layer:
    """A mapper whose picture is looked into."""

    mapper: Any
    ids: npt.NDArray[np.int64] | None = None  # which streamlines its own are, where it draws some of another mapper's
    # where it draws spline tubes: the place along its streamline at which each segment begins
    starts: npt.NDArray[np.int64] | None = None


@dataclass(frozen=True, eq=False)
class Hits:
    """Pixels of an area in which streamlines are seen."""

    ids: npt.NDArray[np.int64]  # `(n,)` int64 streamlines
    places: npt.NDArray[np.float64]  # `(n,)` float64: index of the point before, plus the fraction of the segment
    depths: npt.NDArray[np.float64]  # `(n,)` float64 window depths
    pixels: npt.NDArray[np.float64]  # `(n, 2)` float64 window pixels; fractions where the picture is supersampled
    distances: npt.NDArray[np.float64]  # `(n,)` float64 window pixels from the area; 0 within
    values: npt.NDArray[np.float64]  # `(n,)` float64: the per-point value that is drawn; NaN where none is


@dataclass(frozen=True, eq=False)
class Shown:
    """A mapper's last picture for a renderer."""

    context: WindowContext
    slot: Any
    drawn: Drawn
    renderer: Any

    @property
    def enlarged(self) -> npt.NDArray[np.float64]:
        """(2,) pixels of the G-buffer for a pixel of the window."""
        enlarged: npt.NDArray[np.float64] = np.divide(self.drawn.viewport[2:], self.renderer.GetSize())
        return enlarged

    def to_viewport(self, pixels: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Window pixels in units of the G-buffer's, whose first has its middle at (0.5, 0.5)."""
        moved: npt.NDArray[np.float64] = (np.asarray(pixels) - self.renderer.GetOrigin() + 0.5) * self.enlarged
        return moved

    def to_window(self, places: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Undo :meth:`to_viewport`."""
        moved: npt.NDArray[np.float64] = np.asarray(places) / self.enlarged + self.renderer.GetOrigin() - 0.5
        return moved

    def read(self, names: Sequence[str], area: tuple[int, int, int, int]) -> dict[str, npt.NDArray[Any]]:
        """Return textures of the G-buffer by their names, as (height, width, components) of a rectangle."""
        self.context.window.MakeCurrent()
        with self.context.foreign():
            engine, drawn = self.slot.renderer, (self.drawn.view, self.drawn.style)
            switch_view(engine, self.renderer, self.slot.mapper.Get().actor, *drawn)
            buffer = engine.render(*drawn)
            return {name: _texels(self.context.ctx, getattr(buffer, name), area) for name in names}


def shown_by(mapper: Any, renderer: vtkRenderer | None = None) -> Shown | None:
    """Return a mapper's last picture."""
    for context in contexts_with(mapper):
        slot = context.slots[mapper.GetAddressAsString("")]
        latest = next(reversed(slot.drawn), "")
        drawn = slot.drawn.get(latest if renderer is None else renderer.GetAddressAsString(""))
        if drawn is None or slot.renderer is None or not context.alive:
            continue
        found = drawn.renderer.Get()
        if found is not None and min(found.GetSize()) > 0:
            return Shown(context, slot, drawn, found)
    return None


@dataclass(frozen=True, eq=False)
class PixelHit:
    """The G-buffer's contents at the pixel nearest to a place."""

    shown: Shown  # the picture
    pixel: tuple[int, int]  # column and row in the viewport
    key: int  # its depth
    texels: dict[str, npt.NDArray[Any]]  # components of the textures that were read, by their names


def nearest_pixel(
    mapper: Any,
    place: tuple[float, float],
    read: Sequence[str],
    *,
    renderer: vtkRenderer | None = None,
    tolerance: int = 0,
) -> PixelHit | None:
    """Return the pixel nearest to a place that shows something."""
    # Of several as near the one in front is taken. The G-buffer is drawn again if it shows another view by now.
    shown = shown_by(mapper, renderer)
    if shown is None or tolerance < 0:
        return None
    column, row = (int(at) for at in np.floor(shown.to_viewport(place)))
    reach = int(tolerance * shown.enlarged.max())
    width, height = shown.drawn.viewport[2:]
    left, lower = max(column - reach, 0), max(row - reach, 0)
    area = (left, lower, min(column + reach + 1, width) - left, min(row + reach + 1, height) - lower)
    if min(area[2:]) < 1:
        return None
    texels = shown.read(("depth", *read), area)
    keys = texels["depth"][..., 0]
    there = keys != EMPTY
    if "owner" in texels:
        there &= texels["owner"][..., 0] != EMPTY
    rows, columns = np.nonzero(there)
    distance = (rows + lower - row) ** 2 + (columns + left - column) ** 2
    if not len(rows) or distance.min() > reach * reach:
        return None
    best = np.lexsort((keys[rows, columns], distance))[0]
    at = rows[best], columns[best]
    pixel = int(columns[best]) + left, int(rows[best]) + lower
    return PixelHit(shown, pixel, int(keys[at]), {name: texels[name][at] for name in read})


def pick_area(
    layers: Sequence[Layer], polygon: npt.ArrayLike, *, renderer: vtkRenderer | None = None, tolerance: float = 0.0
) -> Hits | None:
    """Return the visible objects in an area of the window, pixel by pixel."""
    # Pixels in which something else is nearer, by VTK's depth of the last frame, are left out: opaque actors do hide
    # streamlines. What is translucent leaves no depth and hides nothing. Under supersampling a pixel of the window
    # counts as a whole.
    from pvfiblets.query.selection.screen import area_distances

    pictures = [(shown_by(layer.mapper, renderer), layer) for layer in layers]
    seen = [(shown, layer) for shown, layer in pictures if shown is not None]
    if not seen:
        return None
    first = seen[0][0]
    corners = first.to_viewport(np.asarray(polygon, np.float64))
    width, height = first.drawn.viewport[2:]
    reach = tolerance * first.enlarged
    low = np.clip(np.floor(corners.min(axis=0) - reach), 0, (width, height)).astype(int)
    high = np.clip(np.ceil(corners.max(axis=0) + reach), 0, (width, height)).astype(int)
    box = (int(low[0]), int(low[1]), int(high[0] - low[0]), int(high[1] - low[1]))
    if box[2] < 1 or box[3] < 1:
        return _hits(first, np.zeros((0, 2)), np.zeros((0, 5)))
    raster = _nearest(seen, box)
    rows, columns = np.nonzero(raster[..., 1] < 1.5)
    values = raster[rows, columns]
    pixels = first.to_window(np.column_stack([columns + box[0], rows + box[1]]) + 0.5)
    values[:, 4] = area_distances(polygon, pixels)
    kept = values[:, 4] <= tolerance
    kept[kept] = ~_hidden(first, pixels, values[:, 1])[kept]
    return _hits(first, pixels[kept], values[kept])


def _hits(shown: Shown, pixels: Any, rows: Any) -> Hits:
    ids, depths, places, values, distances = rows.T
    if shown.drawn.style.values is None:
        values = np.full(len(values), np.nan)
    return Hits(ids.astype(np.int64), places, depths, pixels, distances, values)


def _nearest(seen: Sequence[tuple[Shown, Layer]], box: tuple[int, int, int, int]) -> npt.NDArray[np.float64]:
    """(height, width, 5): streamline, depth (2 where empty), place, value, and room for a distance."""
    raster = np.zeros((box[3], box[2], 5))
    raster[..., 1] = 2.0
    size = seen[0][0].drawn.viewport
    for shown, layer in seen:
        if shown.drawn.viewport != size:
            continue  # drawn at another time, when the window had another size
        names = ["depth", "ids", "position", *(["owner"] if layer.starts is not None else [])]
        texels = shown.read(names, box)
        key, ids = texels["depth"][..., 0], texels["ids"][..., 0].astype(np.int64)
        position = texels["position"].astype(np.float64)
        if layer.starts is not None:
            segment = texels["owner"][..., 0]
            position[key != EMPTY, 0] += layer.starts[segment[key != EMPTY]]
        depth = np.where(key == EMPTY, 3.0, key / float(EMPTY))
        nearer = depth <= raster[..., 1]
        own = ids[nearer]
        raster[nearer, 0] = own if layer.ids is None else layer.ids[own]
        raster[nearer, 1] = depth[nearer]
        raster[nearer, 2:4] = position[nearer]
    return raster


def _hidden(shown: Shown, pixels: npt.NDArray[np.float64], depths: npt.NDArray[np.float64]) -> npt.NDArray[np.bool_]:
    """(n,) bool: pixels in which VTK's last frame shows something nearer than the fiblets."""
    window = with_exact_depths(shown.context.window)
    at = np.floor(pixels + 0.5).astype(np.int64)
    nothing: npt.NDArray[np.bool_] = np.zeros(len(at), np.bool_)
    if not len(at):
        return nothing
    width, height = window.GetSize()
    low, high = at.min(axis=0), at.max(axis=0)
    if low.min() < 0 or high[0] >= width or high[1] >= height:
        return nothing
    values = vtkFloatArray()
    window.GetZbufferData(int(low[0]), int(low[1]), int(high[0]), int(high[1]), values)
    columns, rows = high - low + 1
    if values.GetNumberOfTuples() * values.GetNumberOfComponents() != columns * rows:
        return nothing
    front = vtk_to_numpy(values).reshape(rows, columns).astype(np.float64)
    nearest = np.full((rows, columns), 2.0)
    column, row = (at - low).T
    np.minimum.at(nearest, (row, column), depths)
    if not np.allclose(shown.enlarged, 1.0):
        # The depth of a supersampled picture is one sample's, or several samples' mean.
        padded = np.pad(nearest, 1, constant_values=2.0)
        nearest = np.min([padded[y : y + rows, x : x + columns] for y in range(3) for x in range(3)], axis=0)
    hidden: npt.NDArray[np.bool_] = (front < nearest - DEPTH_ERROR)[row, column]
    return hidden


def _texels(ctx: moderngl.Context, texture: Any, area: tuple[int, int, int, int]) -> npt.NDArray[Any]:
    """Read a rectangle of a texture of integers or floats as (height, width, components)."""
    framebuffer = ctx.framebuffer([texture])
    try:
        data = framebuffer.read(viewport=area, components=texture.components, dtype=texture.dtype, alignment=1)
    finally:
        framebuffer.release()
    return np.frombuffer(data, texture.dtype).reshape(area[3], area[2], texture.components)
