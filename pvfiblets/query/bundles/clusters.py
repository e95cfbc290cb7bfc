"""Clusters of streamlines that run alike: QuickBundles.

Source: Garyfallidis, Brett, Correia, Williams and Nimmo-Smith, "QuickBundles, a method for tractography
simplification", Frontiers in Neuroscience 6:175 (2012), section 2.3. One pass over the streamlines: each joins the
cluster whose mean line is nearest, if that is near enough, and begins one of its own otherwise. The result depends on
their order, which is that of the set.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ...codec.decompress import select_streamlines
from ...codec.progress import Progress
from ...streamlines import Streamlines
from .colours import distinct_colours
from .resampled import check_count, check_distance, iter_resampled

if TYPE_CHECKING:
    from ...codec.fibletset import FibletSet

Ints = npt.NDArray[np.int64]
ROOM = 1024  # clusters with memory at first


@dataclass(frozen=True, eq=False)
class Cluster:
    """A cluster of similar streamlines; usable as an index: ``fiblets[cluster]``.

    Attributes
    ----------
    number : int
        Index of the cluster.
    ids : numpy.ndarray
        ``(k,)`` int64, rising.
    centroid : numpy.ndarray
        ``(n_points, 3)`` float32 mm: the mean of its streamlines, oriented like the first.
    """

    number: int
    ids: Ints
    centroid: npt.NDArray[np.float32]

    def __len__(self) -> int:
        return len(self.ids)

    def __repr__(self) -> str:
        return f"Cluster({self.number}: {len(self):,} streamlines)"

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> npt.NDArray[Any]:
        del copy  # numbers are small, and a copy is never wrong
        return np.array(self.ids, dtype)

    @property
    def count(self) -> int:
        """Number of streamlines."""
        return len(self.ids)


@dataclass(frozen=True, eq=False)
class Clusters:
    """All clusters of a set: a sequence of :class:`Cluster`.

    Attributes
    ----------
    labels : numpy.ndarray
        ``(n_streamlines,)`` int32: index of each streamline's cluster, or -1.
    counts : numpy.ndarray
        ``(n_clusters,)`` int64: streamlines of each cluster.
    centroids : numpy.ndarray
        ``(n_clusters, n_points, 3)`` float32 mm: mean line of each cluster.
    threshold : float
        Distance at which a streamline starts a new cluster, mm.
    """

    labels: npt.NDArray[np.int32]
    counts: Ints
    centroids: npt.NDArray[np.float32]
    threshold: float

    def __len__(self) -> int:
        return len(self.counts)

    def __getitem__(self, number: int) -> Cluster:
        n = len(self)
        if not -n <= number < n:
            raise IndexError(f"cluster {number} is not among the {n} clusters (0..{n - 1})")
        number = number + n if number < 0 else number
        start = int(self._starts[number])
        ids = self._order[start : start + int(self.counts[number])]
        return Cluster(int(number), np.sort(ids), self.centroids[number])

    def __iter__(self) -> Iterator[Cluster]:
        return (self[number] for number in range(len(self)))

    def __repr__(self) -> str:
        largest = f", the largest of {int(self.counts.max()):,}" if len(self) else ""
        return f"Clusters({len(self):,} of {int(self.counts.sum()):,} streamlines at {self.threshold:g} mm{largest})"

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> npt.NDArray[Any]:
        del copy
        return np.array(self.labels, dtype)

    @property
    def _order(self) -> Ints:
        return self._cached()[0]

    @property
    def _starts(self) -> Ints:
        return self._cached()[1]

    def _cached(self) -> tuple[Ints, Ints]:
        """Streamlines by cluster, and where each cluster's begin; made once."""
        found = self.__dict__.get("_sorted")
        if found is None:
            order = np.argsort(self.labels, kind="stable").astype(np.int64)
            starts = np.searchsorted(self.labels[order], np.arange(len(self)))
            found = self.__dict__["_sorted"] = (order, starts.astype(np.int64))
        return found

    def by_size(self, at_least: int = 1) -> Clusters:
        """Return the clusters sorted by size, largest first.

        Parameters
        ----------
        at_least : int, default: 1
            Clusters with fewer streamlines are dropped; their streamlines get the label -1.
        """
        kept = np.flatnonzero(self.counts >= at_least)
        kept = kept[np.argsort(-self.counts[kept], kind="stable")]
        numbers = np.full(len(self) + 1, -1, np.int32)  # the last for unclustered ones
        numbers[kept] = np.arange(len(kept))
        return Clusters(numbers[self.labels], self.counts[kept], self.centroids[kept], self.threshold)

    def groups(self, name: str = "cluster {}", at_least: int = 1) -> dict[str, Ints]:
        """Return the clusters as groups by name, the largest first: ``fiblets.bundles.add(**clusters.groups())``.

        Parameters
        ----------
        name : str, default: "cluster {}"
            Template of the names; ``{}`` becomes 1, 2, and so on.
        at_least : int, default: 1
            Clusters with fewer streamlines are dropped.
        """
        return {name.format(cluster.number + 1): cluster.ids for cluster in self.by_size(at_least)}

    def colors(self) -> npt.NDArray[np.uint8]:
        """Return a colour for each streamline, ``(n_streamlines, 3)`` uint8, for ``scalars=``; grey outside clusters.

        Successive clusters have distinct colours.
        """
        table = np.concatenate([np.round(distinct_colours(len(self)) * 255.0), [[128.0] * 3]]).astype(np.uint8)
        return table[self.labels]

    def lines(self) -> Streamlines:
        """Return the centroids as streamlines; ``count`` holds the size of each cluster."""
        n, m = self.centroids.shape[:2]
        return Streamlines(
            self.centroids.reshape(-1, 3), m * np.arange(n + 1), per_streamline={"count": np.array(self.counts)}
        )


def clusters(
    data: FibletSet | Streamlines,
    threshold: float = 10.0,
    *,
    n_points: int = 12,
    max_clusters: int | None = None,
    ids: Any = None,
    progress: Progress = False,
) -> Clusters:
    """Cluster similar streamlines (QuickBundles), in one pass and bounded memory.

    Parameters
    ----------
    data : FibletSet or Streamlines
        The tractogram.
    threshold : float, default: 10.0
        mm: a streamline farther than this (MDF distance) from the mean line of every cluster starts a new cluster.
    n_points : int, default: 12
        Number of points to which streamlines are resampled, at equal arc length.
    max_clusters : int, optional
        Once there are this many clusters, streamlines join the nearest one at any distance.
    ids : array_like, optional
        Streamlines to cluster, in this order; by default all, in their own order.
    progress : bool or callable
        Show a progress bar; or call this with the name of the step and its finished share, from 0 to 1. What it raises
        ends the work.

    Returns
    -------
    Clusters
        Clusters in the order of their first streamlines. Streamlines without points have the label -1.

    Raises
    ------
    ValueError
        If a number is out of range, or `ids` repeat a streamline.
    IndexError
        If a streamline is out of range.

    Notes
    -----
    The result equals dipy's ``QuickBundles(threshold).cluster(streamlines)`` up to rounding.
    """
    from .similarity_kernels import add_to_clusters

    reach, n_points = check_distance(threshold, "threshold"), check_count(n_points)
    most = np.iinfo(np.int32).max if max_clusters is None else int(max_clusters)
    if most < 1:
        raise ValueError(f"max_clusters is {max_clusters}; give 1 or more, or None")
    chosen = None if ids is None else select_streamlines(len(data), ids)
    if chosen is not None and len(np.unique(chosen)) != len(chosen):
        raise ValueError("ids name a streamline twice; each can be in one cluster only")
    labels = np.full(len(data), -1, np.int32)
    centroids, means = np.zeros((ROOM, n_points, 3), np.float32), np.zeros((3, ROOM), np.float32)
    counts, used = np.zeros(ROOM, np.int64), 0
    for numbers, lines in iter_resampled(data, n_points, chosen, progress, "clustering"):
        found, at = np.empty(len(lines), np.int32), 0
        while at < len(lines):
            if used == len(counts):
                centroids = np.concatenate([centroids, np.zeros_like(centroids)])
                means = np.ascontiguousarray(np.concatenate([means, np.zeros_like(means)], axis=1))
                counts = np.concatenate([counts, np.zeros_like(counts)])
            at, used = add_to_clusters(lines, at, reach, most, centroids, means, counts, used, found)
        labels[numbers] = found
    return Clusters(labels, counts[:used].copy(), centroids[:used].copy(), reach)
