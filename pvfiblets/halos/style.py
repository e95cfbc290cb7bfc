"""`HaloStyle`: how lines and points with halos are drawn, as one small value that a redraw is decided on."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

DISPLACEMENTS = ("linear", "square", "square root")  # displacement functions by name (paper: figure 17)

TABLE_SIZE = 64  # greatest number of entries of a displacement table

MAX_TAPERED = 1000


@dataclass(frozen=True)
class HaloStyle:
    """The style of lines, or points, with halos.

    Source: Everts, Bekker, Roerdink and Isenberg, "Depth-dependent halos" (2009), sections 3.2 to 3.6.
    """

    line_width: float  # mm, of a line, or the diameter of a point; above 0
    # mm, of a line together with the halos on both its sides, or of a point with its own; at least ``line_width``
    strip_width: float
    # mm from a line to the edge of its halo behind it; 0 lets every halo hide everything behind its line
    max_displacement: float
    # How far behind its line a halo lies between its middle and its edge (equation 3): one of `DISPLACEMENTS`, or 2
    # to `TABLE_SIZE` numbers in 0..1, the function at equally spaced places from 0 to 1, linear between them
    displacement: str | tuple[float, ...] = "linear"
    n_tapered: int = 2  # Vertices over which the ends of lines narrow; 0 leaves them square. Points have no ends.
    # Where along the mask, from 0 at one end of a line to 1 at the other, the first ``n_tapered`` vertices end
    # (section 3.4), above 0 and at most 0.5. The mask is as wide as the strip from 0.2 to 0.8 of it.
    t_tapered: float = 0.2
    # 0 to 1: thins the farthest lines of the data by this share, against the nearest, for depth cueing by line width.
    # Halos keep their width.
    width_cue: float = 0.0
    min_width: float = 1.0  # Pixels that a line takes at least, however thin and far it is; 0 leaves it as it is
    # Whether the edge between a line and its own halo is a gradual transition; else every pixel is one or the other
    smooth: bool = True
    # Values that filter lines (section 3.6): only numbers from ``low`` to ``high`` are shown, and NaN is not
    filter_by: str | None = None
    low: float = -math.inf  # Thresholds; -inf and inf let all numbers pass
    high: float = math.inf
    filter_taper: float = 0.0  # mm over which lines narrow where the filter ends them; 0 leaves those ends square

    def __post_init__(self) -> None:
        self._check("line_width", self.line_width > 0.0, "a number of mm above 0")
        self._check("strip_width", self.strip_width >= self.line_width, f"at least line_width, {self.line_width}")
        self._check("max_displacement", self.max_displacement >= 0.0, "a number of mm, 0 or more")
        self._check("t_tapered", 0.0 < self.t_tapered <= 0.5, "a number above 0, at most 0.5")
        self._check("width_cue", 0.0 <= self.width_cue <= 1.0, "a number from 0 to 1")
        self._check("min_width", self.min_width >= 0.0, "a number of pixels, 0 or more")
        self._check("filter_taper", self.filter_taper >= 0.0, "a number of mm, 0 or more")
        whole = isinstance(self.n_tapered, int) and not isinstance(self.n_tapered, bool)
        if not whole or not 0 <= self.n_tapered <= MAX_TAPERED:
            raise ValueError(f"n_tapered is {self.n_tapered!r}; give a whole number from 0 to {MAX_TAPERED}")
        if math.isnan(self.low) or math.isnan(self.high) or self.low > self.high:
            raise ValueError(f"the thresholds are {self.low} and {self.high}; give the lower one first")
        self._check_displacement()

    def _check(self, name: str, right: bool, expected: str) -> None:
        value = getattr(self, name)
        if not (right and math.isfinite(value)):
            raise ValueError(f"{name} is {value}; give {expected}")

    def _check_displacement(self) -> None:
        given: Any = self.displacement
        if isinstance(given, str):
            if given not in DISPLACEMENTS:
                raise ValueError(f"displacement is {given!r}; choose one of {DISPLACEMENTS} or give a table")
            return
        table = tuple(float(entry) for entry in given)
        if not 2 <= len(table) <= TABLE_SIZE or not all(0.0 <= entry <= 1.0 for entry in table):
            raise ValueError(f"displacement is {given!r}; a table has 2 to {TABLE_SIZE} numbers in 0..1")
        object.__setattr__(self, "displacement", table)
