"""A row for each bundle: how many streamlines, how long, how large, and what arrays and images say of it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ...streamlines import Streamlines
from ..table import Table
from ..voxel_grid import grid_like
from .bundle_list import Bundles
from .sampling import as_image

if TYPE_CHECKING:
    from ...codec.fibletset import FibletSet

__all__ = ["bundle_table"]

CHUNK = 1 << 20  # points decoded together
VOXEL = 1.0  # mm, of the grid that volumes are counted on by default


def bundle_table(
    data: FibletSet | Streamlines,
    groups: Mapping[str, Any] | None = None,
    *,
    images: Mapping[str, Any] | None = None,
    voxel_size: float | None = None,
    like: Any = None,
) -> Table:
    """Measure bundles.

    Parameters
    ----------
    data : FibletSet or Streamlines
    groups : mapping of str to array_like, optional
        Streamlines by name; the groups of `data` by default.
    images : mapping of str to image, optional
        Images to take means of, by name: of nibabel, paths, or ``(array, affine)``. They are sampled at the points.
    voxel_size : float, optional
        mm: side of the voxels that volumes are counted in; 1 by default.
    like : image, optional
        Whose voxels volumes are counted in, instead.

    Returns
    -------
    Table
        Columns ``bundle``; ``count``, ``points``; ``length_mean``, ``length_std`` (population), ``length_min``,
        ``length_max`` and ``length_total``, mm; ``volume_voxels``, voxels that a streamline passes, cut exactly at
        their faces, and ``volume_mm3``; then for each image, per-point and per-streamline array of single numbers
        ``mean_NAME`` and ``std_NAME``, over points or streamlines that have a value. NaN where there is nothing.

    Raises
    ------
    IndexError
        If a streamline is out of range.
    TypeError, ValueError
        If an image or a voxel's size is none.
    """
    from ..density import density

    known = {name: as_image(image) for name, image in (images or {}).items()}
    for name, image in known.items():
        if image is None:
            raise TypeError(f"the image {name!r} is none; give one of nibabel or its path, or (array, affine)")
    bundles = Bundles(data)
    chosen = {name: bundles.ids(name) for name in bundles.names}
    if groups is not None:
        chosen = {name: bundles._members(ids) for name, ids in groups.items()}  # noqa: SLF001 - of the same room
    size = VOXEL if voxel_size is None and like is None else voxel_size
    cell = float(size) ** 3 if size is not None else float(abs(np.linalg.det(grid_like(like).affine[:3, :3])))
    rows = []
    for name, ids in chosen.items():
        part = data[ids]
        lengths = part.lengths() if len(ids) else np.zeros(0)
        voxels = 0
        if part.n_points:
            voxels = int(np.count_nonzero(density(part, size, like=like).values))
        row: dict[str, Any] = {"bundle": name, "count": len(ids), "points": part.n_points}
        row |= {f"length_{key}": value for key, value in _summary(lengths).items()}
        row |= {"length_total": float(lengths.sum()), "volume_voxels": voxels, "volume_mm3": voxels * cell}
        sums: dict[str, _Sums] = {}
        for chunk in _chunks(part):
            for key, image in known.items():
                assert image is not None
                sums.setdefault(key, _Sums()).add(image.at(chunk.points))
            for key, values in chunk.per_point.items():
                if _single(values):
                    sums.setdefault(key, _Sums()).add(np.asarray(values, np.float64).ravel())
        for key, values in part.per_streamline.items():
            if _single(values):
                sums.setdefault(key, _Sums()).add(np.asarray(values, np.float64).ravel())
        for key, found in sums.items():
            row[f"mean_{key}"], row[f"std_{key}"] = found.mean, found.std
        rows.append(row)
    names = list(dict.fromkeys(key for row in rows for key in row)) or ["bundle", "count"]
    return Table({name: np.array([row.get(name, np.nan) for row in rows]) for name in names})


def _summary(values: npt.NDArray[np.float64]) -> dict[str, float]:
    some = values if len(values) else np.full(1, np.nan)
    return {"mean": float(some.mean()), "std": float(some.std()), "min": float(some.min()), "max": float(some.max())}


def _chunks(part: FibletSet | Streamlines) -> Iterator[Streamlines]:
    if isinstance(part, Streamlines):
        for start, stop in part.blocks(CHUNK):
            yield part[start:stop]
    else:
        yield from part.iter_chunks(CHUNK)


def _single(rows: Any) -> bool:
    return rows.dtype.kind in "biuf" and (rows.ndim == 1 or rows.shape[1:] == (1,))


class _Sums:
    """Mean and spread of numbers that come in parts (Chan, Golub and LeVeque 1983)."""

    def __init__(self) -> None:
        self._n, self._mean, self._squares = 0, 0.0, 0.0

    def add(self, values: npt.NDArray[np.float64]) -> None:
        known = values[np.isfinite(values)]
        if not len(known):
            return
        n, mean = len(known), float(known.mean())
        apart, total = mean - self._mean, self._n + len(known)
        self._squares += float(((known - mean) ** 2).sum()) + apart**2 * self._n * n / total
        self._mean += apart * n / total
        self._n = total

    @property
    def mean(self) -> float:
        return self._mean if self._n else float("nan")

    @property
    def std(self) -> float:
        return float(np.sqrt(self._squares / self._n)) if self._n else float("nan")
