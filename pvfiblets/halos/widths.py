"""Visible widths of halos: the paper's appendix A, for every displacement function."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from .displacement import Displacement, as_displacement, displaced, table_places
from .style import HaloStyle


def halo_width(
    dz: npt.ArrayLike,
    line_width: float,
    strip_width: float,
    max_displacement: float,
    displacement: Displacement = "linear",
) -> npt.NDArray[np.float64]:
    """Return the visible width of a line's halo, on each of its sides, where another line crosses behind it.

    Parameters
    ----------
    dz : array_like
        mm from this line to the other along the view axis, away from the viewer; none of its halo shows at 0 or
        less, where it is the one in front. NaN stays NaN.
    line_width : float
        mm, of the line in front.
    strip_width : float
        mm, of that line with its halos.
    max_displacement : float
        mm, of the edge of its halos.
    displacement : str, sequence of float or callable, default: 'linear'
        As of :func:`.displacement.as_displacement`.

    Returns
    -------
    ndarray
        float64, mm across the line, in the shape of `dz`: 0 to ``(strip_width - line_width) / 2``.

    Raises
    ------
    ValueError
        If a width or the displacement is out of range.

    Notes
    -----
    Source: Everts et al. 2009, appendix A. Let a be the distance on the screen from the axis of the line in front,
    which is equation 2's s, in mm. Equation 1 gives the strip the half width w_strip/2, so that the argument of
    equation 3, 2|v - 0.5|, is x = 2 a / w_strip, and its halo lies ``max_displacement * f(x)`` behind the axis. The
    other line is hidden where it is farther than that:

        f(2 a / w_strip) < dz / d_max = t.

    The line itself reaches to a = w_line/2, or x = w_line/w_strip; the halo shows from there to the first a at which
    this no longer holds, and at most to w_strip/2. For the linear function that a is t w_strip/2, so

        w_halo = 0                                    for            dz <= d_max w_line / w_strip
               = (w_strip dz / d_max - w_line) / 2    for d_max w_line / w_strip < dz < d_max
               = (w_strip - w_line) / 2               for            dz >= d_max.

    Equation 4 as printed has the two differences the other way round, so that its widths are negative; its bounds
    agree. Section 3.3 says that the halo disappears where lines are closer than f(0.5 w_line): in the units of
    equation 3 that is d_max f(w_line / w_strip). Where a function falls again, a line that has come out of the halo
    may be hidden a second time farther out; that does not count.

    Lines that cross at an angle have this width across the line in front, along the other one more. Ends of lines that
    are tapered have narrower halos. Perspective makes all of it smaller with distance, that is, by the depth of the
    line in front.

    Examples
    --------
    >>> from pvfiblets.halos.widths import halo_width
    >>> halo_width([0.5, 1.0, 3.0, 4.0, 9.0], line_width=1.0, strip_width=4.0, max_displacement=4.0).tolist()
    [0.0, 0.0, 1.0, 1.5, 1.5]
    """
    form = as_displacement(displacement)
    HaloStyle(line_width, strip_width, max_displacement, form)
    ahead = np.asarray(dz, np.float64)
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(ahead > 0.0, ahead / max_displacement, 0.0)
    edge = line_width / strip_width
    hidden_to = np.maximum(_first_place(share, form, edge), edge)
    width = np.where(ahead > 0.0, 0.5 * strip_width * (hidden_to - edge), 0.0)
    return np.where(np.isnan(ahead), np.nan, width)


def _first_place(share: npt.NDArray[np.float64], form: Any, edge: float) -> npt.NDArray[np.float64]:
    """The first x from `edge` on, at most 1, at which f(x) is at least `share`."""
    if isinstance(form, str):
        inverse = {"linear": 1.0, "square": 0.5, "square root": 2.0}[form]
        return np.minimum(share, 1.0) ** inverse
    places = table_places(len(form))
    places = np.concatenate([[edge], places[places > edge]])
    values = displaced(places, form)
    highest = np.maximum.accumulate(values)
    after = np.searchsorted(highest, share, side="left")
    last = len(places) - 1
    right = np.clip(after, min(1, last), last)
    left = np.maximum(right - 1, 0)
    rise = values[right] - values[left]
    part = (share - values[left]) / np.where(rise > 0.0, rise, 1.0)
    place = places[left] + part * (places[right] - places[left])
    return np.where(after == 0, edge, np.where(after > last, 1.0, place))
