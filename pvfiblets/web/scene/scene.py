"""The scene of one session: a document, and the plotter that is kept in step with it.

All changes of the document go through :meth:`Scene.become`: actors get the differences, and if one of them
refuses, all is as before. So undo, sessions and single settings are the same thing, a :class:`.State` to become.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pvfiblets.formats.attachments import name_of
from pvfiblets.support.vtk_space import Space
from pvfiblets.web.scene import layers
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
from pvfiblets.web.scene.bundles import SceneBundles
from pvfiblets.web.scene.cameras import Cameras
from pvfiblets.web.scene.distance_label import show_distances
from pvfiblets.web.scene.files.loading import Cancel, Files, Loaded, Progress
from pvfiblets.web.scene.filters import SceneFilters
from pvfiblets.web.scene.layer_queries import LayerQueries
from pvfiblets.web.scene.matrix import SceneMatrix
from pvfiblets.web.scene.measurements import SceneMeasurements
from pvfiblets.web.scene.regions import SceneRegions
from pvfiblets.web.scene.scalar_bars import Bars
from pvfiblets.web.scene.selection import SceneSelection
from pvfiblets.web.scene.slices.canvas import Canvas
from pvfiblets.web.scene.slices.painted import ScenePainting
from pvfiblets.web.scene.slices.slice_images import SliceImages
from pvfiblets.web.scene.slices.slicing import Slicing
from pvfiblets.web.session.document import (
    LINES,
    Clip,
    Filters,
    Ids,
    Layer,
    Measurement,
    Source,
    State,
    as_volume_choice,
    free_name,
    volumes_of,
)
from pvfiblets.web.session.store import Store
from pvfiblets.web.values import colour, text

if TYPE_CHECKING:
    import pyvista as pv

MOST_LAYERS = 64
MOST_VALUES = 64  # files of values of one layer
LONGEST_NAME = 1024  # largest number of characters of a layer's name


@dataclass(frozen=True)
class Change:
    """A change, as listeners receive it."""

    what: str  # its name in a list of things to undo
    key: tuple[str, ...] | None = None  # changes of one key that follow each other at once are one, as a slider's are
    whole: bool = False  # they are one step however long they pause, like the moves of a drag


@dataclass(frozen=True)
class _Drawn:
    """An actor, and the state applied to it."""

    actor: Any
    layer: Layer
    clips: tuple[Clip, ...]
    whole: Any = None  # of a mesh: what the actor draws where nothing is cut


class Scene:
    """The scene of a session.

    All methods but :meth:`load` are for the thread that renders. None of them renders: call ``plotter.render()``.
    """

    def __init__(
        self, plotter: pv.BasePlotter, root: Path | None = None, *, allowed: Any = (), look: str | None = None,
        cluster: str | None = None,  # whose workers draw fiblets, as of `plotter.add_fiblets`
    ) -> None:  # fmt: skip
        self.plotter = plotter  # drawn into; it is the scene's own
        self._look, self._cluster = look, cluster  # that streamlines begin with (`pvfiblets.plotting.fiblets.looks`)
        self.files = Files(root, allowed)
        self._state = State(background=plotter.background_color.hex_rgb)
        self._drawn: dict[str, _Drawn] = {}
        self.store = Store(self.files)
        self.filters = SceneFilters(self)
        self.regions = SceneRegions(self)
        self.selection = SceneSelection(self)
        self.images = SliceImages(self)
        self.painting = ScenePainting(self)
        self.bundles = SceneBundles(self)
        self.matrix = SceneMatrix(self)
        self.measurements = SceneMeasurements(self)
        self.queries = LayerQueries(self)
        self.cameras = Cameras(self)
        self.bars = Bars(plotter)
        self.slicing = Slicing(plotter, self.images.turn_oblique, self.images.keep_window)
        self.canvas = Canvas(self.slicing)
        self._listeners: list[Callable[[Change], None]] = []
        self._used = 0
        self._measured: tuple[Measurement, ...] = ()  # drawn ones

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

    def become(self, state: State, what: str = "", key: tuple[str, ...] | None = None, *, whole: bool = False) -> None:
        """Bring everything in step with another document."""
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
        regrouped = self.bundles.sync.groups(state, sets)
        for layer in state.layers:
            self._draw(layer, state.clips)
        actors = [(layer, self._drawn[layer.id].actor) for layer in state.layers]
        put_in_order(self.plotter.renderer, [actor for layer, actor in actors if layer.kind != "image"])
        self.slicing.put_in_order([actor for layer, actor in actors if layer.kind == "image"])
        self.slicing.tilt(state.oblique)
        lines = [(layer, actor) for layer, actor in actors if layer.kind in LINES]
        self.canvas.become(state.painting, lines)
        self.bundles.sync.show(state, lines, regrouped)
        self.matrix.draw(state)
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
            cut(actor, layer, clips, self.store.shape, drawn.whole)
        self._drawn[layer.id] = _Drawn(actor, layer, clips, drawn.whole)

    def _draw_image(self, layer: Layer, drawn: _Drawn | None) -> None:
        data = self.data(layer).data
        if drawn is None:
            self._drawn[layer.id] = _Drawn(self.slicing.add(layer, data, self.store.colours), layer, ())
        elif drawn.layer is not layer:
            image = self.slicing.look(drawn.actor, drawn.layer, layer, data, self.store.colours)
            self._drawn[layer.id] = _Drawn(image, layer, ())

    def _filter(self, drawn: _Drawn, layer: Layer) -> None:
        read = self.store.shape, self.store.end_labels, self.store.colours
        try:
            filter_as(drawn.actor, drawn.layer.filters, layer.filters, *read)
        except BaseException:  # some of it may be in force already
            drawn.actor.show_all()
            filter_as(drawn.actor, Filters(), drawn.layer.filters, *read)
            cut(drawn.actor, drawn.layer, drawn.clips, self.store.shape)
            raise

    # Layers -------------------------------------------------------------------------------------

    def load(
        self, path: str | Path, kind: str | None = None, progress: Progress | None = None, cancel: Cancel | None = None,
        space: Space | None = None,
    ) -> Loaded:  # fmt: skip
        """Read a file, and compress it if need be, for :meth:`add`; may run in a thread of its own."""
        # A file of VTK that names no space has coordinates of `space`.
        if kind == "selection" or (kind is not None and kind not in layers.KINDS):
            raise ValueError(
                f"kind is {kind!r}; choose one of {', '.join(k for k in layers.KINDS if k != 'selection')}"
            )
        place = self.files.resolve(path)
        source = Source(self.files.name(place), space=space)
        return self.images.with_names(self.files.load(source, kind, progress, cancel))

    def add(self, loaded: Loaded, *, name: str | None = None) -> Layer:
        """Add a layer of what :meth:`load` returned."""
        settings = layers.beginning(loaded.kind, loaded.data)
        if self._look is not None and loaded.kind in layers.LINES:
            settings = layers.changed(loaded.kind, settings, "look", self._look, loaded.data)
        self.queries.histograms = {
            key: found for key, found in self.queries.histograms.items() if key[1] != loaded.source
        }
        layer = Layer(
            self.fresh_id(),
            loaded.kind,
            self._free_name(loaded.name if name is None else text(name, "name")),
            loaded.source,
            settings=settings,
        )
        first = layer.kind == "image" and self.slicing.workspace is None
        with self.store.with_new(loaded):
            found = self._add(layer, f"open {layer.name}")
        # An image is larger than its tracts, and its view has become smaller.
        if first and len(self.layers) > 1 and not self.cameras.refit():
            self.cameras.reset()
        return found

    def open(
        self, path: str | Path, kind: str | None = None, progress: Progress | None = None, cancel: Cancel | None = None
    ) -> Layer:
        """Read a file and add a layer of it; see :meth:`load`."""
        return self.add(self.load(path, kind, progress, cancel))

    def load_values(self, layer_id: str, path: str | Path) -> Loaded:
        """Read values for a layer's streamlines or vertices, for :meth:`attach`; may run in a thread of its own."""
        layer = self.layer(layer_id)
        source = (layer if layer.kind == "mesh" else self.lines_layer(layer_id)).source
        name = self.files.name(self.files.resolve(path))
        values = tuple(dict.fromkeys([*source.values, name]))
        if len(values) > MOST_VALUES:
            raise ValueError(f"{layer.name} has {MOST_VALUES} files of values, which is the most; open it again")
        twin = self.store.fork()
        return twin.data(replace(layer, source=replace(source, values=values), settings={}))

    def attach(self, layer_id: str, loaded: Loaded) -> Layer:
        """Give a layer the values that :meth:`load_values` read, and colour it by the last of them."""
        layer = self.layer(layer_id)
        name = self._last_values(loaded)
        with self.store.with_new(loaded):
            checked = layers.check(layer.kind, "scalars", name, loaded.data)
            settings = layers.changed(layer.kind, layer.settings, "scalars", checked, loaded.data)
            changed = replace(layer, source=loaded.source, settings=settings)
            self.change(changed, f"values {name} of {layer.name}")
        return changed

    @staticmethod
    def _last_values(loaded: Loaded) -> str:
        """Return what to colour by of the last file of values: of labels, by the colours of their table."""
        if loaded.kind != "mesh":
            name = name_of(loaded.source.values[-1])
            held = {**loaded.data.per_point, **loaded.data.per_streamline}
            columns = (one for one in held if one.startswith(f"{name} "))
            return name if name in held else next(columns, name)
        from pvfiblets.plotting.gifti import shown_array

        return shown_array(loaded.data, loaded.source.values[-1])

    def load_demo(self, streamlines: int = 5000, voxels: int = 64) -> list[Loaded]:
        """Make tracts up, and a head around them, for :meth:`add_loaded_demo`; may run in a thread of its own."""
        sources = Source(demo="tracts", size=int(streamlines)), Source(demo="head", size=int(voxels))
        return [self.files.load(source) for source in sources]

    def add_loaded_demo(self, loaded: Sequence[Loaded]) -> list[Layer]:
        """Add synthetic data: tracts, and a head that is hidden at first."""
        tracts, head = [self.add(one) for one in loaded]
        self.show(head.id, False)
        return [tracts, self.layer(head.id)]

    def remove(self, layer_id: str) -> None:
        """Take a layer away."""
        layer = self.layer(layer_id)
        kept = tuple(other for other in self.layers if other is not layer)
        clips = tuple(
            replace(clip, layers=tuple(i for i in clip.layers if i != layer_id))
            if clip.layers is not None and layer_id in clip.layers
            else clip
            for clip in self.state.clips
        )
        matrix = self.state.matrix
        matrix = None if matrix is not None and matrix.layer == layer_id else matrix
        self.become(replace(self.state, layers=kept, clips=clips, matrix=matrix), f"remove {layer.name}")

    def duplicate(self, layer_id: str) -> Layer:
        """Add a layer like another, with the same settings and filters."""
        layer = self.layer(layer_id)
        twin = replace(layer, id=self.fresh_id(), name=self._free_name(layer.name))
        return self._add(twin, f"duplicate {layer.name}")

    def rename(self, layer_id: str, name: str) -> None:
        """Give a layer another name."""
        layer = self.layer(layer_id)
        self.change(replace(layer, name=text(name, "name")), f"rename {layer.name}")

    def show(self, layer_id: str, visible: bool) -> None:
        """Show or hide a layer."""
        layer = self.layer(layer_id)
        self.change(replace(layer, visible=bool(visible)), f"{'show' if visible else 'hide'} {layer.name}")

    def set(self, layer_id: str, name: str, value: Any) -> None:
        """Set a property of a layer."""
        layer = self.layer(layer_id)
        checked = layers.check(layer.kind, name, value, self.data(layer).data, self.volume_choices(layer))
        settings = layers.changed(layer.kind, layer.settings, name, checked, self.data(layer).data)
        self.change(replace(layer, settings=settings), f"{name} of {layer.name}", ("set", layer_id, name))

    def keep_selection(self, layer_id: str) -> Layer:
        """Add a layer of another layer's selection."""
        layer = self.lines_layer(layer_id)
        if layer.selected is None:
            raise ValueError(f"nothing of {layer.name!r} is selected; pick streamlines first")
        chosen = layer.selected.array()
        if layer.source.ids is not None:
            chosen = layer.source.ids.array()[chosen]
        source = replace(layer.source, ids=Ids.from_numbers(chosen))
        settings: dict[str, Any] = dict(layer.settings)
        for key, value in (("tube_radius", None), ("opacity", 1.0)):
            settings = layers.changed(layer.kind, settings, key, value, self.data(layer).data)
        name = self._free_name(f"{len(layer.selected):,} of {layer.name}"[: LONGEST_NAME - 10])
        return self._add(Layer(self.fresh_id(), "selection", name, source, settings=settings), f"keep {name}")

    # Inside -------------------------------------------------------------------------------------

    def _add(self, layer: Layer, what: str) -> Layer:
        if len(self.layers) >= MOST_LAYERS:
            raise ValueError(f"there are {MOST_LAYERS} layers, which is the most; remove one first")
        first = not self.layers
        self.become(replace(self.state, layers=(*self.layers, layer)), what)
        if first:
            self.cameras.view("oblique")
        return layer

    def change(self, layer: Layer, what: str, key: tuple[str, ...] | None = None) -> None:
        """Put a layer in the place of the one of the same id."""
        changed = tuple(layer if other.id == layer.id else other for other in self.layers)
        self.become(replace(self.state, layers=changed), what, key)

    def lines_layer(self, layer_id: str) -> Layer:
        """Return a layer that is made of streamlines."""
        layer = self.layer(layer_id)
        if layer.kind not in LINES:
            raise ValueError(f"{layer.name!r} is of kind {layer.kind}; only tractograms have streamlines to choose")
        return layer

    def fresh_id(self) -> str:
        """Return an id that no layer and no cut has."""
        taken = {layer.id for layer in self.layers} | {clip.id for clip in self.state.clips}
        while True:
            self._used += 1
            if (found := f"layer{self._used}") not in taken:
                return found

    def _free_name(self, name: str) -> str:
        return free_name(name, {layer.name for layer in self.layers})

    # Data ---------------------------------------------------------------------------------------

    def data(self, layer: Layer, progress: Progress | None = None, cancel: Cancel | None = None) -> Loaded:
        """Return what a layer draws; it is read if it must be."""
        return self.store.data(layer, progress, cancel)

    def forget_unused(self, states: Iterable[State] = ()) -> None:
        """Release data that neither the document nor any of some other states needs."""
        self.store.keep([self._state, *states])

    def volume_choices(self, layer: Layer) -> list[tuple[Any, str]]:
        """Return what colours a layer by a volume, and how that is called."""
        # These are the scene's volumes, its other images of one number per voxel, and what colours the layer now.
        others = [other for other in self.layers if other.kind == "image" and other.id != layer.id]
        named = {one.source.bare: one.name for one in others if self.data(one).data.n_volumes == 1}
        named |= {other.source: other.name for other in self.layers if other.kind == "volume"}
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
        """Remove all layers and temporary files; a second call has no effect."""
        self._listeners.clear()
        self.become(State(background=self._state.background))
        self.bars.close()
        self.store.clear()
        self.files.close()


def _whole(layer: Layer, actor: Any) -> Any:
    """Return what the actor of a mesh was made to draw: smooth shading makes other points than the file's."""
    return actor.mapper.dataset if layer.kind == "mesh" else None
