"""Reading a streamline back from the G-buffer."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

EMPTY = 0xFFFFFFFF


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


def pick(ctx: Any, engine: Any, drawn: Drawn, pixel: tuple[float, float], tolerance: int) -> tuple[int, float] | None:
    """Return (streamline id, position along it) near a pixel of the window, or None.

    Of several lines within `tolerance` pixels the nearest on the screen wins, and of those as near
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
    ids = _read(ctx, buffer.ids, region, "u4", 2)
    position = _read(ctx, buffer.position, region, "f4", 2)
    return int(ids[(*at, 0)]), float(position[(*at, 0)])


def _read(ctx: Any, texture: Any, region: tuple[int, int, int, int], dtype: str, components: int) -> Any:
    """Read a rectangle of a texture as (height, width, components)."""
    framebuffer = ctx.framebuffer([texture])
    try:
        data = framebuffer.read(viewport=region, components=components, dtype=dtype, alignment=1)
    finally:
        framebuffer.release()
    return np.frombuffer(data, dtype=dtype).reshape(region[3], region[2], components)
