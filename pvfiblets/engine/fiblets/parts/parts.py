"""A set in parts that come to the GPU one by one: stretches of a set's streamlines, or the shards of a sharded set."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Protocol

import numpy as np
import numpy.typing as npt

from ....codec import layout
from ....codec.editing.restrict import even_share, restrict

if TYPE_CHECKING:
    from ....codec.fibletset import FibletSet
    from ...view import Style, View

Box = npt.NDArray[np.float64]  # `(2, 3)` float64: least and greatest coordinates, mm


class Parts(Protocol):
    """The parts of a set. Each streamline is in one part, as a whole, with its number in the set."""

    whole: FibletSet  # the set: what filters and colours go by

    by_streamline: bool  # whether the set is coded in the order of its streamlines' numbers, but not part by part

    def __len__(self) -> int:
        """Return how many parts there are."""
        ...

    def box(self, number: int) -> Box | None:
        """Return bounds of a part, None where they are not known before it is there."""
        ...

    def ids(self, number: int) -> npt.NDArray[np.int64]:
        """Return the numbers of the streamlines of a part, or of more, in any order."""
        ...

    def is_here(self, number: int) -> bool:
        """Whether a part can be had at once; if not, it is being fetched from now on."""
        ...

    def wait(self, seconds: float) -> None:
        """Wait until another part is here, no longer than that."""
        ...

    def part(self, number: int) -> FibletSet:
        """Return a part, fetched if need be."""
        ...

    def thinned(self, nbytes: int) -> FibletSet:
        """Return an even share of all streamlines that takes about so much GPU memory."""
        ...


class Stretches:
    """Parts of a set in memory or mapped: stretches of streamlines that are coded one after another."""

    by_streamline = False

    def __init__(self, fiblets: FibletSet, gpu_bytes: int, part_bytes: int) -> None:
        self.whole = fiblets
        self._share = min(part_bytes / max(gpu_bytes, 1), 1.0)
        self._gpu_bytes = gpu_bytes  # GPU memory that all of it would take

    @classmethod
    def of_count(cls, fiblets: FibletSet, count: int) -> Stretches:
        """Divide a set into a number of parts, or fewer where it has fewer streamlines."""
        return cls(fiblets, count, 1)

    @cached_property
    def _ranks(self) -> Sequence[int]:
        """First rank of each part, and one past the last: parts have about the same number of bytes of codes."""
        pages = np.asarray(self.whole.pages, np.float64)
        codes = pages[:, 1]
        count = max(int(np.ceil(1.0 / self._share)), 1)
        wanted = np.linspace(0.0, codes[-1], count + 1)[1:-1]
        # Within a page streamlines are taken to be alike; a page has 16,384 fiblets at most.
        edges = np.interp(wanted, codes, pages[:, 0]).astype(np.int64)
        return [int(rank) for rank in np.unique(np.concatenate([[0], edges, [self.whole.n_ranks]]))]

    def __len__(self) -> int:
        return max(len(self._ranks) - 1, 1)

    def box(self, number: int) -> Box | None:  # noqa: ARG002
        """Return None: bounds of a stretch are known from its records alone."""
        return None

    def ids(self, number: int) -> npt.NDArray[np.int64]:
        """Return the numbers of a part's streamlines."""
        ranks = np.arange(*self._ranks[number : number + 2])
        return ranks if self.whole.rank_to_id is None else np.asarray(self.whole.rank_to_id)[ranks]

    def is_here(self, number: int) -> bool:  # noqa: ARG002
        """Return True: all are."""
        return True

    def wait(self, seconds: float) -> None:
        """Return at once."""

    def part(self, number: int) -> FibletSet:
        """Copy a part into memory."""
        ids = self.ids(number)
        return _numbered(restrict(self.whole, ids), ids)

    def thinned(self, nbytes: int) -> FibletSet:
        """Copy an even share into memory."""
        ids = even_share(self.whole, min(nbytes / max(self._gpu_bytes, 1), 1.0))
        return _numbered(restrict(self.whole, ids), ids)


def _numbered(part: FibletSet, ids: npt.NDArray[np.int64]) -> FibletSet:
    """Return a part with its streamlines' numbers, even if it is the whole set: all parts share their programs."""
    return part if part.rank_to_id is not None else replace(part, rank_to_id=ids)


def reach_of(part: FibletSet) -> Box | None:
    """Return bounds of all points of a set, from its anchors; None if it has none."""
    # Each fiblet lies in a sphere of the set's largest radius that its anchor lies in too.
    if not part.n_fiblets:
        return None
    words, low = np.asarray(part.anchors), part.anchors_low
    found = np.empty((2, 3))
    for axis, name in enumerate(("anchor_x", "anchor_y", "anchor_z")):
        at = layout.unpack(name, words).astype(np.int64)
        if low is not None:
            at = (at << 16) | np.asarray(low[:, axis])
        found[:, axis] = part.origin[axis] + part.anchor_scale[axis] * np.array([at.min(), at.max()])
    slack = 2.0 * part.largest_radius + 8.0 * np.spacing(np.abs(found).max())
    found += np.array([[-slack], [slack]])
    return found


def in_view(view: View, style: Style, box: Box | None) -> bool:
    """Return whether anything in a box may show; True where it is not known."""
    if box is None:
        return True
    corners = np.array([[box[i, 0], box[j, 1], box[k, 2], 1.0] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
    corners[:, :3] += style.reach * np.where(corners[:, :3] == box[0], -1.0, 1.0)
    x, y, z, w = view.model_view_projection @ corners.T
    beside = 1.0 if style.exact else 1.5  # no sample of a pixel shows a part that its picture does not
    across, up = (1.0 + 2.0 * (style.half_width + beside) / size for size in view.size)
    deep = np.abs(w) * 1e-6 + style.thickness * np.linalg.norm(view.model_view_projection[2:, :3])
    beyond = (x < -across * w, x > across * w, y < -up * w, y > up * w, z < -w - deep, z > w + deep)
    if any(side.all() for side in beyond):
        return False
    return not any((corners @ plane < -style.reach * np.linalg.norm(plane[:3])).all() for plane in view.clip_planes)
