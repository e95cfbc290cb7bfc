"""Transfer functions: what colour, how opaque a value is (Lesar 2015, III-E), exactly and for steps of any length.

Light along a ray obeys dI/ds = g - kappa I (equation 6): extinction kappa per mm, emission g. Seen from the eye, with s
running away from it, the colour of a ray is (equations 7 and 8)

    I = int_0^S g(s) exp(-int_0^s kappa(u) du) ds,    g = kappa c,

c being the table's colour, and its opacity is 1 - exp(-int_0^S kappa ds). As g = kappa c, light never leaves the range
of the colours. The table says how opaque `unit` mm of a value are, alpha, so kappa = -ln(1 - alpha) / unit: how opaque
something is does not depend on how finely rays are sampled.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt

from .volume import RaycastVolume

LARGEST_DEPTH = 24.0 * np.log(2.0)
"""Largest optical depth of one unit, 16.6: there alpha is 1 - 2^-24, which float32 hardly tells from 1. Full opacity
would take an infinite one."""

PREINTEGRATED = 256  # least number of values along each side of a pre-integrated table

LARGEST_PREINTEGRATED = 1024
"""Largest number of entries of tables that can be pre-integrated: time grows with its third power."""

EVEN_COLOURS, EVEN_EXTINCTION = 1.0 / 512.0, 1e-3
"""Differences of colours, and their part of extinction, up to which both count as the same."""

PLACES = 4080  # least number of pieces of the finer table that light is calculated from: 16 for each of 255

KEPT = 8  # number of cached pre-integrated tables: each takes a moment, and some colours need two

ALLOWED = 1e-3  # difference of light between a stretch and its halves up to which `'adaptive'` does not halve it again

FINEST = 64  # parts of two steps below which it does not

Array = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Transfer:
    """A transfer function: a table of colours and opacities over an interval of values."""

    # ``(k, 4)`` RGBA from 0 to 1, k >= 2, kept as float32. Between its entries, which lie evenly over ``clim``, all
    # four are linear; outside the first and last go on.
    table: npt.NDArray[np.float32]
    clim: tuple[float, float]  # ``(low, high)``: values of the first and last entry
    unit: float = 1.0  # Length of the table's opacity, mm. :meth:`over` uses the volume's mean voxel spacing.

    def __post_init__(self) -> None:
        table = np.array(self.table, np.float64)
        if table.ndim != 2 or table.shape[1] != 4 or len(table) < 2:
            raise ValueError(f"the transfer function's table has the shape {table.shape}; expected (k, 4) RGBA, k >= 2")
        fine = (table >= 0.0) & (table <= 1.0)  # not of NaN
        if not fine.all():
            row, column = np.argwhere(~fine)[0]
            raise ValueError(
                f"the transfer function's {'RGBA'[column]} of entry {row} is {table[row, column]:g}; expected 0 to 1"
            )
        low, high = (float(end) for end in self.clim)
        if not (np.isfinite(low) and np.isfinite(high) and low < high and np.isfinite(high - low)):
            raise ValueError(f"clim={(low, high)}; expected two finite numbers, the lower one first")
        unit = float(self.unit)
        if not 0.0 < unit < np.inf:
            raise ValueError(f"the unit of opacity is {unit:g} mm; expected a finite length above 0")
        single = table.astype(np.float32)
        single.flags.writeable = False
        object.__setattr__(self, "table", single)
        object.__setattr__(self, "clim", (low, high))
        object.__setattr__(self, "unit", unit)

    @classmethod
    def over(
        cls, volume: RaycastVolume, table: Any, clim: tuple[float, float] | None = None, unit: float | None = None
    ) -> Transfer:
        """A transfer function for a volume.

        Parameters
        ----------
        volume : RaycastVolume
        table, clim, unit
            As of the class. By default ``clim`` is the range of the volume's values, of a constant volume from its
            value to 1 above, so that it has the first entry; the unit is the mean voxel spacing.
        """
        if clim is None:
            low, high = volume.value_range
            clim = (low, high) if low < high else (low, max(low + 1.0, float(np.nextafter(low, np.inf))))
        return cls(table, clim, float(volume.spacing.mean()) if unit is None else unit)

    def lookup(self, values: npt.ArrayLike) -> Array:
        """Return ``(..., 4)`` float64 RGBA of values."""
        where = self._places(values)
        table = self.table.astype(np.float64)
        below = np.minimum(where.astype(np.int64), len(table) - 2)
        share = (where - below)[..., None]
        return (1.0 - share) * table[below] + share * table[below + 1]

    def colour(self, values: npt.ArrayLike) -> Array:
        """Return ``(..., 3)`` float64 RGB of values, the c of g = kappa c."""
        return self.lookup(values)[..., :3]

    def extinction(self, values: npt.ArrayLike) -> Array:
        """Return the extinction kappa of values, 1/mm."""
        return _depth(self.lookup(values)[..., 3]) / self.unit

    @cached_property
    def largest_extinction(self) -> float:
        """The largest extinction of all values, 1/mm."""
        return float(_depth(self.table[:, 3].astype(np.float64)).max()) / self.unit

    def emission(self, values: npt.ArrayLike) -> Array:
        """Return ``(..., 3)`` emission g = kappa c of values, 1/mm."""
        rgba = self.lookup(values)
        return rgba[..., :3] * (_depth(rgba[..., 3]) / self.unit)[..., None]

    def visible_range(self, low: npt.ArrayLike, high: npt.ArrayLike) -> npt.NDArray[np.bool_]:
        """Return whether anything between two values, themselves included, has an opacity above 0."""
        # For arrays of bounds, as in `pvfiblets.volumes.octree.flags`; the cost does not depend on the length of the
        # table lies between.
        first, last = self._places(low), self._places(high)
        # Opacity is linear between entries: it is 0 all through if it is at both ends and at the entries between.
        n = self._opaque_before
        between = n[np.floor(last).astype(np.int64) + 1] > n[np.ceil(first).astype(np.int64)]
        seen: npt.NDArray[np.bool_] = between | self._opaque_at(first) | self._opaque_at(last)
        return seen

    @cached_property
    def opaque_range(self) -> tuple[float, float]:
        """Values between which all opacities above 0 lie; infinite where the first or the last entry has one."""
        entries = np.flatnonzero(self.table[:, 3] > 0.0)
        if not entries.size:
            return np.inf, -np.inf
        low, high = self.clim
        ends = low + (high - low) * np.array([entries[0] - 1.0, entries[-1] + 1.0]) / (len(self.table) - 1)
        return (
            float(ends[0]) if entries[0] > 0 else -np.inf,
            float(ends[1]) if entries[-1] < len(self.table) - 1 else np.inf,
        )

    def even_range(self, low: npt.ArrayLike, high: npt.ArrayLike) -> npt.NDArray[np.bool_]:
        """Return whether between two values neither colours nor extinction change by more than rounding does."""
        # For arrays of bounds, as `visible_range`. Colours may change by `EVEN_COLOURS`, extinction by
        # `EVEN_EXTINCTION` of the least of it, all ups and downs added up.
        first, last = self._places(low), self._places(high)
        entries = np.arange(len(self.table))
        colour, depth = self._changes_before
        turned = np.interp(last, entries, colour) - np.interp(first, entries, colour)
        thinned = np.interp(np.ceil(last), entries, depth) - np.interp(np.floor(first), entries, depth)
        even: npt.NDArray[np.bool_] = (turned <= EVEN_COLOURS) & (
            thinned <= EVEN_EXTINCTION * np.minimum(self.extinction(low), self.extinction(high))
        )
        return even

    @cached_property
    def _changes_before(self) -> tuple[Array, Array]:
        """``(k,)`` each: by how much colours, the one that does most, and extinction have changed up to each entry."""
        rgba = self.table.astype(np.float64)
        colour = np.abs(np.diff(rgba[:, :3], axis=0)).max(axis=1)
        depth = np.abs(np.diff(_depth(rgba[:, 3]) / self.unit))
        return np.append(0.0, np.cumsum(colour)), np.append(0.0, np.cumsum(depth))

    @cached_property
    def _opaque_before(self) -> npt.NDArray[np.int64]:
        """``(k + 1,)``: how many entries before each have opacity."""
        return np.concatenate([[0], np.cumsum(self.table[:, 3] > 0.0)])

    def _opaque_at(self, where: Array) -> npt.NDArray[np.bool_]:
        opaque = self.table[:, 3] > 0.0
        below, above = np.floor(where).astype(np.int64), np.ceil(where).astype(np.int64)
        either: npt.NDArray[np.bool_] = opaque[below] | opaque[above]  # of one, if the value is an entry's own
        return either

    def _places(self, values: npt.ArrayLike) -> Array:
        """Return the places of values in the table, 0 to k - 1."""
        low, high = self.clim
        share = (np.asarray(values, np.float64) - low) / (high - low)
        return np.clip(share, 0.0, 1.0) * (len(self.table) - 1)

    def preintegrated(self, step: float) -> npt.NDArray[np.float32]:
        """Return colour and opacity of a step in mm along which the value changes linearly, for all pairs of values."""
        # (n, n, 4) float32: for the value at the step's front, first, and back, second, each evenly over `clim`, the
        # RGB, multiplied by opacity, and the opacity. n is at least 256, and such that each entry of the table is among
        # the values. Read-only: it is cached.
        #
        # The optical depth is exact: over a piece in which alpha is linear, -ln(1 - alpha) has the primitive (1 -
        # alpha) ln(1 - alpha) + alpha. So is what light loses within the step: with u = 1 - exp(-tau), the colour is
        # int c du, piece by piece by parts, so that only exp(-tau), smooth within a piece, is left to a quadrature.
        if not 0.0 < step < np.inf:
            raise ValueError(f"the step is {step!r} mm; expected a finite length above 0")
        k = len(self.table)
        if k > LARGEST_PREINTEGRATED:
            raise ValueError(
                f"the transfer function has {k} entries; tables of up to {LARGEST_PREINTEGRATED} can be "
                "pre-integrated: give a shorter one"
            )
        n = (k - 1) * -(-(PREINTEGRATED - 1) // (k - 1)) + 1
        return _preintegrated(self.table.tobytes(), n, step / self.unit)

    def media(self, least: int = PLACES) -> tuple[npt.NDArray[np.float32], int]:
        """What light of stretches in which the value is linear is calculated from (``shaders/volumes/adaptive.glsl``).

        (2, n, 4) float32, and the number of places from each entry of the table to the next. First colour and
        extinction, 1/mm, at places evenly over ``clim``; then the integral of extinction over places from the first on,
        in two numbers, the second the remainder of the first, its growth to the next place, and 0.
        """
        from .preintegration import unit_depths

        pieces = len(self.table) - 1
        places = -(-least // pieces)
        rgba = self.lookup(np.linspace(*self.clim, pieces * places + 1))
        grows = np.append(unit_depths(rgba[:, 3]), 0.0) / self.unit
        depth = np.append(0.0, np.cumsum(grows[:-1]))
        first = depth.astype(np.float32)
        made = np.zeros((2, len(rgba), 4), np.float32)
        made[0] = np.column_stack([rgba[:, :3], _depth(rgba[:, 3]) / self.unit])
        made[1, :, :3] = np.column_stack([first, depth - first, grows])
        return made, places


@lru_cache(maxsize=KEPT)
def _preintegrated(table: bytes, n: int, units: float) -> npt.NDArray[np.float32]:
    """Table of n entries, made of a user's table, by the length of a step in units of opacity."""
    from .preintegration import preintegrate

    rgba = np.frombuffer(table, np.float32).reshape(-1, 4).astype(np.float64)
    where = np.linspace(0.0, len(rgba) - 1.0, n)
    fine = np.column_stack([np.interp(where, np.arange(len(rgba)), column) for column in rgba.T])
    made = preintegrate(fine, units)
    made.flags.writeable = False
    return made


def _depth(alpha: Array) -> Array:
    """Optical depth of one unit of an opacity."""
    with np.errstate(divide="ignore"):
        return np.minimum(-np.log1p(-alpha), LARGEST_DEPTH)
