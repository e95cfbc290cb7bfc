"""Three linked slices and the 3-D view in one window: ``plotter.slices.workspace(...)``."""

from __future__ import annotations

import weakref
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np
import numpy.typing as npt
import pyvista as pv

from pvfiblets.mappers.kept_views import KeptViews
from pvfiblets.plotting.slices.layer import SliceLayer
from pvfiblets.plotting.slices.layouts import LAYOUTS, viewports
from pvfiblets.plotting.slices.pane import Pane
from pvfiblets.plotting.slices.pane_events import PaneEvents
from pvfiblets.plotting.slices.plane import before_render, on_events, prepare
from pvfiblets.plotting.slices.stack import SliceStack
from pvfiblets.slices.frames import ORIENTATIONS

__all__ = ["PointValues", "Workspace"]

Array = npt.NDArray[np.float64]

CONVENTIONS = ("radiological", "neurological")


@dataclass(frozen=True)
class PointValues:
    """What is at a position.

    Attributes
    ----------
    position : numpy.ndarray
        ``(3,)`` mm.
    voxel : tuple of int or None
        Of the lowest image; None outside of it.
    images : dict
        By layer, as of `SliceStack.values`.
    streamlines : dict
        By actor: ids of streamlines of which a point lies within the radius.
    """

    position: Array
    voxel: tuple[int, int, int] | None
    images: dict[str, Any]
    streamlines: dict[str, npt.NDArray[np.int64]]


class Workspace:
    """Axial, coronal and sagittal panes and the 3-D view, linked by a cross-hair.

    ``plotter.slices.workspace(...)`` makes it. Its properties may be set at any time and show with the next render.

    In a pane, the left button moves the cross-hair, the wheel goes through slices, the right button changes the window
    of the `active` layer (sideways its width, up and down its level), the middle one moves the slice, and the wheel
    with Ctrl zooms. Arrow keys move the cross-hair by a voxel in the pane under the mouse, Page Up and Page Down go
    through its slices; G begins a position to be typed, in mm or, with a V before it, in voxels. A click on a slice of
    the 3-D view moves the cross-hair there.

    Attributes
    ----------
    slices : SliceStack
        Images in layers, and their slices in the 3-D view.
    panes : mapping of str to Pane
    """

    def __init__(
        self,
        plotter: Any,
        slices: SliceStack,
        renderers: Mapping[str, Any],
        *,
        thickness: float,
        convention: str,
        layout: str,
        color: Any,
    ) -> None:
        # What is wrong with them is said before anything is shown.
        _choice("convention", convention, CONVENTIONS)
        _choice("layout", layout, LAYOUTS)
        _length(thickness)
        self._plotter = plotter  # a proxy
        self.slices = slices
        self._renderers = dict(renderers)
        self._color = color
        self.panes: Mapping[str, Pane] = MappingProxyType(
            {name: Pane(slices, name, renderers[name], color) for name in ORIENTATIONS}
        )
        self._meshes: dict[str, tuple[Any, Any, float]] = {}
        self._contours_at: Array | None = None
        self._tracts: list[Any] = []
        self._active: SliceLayer | None = None
        self._callbacks: list[Callable[[Array], None]] = []
        self._where: Array = slices.position
        self._removed = False
        self._told = True
        self._ends = [before_render(one, self, "sync") for one in renderers.values()]
        if plotter.render_window is not None:
            self._ends.append(on_events(plotter.render_window, ("WindowResizeEvent",), self, "_arrange"))
        self._kept: KeptViews | None = None
        if plotter.render_window is not None:
            self._kept = KeptViews(plotter.render_window, renderers.values(), _weakly(self._prepare))
        self.convention = convention
        self.thickness = thickness
        self.layout = layout
        for pane in self.panes.values():
            slices.show_glyphs_on(pane.renderer, pane.place)
        slices.watch(_weakly(self._slices_changed))
        self._events: PaneEvents | None = None
        if plotter.iren is not None:
            self._events = PaneEvents(self, plotter)
        self._slices_changed()

    # Place --------------------------------------------------------------------------------------

    @property
    def position(self) -> Array:
        """``(3,)`` mm: the cross-hair."""
        return self.slices.position

    @position.setter
    def position(self, position: Any) -> None:
        self.slices.position = position

    @property
    def voxel(self) -> tuple[int, int, int] | None:
        """The cross-hair's voxel of the lowest image; None outside of it."""
        return self.slices.voxel

    @voxel.setter
    def voxel(self, voxel: Any) -> None:
        self.slices.voxel = voxel

    def step(self, pane: str, right: int = 0, up: int = 0, toward: int = 0) -> None:
        """Move the cross-hair by voxels: to the right, up, and towards the viewer of a pane."""
        one = self.panes[pane]
        layers = self.slices.layers
        if not layers:
            return
        moved = self.position
        for n, direction in zip((right, up, toward), (*one.axes, one.toward), strict=True):
            # How far it is along a direction from the middle of a voxel to that of the next.
            inverse = layers[0].image.inverse[:3, :3] @ direction
            moved = moved + n * direction / float(abs(inverse).max())
        self.position = moved

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
        self._contours_at = None

    @property
    def layout(self) -> str:
        """Which views are shown, and where.

        ``"grid"``, ``"row"``, ``"beside"`` (the 3-D view and, small, three slices: below it in a window that is higher
        than wide), or one of ``"3d"``, ``"axial"``,
        ``"coronal"`` and ``"sagittal"`` alone.
        """
        return self._layout

    @layout.setter
    def layout(self, layout: str) -> None:
        self._layout = _choice("layout", layout, LAYOUTS)
        self._arrange()

    def _arrange(self, *_: Any) -> None:
        """Lay views out as it suits the window, which may have another shape now."""
        width, height = self._plotter.window_size
        places = viewports(self._layout, width / max(height, 1))
        for name, renderer in self._renderers.items():
            renderer.SetDraw(name in places)
            renderer.SetInteractive(name in places)
            renderer.SetViewport(*places.get(name, (0.0, 0.0, 0.001, 0.001)))

    @property
    def active(self) -> SliceLayer:
        """The layer whose window the right button changes; the lowest until another is set."""
        if self._active is None or self._active not in self.slices.layers:
            return self.slices.layers[0]
        return self._active

    @active.setter
    def active(self, layer: SliceLayer | str) -> None:
        found = self.slices.layer(layer) if isinstance(layer, str) else layer
        if found not in self.slices.layers:
            raise ValueError(f"active is {layer!r}, which is no layer of the workspace")
        self._active = found

    @property
    def cross_hair(self) -> bool:
        """Whether the panes show the cross-hair."""
        return self.panes["axial"].cross_hair

    @cross_hair.setter
    def cross_hair(self, shown: bool) -> None:
        for pane in self.panes.values():
            pane.cross_hair = shown

    @property
    def told(self) -> bool:
        """Whether the axial pane says position and values in its corner."""
        return self._told

    @told.setter
    def told(self, told: bool) -> None:
        self._told = bool(told)
        self.say(None)

    # Values -------------------------------------------------------------------------------------

    def values(self, radius: float = 2.0) -> PointValues:
        """Return what is under the cross-hair.

        Parameters
        ----------
        radius : float, default: 2.0
            mm: streamlines of which a point is nearer are listed, if they are shown. Compressed data are asked, of
            which few are decoded. Where points are farther apart than that, positions between them count, too.

        Returns
        -------
        PointValues

        Raises
        ------
        ValueError
            If the radius is no length above 0.
        """
        from pvfiblets.query.passing import region_flags
        from pvfiblets.query.point_flags import ANY
        from pvfiblets.regions import Sphere

        position = self.position
        ball = Sphere(position, radius)
        found: dict[str, npt.NDArray[np.int64]] = {}
        for actor in self._fiblets():
            region: Any = ball
            matrix = np.array(actor.user_matrix, np.float64)
            if not np.array_equal(matrix, np.eye(4)):
                region = ball.moved(np.linalg.inv(matrix))
            sampling = float(radius) if actor.fiblets.step > radius else None
            flags = region_flags(actor.fiblets, region, sampling, bits=ANY)
            found[str(actor.name)] = np.flatnonzero((flags & ANY > 0) & actor.shown)
        return PointValues(position, self.voxel, self.slices.values(), found)

    def on_move(self, callback: Callable[[Array], None]) -> None:
        """Call something with the position, ``(3,)`` mm, whenever the cross-hair moves."""
        if not callable(callback):
            raise TypeError(f"callback is a {type(callback).__name__}; give a function of the position")
        self._callbacks.append(callback)

    # Contours -----------------------------------------------------------------------------------

    def add_contours(
        self, mesh: pv.DataSet, color: Any = "yellow", line_width: float = 2.0, name: str | None = None
    ) -> str:
        """Show where a mesh is cut by the slices.

        Parameters
        ----------
        mesh : pyvista.DataSet
            A surface, in world coordinates.
        color : color-like
        line_width : float
            Pixels.
        name : str, optional
            Replaces the contours of the same name.

        Returns
        -------
        str
            The name, for `remove_contours`.
        """
        if not isinstance(mesh, pv.DataSet):
            raise TypeError(f"mesh is a {type(mesh).__name__}; give a pyvista mesh")
        name = name or f"contours {len(self._meshes) + 1}"
        self.remove_contours(name)
        self._meshes[name] = mesh, pv.Color(color), float(line_width)
        self._contours_at = None
        return name

    def remove_contours(self, name: str) -> None:
        """Take contours away; names that are not there do no harm."""
        if self._meshes.pop(name, None) is not None:
            for pane in self.panes.values():
                pane.set_contour(name, None)

    # Inside -------------------------------------------------------------------------------------

    def _fiblets(self) -> Iterable[Any]:
        """Return fiblet actors of the 3-D view; nothing is imported where there are none."""
        component = vars(self._plotter).get("fiblets") if hasattr(self._plotter, "__dict__") else None
        view = self._renderers["3d"]
        return [] if component is None else [one for one in component if view.HasViewProp(one)]

    def _slices_changed(self) -> None:
        for pane in self.panes.values():
            pane.changed()
        position = self.slices.position
        self.panes["axial"].say(self._words)
        if (position != self._where).any():
            self._where = position
            for callback in self._callbacks:
                callback(position)

    @property
    def _words(self) -> str:
        if not self._told:
            return ""
        lines = ["{:.1f} {:.1f} {:.1f} mm".format(*self.position)]
        if self.voxel is not None:
            lines[0] += "   voxel {} {} {}".format(*self.voxel)
        for name, value in self.slices.values().items():
            if isinstance(value, float):
                value = f"{value:.4g}"
            elif isinstance(value, tuple):
                value = f"{value[1]} ({value[0]})" if value[1] != str(value[0]) else str(value[0])
            elif isinstance(value, np.ndarray):
                value = " ".join(f"{part:.3g}" for part in value)
            lines.append(f"{name}: {'-' if value is None else value}")
        return "\n".join(lines)

    def say(self, text: str | None) -> None:
        """Write into the axial pane's corner; None for position and values, as usual."""
        self.panes["axial"].say(self._words if text is None else text)

    def sync(self) -> None:
        """Have each pane show the 3-D view's streamlines in its slab, and contours; a renderer is about to draw."""
        actors = list(self._fiblets())
        for actor in [one for one in self._tracts if one not in actors]:  # no longer in the 3-D view
            self._take_out(actor)
        self._tracts = actors
        for pane in self.panes.values():
            planes = pane.planes
            for actor in actors:
                if not pane.renderer.HasViewProp(actor):
                    vars(self._plotter)["fiblets"].show_in(actor, pane.renderer)
                actor.mapper.cut_in(pane.renderer, planes)
        position = self.position
        if self._contours_at is None or (position != self._contours_at).any():
            self._contours_at = position
            for name, (mesh, color, width) in self._meshes.items():
                for pane in self.panes.values():
                    pane.set_contour(name, mesh.slice(normal=pane.toward, origin=position), color, width)

    def _prepare(self) -> None:
        """Bring all views that are shown up to date."""
        for renderer in self._renderers.values():
            if renderer.GetDraw():
                prepare(renderer)

    def _take_out(self, actor: Any) -> None:
        """Show streamlines in no pane any more."""
        for pane in self.panes.values():
            pane.renderer.remove_actor(actor, reset_camera=False, render=False)
            actor.mapper.cut_in(pane.renderer, None)

    def render(self) -> None:
        """Draw all views, unless somebody else draws all that there is, as servers do."""
        interactor = None if self._plotter.iren is None else self._plotter.iren.interactor
        if interactor is None or interactor.GetEnableRender():
            self._plotter.render()

    @property
    def removed(self) -> bool:
        """Whether :meth:`remove` has been called."""
        return self._removed

    def picked_in_view(self, x: float, y: float) -> Array | None:
        """Return the position of the slice that a pixel of the 3-D view shows; None if it shows none."""
        renderer = self._renderers["3d"]
        ends = []
        for depth in (0.0, 1.0):
            renderer.SetDisplayPoint(x, y, depth)
            renderer.DisplayToWorld()
            point = np.array(renderer.GetWorldPoint())
            ends.append(point[:3] / point[3])
        near, ray = ends[0], ends[1] - ends[0]
        hits = []
        for plane in self.slices:
            pixels, grid = plane.actor.pixels, plane.grid
            across = float(ray @ plane.normal)
            if not plane.visible or grid is None or pixels is None or across == 0.0:
                continue
            share = float((plane.origin - near) @ plane.normal) / across
            hit = near + share * ray
            at = hit - grid.corner
            i, j = int(at @ grid.along // (grid.along @ grid.along)), int(at @ grid.up // (grid.up @ grid.up))
            if 0 <= i < pixels.shape[1] and 0 <= j < pixels.shape[0] and pixels[j, i, 3] and share > 0.0:
                hits.append((share, hit))
        return min(hits, key=lambda one: one[0])[1] if hits else None

    def pane_at(self, x: float, y: float) -> Pane | None:
        """Return the pane of a pixel of the window; None if it is none's."""
        for name, pane in self.panes.items():
            if name not in viewports(self._layout):
                continue
            left, bottom = pane.renderer.GetOrigin()
            width, height = pane.pixels
            if left <= x < left + width and bottom <= y < bottom + height:
                return pane
        return None

    def stop(self) -> None:
        """End gestures and follow renderers no more; the views stay as they are."""
        if self._events is not None:
            self._events.stop()
            self._events = None
        if self._kept is not None:
            self._kept.stop()
            self._kept = None
        while self._ends:
            self._ends.pop()()

    def remove(self) -> None:
        """Take panes, slices and gestures away; twice is harmless."""
        self._removed = True
        self.stop()
        for actor in self._tracts:
            self._take_out(actor)
        self._tracts = []
        for pane in self.panes.values():
            pane.remove()
        self.slices.remove()


def _choice(name: str, given: str, choices: tuple[str, ...]) -> str:
    if given not in choices:
        raise ValueError(f"{name} is {given!r}; choose one of {choices}")
    return given


def _length(thickness: Any) -> float:
    found = float(thickness) if isinstance(thickness, (int, float, np.number)) else np.nan
    if not 0.0 < found < np.inf:
        raise ValueError(f"thickness is {thickness!r}; give a length above 0, mm")
    return found


def _weakly(method: Callable[[], None]) -> Callable[[], None]:
    reference = weakref.WeakMethod(method)

    def call() -> None:
        alive = reference()
        if alive is not None:
            alive()

    return call
