"""Measures of streamlines and of points: what criteria compare and colours show.

====================  ===========  ====  =======================================================================
name                  a value per  unit  definition, of the decoded points
====================  ===========  ====  =======================================================================
``'length'``          streamline   mm    sum of its segments' lengths; 0 without points
``'n_points'``        streamline         number of points
``'mean_curvature'``  streamline   1/mm  mean of its points' ``'curvature'``; NaN without points
``'end_distance'``    streamline   mm    distance between its first and last point; NaN without points
``'curvature'``       point        1/mm  angle between the chords before and after over half the line along both
``'arc_length'``      point        mm    length of the streamline up to the point
``'coding_error'``    point        mm    distance to the point it was coded from, which must be given
a stored array        either             as it is stored, under the name that it has
:class:`Distance`     either       mm    distance to a region or position, or a streamline's least one
an image              point              its value there, as it colours: whole numbers of the nearest voxel
====================  ===========  ====  =======================================================================

Curvature does not depend on how a set is stored. A tenth of a step, which coding may move points by, would turn each
segment by a tenth of a radian; so chords of a streamline are long enough for such an error (or the set's error
bound where that is coarser) to change its mean curvature by no more than 2 %, of coded sets and of exact ones
alike: over ``2 sqrt(error / curvature)`` mm at least. The points at its ends take the value of the nearest one that has
both chords; of fewer than three points it is 0. A warning tells where coded lines are too short or too bent for that,
or the error bound is coarser than a tenth of a step, and the `max_error` that is needed.

Values per point stand in the order in which points are coded. Stored arrays come before the names above, as
they do for colours.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Literal, Self

import numpy as np
import numpy.typing as npt

from ...codec.files.stored_parts import stored_parts
from ...codec.parameters import DEFAULT_PROMISE_STEPS, median_step
from ...codec.point_values import PointValues
from ...images.sources import as_image, is_image
from ...streamlines import Streamlines
from ..regions.region import Region
from .chunks import CHUNK

if TYPE_CHECKING:
    from ...codec.fibletset import FibletSet

Kind = Literal["streamline", "point"]
Floats = npt.NDArray[np.float64]
CODING_ERROR = "coding_error"
CURVATURE = "_curvature"  # attribute of a set, no field of it: a set that is made of another has other points
SLACK = 0.99  # of an error bound: it is a tenth of a step but for rounding
UNCERTAIN = 0.05  # of the streamlines may be too short for their curvature: every set has some

COMPUTED: dict[Kind, dict[str, str]] = {
    "streamline": {"length": "mm", "n_points": "", "mean_curvature": "1/mm", "end_distance": "mm"},
    "point": {"curvature": "1/mm", "arc_length": "mm", "coding_error": "mm"},
}
"""Units of the computed measures, by kind (point or streamline) and name."""


@dataclass(frozen=True, eq=False)
class Values:
    """A value for each streamline or each point."""

    kind: Kind  # streamlines or points
    # `(n_streamlines,)` float64; or `(n_points,)` float32 in coded order, codes where the set stores them
    values: npt.NDArray[Any] | PointValues
    name: str  # `unit` is empty where there is none or it is not known
    unit: str = ""

    def array(self) -> npt.NDArray[Any]:
        """The values as numbers: ``(n_streamlines,)`` float64 or ``(n_points,)`` float32."""
        return self.values.values() if isinstance(self.values, PointValues) else self.values

    def range(self) -> tuple[float, float]:
        """Least and greatest finite value; ``(0.0, 0.0)`` where there is none."""
        if isinstance(self.values, PointValues):
            return float(self.values.lo), float(self.values.hi)
        finite = self.values[np.isfinite(self.values)]
        return (float(finite.min()), float(finite.max())) if finite.size else (0.0, 0.0)


@dataclass(frozen=True, init=False)
class Distance:
    """Distance to a region (0 inside) or to a position.

    Parameters
    ----------
    what : Region or array_like
        A region that has distances (:meth:`.Region.distance`), or ``(3,)`` mm.
    per : {'streamline', 'point'}
        ``'streamline'``: the smallest distance of the streamline's points. ``'point'``: the distance of each point.

    Raises
    ------
    ValueError
        If the position is not three finite numbers, or `per` is unknown.
    """

    what: Region | tuple[float, float, float]
    per: Kind

    def __init__(self, what: Region | npt.ArrayLike, per: Kind = "streamline") -> None:
        if per not in ("streamline", "point"):
            raise ValueError(f"per is {per!r}; give 'streamline' or 'point'")
        if not isinstance(what, Region):
            position = np.array(what, np.float64)
            if position.shape != (3,) or not np.isfinite(position).all():
                raise ValueError(f"a distance to {what!r}; give a region, or a position as three finite numbers of mm")
            what = (float(position[0]), float(position[1]), float(position[2]))
        object.__setattr__(self, "what", what)
        object.__setattr__(self, "per", per)

    def at_points(self, points: npt.NDArray[Any]) -> Floats:
        """Return the distances of positions ``(n, 3)``: ``(n,)`` float64, mm."""
        if isinstance(self.what, Region):
            return self.what.distance(points)
        apart: Floats = np.linalg.norm(points - np.array(self.what), axis=1)
        return apart


def measure_names(fiblets: FibletSet | Streamlines, kind: Kind | None = None) -> list[str]:
    """Names that :func:`measure` takes: computed ones, then the stored arrays of single numbers."""
    names: list[str] = []
    if kind != "point":
        names += [*COMPUTED["streamline"], *(k for k, v in fiblets.per_streamline.items() if _is_scalar(v))]
    if kind != "streamline":
        coded = not isinstance(fiblets, Streamlines)
        names += [name for name in COMPUTED["point"] if coded or name != CODING_ERROR]
        names += [k for k, v in fiblets.per_point.items() if coded or _is_scalar(np.asarray(v))]
    return list(dict.fromkeys(names))


def _is_scalar(rows: npt.NDArray[Any]) -> bool:
    return rows.dtype.kind in "biuf" and (rows.ndim == 1 or rows.shape[1:] == (1,))


def measure(
    fiblets: FibletSet | Streamlines,
    what: str | Distance | Values | npt.ArrayLike,
    *,
    original: Streamlines | None = None,
) -> Values:
    """Measure every streamline or every point, of compressed or other streamlines."""
    if isinstance(what, Values):
        return what
    try:
        return _measured(fiblets, what, original)
    except IndexError:
        if not isinstance(fiblets, Streamlines):
            fiblets.verify()  # raises for a damaged file; other errors pass
        raise


def _measured(
    fiblets: FibletSet | Streamlines, what: str | Distance | npt.ArrayLike, original: Streamlines | None
) -> Values:
    if isinstance(what, Distance):
        return _distance(fiblets, what)
    stored = isinstance(what, str) and (what in fiblets.per_streamline or what in fiblets.per_point)
    if not stored and is_image(what):
        image = as_image(what)
        dtype = np.promote_types(image.single.dtype, np.float32)  # of times, float32 keeps minutes
        values = _per_point(fiblets, lambda _, chunk: image.at(chunk.points), dtype)
        return Values("point", values, image.name or "values")
    if not isinstance(what, str):
        return _own(fiblets, what)
    rows = fiblets.per_streamline.get(what)
    if original is None and rows is not None and _is_scalar(rows):
        return Values("streamline", np.asarray(rows, np.float64).reshape(len(rows)), what)
    column = fiblets.per_point.get(what)
    if original is None and column is not None and (isinstance(column, PointValues) or _is_scalar(column)):
        return Values("point", column if isinstance(column, PointValues) else column.reshape(len(column)), what)
    for kind, units in COMPUTED.items():
        if what in units and not (what == CODING_ERROR and isinstance(fiblets, Streamlines)):
            return Values(kind, _computed(fiblets, what, original), what, units[what])
    kept = f". Compression left it out: keep it by per_point=[{what!r}]" if _is_left_out(fiblets, what) else ""
    raise KeyError(f"there is no measure {what!r}; there are {', '.join(measure_names(fiblets))}{kept}")


def _is_left_out(fiblets: FibletSet | Streamlines, name: str) -> bool:
    said = next((reason for reason in fiblets.dropped if reason.startswith("per-point arrays not kept (")), "()")
    return name in said[said.index("(") + 1 : -1].split(", ")


def _own(fiblets: FibletSet | Streamlines, given: npt.ArrayLike) -> Values:
    try:
        rows = np.asarray(given)
    except ValueError:  # of rows of unlike lengths
        rows = np.asarray(given, object)
    if rows.shape == (len(fiblets),) and rows.dtype.kind in "biuf":
        return Values("streamline", rows.astype(np.float64), "values")
    if rows.shape == (fiblets.n_points,) and rows.dtype.kind in "biuf":
        kept = np.float32 if rows.dtype in (np.float32, np.float16) else np.float64  # of times, float32 keeps minutes
        ordered = rows if isinstance(fiblets, Streamlines) else fiblets.in_coded_order(rows)
        return Values("point", ordered.astype(kept), "values")
    raise ValueError(
        f"values of {rows.dtype}{rows.shape}; one number for each of the {len(fiblets)} streamlines or "
        f"{fiblets.n_points} points is needed"
    )


# ------------------------------------------------------------------------------------------------------ chunk by chunk


def by_rank(fiblets: FibletSet) -> FibletSet:
    """The streamlines that have points, in the order in which they are coded, and nothing else."""
    return replace(
        fiblets,
        rank_to_id=None,
        n_streamlines=fiblets.n_ranks,
        per_point={},
        per_streamline={},
        groups={},
        per_group={},
    )


def decoded_by_rank(fiblets: FibletSet, most: int, dtype: npt.DTypeLike) -> Iterator[Streamlines]:
    """Decode the streamlines that have points in the order in which they are coded, shard after shard."""
    from ...codec.decompress import iter_chunks

    for part, _ in stored_parts(fiblets):
        if part.n_ranks:
            yield from iter_chunks(by_rank(part), most, dtype)


def _coded_chunks(fiblets: FibletSet | Streamlines) -> Iterator[tuple[int, int, Streamlines]]:
    """Yield first rank, first point and float64 streamlines, in coded order."""
    if isinstance(fiblets, Streamlines):
        if fiblets.n_points:
            begins = fiblets.offsets[:-1][fiblets.counts > 0]
            yield 0, 0, Streamlines(np.asarray(fiblets.points, np.float64), np.append(begins, fiblets.n_points))
        return
    rank = point = 0
    for chunk in decoded_by_rank(fiblets, CHUNK, np.float64):
        yield rank, point, chunk
        rank, point = rank + len(chunk), point + chunk.n_points


def _per_point(
    fiblets: FibletSet | Streamlines, make: Callable[[int, Streamlines], Any], kept: npt.DTypeLike = np.float32
) -> npt.NDArray[Any]:
    out = np.empty(fiblets.n_points, kept)
    for rank, point, chunk in _coded_chunks(fiblets):
        out[point : point + chunk.n_points] = make(rank, chunk)
    return out


def _per_streamline(
    fiblets: FibletSet | Streamlines, make: Callable[[Streamlines], Any], without: float
) -> Floats:
    found = [np.asarray(make(chunk), np.float64) for _, _, chunk in _coded_chunks(fiblets)]
    return _placed(fiblets, np.concatenate(found) if found else np.empty(0), without)


def _placed(fiblets: FibletSet | Streamlines, ranked: Floats, without: float) -> Floats:
    """Values of ranks as values of streamlines; those without points get one of their own."""
    ids = np.flatnonzero(fiblets.counts) if isinstance(fiblets, Streamlines) else fiblets.rank_to_id
    if ids is None:
        return ranked
    out = np.full((len(fiblets), *ranked.shape[1:]), without)
    out[ids] = ranked
    return out


class Curvatures:
    """Curvature of streamlines, chunk by chunk; as a context, it warns in the end of what could not be measured."""

    def __init__(self, data: FibletSet | Streamlines) -> None:
        if isinstance(data, Streamlines):
            step, self._promise = median_step(data), 0.0
        else:
            step, self._promise = data.step, data.points_promise
        self._fine = DEFAULT_PROMISE_STEPS * step
        self._bears: list[Floats] = []

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        if kind is not None or not self._promise or not self._bears:
            return
        bears = np.concatenate(self._bears)
        short = bears[bears < self._promise * SLACK]
        if 0.0 < self._fine < self._promise * SLACK:
            why, needed = "needs chords longer than the segments", self._fine
        elif len(short) > UNCERTAIN * len(bears):
            why = f"is lost in {len(short)} of {len(bears)} streamlines, which are too short or too bent"
            needed = max(float(np.quantile(short, UNCERTAIN)), 0.01 * self._promise)
        else:
            return
        warnings.warn(
            f"points may be {self._promise:.3g} mm off, and curvature {why}: to have it within 2 %, compress with "
            f"max_error={needed:.2g}, or exact=True",
            stacklevel=4,
        )

    def points(self, points: npt.NDArray[np.floating[Any]], offsets: npt.NDArray[np.int64]) -> npt.NDArray[np.float32]:
        """Curvature of each of some streamlines' float64 points, ``(n_points,)``, 1/mm."""
        from . import measure_kernels as kernels

        each, bears = np.empty(len(points), np.float32), np.empty(len(offsets) - 1)
        kernels.curvatures(points, offsets, max(self._fine, self._promise), each, bears)
        self._bears.append(bears)
        return each

    def means(self, points: npt.NDArray[np.floating[Any]], offsets: npt.NDArray[np.int64]) -> Floats:
        """Mean of the curvature of each streamline's points, ``(n,)``, 1/mm; NaN without points."""
        from . import measure_kernels as kernels

        out = np.empty(len(offsets) - 1)
        kernels.means(self.points(points, offsets), offsets, out)
        return out


def _computed(fiblets: FibletSet | Streamlines, name: str, original: Streamlines | None) -> npt.NDArray[Any]:
    from . import measure_kernels as kernels

    def arc_lengths(_: int, chunk: Streamlines) -> npt.NDArray[np.float32]:
        out = np.empty(chunk.n_points, np.float32)
        kernels.arc_lengths(chunk.points, chunk.offsets, out)
        return out

    if name == "length":
        return _per_streamline(fiblets, lambda chunk: chunk.lengths(), 0.0)
    if name == "n_points":
        counts = fiblets.counts if isinstance(fiblets, Streamlines) else np.diff(fiblets.offsets())
        return counts.astype(np.float64)
    if name == "mean_curvature":
        with Curvatures(fiblets) as found:
            return _per_streamline(fiblets, lambda chunk: found.means(chunk.points, chunk.offsets), np.nan)
    if name == "end_distance":
        if isinstance(fiblets, Streamlines):
            return _per_streamline(fiblets, _end_distances, np.nan)
        from ..selection.endpoints import end_points

        ends = end_points(fiblets)
        apart: Floats = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
        return apart
    if name == "curvature":
        return curvature_values(fiblets)
    if name == "arc_length":
        return _per_point(fiblets, arc_lengths)
    assert not isinstance(fiblets, Streamlines)
    return _coding_error(fiblets, original)


def _end_distances(lines: Streamlines) -> Floats:
    apart: Floats = np.linalg.norm(lines.points[lines.offsets[1:] - 1] - lines.points[lines.offsets[:-1]], axis=1)
    return apart


def curvature_values(fiblets: FibletSet | Streamlines) -> npt.NDArray[np.float32]:
    """Curvature at every point, in coded order, measured once a set: tables, criteria and colours have the same."""
    found: npt.NDArray[np.float32] | None = fiblets.__dict__.get(CURVATURE)
    if found is None:
        with Curvatures(fiblets) as curvatures:
            found = _per_point(fiblets, lambda _, chunk: curvatures.points(chunk.points, chunk.offsets))
        fiblets.__dict__[CURVATURE] = found
    return found


def _distance(fiblets: FibletSet | Streamlines, what: Distance) -> Values:
    from . import measure_kernels as kernels

    def least(chunk: Streamlines) -> Floats:
        out = np.empty(len(chunk))
        kernels.least(what.at_points(chunk.points), chunk.offsets, out)
        return out

    values: npt.NDArray[Any]
    if what.per == "point":
        values = _per_point(fiblets, lambda _, chunk: what.at_points(chunk.points))
    else:
        values = _per_streamline(fiblets, least, np.nan)
    return Values(what.per, values, "distance", "mm")


def _coding_error(fiblets: FibletSet, original: Streamlines | None) -> npt.NDArray[np.float32]:
    if original is None:
        raise ValueError("'coding_error' is a distance to the compressed streamlines; pass these as original=")
    if len(original) != fiblets.n_streamlines or not np.array_equal(original.offsets, fiblets.offsets()):
        raise ValueError(
            f"the original has {len(original)} streamlines of {original.n_points} points, the fiblets "
            f"{fiblets.n_streamlines} of {fiblets.n_points}, or they differ in the points of some streamline: "
            "errors can be measured only against the compressed streamlines"
        )
    # What was left out of the source has no rank, and neither has a streamline without points.
    given = fiblets.rank_to_id

    def errors(rank: int, chunk: Streamlines) -> Floats:
        last = rank + len(chunk)
        if fiblets.in_order:  # consecutive, but for streamlines without points
            ids = (rank, last - 1) if given is None else (int(given[rank]), int(given[last - 1]))
            points = original.points[original.offsets[ids[0]] : original.offsets[ids[1] + 1]]
        else:
            assert given is not None
            points = original[np.asarray(given[rank:last])].points
        apart: Floats = np.linalg.norm(chunk.points - points.astype(np.float64), axis=1)
        return apart

    return _per_point(fiblets, errors)
