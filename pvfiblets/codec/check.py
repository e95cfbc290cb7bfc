"""Sense checks of fiblet records, so that a damaged file ends in an error and not in foreign memory."""

from __future__ import annotations

from os import PathLike
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from ..errors import FormatError
from .capsules import capsule_ends
from .files.archive import check_members
from .layout import (
    END_BITS,
    MAX_POINTS,
    NODE_BYTES,
    PAGE,
    SPLINE,
    WIDE,
    code_bytes,
    coded_kind,
    unpack,
    unpack_ends,
)

if TYPE_CHECKING:
    from .fibletset import FibletSet


def check_file(fiblets: FibletSet, path: str | PathLike[str]) -> None:
    """Check every byte of the file that a set is mapped from against its checksums, and the records for sense."""
    damaged = check_members(path)
    if damaged:
        raise FormatError(
            path, None, f"changed bytes in {', '.join(damaged)}", "bytes as written: copy or make the file again"
        )
    check_records(fiblets, path)


def check_records(fiblets: FibletSet, path: str | PathLike[str] = "fiblets in memory") -> None:
    """Check that records and pages agree with each other, and that every fiblet lies within its capsule."""
    table = fiblets.pages
    point, rank = 0, -1
    for page in range(len(table) - 1):
        rows = slice(page * PAGE, min((page + 1) * PAGE, fiblets.n_fiblets))
        decoding, anchors = fiblets.decoding[rows], fiblets.anchors[rows]
        counts = unpack("last", decoding).astype(np.int64) + 1
        sizes = code_bytes(decoding)
        starts = unpack("code", decoding) + table[page, 1]
        points = unpack("point", decoding) + table[page, 2]
        ranks = unpack("rank", anchors) + table[page, 0]
        begins, ends = unpack("begin", anchors).astype(bool), unpack("end", anchors).astype(bool)
        width = unpack("step", decoding) & 7
        expected_points = point + np.concatenate([[0], np.cumsum(counts[:-1])])
        expected_ranks = rank + np.cumsum(begins)
        for bad, what in (
            (counts > MAX_POINTS, "more than 60 points"),
            (starts + sizes > len(fiblets.codes), "codes beyond the end"),
            (starts != table[page, 1] + np.concatenate([[0], np.cumsum(sizes[:-1])]), "codes that do not follow on"),
            (points != expected_points, "points that do not follow on"),
            (ranks != expected_ranks, "a streamline that does not follow on"),
            ((unpack("kind", decoding) == WIDE) & (width > SPLINE), "codes of impossible width"),
            (_spans(fiblets.codes, decoding, starts) != counts - 1, "a spline of more or fewer points"),
            (np.append(False, begins[1:] != ends[:-1]), "begin and end marks that do not alternate"),
        ):
            _refuse(path, rows.start, bad, what)
        _check_capsules(fiblets, path, rows, counts, ranks, ends)
        point, rank = int(points[-1] + counts[-1]), int(ranks[-1])
    if fiblets.ends.shape != (fiblets.n_ranks,) or (np.asarray(fiblets.ends) >> np.uint32(3 * END_BITS)).any():
        raise FormatError(path, None, "end vectors that none would be", f"{fiblets.n_ranks} words of 30 bits")
    ids = fiblets.rank_to_id
    if ids is not None and len(ids):
        rising = ids if fiblets.in_order else np.sort(ids)
        if rising[0] < 0 or rising[-1] >= fiblets.n_streamlines or (np.diff(rising) == 0).any():
            raise FormatError(
                path, None, "a rank_to_id that names none or one twice", f"streamlines 0..{fiblets.n_streamlines - 1}"
            )
    for name, members in fiblets.groups.items():
        if len(members) and not 0 <= int(np.min(members)) <= int(np.max(members)) < fiblets.n_streamlines:
            raise FormatError(path, None, f"group {name!r} with foreign streamlines", f"0..{fiblets.n_streamlines - 1}")
    if point != fiblets.n_points or rank + 1 != fiblets.n_ranks:
        raise FormatError(
            path, None, f"records of {point} points, {rank + 1} streamlines", f"{fiblets.n_points}, {fiblets.n_ranks}"
        )


def _spans(
    codes: npt.NDArray[np.uint8], decoding: npt.NDArray[np.uint32], starts: npt.NDArray[np.int64]
) -> npt.NDArray[np.int64]:
    """Points behind the first of each fiblet; of splines, the sum of the nodes' spans."""
    spans = unpack("last", decoding).astype(np.int64)
    splines = np.flatnonzero(coded_kind(decoding) == SPLINE)
    nodes, at = unpack("step", decoding)[splines].astype(np.int64) >> 3, np.asarray(starts[splines], np.int64)
    spans[splines] = 0
    for node in range(int(nodes.max(initial=0))):
        some = (node < nodes) & (at + node * NODE_BYTES < len(codes))
        spans[splines[some]] += codes[at[some] + node * NODE_BYTES] & 63
    return spans


def _refuse(path: str | PathLike[str], first: int, bad: npt.NDArray[np.bool_], what: str) -> None:
    if bad.any():
        fiblet = first + int(np.flatnonzero(bad)[0])
        raise FormatError(path, None, f"fiblet {fiblet} with {what}", "records as written: make the file again")


def _check_capsules(
    fiblets: FibletSet,
    path: str | PathLike[str],
    rows: slice,
    counts: npt.NDArray[np.int64],
    ranks: npt.NDArray[np.int64],
    ends: npt.NDArray[np.bool_],
) -> None:
    """Decode the fiblets of one page, and check their culling bounds."""
    from .decompress import decode_fiblets
    from .kernels.capsule_kernels import leaving

    more = rows.stop < fiblets.n_fiblets  # the last chord ends at the next page's first anchor
    which = np.arange(rows.start, rows.stop + more)
    if more:
        counts = np.append(counts, unpack("last", fiblets.decoding[rows.stop]).astype(np.int64) + 1)
    starts = np.concatenate([[0], np.cumsum(counts)])
    points = np.empty((int(starts[-1]), 3))
    decode_fiblets(fiblets, which, starts[:-1], points)
    points -= fiblets.origin  # away from the origin float64 would hold fewer digits of a chord than the encoder had
    n = rows.stop - rows.start
    anchors = points[starts[:n]]
    owners = ranks[ends]
    if owners.size and not 0 <= int(owners.min()) <= int(owners.max()) < len(fiblets.ends):
        raise FormatError(path, None, f"end vectors of {len(fiblets.ends)} streamlines", f"of {int(owners.max()) + 1}")
    vectors = unpack_ends(np.asarray(fiblets.ends[owners])) * fiblets.end_scale
    chords = capsule_ends(anchors, ends, vectors, points[starts[n]] if more else None)
    radius = np.asarray(fiblets.reach[rows]) * fiblets.reach_scale
    slack = 8.0 * np.spacing(np.abs(points).max(initial=0.0) + np.abs(fiblets.origin).max())
    _refuse(path, rows.start, leaving(points, starts[: n + 1], chords, radius + slack), "points outside its capsule")
    spheres = 0.5 * np.sqrt(((chords - anchors) ** 2).sum(1)) + radius
    too_large = spheres > fiblets.largest_radius + slack
    _refuse(path, rows.start, too_large, "a capsule beyond the set's largest radius")
