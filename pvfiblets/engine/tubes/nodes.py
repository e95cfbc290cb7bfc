"""Nodes and segments of spline tubes on the GPU.

A node takes 32 bytes: its place as three integers of a lattice, radius, and the derivatives of both; a segment takes
16: its nodes, its tube, and which of its ends others go on from. Numbers that colour take 8 bytes a node, colours 32,
while they are shown.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import moderngl
import numpy as np
import numpy.typing as npt

from ...support.value_reference import relative
from ..errors import EngineError
from ..gl.bindings import TUBES
from ..gl.moderngl_extras import BufferTexture, GLExtras
from ..lattice import lattice, places

if TYPE_CHECKING:
    from ...tubes.spline_tubes import NodeValues, SplineTubes

__all__ = ["Nodes"]


HIDDEN = 4
"""Flag of segments that are not drawn (``shaders/tubes/write_varyings.glsl``)."""

_LARGEST = float(np.finfo(np.float32).max)


class Nodes:
    """What shaders read of a set.

    Parameters
    ----------
    ctx : moderngl.Context
    gl : GLExtras
    tubes : SplineTubes

    Attributes
    ----------
    origin : numpy.ndarray
        (3,) float64: mm of place 0.
    scale : numpy.ndarray
        (3,) float64: mm per integer, the same thrice.
    buffers : dict of str to moderngl.Buffer

    Raises
    ------
    EngineError
        If there are more nodes or segments than this OpenGL reads from one buffer, memory does not suffice, or a
        radius, derivative or extent is too large for float32.
    """

    def __init__(self, ctx: moderngl.Context, gl: GLExtras, tubes: SplineTubes) -> None:
        self._ctx, self._gl, self._tubes = ctx, gl, tubes
        self._textures: dict[str, BufferTexture] = {}
        self.buffers: dict[str, moderngl.Buffer] = {}
        self._shown: NodeValues | None = None
        self._filtering: npt.NDArray[np.bool_] | None = None
        self.origin, self.scale = lattice(tubes.points, "nodes of spline tubes")
        if not tubes.n_segments:
            return
        try:
            self._put("node_texels", "nodes", "rgba32ui", self._node_words())
            self._put("segment_texels", "segments", "rgba32ui", self._segment_words(None))
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

    def _put(self, sampler: str, name: str, texel: str, data: npt.NDArray[Any]) -> None:
        limit = self._gl.get_integer("GL_MAX_TEXTURE_BUFFER_SIZE") * (16 if texel.startswith("rgba") else 8)
        if data.nbytes > limit:
            raise EngineError(
                f"{len(data)} {name} of spline tubes take {data.nbytes} bytes, more than the {limit} that this OpenGL "
                "reads from one buffer; draw them as several actors"
            )
        try:
            self.buffers[name] = self._ctx.buffer(np.ascontiguousarray(data).tobytes())
        except moderngl.Error as error:
            raise EngineError(f"no memory for {len(data)} {name} of spline tubes ({data.nbytes} bytes)") from error
        self._textures[sampler] = self._gl.texture_buffer(self.buffers[name], texel)

    def show(self, values: NodeValues | None) -> str | None:
        """Have one attribute of the nodes on the GPU, and no other; return the feature that reads it."""
        if values is not self._shown:
            for sampler, name in (("value_texels", "values"), ("colour_texels", "colours")):
                if name in self.buffers:
                    self._textures.pop(sampler).release()
                    self.buffers.pop(name).release()
            self._shown = None
            if values is not None and self._tubes.n_segments:
                numbers = values.values.ndim == 1
                data = _singles(np.stack([relative(values.values, values.reference), values.slopes], axis=1))
                if numbers:
                    self._put("value_texels", "values", "rg32f", data)
                else:
                    self._put("colour_texels", "colours", "rgba32f", data)
            self._shown = values
        if values is None:
            return None
        return "TUBE_VALUES" if values.values.ndim == 1 else "TUBE_COLOURS"

    def bind(self) -> None:
        """Bind all to their units."""
        for sampler, texture in self._textures.items():
            texture.bind(TUBES[sampler])

    def release(self) -> None:
        """Give everything back; twice is harmless."""
        for texture in self._textures.values():
            texture.release()
        for buffer in self.buffers.values():
            buffer.release()
        self._textures.clear()
        self.buffers.clear()
        self._shown = None


def _float_bits(values: npt.NDArray[np.float64], name: str) -> npt.NDArray[np.uint32]:
    largest = float(np.abs(values).max(initial=0.0))
    if not largest <= _LARGEST / 4.0:
        raise EngineError(f"{name} of spline tubes reach {largest:g}, more than float32 holds; scale the data down")
    bits: npt.NDArray[np.uint32] = np.ascontiguousarray(values, "<f4").view("<u4")
    return bits


def _singles(numbers: npt.NDArray[np.float64]) -> npt.NDArray[np.float32]:
    """As float32; what is larger than that holds becomes its largest, and what is not finite stays so."""
    within = np.where(np.isfinite(numbers), np.clip(numbers, -_LARGEST, _LARGEST), numbers)
    return within.astype("<f4")
