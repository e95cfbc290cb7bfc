"""Uniform blocks of spline tubes: the camera's, shared with fiblets, and their own (``shaders/tubes/block.glsl``)."""

from __future__ import annotations

import moderngl
import numpy as np
import numpy.typing as npt

from ..bindings import BLOCKS
from ..clipping import BLOCK_BYTES, clip_planes_block
from ..fiblets.line_tubes import TUBES_BYTES, tubes_block
from ..frame import FRAME_BYTES, frame_block, local_frame
from ..view import Style, View

__all__ = ["CONSTANTS", "SPLINES_BYTES", "TubeBlocks"]

SPLINES_BYTES = 160
Array = npt.NDArray[np.float64]

CONSTANTS = {"max_clip_planes": 8}
"""Of the shaders."""


class TubeBlocks:
    """The blocks of one set.

    Parameters
    ----------
    ctx : moderngl.Context
    place : tuple
        Origin (3,), scale (3,) and largest integer of the nodes' lattice.
    scaled : bool
        Whether derivatives are by length.

    Attributes
    ----------
    buffers : dict of str to moderngl.Buffer
    """

    def __init__(self, ctx: moderngl.Context, place: tuple[Array, Array, int], scaled: bool) -> None:
        self._ctx, self._place, self._scaled = ctx, place, scaled
        self.buffers: dict[str, moderngl.Buffer] = {}

    def write(
        self, view: View, *, reach: float, middle: float, min_width: float, iterations: int, n_segments: int
    ) -> bool:
        """Bring all up to date and bind them; say whether a clip plane may touch anything.

        Parameters
        ----------
        view : View
        reach : float
            Mm that a tube may lie outside the box of the nodes.
        middle : float
            Share of a derivative between control points.
        min_width : float
            Pixels.
        iterations, n_segments : int
        """
        tubes = tubes_block(view, 1.0, *self._place)
        rays = np.frombuffer(tubes, "<f4").reshape(5, 4).astype(np.float64)
        pixel = max(np.linalg.norm(rays[2, :3]), np.linalg.norm(rays[3, :3]))
        block = np.zeros((), [("scale", "<f4", 4), ("counts", "<i4", 4), ("rows", "<f4", (4, 2, 4))])
        block["scale"] = self._place[1][0], middle, 0.5 * min_width * pixel, float(self._scaled)
        block["counts"] = iterations, n_segments, 0, 0
        block["rows"] = self._rows(view)
        self._put("frame", "Frame", FRAME_BYTES, frame_block(view, Style(), *self._place)[0])
        self._put("tubes", "Tubes", TUBES_BYTES, tubes)
        self._put("splines", "Splines", SPLINES_BYTES, block.tobytes())
        planes = clip_planes_block(view, 1.0, *self._place, reach)
        if planes is None:
            if "clip_planes" in self.buffers:
                self.buffers.pop("clip_planes").release()
            return False
        self._put("clip_planes", "ClipPlanes", BLOCK_BYTES, planes)
        return True

    def _rows(self, view: View) -> Array:
        """(4, 2, 4): from local mm to X, Y, W of the window and to W - Z, in two parts."""
        x, y, z, w = local_frame(view, *self._place)[2]
        width, height = view.size
        rows = np.array([width / 2 * (x + w), height / 2 * (y + w), w, (w - z) / 2])
        high = rows.astype(np.float32).astype(np.float64)
        return np.stack([high, rows - high], axis=1)

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
