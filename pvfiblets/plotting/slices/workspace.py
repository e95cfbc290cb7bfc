"""Three linked slices and the 3-D view in one window: ``plotter.slices.workspace(...)``."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from types import MappingProxyType
from typing import Any

import numpy as np
import numpy.typing as npt
import pyvista as pv

from pvfiblets.mappers.frames.kept_views import KeptViews
from pvfiblets.mappers.frames.observers import observe, weakly
from pvfiblets.plotting.slices.contours import PaneContours
from pvfiblets.plotting.slices.following import before_render, prepare
from pvfiblets.plotting.slices.layer import SliceLayer
from pvfiblets.plotting.slices.layouts import LAYOUTS, viewports
from pvfiblets.plotting.slices.oblique import NAME as OBLIQUE
from pvfiblets.plotting.slices.oblique import ObliqueSlice, add_oblique_slice
from pvfiblets.plotting.slices.pane import Pane
from pvfiblets.plotting.slices.pane_events import PaneEvents
from pvfiblets.plotting.slices.picking import picked_on_planes
from pvfiblets.plotting.slices.point_values import PointValues, streamlines_near, words_of
from pvfiblets.plotting.slices.seams import show_seams
from pvfiblets.plotting.slices.stack import SliceStack
from pvfiblets.slices.frames import ORIENTATIONS

__all__ = ["PointValues", "Workspace"]

Array = npt.NDArray[np.float64]

CONVENTIONS = ("radiological", "neurological")


class Workspace:
    """Axial, coronal and sagittal panes and the 3-D view, linked by a cross-hair.

    ``plotter.slices.workspace(...)`` makes it. Its properties may be set at any time and show with the next render.

    In a pane, the left button moves the cross-hair, the wheel goes through slices, the right button changes the window
    of the `active` layer (sideways its width, up and down its level), the middle one moves the slice, and the wheel
    with Ctrl zooms. Arrow keys move the cross-hair by a voxel in the pane under the mouse, Page Up and Page Down go
    through its slices; G begins a position to be typed, in mm or, with a V before it, in voxels. A click on a slice of
    the 3-D view moves the cross-hair there. Where panes show the line of an oblique slice, a drag of its handles turns
    it.

    Attributes
    ----------
    slices : SliceStack
        Images in layers, and their slices in the 3-D view.
    panes : mapping of str to Pane
    oblique : ObliqueSlice or None
        That of :meth:`add_oblique`.
    """

    def __init__(
        self,
        plotter: pv.BasePlotter,
        slices: SliceStack,
        renderers: Mapping[str, Any],
        *,
        thickness: float,
        convention: str,
        layout: str,
        color: Any,
    ) -> None:
        # Errors are raised before anything is shown.
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
        self.oblique: ObliqueSlice | None = None
        self._contours = PaneContours()
        self._tracts: list[Any] = []
        self._active: SliceLayer | None = None
        self._callbacks: list[Callable[[Array], None]] = []
        self._where: Array = slices.position
        self._removed = False
        self._told = True
        self._ends = [before_render(one, self.sync) for one in renderers.values()]
        if plotter.render_window is not None:
            self._ends.append(observe(plotter.render_window, ("WindowResizeEvent",), weakly(self.arrange)))
        self._kept: KeptViews | None = None
        if plotter.render_window is not None:
            self._kept = KeptViews(plotter.render_window, renderers.values(), weakly(self._prepare))
        self.convention = convention
        self.thickness = thickness
        self.layout = layout
        for pane in self.panes.values():
            slices.show_glyphs_on(pane.renderer, pane.place)
        slices.watch(weakly(self._slices_changed))
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
        """Voxel of the lowest image at the cross-hair; None outside the image."""
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

    def on_window(self, callback: Callable[[SliceLayer], Any]) -> None:
        """Call a function with the layer whose window the right button has changed."""
        if not callable(callback):
            raise TypeError(f"callback is a {type(callback).__name__}; give a function of the layer")
        if self._events is not None:
            self._events.windowed.append(callback)

    @property
    def told(self) -> bool:
        """Whether the axial pane shows position and values in its corner."""
        return self._told

    @told.setter
    def told(self, told: bool) -> None:
        self._told = bool(told)
        self.say(None)

    # All panes ----------------------------------------------------------------------------------

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
        """Thickness of the slab about each slice whose streamlines are shown in its pane, mm."""
        return self.panes["axial"].thickness

    @thickness.setter
    def thickness(self, thickness: float) -> None:
        found = _length(thickness)
        for pane in self.panes.values():
            pane.thickness = found
        self._contours.forget()

    @property
    def layout(self) -> str:
        """Visible views, and their layout.

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
        """Places of the visible views; the layout of a hidden pane counts as ``"beside"``."""
        width, height = self._plotter.window_size
        there = self._has_oblique_pane
        layout = "beside" if self._layout == OBLIQUE and not there else self._layout
        return viewports(layout, width / max(height, 1), oblique=there)

    def postpone(self, renderer: pv.Renderer) -> None:
        """Keep a view's picture in the next frame, though it has changed."""
        if self._kept is not None:
            self._kept.postpone(renderer)

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

    # Oblique slice ------------------------------------------------------------------------------

    def add_oblique(
        self, normal: Any = (0.0, -0.5, 1.0), *, widget: bool = True, color: Any = "#40d0ff", **widget_options: Any
    ) -> ObliqueSlice:
        """Add a slice at any angle through the cross-hair.

        A widget turns it in the 3-D view, and a drag of the handles of its line in a pane turns it there. A plotter of
        five views, as ``pv.Plotter(shape=(1, 5))`` is, shows it in a pane of its own, too.

        Parameters
        ----------
        normal : (3,) array, default: (0, -0.5, 1)
            Normal of the slice.
        widget : bool, default: True
            Whether there is a widget in the 3-D view.
        color : color-like
            Of its lines in the panes.
        **widget_options
            Of :meth:`pyvista.Plotter.add_plane_widget`.

        Returns
        -------
        ObliqueSlice
            ``normal`` and ``visible`` are live; ``on_turn`` calls back.

        Raises
        ------
        ValueError
            If there is one already, or the normal is no direction.
        """
        if self.oblique is not None:
            raise ValueError("the workspace has an oblique slice already; set workspace.oblique.normal")
        self.oblique = add_oblique_slice(self, self._plotter, normal, self._color, color)
        if widget and self._plotter.iren is not None:
            self.oblique.add_widget(self._plotter, self._renderers["3d"], **widget_options)
        self._contours.forget()
        self.arrange()
        return self.oblique

    def take(self, pane: Pane) -> None:
        """Set up one more pane like the initial ones."""
        pane.mirrored = self.convention == "radiological"
        pane.thickness, pane.cross_hair = self.thickness, self.cross_hair
        self.panes = MappingProxyType({**self.panes, pane.name: pane})
        renderer = self._renderers[pane.name] = pane.renderer
        self._ends.append(before_render(renderer, self.sync))
        if self._kept is not None:
            self._kept.follow(renderer)
        self.slices.show_glyphs_on(renderer, pane.place)

    # Values -------------------------------------------------------------------------------------

    def values(self, radius: float = 2.0) -> PointValues:
        """Return the values under the cross-hair.

        Parameters
        ----------
        radius : float, default: 2.0
            mm: shown streamlines with a point within it are listed. Few points of compressed data are decoded for
            this. Where points are farther apart than that, positions between them count, too.

        Returns
        -------
        PointValues

        Raises
        ------
        ValueError
            If the radius is no length above 0.
        """
        found = streamlines_near(self._fiblets(), self.position, radius)
        return PointValues(self.position, self.voxel, self.slices.values(), found)

    def on_move(self, callback: Callable[[Array], None]) -> None:
        """Call a function with the position, ``(3,)`` mm, whenever the cross-hair moves."""
        if not callable(callback):
            raise TypeError(f"callback is a {type(callback).__name__}; give a function of the position")
        self._callbacks.append(callback)

    # Contours -----------------------------------------------------------------------------------

    def add_contours(
        self, mesh: pv.DataSet, color: Any = "yellow", line_width: float = 2.0, name: str | None = None
    ) -> str:
        """Show the intersection of a mesh with the slices.

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
        return self._contours.add(mesh, color, line_width, name, self.panes.values())

    def remove_contours(self, name: str) -> None:
        """Remove contours; unknown names are ignored."""
        self._contours.remove(name, self.panes.values())

    # Inside -------------------------------------------------------------------------------------

    def _fiblets(self) -> Iterable[Any]:
        """Return fiblet actors of the 3-D view; nothing is imported where there are none."""
        component = vars(self._plotter).get("fiblets") if hasattr(self._plotter, "__dict__") else None
        view = self._renderers["3d"]
        return [] if component is None else [one for one in component if view.HasViewProp(one)]

    def _slices_changed(self) -> None:
        for pane in self.panes.values():
            pane.changed()
        if self.oblique is not None:
            self.oblique.changed()
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
        return words_of(self.position, self.voxel, self.slices.values())

    def say(self, text: str | None) -> None:
        """Write a text into the axial pane's corner; None shows position and values, the default."""
        self.panes["axial"].say(self._words if text is None else text)

    def sync(self) -> None:
        """Show the 3-D view's streamlines in each pane's slab, and contours, before a renderer draws."""
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
        if self.oblique is not None:
            self.oblique.refresh()
        self._contours.show(self.position, self.panes.values())

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
        """Render all views, unless a server does."""
        interactor = None if self._plotter.iren is None else self._plotter.iren.interactor
        if interactor is None or interactor.GetEnableRender():
            self._plotter.render()

    @property
    def removed(self) -> bool:
        """Whether :meth:`remove` has been called."""
        return self._removed

    def picked_in_view(self, x: float, y: float) -> Array | None:
        """Return the position of the slice that a pixel of the 3-D view shows; None if it shows none."""
        return picked_on_planes(self._renderers["3d"], self.slices, x, y)

    def pane_at(self, x: float, y: float) -> Pane | None:
        """Return the pane at a window pixel; None outside all panes."""
        for name, pane in self.panes.items():
            if name not in self._places:
                continue
            left, bottom = pane.renderer.GetOrigin()
            width, height = pane.pixels
            if left <= x < left + width and bottom <= y < bottom + height:
                return pane
        return None

    def stop(self) -> None:
        """End gestures and updates; the views stay as they are."""
        if self._events is not None:
            self._events.stop()
            self._events = None
        if self._kept is not None:
            self._kept.stop()
            self._kept = None
        while self._ends:
            self._ends.pop()()

    def remove(self) -> None:
        """Remove panes, slices and gestures; a second call has no effect."""
        self._removed = True
        self.stop()
        for actor in self._tracts:
            self._take_out(actor)
        self._tracts = []
        if self.oblique is not None:
            self.oblique.remove()
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
