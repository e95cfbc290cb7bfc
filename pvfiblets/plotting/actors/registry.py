"""The life cycle of a plotter's actors whose drawing is this package's.

A component of PyVista's (:class:`~pvfiblets.plotting.fiblets.component.FibletsComponent`) lives as long as
its plotter. It knows every actor that it added, raises errors that drawing met from the call that
rendered, keeps scalar bars in step, and gives GPU memory back when an actor is removed and when the
plotter closes.
"""

from __future__ import annotations

import warnings
import weakref
from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING, Any, ClassVar, Generic, Protocol, TypeVar

import pyvista as pv
from vtkmodules.vtkCommonCore import vtkCommand
from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor
from vtkmodules.vtkRenderingCore import vtkPicker

from pvfiblets.antialias import default_antialias
from pvfiblets.mappers.frames.scene import partly_shown
from pvfiblets.plotting.actors.source_changes import SourceChanges, is_dataset
from pvfiblets.plotting.colours.scalar_bar_labels import label_format
from pvfiblets.plotting.plotter_methods import exports, transparent, visible_picking  # noqa: F401 - registers them
from pvfiblets.plotting.settings.call_signature import document, refuse_unknown, split_arguments
from pvfiblets.plotting.settings.mesh_arguments import apply, translate
from pvfiblets.plotting.settings.settings import Settings
from pvfiblets.plotting.settings.shared import Common

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingCore import vtkRenderWindow


class Registered(Protocol):
    """The interface of registered actors, which also are :class:`pyvista.Actor`."""

    name: Any
    prop: Any
    mapper: Any
    user_matrix: Any

    @property
    def memory_address(self) -> str:
        """VTK's address of it."""
        ...

    @property
    def scalars_title(self) -> str | None:
        """Title of its scalar bar; None if it needs none."""
        ...

    @property
    def shows_labels(self) -> bool:
        """Whether its scalar bar names numbers."""
        ...

    @property
    def legend_color(self) -> pv.Color:
        """The colour of its entry in a legend."""
        ...

    def watch(self, bar_changed: Any) -> None:
        """Call that whenever another scalar bar is needed."""
        ...

    def entered(self, renderer: pv.Renderer) -> None:
        """Handle that a renderer draws it from now on."""
        ...

    def release(self, window: vtkRenderWindow | None = None) -> None:
        """Give back the GPU memory that it has in a window, or in all."""
        ...

    def raise_pending(self) -> None:
        """Raise what drawing stored, once."""
        ...

    def explain(self) -> dict[str, Any]:
        """Return what its drawing costs."""
        ...


A = TypeVar("A", bound=Registered)

LETTER = 0.5  # width of a letter per size of its font, about
NAMES_FONT = 18  # size of the font of names beside a scalar bar that VTK chooses in a small window, about
NAMES_SHARE = 0.42  # share of the window's width for names beside a scalar bar


CAMERA_REACH = 2.0**53
"""mm; PyVista's first camera looks from a mm beside the focal point, which is the same number beyond."""


def _warn_of_distance(actor: Any) -> None:
    """Warn, as ``add_mesh`` does, that the scene is too large for PyVista's camera."""
    reach = max(map(abs, actor.GetBounds() or (0.0,)))
    if CAMERA_REACH <= reach < float("inf"):
        warnings.warn(
            f"coordinates reach {reach:.3g} mm: beyond {CAMERA_REACH:.1g} mm PyVista's first camera has no direction "
            "and may show nothing; check the units, leave outliers out, or scale the points",
            UserWarning,
            stacklevel=7,
        )


@dataclass
class _Bar:
    """Whether an actor wants a scalar bar, how, and which one it has."""

    show: bool
    arguments: dict[str, Any]
    title: str | None = None
    labels: bool = False
    changing: bool = False


class ActorRegistry(ABC, Generic[A]):
    """Base of the components that add actors: makes and keeps actors of one kind.

    A subclass says what can be set, in `_SETTINGS`, and makes actors, in ``_make``. Arguments and doc of its ``add``
    are put together of these (`pvfiblets.plotting.settings.call_signature`).

    Parameters
    ----------
    plotter : pyvista.BasePlotter
        The plotter it belongs to.
    """

    # What can be set of its actors.
    _SETTINGS: ClassVar[type[Settings]]
    # Arguments of every ``add``.
    COMMON: ClassVar[type[Settings]] = Common
    # By which plotters know the component.
    NAME: ClassVar[str]

    # Name of the plotter's method that does the same as ``add``.
    ADD: ClassVar[str]

    # Arguments of ``_make`` beside the settings.
    OWN: ClassVar[frozenset[str]] = frozenset()

    def __init_subclass__(cls, **more: Any) -> None:
        super().__init_subclass__(**more)
        if "_make" in vars(cls):
            document(cls)

    def __init__(self, plotter: pv.BasePlotter) -> None:
        self._plotter: Any = weakref.proxy(plotter)
        self._actors: list[A] = []
        self._renderers: dict[str, tuple[Any, int, set[str]]] = {}
        self._bars: dict[str, _Bar] = {}
        self._sources: dict[str, SourceChanges] = {}

    def add(self, /, source: Any, **arguments: Any) -> A:
        """Make an actor and add it to the plotter."""
        words = self.COMMON.DECLARED.keys() - Common.DECLARED.keys()
        of_mesh = {name: arguments.pop(name) for name in words if name in arguments}
        translate(self.ADD, of_mesh, source, arguments, self._plotter.theme)
        common, given, own = split_arguments(self, Common, arguments)
        self._check_known(own)
        made = self._make(source, given, **own)
        apply(self.ADD, of_mesh, made)
        actor = self._add_actor(made, **common)
        if is_dataset(source) and not of_mesh.get("copy_mesh"):
            self._sources[actor.memory_address] = SourceChanges(source, actor)
        return actor

    @abstractmethod
    def _make(self, *source: Any, **own: Any) -> A:
        """Add an actor; same arguments and doc as ``add``."""

    def _check_known(self, own: dict[str, Any]) -> None:
        """Raise a TypeError for unknown arguments, in the name of the called function."""
        refuse_unknown(self, own)

    def __iter__(self) -> Iterator[A]:
        return iter(tuple(self._actors))

    def __len__(self) -> int:
        return len(self._actors)

    def explain(self) -> list[dict[str, Any]]:
        """Return the rendering cost of each actor.

        Returns
        -------
        list of dict
            One entry of the actor's own ``explain()`` per actor, with its ``name``.
        """
        return [{"name": actor.name, **actor.explain()} for actor in self]

    def _add_actor(
        self,
        actor: A,
        *,
        name: str | None,
        label: str | None,
        show_scalar_bar: bool | None,
        scalar_bar_args: dict[str, Any] | None,
        pickable: bool,
        user_matrix: Any,
        reset_camera: bool | None,
        render: bool,
    ) -> A:
        """Add an actor to the plotter's active renderer as ``add_mesh`` does, and keep it."""
        # Where an argument is refused, the actor is not left behind.
        for word, text in (("name", name), ("label", label)):
            if text is not None and not isinstance(text, str):
                raise TypeError(f"{word} is {text!r}; give a string")
        if scalar_bar_args is not None and not isinstance(scalar_bar_args, dict):
            raise TypeError(f"scalar_bar_args is {scalar_bar_args!r}; give a dict of arguments of add_scalar_bar")
        if user_matrix is not None:
            actor.user_matrix = user_matrix
        if show_scalar_bar is None:
            show_scalar_bar = self._plotter.theme.show_scalar_bar
        if reset_camera is None and self._plotter.camera_set:
            reset_camera = False
        renderer = self._plotter.renderer
        self._plotter.add_actor(
            actor, name=name, pickable=pickable, reset_camera=reset_camera, render=False
        )
        self._track(actor, renderer)
        self._meet_vtk()
        _warn_of_distance(actor)
        if label is not None:
            self._set_label(actor, label, renderer)
        if actor.scalars_title is not None or self._plotter.mapper is None:
            self._plotter.mapper = actor.mapper  # for `add_scalar_bar`, as after `add_mesh`
        self._bars[actor.memory_address] = _Bar(bool(show_scalar_bar), dict(scalar_bar_args or {}))
        try:
            self._update_bar(actor)
        except Exception:
            self._plotter.remove_actor(actor, render=False)
            raise
        actor.watch(self._recoloured)
        if render:
            self._plotter.render()
        return actor

    # Life cycle ---------------------------------------------------------------------------------

    def show_in(self, actor: A, renderer: pv.Renderer) -> None:
        """Show an actor in another renderer of the plotter, too; both share GPU memory.

        Parameters
        ----------
        actor : actor
            One of the component's.
        renderer : pyvista.Renderer
            Of the same plotter.
        """
        shown: Any = actor
        renderer.add_actor(
            shown, name=actor.name, reset_camera=False, render=False, pickable=bool(shown.GetPickable())
        )
        self._follow(actor, renderer)

    def _track(self, actor: A, renderer: pv.Renderer) -> None:
        self._actors.append(actor)
        for other in self._plotter.renderers:
            self._observe(other)
        self._follow(actor, renderer)
        # Registered current here, since `clear_on_render_callbacks` drops what others registered.
        self._plotter.add_on_render_callback(self._raise_pending)

    def _observe(self, renderer: pv.Renderer) -> set[str]:
        """Observe a renderer's actors; return the addresses of this package's actors in it."""
        address = renderer.GetAddressAsString("")
        if address not in self._renderers:
            # `Renderer.add_actor`, `remove_actor` and their kin end in Modified(): no other sign is given.
            tag = renderer.AddObserver(vtkCommand.ModifiedEvent, self._actors_changed)
            self._renderers[address] = (renderer, tag, set())
        return self._renderers[address][2]

    def _follow(self, actor: A, renderer: pv.Renderer) -> None:
        self._observe(renderer).add(actor.memory_address)
        actor.entered(renderer)
        self._smooth(renderer)

    def _meet_vtk(self) -> None:
        """Make the plotter's picker find actors: it is older than VTK's hook."""
        interactor = getattr(getattr(self._plotter, "iren", None), "interactor", None)
        picker = None if interactor is None else interactor.GetPicker()
        if len(self._actors) == 1 and isinstance(picker, vtkPicker):
            from pvfiblets.mappers.vtk_pipeline.vtk_overrides import follow

            follow(picker)

    def _actors_changed(self, _renderer: Any, _event: str) -> None:
        """Follow actors into other renderers, and release the GPU memory of removed ones."""
        if partly_shown:
            return
        for actor in self:
            showing = [one for one, _, _ in self._renderers.values() if one.HasViewProp(actor)]
            for renderer in showing:
                if actor.memory_address not in self._observe(renderer):
                    self._follow(actor, renderer)
            if not showing:
                self._forget(actor)
                for renderer, _, _ in self._renderers.values():
                    self._smooth(renderer)

    def _smooth(self, renderer: pv.Renderer) -> None:
        """Smooth edges by default where an actor of this package is shown; load nothing elsewhere."""
        if default_antialias() != "off":
            import_module("pvfiblets.plotting.picture_component")  # Qt's plotters have only imported components
            self._plotter.picture.follow(renderer)

    def _forget(self, actor: A) -> None:
        self._actors.remove(actor)
        for _renderer, _tag, shown in self._renderers.values():
            shown.discard(actor.memory_address)
        self._bars.pop(actor.memory_address, None)
        self._sources.pop(actor.memory_address, None)
        actor.watch(None)
        actor.release(self._plotter.render_window)

    def _raise_pending(self, _plotter: Any = None) -> None:
        for actor in self:
            actor.raise_pending()
            changes = self._sources.get(actor.memory_address)
            if changes is not None and changes.warn(actor, self.ADD):
                del self._sources[actor.memory_address]

    def __plotter_close__(self) -> None:
        """Release everything; PyVista calls this before the render window goes."""
        for renderer, tag, _ in self._renderers.values():
            renderer.RemoveObserver(tag)
        self._renderers.clear()
        for actor in self:
            self._forget(actor)

    # Scalar bars and legend ---------------------------------------------------------------------

    def _recoloured(self, actor: A) -> None:
        """Update the scalar bar and the legend."""
        self._update_bar(actor)
        for renderer, _, _ in self._renderers.values():
            entry = renderer._labels.get(actor.memory_address)  # noqa: SLF001
            if entry is not None:
                self._set_label(actor, entry[1], renderer)

    def _update_bar(self, actor: A) -> None:
        """Add, replace or remove the actor's scalar bar so that it says what the picture shows."""
        state = self._bars[actor.memory_address]
        if state.changing:
            return  # a bar that several actors share gives them all its range, which recolours them
        state.changing = True
        try:
            self._change_bar(actor, state)
        finally:
            state.changing = False

    def _change_bar(self, actor: A, state: _Bar) -> None:
        if state.title is not None and not self._has_bar(actor):
            state.show, state.title = False, None  # the user removed it: it stays away
        wanted = actor.scalars_title if state.show else None
        if wanted is not None:
            wanted = state.arguments.get("title", wanted)
        if wanted == state.title and actor.shows_labels == state.labels:
            self._write_labels(actor, state)
            return
        if state.title is not None:
            # PyVista does this for a removed actor; it removes an unused bar.
            bars = self._plotter.scalar_bars
            bars._remove_mapper_from_plotter(actor)  # noqa: SLF001
            # But not one that was given a place, both x and y.
            if state.title in bars and not bars._scalar_bar_mappers[state.title]:  # noqa: SLF001
                bars.remove_scalar_bar(state.title, render=False)
        if wanted is not None:
            self._plotter.mapper = actor.mapper  # what `plotter.update_scalar_bar_range` changes
            usual = {"n_labels": 0, "vertical": True, **self._small_names(actor)} if actor.shows_labels else {}
            arguments = {**usual, **state.arguments, "title": wanted}
            self._plotter.add_scalar_bar(mapper=actor.mapper, render=False, **arguments)
        state.title, state.labels = wanted, actor.shows_labels
        self._write_labels(actor, state)

    def _write_labels(self, actor: A, state: _Bar) -> None:
        """Set the digits that distinguish the numbers, unless the user sets a format."""
        if "fmt" in state.arguments or self._plotter.theme.font.fmt is not None or state.title is None:
            return
        table = actor.mapper.lookup_table
        form = None if table.GetScale() else label_format(*table.GetTableRange())
        self._plotter.scalar_bars[state.title].SetLabelFormat(form or vtkScalarBarActor().GetLabelFormat())

    def _small_names(self, actor: A) -> dict[str, Any]:
        """Return font sizes that keep names beside a bar within half of the window."""
        table = actor.mapper.lookup_table
        names = [table.GetAnnotation(i) for i in range(table.GetNumberOfAnnotatedValues())]
        width, height = self._plotter.window_size
        longest = max(map(len, names), default=0)
        if longest * LETTER * NAMES_FONT <= NAMES_SHARE * width:
            return {}
        size = min(NAMES_SHARE * width / (longest * LETTER), 0.4 * height / len(names))
        return {"label_font_size": max(int(size), 7), "title_font_size": max(int(size) + 2, 9)}

    def _has_bar(self, actor: A) -> bool:
        """Whether any scalar bar is the actor's."""
        shown = self._plotter.scalar_bars._scalar_bar_mappers  # noqa: SLF001
        return any(actor.mapper in mappers for mappers in shown.values())

    def _set_label(self, actor: A, label: str, renderer: pv.Renderer) -> None:
        face = pv.Rectangle() if actor.scalars_title else pv.Triangle()
        entry = (face, label, actor.legend_color)
        renderer._labels[actor.memory_address] = entry  # noqa: SLF001 - as add_mesh does
