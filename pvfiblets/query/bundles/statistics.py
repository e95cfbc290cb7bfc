"""A table of bundles: counts, lengths, volumes, and means of arrays and images."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ...images.sources import as_image
from ...streamlines import Streamlines
from ...support.ragged import blocks, offsets_from_counts
from ..density.density_sources import as_source
from ..density.voxel_grid import grid_about, grid_like
from ..measures.chunks import without_groups
from ..measures.samples import PointWeights, check_weights, half_lengths
from ..measures.table import Table
from .bundle_list import Bundles

if TYPE_CHECKING:
    from ...codec.fibletset import FibletSet

CHUNK = 1 << 20  # points decoded together
VOXEL = 1.0  # mm, of the grid that volumes are counted on by default


def bundle_table(
    data: FibletSet | Streamlines,
    groups: Mapping[str, Any] | None = None,
    *,
    images: Mapping[str, Any] | None = None,
    voxel_size: float | None = None,
    like: Any = None,
    weights: PointWeights = "length",
) -> Table:
    """Return a table with a row for each bundle: counts, lengths, volumes, and means of arrays and images.

    Parameters
    ----------
    data : FibletSet or Streamlines
        The tractogram.
    groups : mapping of str to array_like, optional
        Streamlines by name; the groups of `data` by default.
    images : mapping of str to image, optional
        Images by name, sampled at the points: paths, ``(array, affine)``, images of nibabel, or ImageData.
    voxel_size : float, optional
        Side of the voxels that volumes are counted in, mm; 1 by default.
    like : image, optional
        Image whose voxels volumes are counted in, instead of `voxel_size`.
    weights : {"length", "points"}
        Weights of points in means of images and per-point arrays. ``"length"``: half the length of the adjacent
        segments, as in MRtrix's ``tcksample -stat_tck mean``. ``"points"``: all equal.

    Returns
    -------
    Table
        Columns ``bundle``; ``count``, ``points``; ``length_mean``, ``length_std`` (population), ``length_min``,
        ``length_max`` and ``length_total``, mm; ``volume_voxels``, the number of voxels that streamlines pass, and
        ``volume_mm3``; then ``mean_NAME`` and ``std_NAME`` for each image and each per-point or per-streamline array of
        single numbers, over the points (see `weights`) or streamlines that have a value. NaN without values.

    Raises
    ------
    IndexError
        If a streamline is out of range.
    TypeError, ValueError
        If an image is invalid or has several numbers per voxel, `voxel_size` is not above 0, both `voxel_size` and
        `like` are given, or `weights` is unknown.
    """
    from ..density.volume import Visits

    if voxel_size is not None and like is not None:
        raise ValueError("give either voxel_size= (mm) or like= (an image whose grid is taken)")
    check_weights(weights)
    known = {name: as_image(image, f"the image {name!r}") for name, image in (images or {}).items()}
    bundles = Bundles(data)
    chosen = {name: bundles.ids(name) for name in bundles.names}
    if groups is not None:
        chosen = {name: bundles._members(ids) for name, ids in groups.items()}  # noqa: SLF001 - of the same room
    size = VOXEL if voxel_size is None and like is None else voxel_size
    cell = float(size) ** 3 if size is not None else float(abs(np.linalg.det(grid_like(like).affine[:3, :3])))
    ids = np.concatenate([*chosen.values(), np.zeros(0, np.int64)])
    counts = np.array([len(one) for one in chosen.values()], np.int64)
    bundle = np.repeat(np.arange(len(counts)), counts)
    bare = without_groups(data)
    grid = grid_like(like) if size is None else grid_about(*as_source(bare, None, None).box(False), size)
    visits = Visits(grid, len(counts))
    points, lengths = np.zeros(len(counts), np.int64), np.zeros(len(ids))
    sums: dict[str, _Sums] = {}
    sizes = np.asarray((data.counts if isinstance(data, Streamlines) else np.diff(data.offsets()))[ids])
    for a, b in blocks(offsets_from_counts(sizes), CHUNK):
        part = bare[ids[a:b]] if isinstance(bare, Streamlines) else bare.decompress(ids[a:b], dtype=np.float64)
        lengths[a:b] = part.lengths()
        line = np.repeat(np.arange(b - a), part.counts)
        owner = bundle[a:b][line]
        points += np.bincount(owner, minlength=len(counts))
        visits.add(part.points, line, owner)
        values = {key: image.at(part.points, nearest=image.is_labels) for key, image in known.items()}
        of_points = half_lengths(part) if weights == "length" else None
        for key, column in (values | part.per_point).items():
            if _single(column):
                sums.setdefault(key, _Sums(len(counts))).add(column, owner, of_points)
    for key, column in data.per_streamline.items():
        if _single(column):
            sums.setdefault(key, _Sums(len(counts))).add(np.asarray(column)[ids], bundle)
    found = Table(bundle=np.array(list(chosen), dtype=str), count=counts, points=points)
    of_lengths = _Sums(len(counts))
    of_lengths.add(lengths, bundle)
    found |= {"length_mean": of_lengths.mean, "length_std": of_lengths.std}
    for key, extreme, beyond in (("min", np.minimum, np.inf), ("max", np.maximum, -np.inf)):
        rows = np.full(len(counts), beyond)
        with np.errstate(invalid="ignore"):  # the length of a line with a point that is none
            extreme.at(rows, bundle, lengths)
        found[f"length_{key}"] = np.where(counts > 0, rows, np.nan)
    found["length_total"] = np.bincount(bundle, lengths, minlength=len(counts))
    found |= {"volume_voxels": visits.counts, "volume_mm3": visits.counts * cell}
    for key, one in sums.items():
        found |= {f"mean_{key}": one.mean, f"std_{key}": one.std}
    return found


def _single(rows: Any) -> bool:
    return rows.dtype.kind in "biuf" and (rows.ndim == 1 or rows.shape[1:] == (1,))


class _Sums:
    """Mean and spread of each bundle's numbers, which come in parts (Chan, Golub and LeVeque 1983)."""

    def __init__(self, n_bundles: int) -> None:
        self._n, self._mean, self._squares = np.zeros(n_bundles), np.zeros(n_bundles), np.zeros(n_bundles)

    def add(
        self, values: npt.ArrayLike, owner: npt.NDArray[np.int64], weights: npt.NDArray[np.float64] | None = None
    ) -> None:
        """Add numbers, ``(k,)`` or ``(k, 1)``, of bundles, each with its weight or 1."""
        numbers = np.asarray(values, np.float64).ravel()
        weights = np.ones(len(numbers)) if weights is None else weights
        known = np.isfinite(numbers) & (weights > 0)
        numbers, owner, weights, size = numbers[known], owner[known], weights[known], len(self._n)
        n = np.bincount(owner, weights, minlength=size)
        mean = np.bincount(owner, weights * numbers, minlength=size) / np.where(n > 0, n, 1)
        total, apart = np.where(self._n + n > 0, self._n + n, 1), mean - self._mean
        self._squares += np.bincount(owner, weights * (numbers - mean[owner]) ** 2, minlength=size)
        self._squares += apart**2 * self._n * n / total
        self._mean += apart * n / total
        self._n += n

    @property
    def mean(self) -> npt.NDArray[np.float64]:
        return np.where(self._n > 0, self._mean, np.nan)

    @property
    def std(self) -> npt.NDArray[np.float64]:
        return np.where(self._n > 0, np.sqrt(self._squares / np.where(self._n > 0, self._n, 1)), np.nan)
