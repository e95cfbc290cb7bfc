"""Streamlines to a FibletSet in memory."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal, TypeAlias

import numpy as np

from ...invalid_points import Invalid, valid_points
from ...streamlines import Streamlines
from ...support.progress_bar import progress_bar
from .. import parameters as limits
from ..fibletset import FibletSet
from ..layout import WORDS
from ..parameters import CUT_SHARE, DEFAULT_ANGLE, Effort, Parameters, Survey, bounds_of, survey, tell_far
from ..point_values import PointValues, ValueCoder, ValueSurvey, value_columns
from .exact import plain_records, raw_bytes
from .ordering import Order, check_order, hilbert_order
from .record_writer import FibletChunk, RecordWriter, join

CHUNK_POINTS = 2_000_000
LARGEST_FIT = 16
"""Most bytes a point of per-point values where per_point is 'fit': a tensor at one byte a number, and some more."""

PerPoint: TypeAlias = Sequence[str] | Literal["all", "fit", "none"]
"""Which per-point arrays to keep: their names, all, as many as fit into LARGEST_FIT bytes a point, or none."""


@dataclass(frozen=True)
class ValueBounds:
    """In how many bits values of points are kept at least, and how far off they may be."""

    bits: int = 8
    most: float | Mapping[str, float] | None = None

    def __post_init__(self) -> None:
        named = self.most.items() if isinstance(self.most, Mapping) else [("max_value_error", self.most)]
        for name, most in named:
            if most is not None and not (isinstance(most, (int, float)) and 0.0 < most < math.inf):
                what = f"max_value_error of {name!r}" if isinstance(self.most, Mapping) else name
                raise ValueError(f"{what} is {most!r}; a positive number in the array's unit is needed")

    def bound_of(self, name: str) -> float | None:
        """Return the bound of an array, or of the one that a column is of."""
        if not isinstance(self.most, Mapping):
            return self.most
        return self.most.get(name, self.most.get(name.partition("[")[0]))


def compress(
    streamlines: Streamlines,
    *,
    step: float | Literal["auto"] = "auto",
    max_error: float | None = None,
    max_angle: float | None = DEFAULT_ANGLE,
    effort: Effort = "fast",
    order: Order = "input",
    per_point: PerPoint = (),
    per_point_bits: int = 8,
    max_value_error: float | Mapping[str, float] | None = None,
    exact: bool | None = None,
    nan: Invalid = "split",
    progress: bool = False,
) -> FibletSet:
    """Compress streamlines into fiblets.

    Streamlines of (nearly) constant step take one byte a point, 22 bytes per 60 points and 4 per streamline, at a mean
    error of about a hundredth of a step; any other line is kept point for point on a lattice, at two to four bytes a
    point. The method is chosen for every 60 points, and the error bound always holds.

    Sets of less than a megabyte keep every bit of their points, and so do sets that compression would enlarge, such
    as lines of two points (:mod:`pvfiblets.codec.encoding.exact`).

    Parameters
    ----------
    streamlines : Streamlines
        Points in mm, RAS+. Other kinds of lines are converted to Streamlines first.
    step : float or 'auto'
        'auto' keeps every point. A number resamples each streamline to points that lie this far apart along it, mm, its
        two ends kept, and points between them where the line would otherwise be farther away than a quarter of the
        promise.
    max_error : float, optional
        Error bound in mm: no decoded point is farther from its original; for resampled lines, no point of one line
        from the other. Default: a tenth of the median step. Where steps
        vary, or are longer than a 20th of the diagonal of the bounds, it is no more than a 4000th of that diagonal as
        seen along any of the axes: half a pixel of a full-screen view. Where units differ, such as degrees beside
        metres, it is no more than a tenth of the steps that are seen along an axis either.
    max_angle : float, optional
        Largest angle between the tangents of the original and of the decoded line, degrees, up to 90, at both ends of
        every segment longer than a pixel of a full-screen view (a 2000th of the diagonal of the bounds). Fiblets that
        would exceed it are coded more finely, and fiblets begin where lines bend little, as far as the format allows;
        :func:`pvfiblets.measure_error` returns the angles as drawn. None sets no bound, for fewer bytes if
        `max_error` is coarse.
    effort : {'fast', 'high', 'small'}
        'high' looks ahead with a beam while coding: a tenth of the speed for a lower mean error at the same bytes.
        'small' codes points of even steps as cubic splines where these take fewer bytes: 0.5 to 0.85 times the bytes
        in all, at the same bounds, with mean errors that are mostly 4 to 11 times as large.
    order : {'input', 'hilbert'}
        'hilbert' codes streamlines along a space-filling curve (:mod:`pvfiblets.codec.encoding.ordering`): pages become
        compact in space, which culling of very large sets gains from. Whatever is decoded comes in the order of the
        input; 8 bytes a streamline remember it.
    per_point : sequence of str, or {'all', 'fit', 'none'}
        Names of per-point arrays to keep; 'fit' keeps them in their order, each that still fits into 16 bytes a point.
        None by default. ``dropped`` names the others.
    per_point_bits : {8, 16}
        Bits for each of those values, or more where the bound needs them.
    max_value_error : float or dict of str to float, optional
        Largest difference of a kept value to its original, in the array's unit, for all arrays or by name. By default
        1/255 of the range from the array's 1st to its 99th percentile, so that colours over that range move by a level
        at most; of positive values over more than two decades, 1/255 of their logarithms' range. Integers, categories,
        arrays of up to 255 different numbers and all values of exact sets are exact.
    exact : bool, optional
        Keep every bit of the points. By default so where they take less than a megabyte and none is given of `step`,
        `max_error`, `max_angle`, `effort` or `order`; and where coding would take more bytes than the points do, up to
        a gigabyte of them. False codes in any case.
    nan : {'split', 'drop', 'error'}
        Treatment of points that are not finite. ``'split'``, as :func:`pvfiblets.read` does: the line ends there and
        goes on behind them as another streamline with the same data. ``'drop'``: the line goes straight across the
        gap. ``'error'``: a ValueError. ``dropped`` counts the points and the added streamlines.
    progress : bool
        Show a progress bar.

    Returns
    -------
    FibletSet
        With all per-streamline data, groups and headers.

    Raises
    ------
    ValueError
        For points that are not finite if `nan` is ``'error'``, a step or promise that is not a positive number, an
        angle that is not between 0 and 90, an unknown effort or order, or a per-point name that the streamlines do not
        have (the error lists those they have).

    Notes
    -----
    Paper: Schertzer et al., "Fiblets for Real-Time Rendering of Massive Brain Tractograms", 2022, section 3.2 and
    appendix A, with the changes that :mod:`pvfiblets.codec.direction_codebook` states.
    """
    if not isinstance(streamlines, Streamlines):
        raise TypeError(
            f"compress takes pvfiblets.Streamlines, got {type(streamlines).__name__}; "
            "pvfiblets.read(path) or Streamlines.from_list(arrays) makes one"
        )
    streamlines = valid_points(streamlines, nan)
    per_point = choose_per_point(streamlines, per_point, per_point_bits)
    how = ValueBounds(per_point_bits, max_value_error)
    check_order(order)
    plain = is_plain(step, max_error, max_angle, effort, order)
    check_exact(exact, step, order, max_error)
    if exact or (exact is None and plain and raw_bytes(streamlines) < limits.EXACT_BELOW):
        return _kept_exactly(streamlines, survey([streamlines], per_point), per_point, how)
    promise = None
    if step != "auto":
        from .resample import resample  # compiled code: most sets need none

        promise = Parameters.choose(survey([resample(streamlines, step)]), max_error).promise
        streamlines = resample(streamlines, step, CUT_SHARE * promise)
    found = survey([streamlines], per_point)
    if promise is None:
        parameters = Parameters.choose(found, max_error)
    else:
        parameters = Parameters.of_resampled(found, promise, float(step))
    from .encode import Encoder  # which needs a compiler

    encoder = Encoder(parameters, effort, max_angle)
    coded, ids = streamlines, None
    if order == "hilbert":
        ids = hilbert_order(streamlines)
        values = {name: streamlines.per_point[name] for name in per_point}
        coded = Streamlines(streamlines.points, streamlines.offsets, per_point=values)[ids]
    with progress_bar(progress, total=coded.n_points, unit="points", unit_scale=True) as bar:
        chunks: list[FibletChunk] = []
        for chunk in split_chunks(coded):
            chunks += encoder.parts(chunk)
            bar.update(chunk.n_points)
    if exact is None and step == "auto" and grows(encoder, raw_bytes(streamlines)):
        return _kept_exactly(streamlines, found, per_point, how)
    tell_far(found)
    return FibletSet(
        parameters=encoder.parameters if promise is None else replace(encoder.parameters, promise=promise),
        pages=encoder.page_table(),
        rank_to_id=encoder.rank_to_id() if ids is None else ids,
        bounds=bounds_of(found),
        per_point=code_chosen(coded, found, per_point, how),
        **_rest(streamlines, per_point),
        **join(chunks),
    )


def grows(coded: RecordWriter, raw: int) -> bool:
    """Whether streamlines took more bytes to code than they have, so few that they can be kept as they are."""
    anchor = WORDS["anchors"] * 4 + (6 if coded.parameters.anchor_bits == 32 else 0)
    record = anchor + WORDS["decoding"] * 4 + 2
    return coded.n_fiblets * record + coded.n_codes + 4 * coded.n_ranks >= raw and 0 < raw <= limits.EXACT_UP_TO


def is_plain(*choices: Any) -> bool:
    """Return True if ``step, max_error, max_angle, effort, order`` are the defaults."""
    return choices == ("auto", None, DEFAULT_ANGLE, "fast", "input")


def check_exact(exact: bool | None, step: float | str, order: str, max_error: float | None) -> None:
    """Refuse arguments that would change exact points, and an error bound for them."""
    if not any(exact is known for known in (None, True, False)):
        raise ValueError(f"exact is {exact!r}; True, False or None is needed")
    if exact and max_error is not None:
        raise ValueError(f"exact=True keeps every bit of the points; leave max_error={max_error!r} out, or exact")
    if exact and (step != "auto" or order != "input"):
        what = f"step={step!r}" if step != "auto" else f"order={order!r}"
        raise ValueError(f"exact=True keeps the points as they are, and {what} would change them or their order")


def _kept_exactly(streamlines: Streamlines, found: Survey, per_point: Sequence[str], how: ValueBounds) -> FibletSet:
    tell_far(found)
    return FibletSet(
        bounds=bounds_of(found),
        per_point=code_chosen(streamlines, found, per_point, how, exact=True),
        **_rest(streamlines, per_point),
        **plain_records(streamlines, Parameters.of_exact(found)),
    )


def _rest(streamlines: Streamlines, per_point: Sequence[str]) -> dict[str, Any]:
    """Return the data that are kept whole, as fields of a FibletSet."""
    return {
        "n_streamlines": len(streamlines),
        "per_streamline": {k: np.asarray(v) for k, v in streamlines.per_streamline.items()},
        "groups": {k: np.asarray(v) for k, v in streamlines.groups.items()},
        "per_group": {k: dict(v) for k, v in streamlines.per_group.items()},
        "affine": np.asarray(streamlines.affine, np.float64),
        "space": dict(streamlines.space or {}),
        "dropped": {**streamlines.dropped, **not_kept(streamlines, per_point)},
    }


def split_chunks(streamlines: Streamlines, max_points: int = CHUNK_POINTS) -> Iterator[Streamlines]:
    """Whole streamlines, at most ``max_points`` at a time (or one, where it alone has more), without their data."""
    offsets = np.asarray(streamlines.offsets)
    n = len(streamlines)
    a = 0
    while a < n:
        b = int(np.searchsorted(offsets, offsets[a] + max_points, side="right")) - 1
        b = min(max(b, a + 1), n)
        yield Streamlines(streamlines.points[offsets[a] : offsets[b]], offsets[a : b + 1] - offsets[a])
        a = b


def choose_per_point(streamlines: Streamlines, per_point: PerPoint, bits: int) -> tuple[str, ...]:
    """Return the names of the per-point arrays to keep."""
    if bits not in (8, 16):
        raise ValueError(f"per_point_bits is {bits}; 8 or 16 is needed")
    if isinstance(per_point, str):
        if per_point not in ("all", "fit", "none"):
            raise ValueError(
                f"per_point is the text {per_point!r}; a list of names is needed: [{per_point!r}], or 'all', 'fit' or "
                "'none'"
            )
        kept, room = [], {"all": math.inf, "fit": LARGEST_FIT, "none": -1}[per_point]
        for name, values in streamlines.per_point.items():
            size = int(np.prod(values.shape[1:])) * bits // 8
            if size <= room and (per_point == "all" or values.dtype.kind in "biuf"):
                kept.append(name)
                room -= size
        return tuple(kept)
    for name in per_point:
        if name not in streamlines.per_point:
            have = ", ".join(sorted(streamlines.per_point)) or "none"
            raise ValueError(f"there is no per-point array {name!r}; the streamlines have: {have}")
    return tuple(dict.fromkeys(per_point))


def not_kept(streamlines: Streamlines, per_point: Sequence[str]) -> dict[str, int]:
    """Return per-point arrays that stay behind as ``dropped`` lists them: a reason that names them, their number."""
    names = [name for name in streamlines.per_point if name not in per_point]
    return {f"per-point arrays not kept ({', '.join(names)})": len(names)} if names else {}


def code_chosen(
    streamlines: Streamlines, found: Survey, per_point: Iterable[str], how: ValueBounds, *, exact: bool = False
) -> dict[str, PointValues]:
    """Code the named per-point arrays."""
    columns = dict(value_columns(streamlines, per_point))
    coders = value_coders(found, columns, how, exact=exact)
    return {name: coders[name].code(column) for name, column in columns.items()}


def value_coders(
    found: Survey, names: Iterable[str], how: ValueBounds, *, exact: bool = False
) -> dict[str, ValueCoder]:
    """Return how the columns of per-point arrays are coded, by what a survey has found of them."""
    surveys = {name: found.values.get(name, ValueSurvey()) for name in names}
    return {name: one.coder(how.bits, how.bound_of(name), exact=exact) for name, one in surveys.items()}
