"""Widgets that cut: planes, boxes, slabs and meshes that a user drags.

Dragging sets a cut by its name, which changes some numbers in a uniform block: nothing is compressed or uploaded.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv

from pvfiblets.plotting.fiblets.filter_state import unique_name
from pvfiblets.plotting.fiblets.slabs import FibletSlab
from pvfiblets.plotting.region_sources import as_region, direction_of

if TYPE_CHECKING:
    from pvfiblets.plotting.fiblets.actor import FibletActor


class Widgets:
    """The part of :class:`~pvfiblets.plotting.fiblets.component.FibletsComponent` that adds widgets."""

    _plotter: Any

    def _init_widgets(self) -> None:
        self._removals: dict[str, Callable[[], None]] = {}

    def __iter__(self) -> Iterator[FibletActor]:
        raise NotImplementedError

    def add_slab(
        self,
        actor: FibletActor | Sequence[FibletActor] | None = None,
        normal: Any = "z",
        *,
        origin: Any = None,
        thickness: float = 5.0,
        volume: Any = None,
        name: str | None = None,
        render: bool = True,
        **mesh_options: Any,
    ) -> FibletSlab:
        """Cut actors to a slab, and show the slice of a volume in it.

        Parameters
        ----------
        actor : FibletActor or sequence of such, optional
            What is cut; all fiblet actors by default.
        normal : str or (3,) array, default: "z"
            ``"x"``, ``"y"``, ``"z"``, or a direction.
        origin : float or (3,) array, optional
            A point of the slab's middle plane, or how far along the normal it is; the actors' middle by default, mm.
        thickness : float, default: 5.0
            mm.
        volume : pyvista.DataSet, optional
            Drawn where the middle plane cuts it, in world coordinates.
        name : str, optional
            Of the cut.
        render : bool, default: True
            Render at once if the window is shown already.
        **mesh_options
            For :meth:`pyvista.Plotter.add_mesh` of the slice, such as ``cmap``, ``clim``,
            ``opacity``.

        Returns
        -------
        FibletSlab
            ``position``, ``thickness``, ``normal`` and ``origin`` are live; ``remove()`` ends it.
        """
        actors = self._cut_actors(actor)
        slab = FibletSlab(
            self._plotter,
            actors,
            self._new_name(name, "slab"),
            normal=normal,
            origin=_centre(actors) if origin is None else origin,
            thickness=thickness,
            volume=volume,
            **mesh_options,
        )
        self._removals[slab.name] = slab.remove
        if render:
            self._plotter.render()
        return slab

    def add_clip_plane_widget(
        self,
        actor: FibletActor | Sequence[FibletActor] | None = None,
        normal: Any = "x",
        *,
        origin: Any = None,
        invert: bool = False,
        name: str | None = None,
        interaction_event: Any = "always",
        **widget_options: Any,
    ) -> Any:
        """Add a plane that cuts where it is dragged.

        Parameters
        ----------
        actor : FibletActor or sequence of such, optional
            What is cut; all fiblet actors by default.
        normal : str or (3,) array, default: "x"
            What it points to stays.
        origin : (3,) array, optional
            A point of the plane; the middle of the actors by default, mm.
        invert : bool, default: False
            Keep the other side.
        name : str, optional
            Of the cut.
        interaction_event : str, default: "always"
            ``"end"`` cuts only when the mouse is let go.
        **widget_options
            For :meth:`pyvista.Plotter.add_plane_widget`.

        Returns
        -------
        vtkImplicitPlaneWidget
        """
        actors, name = self._cut_actors(actor), self._new_name(name, "plane")

        def cut(normal: Any, origin: Any) -> None:
            for item in actors:
                item.clip((normal, origin), inside=not invert, name=name)

        return self._plane_widget(name, actors, cut, normal, origin, interaction_event, widget_options)

    def add_clip_slab_widget(
        self,
        actor: FibletActor | Sequence[FibletActor] | None = None,
        normal: Any = "z",
        *,
        origin: Any = None,
        thickness: float = 5.0,
        volume: Any = None,
        name: str | None = None,
        interaction_event: Any = "always",
        mesh_options: dict[str, Any] | None = None,
        **widget_options: Any,
    ) -> tuple[Any, FibletSlab]:
        """Add a plane that a slab follows; parameters as for :meth:`add_slab`.

        Parameters
        ----------
        actor, normal, origin, thickness, volume, name
            As for :meth:`add_slab`.
        interaction_event : str, default: "always"
            ``"end"`` cuts only when the mouse is let go.
        mesh_options : dict, optional
            For :meth:`pyvista.Plotter.add_mesh` of the slice.
        **widget_options
            For :meth:`pyvista.Plotter.add_plane_widget`.

        Returns
        -------
        widget : vtkImplicitPlaneWidget
        slab : FibletSlab
            For its thickness.
        """
        actors = self._cut_actors(actor)
        slab = self.add_slab(
            actors,
            normal,
            origin=origin,
            thickness=thickness,
            volume=volume,
            name=name,
            render=False,
            **(mesh_options or {}),
        )

        def cut(normal: Any, origin: Any) -> None:
            slab.place(normal=normal, origin=origin)

        widget = self._plane_widget(
            slab.name, actors, cut, normal, slab.origin, interaction_event, widget_options
        )
        take_plane = self._removals[slab.name]

        def remove() -> None:
            take_plane()
            slab.remove()

        self._removals[slab.name] = remove
        return widget, slab

    def add_clip_box_widget(
        self,
        actor: FibletActor | Sequence[FibletActor] | None = None,
        *,
        bounds: Any = None,
        invert: bool = False,
        name: str | None = None,
        interaction_event: Any = "always",
        **widget_options: Any,
    ) -> Any:
        """Add a box that cuts where it is dragged, turned or not.

        Parameters
        ----------
        actor : FibletActor or sequence of such, optional
            What is cut; all fiblet actors by default.
        bounds : (6,) array, optional
            Of the box, mm; those of the actors by default.
        invert : bool, default: False
            Keep what is outside.
        name : str, optional
            Of the cut.
        interaction_event : str, default: "always"
            ``"end"`` cuts only when the mouse is let go.
        **widget_options
            For :meth:`pyvista.Plotter.add_box_widget`.

        Returns
        -------
        vtkBoxWidget
        """
        actors, name = self._cut_actors(actor), self._new_name(name, "box")

        def cut(box: pv.PolyData) -> None:
            region = _box_region(box)
            for item in actors:
                item.clip(region, inside=not invert, name=name)

        options = {"factor": 1.0, **widget_options}
        widget = self._plotter.add_box_widget(
            cut,
            bounds=_bounds(actors) if bounds is None else bounds,
            interaction_event=interaction_event,
            **options,
        )

        def remove() -> None:
            _end_widget(self._plotter, "box_widgets", widget)
            _uncut(actors, name)

        self._removals[name] = remove
        return widget

    def add_clip_mesh_widget(
        self,
        mesh: pv.PolyData,
        actor: FibletActor | Sequence[FibletActor] | None = None,
        *,
        invert: bool = False,
        name: str | None = None,
        color: Any = "white",
        opacity: float = 0.2,
        mesh_options: dict[str, Any] | None = None,
        **widget_options: Any,
    ) -> tuple[Any, pv.Actor]:
        """Add a closed mesh that cuts wherever it is dragged and turned.

        Parameters
        ----------
        mesh : pyvista.PolyData
            Closed; concave ones cut as exactly as convex ones.
        actor : FibletActor or sequence of such, optional
            What is cut; all fiblet actors by default.
        invert : bool, default: False
            Keep what is outside.
        name : str, optional
            Of the cut.
        color : color-like, default: "white"
            Of the mesh.
        opacity : float, default: 0.2
            Of the mesh.
        mesh_options : dict, optional
            For :meth:`pyvista.Plotter.add_mesh`.
        **widget_options
            For :meth:`pyvista.Plotter.add_affine_transform_widget`.

        Returns
        -------
        widget : pyvista.plotting.affine_widget.AffineWidget3D
        actor : pyvista.Actor
            Of the mesh; its ``user_matrix`` says where it is.

        Raises
        ------
        ValueError
            If the mesh is open, empty or inside-out.
        """
        region = as_region(mesh)
        actors, name = self._cut_actors(actor), self._new_name(name, "mesh")
        shown = self._plotter.add_mesh(
            mesh,
            color=color,
            opacity=opacity,
            name=f"{name} widget",
            reset_camera=False,
            render=False,
            **(mesh_options or {}),
        )

        def cut(matrix: Any) -> None:
            placed = region.moved(np.asarray(matrix, float))
            for item in actors:
                item.clip(placed, inside=not invert, name=name)

        cut(np.eye(4))
        widget = self._plotter.add_affine_transform_widget(
            shown, interact_callback=cut, release_callback=cut, **widget_options
        )

        def remove() -> None:
            widget.remove()
            self._plotter.remove_actor(shown, reset_camera=False, render=False)
            _uncut(actors, name)

        self._removals[name] = remove
        return widget, shown

    def clear_widgets(self) -> None:
        """Take all slabs and cutting widgets away, and what they cut."""
        for remove in list(self._removals.values()):
            remove()
        self._removals.clear()
        self._plotter.render()

    # Inside -------------------------------------------------------------------------------------

    def _plane_widget(
        self,
        name: str,
        actors: Sequence[FibletActor],
        cut: Callable[[Any, Any], None],
        normal: Any,
        origin: Any,
        interaction_event: Any,
        options: dict[str, Any],
    ) -> Any:
        """Add PyVista's plane widget, and note how to take it away."""
        plotter = self._plotter
        widget = plotter.add_plane_widget(
            cut,
            normal=direction_of(normal),
            origin=_centre(actors) if origin is None else origin,
            bounds=_bounds(actors),
            interaction_event=interaction_event,
            **options,
        )

        def remove() -> None:
            _end_widget(plotter, "plane_widgets", widget)
            _uncut(actors, name)

        self._removals[name] = remove
        return widget

    def _cut_actors(self, actor: Any) -> list[FibletActor]:
        actors = list(self) if actor is None else list(actor) if isinstance(actor, Sequence) else [actor]
        if not actors:
            raise ValueError("there is nothing to cut: this plotter has no fiblets; add_fiblets() first")
        return actors

    def _new_name(self, name: str | None, stem: str) -> str:
        """Return a name for a cut; a widget of the same name goes."""
        if name is None:
            return unique_name(self._removals, f"{stem} widget")
        if name in self._removals:
            self._removals.pop(name)()
        return name


def _end_widget(plotter: Any, kind: str, widget: Any) -> None:
    """Switch one of VTK's widgets off and have the plotter forget it."""
    widget.Off()
    held = getattr(getattr(plotter, "widgets", plotter), kind)  # of PyVista 0.49, and of those before
    if widget in held:
        held.remove(widget)


def _bounds(actors: Sequence[FibletActor]) -> tuple[float, ...]:
    """Return what holds all actors, world mm."""
    each = np.array([actor.bounds for actor in actors], float).reshape(-1, 3, 2)
    low, high = each[:, :, 0].min(0), each[:, :, 1].max(0)
    return tuple(np.stack([low, high], axis=1).ravel().tolist())


def _centre(actors: Sequence[FibletActor]) -> np.ndarray:
    centre: np.ndarray = np.array(_bounds(actors)).reshape(3, 2).mean(1)
    return centre


def _uncut(actors: Sequence[FibletActor], name: str) -> None:
    for actor in actors:
        if name in actor.clips:
            actor.unclip(name)


def _box_region(box: pv.PolyData) -> Any:
    """Return the region of VTK's box: its first eight points are the corners, turned or not."""
    from pvfiblets import regions

    corners = np.asarray(box.points[:8], float)
    # 0 to 1, 3 and 4 lead along the three edges.
    edges = (corners[[1, 3, 4]] - corners[0]).T / 2.0
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = edges, corners.mean(0)
    return regions.Box((-1.0, 1.0, -1.0, 1.0, -1.0, 1.0)).moved(matrix)
