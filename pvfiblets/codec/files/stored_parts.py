"""A stored set: one file, or shards that are read one after the other."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from ..fibletset import FibletSet

Ints = npt.NDArray[np.int64]


def in_parts(fiblets: FibletSet) -> bool:
    """Whether a set is in shards that are not put together."""
    return hasattr(fiblets, "parts")


def stored_parts(fiblets: FibletSet) -> Iterator[tuple[FibletSet, Ints | None]]:
    """Yield the shards of a set and the numbers that their streamlines have in it; of any other the set and None."""
    if hasattr(fiblets, "parts"):
        yield from fiblets.parts()
    else:
        yield fiblets, None


def of_streamlines(
    fiblets: FibletSet, ask: Callable[[FibletSet], npt.NDArray[Any]], missing: Any, shape: Sequence[int] = ()
) -> Any:
    """Ask for a value of each streamline, shard after shard."""
    out = None
    for part, ids in stored_parts(fiblets):
        found = ask(part)
        if ids is None:
            return found
        if out is None:
            out = np.full((fiblets.n_streamlines, *shape), missing, found.dtype)
        out[ids] = found
    return np.full((fiblets.n_streamlines, *shape), missing) if out is None else out
