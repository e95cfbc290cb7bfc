"""How far apart lines or points lie, and the widths that suit them."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from .neighbours import Cloud, Frame, Paths, distances
from .things import HaloLines, HaloPoints

__all__ = ["default_widths", "line_spacing", "point_spacing"]

_ALONE = 1.0 / 60.0
"""Spacing, by the diagonal of the bounds, of what has no neighbours."""


def line_spacing(lines: HaloLines, samples: int = 2000, seed: int = 0) -> float:
    """How far apart lines lie.

    Parameters
    ----------
    lines : HaloLines
        Lines without length count as points that others are near to, and lines of one point not at all.
    samples : int, default: 2000
        Places to measure at, spread evenly over the length of all lines.
    seed : int, default: 0
        Of where exactly.

    Returns
    -------
    float
        mm: the median distance from a place on a line to the nearest place on another line. Lines that pass through
        the place itself, as duplicates do, are left out where there are others. A sixtieth of the diagonal of the
        bounds if there are none; 1 if all points are at one place.

    Raises
    ------
    ValueError
        If there is not at least one sample.

    Examples
    --------
    >>> import numpy as np
    >>> from pvfiblets.halos import HaloLines
    >>> from pvfiblets.halos.spacing import line_spacing
    >>> points = [[0, 0, 0], [100, 0, 0], [0, 2, 0], [100, 2, 0]]
    >>> round(line_spacing(HaloLines(np.array(points), [0, 2, 4])), 6)
    2.0
    """
    _check_samples(samples)
    frame = Frame.around(lines.points)
    paths = Paths(lines, frame)
    found = np.zeros(0)
    if len(paths) > 1 and paths.length > 0.0:
        rng = np.random.default_rng(seed)
        where = rng.permutation((np.arange(samples) + rng.random(samples)) * (paths.length / samples))
        line = paths.line_at(where)
        found = distances(paths, paths.at(line, where), line)
    return _median(found, frame)


def point_spacing(points: HaloPoints, samples: int = 2000, seed: int = 0) -> float:
    """How far apart points lie.

    Parameters
    ----------
    points : HaloPoints
        The points.
    samples : int, default: 2000
        Points to measure at.
    seed : int, default: 0
        Of which.

    Returns
    -------
    float
        mm: the median distance from a point to the nearest other one, those at the same place left out where there are
        others. A sixtieth of the diagonal of the bounds for a single point's place; 1 if there is nothing else.

    Raises
    ------
    ValueError
        If there is not at least one sample.
    """
    _check_samples(samples)
    frame = Frame.around(points.points)
    found = np.zeros(0)
    if points.n_points > 1 and frame.size > 0.0:
        some = np.random.default_rng(seed).choice(points.n_points, min(samples, points.n_points), replace=False)
        cloud = Cloud(points.points, frame)
        found = distances(cloud, cloud.at(some), some)
    return _median(found, frame)


def default_widths(
    drawn: HaloLines | HaloPoints,
    line_width: float | None = None,
    strip_width: float | None = None,
    max_displacement: float | None = None,
) -> tuple[float, float, float]:
    """Widths and the displacement that suit the data.

    Parameters
    ----------
    drawn : HaloLines or HaloPoints
        The data.
    line_width, strip_width, max_displacement : float, optional
        mm; what is given stays as it is.

    Returns
    -------
    tuple of float
        Line width, strip width and largest displacement, mm, as :class:`.Look` takes them.
    """
    diagonal = Frame.around(drawn.points).diagonal or 1.0
    are_lines = isinstance(drawn, HaloLines)
    if line_width is None:
        spacing = line_spacing(drawn) if isinstance(drawn, HaloLines) else point_spacing(drawn)
        line_width = float(np.clip(0.4 * spacing, diagonal / 3000.0, diagonal / 150.0))
        if strip_width is not None:
            line_width = min(line_width, 0.5 * strip_width)
    if strip_width is None:
        strip_width = (6.0 if are_lines else 10.0) * line_width
    if max_displacement is None:
        max_displacement = max(4.0 * strip_width, diagonal / 50.0)
    return line_width, strip_width, max_displacement


def _median(found: npt.NDArray[np.float64], frame: Frame) -> float:
    """The median in mm, or what stands for it."""
    found = found[~np.isnan(found)]
    if 2 * np.count_nonzero(np.isfinite(found)) <= len(found):
        found = found[np.isfinite(found)]
    return float(np.median(found)) * frame.size if len(found) else _ALONE * frame.diagonal or 1.0


def _check_samples(samples: int) -> None:
    if samples < 1:
        raise ValueError(f"samples is {samples}; give a whole number of places to measure at, 1 or more")
