"""Vertices of lines or points with halos on the GPU.

A vertex takes 12 bytes, three integers of a lattice; on a line two more, where along its line's mask it is; and four
each for numbers that filter and for numbers or colours that show, while they do. Nothing is stored twice: strips are
widened from these by the vertex stage.
"""

from __future__ import annotations

from typing import Any

import moderngl
import numpy as np
import numpy.typing as npt

from ...halos.geometry import HaloLines, HaloPoints
from ...support.value_reference import relative
from ..errors import EngineError
from ..gl.bindings import HALOS
from ..gl.moderngl_extras import TEXEL_FORMATS, BufferTexture, GLExtras
from ..lattice import lattice, places

__all__ = ["LAST", "MOST", "Vertices", "mask_places"]


LAST = 65535
"""Place on the mask of a line's last vertex, and of no other."""

_LARGEST = float(np.finfo(np.float32).max)

MOST = _LARGEST / 2.0
"""Numbers that filter, and thresholds, count as no larger, infinity neither: what lies between two is a number then."""


class Vertices:
    """What shaders read of lines or points.

    Parameters
    ----------
    ctx : moderngl.Context
    gl : GLExtras
    drawn : HaloLines or HaloPoints

    Attributes
    ----------
    origin, scale : numpy.ndarray
        (3,) float64: mm of place 0, and mm per integer, the same thrice.
    n_items : int
        Segments, counted from every vertex to the next whether they are on one line or not; or points.
    buffers : dict of str to moderngl.Buffer

    Raises
    ------
    EngineError
        If there are more vertices than this OpenGL reads from one buffer, memory does not suffice, or the extent is
        too large for float32.
    """

    def __init__(self, ctx: moderngl.Context, gl: GLExtras, drawn: HaloLines | HaloPoints) -> None:
        self._ctx, self._gl, self._drawn = ctx, gl, drawn
        self._textures: dict[str, BufferTexture] = {}
        self._holds: dict[str, object] = {}
        self._filtering: npt.NDArray[np.bool_] | None = None
        self.buffers: dict[str, moderngl.Buffer] = {}
        self.origin, self.scale = lattice(drawn.points, "points with halos")
        self.n_items = max(drawn.n_points - 1, 0) if isinstance(drawn, HaloLines) else drawn.n_points
        if not self.n_items:
            return
        try:
            self._put("place_texels", "r32ui", places(drawn.points, self.origin, self.scale), drawn)
            if isinstance(drawn, HaloLines):
                self._put("offset_texels", "r32ui", drawn.offsets.astype("<u4"), drawn)
        except BaseException:
            self.release()
            raise

    def show_mask(self, n_tapered: int, t_tapered: float, filtering: npt.NDArray[np.bool_] | None = None) -> None:
        """Have the places of vertices on the masks of lines, whose ends taper; of points, which are hidden."""
        drawn = self._drawn
        key = n_tapered, t_tapered
        if not self.n_items or (filtering is self._filtering and self._holds.get("mask_texels") == key):
            return
        self._filtering = filtering
        if isinstance(drawn, HaloLines):
            offsets = drawn.offsets if filtering is None else drawn.pieces(filtering)
            self._put("mask_texels", "r16ui", mask_places(offsets, n_tapered, t_tapered), key)
        elif filtering is None:
            self._drop("mask_texels")
        else:
            self._put("mask_texels", "r16ui", np.where(filtering, 0, LAST).astype("<u2"), key)

    def show_filter(self, name: str | None) -> bool:
        """Have the numbers that filter, and no others; say whether there are."""
        return self._show("filter_texels", None if name is None else self._values(name, 1), name, MOST)

    def show_values(self, name: Any) -> str | None:
        """Have the numbers or colours that show, and no others; return the feature that reads them."""
        values = None if name is None else self._values(name, 2)
        coloured = values is not None and values.ndim == 2
        self._show("colour_texels", values if coloured else None, name)
        self._show("value_texels", None if coloured else values, name)
        if values is None:
            return None
        return "HALO_COLOURS" if coloured else "HALO_VALUES"

    def _values(self, name: Any, most: int) -> npt.NDArray[Any]:
        known = self._drawn.values
        if not isinstance(name, str) or name not in known:
            raise EngineError(f"no values {name!r} at the points of these halos; there are {sorted(known)}")
        if known[name].ndim > most:
            raise EngineError(f"values {name!r} are colours, and cannot filter; give numbers")
        return known[name]

    def _show(self, sampler: str, values: npt.NDArray[Any] | None, name: Any, most: float = np.inf) -> bool:
        if values is None:
            self._drop(sampler)
        elif self.n_items and self._holds.get(sampler) is not values:
            if values.ndim == 2:
                self._put(sampler, "r32ui", _packed(values), values)
            else:
                reference = self._drawn.value_reference(name)
                self._put(sampler, "r32f", _singles(values, reference, most), values)
        return values is not None

    def _put(self, sampler: str, texel: str, data: npt.NDArray[Any], holds: object) -> None:
        self._drop(sampler)
        limit = self._gl.get_integer("GL_MAX_TEXTURE_BUFFER_SIZE") * TEXEL_FORMATS[texel][1]
        n = self._drawn.n_points
        if data.nbytes > limit:
            raise EngineError(
                f"{n} points with halos take {data.nbytes} bytes, more than the {limit} that this OpenGL reads from "
                "one buffer; draw them as several actors"
            )
        name = sampler.removesuffix("_texels") + "s"
        try:
            self.buffers[name] = self._ctx.buffer(np.ascontiguousarray(data))
        except moderngl.Error as error:
            raise EngineError(f"no memory for {n} points with halos ({data.nbytes} bytes)") from error
        self._textures[sampler] = self._gl.texture_buffer(self.buffers[name], texel)
        self._holds[sampler] = holds

    def _drop(self, sampler: str) -> None:
        if sampler in self._textures:
            self._textures.pop(sampler).release()
            self.buffers.pop(sampler.removesuffix("_texels") + "s").release()
            self._holds.pop(sampler)

    def bind(self) -> None:
        """Bind all to their units."""
        for sampler, texture in self._textures.items():
            texture.bind(HALOS[sampler])

    def release(self) -> None:
        """Give everything back; twice is harmless."""
        for sampler in list(self._textures):
            self._drop(sampler)


def mask_places(offsets: npt.NDArray[np.int64], n_tapered: int, t_tapered: float) -> npt.NDArray[np.uint16]:
    """Return where along its line's mask every vertex is.

    Notes
    -----
    Source: Everts et al. 2009, section 3.4: u goes from 0 to t over the first n vertices and from 1 - t to 1 over the
    last ones. Lines of less than 2 n + 1 vertices go as far as their middle, from both ends.
    """
    counts = np.diff(offsets)
    filled = counts > 0
    total = np.repeat(counts[filled] - 1, counts[filled]).astype(np.float32)
    index = (np.arange(offsets[-1]) - np.repeat(offsets[:-1], counts)).astype(np.float32)
    from_end = np.minimum(index, total - index)
    if n_tapered:
        within = from_end / np.float32(n_tapered) * np.float32(t_tapered)
        inner = np.maximum(total - 2 * n_tapered, 1.0)
        between = t_tapered + (from_end - n_tapered) * ((1.0 - 2.0 * t_tapered) / inner)
        half = np.where(from_end <= n_tapered, within, between)
        half[2.0 * from_end == total] = 0.5
    else:
        half = np.full(len(index), 0.5, np.float32)
    half[from_end == 0.0] = 0.0
    u = np.where(2.0 * index > total, 1.0 - half, half)
    places: npt.NDArray[np.uint16] = np.rint(u * LAST).astype("<u2")
    places[from_end > 0.0] = np.clip(places[from_end > 0.0], 1, LAST - 1)
    places[offsets[1:][filled] - 1] = LAST
    return places


def _singles(numbers: npt.NDArray[Any], reference: float, most: float) -> npt.NDArray[np.float32]:
    """Less the reference as float32, none beyond +-most; what float32 does not hold becomes its largest."""
    if numbers.dtype == np.float32 and most == np.inf and not reference:
        return np.asarray(numbers, "<f4")
    wide = np.clip(relative(numbers, reference), -most, most)
    return np.where(np.isfinite(wide), np.clip(wide, -_LARGEST, _LARGEST), wide).astype("<f4")


def _packed(colours: npt.NDArray[np.float32]) -> npt.NDArray[np.uint32]:
    """(n, 4) colours as four bytes each, red lowest; NaN as 0."""
    levels = np.rint(np.clip(np.nan_to_num(colours), 0.0, 1.0) * 255.0)
    return np.ascontiguousarray(levels.astype(np.uint8)).view("<u4").reshape(-1)
