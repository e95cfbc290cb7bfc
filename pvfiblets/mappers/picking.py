"""Reading streamlines back from the G-buffer: near a pixel, and in a whole area of the window.

Window pixels are whole numbers at the middles of pixels, counted from the window's lower left corner, as VTK's events
give them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkFloatArray

from pvfiblets.mappers.windows import WindowContext, contexts_with

EMPTY = 0xFFFFFFFF
DEPTH_ERROR = 3e-7
"""Window depth: as much as a depth buffer of 24 bits and the shader's float32 round."""


@dataclass(frozen=True, eq=False)
class Drawn:
    """What was last drawn for one renderer.

    Attributes
    ----------
    renderer : vtkWeakReference
        The vtkRenderer.
    viewport : tuple of 4 ints
        Viewport in pixels of the framebuffer, which supersampling makes larger than the window's.
    view, style : Any
        As given to the engine.
    """

    renderer: Any
    viewport: tuple[int, int, int, int]
    view: Any
    style: Any


def pick(
    ctx: Any, engine: Any, drawn: Drawn, pixel: tuple[float, float], tolerance: int, what: str = "ids"
) -> tuple[int, float] | None:
    """Return (number, position along it) near a pixel of the window, or None.

    The number is a streamline's, or with ``'owner'`` for `what` that of the part of it that the pixel belongs to. Of
    several lines within `tolerance` pixels the nearest on the screen wins, and of those as near
    the one in front. The G-buffer is drawn again if it shows another view by now.
    """
    renderer = drawn.renderer.Get()
    if renderer is None:
        return None
    (left, bottom), size = renderer.GetOrigin(), renderer.GetSize()
    width, height = drawn.viewport[2:]
    if min(size) < 1 or tolerance < 0:
        return None
    column = int((pixel[0] - left + 0.5) * width / size[0])
    row = int((pixel[1] - bottom + 0.5) * height / size[1])
    reach = int(tolerance * max(width / size[0], height / size[1]))
    x0, x1 = max(column - reach, 0), min(column + reach + 1, width)
    y0, y1 = max(row - reach, 0), min(row + reach + 1, height)
    if x0 >= x1 or y0 >= y1:
        return None
    buffer = engine.render(drawn.view, drawn.style)
    region = (x0, y0, x1 - x0, y1 - y0)
    depth = _read(ctx, buffer.depth, region, "u4", 1)[..., 0].astype(np.int64)
    rows, columns = np.nonzero(depth != EMPTY)
    if len(rows) == 0:
        return None
    distance = (rows + y0 - row) ** 2 + (columns + x0 - column) ** 2
    nearest = np.lexsort((depth[rows, columns], distance))[0]
    if distance[nearest] > reach * reach:
        return None
    at = rows[nearest], columns[nearest]
    numbers = _read(ctx, getattr(buffer, what), region, "u4", {"ids": 2, "owner": 1}[what])
    position = _read(ctx, buffer.position, region, "f4", 2)
    return int(numbers[(*at, 0)]), float(position[(*at, 0)])


@dataclass(frozen=True, eq=False)
class Layer:
    """A mapper whose picture is looked into.

    Attributes
    ----------
    mapper : FibletMapper
    ids : numpy.ndarray or None
        Which streamlines its own are, where it draws some of another mapper's.
    starts : numpy.ndarray or None
        Where it draws spline tubes: the place along its streamline at which each segment begins.
    """

    mapper: Any
    ids: npt.NDArray[np.int64] | None = None
    starts: npt.NDArray[np.int64] | None = None


@dataclass(frozen=True, eq=False)
class Hits:
    """Pixels of an area in which streamlines are seen.

    Attributes
    ----------
    ids : numpy.ndarray
        ``(n,)`` int64 streamlines.
    places : numpy.ndarray
        ``(n,)`` float64: index of the point before, plus the fraction of the segment.
    depths : numpy.ndarray
        ``(n,)`` float64 window depths.
    pixels : numpy.ndarray
        ``(n, 2)`` float64 window pixels; fractions where the picture is supersampled.
    distances : numpy.ndarray
        ``(n,)`` float64 window pixels from the area; 0 within.
    values : numpy.ndarray
        ``(n,)`` float64: the per-point value that is drawn; NaN where none is.
    """

    ids: npt.NDArray[np.int64]
    places: npt.NDArray[np.float64]
    depths: npt.NDArray[np.float64]
    pixels: npt.NDArray[np.float64]
    distances: npt.NDArray[np.float64]
    values: npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Shown:
    """A mapper's last picture for a renderer.

    Attributes
    ----------
    context : WindowContext
    slot : Slot
    drawn : Drawn
    renderer : vtkRenderer
    """

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


def shown_by(mapper: Any, renderer: Any = None) -> Shown | None:
    """Return a mapper's last picture.

    Parameters
    ----------
    mapper : FibletMapper
    renderer : vtkRenderer, optional
        The one that was drawn last by default.

    Returns
    -------
    Shown or None
        None where nothing was drawn, or can be drawn any more.
    """
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


def pick_area(
    layers: Sequence[Layer], polygon: npt.ArrayLike, *, renderer: Any = None, tolerance: float = 0.0
) -> Hits | None:
    """Return what is seen in an area of the window, pixel by pixel.

    Parameters
    ----------
    layers : sequence of Layer
        Mappers that are looked into together: where several drew a pixel the nearest counts, of equals the last.
    polygon : array_like
        ``(k, 2)`` corners in window pixels; inside is by the even-odd rule. One corner is a point, two are a line.
    renderer : vtkRenderer, optional
        Whose picture; by default the one that was drawn last.
    tolerance : float
        Window pixels that a pixel's middle may be away from the area.

    Returns
    -------
    Hits or None
        None where nothing has been drawn yet.

    Notes
    -----
    Pixels in which something else is nearer, by VTK's depth of the last frame, are left out: opaque actors do hide
    streamlines. What is translucent leaves no depth and hides nothing. Under supersampling a pixel of the window
    counts as a whole.
    """
    from pvfiblets.query.screen import area_distances

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
        ctx = shown.context.ctx
        shown.context.window.MakeCurrent()
        with shown.context.foreign():
            buffer = shown.slot.renderer.render(shown.drawn.view, shown.drawn.style)
            key = _read(ctx, buffer.depth, box, "u4", 1)[..., 0]
            ids = _read(ctx, buffer.ids, box, "u4", 2)[..., 0].astype(np.int64)
            position = _read(ctx, buffer.position, box, "f4", 2).astype(np.float64)
            if layer.starts is not None:
                segment = _read(ctx, buffer.owner, box, "u4", 1)[..., 0]
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
    window = shown.context.window
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


def _read(ctx: Any, texture: Any, region: tuple[int, int, int, int], dtype: str, components: int) -> Any:
    """Read a rectangle of a texture as (height, width, components)."""
    framebuffer = ctx.framebuffer([texture])
    try:
        data = framebuffer.read(viewport=region, components=components, dtype=dtype, alignment=1)
    finally:
        framebuffer.release()
    return np.frombuffer(data, dtype=dtype).reshape(region[3], region[2], components)
