"""Direction codes of many slots at once, in NumPy and in the arithmetic of `direction_kernels`.

Codes of a slot follow from each other, codes of different slots do not: the loop is over the points of a slot, and
each turn of it is over all slots. They are sorted by their number of points, so that slots with an ``i``-th point come
first, and a slot that exceeds the error bound is left out of the rest.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ..direction_codebook import cap_ratios, directions, quaternions
from ..layout import DIRECTION_SCALE, STEP_LEVELS
from .capsule_arrays import capsules
from .frame_arrays import first_frames, signs, turn, turned_x
from .turn_arrays import Turning, excess

BATCH = 512  # slots at once: the codebooks of their caps take 3 MiB
TRIES = 3  # cap angles

Array = npt.NDArray[np.float64]


def anchors_of(relative: Array, scale: Array, top: float) -> Array:
    """Points ``(3, ...)`` from the origin as anchors hold them."""
    unit = scale.reshape(3, *([1] * (relative.ndim - 1)))
    levels = np.divide(relative, unit, out=np.zeros_like(relative), where=unit > 0.0)
    anchors: Array = unit * np.minimum(np.maximum(np.rint(levels), 0.0), top)
    return anchors


def pack_directions(d: Array) -> npt.NDArray[np.int64]:
    """Quantise vectors ``(3, k)`` to two snorm16 on the octahedron about +x."""
    x, y, z = d
    norm = np.abs(x) + np.abs(y) + np.abs(z)
    still = norm == 0.0
    norm = np.where(still, 1.0, norm)
    u, v = y / norm, z / norm
    back = x < 0.0
    u, v = np.where(back, (1.0 - np.abs(v)) * signs(u), u), np.where(back, (1.0 - np.abs(u)) * signs(v), v)
    iu, iv = np.rint(u * DIRECTION_SCALE).astype(np.int64), np.rint(v * DIRECTION_SCALE).astype(np.int64)
    return (iu & 0xFFFF) | ((iv & 0xFFFF) << 16)


def encode_directions(
    points: npt.NDArray[np.floating],
    origin: Array,
    slots: npt.NDArray[np.int64],
    end: npt.NDArray[np.uint8],
    scale: Array,
    top: float,
    steps: tuple[float, float],
    promise: float,
    turning: Turning,
    end_scale: float,
    out: tuple[npt.NDArray[Any], ...],
) -> None:
    """Try to code every slot with direction bytes; arguments are as in `direction_kernels.encode_directions`."""
    # `turning` is that of all points, `end (m,)` says which slots end their streamlines, and `out` is filled.
    order = np.argsort(-slots[:, 1], kind="stable")
    for a in range(0, len(order), BATCH):
        which = order[a : a + BATCH]
        first, counts, leads = slots[which, 0], slots[which, 1], end[which] == 0
        rows = first + np.minimum(np.arange(counts[0])[:, None], counts - 1)
        true = np.ascontiguousarray(np.moveaxis(points[rows].astype(np.float64) - origin, 2, 1))
        batch = _Batch(true, counts, anchors_of(true[0], scale, top), promise * promise)
        batch.encode(*steps)
        after = np.minimum(first + counts, len(points) - 1)
        following = anchors_of(points[after].astype(np.float64).T - origin[:, None], scale, top)
        good = batch.best <= batch.give_up
        allowed = turning.allowed[rows]
        begins = turning.first[first]
        np.minimum(allowed[0], begins, out=allowed[0], where=begins >= 0.0)
        units = np.moveaxis(turning.units[:, rows], 0, 1)
        good &= excess(batch.decoded, counts, following, leads, units, allowed) <= 1.0
        ok, shape, step, cap, radius, end_words, codes = out
        ok[which], shape[which], step[which], cap[which] = good, batch.shape, batch.step_index, batch.cap
        radius[which], end_words[which] = capsules(batch.decoded, counts, leads, following, end_scale)
        inside = np.arange(len(batch.codes))[:, None] < counts - 2
        codes[rows[: len(batch.codes)][inside]] = batch.codes[inside]


class _Batch:
    """Slots in order of falling numbers of points, and the best coding of each so far."""

    def __init__(self, true: Array, counts: npt.NDArray[np.int64], anchors: Array, give_up: float) -> None:
        most, _, k = true.shape
        self.true, self.counts, self.anchors, self.give_up = true, counts, anchors, give_up
        self.best = np.where(counts > 1, np.inf, 0.0)
        self.cap = np.zeros(k, np.uint8)
        self.shape, self.step_index = np.zeros(k, np.int64), np.zeros(k, np.int64)
        self.codes = np.zeros((max(most - 2, 0), k), np.uint8)
        self.decoded: Array = np.repeat(anchors[None], most, axis=0)

    def encode(self, lo: float, hi: float) -> None:
        """Try the smallest cap that holds all turns, and wider ones where it errs by more than half the error bound."""
        moving = int(np.searchsorted(-self.counts, -1))  # slots of one point come last
        if not moving:
            return
        if hi > lo:
            self.step_index[:moving] = self._step_indices(moving, lo, hi)
        step = lo + self.step_index * (hi - lo) / STEP_LEVELS if hi > lo else np.full(len(self.counts), lo)
        self.shape[:moving] = pack_directions((self.true[1] - self.anchors)[:, :moving])
        smallest = self._smallest_caps(moving)
        for wider in range(TRIES):
            some = np.flatnonzero(
                (self.best[:moving] > 0.25 * self.give_up) & (smallest + wider < len(cap_ratios()))
            )
            if some.size:
                self._try(some, smallest[some] + wider, step[some])

    def _step_indices(self, n: int, lo: float, hi: float) -> Array:
        """Index of each fiblet's step between the file's least and greatest."""
        arc = np.zeros(n)
        for i in range(1, len(self.true)):
            d = self.true[i, :, :n] - self.true[i - 1, :, :n]
            arc += np.where(i < self.counts[:n], np.sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), 0.0)
        levels = (arc / (self.counts[:n] - 1) - lo) / (hi - lo) * STEP_LEVELS
        index: Array = np.rint(np.minimum(np.maximum(levels, 0.0), float(STEP_LEVELS)))
        return index

    def _smallest_caps(self, n: int) -> npt.NDArray[np.int64]:
        """Index of the smallest cap angle that holds every turn of the points."""
        least = np.ones(n)
        for i in range(2, len(self.true)):
            a = self.true[i - 1, :, :n] - self.true[i - 2, :, :n]
            b = self.true[i, :, :n] - self.true[i - 1, :, :n]
            norm = np.sqrt(
                (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]) * (b[0] * b[0] + b[1] * b[1] + b[2] * b[2])
            )
            told = (i < self.counts[:n]) & (norm > 0.0)
            dots = a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
            np.minimum(least, np.divide(dots, norm, out=np.ones(n), where=told), out=least)
        held = 1.0 - cap_ratios()[:, None] <= least
        return np.where(held.any(axis=0), held.argmax(axis=0), len(held) - 1)

    def _try(self, some: npt.NDArray[np.int64], caps: npt.NDArray[np.int64], step: Array) -> None:
        """Code slots by caps; better codes replace earlier ones."""
        tables = np.moveaxis(quaternions().astype(np.float64), 2, 0)
        books = np.moveaxis(directions(), 2, 0)[:, caps]
        limit = np.minimum(self.give_up, self.best[some])
        counts = self.counts[some]
        codes = np.zeros((len(self.codes), len(some)), np.uint8)
        decoded = self.decoded[:, :, some]
        column = np.arange(len(some))  # slots that have not failed, and have further points
        d, q = first_frames(self.shape[some])
        p = self.anchors[:, some]
        worst = _squares(self.true[0][:, some] - p)
        p = p + step * d
        decoded[1] = p
        worst = np.maximum(worst, _squares(self.true[1][:, some] - p))
        error = worst.copy()
        for i in range(2, int(counts[0])):
            alive = (i < counts[column]) & (worst <= limit[column])
            if not alive.all():
                error[column] = worst
                column, p, q, worst, books = column[alive], p[:, alive], q[:, alive], worst[alive], books[:, alive]
                if not column.size:
                    break
            true = self.true[i][:, some[column]]
            code = _nearest(_unturned(q, true - p), books)
            codes[i - 2, column] = code
            q = turn(q, tables[:, caps[column], code])
            p = p + step[column] * turned_x(q)
            decoded[i][:, column] = p
            worst = np.maximum(worst, _squares(true - p))
        error[column] = worst
        better = np.flatnonzero((error <= limit) & (error < self.best[some]))
        to = some[better]
        self.best[to], self.cap[to] = error[better], caps[better]
        self.codes[:, to], self.decoded[:, :, to] = codes[:, better], decoded[:, :, better]


def _squares(v: Array) -> Array:
    squares: Array = v[0] * v[0] + v[1] * v[1] + v[2] * v[2]
    return squares


def _unturned(q: Array, a: Array) -> Array:
    """Vectors ``(3, k)`` in the coordinates of frames."""
    w, x, y, z = q
    ax, ay, az = a
    return np.stack(
        [
            ax * (1.0 - 2.0 * (y * y + z * z)) + ay * (2.0 * (x * y + w * z)) + az * (2.0 * (x * z - w * y)),
            ax * (2.0 * (x * y - w * z)) + ay * (1.0 - 2.0 * (x * x + z * z)) + az * (2.0 * (y * z + w * x)),
            ax * (2.0 * (x * z + w * y)) + ay * (2.0 * (y * z - w * x)) + az * (1.0 - 2.0 * (x * x + y * y)),
        ]
    )


def _nearest(aim: Array, books: Array) -> npt.NDArray[np.intp]:
    """Codes whose directions, of ``books (3, k, 256)``, are nearest to ``aim (3, k)``."""
    score = aim[0][:, None] * books[0]
    part = aim[1][:, None] * books[1]
    score += part
    np.multiply(aim[2][:, None], books[2], out=part)
    score += part
    return score.argmax(axis=1)


