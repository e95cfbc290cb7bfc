"""Tract profiles: mean values along a bundle.

Streamlines are oriented alike and resampled to positions of equal arc length. At each position the profile is a
weighted mean over the streamlines. The weight is the inverse Mahalanobis distance of a streamline from the mean
position, so streamlines near the bundle's core count more.

Source: Yeatman, Dougherty, Myall, Wandell and Feldman, "Tract profiles of white matter properties: automating
fiber-tract quantification", PLoS ONE 7(11) (2012), methods, "Tract profiles"; dipy's ``afq_profile`` with
``gaussian_weights``.
dipy's covariance matrix has zeros below its diagonal; here it is the symmetric one that the paper's distance needs.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np
import numpy.typing as npt

from ...codec.decompress import select_streamlines
from ...images.sources import as_image, is_image
from ...streamlines import Streamlines
from ...support.real_numbers import real_numbers
from ..measures.band_plot import plot_band
from ..measures.chunks import without_groups
from ..measures.table import Table
from .resampled import check_count
from .students import student_quantile

if TYPE_CHECKING:
    from ...codec.fibletset import FibletSet

Floats = npt.NDArray[np.float64]
Weights = Literal["core", "equal"]
MOST = 1 << 27  # places, streamlines times places along them, that are held together: 3 GB


@dataclass(frozen=True, eq=False)
class TractProfile:
    """Mean of a value along a bundle, with a confidence band.

    Attributes
    ----------
    mean, std : numpy.ndarray
        ``(n,)`` float64: weighted mean and standard deviation; NaN without values.
    low, high : numpy.ndarray
        ``(n,)`` float64: confidence interval of the mean, by Student's distribution; NaN for one streamline.
    position : numpy.ndarray
        ``(n,)`` float64 from 0 to 1: fractions of the length.
    core : numpy.ndarray
        ``(n, 3)`` float64 mm: mean positions; NaN for averaged profiles.
    name : str
        Name of the value.
    bundle : str
        Name of the bundle, or of the group of subjects.
    count : int
        Number of averaged streamlines or profiles.
    confidence : float
        Confidence level of ``low`` and ``high``, between 0 and 1.
    """

    mean: Floats
    std: Floats
    low: Floats
    high: Floats
    position: Floats
    core: Floats
    name: str = ""
    bundle: str = ""
    count: int = 0
    confidence: float = 0.95

    def __len__(self) -> int:
        return len(self.mean)

    def __repr__(self) -> str:
        where = self.bundle or "a bundle"
        return f"TractProfile({self.name!r} along {where}: {len(self)} places, {self.count:,} averaged)"

    def table(self) -> Table:
        """Return a row for each position.

        Columns: ``bundle``, ``value``, ``position``, ``mean``, ``std``, ``low``, ``high``, ``x``, ``y``, ``z``.
        """
        return profile_table([self])

    def plot(self, ax: Any = None, *, color: Any = None) -> Any:
        """Plot the mean and its confidence band with matplotlib.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Axes to draw into; those of a new figure by default.
        color : optional
            A matplotlib colour.

        Returns
        -------
        matplotlib.axes.Axes
        """
        label = self.bundle or self.name
        return plot_band(self.position, self.mean, self.low, self.high, self.name, ax, label=label, color=color)


def tract_profile(
    data: FibletSet | Streamlines,
    ids: Any,
    values: Any,
    n: int = 100,
    *,
    weights: Weights = "core",
    orient_by: npt.ArrayLike | None = None,
    confidence: float = 0.95,
    name: str = "",
    bundle: str = "",
) -> TractProfile:
    """Return the mean of a value at equally spaced positions along a bundle.

    Parameters
    ----------
    data : FibletSet or Streamlines
        The tractogram.
    ids : array_like, slice, Bundle, Cluster or str
        The bundle's streamlines, or the name of a group.
    values : str, image or array_like
        The name of a per-point array, or ``"curvature"`` (1/mm) or ``"arc_length"`` (mm); one number for each point of
        `data`; or an image, sampled at the positions: a path, ``(array, affine)``, an image of nibabel or an ImageData.
    n : int, default: 100
        Number of positions along each streamline, ends included.
    weights : {'core', 'equal'}
        ``"core"``: streamlines near the core count more. ``"equal"``: all count the same.
    orient_by : array_like, optional
        ``(m, 3)`` mm: a line; streamlines that run against it are reversed. By default the first of the bundle.
    confidence : float, default: 0.95
        Confidence level of the band, between 0 and 1. The band assumes independent streamlines, which those of one
        brain are not: :func:`average_profiles` returns bands over subjects.
    name, bundle : str, optional
        Labels for legends and tables.

    Returns
    -------
    TractProfile

    Raises
    ------
    KeyError
        If no array or group has that name.
    IndexError
        If a streamline is out of range.
    ValueError
        If no streamline has points, the values have the wrong shape, or a number is out of range.
    """
    n = check_count(n, "n")
    if weights not in get_args(Weights):
        raise ValueError(f"weights is {weights!r}; give one of {', '.join(map(repr, get_args(Weights)))}")
    student_quantile(confidence, 1)
    bundle = ids if isinstance(ids, str) and not bundle else bundle
    chosen = select_streamlines(len(data), bundle_lines(data, ids))
    if len(chosen) * n > MOST:
        raise ValueError(f"{len(chosen):,} streamlines at {n} places take too much memory; give fewer of either")
    image = as_image(values) if is_image(values) else None
    places, found = _along(data, chosen, None if image is not None else values, n)
    if not len(places):
        raise ValueError("there is no streamline with points to average")
    if image is not None:
        found = image.at(places.reshape(-1, 3), nearest=image.is_labels).reshape(len(places), n)
    like = places[0] if orient_by is None else as_line(orient_by, n)
    turn = runs_backwards(places, like)
    places[turn], found[turn] = places[turn, ::-1], found[turn, ::-1]
    weight = core_weights(places) if weights == "core" else np.full(found.shape, 1.0 / len(found))
    mean, std, low, high = _banded(found, weight, confidence)
    said = name or (values if isinstance(values, str) else "value")
    return TractProfile(
        mean, std, low, high, np.linspace(0.0, 1.0, n), places.mean(axis=0), said, bundle, len(places), confidence
    )


def core_weights(places: Floats) -> Floats:
    """Return the weight of each streamline at each position, by its distance from the core.

    Parameters
    ----------
    places : numpy.ndarray
        ``(m, n, 3)`` float64 mm: `n` positions of `m` streamlines that run the same way.

    Returns
    -------
    numpy.ndarray
        ``(m, n)`` float64: inverse Mahalanobis distances from the mean position; each column sums to 1. Positions in
        one point, on one line or in one plane are measured within it.
    """
    m = len(places)
    apart = places - places.mean(axis=0)
    covariance = np.einsum("mni,mnj->nij", apart, apart) / m
    values, axes = np.linalg.eigh(covariance)
    least = 1e-9 * np.maximum(values[:, -1:], 1e-300)
    inverse = np.where(values > least, 1.0 / np.maximum(values, 1e-300), 0.0)
    along = np.einsum("mni,nij->mnj", apart, axes)
    distance = np.sqrt(np.einsum("mnj,nj->mn", along**2, inverse))
    # On the core itself a weight is large, and never infinite.
    weight = 1.0 / np.maximum(distance, 1e-6)
    scaled: Floats = weight / weight.sum(axis=0)
    return scaled


def average_profiles(profiles: Iterable[TractProfile], *, confidence: float = 0.95, bundle: str = "") -> TractProfile:
    """Average the profiles of several subjects with equal weights.

    Parameters
    ----------
    profiles : iterable of TractProfile
        Profiles of the same value, at the same number of positions.
    confidence : float, default: 0.95
        Confidence level of the band, by Student's distribution over the subjects.
    bundle : str, optional
        Name of the group; by default the bundle of the first profile.

    Returns
    -------
    TractProfile
        ``std``, ``low`` and ``high`` are NaN where fewer than two subjects have a value.

    Raises
    ------
    ValueError
        If there are no profiles, or their numbers of positions differ.
    """
    given = list(profiles)
    if not given or len({len(p) for p in given}) != 1:
        raise ValueError(f"profiles have {[len(p) for p in given]} places; give at least one, all of the same number")
    rows = np.stack([p.mean for p in given])
    mean, std, low, high = _banded(rows, np.full(rows.shape, 1.0 / len(rows)), confidence)
    n = len(given[0])
    return TractProfile(
        mean, std, low, high, given[0].position, np.full((n, 3), np.nan), given[0].name, bundle or given[0].bundle,
        len(given), confidence,
    )  # fmt: skip


def profile_table(profiles: Sequence[TractProfile]) -> Table:
    """Return a row for each position of each profile, with the columns of :meth:`TractProfile.table`."""
    columns: dict[str, list[npt.NDArray[Any]]] = {}
    for p in profiles:
        rows: dict[str, npt.NDArray[Any]] = {
            "bundle": np.array([p.bundle] * len(p), dtype=str), "value": np.array([p.name] * len(p), dtype=str),
            "position": p.position, "mean": p.mean, "std": p.std, "low": p.low, "high": p.high,
        }  # fmt: skip
        rows |= {axis: p.core[:, i] for i, axis in enumerate("xyz")}
        for key, column in rows.items():
            columns.setdefault(key, []).append(column)
    return Table({key: np.concatenate(parts) for key, parts in columns.items()})


def _banded(rows: Floats, weight: Floats, confidence: float) -> tuple[Floats, Floats, Floats, Floats]:
    """Weighted mean and standard deviation of each column, and the band of the mean; rows without a value left out."""
    there = ~np.isnan(rows)
    share = np.where(there, weight, 0.0)
    total = share.sum(axis=0)
    with np.errstate(invalid="ignore", divide="ignore"):
        share = share / total
        mean = np.where(there, rows * share, 0.0).sum(axis=0)
        squares = np.where(there, share * (np.where(there, rows, 0.0) - mean) ** 2, 0.0).sum(axis=0)
        # Effective number of streamlines of equal weight (Kish 1965).
        many = 1.0 / (share**2).sum(axis=0)
        std = np.sqrt(squares * many / (many - 1.0))
        error = std / np.sqrt(many)
    none = total == 0.0
    known = np.isfinite(many) & (many >= 1.5)
    freedom = np.where(known, np.maximum(np.floor(np.where(known, many, 2.0) + 1e-9) - 1.0, 1.0), 1.0).astype(np.int64)
    quantiles = {int(f): student_quantile(confidence, int(f)) for f in np.unique(freedom)}
    half = np.array([quantiles[int(f)] for f in freedom]) * error
    mean = np.where(none, np.nan, mean)
    std, half = (np.where(known & ~none, column, np.nan) for column in (std, half))
    return mean, std, mean - half, mean + half


def bundle_lines(data: FibletSet | Streamlines, ids: Any) -> Any:
    """Return the streamlines of a bundle, a group's by its name, as `select_streamlines` takes them."""
    if not isinstance(ids, str):
        return getattr(ids, "ids", ids)
    if ids not in data.groups:
        raise KeyError(f"there is no group {ids!r}; there are: {', '.join(map(repr, data.groups)) or 'none'}")
    return data.groups[ids]


def runs_backwards(places: Floats, like: Floats) -> npt.NDArray[np.bool_]:
    """Return which streamlines run against a line, by the mean distance of their places from its places."""
    direct, flipped = (np.linalg.norm(one - like, axis=2).mean(axis=1) for one in (places, places[:, ::-1]))
    return np.asarray(flipped < direct)


def as_line(given: npt.ArrayLike, n: int) -> Floats:
    """Resample a user's line to places of equal arc length."""
    line = real_numbers(given, "places of orient_by")
    if line.ndim != 2 or line.shape[1] != 3 or not len(line) or not np.isfinite(line).all():
        raise ValueError(f"orient_by has the shape {line.shape}; give a line as (m, 3) finite numbers of mm")
    return resampled_lines(line, np.zeros(len(line)), np.array([0, len(line)]), n)[0][0]


def resampled_lines(points: Any, values: Any, offsets: Any, n: int) -> tuple[Floats, Floats]:
    """Return positions, ``(m, n, 3)``, and values, ``(m, n)``, at places of equal arc length."""
    from ..measures.measure_kernels import resample

    m = len(offsets) - 1
    places, found = np.empty((m, n, 3)), np.empty((m, n))
    resample(np.require(points, np.float64, ["C", "W"]), np.require(values, np.float64, ["C", "W"]),
             np.require(offsets, np.int64, ["C", "W"]), places, found)  # fmt: skip
    return places, found


def _along(data: FibletSet | Streamlines, chosen: Any, values: Any, n: int) -> tuple[Floats, Floats]:
    """Places of the streamlines that have points, and their values there."""
    bare = without_groups(data)
    part: Any = bare[chosen] if isinstance(bare, Streamlines) else bare.decompress(chosen, dtype=np.float64)
    if values is None:
        numbers: Any = np.zeros(part.n_points)
    elif isinstance(values, str):
        if values in part.per_point:
            numbers = part.per_point[values]
        else:
            from ...codec.encoding.compress import compress
            from ..measures.measures import measure

            found = measure(compress(part, exact=True), values)
            if found.kind != "point":
                raise ValueError(
                    f"{values!r} has a value per {found.kind}; a profile needs values per point, or an image"
                )
            numbers = found.array()
    else:
        numbers = _rows(data, chosen, real_numbers(values, "values"))
    numbers = np.asarray(numbers, np.float64)
    if numbers.ndim == 2 and numbers.shape[1] == 1:
        numbers = numbers[:, 0]
    if numbers.shape != (part.n_points,):
        raise ValueError(f"values have the shape {numbers.shape}; one number per point is needed, or an image")
    counts = np.asarray(part.counts)
    keep = counts > 0
    offsets = np.concatenate([[0], np.cumsum(counts[keep])])
    return resampled_lines(part.points, numbers, offsets, n)


def _rows(data: Any, chosen: Any, values: Any) -> Any:
    offsets = data.offsets if isinstance(data, Streamlines) else data.offsets()
    if values.shape[:1] != (int(offsets[-1]),):
        raise ValueError(f"values have the shape {values.shape}; give one for each of {int(offsets[-1]):,} points")
    counts = np.diff(offsets)[chosen]
    starts = np.cumsum(counts) - counts
    return values[np.arange(int(counts.sum())) + np.repeat(offsets[:-1][chosen] - starts, counts)]
