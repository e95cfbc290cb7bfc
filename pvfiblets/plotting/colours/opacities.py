"""Opacities of tubes and halos: one number, along the colour map, or one per line, as in `pyvista.Plotter.add_mesh`."""

from __future__ import annotations

from typing import Any

import numpy as np

from pvfiblets.plotting.fiblets.opacities import Opacities, as_transfer, check_range
from pvfiblets.plotting.filtering.selection import SelectedActor


class LineActor(SelectedActor):
    """Actor of tubes or halos: its lines have opacities."""

    def _write_opacity(self, opacity: Any) -> None:
        if opacity is None or isinstance(opacity, float):
            self.prop.opacity = self._theme.opacity if opacity is None else opacity
        else:
            self._write_opacity_by(opacity)

    def _write_opacity_by(self, choice: Any) -> None:
        if choice is not None or self._opacity_by is not None:
            self._fade_by(choice, Opacities() if choice is None else self._find_opacities(choice), "line")

    def _find_opacities(self, choice: Any) -> Opacities:
        lines = self._subject.lines
        n_lines, named = len(lines), lines.per_streamline
        if isinstance(choice, str) and choice not in named:
            return Opacities(transfer=as_transfer(choice, named))
        values = np.asarray(named[choice] if isinstance(choice, str) else choice)
        if values.ndim != 1 or values.dtype.kind not in "buif" or len(values) < 1:
            raise ValueError(
                f"opacity has shape {values.shape} and type {values.dtype}; give a number, {n_lines} numbers (one per "
                "line), or some for the colour map, the lowest first"
            )
        if len(values) == n_lines:
            check_range("opacity", values)
            return Opacities(streamlines=values.astype(np.float64))
        if len(values) == lines.n_points:
            raise ValueError(
                f"opacity has {len(values)} numbers, one per point; here there is one per line: give {n_lines}, or "
                "colours of points with an alpha as scalars, (n_points, 4) with rgb=True"
            )
        return Opacities(transfer=as_transfer(values))
