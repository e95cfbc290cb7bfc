"""Uniform blocks of spline tubes: the camera's, shared with fiblets, and their own.

``shaders/tubes/block.glsl`` says what the symbols are.
"""

from __future__ import annotations

import moderngl
import numpy as np
import numpy.typing as npt

from ..clipping import CLIP_PLANES_BLOCK, clip_planes_block
from ..fiblets.line_tubes import TUBES_BLOCK, tubes_block
from ..frame import FRAME_BLOCK, frame_block, local_frame
from ..gl.block_buffers import BlockBuffers
from ..gl.uniform_struct import Field, UniformStruct
from ..view import Style, View

SPLINES_BLOCK = UniformStruct(
    "Splines",
    Field("tube_place_scale", "float", "mm per integer of a place"),
    Field("tube_control_share", "float", "c"),
    Field("tube_least_over_w", "float", "mm, over W, of half the least width that a tube is drawn with"),
    Field("tube_own_least_over_w", "float", "the same between its edges, at most that value"),
    Field("tube_by_length", "int", "1 where derivatives are by length, 0 where by a segment's parameter"),
    Field("tube_search_steps", "int", "of a root search"),
    Field("tube_segments", "int", "of all tubes"),
    Field("tube_window_rows", "vec4[8]", "from (local mm, 1) to X, Y, W and U, each as float32 and what that leaves"),
)
Array = npt.NDArray[np.float64]


class TubeBlocks(BlockBuffers):
    """The blocks of one set: `place` is origin, scale and largest integer of the nodes' lattice."""

    def __init__(self, ctx: moderngl.Context, place: tuple[Array, Array, int], scaled: bool) -> None:
        super().__init__(ctx)
        self._place, self._scaled = place, scaled

    def write(
        self,
        view: View,
        *,
        reach: float,
        middle: float,
        min_width: float,
        drawn_width: float,
        iterations: int,
        n_segments: int,
    ) -> bool:
        """Bring all up to date and bind them; say whether a clip plane may touch anything."""
        tubes = tubes_block(view, 1.0, *self._place)
        rays = np.frombuffer(tubes, TUBES_BLOCK.dtype)[0]
        pixel = max(np.linalg.norm(rays[axis].astype(np.float64)) for axis in ("tube_ray_x", "tube_ray_y"))
        splines = SPLINES_BLOCK.pack(
            tube_place_scale=self._place[1][0],
            tube_control_share=middle,
            tube_least_over_w=0.5 * drawn_width * pixel,
            tube_own_least_over_w=0.5 * min_width * pixel,
            tube_by_length=self._scaled,
            tube_search_steps=iterations,
            tube_segments=n_segments,
            tube_window_rows=self._rows(view),
        )
        self.put("frame", FRAME_BLOCK, frame_block(view, Style(), *self._place)[0])
        self.put("tubes", TUBES_BLOCK, tubes)
        self.put("splines", SPLINES_BLOCK, splines)
        return self.put("clip_planes", CLIP_PLANES_BLOCK, clip_planes_block(view, 0.0, *self._place, reach))

    def _rows(self, view: View) -> Array:
        """(8, 4): from local mm to X, Y, W of the window and to W - Z, each in two parts."""
        x, y, z, w = local_frame(view, *self._place)[2]
        width, height = view.size
        rows = np.array([width / 2 * (x + w), height / 2 * (y + w), w, (w - z) / 2])
        high = rows.astype(np.float32).astype(np.float64)
        return np.stack([high, rows - high], axis=1).reshape(8, 4)
