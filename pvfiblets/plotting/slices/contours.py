"""Meshes as contours in the panes of a workspace: made anew when the slices have moved."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
import pyvista as pv

if TYPE_CHECKING:
    from pvfiblets.plotting.slices.pane import Pane

Array = npt.NDArray[np.float64]


class PaneContours:
    """The contours of one workspace."""

    def __init__(self) -> None:
        self._meshes: dict[str, tuple[pv.DataSet, pv.Color, float]] = {}
        self._cut: tuple[Any, ...] | None = None

    def add(self, mesh: Any, color: Any, line_width: float, name: str | None, panes: Iterable[Pane]) -> str:
        """Show a mesh; arguments as of ``workspace.add_contours``."""
        if not isinstance(mesh, pv.DataSet):
            raise TypeError(f"mesh is a {type(mesh).__name__}; give a pyvista mesh")
        name = name or f"contours {len(self._meshes) + 1}"
        self.remove(name, panes)
        self._meshes[name] = mesh, pv.Color(color), float(line_width)
        self.forget()
        return name

    def remove(self, name: str, panes: Iterable[Pane]) -> None:
        """Remove contours; unknown names are ignored."""
        if self._meshes.pop(name, None) is not None:
            for pane in panes:
                pane.set_contour(name, None)

    def forget(self) -> None:
        """Cut all meshes again with the next render."""
        self._cut = None

    def show(self, position: Array, panes: Iterable[Pane]) -> None:
        """Bring contours up to date; a renderer is about to draw."""
        panes = list(panes)
        cut = (*position, *(part for pane in panes for part in pane.toward))
        if cut == self._cut:
            return
        self._cut = cut
        for name, (mesh, color, width) in self._meshes.items():
            for pane in panes:
                pane.set_contour(name, mesh.slice(normal=pane.toward, origin=position), color, width)
