"""Streamlines for density maps, a part at a time: from compressed sets, from memory and from files of any format."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
import numpy.typing as npt

from ... import formats
from ...codec.decompress import decode_fiblets, held_in_bounds
from ...codec.fibletset import FibletSet
from ...codec.files.stored_parts import stored_parts
from ...codec.point_values import PointValues
from ...codec.progress import Progress, shown
from ...images.image import Image
from ...images.sources import as_image, is_image
from ...invalid_points import CUT, NONFINITE, valid_points
from ...streamlines import Streamlines
from ...support.summary import counting, warn_of_losses
from ..measures.chunks import without_groups
from ..measures.measures import Distance, Values, decoded_by_rank, measure

if TYPE_CHECKING:
    from collections.abc import Mapping

Floats = npt.NDArray[np.float64]

Wanted = str | Distance | Values | npt.ArrayLike | None

CHUNK = 1 << 19  # points decoded together
ANY = 1 << 62  # an unknown number of streamlines


@dataclass(frozen=True)
class Part:
    """Some streamlines."""

    points: Floats  # `(n_points, 3)` float64, mm
    offsets: npt.NDArray[np.int64]  # `(n + 1,)` int64
    weights: Floats  # `(n,)` float64
    values: Floats  # `(n_points,)` or `(n,)` float64; empty where none are wanted


class Source(Protocol):
    """The source of density maps."""

    name: str  # name of the values
    unit: str
    per_point: bool  # whether values are of points, or of streamlines

    @property
    def most_streamlines(self) -> int:
        """At most how many streamlines there are."""

    def box(self, progress: Progress) -> tuple[Floats, Floats]:
        """Return the corners ``(3,)`` of a box about all points, mm."""

    def parts(self, progress: Progress) -> Iterator[Part]:
        """Yield all streamlines in the order in which they are kept."""

    def compile(self) -> None:
        """Compile the kernels of :meth:`parts`."""


def as_source(source: Any, weights: Any, wanted: Wanted) -> Source:
    """Return what goes through the streamlines of something, with weights and values."""
    if isinstance(source, (str, os.PathLike)):
        path = os.fspath(source)
        if formats.registry.suffix_of(path) != ".fiblets":
            facts = formats.info(path)
            known = facts.get("streamlines"), facts.get("points")
            return _Plain(partial(formats.iter_chunks, path, CHUNK), path, known, weights, wanted)
        source = FibletSet.open(path)
    if isinstance(source, FibletSet):
        return _Compressed(source, weights, wanted)
    if isinstance(source, Streamlines):
        lines = valid_points(source, "split")
        if lines is not source:
            cut = {reason: lines.dropped[reason] for reason in (NONFINITE, CUT) if reason in lines.dropped}
            warn_of_losses("the streamlines", cut, stacklevel=3)
        spans = list(lines.blocks(CHUNK))
        known, lines = (len(lines), lines.n_points), without_groups(lines)
        return _Plain(lambda: (lines[a:b] for a, b in spans), "the streamlines", known, weights, wanted)
    raise TypeError(
        f"source is a {type(source).__name__}; give a FibletSet, Streamlines, or the path of a tractogram; "
        "lines of PyVista are lines.fiblets.to_streamlines()"
    )


class _Compressed:
    """A compressed set: streamlines with points, in coded order."""

    def __init__(self, fiblets: FibletSet, weights: Any, wanted: Wanted) -> None:
        self._fiblets = fiblets
        n = fiblets.n_streamlines
        self._weights = None if weights is None else _weights(weights, fiblets.per_streamline, n)
        self._values = None if wanted is None else measure(fiblets, wanted)
        self.name = "" if self._values is None else self._values.name
        self.unit = "" if self._values is None else self._values.unit
        self.per_point = self._values is not None and self._values.kind == "point"

    @property
    def most_streamlines(self) -> int:
        return self._fiblets.n_ranks

    def box(self, progress: Progress) -> tuple[Floats, Floats]:  # noqa: ARG002 - it is known
        if not self._fiblets.n_points:
            return np.zeros(3), np.zeros(3)
        ends = np.array(self._fiblets.bounds, np.float64).reshape(3, 2)
        return ends[:, 0], ends[:, 1]

    def parts(self, progress: Progress) -> Iterator[Part]:
        fiblets, rank, point = self._fiblets, 0, 0
        if not fiblets.n_ranks:
            return
        ids = fiblets.rank_to_id
        decoded = held_in_bounds(fiblets, decoded_by_rank(fiblets, CHUNK, np.float64))
        for chunk in shown(decoded, fiblets.n_points, "adding up", progress):
            ranks, points = slice(rank, rank + len(chunk)), slice(point, point + chunk.n_points)
            yield Part(
                chunk.points.astype(np.float64, copy=False),
                chunk.offsets,
                self._of_streamlines(self._weights, ranks, ids, np.ones(len(chunk))),
                self._chosen_values(ranks, points, ids),
            )
            rank, point = ranks.stop, points.stop

    def _chosen_values(self, ranks: slice, points: slice, ids: Any) -> Floats:
        if self._values is None:
            return np.empty(0)
        kept = self._values.values
        if not self.per_point:
            assert isinstance(kept, np.ndarray)
            return self._of_streamlines(kept, ranks, ids, np.empty(0))
        rows = kept.values(points) if isinstance(kept, PointValues) else kept[points]
        return rows.astype(np.float64)

    @staticmethod
    def _of_streamlines(rows: Floats | None, ranks: slice, ids: Any, otherwise: Floats) -> Floats:
        if rows is None:
            return otherwise
        return np.array(rows[ranks if ids is None else ids[ranks]], np.float64)

    def compile(self) -> None:
        """Compile the decoder by decoding nothing."""
        none = np.empty(0, np.int64)
        decode_fiblets(next(stored_parts(self._fiblets))[0], none, none, np.empty((0, 3)))


class _Plain:
    """Streamlines that are not compressed, as they come."""

    def __init__(
        self,
        chunks: Callable[[], Iterator[Streamlines]],
        place: str,
        known: tuple[int | None, int | None],
        weights: Any,
        wanted: Wanted,
    ) -> None:
        if isinstance(wanted, (Values, Distance)):
            raise TypeError(
                f"contrast is a {type(wanted).__name__}, which is for compressed sets; compress {place} first"
            )
        self._chunks, self._place, self._known = chunks, place, known
        self._weights, self._wanted = weights, as_image(wanted) if is_image(wanted) else wanted
        named = self._wanted.name if isinstance(self._wanted, Image) else wanted
        self.name = named if isinstance(named, str) and named else "values"
        self.unit = ""
        self.per_point = False
        self._progress: Progress = False

    @property
    def most_streamlines(self) -> int:
        return ANY if self._known[0] is None else self._known[0]

    @cached_property
    def _survey(self) -> tuple[Floats, Floats, int, int]:
        """Corners of a box about all points; streamlines; points."""
        low, high, lines, points = np.full(3, np.inf), np.full(3, -np.inf), 0, 0
        for chunk in shown(self._chunks(), self._known[1], "surveying", self._progress):
            if chunk.n_points:
                low = np.minimum(low, chunk.points.min(axis=0))
                high = np.maximum(high, chunk.points.max(axis=0))
            lines, points = lines + len(chunk), points + chunk.n_points
        if not points:
            low = high = np.zeros(3)
        return low, high, lines, points

    def box(self, progress: Progress) -> tuple[Floats, Floats]:
        self._progress = progress
        low, high, lines, points = self._survey
        self._known = lines, points
        return low, high

    def parts(self, progress: Progress) -> Iterator[Part]:
        self._progress = progress
        weights, wanted = self._weights, self._wanted
        if weights is not None and not isinstance(weights, str):
            weights = _weights(weights, {}, self._survey[2])
        if wanted is not None and not isinstance(wanted, (str, Image)):
            wanted = np.asarray(wanted)
            self.per_point = _is_per_point(wanted, *self._survey[2:])
        line = point = 0
        dropped: Counter[str] = Counter()
        for chunk in shown(counting(self._chunks(), dropped), self._known[1], "adding up", progress):
            lines, points = slice(line, line + len(chunk)), slice(point, point + chunk.n_points)
            own = np.ones(len(chunk))
            if isinstance(weights, str):
                own = _weights(weights, chunk.per_streamline, len(chunk))
            elif weights is not None:
                own = weights[lines]
            values = np.empty(0)
            if isinstance(wanted, Image):
                self.per_point, values = True, wanted.at(chunk.points)
            elif isinstance(wanted, str):
                self.per_point, values = self._named(chunk, wanted)
            elif wanted is not None:
                values = np.array(wanted[points if self.per_point else lines], np.float64)
            yield Part(_writable(chunk.points, np.float64), _writable(chunk.offsets, np.int64), own, values)
            line, point = lines.stop, points.stop
        warn_of_losses(self._place, dropped, stacklevel=3)

    def _named(self, chunk: Streamlines, name: str) -> tuple[bool, Floats]:
        """Whether an array is of points, and its numbers."""
        for per_point, arrays, n in (
            (False, chunk.per_streamline, len(chunk)),
            (True, chunk.per_point, chunk.n_points),
        ):
            if name in arrays and arrays[name].dtype.kind in "biuf" and arrays[name].size == n:
                return per_point, np.array(arrays[name], np.float64).reshape(n)
        there = ", ".join([*chunk.per_streamline, *chunk.per_point]) or "none"
        raise KeyError(
            f"{self._place} has no array {name!r} of single numbers; there are: {there}. Computed measures, such as "
            "'curvature', need a compressed set"
        )

    def compile(self) -> None:
        """Nothing is to be decoded."""


def _writable(rows: npt.NDArray[Any], dtype: npt.DTypeLike) -> npt.NDArray[Any]:
    """Rows, copied where they are of another type, or cannot be written to: compiled code is by type, that included."""
    return np.require(rows, dtype, ["C", "W"])


def _is_per_point(rows: npt.NDArray[Any], n_lines: int, n_points: int) -> bool:
    if rows.dtype.kind in "biuf" and rows.shape in ((n_lines,), (n_points,)):
        return rows.shape != (n_lines,)
    raise ValueError(
        f"contrast is an array of {rows.dtype}{rows.shape}; one number for each of the {n_lines} streamlines or "
        f"{n_points} points is needed"
    )


def _weights(given: Any, arrays: Mapping[str, npt.NDArray[Any]], n: int) -> Floats:
    """Weights as ``(n,)`` float64; raise an error for invalid ones."""
    rows = given
    if isinstance(given, str):
        if given not in arrays:
            raise KeyError(f"no array per streamline is named {given!r}; there are: {', '.join(arrays) or 'none'}")
        rows = arrays[given]
    rows = np.asarray(rows)
    if rows.size != n or rows.dtype.kind not in "biuf" or rows.ndim not in (1, 2):
        raise ValueError(
            f"weights are {rows.dtype}{rows.shape}; one number for each of the {n} streamlines is needed, of those "
            "without points, too"
        )
    found = rows.reshape(n).astype(np.float64)
    bad = np.flatnonzero(~(np.isfinite(found) & (found >= 0.0)))
    if bad.size:
        raise ValueError(f"the weight of streamline {bad[0]} is {found[bad[0]]}; give finite numbers of 0 or more")
    return found
