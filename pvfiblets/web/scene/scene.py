"""The scene of one session: a document, and the plotter that is kept in step with it.

Whatever changes the document goes through :meth:`Scene.become`: actors are told what differs, and if one of them
refuses, all is as it was. So undo, sessions and single settings are the same thing, a :class:`.State` to become.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from pvfiblets.web.scene.actors import (
    add_actor,
    cut,
    filter_as,
    look_as,
    put_in_order,
    remove_actor,
    select_as,
    split_cuts,
)
from pvfiblets.web.scene.bundles import BundleSync, SceneBundles
from pvfiblets.web.scene.cameras import Cameras
from pvfiblets.web.scene.canvas import Canvas
from pvfiblets.web.scene.distance_label import show_distances
from pvfiblets.web.scene.filters import SceneFilters
from pvfiblets.web.scene.layer_list import SceneLayers
from pvfiblets.web.scene.layer_queries import LayerQueries
from pvfiblets.web.scene.loading import Cancel, Files, Loaded, Progress
from pvfiblets.web.scene.matrix import SceneMatrix
from pvfiblets.web.scene.measurements import SceneMeasurements
from pvfiblets.web.scene.painted import ScenePainting
from pvfiblets.web.scene.regions import SceneRegions
from pvfiblets.web.scene.scalar_bars import Bars
from pvfiblets.web.scene.selection import SceneSelection
from pvfiblets.web.scene.slice_images import SceneSlices
from pvfiblets.web.scene.slicing import Slicing
from pvfiblets.web.session.document import LINES, Clip, Filters, Layer, Measurement, State, as_volume_choice, volumes_of
from pvfiblets.web.session.store import Store
from pvfiblets.web.values import colour

__all__ = ["Change", "Scene"]


@dataclass(frozen=True)
class Change:
    """What listeners are told.

    Attributes
    ----------
    what : str
        What was done, for a list of things to undo.
    key : tuple or None
        Changes of one key that follow each other at once are one, as a slider's are.
    whole : bool
        They are one however long they pause, as those of a drag.
    """

    what: str
    key: tuple[str, ...] | None = None
    whole: bool = False


@dataclass(frozen=True)
class _Drawn:
    """An actor, and what it is in step with."""

    actor: Any
    layer: Layer
    clips: tuple[Clip, ...]
    whole: Any = None  # of a mesh: what the actor draws where nothing is cut


class Scene(
    SceneLayers, SceneFilters, SceneRegions, SceneSelection, SceneSlices, ScenePainting, SceneBundles, SceneMatrix,
    SceneMeasurements, LayerQueries, Cameras,
):  # fmt: skip
    """What a session shows.

    All methods but :meth:`load` are for the thread that renders. None of them renders: call ``plotter.render()``.

    Parameters
    ----------
    plotter : pyvista.Plotter
        Drawn into; it is the scene's own.
    root : Path, optional
        Folder that paths are relative to and confined to; any path is allowed without.
    allowed : iterable of Path
        Files and folders outside of the root that may be opened all the same.
    look : str, optional
        That streamlines begin with (`pvfiblets.plotting.fiblets.looks`).
    cluster : str, optional
        Whose workers draw fiblets, as of ``plotter.add_fiblets``.
    """

    def __init__(
        self, plotter: Any, root: Path | None = None, *, allowed: Any = (), look: str | None = None,
        cluster: str | None = None,
    ) -> None:  # fmt: skip
        self.plotter = plotter
        self._look, self._cluster = look, cluster
        self.files = Files(root, allowed)
        self._state = State(background=plotter.background_color.hex_rgb)
        self._drawn: dict[str, _Drawn] = {}
        self.store = Store(self.files)
        self.bars = Bars(plotter)
        self.slicing = Slicing(plotter, self.turn_oblique)
        self.canvas = Canvas(self.slicing)
        self._bundled = BundleSync()
        self._listeners: list[Callable[[Change], None]] = []
        self._histograms: dict[tuple[Any, ...], dict[str, Any]] = {}
        self._used = 0
        self._measured: tuple[Measurement, ...] = ()  # those in the picture

    # The document -------------------------------------------------------------------------------

    @property
    def root(self) -> Path | None:
        """Folder that paths are relative to."""
        return self.files.root

    @property
    def state(self) -> State:
        """The document as it is; it never changes, another one takes its place."""
        return self._state

    @property
    def layers(self) -> tuple[Layer, ...]:
        """All layers, in their order."""
        return self._state.layers

    def layer(self, layer_id: str) -> Layer:
        """Return a layer; KeyError if there is none of that id."""
        return self._state.layer(layer_id)

    def actor(self, layer_id: str) -> Any:
        """Return the actor that draws a layer; KeyError if there is none of that id. That of a mesh may change."""
        self._state.layer(layer_id)
        return self._drawn[layer_id].actor

    def watch(self, listener: Callable[[Change], None]) -> Callable[[], None]:
        """Call ``listener`` after every change of the document; return what ends that."""
        self._listeners.append(listener)
        return lambda: self._listeners.remove(listener) if listener in self._listeners else None

    def become(
        self, state: State, what: str = "", key: tuple[str, ...] | None = None, *, whole: bool = False
    ) -> None:
        """Bring everything in step with another document.

        Parameters
        ----------
        state : State
            That was checked.
        what : str
            What is done, for listeners; they are told nothing if it is empty.
        key, whole
            Of the :class:`Change`.

        Raises
        ------
        Exception
            What an actor or file refused; the scene is as it was.
        """
        if state == self._state:
            return
        try:
            self._step(state)
        except BaseException:
            self._step(self._state)
            raise
        self._state = state
        if what:
            for listener in tuple(self._listeners):
                listener(Change(what, key, whole))

    def _step(self, state: State) -> None:
        wanted = {layer.id: layer for layer in state.layers}
        for layer in state.layers:  # before anything changes
            self.data(layer)
            if layer.kind not in (*LINES, "volume", "image"):
                split_cuts(layer, [clip for clip in state.clips if clip.cuts(layer)])
        for layer_id, drawn in list(self._drawn.items()):
            new = wanted.get(layer_id)
            if new is None or (new.kind, new.source) != (drawn.layer.kind, drawn.layer.source):
                del self._drawn[layer_id]
                if drawn.layer.kind == "image":
                    self.slicing.remove(drawn.actor)
                else:
                    remove_actor(self.plotter, drawn.actor)
        sets = {layer.source: self.data(layer).data for layer in state.layers if layer.kind in LINES}
        regrouped = self._bundled.groups(state, sets)
        for layer in state.layers:
            self._draw(layer, state.clips)
        actors = [(layer, self._drawn[layer.id].actor) for layer in state.layers]
        put_in_order(self.plotter.renderer, [actor for layer, actor in actors if layer.kind != "image"])
        self.slicing.put_in_order([actor for layer, actor in actors if layer.kind == "image"])
        self.slicing.tilt(state.oblique)
        lines = [(layer, actor) for layer, actor in actors if layer.kind in LINES]
        self.canvas.become(state.painting, lines)
        self._bundled.show(state, lines, regrouped)
        if state.background != self.plotter.background_color.hex_rgb:
            self.plotter.set_background(state.background)
        if state.measurements != self._measured:
            show_distances(self.plotter, state.measurements)
            self._measured = state.measurements
        self.bars.show(actors, state.background)

    def _draw(self, layer: Layer, clips: tuple[Clip, ...]) -> None:
        """Bring one actor in step with its layer."""
        drawn = self._drawn.get(layer.id)
        if layer.kind == "image":
            self._draw_image(layer, drawn)
            return
        if drawn is None:
            actor = add_actor(self.plotter, layer, self.data(layer), self.store.colours, self._cluster)
            drawn = _Drawn(actor, replace(layer, filters=Filters(), selected=None), (), _whole(layer, actor))
        elif drawn.layer is layer and drawn.clips is clips:
            return
        else:
            actor = look_as(self.plotter, drawn.actor, drawn.layer, layer, self.data(layer), self.store.colours)
            same = actor is drawn.actor
            before, whole = (drawn.clips, drawn.whole) if same else ((), _whole(layer, actor))
            past = replace(layer, filters=drawn.layer.filters, selected=drawn.layer.selected)
            drawn = _Drawn(actor, past, before, whole)
        self._drawn[layer.id] = drawn
        if layer.kind in LINES:
            self._filter(drawn, layer)
            if drawn.layer.selected != layer.selected:
                select_as(actor, layer.selected)
        if drawn.clips != clips:
            cut(actor, layer, clips, self.shape_data, drawn.whole)
        self._drawn[layer.id] = _Drawn(actor, layer, clips, drawn.whole)

    def _draw_image(self, layer: Layer, drawn: _Drawn | None) -> None:
        data = self.data(layer).data
        if drawn is None:
            self._drawn[layer.id] = _Drawn(self.slicing.add(layer, data, self.store.colours), layer, ())
        elif drawn.layer is not layer:
            image = self.slicing.look(drawn.actor, drawn.layer, layer, data, self.store.colours)
            self._drawn[layer.id] = _Drawn(image, layer, ())

    def _filter(self, drawn: _Drawn, layer: Layer) -> None:
        try:
            filter_as(drawn.actor, drawn.layer.filters, layer.filters, self.shape_data, self.store.end_labels)
        except BaseException:  # some of it may be in force already
            drawn.actor.show_all()
            filter_as(drawn.actor, Filters(), drawn.layer.filters, self.shape_data, self.store.end_labels)
            cut(drawn.actor, drawn.layer, drawn.clips, self.shape_data)
            raise

    # Data ---------------------------------------------------------------------------------------

    def data(self, layer: Layer, progress: Progress | None = None, cancel: Cancel | None = None) -> Loaded:
        """Return what a layer draws; it is read if it must be."""
        return self.store.data(layer, progress, cancel)

    def forget_unused(self, states: Iterable[State] = ()) -> None:
        """Let go of data that neither the document nor any of some other states needs."""
        self.store.keep([self._state, *states])

    def shape_data(self, kind: str, path: str) -> Any:
        """Return what a region is made of: the region of a mesh, or an image of labels."""
        return self.store.shape(kind, path)

    def volume_choices(self, layer: Layer) -> list[tuple[Any, str]]:
        """Return what colours a layer by a volume, and how that is called: the scene's volumes, and its present one.

        Of images of slices, the scene's other images of one number per voxel, too.
        """
        named = {other.source: other.name for other in self.layers if other.kind == "volume"}
        if layer.kind == "image":
            others = [other for other in self.layers if other.kind == "image" and other.id != layer.id]
            named |= {one.source.bare: one.name for one in others if self.data(one).data.n_volumes == 1}
        for present in volumes_of(layer.settings).values():
            if present not in named:
                named[present] = f"demo {present.demo}" if present.path is None else Path(present.path).name
        word = "" if layer.kind == "image" else "volume "
        return [(as_volume_choice(source), f"{word}{name}") for source, name in named.items()]

    def set_background(self, value: str) -> None:
        """Set the colour behind everything."""
        background = colour(value, "background")
        self.become(replace(self._state, background=background), "background", ("background",))

    def close(self) -> None:
        """Take all layers away and remove what was made of files; twice is harmless."""
        self._listeners.clear()
        self.become(State(background=self._state.background))
        self.bars.close()
        self.store.clear()
        self.files.close()


def _whole(layer: Layer, actor: Any) -> Any:
    """Return what the actor of a mesh was made to draw: smooth shading makes other points than the file's."""
    return actor.mapper.dataset if layer.kind == "mesh" else None
