"""Measured distances in the picture: lines between two points with their lengths, seen through whatever is before."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from pvfiblets.web.session.document import Measurement

if TYPE_CHECKING:
    import pyvista as pv

_LINE, _TEXT = "measured-line", "measured-text"
_COLOUR = "#ffcc00"
NEAREST = (0.0, -66_000.0)  # offset of lines, of VTK's depth units: before everything
LINES: dict[str, Any] = {"color": _COLOUR, "line_width": 2.0, "lighting": False, "pickable": False}
LABELS: dict[str, Any] = {
    "text_color": _COLOUR, "font_size": 14, "shape": None, "shadow": True, "show_points": False, "always_visible": True,
}  # fmt: skip
"""Looks of lines and lengths, as arguments of ``plotter.add_mesh`` and ``plotter.add_point_labels``."""


def show_distances(plotter: pv.BasePlotter, measurements: Sequence[Measurement]) -> None:
    """Show some distances in place of those before."""
    import numpy as np
    import pyvista as pv

    for name in names_of(plotter):
        plotter.remove_actor(name, reset_camera=False, render=False)
    if not measurements:
        return
    ends = np.array([[one.begin, one.end] for one in measurements], np.float64)
    quiet: dict[str, Any] = {"reset_camera": False, "render": False}
    actor = plotter.add_mesh(
        pv.line_segments_from_points(ends.reshape(-1, 3)), name=_LINE, show_scalar_bar=False, **LINES, **quiet
    )
    actor.mapper.SetResolveCoincidentTopologyToPolygonOffset()
    actor.mapper.SetRelativeCoincidentTopologyLineOffsetParameters(*NEAREST)
    plotter.add_point_labels(ends.mean(axis=1), [one.text for one in measurements], name=_TEXT, **LABELS, **quiet)


@contextmanager
def hidden_distances(plotter: pv.BasePlotter) -> Iterator[None]:
    """Draw pictures without distances in this scope, so that depths read from them are the scene's."""
    found = [plotter.actors[name] for name in names_of(plotter)]
    for actor in found:
        actor.SetVisibility(False)
    try:
        if found:
            plotter.render()
        yield
    finally:
        for actor in found:
            actor.SetVisibility(True)


def names_of(plotter: pv.BasePlotter) -> list[str]:
    """Return the names of the actors that show distances."""
    return [name for name in (_LINE, f"{_TEXT}-labels", f"{_TEXT}-points") if name in plotter.actors]
