"""Nodes and segments of spline tubes on the GPU.

A node takes 32 bytes: its place as three integers of a lattice, radius, and the derivatives of both; a segment takes
16: its nodes, its tube, and which of its ends others go on from. Numbers that colour take 8 bytes a node, colours 32,
while they are shown.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import moderngl
import numpy as np
import numpy.typing as npt

from ...support.value_reference import relative
from ..errors import EngineError
from ..gl.bindings import TUBES
from ..gl.moderngl_extras import GLExtras
from ..gl.texel_buffers import LARGEST, TexelBuffers, as_singles
from ..lattice import lattice, places

if TYPE_CHECKING:
    from ...tubes.spline_tubes import NodeValues, SplineTubes


HIDDEN = 4  # flag of segments that are not drawn (`shaders/tubes/write_varyings.glsl`)


class Nodes(TexelBuffers):
    """What shaders read of a set; `origin` and `scale` are mm of place 0 and mm per integer, (3,) float64."""

    def __init__(self, ctx: moderngl.Context, gl: GLExtras, tubes: SplineTubes) -> None:
        super().__init__(ctx, gl, TUBES)
        self._tubes = tubes
        self._shown: NodeValues | None = None
        self._filtering: npt.NDArray[np.bool_] | None = None
        self.origin, self.scale = lattice(tubes.points, "nodes of spline tubes")
        if not tubes.n_segments:
            return
        try:
            self.put("node_texels", "rgba32ui", self._node_words(), f"{tubes.n_nodes} nodes of spline tubes")
            words, what = self._segment_words(None), f"{tubes.n_segments} segments of spline tubes"
            self.put("segment_texels", "rgba32ui", words, what)
        except BaseException:
            self.release()
            raise

    def _node_words(self) -> npt.NDArray[np.uint32]:
        tubes = self._tubes
        words: npt.NDArray[np.uint32] = np.zeros((tubes.n_nodes, 8), "<u4")
        words[:, :3] = places(tubes.points, self.origin, self.scale)
        words[:, 3] = _float_bits(tubes.radius, "radius")
        words[:, 4:7] = _float_bits(tubes.tangents, "tangents")
        words[:, 7] = _float_bits(tubes.radius_slopes, "radius_slopes")
        return words

    def _segment_words(self, filtering: npt.NDArray[np.bool_] | None) -> npt.NDArray[np.uint32]:
        tubes = self._tubes
        words: npt.NDArray[np.uint32] = np.empty((tubes.n_segments, 4), "<u4")
        words[:, :2] = tubes.segments
        words[:, 2] = tubes.tubes
        words[:, 3] = HIDDEN
        if filtering is None:
            words[:, 3] = tubes.joined_ends @ np.array([1, 2])
        else:
            words[filtering, 3] = tubes.with_segments(filtering).joined_ends @ np.array([1, 2])
        return words

    def filter(self, filtering: npt.NDArray[np.bool_] | None) -> None:
        """Have segments hidden but for some; those left end where others are hidden."""
        if filtering is not self._filtering and self._tubes.n_segments:
            self.buffers["segments"].write(np.ascontiguousarray(self._segment_words(filtering)).tobytes())
        self._filtering = filtering

    def show(self, values: NodeValues | None) -> str | None:
        """Have one attribute of the nodes on the GPU, and no other; return the feature that reads it."""
        if values is not self._shown:
            for sampler in ("value_texels", "colour_texels"):
                self.drop(sampler)
            self._shown = None
            if values is not None and self._tubes.n_segments:
                data = as_singles(np.stack([relative(values.values, values.reference), values.slopes], axis=1))
                sampler, texel = ("value_texels", "rg32f") if data.ndim == 2 else ("colour_texels", "rgba32f")
                self.put(sampler, texel, data, f"{len(data)} values of spline tubes")
            self._shown = values
        if values is None:
            return None
        return "TUBE_VALUES" if values.values.ndim == 1 else "TUBE_COLOURS"


def _float_bits(values: npt.NDArray[np.float64], name: str) -> npt.NDArray[np.uint32]:
    largest = float(np.abs(values).max(initial=0.0))
    if not largest <= LARGEST / 4.0:
        raise EngineError(f"{name} of spline tubes reach {largest:g}, more than float32 holds; scale the data down")
    bits: npt.NDArray[np.uint32] = np.ascontiguousarray(values, "<f4").view("<u4")
    return bits
