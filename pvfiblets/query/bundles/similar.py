"""Streamlines similar to given ones."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ...codec.decompress import select_streamlines
from ...codec.progress import Progress
from ...streamlines import Streamlines
from .resampled import check_count, check_distance, iter_resampled, resampled

if TYPE_CHECKING:
    from ...codec.fibletset import FibletSet

Ints = npt.NDArray[np.int64]
Floats = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Similar:
    """Streamlines similar to given lines; usable as an index: ``fiblets[found]``.

    Attributes
    ----------
    ids : numpy.ndarray
        ``(k,)`` int64, the nearest first.
    distances : numpy.ndarray
        ``(k,)`` float64 mm: MDF distance of each from the nearest given line.
    nearest : numpy.ndarray
        ``(k,)`` int64: index of that given line.
    n_streamlines : int
        Number of streamlines of the whole set.
    distance : float
        Requested distance, mm.
    """

    ids: Ints
    distances: Floats
    nearest: Ints
    n_streamlines: int
    distance: float

    def __len__(self) -> int:
        return len(self.ids)

    def __repr__(self) -> str:
        return f"Similar({len(self):,} of {self.n_streamlines:,} streamlines within {self.distance:g} mm)"

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> npt.NDArray[Any]:
        del copy  # numbers are small, and a copy is never wrong
        return np.array(self.ids, dtype)

    @property
    def mask(self) -> npt.NDArray[np.bool_]:
        """``(n_streamlines,)`` bool."""
        found = np.zeros(self.n_streamlines, bool)
        found[self.ids] = True
        return found

    def values(self) -> Floats:
        """Return the distance of each streamline of the set, ``(n_streamlines,)`` mm, NaN beyond: for ``scalars=``."""
        found = np.full(self.n_streamlines, np.nan)
        found[self.ids] = self.distances
        return found


def similar(
    data: FibletSet | Streamlines,
    like: Any,
    distance: float = 10.0,
    *,
    n_points: int = 12,
    ids: Any = None,
    progress: Progress = False,
) -> Similar:
    """Find streamlines similar to given ones from end to end, in either direction.

    Parameters
    ----------
    data : FibletSet or Streamlines
        The tractogram to search. A FibletSet is decoded in chunks.
    like : array_like, Streamlines or list of array_like
        The given lines: numbers of streamlines of `data` (or a mask or slice), or new lines in mm: ``Streamlines``, an
        ``(n, 3)`` array or a list of such arrays.
    distance : float, default: 10.0
        mm: largest MDF distance from the nearest given line.
    n_points : int, default: 12
        Number of points to which all lines are resampled, at equal arc length.
    ids : array_like, optional
        Streamlines to search; all by default.
    progress : bool or callable
        Show a progress bar; or call this with the name of the step and its finished share, from 0 to 1. What it raises
        ends the work.

    Returns
    -------
    Similar
        Given streamlines of `data` are part of the result.

    Raises
    ------
    ValueError
        If no line with points is given, or `distance` or `n_points` is out of range.
    IndexError
        If a streamline is out of range, or a mask has the wrong length.

    Notes
    -----
    Minimum average direct-flip distance: Garyfallidis et al. 2012, "QuickBundles, a method for tractography
    simplification", section 2.2; dipy's ``bundles_distances_mdf`` of resampled streamlines.
    """
    from .similarity_kernels import nearest as nearest_of

    reach, n_points = check_distance(distance, "distance"), check_count(n_points)
    others = _others(data, like, n_points)
    if not len(others):
        raise ValueError("no reference: give at least one streamline with points")
    chosen = None if ids is None else select_streamlines(len(data), ids)
    parts: list[tuple[Ints, Floats, Ints]] = []
    for numbers, lines in iter_resampled(data, n_points, chosen, progress, "comparing"):
        apart, which = np.empty(len(lines)), np.empty(len(lines), np.int64)
        nearest_of(lines, others, reach, apart, which)
        near = np.flatnonzero(which >= 0)
        parts.append((numbers[near], apart[near], which[near]))
    empty = (np.empty(0, np.int64), np.empty(0), np.empty(0, np.int64))
    found, distances, nearest = (np.concatenate(columns) for columns in zip(empty, *parts, strict=True))
    order = np.lexsort((found, distances))
    return Similar(found[order], distances[order], nearest[order], len(data), reach)


def mdf(a: Any, b: Any, n_points: int = 12) -> Floats:
    """Return the MDF distances between the lines of two sets.

    Parameters
    ----------
    a, b : Streamlines or list of array_like
        `n` and `m` lines, mm.
    n_points : int, default: 12
        Number of points to which all lines are resampled, at equal arc length.

    Returns
    -------
    numpy.ndarray
        ``(n, m)`` float64 mm.

    Raises
    ------
    ValueError
        If a line has no points, or ``n_points`` is below 2.
    """
    from .similarity_kernels import pairs

    n_points = check_count(n_points)
    first, second = _own_lines(a, n_points), _own_lines(b, n_points)
    out = np.empty((len(first), len(second)))
    pairs(first, second, out)
    return out


def _others(data: FibletSet | Streamlines, like: Any, n_points: int) -> npt.NDArray[np.float32]:
    if isinstance(like, Streamlines) or _are_lines(like):
        return _own_lines(like, n_points)
    chosen = select_streamlines(len(data), getattr(like, "ids", like))
    parts = [lines for _, lines in iter_resampled(data, n_points, chosen)]
    return np.concatenate(parts) if parts else np.empty((0, n_points, 3), np.float32)


def _are_lines(like: Any) -> bool:
    if isinstance(like, np.ndarray):
        return like.ndim in (2, 3) and like.shape[-1] == 3
    return isinstance(like, (list, tuple)) and len(like) > 0 and np.ndim(like[0]) == 2


def _own_lines(given: Any, n_points: int) -> npt.NDArray[np.float32]:
    if not isinstance(given, Streamlines):
        rows = [given] if isinstance(given, np.ndarray) and given.ndim == 2 else list(given)
        given = Streamlines.from_list([np.asarray(row, np.float64) for row in rows])
    if (given.counts == 0).any():
        raise ValueError("a line without points has no distance; leave it out")
    return resampled(given, n_points)
