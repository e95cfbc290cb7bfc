"""What the panes of a workspace have in common: convention, thickness of slabs, cross-hair, and their layout."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.plotting.slices.layouts import LAYOUTS, viewports
from pvfiblets.plotting.slices.oblique import NAME as OBLIQUE
from pvfiblets.plotting.slices.seams import show_seams

if TYPE_CHECKING:
    from pvfiblets.plotting.slices.contours import PaneContours
    from pvfiblets.plotting.slices.oblique import ObliqueSlice
    from pvfiblets.plotting.slices.pane import Pane

__all__ = ["CONVENTIONS", "PaneSettings", "checked_settings"]

CONVENTIONS = ("radiological", "neurological")


class PaneSettings:
    """The part of :class:`~pvfiblets.plotting.slices.workspace.Workspace` that sets all of its panes."""

    if TYPE_CHECKING:
        panes: Mapping[str, Pane]
        oblique: ObliqueSlice | None
        _plotter: Any
        _renderers: dict[str, Any]
        _contours: PaneContours

    @property
    def convention(self) -> str:
        """``"radiological"``: the patient's right is on the left of the window; or ``"neurological"``.

        Front is on the left of sagittal slices by the first, and on the right by the second.
        """
        return self._convention

    @convention.setter
    def convention(self, convention: str) -> None:
        self._convention = _choice("convention", convention, CONVENTIONS)
        for pane in self.panes.values():
            pane.mirrored = convention == "radiological"

    @property
    def thickness(self) -> float:
        """Of the slab about each slice whose streamlines are shown in its pane, mm."""
        return self.panes["axial"].thickness

    @thickness.setter
    def thickness(self, thickness: float) -> None:
        found = _length(thickness)
        for pane in self.panes.values():
            pane.thickness = found
        self._contours.forget()

    @property
    def layout(self) -> str:
        """Which views are shown, and where.

        ``"grid"``, ``"row"``, ``"beside"`` (the 3-D view and, small, three slices: below it in a window that is higher
        than wide), or one of ``"3d"``, ``"axial"``,
        ``"coronal"``, ``"sagittal"`` and, if it has a pane, ``"oblique"`` alone.
        """
        return self._layout

    @layout.setter
    def layout(self, layout: str) -> None:
        found = _choice("layout", layout, LAYOUTS)
        if found == OBLIQUE and not self._has_oblique_pane:
            raise ValueError('layout is "oblique", and there is no such pane; call workspace.add_oblique() first')
        self._layout = found
        self.arrange()

    @property
    def _has_oblique_pane(self) -> bool:
        return self.oblique is not None and self.oblique.pane is not None and self.oblique.visible

    @property
    def _places(self) -> Mapping[str, tuple[float, float, float, float]]:
        """Where views are that are shown; the layout of a pane that is not is ``"beside"``."""
        width, height = self._plotter.window_size
        there = self._has_oblique_pane
        layout = "beside" if self._layout == OBLIQUE and not there else self._layout
        return viewports(layout, width / max(height, 1), oblique=there)

    def arrange(self, *_: Any) -> None:
        """Lay views out as it suits the window, which may have another shape now."""
        places = self._places
        for name, renderer in self._renderers.items():
            renderer.SetDraw(name in places)
            renderer.SetInteractive(name in places)
            renderer.SetViewport(*places.get(name, (0.0, 0.0, 0.001, 0.001)))
        show_seams(self._plotter, places.values())

    @property
    def cross_hair(self) -> bool:
        """Whether the panes show the cross-hair."""
        return self.panes["axial"].cross_hair

    @cross_hair.setter
    def cross_hair(self, shown: bool) -> None:
        for pane in self.panes.values():
            pane.cross_hair = shown


def checked_settings(convention: Any, layout: Any, thickness: Any) -> None:
    """Raise ValueError if one of a workspace's settings cannot be what it is to be."""
    _choice("convention", convention, CONVENTIONS)
    _choice("layout", layout, LAYOUTS)
    _length(thickness)


def _choice(name: str, given: str, choices: tuple[str, ...]) -> str:
    if given not in choices:
        raise ValueError(f"{name} is {given!r}; choose one of {choices}")
    return given


def _length(thickness: Any) -> float:
    found = float(thickness) if isinstance(thickness, (int, float, np.number)) else np.nan
    if not 0.0 < found < np.inf:
        raise ValueError(f"thickness is {thickness!r}; give a length above 0, mm")
    return found
