"""What PyVista's scripts set of an actor's mapper and ours keep in their actors: taken over, or told where it is.

A mapper of VTK's takes any attribute that Python gives it, and nobody would read it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from pvfiblets.plotting.settings import NoSetting
from pvfiblets.plotting.volumes.blending import BLENDING, mode_of_blending

__all__ = ["LinesWords", "VolumeWords"]

_NONE = "this mapper has no {name}: "


class _Words:
    """Words of all mappers."""

    _shown_by: Callable[[], Any]

    copy = NoSetting(_NONE + "actor.copy() makes an actor with a mapper of its own")
    interpolate_before_map = NoSetting(_NONE + "values are interpolated before they are mapped, always")
    emissive = NoSetting(_NONE + "it is of points drawn as gaussians")


class LinesWords(_Words):
    """Words of mappers of lines and points."""

    as_rgba = NoSetting(_NONE + "give colours of points or lines as actor.scalars")
    clear_active_scalars = NoSetting(_NONE + "set actor.scalars = None")
    cmap = NoSetting(_NONE + "set actor.cmap")
    scalar_map_mode = NoSetting(_NONE + "actor.scalars may be of points or of lines")
    set_active_scalars = NoSetting(_NONE + "set actor.scalars to the name")
    set_custom_opacity = NoSetting(_NONE + "set actor.opacity_by")
    set_scalars = NoSetting(_NONE + "set actor.scalars, and actor.cmap, clim and n_colors")

    @property
    def array_name(self) -> str:
        """Name of what colours; empty without scalars. Set it to colour by another array of what is drawn."""
        found = self._shown_by()._scalars  # noqa: SLF001
        return "" if found is None else str(found.name)

    @array_name.setter
    def array_name(self, name: str) -> None:
        self._shown_by().scalars = name


class VolumeWords(_Words):
    """Words of mappers of volumes."""

    dataset = NoSetting(_NONE + "actor.volume holds values and place; actor.update(image) draws others")
    scalar_map_mode = NoSetting(_NONE + "as_raycast_volume(image, scalars=...) chooses the array")

    @property
    def blend_mode(self) -> str:
        """The actor's mode by ``add_volume``'s words, or its own where these have none."""
        mode = self._shown_by().mode
        return next((theirs for theirs, ours in BLENDING.items() if ours == mode), mode)

    @blend_mode.setter
    def blend_mode(self, word: str) -> None:
        self._shown_by().mode = mode_of_blending(word)
