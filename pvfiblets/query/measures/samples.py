"""Values of an image along streamlines: one for each point, or a statistic of each streamline."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np
import numpy.typing as npt

from ...codec.files.open_lines import open_lines
from ...images.sources import as_image
from ...streamlines import Streamlines
from .chunks import chunks_of, without_groups

if TYPE_CHECKING:
    from ...codec.fibletset import FibletSet

Floats = npt.NDArray[np.float64]
PointWeights = Literal["length", "points"]
Statistic = Literal["mean", "median", "min", "max"]


def sample(
    data: FibletSet | Streamlines | str | os.PathLike[str],
    image: Any,
    statistic: Statistic | None = None,
    *,
    weights: PointWeights = "length",
    nearest: bool = False,
) -> Floats:
    """Sample an image along streamlines, as MRtrix's ``tcksample`` does.

    Parameters
    ----------
    data : FibletSet, Streamlines, str or PathLike
    image : image
        A path, ``(array, affine)``, an image of nibabel, or a :class:`pyvista.ImageData`.
    statistic : {'mean', 'median', 'min', 'max'}, optional
        Statistic of each streamline; by default, the values of all points are returned.
    weights : {'length', 'points'}
        Weights of points in means: half the length of the adjacent segments, as in ``tcksample``, or equal weights.
        Points of streamlines without a length have equal weights.
    nearest : bool, default: False
        Take the nearest voxel's value, as labels need it. By default values are linear between the centres of voxels.

    Returns
    -------
    numpy.ndarray
        ``(n_points,)`` float64 in the order of `data`, or ``(n_streamlines,)``. NaN outside the image and next to
        voxels that are NaN; a statistic is of the points that have a value, and NaN without any.

    Raises
    ------
    FormatError
        If a file is damaged.
    TypeError
        If ``image`` is not an image.
    ValueError
        If the image has other than one number per voxel, or there is no such statistic.

    Notes
    -----
    ``tcksample`` returns 0 instead of NaN, and includes it in statistics.

    Examples
    --------
    >>> import pvfiblets
    >>> fa = pvfiblets.sample("brain.trk", "fa.nii.gz", "mean")  # doctest: +SKIP
    """
    check_weights(weights)
    if statistic is not None and statistic not in get_args(Statistic):
        raise ValueError(f"unknown statistic {statistic!r}; choose one of {', '.join(map(repr, get_args(Statistic)))}")
    taken = as_image(image)
    nearest = nearest or taken.is_labels
    lines = open_lines(data) if isinstance(data, (str, os.PathLike)) else data
    parts = [np.zeros(0)]
    for chunk in chunks_of(without_groups(lines)):
        values = taken.at(chunk.points, nearest=nearest)
        parts.append(values if statistic is None else along(values, chunk, statistic, weights))
    return np.concatenate(parts)


def check_weights(weights: str) -> None:
    """Raise a ValueError unless points can be weighed so."""
    if weights not in get_args(PointWeights):
        raise ValueError(f"unknown weights {weights!r}; choose 'length' or 'points'")


def along(values: Floats, lines: Streamlines, statistic: Statistic, weights: PointWeights) -> Floats:
    """Return a statistic of the values of each streamline's points that have one; NaN without any."""
    n, known = len(lines), np.isfinite(values)
    owner = np.repeat(np.arange(n), lines.counts)[known]
    found, counts = np.full(n, np.nan), np.bincount(owner, minlength=n)
    some = counts > 0
    if statistic == "mean":
        weight = half_lengths(lines)[known] if weights == "length" else np.ones(len(owner))
        weight = np.where(np.bincount(owner, weight, n)[owner] > 0.0, weight, 1.0)
        total, sums = np.bincount(owner, weight, n), np.bincount(owner, weight * values[known], n)
        found[some] = sums[some] / total[some]
        return found
    rows = values[known]
    rows, first = rows[np.lexsort((rows, owner))], np.cumsum(counts) - counts
    if statistic == "median":
        found[some] = (rows[(first + (counts - 1) // 2)[some]] + rows[(first + counts // 2)[some]]) / 2
    else:
        found[some] = rows[(first if statistic == "min" else first + counts - 1)[some]]
    return found


def means_along(fiblets: FibletSet, coded: Floats) -> Floats:
    """Return the mean along each streamline of values of points in the order in which these are coded."""
    values, point = np.empty(fiblets.n_points), 0
    values[fiblets.in_coded_order(np.arange(fiblets.n_points))] = coded
    parts = [np.zeros(0)]
    for chunk in chunks_of(without_groups(fiblets)):
        parts.append(along(values[point : point + chunk.n_points], chunk, "mean", "length"))
        point += chunk.n_points
    return np.concatenate(parts)


def half_lengths(lines: Streamlines) -> Floats:
    """Return half the length (mm) of the segments beside each point."""
    steps = np.linalg.norm(np.diff(lines.points.astype(np.float64), axis=0), axis=1)
    steps[np.setdiff1d(lines.offsets[1:-1], [0, len(lines.points)]) - 1] = 0.0  # between streamlines
    return (np.r_[0.0, steps] + np.r_[steps, 0.0])[: len(lines.points)] / 2
