"""Spacing of lines or points, and widths that suit it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .geometry import HaloLines, HaloPoints
from .neighbours import Cloud, Frame, Paths, distances

_ALONE = 1.0 / 60.0  # spacing of data without neighbours, as a share of the bounds' diagonal


def line_spacing(lines: HaloLines, samples: int = 2000, seed: int = 0) -> float:
    """Return the spacing of lines."""
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
    """Return the spacing of points."""
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
    """Widths and the displacement that suit the data."""
    # Everts et al. 2009, section 4.3, have strips 4 to 8 times as wide as their lines, and 8 to 27 times for points
    # (printed the other way round), and thinner lines for more of them.
    #
    # - A line takes 2/5 of the spacing, so that a sheet of lines that all lie in front is half white, half black.
    #   Where the data fill a window of 1000 pixels, that is at least about a pixel (1/1200 of the diagonal of the
    #   bounds; of points 1/1500), however dense they are: thinner ones would be as thick on the screen, and all of it
    #   grey. It is at most 1/200.
    # - A strip is 6 times as wide (of points 10 times), and so reaches over one to two neighbours (of points two). Of
    #   dense data it is wider, up to 8 (19) times, for its halo to be about three pixels wide in such a window.
    # - Its edge lies 4 times its width behind. So within a strip a line behind is seen if it is at most 8 times as far
    #   behind as it is away on the screen: bundles and surfaces stay together at all but grazing angles, and lines that
    #   cross farther behind are set apart. Doubling it lets layers behind a sheet of lines show through it.
    diagonal = Frame.around(drawn.points).diagonal or 1.0
    shape = _LINES if isinstance(drawn, HaloLines) else _POINTS
    if line_width is None:
        spacing = line_spacing(drawn) if isinstance(drawn, HaloLines) else point_spacing(drawn)
        line_width = min(max(0.4 * spacing, diagonal / shape.thinnest), diagonal / shape.thickest)
        if strip_width is not None:
            line_width = min(line_width, 0.5 * strip_width)
    if strip_width is None:
        strip_width = min(max(shape.strip * line_width, diagonal / shape.narrowest), shape.widest * line_width)
    if max_displacement is None:
        max_displacement = 4.0 * strip_width
    return line_width, strip_width, max_displacement


@dataclass(frozen=True)
class _Proportions:
    """Limits of widths, by the widths of lines or as parts of the diagonal of the bounds."""

    thinnest: float  # A line is at least and at most one such part of the diagonal
    thickest: float
    strip: float  # A strip is at least so many times as wide as its line
    narrowest: float  # it is at least such a part of the diagonal too, if it can be with `widest`
    widest: float  # it is at most so many times as wide as its line


_LINES = _Proportions(1200.0, 200.0, 6.0, 150.0, 8.0)
_POINTS = _Proportions(1500.0, 200.0, 10.0, 80.0, 27.0)


def _median(found: npt.NDArray[np.float64], frame: Frame) -> float:
    """The median in mm, or its default."""
    found = found[~np.isnan(found)]
    if 2 * np.count_nonzero(np.isfinite(found)) <= len(found):
        found = found[np.isfinite(found)]
    return float(np.median(found)) * frame.size if len(found) else _ALONE * frame.diagonal or 1.0


def _check_samples(samples: int) -> None:
    if samples < 1:
        raise ValueError(f"samples is {samples}; give a whole number of places to measure at, 1 or more")
