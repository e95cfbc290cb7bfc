"""Uniform blocks of lines and points with halos: the camera's, and their own (``shaders/halos/block.glsl``)."""

from __future__ import annotations

from typing import Any

import moderngl
import numpy as np
import numpy.typing as npt

from ...halos.style import DISPLACEMENTS, TABLE_SIZE, HaloStyle
from ..bindings import BLOCKS
from ..clipping import BLOCK_BYTES, clip_planes_block
from ..frame import FRAME_BYTES, frame_block, local_frame
from ..lattice import TOP
from ..view import Style, View
from .vertices import MOST

__all__ = ["CONSTANTS", "HALOS_BYTES", "ITEM_SHIFT", "HaloBlocks"]

BESIDE = 3.0
"""Half pictures from the middle, beyond which an axis is cut off."""

ITEM_SHIFT = 3
"""Items are listed by eights: to look at each would cost more than it spares, and four bytes a vertex."""

CONSTANTS = {"max_clip_planes": 8, "displacement_words": TABLE_SIZE // 4, "item_shift": ITEM_SHIFT, "beside": BESIDE}
"""Of the shaders."""

_KINDS = {name: number for number, name in enumerate(DISPLACEMENTS)}
_TABLE = len(DISPLACEMENTS)
_LAYOUT: list[Any] = [
    ("widths", "<f4", 4),
    ("depth", "<f4", 4),
    ("cue", "<f4", 4),
    ("filter", "<f4", 4),
    ("mask", "<f4", 4),
    ("counts", "<i4", 4),
    ("rows", "<f4", (4, 4)),
    ("table", "<f4", TABLE_SIZE),
]
HALOS_BYTES = np.dtype(_LAYOUT).itemsize

Array = npt.NDArray[np.float64]


class HaloBlocks:
    """The blocks of one set.

    Parameters
    ----------
    ctx : moderngl.Context
    origin, scale : numpy.ndarray
        (3,) float64, of the points' lattice.
    bounds : sequence of float
        Of the points, (xmin, xmax, ymin, ymax, zmin, zmax) mm.

    Attributes
    ----------
    buffers : dict of str to moderngl.Buffer
    """

    def __init__(self, ctx: moderngl.Context, origin: Array, scale: Array, bounds: tuple[float, ...]) -> None:
        self._ctx, self._place = ctx, (origin, scale, TOP)
        low, high = np.array(bounds).reshape(3, 2).T
        self._corners = np.array([np.where(pick, high, low) for pick in np.ndindex(2, 2, 2)])
        self.buffers: dict[str, moderngl.Buffer] = {}

    def write(self, view: View, look: HaloStyle, n_items: int) -> tuple[bool, bool]:
        """Bring all up to date and bind them.

        Returns
        -------
        planes : bool
            Whether a clip plane may touch anything.
        beside : bool
            Whether anything may lie before the near plane, beyond the far one or far beside the picture.
        """
        self._put("frame", "Frame", FRAME_BYTES, frame_block(view, Style(), *self._place)[0])
        self._put("halos", "Halos", HALOS_BYTES, self._block(view, look, n_items))
        planes = clip_planes_block(view, 1.0, *self._place, 0.0)
        if planes is not None:
            self._put("clip_planes", "ClipPlanes", BLOCK_BYTES, planes)
        elif "clip_planes" in self.buffers:
            self.buffers.pop("clip_planes").release()
        return planes is not None, self._beside(view)

    def _beside(self, view: View) -> bool:
        x, y, z, w = view.model_view_projection @ np.column_stack([self._corners, np.ones(8)]).T
        inside = (np.abs(z) < w) & (np.maximum(np.abs(x), np.abs(y)) < BESIDE * w)
        return not inside.all()

    def _block(self, view: View, look: HaloStyle, n_items: int) -> bytes:
        _, to_data, (x, y, z, w) = local_frame(view, *self._place)
        half_size = np.array(view.size) / 2.0
        axis, scale_of_w, perspective = _axis(z, w)
        across = [row[:3] - (row[:3] @ axis) * axis for row in (x, y)]
        pixels = float(np.mean(half_size * np.linalg.norm(across, axis=1)))  # per mm, times W
        block = np.zeros((), _LAYOUT)
        block["widths"] = (
            0.5 * look.line_width * pixels,
            0.5 * (look.strip_width - look.line_width) * pixels,
            0.5 * look.min_width,
            self._place[1][0],
        )
        # 1 - depth is (W - Z) / 2W: in perspective it changes by W to the power of -1, else it is linear.
        if perspective:
            swing = 0.5 * float((w[3] - z[3]) - (w[:3] - z[:3]) @ axis / scale_of_w * w[3])
            block["depth"] = look.max_displacement, 0.0, max(swing, 0.0) * scale_of_w, scale_of_w
        else:
            block["depth"] = look.max_displacement, float(np.linalg.norm(z[:3])) / 2.0 / abs(w[3] or 1.0), 0.0, 0.0
        block["cue"] = self._cue(to_data, axis, w, scale_of_w, perspective, look.width_cue)
        block["filter"] = *np.clip((look.low, look.high), -MOST, MOST), look.filter_taper, float(look.smooth)
        block["mask"] = 0.0, *half_size, look.width_cue
        table = look.displacement
        named = isinstance(table, str)
        block["counts"] = n_items, _KINDS[table] if isinstance(table, str) else _TABLE, 0 if named else len(table), 0
        block["rows"] = np.array([half_size[0] * x, half_size[1] * y, (w - z) / 2.0, w])
        if not isinstance(table, str):
            block["table"][: len(table)] = table
        return block.tobytes()

    def _cue(
        self, to_data: Array, axis: Array, w: Array, scale_of_w: float, perspective: bool, strength: float
    ) -> tuple[float, ...]:
        """Return (a, d): 1 - a . p - d of a place p (local mm) is the share that depth cueing leaves of a width.

        How near and far goes by the box of the data; what lies behind the eye counts as beside it.
        """
        local = self._corners - to_data[:3, 3]
        along = local @ axis
        if perspective:
            along = np.maximum(along + w[3] / scale_of_w, 0.0) - w[3] / scale_of_w
        nearest, farthest = float(along.min()), float(along.max())
        if strength == 0.0 or not farthest > nearest:
            return (0.0, 0.0, 0.0, 0.0)
        return (*(strength / (farthest - nearest) * axis), -strength * nearest / (farthest - nearest))

    def _put(self, name: str, block: str, size: int, data: bytes) -> None:
        if name not in self.buffers:
            self.buffers[name] = self._ctx.buffer(reserve=size)
        self.buffers[name].write(data)
        self.buffers[name].bind_to_uniform_block(BLOCKS[block])

    def release(self) -> None:
        """Give the buffers back; twice is harmless."""
        for buffer in self.buffers.values():
            buffer.release()
        self.buffers.clear()


def _axis(z: Array, w: Array) -> tuple[Array, float, bool]:
    """Return the viewing direction (unit, local mm), the change of W along it per mm, and whether there is any."""
    slope = float(np.linalg.norm(w[:3]))
    if slope > 0.0:
        return w[:3] / slope, slope, True
    depth = float(np.linalg.norm(z[:3]))
    return (z[:3] / depth if depth > 0.0 else np.array([0.0, 0.0, 1.0])), 0.0, False
