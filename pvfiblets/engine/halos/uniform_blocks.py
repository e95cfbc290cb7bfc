"""Uniform blocks of lines and points with halos: the camera's, and their own.

``shaders/halos/block.glsl`` says what the symbols are.
"""

from __future__ import annotations

import moderngl
import numpy as np
import numpy.typing as npt

from ...halos.style import DISPLACEMENTS, TABLE_SIZE, HaloStyle
from ...support.value_reference import relative
from ..clipping import CLIP_PLANES_BLOCK, clip_planes_block
from ..frame import FRAME_BLOCK, frame_block, local_frame
from ..gl.block_buffers import BlockBuffers
from ..gl.uniform_struct import Field, UniformStruct
from ..lattice import TOP
from ..view import Style, View
from .vertices import MOST

BESIDE = 3.0  # half pictures from the middle, beyond which an axis is cut off

ITEM_SHIFT = 3  # items are listed by eights: to look at each would cost more than it spares, and four bytes a vertex

CONSTANTS = {"item_shift": ITEM_SHIFT, "beside": BESIDE}  # of the shaders

_KINDS = {name: number for number, name in enumerate(DISPLACEMENTS)}
_TABLE = len(DISPLACEMENTS)

HALOS_BLOCK = UniformStruct(
    "Halos",
    Field("halo_line_reach", "float", "reach of w_line / 2"),
    Field("halo_border_reach", "float", "reach of (w_strip - w_line) / 2, the halo on either side of a line"),
    Field("halo_least_half_width", "float", "pixels of half the least width that a line is drawn with"),
    Field("halo_own_least_half_width", "float", "the same between its edges, at most that value"),
    Field("halo_place_scale", "float", "mm per integer of a place"),
    Field("halo_displacement", "float", "d_max"),
    Field("halo_depth_per_mm", "float", "1 - depth falls by this per mm, and"),
    Field("halo_depth_swing", "float", "by this / (W (W + halo_w_per_mm mm)) per mm"),
    Field("halo_w_per_mm", "float", "change of W along the view"),
    Field("halo_cue", "vec4", "a line is narrower at p by this share: its dot product with (p, 1)"),
    Field("halo_filter_low", "float", "least number that is seen"),
    Field("halo_filter_high", "float", "greatest number that is seen"),
    Field("halo_filter_taper", "float", "mm over which lines narrow to where a threshold cuts them"),
    Field("halo_cue_most", "float", "the largest share of halo_cue"),
    Field("half_picture", "vec2", "half the picture's width and height in pixels"),
    Field("halo_smooth", "int", "1 where lines have smooth edges"),
    Field("halo_items", "int", "vertices of lines, or points"),
    Field("halo_window_rows", "mat4", "(p, 1) before it is (X, Y, U, W): its columns are rows of the window's matrix"),
    Field("halo_table", f"vec4[{TABLE_SIZE // 4}]", "entries of f, by fours"),
    Field("halo_displacement_kind", "int", "of f: 0 x, 1 x^2, 2 sqrt(x), 3 by halo_table"),
    Field("halo_table_entries", "int", "of halo_table that count"),
)

Array = npt.NDArray[np.float64]


class HaloBlocks(BlockBuffers):
    """The blocks of one set; `origin` and `scale` are those of the points' lattice."""

    def __init__(self, ctx: moderngl.Context, origin: Array, scale: Array, bounds: tuple[float, ...]) -> None:
        super().__init__(ctx)
        self._place = origin, scale, TOP
        low, high = np.array(bounds).reshape(3, 2).T
        self._corners = np.array([np.where(pick, high, low) for pick in np.ndindex(2, 2, 2)])

    def write(
        self, view: View, look: HaloStyle, n_items: int, drawn_width: float, reference: float
    ) -> tuple[bool, bool]:
        """Bring all up to date and bind them."""
        self.put("frame", FRAME_BLOCK, frame_block(view, Style(), *self._place)[0])
        self.put("halos", HALOS_BLOCK, self._block(view, look, n_items, drawn_width, reference))
        planes = clip_planes_block(view, 0.0, *self._place, 0.0)
        return self.put("clip_planes", CLIP_PLANES_BLOCK, planes), self._near_the_view(view)

    def _near_the_view(self, view: View) -> bool:
        x, y, z, w = view.model_view_projection @ np.column_stack([self._corners, np.ones(8)]).T
        inside = (np.abs(z) < w) & (np.maximum(np.abs(x), np.abs(y)) < BESIDE * w)
        return not inside.all()

    def _block(self, view: View, look: HaloStyle, n_items: int, drawn_width: float, reference: float) -> bytes:
        _, to_data, (x, y, z, w) = local_frame(view, *self._place)
        half_size = np.array(view.size) / 2.0
        axis, scale_of_w, perspective = _axis(z, w)
        across = [row[:3] - (row[:3] @ axis) * axis for row in (x, y)]
        pixels = float(np.mean(half_size * np.linalg.norm(across, axis=1)))  # per mm, times W
        # 1 - depth is (W - Z) / 2W: in perspective it changes by W to the power of -1, else it is linear.
        per_mm, swing = 0.0, 0.0
        if perspective:
            bend = 0.5 * float((w[3] - z[3]) - (w[:3] - z[:3]) @ axis / scale_of_w * w[3])
            swing = max(bend, 0.0) * scale_of_w
        else:
            per_mm = float(np.linalg.norm(z[:3])) / 2.0 / abs(w[3] or 1.0)
        low, high = np.clip(relative((look.low, look.high), reference), -MOST, MOST)
        f = look.displacement
        table = np.zeros(TABLE_SIZE)
        if not isinstance(f, str):
            table[: len(f)] = f
        return HALOS_BLOCK.pack(
            halo_line_reach=0.5 * look.line_width * pixels,
            halo_border_reach=0.5 * (look.strip_width - look.line_width) * pixels,
            halo_least_half_width=0.5 * drawn_width,
            halo_own_least_half_width=0.5 * look.min_width,
            halo_place_scale=self._place[1][0],
            halo_displacement=look.max_displacement,
            halo_depth_per_mm=per_mm,
            halo_depth_swing=swing,
            halo_w_per_mm=scale_of_w if perspective else 0.0,
            halo_cue=self._cue(to_data, axis, w, scale_of_w, perspective, look.width_cue),
            halo_filter_low=low,
            halo_filter_high=high,
            halo_filter_taper=look.filter_taper,
            halo_cue_most=look.width_cue,
            half_picture=half_size,
            halo_smooth=bool(look.smooth),
            halo_items=n_items,
            halo_window_rows=np.array([half_size[0] * x, half_size[1] * y, (w - z) / 2.0, w]).T,
            halo_table=table.reshape(-1, 4),
            halo_displacement_kind=_KINDS[f] if isinstance(f, str) else _TABLE,
            halo_table_entries=0 if isinstance(f, str) else len(f),
        )

    def _cue(
        self, to_data: Array, axis: Array, w: Array, scale_of_w: float, perspective: bool, strength: float
    ) -> tuple[float, ...]:
        """Return (a, d): 1 - a . p - d of a place p (local mm) is the share that depth cueing leaves of a width."""
        # How near and far goes by the box of the data; what lies behind the eye counts as beside it.
        local = self._corners - to_data[:3, 3]
        along = local @ axis
        if perspective:
            along = np.maximum(along + w[3] / scale_of_w, 0.0) - w[3] / scale_of_w
        nearest, farthest = float(along.min()), float(along.max())
        if strength == 0.0 or not farthest > nearest:
            return (0.0, 0.0, 0.0, 0.0)
        return (*(strength / (farthest - nearest) * axis), -strength * nearest / (farthest - nearest))


def _axis(z: Array, w: Array) -> tuple[Array, float, bool]:
    """Return the viewing direction (unit, local mm), the change of W along it per mm, and whether there is any."""
    slope = float(np.linalg.norm(w[:3]))
    if slope > 0.0:
        return w[:3] / slope, slope, True
    depth = float(np.linalg.norm(z[:3]))
    return (z[:3] / depth if depth > 0.0 else np.array([0.0, 0.0, 1.0])), 0.0, False
