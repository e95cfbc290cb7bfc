"""Sources of the opacity of streamlines, beside one number for all: as in ``add_mesh``."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.support.real_numbers import real_numbers

if TYPE_CHECKING:
    from pvfiblets.codec.fibletset import FibletSet

TRANSFERS = ("linear", "linear_r", "geom", "geom_r", "sigmoid", "sigmoid_r")
"""Transfer functions that a page offers; PyVista has more sigmoids."""

POINTS = "opacity"  # name of an array of opacities per point among the fiblets' own


@dataclass(frozen=True, eq=False)
class Opacities:
    """A choice of opacities for some fiblets; one of these is given."""

    # of the colour map: PyVista's name of a transfer function, or opacities 0 to 1 from the first colour to the last
    transfer: Any = None
    streamlines: np.ndarray | None = None  # (n_streamlines,) float64, 0 to 1
    points: str | None = None  # name of a per-point array


def find_opacities(fiblets: FibletSet, choice: Any) -> tuple[FibletSet, Opacities]:
    """Find what a choice of opacities means."""
    from pvfiblets.codec.editing.point_arrays import with_point_values

    if isinstance(choice, str):
        return fiblets, _named(fiblets, choice)
    values = np.asarray(choice)
    if values.ndim != 1 or values.dtype.kind not in "buif" or len(values) < 1:
        raise ValueError(
            f"opacity has shape {values.shape} and type {values.dtype}; give a number, {fiblets.n_streamlines} numbers "
            f"(one per streamline), {fiblets.n_points} (one per point), or some for the colour map, the lowest first"
        )
    if len(values) == fiblets.n_streamlines:
        check_range("opacity", values)
        return fiblets, Opacities(streamlines=values.astype(np.float64))
    if len(values) == fiblets.n_points:
        check_range("opacity", values)
        return with_point_values(fiblets, POINTS, values.astype(np.float64)), Opacities(points=POINTS)
    return fiblets, Opacities(transfer=as_transfer(values))


def _named(fiblets: FibletSet, name: str) -> Opacities:
    if name in fiblets.per_point:
        stored = fiblets.per_point[name]
        check_range(f"opacity {name!r}", np.array([stored.lo, stored.hi]))
        return Opacities(points=name)
    if name in fiblets.per_streamline:
        values = np.asarray(fiblets.per_streamline[name])
        if values.ndim != 1:
            raise ValueError(f"opacity {name!r} has {values.ndim} dimensions; give one number per streamline")
        check_range(f"opacity {name!r}", values)
        return Opacities(streamlines=values.astype(np.float64))
    return Opacities(transfer=as_transfer(name, (*fiblets.per_point, *fiblets.per_streamline)))


def as_transfer(choice: Any, arrays: Iterable[str] = ()) -> Any:
    """Return opacities along a colour map, by name or from 0 to 1; bytes go to 255, as in PyVista."""
    if isinstance(choice, str):
        from pyvista.plotting.tools import opacity_transfer_function

        try:
            opacity_transfer_function(choice, 4)
        except (KeyError, ValueError) as error:
            listed = ", ".join(map(repr, arrays)) or "none"
            known = ", ".join(repr(key) for key in TRANSFERS)
            raise KeyError(f"there is no opacity {choice!r}. Arrays: {listed}; transfer functions: {known}") from error
        return choice
    values = choice.astype(np.float64) / (255.0 if choice.dtype == np.uint8 and choice.max() > 1 else 1.0)
    check_range("opacity", values)
    return values


def apply_transfer(table: Any, transfer: Any) -> None:
    """Give a look-up table opacities along it, by name or as :func:`as_transfer` returns them."""
    count = table.n_values
    if not isinstance(transfer, str) and len(transfer) >= count:  # PyVista reads equal lengths as bytes, refuses more
        places = np.linspace(0.0, 1.0, len(transfer))
        transfer = np.round(255.0 * np.interp(np.linspace(0.0, 1.0, count), places, transfer)).astype(np.uint8)
    table.apply_opacity(transfer)


def check_range(what: str, values: np.ndarray) -> None:
    """Raise unless numbers lie between 0 and 1; NaN counts as 0."""
    numbers = real_numbers(values, what)
    least, most = float(np.nanmin(numbers, initial=0.0)), float(np.nanmax(numbers, initial=0.0))
    if least < 0.0 or most > 1.0:
        raise ValueError(f"{what} lies between {least:g} and {most:g}; give numbers from 0 (invisible) to 1")
