"""Rays whose light is known in closed form, thin to stiff: what integrators are measured on.

A profile is a ray along which the value is linear between evenly spaced places, such as the voxels that it passes
through, and a transfer function. It falls into pieces on which the opacity of a unit, alpha, and the colour c are
linear. With ``x`` the optical depth of a piece of l units, and alpha and c at its front, alpha' and c' at its back:

* Where alpha is constant, ``x = -l ln(1 - alpha)`` and the piece gives off
  ``c (1 - e^-x) + (c' - c) (1 - e^-x - x e^-x) / x``.
* Where the colour is constant, ``x = l (F(alpha') - F(alpha)) / (alpha' - alpha)`` with the primitive
  ``F(alpha) = (1 - alpha) ln(1 - alpha) + alpha`` of ``-ln(1 - alpha)``, and the piece gives off ``c (1 - e^-x)``.

Profiles are chosen so that one of the two holds on each piece.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from pvfiblets.volumes.transfer import Transfer
from pvfiblets.volumes.volume import RaycastVolume

Array = npt.NDArray[np.float64]

ENTRIES = 256  # of the profiles' tables: steep ones rise within one 255th of the values' range

DENSE = 0.9  # opacity of a unit where the profiles are densest


@dataclass(frozen=True, eq=False)
class Profile:
    """``(m,)`` values along a ray of so many mm, evenly spaced and linear between, and their transfer function."""

    name: str
    values: Array
    length: float
    transfer: Transfer

    @property
    def places(self) -> Array:
        """``(m,)`` mm along the ray where the values are."""
        return np.linspace(0.0, self.length, len(self.values))

    @property
    def densest(self) -> float:
        """Largest extinction along the ray, 1/mm."""
        entries = np.linspace(*self.transfer.clim, len(self.transfer.table))
        within = entries[(entries > self.values.min()) & (entries < self.values.max())]
        return float(self.transfer.extinction(np.concatenate([self.values, within])).max())

    def value(self, s: npt.ArrayLike) -> Array:
        """Values at places, mm along the ray."""
        return np.interp(np.asarray(s, np.float64), self.places, self.values)

    def volume(self, sides: tuple[int, int] = (2, 2)) -> RaycastVolume:
        """A volume that every ray along its third axis passes through so: voxels of that length, 1 mm wide."""
        values = np.broadcast_to(self.values.astype(np.float32), (*sides, len(self.values)))
        return RaycastVolume(values.copy(), np.diag([1.0, 1.0, self.length / (len(self.values) - 1), 1.0]))

    def light(self, start: float = 0.0, end: float | None = None) -> Array:
        """Return RGB, multiplied by the opacity, and opacity of the ray from one place to another, mm; ``(4,)``."""
        table, (low, high) = self.transfer.table.astype(np.float64), self.transfer.clim
        end = self.length if end is None else end
        entries, places, values = np.linspace(low, high, len(table)), self.places, self.values
        breaks = [np.array([start, end]), places]
        for a, b, va, vb in zip(places, places[1:], values, values[1:], strict=False):
            if va != vb:
                breaks.append(a + (b - a) * (entries - va) / (vb - va))
        s = np.unique(np.clip(np.concatenate(breaks), start, end))
        at = np.clip((self.value(s) - low) / (high - low), 0.0, 1.0) * (len(table) - 1)
        middle = np.clip((self.value((s[1:] + s[:-1]) / 2) - low) / (high - low), 0.0, 1.0) * (len(table) - 1)
        entry = np.minimum(middle.astype(np.int64), len(table) - 2)
        # At a piece's ends, from its own side: where it begins at an entry, its colour may begin to change there.
        front, back = (table[entry] + (where - entry)[:, None] * (table[entry + 1] - table[entry])
                       for where in (at[:-1], at[1:]))  # fmt: skip
        same = table[entry] == table[entry + 1]
        own, depth = _pieces(front, back, np.diff(s) / self.transfer.unit, same)
        before = np.append(0.0, np.cumsum(depth))
        return np.append(np.exp(-before[:-1]) @ own, -np.expm1(-before[-1]))


def _pieces(front: Array, back: Array, units: Array, same: npt.NDArray[np.bool_]) -> tuple[Array, Array]:
    """Light of pieces, and their optical depths, by RGBA at their ends and what of that is the same all along."""
    even = same[:, 3] | (front[:, 3] == back[:, 3])
    if not (even | same[:, :3].all(axis=1)).all():
        raise ValueError("opacity and colour both change between two entries of the table; no closed form is known")
    first, last = ((1.0 - alpha) * np.log1p(-alpha) + alpha for alpha in (front[:, 3], back[:, 3]))
    rise = np.where(even, 1.0, back[:, 3] - front[:, 3])
    x = units * np.where(even, -np.log1p(-front[:, 3]), (last - first) / rise)
    there = np.where(x > 0.0, x, 1.0)
    mean = np.where(even & (x > 0.0), (-np.expm1(-there) - there * np.exp(-there)) / there, 0.0)
    return -np.expm1(-x)[:, None] * front[:, :3] + mean[:, None] * (back[:, :3] - front[:, :3]), x


def profiles(depths: Iterable[float] = (1.0,), length: float = 64.0) -> Iterator[Profile]:
    """Profiles of some optical depths."""
    x = np.linspace(0.0, 1.0, ENTRIES)
    ramp = np.array([0.0, 1.0])
    thin = -np.expm1(np.log1p(-DENSE) / 1e3)  # a thousandth of the extinction
    orange, blue = np.array([1.0, 0.6, 0.1]), np.array([0.1, 0.3, 1.0])
    opacities = {
        "constant": np.full(ENTRIES, DENSE),
        "fade": np.full(ENTRIES, DENSE),
        "ramp": DENSE * x,
        "edge": np.where(x > 0.37, DENSE, 0.0),
        "peak": np.where(np.arange(ENTRIES) == 97, DENSE, 0.0),
        "haze": np.where(x > 0.61, DENSE, thin),
        "teeth": np.where(np.arange(ENTRIES) == 97, DENSE, 0.0),
    }
    teeth = np.where(np.arange(18) % 2 == 0, 0.05, np.linspace(0.5, 0.95, 18))
    for depth in depths:
        unit = -np.log1p(-DENSE) * length / depth
        for name, alpha in opacities.items():
            colours = np.broadcast_to(orange, (ENTRIES, 3))
            if name == "fade":
                colours = blue + x[:, None] * (orange - blue)
            elif name == "haze":
                # The colour changes an entry before the opacity does.
                colours = np.where(x[:, None] > 0.606, orange, blue)
            values = {"constant": np.full(2, 0.5), "teeth": teeth}.get(name, ramp)
            table = np.concatenate([colours, alpha[:, None]], axis=1)
            yield Profile(name, values, length, Transfer(table, (0.0, 1.0), unit))
