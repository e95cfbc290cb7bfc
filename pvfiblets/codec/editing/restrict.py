"""Some streamlines of a set as a set of their own, records copied as they are, and an even choice of them.

A fiblet's points follow from its own record and codes, so that nothing is decoded or rounded: what changes is where
codes, points and streamlines are counted from, because records count from their page (:mod:`.layout`). Streamlines keep
their numbers. Those that are left out become streamlines without points, so that colours, groups, per-streamline values
and whatever else goes by the number of a streamline mean the same for the part as for the whole.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ..decompress import select_streamlines
from ..files.archive import forget
from ..layout import FIELDS, PAGE, PAGE_BITS, WORDS, code_bytes, unpack

if TYPE_CHECKING:
    from ..fibletset import FibletSet

Ints = npt.NDArray[np.int64]
Mask = npt.NDArray[np.bool_]

RANKS = 1 << 20  # looked at together where all ranks are gone through
BEHIND = 64  # pages read of a mapped file before their memory is given back


def even_share(fiblets: FibletSet, share: float) -> Ints:
    """Choose an even share of the streamlines, always the same one."""
    # Rank `r` is chosen where the fraction of `r` times the golden ratio lies below the share: these fractions are
    # spread more evenly than random numbers, over every stretch of consecutive ranks, and streamlines that are coded
    # one after another may lie side by side (`.ordering`).
    if not 0.0 <= share <= 1.0:
        raise ValueError(f"share is {share}; a number from 0 to 1 is needed")
    parts = []
    for first in range(0, fiblets.n_ranks, RANKS):
        ranks = np.arange(first, min(first + RANKS, fiblets.n_ranks))
        fractions = ranks.astype(np.uint64) * np.uint64(0x9E3779B97F4A7C15)  # modulo 2 ** 64
        ranks = ranks if share == 1.0 else ranks[fractions < np.uint64(int(share * 2.0**64))]
        parts.append(ranks if fiblets.rank_to_id is None else np.asarray(fiblets.rank_to_id)[ranks])
    return np.concatenate(parts) if parts else np.zeros(0, np.int64)


def restrict(fiblets: FibletSet, ids: Any) -> FibletSet:
    """Take only these streamlines."""
    return Restriction(fiblets, ids).make()


class Restriction:
    """The size of :func:`restrict`'s result, known before it is made, with the same errors; codes are not read."""

    def __init__(self, fiblets: FibletSet, ids: Any) -> None:
        chosen = select_streamlines(fiblets.n_streamlines, ids)
        self._whole = fiblets
        with _damage_named(fiblets):
            self._keep = _kept_ranks(fiblets, chosen)
            self.n_ranks = int(self._keep.sum())
            self.n_fiblets = self.n_codes = self.n_points = 0
            for part in parts_of(fiblets, self._keep):
                self.n_fiblets += len(part.rows)
                self.n_codes += int(part.sizes.sum())
                self.n_points += int(part.counts.sum())
            if self.n_codes > len(fiblets.codes) or self.n_points > fiblets.n_points:  # must not size an array
                raise ValueError(f"{self.n_codes} bytes of codes and {self.n_points} points, more than in the whole")

    @property
    def nbytes(self) -> int:
        """Bytes of memory that :meth:`make` takes."""
        record = 8 + 12 + 2 + (0 if self._whole.anchors_low is None else 6)
        point = sum(values.codes.dtype.itemsize for values in self._whole.per_point.values())
        point += 0 if self._whole.exact is None else 3 * self._whole.exact.dtype.itemsize
        return self.n_fiblets * record + self.n_codes + self.n_points * point + self.n_ranks * (4 + 8)

    def make(self) -> FibletSet:
        """Make it; see :func:`restrict`."""
        with _damage_named(self._whole):
            return self._make()

    def _make(self) -> FibletSet:
        whole, ranks = self._whole, np.flatnonzero(self._keep)
        out = Records.empty(whole, self.n_fiblets, self.n_codes, self.n_points)
        for part in parts_of(whole, self._keep):
            out.take(whole, part)
        if out.at.tolist() != [self.n_ranks, self.n_codes, self.n_points]:
            raise ValueError(f"{out.at[0]} streamlines begin where {self.n_ranks} are wanted")
        out.pages[-1] = out.at
        ends = [whole.ends[ranks[i : i + RANKS]] for i in range(0, len(ranks), RANKS)]
        numbers = ranks if whole.rank_to_id is None else np.asarray(whole.rank_to_id)[ranks]
        everything = whole.rank_to_id is None and len(ranks) == whole.n_streamlines
        return replace(
            whole,
            anchors=out.anchors,
            anchors_low=out.anchors_low,
            decoding=out.decoding,
            reach=out.reach,
            codes=out.codes,
            ends=np.concatenate(ends) if ends else np.empty(0, np.uint32),
            pages=out.pages,
            rank_to_id=None if everything else numbers,
            exact=out.exact,
            per_point={k: replace(v, codes=out.per_point[k]) for k, v in whole.per_point.items()},
        )


@contextmanager
def _damage_named(fiblets: FibletSet) -> Iterator[None]:
    """Raise for a damaged file; other errors pass."""
    try:
        yield
    except (IndexError, ValueError):
        fiblets.verify()
        raise


def _kept_ranks(fiblets: FibletSet, chosen: Ints) -> Mask:
    """``(n_ranks,)`` which ranks are of chosen streamlines."""
    mask = np.zeros(fiblets.n_streamlines, bool)
    mask[chosen] = True
    if fiblets.rank_to_id is None:
        return mask
    ids = fiblets.rank_to_id
    return np.concatenate([mask[ids[i : i + RANKS]] for i in range(0, len(ids), RANKS)] or [mask[:0]])


@dataclass(frozen=True)
class _Part:
    """Fiblets of one page that are taken."""

    rows: Ints  # `(n,)` which fiblets, counted over the whole set
    decoding: npt.NDArray[np.uint32]  # their words `(n, 3)`, and which of them begin a streamline
    begins: Mask
    sizes: Ints  # their code bytes and points
    counts: Ints
    codes: Ints  # where these stand among all: first of each fiblet, `(n,)`
    points: Ints


def parts_of(fiblets: FibletSet, keep: Mask) -> Iterator[_Part]:
    """Iterate over the pages with chosen fiblets, and release the read parts of a mapped file."""
    table, read = fiblets.pages, 0
    for page in range(len(table) - 1):
        # The page's last streamline may go on in the next one, whose first rank it then is.
        if not keep[table[page, 0] : table[page + 1, 0] + 1].any():
            continue
        first, last = page * PAGE, min((page + 1) * PAGE, fiblets.n_fiblets)
        anchors = fiblets.anchors[first:last]
        taken = np.flatnonzero(keep[unpack("rank", anchors).astype(np.int64) + table[page, 0]])
        if taken.size:
            first_row, rows = first + int(taken[0]), first + taken
            decoding = np.asarray(fiblets.decoding[first_row : int(rows[-1]) + 1])[rows - first_row]
            counts = unpack("last", decoding).astype(np.int64) + 1
            yield _Part(
                rows,
                decoding,
                unpack("begin", anchors[taken]).astype(bool),
                code_bytes(decoding),
                counts,
                unpack("code", decoding).astype(np.int64) + table[page, 1],
                unpack("point", decoding).astype(np.int64) + table[page, 2],
            )
        read += 1
        if read % BEHIND == 0 or page == len(table) - 2:
            _forget(fiblets, last)


def _forget(fiblets: FibletSet, fiblet: int) -> None:
    """Give back the memory of what a mapped file holds up to a fiblet."""
    page = fiblets.pages[fiblet >> PAGE_BITS if fiblet < fiblets.n_fiblets else -1]
    for array in (fiblets.anchors, fiblets.anchors_low, fiblets.decoding, fiblets.reach):
        if array is not None:
            forget(array, 0, fiblet)
    forget(fiblets.codes, 0, int(page[1]))
    for values in fiblets.per_point.values():
        forget(values.codes, 0, int(page[2]))


@dataclass
class Records:
    """Records of a set while it is filled."""

    anchors: npt.NDArray[np.uint32]
    anchors_low: npt.NDArray[np.uint16] | None
    decoding: npt.NDArray[np.uint32]
    reach: npt.NDArray[np.uint16]
    codes: npt.NDArray[np.uint8]
    pages: Ints
    exact: npt.NDArray[Any] | None
    per_point: dict[str, npt.NDArray[Any]]
    at: Ints  # streamlines, code bytes and points so far
    n: int = 0  # fiblets so far

    @classmethod
    def empty(cls, fiblets: FibletSet, n: int, n_codes: int, n_points: int) -> Records:
        """Room for so many fiblets, code bytes and points."""
        return cls(
            anchors=np.empty((n, WORDS["anchors"]), np.uint32),
            anchors_low=None if fiblets.anchors_low is None else np.empty((n, 3), np.uint16),
            decoding=np.empty((n, WORDS["decoding"]), np.uint32),
            reach=np.empty(n, np.uint16),
            codes=np.empty(n_codes, np.uint8),
            pages=np.zeros((-(-n // PAGE) + 1, 3), np.int64),
            exact=None if fiblets.exact is None else np.empty((n_points, 3), fiblets.exact.dtype),
            per_point={k: np.empty(n_points, v.codes.dtype) for k, v in fiblets.per_point.items()},
            at=np.zeros(3, np.int64),
        )

    def take(self, fiblets: FibletSet, part: _Part) -> None:
        """Append the taken fiblets of one page."""
        k = len(part.rows)
        rows = slice(self.n, self.n + k)
        ranks = self.at[0] - 1 + np.cumsum(part.begins)
        codes = self.at[1] + np.cumsum(part.sizes) - part.sizes
        points = self.at[2] + np.cumsum(part.counts) - part.counts
        pages = np.arange(self.n, self.n + k) >> PAGE_BITS
        opening = np.flatnonzero(np.arange(self.n, self.n + k) % PAGE == 0)
        self.pages[pages[opening]] = np.stack([ranks, codes, points], axis=1)[opening]
        base = self.pages[pages]
        span = slice(int(part.rows[0]), int(part.rows[-1]) + 1)
        within = part.rows - span.start
        anchors = np.asarray(fiblets.anchors[span])[within]
        self.anchors[rows] = _with("rank", anchors, ranks - base[:, 0])
        self.decoding[rows] = _with("code", _with("point", part.decoding, points - base[:, 2]), codes - base[:, 1])
        self.reach[rows] = np.asarray(fiblets.reach[span])[within]
        if self.anchors_low is not None and fiblets.anchors_low is not None:
            self.anchors_low[rows] = np.asarray(fiblets.anchors_low[span])[within]
        end = int(codes[-1] + part.sizes[-1])
        self.codes[self.at[1] : end] = _gathered(fiblets.codes, part.codes, part.sizes)
        last = int(points[-1] + part.counts[-1])
        if self.exact is not None and fiblets.exact is not None:
            self.exact[self.at[2] : last] = _gathered(fiblets.exact, part.points, part.counts)
        for name, values in fiblets.per_point.items():
            self.per_point[name][self.at[2] : last] = _gathered(values.codes, part.points, part.counts)
        self.at = np.array([ranks[-1] + 1, end, last])
        self.n += k


def _gathered(array: npt.NDArray[Any], starts: Ints, lengths: Ints) -> npt.NDArray[Any]:
    """Stretches of an array, end to end; read in one piece from the first to the last."""
    first, last = int(starts.min()), int((starts + lengths).max())
    if first < 0 or last > len(array):
        raise IndexError(f"rows {first} to {last} of an array of {len(array)}")
    piece, stops = np.asarray(array[first:last]), starts + lengths
    apart = np.flatnonzero(starts[1:] != stops[:-1]) + 1  # fiblets of one streamline follow on each other
    froms, tos = starts[np.append(0, apart)] - first, stops[np.append(apart, len(stops)) - 1] - first
    return np.concatenate([piece[a:b] for a, b in zip(froms.tolist(), tos.tolist(), strict=True)])


def _with(name: str, words: npt.NDArray[np.uint32], values: Ints) -> npt.NDArray[np.uint32]:
    """Records with other values of one field."""
    field = FIELDS[name]
    if len(values) and not 0 <= int(values.min()) <= int(values.max()) <= field.mask:
        raise ValueError(f"{name} holds 0..{field.mask}, got {values.min()}..{values.max()}")
    column = words[:, field.word] & ~np.uint32(field.mask << field.shift)
    changed = words.copy()
    changed[:, field.word] = column | (values.astype(np.uint32) << np.uint32(field.shift))
    return changed
