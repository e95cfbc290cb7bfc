"""Widgets that cut: planes, boxes and meshes that a user drags.

Dragging sets a cut by its name, which changes some numbers in a uniform block: nothing is compressed or uploaded. Each
function returns PyVista's widget, and at last a function that takes it away with its cut.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv

from pvfiblets.plotting.filtering.region_sources import direction_of

if TYPE_CHECKING:
    from pvfiblets.plotting.fiblets.actor import FibletActor
    from pvfiblets.regions import Region

Widget = tuple[Any, Callable[[], None]]


def plane(
    plotter: pv.BasePlotter,
    actors: Sequence[FibletActor],
    name: str,
    cut: Callable[[Any, Any], None],
    *,
    normal: Any,
    origin: Any,
    event: Any,
    **options: Any,
) -> Widget:
    """Add a plane, and call ``cut(normal, origin)`` where it is dragged."""
    widget = plotter.add_plane_widget(
        cut,
        normal=direction_of(normal),
        origin=centre(actors) if origin is None else origin,
        bounds=bounds_of(actors),
        interaction_event=event,
        **options,
    )

    def remove() -> None:
        _end_widget(plotter, "plane_widgets", widget)
        _uncut(actors, name)

    return widget, remove


def box(
    plotter: pv.BasePlotter,
    actors: Sequence[FibletActor],
    name: str,
    *,
    bounds: Any,
    inside: bool,
    event: Any,
    **options: Any,
) -> Widget:
    """Add a box that cuts where it is dragged, turned or not."""

    def cut(box: pv.PolyData) -> None:
        region = _box_region(box)
        for item in actors:
            item.clip(region, inside=inside, name=name)

    bounds = bounds_of(actors) if bounds is None else bounds
    widget = plotter.add_box_widget(cut, bounds=bounds, interaction_event=event, **{"factor": 1.0, **options})

    def remove() -> None:
        _end_widget(plotter, "box_widgets", widget)
        _uncut(actors, name)

    return widget, remove


def surface(
    plotter: pv.BasePlotter,
    actors: Sequence[FibletActor],
    name: str,
    mesh: pv.PolyData,
    region: Region,
    *,
    inside: bool,
    look: dict[str, Any],
    **options: Any,
) -> tuple[Any, pv.Actor, Callable[[], None]]:
    """Add the mesh of a region, which cuts wherever it is dragged and turned; return its actor, too."""
    shown = plotter.add_mesh(mesh, name=f"{name} widget", reset_camera=False, render=False, **look)

    def cut(matrix: Any) -> None:
        placed = region.moved(np.asarray(matrix, float))
        for item in actors:
            item.clip(placed, inside=inside, name=name)

    cut(np.eye(4))
    widget = plotter.add_affine_transform_widget(shown, interact_callback=cut, release_callback=cut, **options)

    def remove() -> None:
        widget.remove()
        plotter.remove_actor(shown, reset_camera=False, render=False)
        _uncut(actors, name)

    return widget, shown, remove


def _end_widget(plotter: pv.BasePlotter, kind: str, widget: Any) -> None:
    """Switch one of VTK's widgets off and have the plotter forget it."""
    widget.Off()
    held = getattr(getattr(plotter, "widgets", plotter), kind)  # of PyVista 0.49, and of those before
    if widget in held:
        held.remove(widget)


def bounds_of(actors: Sequence[FibletActor]) -> tuple[float, ...]:
    """Return what holds all actors, world mm."""
    each = np.array([actor.bounds for actor in actors], float).reshape(-1, 3, 2)
    low, high = each[:, :, 0].min(0), each[:, :, 1].max(0)
    return tuple(np.stack([low, high], axis=1).ravel().tolist())


def centre(actors: Sequence[FibletActor]) -> np.ndarray:
    """Return the middle of all actors, world mm."""
    middle: np.ndarray = np.array(bounds_of(actors)).reshape(3, 2).mean(1)
    return middle


def _uncut(actors: Sequence[FibletActor], name: str) -> None:
    for actor in actors:
        if name in actor.clips:
            actor.unclip(name)


def _box_region(box: pv.PolyData) -> Region:
    """Return the region of VTK's box: its first eight points are the corners, turned or not."""
    from pvfiblets import regions

    corners = np.asarray(box.points[:8], float)
    # 0 to 1, 3 and 4 lead along the three edges.
    edges = (corners[[1, 3, 4]] - corners[0]).T / 2.0
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = edges, corners.mean(0)
    return regions.Box((-1.0, 1.0, -1.0, 1.0, -1.0, 1.0)).moved(matrix)
