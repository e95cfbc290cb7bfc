"""Several sets as one, streamlines in the order of the sets.

Parts of one set share its parameters: their records are copied as they are (:mod:`.restrict`), and every point decodes
to the same bits. Sets of different parameters have different grids; they are decoded and coded again.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ...streamlines import Streamlines
from ..layout import SPLINE, coded_kind
from ..point_values import PointValues, code_values
from .restrict import Records, parts_of

if TYPE_CHECKING:
    from ..fibletset import FibletSet


def concatenate(sets: Iterable[FibletSet]) -> FibletSet:
    """Put sets behind each other."""
    all_sets = list(sets)
    if not all_sets:
        raise ValueError("there is no set to concatenate; give one or more")
    if len(all_sets) == 1:
        return all_sets[0]
    full = [one for one in all_sets if one.n_points] or all_sets[:1]
    alike = {(one.parameters, None if one.exact is None else one.exact.dtype) for one in full}
    if len(alike) == 1:
        return _copied(all_sets, full)
    if all(one.exact is not None for one in full):
        return _exactly(all_sets)
    return _coded_again(all_sets, max(one.promise for one in full))


def _rest(sets: list[FibletSet]) -> Streamlines:
    """Everything but points, joined as streamlines join it."""
    return Streamlines.concatenate(
        Streamlines(
            np.zeros((0, 3), np.float32), np.zeros(len(one) + 1, np.int64), None, one.per_streamline, one.groups,
            one.per_group, one.affine, one.space, one.dropped,
        )
        for one in sets
    )  # fmt: skip


def _copied(sets: list[FibletSet], full: list[FibletSet]) -> FibletSet:
    """Join sets of the same parameters, record by record."""
    first, rest = full[0], _rest(sets)
    bare = replace(first, per_point={})
    n_exact = 0 if first.exact is None else sum(one.n_points for one in full)
    n_fiblets, n_codes = sum(one.n_fiblets for one in full), sum(int(one.pages[-1, 1]) for one in full)
    out = Records.empty(bare, n_fiblets, n_codes, n_exact)
    for one in full:
        for part in parts_of(one, np.ones(one.n_ranks, bool)):
            out.take(replace(one, per_point={}), part)
    out.pages[-1] = out.at
    starts = np.cumsum([0, *(len(one) for one in sets)])
    numbers = [_ids(one) + start for one, start in zip(sets, starts, strict=False)]
    ids = np.concatenate(numbers)
    plain = len(ids) == len(rest) and bool((ids == np.arange(len(ids))).all())
    low, high = (np.array([one.bounds[side::2] for one in full]) for side in (0, 1))
    b = np.stack([low.min(axis=0), high.max(axis=0)], axis=1).ravel().tolist()
    return replace(
        first,
        anchors=out.anchors,
        anchors_low=out.anchors_low,
        decoding=out.decoding,
        reach=out.reach,
        codes=out.codes,
        ends=np.concatenate([one.ends for one in full]),
        pages=out.pages,
        rank_to_id=None if plain else ids,
        exact=out.exact,
        n_streamlines=len(rest),
        bounds=(b[0], b[1], b[2], b[3], b[4], b[5]),
        per_point=_values(full),
        per_streamline=rest.per_streamline,
        groups=rest.groups,
        per_group=rest.per_group,
        affine=rest.affine,
        space=rest.space,
        dropped=rest.dropped,
    )


def _ids(fiblets: FibletSet) -> npt.NDArray[np.int64]:
    """``(n_ranks,)`` number of each rank's streamline."""
    return np.arange(fiblets.n_ranks) if fiblets.rank_to_id is None else np.asarray(fiblets.rank_to_id, np.int64)


def _values(sets: list[FibletSet]) -> dict[str, PointValues]:
    """Values of all points; codes are kept where the ranges are the same."""
    _refuse_gaps([set(one.per_point) for one in sets])
    kept = {}
    for name, first in sets[0].per_point.items():
        parts = [one.per_point[name] for one in sets]
        if all(_same_table(first.table, one.table) for one in parts) and len({one.codes.dtype for one in parts}) == 1:
            n = np.array([len(one.codes) for one in parts])
            kept[name] = replace(
                first,
                codes=np.concatenate([one.codes for one in parts]),
                lo=min(one.lo for one in parts),
                hi=max(one.hi for one in parts),
                max_error=max(one.max_error for one in parts),
                mean_error=float(n @ [one.mean_error for one in parts] / max(n.sum(), 1)),
            )
        else:
            bits = 8 * max(one.codes.dtype.itemsize for one in parts if one.table is not None or one is first)
            whole = np.concatenate([one.values() for one in parts])
            kept[name] = code_values(whole, 8 if bits == 8 else 16, exact=all(not one.max_error for one in parts))
    return kept


def _same_table(one: npt.NDArray[Any] | None, other: npt.NDArray[Any] | None) -> bool:
    if one is None or other is None:
        return one is other
    return one is other or np.array_equal(one, other, equal_nan=one.dtype.kind == "f")


def _refuse_gaps(names: list[set[str]]) -> None:
    lacking = sorted(names[0].union(*names) - names[0].intersection(*names))
    if lacking:
        raise ValueError(
            f"not every set has per_point {', '.join(map(repr, lacking))}; keep the same arrays when compressing"
        )


def _whole(sets: list[FibletSet], dtype: npt.DTypeLike | None = None) -> tuple[Streamlines, Any]:
    """All streamlines, decoded, and the bits of their values."""
    whole = Streamlines.concatenate(one.decompress(dtype=dtype) for one in sets)
    return whole, 16 if any(v.codes.dtype != np.uint8 for one in sets for v in one.per_point.values()) else 8


def _exactly(sets: list[FibletSet]) -> FibletSet:
    """Join sets that keep every bit of their points."""
    from ..encoding.compress import compress

    whole, bits = _whole(sets)
    return compress(whole, exact=True, per_point=tuple(whole.per_point), per_point_bits=bits)


def _coded_again(sets: list[FibletSet], promise: float) -> FibletSet:
    from ..encoding.compress import compress

    whole, bits = _whole(sets, np.float64)
    small = all(SPLINE in coded_kind(one.decoding) for one in sets)
    made = compress(
        whole, exact=False, max_error=promise, effort="small" if small else "fast", per_point=tuple(whole.per_point),
        per_point_bits=bits,
    )  # fmt: skip
    return replace(made, parameters=replace(made.parameters, promise=2.0 * promise))
