"""The layers of a scene: opened, given values, added, changed, duplicated and taken away."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pvfiblets.formats.attachments import name_of
from pvfiblets.web.scene import layers
from pvfiblets.web.session.document import LINES, Ids, Layer, Source, State, free_name
from pvfiblets.web.values import text

if TYPE_CHECKING:
    from pvfiblets.web.scene.loading import Cancel, Files, Loaded, Progress
    from pvfiblets.web.scene.slicing import Slicing
    from pvfiblets.web.session.store import Store

__all__ = ["SceneLayers"]

MOST_LAYERS = 64
MOST_VALUES = 64  # files of values of one layer
LONGEST_NAME = 1024
"""Characters of a layer's name: a file's, and what it is a part of."""


class SceneLayers:
    """The part of :class:`~pvfiblets.web.scene.scene.Scene` that adds, changes and removes layers."""

    if TYPE_CHECKING:
        plotter: Any
        files: Files
        store: Store
        slicing: Slicing
        _look: str | None
        _histograms: dict[tuple[Any, ...], dict[str, Any]]
        _used: int

        @property
        def state(self) -> State: ...  # noqa: D102 - of the scene
        @property
        def layers(self) -> tuple[Layer, ...]: ...  # noqa: D102 - of the scene

        become: Callable[..., None]
        layer: Callable[[str], Layer]
        data: Callable[..., Loaded]
        volume_choices: Callable[[Layer], list[tuple[Any, str]]]
        with_names: Callable[[Loaded], Loaded]
        view: Callable[[str], None]
        reset: Callable[[], None]

    def load(
        self, path: str | Path, kind: str | None = None, progress: Progress | None = None, cancel: Cancel | None = None
    ) -> Loaded:
        """Read a file, and compress it if need be, for :meth:`add`; may run in a thread of its own.

        Parameters
        ----------
        path : str or Path
            Relative to the root, or absolute.
        kind : str, optional
            Of the layer; that which the file is for by default.
        progress, cancel : callable, optional
            See :meth:`.Files.load`.
        """
        if kind == "selection" or (kind is not None and kind not in layers.KINDS):
            raise ValueError(
                f"kind is {kind!r}; choose one of {', '.join(k for k in layers.KINDS if k != 'selection')}"
            )
        place = self.files.resolve(path)
        return self.with_names(self.files.load(Source(self.files.name(place)), kind, progress, cancel))

    def add(self, loaded: Loaded, *, name: str | None = None) -> Layer:
        """Add a layer of what :meth:`load` returned."""
        settings = layers.beginning(loaded.kind, loaded.data)
        if self._look is not None and loaded.kind in layers.LINES:
            settings = layers.changed(loaded.kind, settings, "look", self._look, loaded.data)
        self._histograms = {key: found for key, found in self._histograms.items() if key[1] != loaded.source}
        layer = Layer(
            self._fresh_id(),
            loaded.kind,
            self._free_name(loaded.name if name is None else text(name, "name")),
            loaded.source,
            settings=settings,
        )
        first = layer.kind == "image" and self.slicing.workspace is None
        with self.store.with_new(loaded):
            found = self._add(layer, f"open {layer.name}")
        if first and len(self.layers) > 1:
            self.reset()  # an image is larger than what it has tracts of, and its view has become smaller
            self.plotter.camera.zoom(1.4)  # VTK has room about it for the box's corners
        return found

    def open(
        self, path: str | Path, kind: str | None = None, progress: Progress | None = None, cancel: Cancel | None = None
    ) -> Layer:
        """Read a file and add a layer of it; see :meth:`load`."""
        return self.add(self.load(path, kind, progress, cancel))

    def load_values(self, layer_id: str, path: str | Path) -> Loaded:
        """Read values for a layer's streamlines or vertices, for :meth:`attach`; may run in a thread of its own."""
        layer = self.layer(layer_id)
        source = (layer if layer.kind == "mesh" else self._lines(layer_id)).source
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
            self._change(changed, f"values {name} of {layer.name}")
        return changed

    @staticmethod
    def _last_values(loaded: Loaded) -> str:
        """Return what to colour by of the last file of values: of labels, by the colours of their table."""
        if loaded.kind != "mesh":
            return name_of(loaded.source.values[-1])
        from pvfiblets.plotting.gifti import name_of as name_of_gifti

        name = name_of_gifti(loaded.source.values[-1])
        return f"{name}_rgb" if f"{name}_rgb" in loaded.data.point_data else name

    def load_demo(self, streamlines: int = 5000, voxels: int = 64) -> list[Loaded]:
        """Make tracts up, and a head around them, for :meth:`add_loaded_demo`; may run in a thread of its own."""
        sources = Source(demo="tracts", size=int(streamlines)), Source(demo="head", size=int(voxels))
        return [self.files.load(source) for source in sources]

    def add_loaded_demo(self, loaded: Sequence[Loaded]) -> list[Layer]:
        """Add what was made up: tracts, and a head that is not visible at first."""
        tracts, head = [self.add(one) for one in loaded]
        self.show(head.id, False)
        return [tracts, self.layer(head.id)]

    def add_demo(self, streamlines: int = 5000, voxels: int = 64) -> list[Layer]:
        """Make tracts and a head up, and add them."""
        return self.add_loaded_demo(self.load_demo(streamlines, voxels))

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
        twin = replace(layer, id=self._fresh_id(), name=self._free_name(layer.name))
        return self._add(twin, f"duplicate {layer.name}")

    def rename(self, layer_id: str, name: str) -> None:
        """Give a layer another name."""
        layer = self.layer(layer_id)
        self._change(replace(layer, name=text(name, "name")), f"rename {layer.name}")

    def show(self, layer_id: str, visible: bool) -> None:
        """Show or hide a layer."""
        layer = self.layer(layer_id)
        self._change(replace(layer, visible=bool(visible)), f"{'show' if visible else 'hide'} {layer.name}")

    def set(self, layer_id: str, name: str, value: Any) -> None:
        """Set a property of a layer.

        Parameters
        ----------
        layer_id : str
        name : str
            Of :data:`pvfiblets.web.scene.layers.TABLES`.
        value : JSON value
            As a browser sent it.
        """
        layer = self.layer(layer_id)
        checked = layers.check(layer.kind, name, value, self.data(layer).data, self.volume_choices(layer))
        settings = layers.changed(layer.kind, layer.settings, name, checked, self.data(layer).data)
        self._change(replace(layer, settings=settings), f"{name} of {layer.name}", ("set", layer_id, name))

    def keep_selection(self, layer_id: str) -> Layer:
        """Add a layer of what is selected of another, drawn on its own."""
        layer = self._lines(layer_id)
        if layer.selected is None:
            raise ValueError(f"nothing of {layer.name!r} is selected; pick streamlines first")
        chosen = layer.selected.array()
        if layer.source.ids is not None:
            chosen = layer.source.ids.array()[chosen]
        source = replace(layer.source, ids=Ids.of(chosen))
        settings: dict[str, Any] = dict(layer.settings)
        for key, value in (("tube_radius", None), ("opacity", 1.0)):
            settings = layers.changed(layer.kind, settings, key, value, self.data(layer).data)
        name = self._free_name(f"{len(layer.selected):,} of {layer.name}"[: LONGEST_NAME - 10])
        return self._add(Layer(self._fresh_id(), "selection", name, source, settings=settings), f"keep {name}")

    # Inside -------------------------------------------------------------------------------------

    def _add(self, layer: Layer, what: str) -> Layer:
        if len(self.layers) >= MOST_LAYERS:
            raise ValueError(f"there are {MOST_LAYERS} layers, which is the most; remove one first")
        first = not self.layers
        self.become(replace(self.state, layers=(*self.layers, layer)), what)
        if first:
            self.view("oblique")
        return layer

    def _change(self, layer: Layer, what: str, key: tuple[str, ...] | None = None) -> None:
        """Put a layer in the place of the one of the same id."""
        changed = tuple(layer if other.id == layer.id else other for other in self.layers)
        self.become(replace(self.state, layers=changed), what, key)

    def _lines(self, layer_id: str) -> Layer:
        """Return a layer that is made of streamlines."""
        layer = self.layer(layer_id)
        if layer.kind not in LINES:
            raise ValueError(f"{layer.name!r} is of kind {layer.kind}; only tractograms have streamlines to choose")
        return layer

    def _fresh_id(self) -> str:
        taken = {layer.id for layer in self.layers} | {clip.id for clip in self.state.clips}
        while True:
            self._used += 1
            if (found := f"layer{self._used}") not in taken:
                return found

    def _free_name(self, name: str) -> str:
        return free_name(name, {layer.name for layer in self.layers})
