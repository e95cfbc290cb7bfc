"""Opacities of tubes and halos: one number, along the colour map, or one per line, as in `pyvista.Plotter.add_mesh`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.plotting.fiblets.opacities import Opacities, apply_transfer, as_transfer, check_range

if TYPE_CHECKING:
    import pyvista as pv

    from pvfiblets.mappers.colouring import Colouring

__all__ = ["LineOpacities"]


class LineOpacities:
    """The part of an actor of tubes or halos that has opacities. The actor says which lines there are."""

    prop: Any
    _theme: Any
    _scalars: Any
    _show: Any
    _opacity_by: Any = None
    _opacities = Opacities()

    @property
    def _lines_drawn(self) -> Any:
        """What is drawn, with ``n_streamlines`` and ``n_points``."""
        raise NotImplementedError

    def _line_values(self) -> Mapping[str, Any]:
        """Return arrays with a row for each line, by name."""
        raise NotImplementedError

    def _read_opacity(self) -> float:
        return float(self.prop.opacity)

    def _write_opacity(self, opacity: Any) -> None:
        if opacity is None or isinstance(opacity, float):
            self.prop.opacity = self._theme.opacity if opacity is None else opacity
        else:
            self._fade_by(opacity)

    def _read_opacity_by(self) -> Any:
        return self._opacity_by

    def _write_opacity_by(self, choice: Any) -> None:
        if choice is not None or self._opacity_by is not None:
            self._fade_by(choice)

    def _fade_by(self, choice: Any) -> None:
        found = Opacities() if choice is None else self._find_opacities(choice)
        if found.transfer is not None and (self._scalars is None or not self._scalars.mapped):
            raise ValueError(
                f"opacity {choice!r} follows the numbers of a colour map, but there are none; give scalars, or one "
                "opacity per line"
            )
        before = self._opacity_by, self._opacities
        self._opacity_by, self._opacities = choice, found
        try:
            self._show(self._scalars)
        except Exception:
            self._opacity_by, self._opacities = before
            self._show(self._scalars)
            raise

    def _find_opacities(self, choice: Any) -> Opacities:
        drawn = self._lines_drawn
        n_lines = drawn.n_streamlines
        if isinstance(choice, str) and choice not in self._line_values():
            return Opacities(transfer=as_transfer(choice, self._line_values()))
        values = np.asarray(self._line_values()[choice] if isinstance(choice, str) else choice)
        if values.ndim != 1 or values.dtype.kind not in "buif" or len(values) < 1:
            raise ValueError(
                f"opacity has shape {values.shape} and type {values.dtype}; give a number, {n_lines} numbers (one per "
                "line), or some for the colour map, the lowest first"
            )
        if len(values) == n_lines:
            check_range("opacity", values)
            return Opacities(streamlines=values.astype(np.float64))
        if len(values) == drawn.n_points:
            raise ValueError(
                f"opacity has {len(values)} numbers, one per point; here there is one per line: give {n_lines}, or "
                "colours of points with an alpha as scalars, (n_points, 4) with rgb=True"
            )
        return Opacities(transfer=as_transfer(values))

    def _fade_table(self, table: pv.LookupTable) -> None:
        if self._opacities.transfer is not None:
            apply_transfer(table, self._opacities.transfer)

    def _faded(self, colouring: Colouring) -> Colouring:
        found = self._opacities.streamlines
        return colouring if found is None else replace(colouring, opacities=found)
