"""The mappers of actors, as PyVista's scalar bars want to see them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import pyvista as pv

if TYPE_CHECKING:
    from pvfiblets.plotting.coloured import Coloured


class Plotted:
    """The part of a mapper that shows PyVista's scalar bars the actor's own look-up table."""

    @property
    def lookup_table(self) -> pv.LookupTable:
        """The table that colours both the picture and the scalar bar."""
        return self._shown_by().lookup_table

    @property
    def scalar_range(self) -> tuple[float, float]:
        """Values of the first and last colour; bars that several actors share set it."""
        return self._shown_by().clim

    @scalar_range.setter
    def scalar_range(self, clim: tuple[float, float]) -> None:
        self._shown_by().clim = clim

    def _shown_by(self) -> Coloured:
        return cast("Coloured", cast("Any", self).actor)
