"""An effect that singles streamlines out: a colour for them, and less of it for all others."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import moderngl
import numpy as np
import numpy.typing as npt

from pvfiblets.mappers.effects.shader_effects import ShaderEffect
from pvfiblets.mappers.frames.windows import MAX_ROW


class _Bits:
    """The texture of one window."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._source: Any = None
        self.texture: Any = None

    def update(self, selected: npt.NDArray[np.bool_]) -> Any:
        """Return the texture of a mask; the same object means the same mask."""
        if self._source is selected:
            return self.texture
        words = -(-len(selected) // 32)
        width = max(1, min(words, MAX_ROW))
        height = max(1, -(-words // width))
        data = np.zeros(width * height * 4, np.uint8)
        packed = np.packbits(selected, bitorder="little")
        data[: len(packed)] = packed
        if self.texture is not None and self.texture.size == (width, height):
            self.texture.write(data.view("<u4").astype("=u4").tobytes())
        else:
            self.release()
            self.texture = self._ctx.texture((width, height), 1, data.view("<u4").astype("=u4").tobytes(), dtype="u4")
            self.texture.filter = moderngl.NEAREST, moderngl.NEAREST
        self._source = selected
        return self.texture

    def explain(self) -> dict[str, list[dict[str, Any]]]:
        """Return ``passes`` (none) and ``buffers``, name and bytes."""
        size = 0 if self.texture is None else 4 * self.texture.width * self.texture.height
        return {"passes": [], "buffers": [{"name": "fibletChosenMap", "bytes": size}]}

    def release(self) -> None:
        """Give the texture back; twice is harmless."""
        if self.texture is not None:
            self.texture.release()
            self.texture = self._source = None


@dataclass(frozen=True, eq=False)
class Highlight(ShaderEffect):
    """Selected streamlines in a colour of their own, all others faded.

    It costs a bit per streamline, 1 MB for 8 million, which is all that another selection writes.
    """

    selected: npt.NDArray[np.bool_]  # `(n_streamlines,)` bool; not to be changed afterwards
    color: tuple[float, ...] | None = None  # RGB of those selected; their own colours by default
    dim: float = 0.8  # how much of the others' colour gives way, 0 to 1
    faded: tuple[float, ...] | None = None  # RGB towards which the others fade; the renderer's background by default
    features = frozenset({"highlight"})

    def __post_init__(self) -> None:
        if self.selected.ndim != 1 or self.selected.dtype != np.bool_:
            found = f"{self.selected.dtype} of shape {self.selected.shape}"
            raise ValueError(f"selected is {found}; give one bool for each streamline")
        if not 0.0 <= self.dim <= 1.0:
            raise ValueError(f"dim is {self.dim}; give a number from 0 to 1")

    def make(self, ctx: moderngl.Context) -> _Bits:
        """Make room for a window's texture."""
        return _Bits(ctx)

    def prepare(self, kept: _Bits, draw: Any) -> Mapping[str, Any]:  # noqa: ARG002  as all effects
        """Return the bits."""
        return {"fibletChosenMap": kept.update(self.selected)}

    def set_uniforms(self, kept: _Bits, program: Any, draw: Any) -> None:  # noqa: ARG002  as all effects
        """Set the two colours and how much of each."""
        color = (0.0, 0.0, 0.0, 0.0) if self.color is None else (*self.color[:3], 1.0)
        faded = draw.renderer.GetBackground() if self.faded is None else self.faded[:3]
        program.SetUniform4f("fibletChosenColour", color)
        program.SetUniform4f("fibletFaded", (*faded, self.dim))
