"""Errors of a ``.fiblets`` file's lines against its source, in bounded memory."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import replace
from os import PathLike

import numpy as np

from ... import formats
from ...streamlines import Streamlines
from ...support.summary import counting
from ..decompress import iter_chunks
from ..encoding.compress import CHUNK_POINTS
from ..error import CodingError, ErrorTally
from ..fibletset import FibletSet
from ..progress import Progress, shown


def measure_file_error(
    fiblets: str | PathLike[str],
    original: str | PathLike[str],
    *,
    progress: Progress = False,
    dropped: Counter[str] | None = None,
) -> CodingError:
    """Compare a ``.fiblets`` file with the file it was made from, in bounded memory."""
    # What reading leaves out of the original is added to `dropped`.
    total = FibletSet.open(fiblets).n_points
    originals = counting(formats.iter_chunks(original, CHUNK_POINTS), Counter() if dropped is None else dropped)
    return compare_file(originals, total, fiblets, progress)


def compare_file(
    originals: Iterable[Streamlines],
    total: int,
    target: str | PathLike[str],
    progress: Progress,
    *,
    every: int = 1,
    max_points: int = CHUNK_POINTS,
) -> CodingError:
    """Decode a file alongside its original; both come in chunks, which need not be cut at the same places."""
    coded = FibletSet.open(target)
    part = coded
    if every > 1:
        bare = replace(coded, per_point={}, per_streamline={}, groups={}, per_group={})
        # Steps and bounds, the units of errors, belong to the whole set.
        part = replace(bare.extract(np.arange(0, len(coded), every)), bounds=coded.bounds)
    tally = ErrorTally(part, by_streamline=False)
    decoded = iter_chunks(part, max_points, np.float64)
    rest: Streamlines | None = None
    seen = 0
    for chunk in _sampled(shown(originals, total, "measuring", progress), every):
        done = 0
        while done < len(chunk):
            if rest is None or len(rest) == 0:
                rest = next(decoded, None)
                if rest is None:
                    raise ValueError(f"the original has more streamlines than the {len(part)} of the fiblets")
            n = min(len(rest), len(chunk) - done)
            a, b = _plain(chunk, done, done + n), _plain(rest, 0, n)
            if not tally.resampled and not np.array_equal(a.offsets, b.offsets):
                differs = int(np.flatnonzero(np.asarray(a.offsets) != np.asarray(b.offsets))[0]) - 1
                raise ValueError(
                    f"streamline {(seen + differs) * every} has {a.counts[differs]} points in the original, "
                    f"{b.counts[differs]} in the fiblets: errors can be measured only against the compressed "
                    "streamlines"
                )
            tally.add(a, b)
            rest = _plain(rest, n, len(rest))
            done += n
            seen += n
    if seen != len(part):
        raise ValueError(f"the fiblets hold {len(part)} streamlines, the original {seen}")
    return tally.result()


def _sampled(chunks: Iterable[Streamlines], every: int) -> Iterator[Streamlines]:
    """Every so many-th streamline."""
    first = 0
    for chunk in chunks:
        yield chunk if every == 1 else chunk[np.arange(first, len(chunk), every)]
        first = (first - len(chunk)) % every


def _plain(s: Streamlines, a: int, b: int) -> Streamlines:
    """Streamlines ``a`` to ``b`` without their data."""
    offsets = np.asarray(s.offsets)
    return Streamlines(s.points[offsets[a] : offsets[b]], offsets[a : b + 1] - offsets[a])
