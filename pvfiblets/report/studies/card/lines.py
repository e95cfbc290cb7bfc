"""Lines in the window in float64, sampled densely, and how far a picture of fiblets is from them: for the card's check.

A thin line is drawn from pixel centre to pixel centre, so that a pixel of it lies within 1.25 pixels of the true line;
a brush of width ``w`` reaches ``w / 2`` pixels further. What a pixel may show, and at which depth, is therefore what
the samples around it are; what a sample must have is a pixel beside it that shows it, or something nearer.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt

from pvfiblets.engine.gbuffer import EMPTY

from ..culling.pictures import directions

if TYPE_CHECKING:
    from pvfiblets.engine.gbuffer import GBuffer

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]
Mask = npt.NDArray[np.bool_]

PER_PIXEL = 8.0
OFF_AXIS = 1.25  # pixels from a thin line's pixels to the line
DEPTH_ROUNDING = 1e-5  # of window depth
SHIFT = 0.13  # of the depths within a pixel or two: the rule of thin lines moves them by so much of a pixel
VALUE_ROUNDING = 1e-3  # of the values' span
ALONG = math.cos(math.radians(8.0))  # the engine's directions bend at points, the samples' do not


class Shown(NamedTuple):
    """The contents of a G-buffer's pixels, ``(height, width)``, row 0 at the bottom."""

    there: Mask
    depth: Array
    streamline: Ints
    direction: Array
    value: Array


def shown(gbuffer: GBuffer) -> Shown:
    """Read a G-buffer."""
    width, height = gbuffer.size
    keys = np.frombuffer(gbuffer.depth.read(), np.uint32).reshape(height, width)
    ids = np.frombuffer(gbuffer.ids.read(), np.uint32).reshape(height, width, 2)
    value = np.frombuffer(gbuffer.position.read(), np.float32).reshape(height, width, 2)[..., 1]
    there = keys != EMPTY
    return Shown(
        there, keys / float(EMPTY), np.where(there, ids[..., 0], 0).astype(np.int64),
        directions(np.where(there, ids[..., 1], 0)), np.where(there, value, 0.0).astype(np.float64),
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class LineSamples:
    """Points along polylines in the window, a fraction of a pixel apart, some of them left out."""

    size: tuple[int, int]  # Of the window, pixels
    cell: Ints  # `(n,)` int64 pixels, row by row from below
    depth: Array  # `(n,)` window depth, 0 to 1
    streamline: Ints  # `(n,)` int64
    direction: Array  # `(n, 3)` unit vectors of their segments
    value: Array  # `(n,)` numbers that run evenly along segments

    @classmethod
    def from_lines(
        cls,
        lines: Sequence[Array],
        values: Sequence[Array],
        matrix: Array,
        size: tuple[int, int],
        keep: Callable[[Array], Mask] | None = None,
    ) -> LineSamples:
        """Sample polylines of at least two points."""
        a, b = (np.concatenate([line[part] for line in lines]).astype(np.float64) for part in (_FIRST, _LAST))
        va, vb = (np.concatenate([value[part] for value in values]).astype(np.float64) for part in (_FIRST, _LAST))
        number = np.repeat(np.arange(len(lines)), [len(line) - 1 for line in lines])
        ca, cb = (np.c_[points, np.ones(len(points))] @ np.asarray(matrix, np.float64).T for points in (a, b))
        low, high = part_in_view(ca, cb)
        kept = np.flatnonzero(low <= high)
        a, b, va, vb, ca, cb, low, high = (x[kept] for x in (a, b, va, vb, ca, cb, low, high))
        number = number[kept]
        begin, end = (ca + t[:, None] * (cb - ca) for t in (low, high))
        run = np.abs(end[:, :2] / end[:, 3:] - begin[:, :2] / begin[:, 3:]) * np.array(size) / 2.0
        count = np.ceil(PER_PIXEL * run.max(axis=1)).astype(np.int64) + 2
        of = np.repeat(np.arange(len(count)), count)
        s = (np.arange(len(of)) - np.repeat(np.cumsum(count) - count, count)) / (count[of] - 1)
        wa, wb = begin[of, 3], end[of, 3]  # even steps in the window are uneven ones in space
        t = low[of] + (high - low)[of] * s * wa / ((1.0 - s) * wb + s * wa)
        place, clip = a[of] + t[:, None] * (b - a)[of], ca[of] + t[:, None] * (cb - ca)[of]
        window = (clip[:, :3] / clip[:, 3:] + 1.0) / 2.0
        column, row = (np.floor(window[:, axis] * size[axis]).astype(np.int64) for axis in (0, 1))
        good = (column >= 0) & (column < size[0]) & (row >= 0) & (row < size[1])
        if keep is not None:
            good &= keep(place)
        length = np.linalg.norm(b - a, axis=1)
        run3 = (b - a) / np.where(length > 0.0, length, 1.0)[:, None]
        of, t = of[good], t[good]
        return cls(
            size, (row * size[0] + column)[good], window[good, 2].clip(0.0, 1.0), number[of], run3[of],
            va[of] + t * (vb - va)[of],
        )  # fmt: skip

    @cached_property
    def _groups(self) -> tuple[Ints, dict[str, Array]]:
        """Samples by pixel and streamline: their key, sorted, and the least and greatest of each number."""
        key = self.cell * self._streamlines + self.streamline
        order = np.argsort(key, kind="stable")
        keys, begins = np.unique(key[order], return_index=True)
        numbers = {"depth": self.depth, "value": self.value}
        found = {}
        for name, values in numbers.items():
            found[f"least {name}"] = np.minimum.reduceat(values[order], begins)
            found[f"greatest {name}"] = np.maximum.reduceat(values[order], begins)
        found["sample"] = order[begins].astype(np.float64)
        return keys, found

    @cached_property
    def _streamlines(self) -> int:
        return int(self.streamline.max(initial=0)) + 1

    def wrong(self, picture: Shown, width: float = 1.0, *, values: bool = False) -> dict[str, Mask]:
        """Return which pixels are wrong."""
        shape = picture.there.shape
        reach = math.ceil(OFF_AXIS + max(width, 1.0) / 2.0 - 0.5)
        around = [(dy, dx) for dy in range(-reach, reach + 1) for dx in range(-reach, reach + 1)]
        rows, columns = np.nonzero(picture.there)
        line, other_way, other_value = (np.zeros(shape, bool) for _ in range(3))
        low, high, low_value, high_value, along = (np.full(len(rows), x) for x in (9.0, -9.0, np.inf, -np.inf, -1.0))
        numbers, direction = picture.streamline[rows, columns], picture.direction[rows, columns]
        for dy, dx in around:
            at, of = self._find(rows + dy, columns + dx, numbers)
            group = {name: values[of] for name, values in self._groups[1].items()}
            low[at], high[at] = np.minimum(low[at], group["least depth"]), np.maximum(high[at], group["greatest depth"])
            low_value[at] = np.minimum(low_value[at], group["least value"])
            high_value[at] = np.maximum(high_value[at], group["greatest value"])
            ways = self.direction[group["sample"].astype(np.int64)]
            along[at] = np.maximum(along[at], (ways * direction[at]).sum(axis=1))
        depth = picture.depth[rows, columns]
        slack = DEPTH_ROUNDING + SHIFT * np.maximum(high - low, 0.0)
        line[rows, columns] = (depth < low - slack) | (depth > high + slack)
        right = ~line[rows, columns]
        other_way[rows, columns] = right & (along < ALONG)
        if values:
            value, slack = picture.value[rows, columns], VALUE_ROUNDING * float(np.ptp(self.value))
            off = ~((value >= low_value - slack) & (value <= high_value + slack))
            other_value[rows, columns] = right & off
        return {"line": line, "lost": self._lost(picture), "direction": other_way, "value": other_value}

    def _find(self, rows: Ints, columns: Ints, streamline: Ints) -> tuple[Ints, Ints]:
        """Return which of pixels have samples of their streamline, and which group those are."""
        width, height = self.size
        keys = self._groups[0]
        key = (rows * width + columns) * self._streamlines + np.minimum(streamline, self._streamlines - 1)
        inside = (rows >= 0) & (rows < height) & (columns >= 0) & (columns < width) & (streamline < self._streamlines)
        at = np.searchsorted(keys, key).clip(0, max(len(keys) - 1, 0))
        found = np.flatnonzero(inside & (keys[at] == key)) if len(keys) else np.zeros(0, np.int64)
        return found, at[found]

    def _lost(self, picture: Shown) -> Mask:
        """Return pixels whose samples have nothing beside them that is as near."""
        shape, (keys, group) = picture.there.shape, self._groups
        lost = np.zeros(shape, bool)
        if not len(keys):
            return lost
        rows, columns = np.divmod(keys // self._streamlines, self.size[0])
        nearest = np.full((shape[0] + 2, shape[1] + 2), np.inf)
        nearest[1:-1, 1:-1] = np.where(picture.there, picture.depth, np.inf)
        near = np.min([nearest[1 + y : 1 + y + shape[0], 1 + x : 1 + x + shape[1]]
                       for y in (-1, 0, 1) for x in (-1, 0, 1)], axis=0)  # fmt: skip
        high = group["greatest depth"].copy()
        for dy, dx in ((dy, dx) for dy in (-1, 0, 1) for dx in (-1, 0, 1)):
            at, of = self._find(rows + dy, columns + dx, keys % self._streamlines)
            high[at] = np.maximum(high[at], group["greatest depth"][of])
        gone = near[rows, columns] > high + DEPTH_ROUNDING
        lost[rows[gone], columns[gone]] = True
        return lost


_FIRST, _LAST = slice(None, -1), slice(1, None)


def part_in_view(a: Array, b: Array) -> tuple[Array, Array]:
    """Return the part of segments, ``(n, 4)`` clip coordinates, that is in the view volume; low > high where none."""
    low, high = np.zeros(len(a)), np.ones(len(a))
    for axis in range(3):
        for sign in (-1.0, 1.0):
            da, db = a[:, 3] + sign * a[:, axis], b[:, 3] + sign * b[:, axis]
            with np.errstate(divide="ignore", invalid="ignore"):
                t = da / (da - db)
            high = np.where((da < 0.0) & (db < 0.0), -1.0, high)
            low = np.where((da < 0.0) & (db >= 0.0), np.fmax(low, t), low)
            high = np.where((da >= 0.0) & (db < 0.0), np.fmin(high, t), high)
    return low, high
