"""Images of a scene as slices: names of their labels, and how they are looked at."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pvfiblets.plotting.slices.settings import MEANING
from pvfiblets.web.scene import layers
from pvfiblets.web.scene.slices.slicing import SliceView, check_view
from pvfiblets.web.session.document import Layer
from pvfiblets.web.values import shown

if TYPE_CHECKING:
    from pvfiblets.web.scene.files.loading import Loaded
    from pvfiblets.web.scene.scene import Scene


class SliceImages:
    """Images of a scene that are shown as slices: names of their labels, and how they are looked at."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene

    def with_names(self, loaded: Loaded) -> Loaded:
        """Return an image of labels with the table that lies beside its file, if one does; all else as it is."""
        if loaded.kind != "image" or loaded.source.path is None or loaded.source.values:
            return loaded
        from pvfiblets.web.scene.slices.label_images import table_beside

        beside = table_beside(loaded.data, self.scene.files.resolve(loaded.source.path))
        if beside is None:
            return loaded
        name = self.scene.files.name(self.scene.files.resolve(self.scene.files.name(beside)))
        return self.scene.files.with_values(loaded, (name,))

    def load_labels(self, layer_id: str, path: str | Path) -> Loaded:
        """Read names and colours of an image's labels, for :meth:`name_labels`; may run in a thread of its own."""
        layer = self.scene.layer(layer_id)
        if layer.kind != "image":
            raise ValueError(f"{layer.name!r} is of kind {layer.kind}; labels are of images that are shown as slices")
        name = self.scene.files.name(self.scene.files.resolve(path))
        twin = self.scene.store.fork()
        return twin.data(replace(layer, source=replace(layer.source, values=(name,))))

    def name_labels(self, layer_id: str, loaded: Loaded) -> Layer:
        """Show an image as labels, with the names and colours that :meth:`load_labels` read."""
        layer = self.scene.layer(layer_id)
        with self.scene.store.with_new(loaded):
            checked = layers.check(layer.kind, MEANING, "labels", loaded.data)
            settings = layers.changed(layer.kind, layer.settings, MEANING, checked, loaded.data)
            changed = replace(layer, source=loaded.source, settings=settings)
            self.scene.change(changed, f"names of labels of {layer.name}")
        return changed

    def set_slices(self, **changes: Any) -> SliceView:
        """Look at slices in another way; arguments and errors as of :func:`.check_view`."""
        # Only the angles of the oblique slice are part of the document, and can be undone.
        view = self.scene.slicing.view
        known = view.as_json()
        if unknown := [name for name in changes if name not in known]:
            raise ValueError(f"slices have no {shown(unknown[0])}; they have {', '.join(known)}")
        wanted = check_view({**known, **changes})
        if "oblique" in changes:
            said = "turn the oblique slice" if wanted.oblique is not None else "hide the oblique slice"
            self.scene.become(replace(self.scene.state, oblique=wanted.oblique), said, ("oblique",))
        self.scene.slicing.view = wanted
        if wanted.layout != view.layout:
            self.scene.cameras.refit()
        return self.scene.slicing.view

    def keep_window(self, shown: Any) -> None:
        """Store the window that a drag in a pane has given an image."""
        layer = next((one for one in self.scene.layers if self.scene.actor(one.id) is shown), None)
        if layer is not None:
            self.scene.set(layer.id, "clim", list(shown.clim))

    def turn_oblique(self, angles: tuple[float, float], drag: int | None = None) -> None:
        """Store the angles that the oblique slice was turned to by hand; turns of one drag are one step to undo."""
        key = ("oblique",) if drag is None else ("oblique", f"drag {drag}")
        state = replace(self.scene.state, oblique=angles)
        self.scene.become(state, "turn the oblique slice", key, whole=drag is not None)
