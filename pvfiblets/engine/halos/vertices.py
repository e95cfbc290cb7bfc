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
from ..gl.moderngl_extras import GLExtras
from ..gl.texel_buffers import LARGEST, TexelBuffers, as_singles
from ..lattice import lattice, places

LAST = 65535  # place on the mask of a line's last vertex, and of no other

MOST = LARGEST / 2.0
"""Numbers that filter, and thresholds, count as no larger, infinity neither: what lies between two is a number then."""


class Vertices(TexelBuffers):
    """What shaders read of lines or points.

    `origin` and `scale` are mm of place 0 and mm per integer, (3,) float64; `n_items` are segments, counted from every
    vertex to the next whether they are on one line or not, or points.
    """

    def __init__(self, ctx: moderngl.Context, gl: GLExtras, drawn: HaloLines | HaloPoints) -> None:
        super().__init__(ctx, gl, HALOS)
        self._drawn = drawn
        self._holds: dict[str, object] = {}
        self._filtering: npt.NDArray[np.bool_] | None = None
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
            self.drop("mask_texels")
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
            self.drop(sampler)
        elif self.n_items and self._holds.get(sampler) is not values:
            if values.ndim == 2:
                self._put(sampler, "r32ui", _packed(values), values)
            else:
                reference = self._drawn.value_reference(name)
                self._put(sampler, "r32f", as_singles(relative(values, reference), most), values)
        return values is not None

    def _put(self, sampler: str, texel: str, data: npt.NDArray[Any], holds: object) -> None:
        self.put(sampler, texel, data, f"{self._drawn.n_points} points with halos")
        self._holds[sampler] = holds

    def drop(self, sampler: str) -> None:
        """Give an array back, if there is one."""
        super().drop(sampler)
        self._holds.pop(sampler, None)


def mask_places(offsets: npt.NDArray[np.int64], n_tapered: int, t_tapered: float) -> npt.NDArray[np.uint16]:
    """Return where along its line's mask every vertex is."""
    # Everts et al. 2009, section 3.4: u goes from 0 to t over the first n vertices and from 1 - t to 1 over the last
    # ones. Lines of less than 2 n + 1 vertices go as far as their middle, from both ends.
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


def _packed(colours: npt.NDArray[np.float32]) -> npt.NDArray[np.uint32]:
    """(n, 4) colours as four bytes each, red lowest; NaN as 0."""
    levels = np.rint(np.clip(np.nan_to_num(colours), 0.0, 1.0) * 255.0)
    return np.ascontiguousarray(levels.astype(np.uint8)).view("<u4").reshape(-1)
