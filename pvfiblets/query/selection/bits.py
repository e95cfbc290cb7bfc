"""Choices as bits: one for each point, one for each streamline that has points; what drawing reads.

Bit ``i % 32`` of word ``i // 32`` stands for point or rank ``i``, points in the order in which they are coded.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ...codec.point_values import PointValues
from ..measures.measures import Values

if TYPE_CHECKING:
    from ...codec.fibletset import FibletSet
    from ...streamlines import Streamlines

Words = npt.NDArray[np.uint32]
Mask = npt.NDArray[np.bool_]
SLICE = 1 << 22  # points of a mapped array that are looked at together


@dataclass(frozen=True, eq=False)
class Criterion:
    """The kept values: from ``lo`` to ``hi``, both included."""

    values: Values | PointValues | npt.ArrayLike  # per point in coded order, or per streamline
    lo: float  # infinite ends are no ends
    hi: float
    keep_nan: bool = False  # whether streamlines without a value are kept

    def __post_init__(self) -> None:
        if math.isnan(self.lo) or math.isnan(self.hi) or self.lo > self.hi:
            raise ValueError(
                f"a range from {self.lo} to {self.hi} holds nothing; give lo <= hi (infinite ends are fine)"
            )


def as_criterion(given: Criterion | tuple[Any, ...]) -> Criterion:
    """Return a criterion, also of a tuple ``(values, lo, hi)`` or ``(values, lo, hi, keep_nan)``."""
    return given if isinstance(given, Criterion) else Criterion(*given)


def point_words(fiblets: FibletSet | Streamlines, criteria: Iterable[Criterion | tuple[Any, ...]]) -> Words:
    """One bit for each point, set where every criterion holds."""
    # Values are compared as float64; coded values by the meaning of their code, without decoding.
    from .bit_kernels import keep_codes, keep_values

    n = fiblets.n_points
    words = np.full((n + 31) // 32 + 1, 0xFFFFFFFF, np.uint32)
    words[-1] = 0
    if n % 32:
        words[n // 32] = (1 << (n % 32)) - 1
    for criterion in map(as_criterion, criteria):
        values = criterion.values
        if isinstance(values, Values):
            if values.kind != "point":
                raise ValueError(f"{values.name!r} has a value per {values.kind}; values per point are needed here")
            values = values.values
        table = values.table if isinstance(values, PointValues) else None
        codes = values.codes if isinstance(values, PointValues) else np.asarray(values)
        if codes.shape != (n,):
            raise ValueError(f"values of shape {codes.shape} for {n} points; one number for each point is needed")
        for a in range(0, n, SLICE):
            # Whole words: SLICE is a multiple of 32. A copy, so that mapped arrays need no kernel of their own.
            part, piece = words[a // 32 : (min(a + SLICE, n) + 31) // 32], codes[a : a + SLICE]
            if table is not None:
                keep_codes(np.array(piece), _meets(table, criterion), part)
            else:
                number = np.array(piece, np.float64)
                keep_values(number, float(criterion.lo), float(criterion.hi), criterion.keep_nan, part)
    return words


def _meets(values: npt.NDArray[Any], criterion: Criterion) -> Mask:
    number = values.astype(np.float64)
    with np.errstate(invalid="ignore"):
        found: Mask = (number >= criterion.lo) & (number <= criterion.hi)
    return found | np.isnan(number) if criterion.keep_nan else found


def streamline_mask(fiblets: FibletSet | Streamlines, criteria: Iterable[Criterion | tuple[Any, ...]]) -> Mask:
    """Streamlines that satisfy every criterion."""
    mask = np.ones(len(fiblets), bool)
    for criterion in map(as_criterion, criteria):
        values = criterion.values
        if isinstance(values, Values):
            if values.kind != "streamline":
                raise ValueError(
                    f"{values.name!r} has a value per {values.kind}; values per streamline are needed here"
                )
            values = values.values
        if isinstance(values, PointValues):
            raise ValueError("a stored per-point array has values per point; values per streamline are needed here")
        number = np.asarray(values)
        if number.shape != mask.shape:
            raise ValueError(
                f"values of shape {number.shape} for {len(mask)} streamlines; one number for each is needed"
            )
        mask &= _meets(number, criterion)
    return mask


def stretch(words: Words, first: int, last: int) -> Words:
    """Return bits first..last of a row as a row of their own; zeros follow its end."""
    begin, shift = divmod(first, 32)
    piece = np.asarray(words[begin : -(-last // 32) + 1], np.uint32)
    if not shift:
        return piece
    following = np.append(piece[1:], np.uint32(0))
    moved: Words = (piece >> np.uint32(shift)) | (following << np.uint32(32 - shift))
    return moved


def rank_words(fiblets: FibletSet, mask: npt.ArrayLike) -> Words:
    """One bit for each streamline that has points, in the order in which they are coded."""
    chosen = np.asarray(mask)
    if chosen.dtype != bool or chosen.shape != (fiblets.n_streamlines,):
        raise ValueError(
            f"a mask of {chosen.dtype}{chosen.shape} for {fiblets.n_streamlines} streamlines; one bool for each is "
            "needed"
        )
    if fiblets.rank_to_id is not None:
        chosen = chosen[fiblets.rank_to_id]
    packed = np.packbits(chosen, bitorder="little")
    padded = np.zeros(-(-len(chosen) // 32) * 4, np.uint8)
    padded[: len(packed)] = packed
    return padded.view("<u4").astype(np.uint32)
