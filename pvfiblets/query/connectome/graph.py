"""Connectomes as graphs: where their nodes lie, which weights their edges have, and the mean streamline of each edge.

Nodes are the parcels of an atlas, at the mean of their voxels' centres, in mm. Edges have no direction: a matrix is
symmetric, or one of its triangles is empty, as MRtrix's ``tck2connectome`` writes it without ``-symmetric``.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ...images.sources import as_image, is_image
from ...support.real_numbers import real_numbers
from ..bundles.resampled import iter_resampled
from .matrix import Connectome, Floats, Ints, end_labels, opened, read_matrix

if TYPE_CHECKING:
    from ...codec.fibletset import FibletSet
    from ...images.image import Image
    from ...streamlines import Streamlines

ROUNDING = 1e-5  # share by which the two numbers of a pair may differ, as printed numbers do


@dataclass(frozen=True, eq=False)
class Graph:
    """Nodes in space, and the edges between them."""

    weights: Floats  # `(n, n)`, symmetric; 0 where there is no edge, and on the diagonal
    positions: Floats  # `(n, 3)` mm; NaN of a node that the atlas lacks
    labels: Ints  # `(n,)`: label of each node's parcel, rising; 1 to n where there is no atlas
    names: list[str] | None  # that the matrix came with
    atlas: Image | None
    ends: Ints | None  # `(n_streamlines, 2)`: labels at the ends of the streamlines that were counted

    @property
    def pairs(self) -> Ints:
        """``(m, 2)`` nodes of each edge, the lower number first, rising."""
        placed = ~np.isnan(self.positions.sum(axis=1))
        return np.argwhere((np.triu(self.weights) != 0.0) & np.outer(placed, placed))


def as_graph(matrix: Any, labels: Any) -> Graph:
    """Return the graph of a matrix, whose nodes are an atlas' labels or lie at ``(n, 3)`` positions."""
    names: list[str] | None = None
    if isinstance(matrix, Connectome):
        numbers, names = matrix.matrix, matrix.names
    elif isinstance(matrix, (str, os.PathLike)):
        numbers, names = read_matrix(matrix)
    else:
        numbers = real_numbers(matrix, "weights of the matrix")
    weights = _weights(numbers)
    n = len(weights)
    ends = matrix.ends if isinstance(matrix, Connectome) else None
    if not is_image(labels):
        positions = real_numbers(labels, "positions of nodes")
        if positions.shape != (n, 3):
            raise ValueError(
                f"labels have the shape {positions.shape}; give an image of labels, such as a path or (array, affine), "
                f"or ({n}, 3) positions for a matrix of {n} rows"
            )
        known = matrix.labels if isinstance(matrix, Connectome) else np.arange(1, n + 1)
        return Graph(weights, positions, known, names, None, ends)
    atlas = as_image(labels, "the atlas")
    found = np.unique(atlas.labels)
    found = found[found != 0].astype(np.int64)
    known = matrix.labels if isinstance(matrix, Connectome) else _rows(found, n, atlas.what)
    return Graph(weights, _centres(atlas, known), known, names, atlas, ends)


def _weights(given: npt.NDArray[Any]) -> Floats:
    """Return a symmetric matrix without NaN and diagonal."""
    if given.ndim != 2 or given.shape[0] != given.shape[1] or not len(given):
        raise ValueError(f"the matrix has the shape {given.shape}; a row and a column for each node are needed")
    if np.isinf(given).any():
        row, column = np.argwhere(np.isinf(given))[0]
        raise ValueError(f"the matrix is {given[row, column]} at [{row}, {column}]; give finite numbers, or NaN")
    weights = np.nan_to_num(np.array(given, np.float64))
    np.fill_diagonal(weights, 0.0)
    if not np.tril(weights).any() or not np.triu(weights).any():
        return weights + weights.T
    apart = abs(weights - weights.T) > ROUNDING * np.maximum(abs(weights), abs(weights.T))
    if apart.any():
        row, column = np.argwhere(apart)[0]
        raise ValueError(
            f"the matrix is not symmetric: [{row}, {column}] is {weights[row, column]:g} and [{column}, {row}] is "
            f"{weights[column, row]:g}; edges have no direction: give one triangle, or (matrix + matrix.T) / 2"
        )
    return 0.5 * (weights + weights.T)


def _rows(found: Ints, n: int, what: str) -> Ints:
    """Return the label of each row of a matrix: all labels in their order, or all numbers up to the highest."""
    if len(found) == n:
        return found
    if len(found) and found[0] > 0 and found[-1] == n:
        return np.arange(1, n + 1)
    between = f", {found[0]} to {found[-1]}" if len(found) else ""
    raise ValueError(
        f"the matrix has {n} rows, and {what} has {len(found)} labels{between}; a row is needed for each label, or for "
        "each number from 1 to the highest label"
    )


def _centres(atlas: Image, labels: Ints) -> Floats:
    """Return the mean of the voxels' centres of each label, in mm; NaN of labels without voxels."""
    voxels = np.argwhere(atlas.labels)
    given = atlas.labels[tuple(voxels.T)]
    rows = np.minimum(np.searchsorted(labels, given), len(labels) - 1)
    known = labels[rows] == given
    voxels, rows = voxels[known], rows[known]
    with np.errstate(invalid="ignore"):
        means = [np.bincount(rows, axis, len(labels)) / np.bincount(rows, minlength=len(labels)) for axis in voxels.T]
    centres: Floats = np.stack(means, axis=1) @ atlas.affine[:3, :3].T + atlas.affine[:3, 3]
    return centres


def mean_streamlines(graph: Graph, source: Any, n_points: int = 32) -> tuple[Floats, Ints]:
    """Return the mean streamline of each edge, ``(m, n_points, 3)``, and of how many streamlines it is the mean.

    They are resampled by arc length and turned to begin at the edge's first node. Edges without any are NaN.
    """
    data: FibletSet | Streamlines = opened(getattr(source, "fiblets", source))
    if graph.ends is not None and len(graph.ends) == len(data):
        ends = graph.ends
    elif graph.atlas is not None:
        ends = end_labels(data, graph.atlas)
    else:
        raise ValueError(
            f"there are no labels at the ends of {len(data):,} streamlines; give labels as an image, or the matrix as "
            "fiblets.connectome(...) of the same streamlines returns it"
        )
    n, pairs = len(graph.labels), graph.pairs
    nodes = np.minimum(np.searchsorted(graph.labels, ends), n - 1)
    low, high = np.sort(nodes, axis=1).T
    edges = np.full((n, n), -1)
    edges[tuple(pairs.T)] = np.arange(len(pairs))
    edge = np.where((graph.labels[nodes] == ends).all(axis=1), edges[low, high], -1)
    sums, counts = np.zeros((len(pairs), n_points, 3)), np.zeros(len(pairs), np.int64)
    for ids, lines in iter_resampled(data, n_points, np.flatnonzero(edge >= 0)):
        backwards = nodes[ids, 0] > nodes[ids, 1]
        lines[backwards] = lines[backwards, ::-1]
        order = np.argsort(edge[ids], kind="stable")
        into, first, many = np.unique(edge[ids][order], return_index=True, return_counts=True)
        sums[into] += np.add.reduceat(lines[order].astype(np.float64), first, axis=0)
        counts[into] += many
    with np.errstate(invalid="ignore"):
        return sums / counts[:, None, None], counts
