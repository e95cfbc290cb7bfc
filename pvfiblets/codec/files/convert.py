"""File to file, in memory that does not grow with the file."""

from __future__ import annotations

import inspect
import math
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, field, replace
from os import PathLike
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

from ... import formats
from ...errors import FormatError
from ...streamlines import Streamlines
from ...support.memory import fits
from ...support.unfinished import remove_unfinished, scratch_folder_for
from ...support.whole_files import naming_target
from .. import parameters as limits
from ..encoding.compress import (
    CHUNK_POINTS,
    PerPoint,
    ValueBounds,
    check_exact,
    choose_per_point,
    compress,
    grows,
    is_plain,
    not_kept,
    value_coders,
)
from ..encoding.exact import raw_bytes
from ..encoding.ordering import Order, check_order
from ..fibletset import FibletSet
from ..layout import WORDS
from ..parameters import CUT_SHARE, DEFAULT_ANGLE, Parameters, Survey, bounds_of, tell_far
from ..point_values import PointValues, ValueCoder, value_columns, value_errors
from ..progress import Progress, shown
from .archive import Member
from .fiblets_file import CORE, OPTIONAL, index_members, make_header, write
from .file_error import compare_file

if TYPE_CHECKING:
    from ..encoding.encode import Encoder
    from ..parameters import Effort

SAMPLE_POINTS = 1_000_000  # compared points of a large file, about


def compress_file(
    source: str | PathLike[str],
    target: str | PathLike[str],
    *,
    step: float | Literal["auto"] = "auto",
    max_error: float | None = None,
    max_angle: float | None = DEFAULT_ANGLE,
    effort: Effort = "fast",
    order: Order = "input",
    per_point: PerPoint = "fit",
    per_point_bits: int = 8,
    max_value_error: float | Mapping[str, float] | None = None,
    exact: bool | None = None,
    verify: Literal["all", "sample"] = "all",
    small: bool = False,
    prepare: Callable[[FibletSet], object] | None = None,
    progress: Progress = False,
) -> dict[str, Any]:
    """Compress a tractogram file into a ``.fiblets`` file.

    The source is read three times: for its bounds and steps, for coding, and to compare the finished file with it.
    Where it is resampled it is read once more, to know the error bound before corners are cut.

    Parameters
    ----------
    source : str or PathLike
        Any format that :func:`pvfiblets.iter_chunks` reads.
    target : str or PathLike
        A name ending in ``.fiblets``; it appears when it is whole.
    step, max_error, max_angle, effort, per_point_bits, max_value_error, exact
        As in :func:`pvfiblets.compress`.
    per_point : sequence of str, or {'all', 'fit', 'none'}
        As in :func:`pvfiblets.compress`, but for the default: per-point arrays are kept in their order, each that still
        fits into 16 bytes a point. ``dropped`` names the others, in the result and in the file.
    order : {'input'}
        Another order needs all streamlines at once, and is refused here.
    verify : {'all', 'sample'}
        Compare all of the finished file with the source, or every so many-th streamline, about a million points in all.
        Coding itself keeps the error bound, in either case.
    small : bool
        As in :meth:`pvfiblets.FibletSet.save`. The compressed set is held in memory for it. A compressed source is
        packed as it is.
    prepare : callable, optional
        Called with the coded set before it is written, unless it keeps every bit: data added to the set, as by
        :func:`pvfiblets.regions.index_of`, are written to the file.
    progress : bool or callable
        Show a progress bar; or call this with the name of the step and its finished share, from 0 to 1 (0 while it
        is unknown). An exception stops the work.

    Returns
    -------
    dict
        ``streamlines, points, fiblets, bytes`` (of the file), ``bytes_per_point, error_mm{max, mean, p999},
        error_steps{...}, error_degrees{max, mean, p99}, error_values{name: {max, mean}}, compared_every`` (1 for all
        streamlines), ``promise_mm, seconds`` (to read and code), ``points_per_second, seconds_to_measure, dropped,
        per_point`` (names of the arrays kept), and ``exact`` (whether every bit of the points is).

    Raises
    ------
    FormatError
        If the source breaks its format.
    ValueError
        As :func:`pvfiblets.compress`.
    """
    started = time.perf_counter()
    if small and Path(source).suffix.lower() == ".fiblets":
        own: dict[str, Any] = {
            "step": step, "max_error": max_error, "max_angle": max_angle, "effort": effort, "per_point": per_point,
            "per_point_bits": per_point_bits, "max_value_error": max_value_error, "exact": exact, "verify": verify,
        }  # fmt: skip
        return _repack(compressed_source(source, own), target, prepare)
    check_order(order)
    if order != "input":
        raise ValueError(
            f"order is {order!r}, which needs all streamlines in memory; compress_file holds a part of them at a time: "
            f"pvfiblets.compress(pvfiblets.read(source), order={order!r}).save(target) does it where memory suffices"
        )

    if verify not in ("all", "sample"):
        raise ValueError(f"verify is {verify!r}; 'all' or 'sample' is needed")
    check_exact(exact, step, order, max_error)
    how = ValueBounds(per_point_bits, max_value_error)
    remove_unfinished(Path(target).resolve().parent)
    tracts = _Source(source, step, max_error, progress)
    first = _survey(shown(tracts.chunks(), None, "surveying", progress), per_point, per_point_bits, bool(exact))
    found, names, raw = first.found, first.names, first.raw
    plain = is_plain(step, max_error, max_angle, effort, order)
    if exact or (exact is None and plain and raw < limits.EXACT_BELOW):
        return _keep_exactly(first.small, target, names, started, small)
    first.small.clear()
    from ..encoding.encode import Encoder  # which needs a compiler

    encoder = Encoder(tracts.parameters(found), effort, max_angle)
    coders = value_coders(found, found.values or names, how)
    spooled = [0]
    with (
        naming_target(target, lambda: 2 * spooled[0]),  # once in parts, once put together
        scratch_folder_for(Path(target)) as scratch,
        closing(_Spool(scratch, spooled)) as spool,  # before its folder goes, whatever happens
    ):
        whole = _Whole(first.behind)
        for chunk in shown(tracts.chunks(), found.n_points, "compressing", progress):
            _code(chunk, encoder, coders, names, spool, whole)
        spool.close()
        # To keep them as they are, all are in memory at once, and their records.
        if exact is None and step == "auto" and grows(encoder, raw) and fits(6 * raw):
            return _keep_exactly(tracts.chunks(), target, names, started, small)
        tell_far(found)
        if not encoder.n_fiblets:
            spool.add_empty(coders, whole)
        pages, ids = encoder.page_table(), encoder.rank_to_id()
        spool.add("pages.npy", pages)
        if ids is not None:
            spool.add("rank_to_id.npy", ids)
        spool.close()
        if tracts.promise is not None:
            encoder.parameters = replace(encoder.parameters, promise=tracts.promise)
        header_set = whole.without_records(encoder, pages, found)
        members = spool.members()
        mapped = spool.mapped(header_set)
        told = replace(header_set, decoding=mapped.decoding)
        header, more = make_header(told, {k: members.pop(k) for k in whole.per_point})
        if prepare is not None:
            prepare(mapped)
            members |= index_members(mapped)
        write(target, header, members | more, small=small)
    seconds = time.perf_counter() - started
    every = 1 if verify == "all" else max(1, round(found.n_points / SAMPLE_POINTS))
    error = compare_file(tracts.originals(), found.n_points, target, progress, every=every, max_points=CHUNK_POINTS)
    return {
        **_written(FibletSet.open(target), target),
        **error.summary(),
        "compared_every": every,
        "seconds": seconds,
        "points_per_second": encoder.n_points / seconds,
        "seconds_to_measure": time.perf_counter() - started - seconds,
    }


def compressed_source(source: str | PathLike[str], options: Mapping[str, Any]) -> FibletSet:
    """Open a compressed source, whose fiblets stay as they are; refuse options of compression."""
    usual = inspect.signature(compress_file).parameters
    given = sorted(name for name, value in options.items() if name not in usual or value != usual[name].default)
    if given:
        raise ValueError(
            f"{', '.join(given)}: {source} is compressed already, and its fiblets stay as they are; give the original, "
            "or leave these out"
        )
    return FibletSet.open(source)


def _repack(
    fiblets: FibletSet, target: str | PathLike[str], prepare: Callable[[FibletSet], object] | None
) -> dict[str, Any]:
    if prepare is not None and fiblets.exact is None:
        prepare(fiblets)
    with naming_target(target):
        fiblets.save(target, small=True)
    return _written(fiblets, target)


def _written(fiblets: FibletSet, target: str | PathLike[str]) -> dict[str, Any]:
    """Return what a file holds, and its size."""
    size = Path(target).stat().st_size
    return {
        "streamlines": len(fiblets),
        "points": fiblets.n_points,
        "fiblets": fiblets.n_fiblets,
        "bytes": size,
        "bytes_per_point": size / max(fiblets.n_points, 1),
        "promise_mm": fiblets.points_promise,
        "dropped": dict(fiblets.dropped),
        "per_point": list(fiblets.per_point),
        "exact": fiblets.exact is not None,
    }


class _Source:
    """A tractogram file, whose streamlines are resampled where a step is asked for."""

    def __init__(
        self, path: str | PathLike[str], step: float | Literal["auto"], max_error: float | None, progress: Progress
    ) -> None:
        self._path, self._step, self._max_error = path, None if step == "auto" else step, max_error
        self.promise: float | None = None  # of resampled streamlines, known before their corners are cut
        if self._step is not None:
            from ..encoding.resample import resample

            coarse = Survey()
            for chunk in shown(self.originals(), None, "surveying", progress):
                coarse.add(resample(chunk, self._step))
            self.promise = Parameters.choose(coarse, max_error).promise

    def originals(self) -> Iterator[Streamlines]:
        """Yield the streamlines as the file has them."""
        return formats.iter_chunks(self._path, CHUNK_POINTS)

    def chunks(self) -> Iterator[Streamlines]:
        """Yield the streamlines to code."""
        if self._step is None or self.promise is None:
            return self.originals()
        from ..encoding.resample import resample

        step, cut = self._step, CUT_SHARE * self.promise
        return (resample(chunk, step, cut) for chunk in self.originals())

    def parameters(self, found: Survey) -> Parameters:
        """Return how to code them."""
        if self._step is None or self.promise is None:
            return Parameters.choose(found, self._max_error)
        return Parameters.of_resampled(found, self.promise, self._step)


@dataclass
class _Surveyed:
    """What the first reading of a file finds."""

    found: Survey = field(default_factory=Survey)
    raw: int = 0  # bytes of its streamlines as they are
    small: list[Streamlines] = field(default_factory=list)  # all chunks, while they are few enough to be kept exactly
    names: tuple[str, ...] = ()  # of the arrays that are kept
    behind: dict[str, int] = field(default_factory=dict)  # arrays that are not


def _survey(chunks: Iterable[Streamlines], per_point: PerPoint, bits: int, exact: bool) -> _Surveyed:
    first = _Surveyed()
    for n, chunk in enumerate(chunks):
        if n == 0:  # all chunks of a file have the same arrays
            first.names = choose_per_point(chunk, per_point, bits)
            first.behind = not_kept(chunk, first.names)
        first.found.add(chunk, first.names)
        first.raw += raw_bytes(chunk)
        first.small.append(chunk)
        if not exact and first.raw >= limits.EXACT_BELOW:
            first.small.clear()
    return first


def _code(
    chunk: Streamlines,
    encoder: Encoder,
    coders: Mapping[str, ValueCoder],
    names: Sequence[str],
    spool: _Spool,
    whole: _Whole,
) -> None:
    """Code the next streamlines, records to a spool and all else to the whole."""
    for records in encoder.parts(chunk):
        for name in ("anchors", "decoding", "reach", "codes", "ends", "anchors_low"):
            if getattr(records, name) is not None:
                spool.add(f"{name}.npy", getattr(records, name))
    for name, column in value_columns(chunk, names):
        values = coders[name].code(column)
        spool.add(name, values.codes)
        whole.add_values(name, values)
    whole.add(chunk)


def _keep_exactly(
    chunks: Iterable[Streamlines], target: str | PathLike[str], names: tuple[str, ...], started: float, small: bool
) -> dict[str, Any]:
    """Write a file that keeps every bit of the points, and say what :func:`compress_file` says."""
    whole = Streamlines.concatenate(chunks)
    fiblets = compress(whole, exact=True, per_point=names)
    with naming_target(target):
        fiblets.save(target, small=small)
    seconds = time.perf_counter() - started
    back = FibletSet.open(target)
    if not (np.array_equal(back.decompress().points, whole.points) and np.array_equal(back.offsets(), whole.offsets)):
        raise FormatError(target, None, "other points than were written", "the same: is the disk damaged?")
    none = {"max": 0.0, "mean": 0.0}
    return {
        **_written(fiblets, target),
        "error_mm": {**none, "p999": 0.0},
        "error_steps": {**none, "p999": 0.0},
        "error_degrees": {**none, "p99": 0.0},
        "error_values": value_errors(fiblets.per_point),
        "compared_every": 1,
        "seconds": seconds,
        "points_per_second": whole.n_points / seconds,
        "seconds_to_measure": time.perf_counter() - started - seconds,
    }


class _Whole:
    """Data that are kept whole: per-streamline data, groups and the header, gathered over chunks."""

    def __init__(self, dropped: dict[str, int]) -> None:
        self.n = 0
        self.per_point: dict[str, PointValues] = {}
        self._values_of: dict[str, int] = {}
        self.per_streamline: dict[str, list[npt.NDArray[Any]]] = {}
        self.groups: dict[str, list[npt.NDArray[Any]]] = {}
        self.per_group: dict[str, dict[str, Any]] = {}
        self.affine: npt.NDArray[np.float64] = np.eye(4)
        self.space: dict[str, Any] = {}
        self.dropped = dict(dropped)

    def add(self, chunk: Streamlines) -> None:
        for name, values in chunk.per_streamline.items():
            self.per_streamline.setdefault(name, []).append(np.array(values))
        for name, members in chunk.groups.items():
            self.groups.setdefault(name, []).append(np.asarray(members, np.int64) + self.n)
        for name, data in chunk.per_group.items():
            self.per_group.setdefault(name, {}).update(data)
        if self.n == 0:
            self.affine, self.space = np.asarray(chunk.affine, np.float64), dict(chunk.space)
        for reason, count in chunk.dropped.items():
            self.dropped[reason] = self.dropped.get(reason, 0) + int(count)
        self.n += len(chunk)

    def without_records(self, encoder: Encoder, pages: npt.NDArray[Any], found: Survey) -> FibletSet:
        """Return the set of all that stands in a header: its arrays of records are empty."""
        return FibletSet(
            parameters=encoder.parameters,
            anchors=np.empty((encoder.n_fiblets, 0), np.uint32),
            decoding=np.empty((0, WORDS["decoding"]), np.uint32),
            reach=np.empty(0, np.uint16),
            codes=np.empty(0, np.uint8),
            ends=np.empty(0, np.uint32),
            pages=pages,
            bounds=bounds_of(found),
            n_streamlines=encoder.n_streamlines,
            per_point=self.per_point,
            per_streamline={k: np.concatenate(v) for k, v in self.per_streamline.items()},
            groups={k: np.concatenate(v) for k, v in self.groups.items()},
            per_group=self.per_group,
            affine=self.affine,
            space=self.space,
            dropped=self.dropped,
        )

    def add_values(self, name: str, values: PointValues) -> None:
        """Remember a per-point array's table and errors, not its codes."""
        n, before = len(values.codes), self.per_point.get(name, values)
        had = self._values_of.get(name, 0)
        mean = (before.mean_error * had + values.mean_error * n) / max(had + n, 1)
        worst = max(before.max_error, values.max_error)
        self._values_of[name] = had + n
        self.per_point[name] = replace(values, codes=values.codes[:0], max_error=worst, mean_error=mean)


class _Spool:
    """Arrays that grow on disk, because a zip's members need their shapes before their bytes."""

    def __init__(self, folder: Path, total: list[int]) -> None:
        self._folder, self._total = folder, total
        self._streams: dict[str, IO[bytes]] = {}
        self._paths: dict[str, Path] = {}
        self._shapes: dict[str, tuple[np.dtype[Any], tuple[int, ...]]] = {}

    def add(self, name: str, rows: npt.NDArray[Any]) -> None:
        if name not in self._paths:
            self._paths[name] = self._folder / str(len(self._paths))
        if name not in self._streams:
            self._streams[name] = self._paths[name].open("ab")
        before = self._shapes[name][1][0] if name in self._shapes else 0
        self._shapes[name] = (rows.dtype, (before + len(rows), *rows.shape[1:]))
        self._total[0] += rows.nbytes
        self._streams[name].write(np.ascontiguousarray(rows).tobytes())

    def add_empty(self, coders: dict[str, ValueCoder], whole: _Whole) -> None:
        """Empty arrays, for a source without points."""
        for name, dtype, shape in (
            ("anchors.npy", np.uint32, (0, WORDS["anchors"])),
            ("decoding.npy", np.uint32, (0, WORDS["decoding"])),
            ("reach.npy", np.uint16, (0,)),
            ("codes.npy", np.uint8, (0,)),
            ("ends.npy", np.uint32, (0,)),
        ):
            if name not in self._shapes:
                self.add(name, np.empty(shape, dtype))
        for name, coder in coders.items():
            if name not in self._shapes:
                empty = coder.code(np.empty(0, coder.kind))
                self.add(name, empty.codes)
                whole.add_values(name, empty)

    def close(self) -> None:
        for stream in self._streams.values():
            stream.close()
        self._streams.clear()

    def members(self) -> dict[str, Member]:
        return {name: self._member(name) for name in self._paths}

    def mapped(self, header_set: FibletSet) -> FibletSet:
        """Return a set whose arrays are those on disk, without values of points."""
        there = (name for name in (*CORE, *OPTIONAL) if f"{name}.npy" in self._shapes)
        arrays: dict[str, Any] = {name: self._map(f"{name}.npy") for name in there}
        return replace(header_set, **arrays | {"per_point": {}})

    def _map(self, name: str) -> npt.NDArray[Any]:
        dtype, shape = self._shapes[name]
        return np.memmap(self._paths[name], dtype, "r", 0, shape) if math.prod(shape) else np.empty(shape, dtype)

    def _member(self, name: str) -> Member:
        dtype, shape = self._shapes[name]

        def pieces() -> Iterator[bytes]:
            with self._paths[name].open("rb") as stream:
                while piece := stream.read(1 << 24):
                    yield piece

        return Member(dtype, shape, pieces)
