"""Outlines of chosen streamlines: ``shaders/effects/selection_mask.frag`` and ``outline.frag``."""

from __future__ import annotations

from typing import Any

import moderngl
import numpy as np
import numpy.typing as npt

from .screen import ScreenEffect

ROW = 4096  # streamlines in a row of the texture: below every driver's limit


class OutlinePass(ScreenEffect):
    """Pixels of the outline of chosen streamlines."""

    def __init__(self, ctx: moderngl.Context) -> None:
        super().__init__(ctx, {})
        self._chosen: moderngl.Texture | None = None
        self._source: object = None

    def draw(self, buffer: Any, chosen: npt.NDArray[np.bool_], *, width: float) -> moderngl.Texture:
        """Bring the texture up to date."""
        size = buffer.depth.size
        texture = self._target("outline", size, "u4")
        marked = self._target("chosen pixels", size, "u4")
        mask = self._mask(chosen)

        def passes() -> None:
            sources = {"keys": buffer.depth, "ids": buffer.ids, "chosen": mask}
            self._pass("selection_mask", "chosen pixels", sources, {})
            self._pass("outline", "outline", {"marked": marked}, {"width": width})

        self._once((buffer, buffer.generation, id(chosen), width), passes)
        return texture

    def _mask(self, chosen: npt.NDArray[np.bool_]) -> moderngl.Texture:
        """Return the choice as a texture, made when another array is given."""
        if self._chosen is not None and self._source is chosen:
            return self._chosen
        if self._chosen is not None:
            self._chosen.release()
        width = max(1, min(len(chosen), ROW))
        texels = np.zeros((max(1, -(-len(chosen) // width)), width), np.uint8)
        texels.ravel()[: len(chosen)] = chosen
        self._chosen = self._ctx.texture((width, len(texels)), 1, texels.tobytes(), alignment=1, dtype="u1")
        self._chosen.filter = moderngl.NEAREST, moderngl.NEAREST
        self._source = chosen
        self._made_of = None
        return self._chosen

    def _textures(self) -> dict[str, moderngl.Texture]:
        textures = super()._textures()
        return textures if self._chosen is None else textures | {"chosen streamlines": self._chosen}

    def release(self) -> None:
        """Give everything on the GPU back; twice is harmless."""
        super().release()
        if self._chosen is not None:
            self._chosen.release()
        self._chosen = self._source = None
