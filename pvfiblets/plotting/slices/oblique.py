"""The oblique slice of a workspace: its plane, its pane, its lines in the other panes, and the widget that turns it.

It always goes through the cross-hair, so that its normal is all that there is to say of it. Panes show where it cuts
them as a line with two handles: a drag of one turns the slice about the pane's own direction. A widget of VTK's turns
it in the 3-D view and, pushed along its arrow, takes the cross-hair with it.
"""

from __future__ import annotations

import weakref
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
import pyvista as pv
from vtkmodules.vtkCommonCore import vtkWeakReference

from pvfiblets.mappers.frames.observers import weakly
from pvfiblets.plotting.active_view import active_view
from pvfiblets.plotting.slices.pane import Pane

if TYPE_CHECKING:
    from pvfiblets.plotting.slices.plane import SlicePlane
    from pvfiblets.plotting.slices.workspace import Workspace

Array = npt.NDArray[np.float64]

NAME = "oblique"  # name of the plane and of its pane

HANDLE = 0.36  # distance of handles from the cross-hair, per the smaller side of a pane
HANDLE_RADIUS, REACH = 5.0, 14.0
"""Pixels: how large handles are drawn, and how near one takes hold of them, which fingers do, too."""
GAP = 12.0  # pixels of the line's middle that stay free for the cross-hair's
FLATTEST = 1e-3  # sine of the angle below which a pane lies in the slice, and no line shows where they meet

_RING = 12


class Trace:
    """The line in which the oblique slice cuts a pane."""

    def __init__(self, pane: Pane, plane: SlicePlane, color: Any) -> None:
        self.pane, self._plane = pane, plane
        closed = np.array([*range(_RING), 0])
        rings = [np.array([_RING + 1, *(closed + first)]) for first in (8, 8 + _RING)]
        lines = np.concatenate([[2, 0, 1, 2, 2, 3, 2, 4, 5, 2, 6, 7], *rings])
        self._mesh = pv.PolyData(np.zeros((8 + 2 * _RING, 3)), lines=lines)
        mapper = pv.DataSetMapper(self._mesh)
        mapper.SetScalarVisibility(False)
        self._actor = pv.Actor(mapper=mapper)
        self._actor.prop.lighting = False
        self._actor.prop.color = color
        self._actor.prop.line_width = 1.5
        pane.renderer.add_actor(self._actor, reset_camera=False, render=False, pickable=False)

    @property
    def direction(self) -> Array | None:
        """``(3,)`` unit direction of the line; None where it is not shown."""
        along = np.cross(self.pane.toward, self._plane.normal)
        size = float(np.linalg.norm(along))
        return along / size if self._plane.visible and size > FLATTEST else None

    def _handles(self, direction: Array) -> Array:
        """Return ``(2, 3)`` mm: middles of the handles."""
        reach = HANDLE * min(self.pane.pixels) * self.pane.scale
        return self.pane.stack.position + reach * np.array([[1.0], [-1.0]]) * direction

    def refresh(self) -> None:
        """Lie where the slice is; the pane is about to draw."""
        direction = self.direction
        self._actor.visibility = direction is not None
        if direction is None:
            return
        pane, scale = self.pane, self.pane.scale
        angles = 2.0 * np.pi * np.arange(_RING) / _RING
        right, up = pane.axes
        ring = HANDLE_RADIUS * scale * (np.cos(angles)[:, None] * right + np.sin(angles)[:, None] * up)
        reach, far = HANDLE * min(pane.pixels) * scale, 4.0 * max(pane.pixels) * scale
        edge = HANDLE_RADIUS * scale
        along = np.array([GAP * scale, reach - edge, reach + edge, far])
        ends = pane.stack.position + np.concatenate([along, -along])[:, None] * direction
        points = np.concatenate([ends, *(one + ring for one in self._handles(direction))])
        points = points + pane.before * pane.toward
        if not np.array_equal(points, self._mesh.points):
            self._mesh.points = points

    def handle_at(self, x: float, y: float) -> int | None:
        """Return which handle a pixel of the window takes hold of, 1 or -1; None for neither."""
        direction = self.direction
        if direction is None:
            return None
        away = [np.hypot(*np.subtract(self.pane.pixel_of(one), (x, y))) for one in self._handles(direction)]
        nearest = int(np.argmin(away))
        return (1, -1)[nearest] if away[nearest] <= REACH else None

    def normal_towards(self, x: float, y: float, handle: int) -> Array | None:
        """Return the slice's normal once a handle points to a pixel of the window; None at the cross-hair itself."""
        direction = self.direction
        wanted = handle * (self.pane.position_at(x, y) - self.pane.stack.position)
        size = float(np.linalg.norm(wanted))
        if direction is None or size < self.pane.scale:
            return None
        wanted /= size
        toward = self.pane.toward
        angle = np.arctan2(float(np.cross(direction, wanted) @ toward), float(direction @ wanted))
        return turned_about(self._plane.normal, toward, float(angle))

    def remove(self) -> None:
        """Take it away."""
        self.pane.renderer.remove_actor(self._actor, reset_camera=False, render=False)


def turned_about(direction: Array, axis: Array, angle: float) -> Array:
    """Return a direction ``(3,)`` turned about a unit axis, right-handed, by radians."""
    along = axis * float(axis @ direction)
    return along + np.cos(angle) * (direction - along) + np.sin(angle) * np.cross(axis, direction)


class ObliqueSlice:
    """The oblique slice of a workspace; ``workspace.add_oblique(...)`` makes it.

    Its properties may be set at any time and show with the next render.
    """

    def __init__(self, workspace: Workspace, plane: SlicePlane, pane: Pane | None, color: Any) -> None:
        self._workspace: Any = weakref.proxy(workspace)
        # none where the plotter has no fifth view
        self.plane, self.pane = plane, pane  # in the 3-D view
        self.traces = {
            name: Trace(one, plane, color) for name, one in workspace.panes.items() if one.plane is not plane
        }
        self.drag: int | None = None  # which drag of a handle turns it now, counted from 1; None while none is held
        self._drags = 0
        self._widget: Any = None
        self._callbacks: list[Callable[[Array], None]] = []

    def __repr__(self) -> str:
        x, y, z = self.normal
        return f"<ObliqueSlice across ({x:.3g}, {y:.3g}, {z:.3g})>"

    @property
    def normal(self) -> Array:
        """``(3,)`` unit direction across the slice; setting it turns the slice about the cross-hair."""
        return self.plane.normal

    @normal.setter
    def normal(self, normal: Any) -> None:
        before = self.plane.normal
        self.plane.normal = normal
        if np.array_equal(before, self.plane.normal):
            return
        if self.pane is not None:
            self.pane.changed()
        self._place_widget()
        for call in self._callbacks:
            call(self.plane.normal)

    @property
    def visible(self) -> bool:
        """Whether the slice, its pane, its lines and its widget are shown."""
        return self.plane.visible

    @visible.setter
    def visible(self, visible: bool) -> None:
        if bool(visible) == self.plane.visible:
            return
        self.plane.visible = visible
        widget = self._live_widget()
        if widget is not None:
            widget.SetEnabled(bool(visible))
        self._workspace.arrange()

    def hold(self, held: bool) -> None:
        """Take note that a handle is taken, or let go."""
        self._drags += held
        self.drag = self._drags if held else None

    def on_turn(self, callback: Callable[[Array], None]) -> None:
        """Call something with the normal, ``(3,)``, whenever the slice is turned."""
        if not callable(callback):
            raise TypeError(f"callback is a {type(callback).__name__}; give a function of the normal")
        self._callbacks.append(callback)

    def add_widget(self, plotter: pv.BasePlotter, view: Any, **options: Any) -> None:
        """Add a plane widget of VTK's that turns and pushes the slice, to one of a plotter's views."""
        corners = self.plane.corners
        bounds = np.stack([corners.min(axis=0), corners.max(axis=0)], axis=1).ravel()
        options = {"interaction_event": "always", "outline_translation": False, **options}
        with active_view(plotter, view):
            widget = plotter.add_plane_widget(
                weakly(self._dragged, passing=True), normal=tuple(self.normal), origin=tuple(self.plane.origin),
                bounds=tuple(bounds), **options,
            )  # fmt: skip
        self._widget = vtkWeakReference()
        self._widget.Set(widget)

    def _live_widget(self) -> Any:
        return None if self._widget is None else self._widget.Get()

    def _dragged(self, normal: Any, origin: Any) -> None:
        self.normal = normal
        if not np.allclose(origin, self._workspace.position, atol=1e-9):
            self._workspace.position = origin

    def _place_widget(self) -> None:
        """Move the widget to the slice, without an event."""
        widget = self._live_widget()
        if widget is not None and not np.allclose(
            [widget.GetNormal(), widget.GetOrigin()], [self.normal, self.plane.origin], atol=1e-9
        ):
            widget.SetNormal(*self.normal)
            widget.SetOrigin(*self.plane.origin)
            widget.UpdatePlacement()

    def changed(self) -> None:
        """Follow the cross-hair."""
        self._place_widget()

    def refresh(self) -> None:
        """Bring lines in panes up to date."""
        for trace in self.traces.values():
            trace.refresh()

    def remove(self) -> None:
        """Take lines and widget away; the plane goes with its stack."""
        for trace in self.traces.values():
            trace.remove()
        widget, self._widget = self._live_widget(), None
        if widget is not None:
            widget.Off()


def add_oblique_slice(
    workspace: Workspace, plotter: pv.BasePlotter, normal: Any, cross_hair_color: Any, color: Any
) -> ObliqueSlice:
    """Add an oblique slice to the 3-D view of a workspace, and to the plotter's fifth view, if there is one."""
    if workspace.oblique is not None:
        raise ValueError("the workspace has an oblique slice already; set workspace.oblique.normal")
    views = list(plotter.renderers)
    with active_view(plotter, views[3]):
        plane = plotter.slices.add_oblique(workspace.slices, normal, name=NAME, widget=False)
    pane = None
    if len(views) > 4:
        pane = Pane(workspace.slices, NAME, views[4], cross_hair_color, plane)
        workspace.take(pane)
    return ObliqueSlice(workspace, plane, pane, color)
