"""The tab Clip."""

from __future__ import annotations

from typing import Any

import numpy as np

from pvfiblets.web.actions import Actions
from pvfiblets.web.controls import AXES, axis_of, controls, moved


class CutActions(Actions):
    """The cuts of an application's scene."""

    def refresh(self) -> None:
        """Show the cuts there are."""
        bounds = self._app.plotter.bounds
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
            }
            for clip in self._app.scene.state.clips
        ]

    def add(self, kind: str, path: str | None = None) -> None:
        """Add a cut in the middle of what is shown, or by the mesh in a file."""
        if path is None:
            self._app.scene.add_clip(kind)
        else:
            self._app.scene.add_clip(kind, path=path)

    def enable(self, clip_id: str, enabled: bool) -> None:
        """Switch a cut on or off."""
        self._app.scene.set_clip(clip_id, enabled=enabled)

    def turn(self, clip_id: str, inside: bool) -> None:
        """Show one side of a cut or the other."""
        self._app.scene.set_clip(clip_id, inside=inside)

    def remove(self, clip_id: str) -> None:
        """Take a cut away."""
        self._app.scene.remove_clip(clip_id)

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
        self._app.scene.set_clip(clip_id, normal=normal)

    def set_value(self, clip_id: str, name: str, value: Any) -> None:
        """Move a cut's slider."""
        self._app.scene.set_clip(clip_id, **moved(self._app.scene.state.clip(clip_id).shape, name, value))


def _side(clip: Any) -> str:
    if clip.shape["kind"] == "plane":
        return "this side" if clip.inside else "other side"
    return "inside" if clip.inside else "outside"
