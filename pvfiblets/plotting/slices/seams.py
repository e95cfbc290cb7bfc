"""The lines between the views of a workspace, which differ from the borders of the plotter's shape."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import pyvista as pv

Viewport = tuple[float, float, float, float]


def seams_of(viewports: Iterable[Viewport]) -> pv.PolyData:
    """Return the edges of views that are none of the window, as lines in shares of the window."""
    found: dict[tuple[Any, ...], None] = {}
    for left, bottom, right, top in viewports:
        edges = [((x, bottom), (x, top)) for x in (left, right) if 0.0 < x < 1.0]
        edges += [((left, y), (right, y)) for y in (bottom, top) if 0.0 < y < 1.0]
        found |= {tuple((round(x, 9), round(y, 9)) for x, y in edge): None for edge in edges}
    points = np.zeros((2 * len(found), 3))
    if found:
        points[:, :2] = np.array(list(found)).reshape(-1, 2)
    return pv.PolyData(points, lines=pv.CellArray.from_regular_cells(np.arange(len(points)).reshape(-1, 2)))


def show_seams(plotter: pv.Plotter, viewports: Iterable[Viewport]) -> None:
    """Move PyVista's lines between subplots to the borders of these views, if the plotter draws any."""
    overlay = getattr(plotter.renderers, "_border_overlay_renderer", None)
    actor = None if overlay is None else getattr(overlay, "_border_actor", None)
    if actor is not None:
        actor.GetMapper().SetInputData(seams_of(viewports))
