"""Colours by value as textures: those of a place, and those of a step between two values."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import moderngl
import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from ...raycast.casting import Casting

__all__ = ["Tables"]

SIZE = 1024
"""Entries of colours by value: opacities are linear between those of the user, extinctions are not."""

_UNITS = {"colours": 12, "segments": 13}


class Tables:
    """The tables of one volume (``shaders/raycast/light.glsl``).

    Parameters
    ----------
    ctx : moderngl.Context
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._made_for: object = None
        self._textures: dict[str, moderngl.Texture] = {}

    def make(self, casting: Casting, step: float) -> None:
        """Bring them up to date for steps of some mm."""
        transfer = casting.transfer if casting.mode == "composite" else None
        beforehand = step if casting.integrator == "preintegrated" else None
        if self._made_for == (transfer, beforehand):
            return
        self.release()
        if transfer is not None:
            values = np.linspace(*transfer.clim, max(SIZE, len(transfer.table)))
            medium = np.concatenate([transfer.colour(values), transfer.extinction(values)[:, None]], axis=1)
            self._textures["colours"] = self._texture(medium[None])
            if beforehand is not None:
                self._textures["segments"] = self._texture(transfer.preintegrated(beforehand).transpose(1, 0, 2))
        self._made_for = transfer, beforehand

    def _texture(self, rows: npt.NDArray[Any]) -> moderngl.Texture:
        height, width = rows.shape[:2]
        texture = self._ctx.texture((width, height), 4, np.ascontiguousarray(rows, "<f4"), dtype="f4")
        texture.filter = moderngl.LINEAR, moderngl.LINEAR
        texture.repeat_x = texture.repeat_y = False
        return texture

    def bind(self, program: moderngl.Program) -> None:
        """Bind all, and tell a program where they are."""
        for name, texture in self._textures.items():
            if name in program:
                texture.use(_UNITS[name])
                program[name] = _UNITS[name]

    @property
    def sizes(self) -> dict[str, int]:
        """Bytes by name."""
        return {name: 16 * texture.width * texture.height for name, texture in self._textures.items()}

    def release(self) -> None:
        """Give everything back; twice is harmless."""
        for texture in self._textures.values():
            texture.release()
        self._textures.clear()
        self._made_for = None
