"""A measured distance in the picture: a line between two points with its length, seen through whatever is before it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

__all__ = ["hide_distance", "show_distance"]

_LINE, _TEXT = "measured-line", "measured-text"
_COLOUR = "#ffcc00"
_NEAR = -66_000.0  # of VTK's depth units: before everything


def show_distance(plotter: Any, begin: Sequence[float], end: Sequence[float], text: str) -> None:
    """Show a distance in place of the one before; it is no part of the document.

    Parameters
    ----------
    plotter : pyvista.Plotter
    begin, end : sequence of 3 floats
        mm.
    text : str
        What stands at the middle.
    """
    import numpy as np
    import pyvista as pv

    hide_distance(plotter)
    ends = np.array([begin, end], np.float64)
    actor = plotter.add_mesh(
        pv.lines_from_points(ends),
        color=_COLOUR,
        line_width=2.0,
        lighting=False,
        name=_LINE,
        pickable=False,
        reset_camera=False,
        render=False,
        show_scalar_bar=False,
    )
    actor.mapper.SetResolveCoincidentTopologyToPolygonOffset()
    actor.mapper.SetRelativeCoincidentTopologyLineOffsetParameters(0.0, _NEAR)
    plotter.add_point_labels(
        ends.mean(axis=0)[None],
        [text],
        name=_TEXT,
        text_color=_COLOUR,
        font_size=14,
        shape=None,
        shadow=True,
        show_points=False,
        always_visible=True,
        reset_camera=False,
        render=False,
    )


def hide_distance(plotter: Any) -> bool:
    """Take the distance away; return whether there was one."""
    found = [name for name in (_LINE, f"{_TEXT}-labels", f"{_TEXT}-points") if name in plotter.actors]
    for name in found:
        plotter.remove_actor(name, reset_camera=False, render=False)
    return bool(found)
