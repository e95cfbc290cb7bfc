"""The tab Clip."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from pvfiblets.web.actions import Actions
from pvfiblets.web.panels.controls import AXES, axis_of, controls, moved, typed_value

EVERY = "*"  # among the layers of a cut: all that are lines


class CutActions(Actions):
    """The cuts of an application's scene."""

    def refresh(self) -> None:
        """Show the cuts there are."""
        bounds = self._app.plotter.bounds
        items = [{"title": "all tractograms", "value": EVERY}]
        items += [{"title": layer.name, "value": layer.id} for layer in self._app.scene.layers if layer.kind != "image"]
        self._app.page.clips = [
            {
                "id": clip.id,
                "name": clip.name,
                "kind": clip.shape["kind"],
                "inside": clip.inside,
                "enabled": clip.enabled,
                "side": _side(clip),
                "axes": clip.shape["kind"] in ("plane", "slab"),
                "axis": axis_of(clip.shape["normal"]) if "normal" in clip.shape else "",
                "controls": controls(clip.shape, bounds),
                "items": items,
                "layers": [EVERY] if clip.layers is None else list(clip.layers),
            }
            for clip in self._app.scene.state.clips
        ]

    def add(self, kind: str) -> None:
        """Add a cut in the middle of the scene."""
        self._app.scene.filters.add_clip(kind)

    def add_file(self, place: Mapping[str, Any]) -> None:
        """Add a cut by the mesh in a file (path, and maybe space), which is read beside everything else."""
        shape = {"kind": "mesh", **place}
        self._app.later(self._app.files.with_shape(shape, lambda: self._app.scene.filters.add_clip(**shape)))

    def enable(self, clip_id: str, enabled: bool) -> None:
        """Switch a cut on or off."""
        self._app.scene.filters.set_clip(clip_id, enabled=enabled)

    def turn(self, clip_id: str, inside: bool) -> None:
        """Show one side of a cut or the other."""
        self._app.scene.filters.set_clip(clip_id, inside=inside)

    def remove(self, clip_id: str) -> None:
        """Take a cut away."""
        self._app.scene.filters.remove_clip(clip_id)

    def set_layers(self, clip_id: str, chosen: Any) -> None:
        """Choose what a cut goes through: ids of layers, or `EVERY` for all tractograms, later ones too."""
        scene = self._app.scene
        clip = scene.state.clip(clip_id)
        if not isinstance(chosen, list):
            raise ValueError("expected a list of layers")
        if EVERY in chosen and clip.layers is not None:
            scene.filters.set_clip(clip_id, layers=None)
            return
        ids = [layer.id for layer in scene.layers if layer.id in chosen or (EVERY in chosen and clip.cuts(layer))]
        if EVERY in chosen and len(chosen) == 1:
            return
        scene.filters.set_clip(clip_id, layers=ids)

    def set_axis(self, clip_id: str, axis: str) -> None:
        """Turn a plane or a slab across an axis, or to face the camera."""
        if axis == "view":
            normal = [float(part) for part in self._app.plotter.camera.direction]
        elif axis in AXES:
            normal = list(AXES[axis])
        else:
            raise ValueError(f"there is no axis {axis!r}; choose x, y, z or view")
        old = self._app.scene.state.clip(clip_id).shape.get("normal")
        if old is not None and axis == axis_of(old) and np.dot(old, normal) > 0:
            return
        self._app.scene.filters.set_clip(clip_id, normal=normal)

    def set_value(self, clip_id: str, name: str, value: Any) -> None:
        """Move a cut's slider."""
        self._app.scene.filters.set_clip(clip_id, **moved(self._app.scene.state.clip(clip_id).shape, name, value))

    def set_end(self, clip_id: str, name: str, end: int, text: str) -> None:
        """Set a number of a cut, or one end of a range, to mm that were typed."""
        shape = self._app.scene.state.clip(clip_id).shape
        self.set_value(clip_id, name, typed_value(shape, self._app.plotter.bounds, name, end, text))


def _side(clip: Any) -> str:
    if clip.shape["kind"] == "plane":
        return "this side" if clip.inside else "other side"
    return "inside" if clip.inside else "outside"
