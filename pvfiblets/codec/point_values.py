"""Values stored per point: the one place that states how, for memory, files, graphics cards and pages.

A value is kept as a code of one or two bytes, which means ``table[code]``. Up to 255 different numbers (65,535 in two
bytes) are a dictionary and stay exact, in value and in type: labels, categories, counts. Other floats take the value of
the nearest entry: entries lie so close, where the array has any values at all, that the largest code fits and no value
is off by more than the bound. A single -9999 is an entry of its own and coarsens nothing. Where all values are positive
and the middle 98 % of them span a factor of 100, entries lie closer the smaller values are, so that logarithms are as
true as values. What no table holds within the bound, and integers of too many kinds, are kept as they are.

The bound, unless one is given: 1/255 of the range from the 1st to the 99th percentile, or of their
logarithms. The largest code of floats means NaN, which infinities become too.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ..formats.mapped import forget
from ..formats.scratch import is_long, spans
from ..support.value_reference import value_reference

if TYPE_CHECKING:
    from ..streamlines import Streamlines

Array = npt.NDArray[Any]
Floats = npt.NDArray[np.float64]

SPREAD = 100.0  # factor between the percentiles of positive values from which on their logarithms count too
SAMPLE = 1 << 16  # values of each array whose percentiles are taken
CELLS = 12  # bits of a float32 that do not tell cells apart: each is 2 ** -11 of its values wide


@dataclass(frozen=True)
class PointValues:
    """A value for each point of a set."""

    # `(n_points,)` uint8 or uint16 where there is a `table`; else the values themselves, of any type of numbers
    codes: Array
    lo: float  # least and largest finite value of the original
    hi: float
    max_error: float  # differences to the finite values of the original, in their unit (measured, not estimated)
    mean_error: float = 0.0
    # `(256,)` or `(65536,)`: what codes mean, in the original's type, rising as far as codes are used; of floats the
    # last is NaN
    table: Array | None = None
    reference: float = 0.0  # what graphics cards subtract first (`pvfiblets.support.value_reference`)

    @property
    def dtype(self) -> np.dtype[Any]:
        """Type of the values."""
        return self.codes.dtype if self.table is None else self.table.dtype

    @property
    def drawn_bytes(self) -> int:
        """Bytes a point on a graphics card, where values without a table are float32."""
        return 4 if self.table is None else self.codes.dtype.itemsize

    @property
    def table_bytes(self) -> int:
        """Bytes of the table on a graphics card."""
        return 0 if self.table is None else 4 * len(self.table)

    @property
    def nbytes(self) -> int:
        """Bytes of codes that make a table comparatively small."""
        return int(self.codes.nbytes)

    def values(self, index: Any = slice(None)) -> Array:
        """Return the values of some points, all by default; NaN where a float was not finite."""
        if self.table is None:
            return np.array(self.codes[index])
        return np.asarray(self.table[np.asarray(self.codes[index])])

    def least_positive(self) -> float:
        """Return the least value above 0, or 1e-30 where there is none."""
        found = self.values() if self.table is None else self.table
        positive = found[found > 0]
        return float(positive.min()) if positive.size else 1e-30

    def distinct(self) -> int:
        """Return how many different numbers there are, NaN not counted."""
        if self.table is None:
            found = np.unique(self.values())
            return int(np.isfinite(found).sum())
        used = np.bincount(np.asarray(self.codes), minlength=len(self.table)) > 0
        return int((used & np.isfinite(self.table)).sum())


@dataclass(frozen=True)
class ValueCoder:
    """Coding of an array's values, by a survey of them."""

    table: Array | None
    count: int  # entries of the table that mean numbers
    kind: np.dtype[Any]
    lo: float
    hi: float
    reference: float

    @property
    def dtype(self) -> np.dtype[Any]:
        """Type of the codes."""
        return self.kind if self.table is None else np.dtype(np.uint8 if len(self.table) == 256 else np.uint16)

    def code(self, values: npt.ArrayLike) -> PointValues:
        """Code some of the values, or all."""
        column = np.asarray(values)
        if column.ndim != 1:
            raise ValueError(f"per-point values of shape {column.shape} cannot be stored; one number a point is needed")
        codes, worst, total, n = np.empty(len(column), self.dtype), 0.0, 0.0, 0
        for a, b in spans(len(column)) if is_long(len(column)) else [(0, len(column))]:
            codes[a:b], errors = self._coded(column[a:b])
            worst, total, n = max(worst, float(errors.max(initial=0.0))), total + float(errors.sum()), n + len(errors)
            forget(column, 0, b)
        mean = total / max(n, 1)
        return PointValues(codes, self.lo, self.hi, worst, mean, self.table, self.reference)

    def _coded(self, column: Array) -> tuple[Array, Floats]:
        """Codes, and the errors of finite values."""
        if self.table is None:
            if self.kind.kind == "f":
                column = np.where(np.isfinite(column), column, np.nan)
            return column.astype(self.kind), np.zeros(0)
        if self.kind.kind != "f":
            return np.searchsorted(self.table[: self.count], column).astype(self.dtype), np.zeros(0)
        numbers = column.astype(np.float64)
        finite = np.isfinite(numbers)
        entries = self.table[: self.count].astype(np.float64)
        middles = entries[:-1] + np.diff(entries) / 2.0
        codes = np.searchsorted(middles, numbers).astype(self.dtype)
        codes[~finite] = len(self.table) - 1
        return codes, np.abs(entries[codes[finite]] - numbers[finite]) if self.count else np.zeros(0)


class ValueSurvey:
    """A first pass over the values of an array, chunk by chunk."""

    def __init__(self) -> None:
        self._kind: np.dtype[Any] | None = None
        self._lo, self._hi = np.inf, -np.inf
        self._distinct: Array | None = np.zeros(0)
        self._cells = np.zeros(1 << (32 - CELLS), bool)  # of float32 numbers, the cells that some value is in
        self._usual: tuple[float, float] | None = None
        self._outside: Array | None = np.zeros(0)  # of the usual: kept as it is, while there is little of it
        self._sample: list[Array] = []
        self._stride, self._n = 1, 0

    def add(self, values: npt.ArrayLike) -> None:
        """Take in some values."""
        column = np.asarray(values)
        self._kind = column.dtype if self._kind is None else np.promote_types(self._kind, column.dtype)
        for a, b in spans(len(column)):
            self._add(column[a:b])
            forget(column, 0, b)

    def _add(self, column: Array) -> None:
        finite = column[np.isfinite(column)]
        if not len(finite):
            return
        self._lo, self._hi = min(self._lo, float(finite.min())), max(self._hi, float(finite.max()))
        self._n += len(finite)
        while self._n > self._stride * SAMPLE:
            self._sample, self._stride = [part[::2] for part in self._sample], 2 * self._stride
        self._sample.append(finite[:: self._stride].copy())
        if self._distinct is not None:
            # Numbers along a line often repeat: only where they change are they looked at.
            for some in (finite[: 1 << 16], finite[1 << 16 :]):
                if len(some) and self._distinct is not None:
                    changes = some[np.append(True, some[1:] != some[:-1])]
                    found = np.union1d(self._distinct.astype(self._kind), changes)
                    self._distinct = found if len(found) < 1 << 16 else None
        if column.dtype.kind == "f":
            if self._usual is None:
                low, high = np.quantile(finite[:: -(-len(finite) // SAMPLE)].astype(np.float64), [0.005, 0.995])
                self._usual = (2.0 * low - high, 2.0 * high - low)
            if self._outside is not None:
                outside = (finite < self._usual[0]) | (finite > self._usual[1])
                found = np.union1d(self._outside, finite[outside])
                few = len(found) < 1 << 16
                self._outside, finite = (found, finite[~outside]) if few else (None, np.append(found, finite))
            with np.errstate(over="ignore"):
                self._cells[finite.astype(np.float32).view(np.uint32) >> np.uint32(CELLS)] = True

    def coder(
        self, bits: int = 8, max_error: float | None = None, *, exact: bool = False
    ) -> ValueCoder:
        """Return how to code the values: in so many bits or more, off by so much at most, or every bit of them."""
        kind = np.dtype(np.float32) if self._kind is None else self._kind
        lo, hi = (self._lo, self._hi) if self._lo <= self._hi else (0.0, 0.0)
        sample = np.concatenate(self._sample) if self._sample else np.zeros(0, kind)
        reference = value_reference(sample)
        room = 255 if kind.kind == "f" else 256
        if self._distinct is not None and len(self._distinct) <= room:
            return ValueCoder(_full(self._distinct.astype(kind), 8), len(self._distinct), kind, lo, hi, reference)
        if self._distinct is not None and (kind.kind != "f" or (exact and kind.itemsize > 2)):
            return ValueCoder(_full(self._distinct.astype(kind), 16), len(self._distinct), kind, lo, hi, reference)
        if kind.kind != "f" or exact:
            return ValueCoder(None, 0, kind, lo, hi, reference)
        scale = _Scale.from_sample(sample.astype(np.float64), lo, hi, max_error)
        for size in (8, 16) if bits == 8 else (16,):
            # A table of a small set shall not be larger than its codes.
            entries = self._entries(scale, (1 << size) - 1, 255 if size == 8 else max(self._n // 8, 255))
            if entries is not None:
                return ValueCoder(_full(entries.astype(kind), size), len(entries), kind, lo, hi, reference)
        return ValueCoder(None, 0, kind, lo, hi, reference)

    def _entries(self, scale: _Scale, most: int, wanted: int) -> Floats | None:
        """Return at most so many entries, about as many as are wanted or the bound needs; None where that is more."""
        low, high = self._occupied()
        low, high = np.clip(low, scale.lo, scale.hi), np.clip(high, scale.lo, scale.hi)
        best, steps = None, max(1.0, np.ceil(scale.steps))
        for _ in range(40):
            first, last = np.rint(scale.at(low) * steps / scale.steps), np.rint(scale.at(high) * steps / scale.steps)
            # Cells are sorted: of one that begins in the entry where the last one ended, that entry counts once.
            first[1:] = np.maximum(first[1:], last[:-1] + 1)
            counts = np.maximum(last - first + 1, 0)
            if counts.sum() > most:
                if best is not None:
                    break
                if steps <= np.ceil(scale.steps):
                    return None
            else:
                before = np.cumsum(counts) - counts
                rows = np.repeat(first - before, counts.astype(np.int64)) + np.arange(counts.sum())
                best = scale.value(rows * scale.steps / steps)
                if counts.sum() > 0.98 * min(wanted, most):
                    break
            finer = min(wanted, most) / max(counts.sum(), 1.0)
            steps = np.floor(steps * finer) if counts.sum() <= most else np.floor(0.97 * steps)
        return best

    def _occupied(self) -> tuple[Floats, Floats]:
        """Least and largest number of each cell that some value is in, rising."""
        cells = np.flatnonzero(self._cells).astype(np.uint32)
        near = (cells << np.uint32(CELLS)).view(np.float32).astype(np.float64)
        far = ((cells << np.uint32(CELLS)) | np.uint32((1 << CELLS) - 1)).view(np.float32).astype(np.float64)
        apart = np.zeros(0) if self._outside is None else self._outside.astype(np.float64)
        low, high = np.append(np.minimum(near, far), apart), np.append(np.maximum(near, far), apart)
        order = np.argsort(low, kind="stable")
        return np.nan_to_num(low[order]), np.nan_to_num(high[order])


@dataclass(frozen=True)
class _Scale:
    """Values as numbers of steps, each twice the bound wide there."""

    lo: float
    hi: float
    width: float
    ratio: float  # of a step, below ``width / ratio``; 0 where logarithms do not count

    @classmethod
    def from_sample(cls, sample: Floats, lo: float, hi: float, max_error: float | None) -> _Scale:
        if max_error is not None:
            return cls(lo, hi, 2.0 * max_error, 0.0)
        low, high = np.quantile(sample, [0.01, 0.99]) if len(sample) else (lo, hi)
        if low == high:
            low, high = lo, hi
        width = 2.0 * float(high - low) / 255.0
        spread = lo > 0.0 and high / low > SPREAD
        return cls(lo, hi, width, 2.0 * float(np.log(high / low)) / 255.0 if spread else 0.0)

    @property
    def steps(self) -> float:
        """Steps from the least value to the largest."""
        return float(self.at(np.array([self.hi]))[0]) or 1.0

    def at(self, values: Floats) -> Floats:
        if not self.ratio:
            return (values - self.lo) / self.width
        knee = self.width / self.ratio
        below = np.log(np.minimum(values, knee) / min(self.lo, knee)) / self.ratio
        found: Floats = below + np.maximum(values - max(knee, self.lo), 0.0) / self.width
        return found

    def value(self, steps: Floats) -> Floats:
        """Return where values lie, the inverse of :meth:`at`, within the range."""
        if not self.ratio:
            found = self.lo + steps * self.width
        else:
            knee = self.width / self.ratio
            turn = max(np.log(knee / min(self.lo, knee)) / self.ratio, 0.0)
            below = min(self.lo, knee) * np.exp(np.minimum(steps, turn) * self.ratio)
            found = below + np.maximum(steps - turn, 0.0) * self.width + max(self.lo - knee, 0.0)
        return np.clip(found, self.lo, self.hi)


def _full(entries: Array, bits: int) -> Array:
    """A table of all codes: what no value has is NaN, or of integers the last entry."""
    most = 1 << bits
    rest = np.nan if entries.dtype.kind == "f" else (entries[-1] if len(entries) else 0)
    return np.append(entries, np.full(most - len(entries), rest, entries.dtype))


def value_errors(per_point: Mapping[str, PointValues]) -> dict[str, dict[str, float]]:
    """Return the largest and the mean difference of each array to its original."""
    return {name: {"max": kept.max_error, "mean": kept.mean_error} for name, kept in per_point.items()}


def value_columns(streamlines: Streamlines, names: Iterable[str]) -> Iterator[tuple[str, Array]]:
    """Yield per-point arrays by name; of one with several columns ``name[0]``, ``name[1]``, ..."""
    for name in names:
        column = np.asarray(streamlines.per_point[name])
        if column.dtype.kind not in "fiub":
            raise ValueError(f"per-point values {name!r} have the type {column.dtype}, expected real numbers")
        if column.ndim == 1 or column.shape[1] == 1:
            yield name, column.reshape(len(column))
        else:
            yield from ((f"{name}[{k}]", column[:, k]) for k in range(column.shape[1]))


def stored_table(table: Array) -> Array:
    """Return the entries that a file needs."""
    if table.dtype.kind == "f":
        return table[: int(np.flatnonzero(~np.isnan(table)).max(initial=-1)) + 1]
    return table[: int(np.searchsorted(table, table[-1])) + 1]


def opened_table(entries: Array, bits: int) -> Array:
    """Return a table of all codes of what a file has."""
    return _full(np.asarray(entries)[: 1 << bits], bits)


def linear_table(lo: float, hi: float, bits: int) -> Array:
    """Return a table of even steps in float32, as older files mean it."""
    most = (1 << bits) - 1
    even = lo + (hi - lo) * np.arange(most, dtype=np.float64) / (most - 1)
    return np.append(even, np.nan).astype(np.float32)


def code_values(values: npt.ArrayLike, bits: int = 8, *, exact: bool = False) -> PointValues:
    """Code one value per point."""
    survey = ValueSurvey()
    survey.add(values)
    return survey.coder(bits, exact=exact).code(values)


def as_codes(values: npt.ArrayLike, most_bits: int = 16) -> tuple[PointValues, Array]:
    """Code one value per point in at most so many bits, whatever that costs; with the table."""
    numbers = np.asarray(values, np.float64)
    found = code_values(numbers)
    if found.table is not None and 8 * found.codes.dtype.itemsize <= most_bits:
        return found, found.table
    n = (1 << most_bits) - 1
    table = _full(np.linspace(found.lo, found.hi, n), most_bits)
    return ValueCoder(table, n, numbers.dtype, found.lo, found.hi, found.reference).code(numbers), table
