"""An effect of the resolve that is one number: a piece of ``shaders/resolve`` with one ``uniform float``."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

if TYPE_CHECKING:
    import moderngl

    from pvfiblets.mappers.effects.shader_effects import Draw


@dataclass(frozen=True)
class UniformEffect:
    """A `pvfiblets.mappers.effects.shader_effects.MapperEffect` that sets one number of one piece."""

    piece: str  # name of the file in `shaders/resolve`
    uniform: str  # name of the number there
    value: float  # the number
    style: ClassVar[Mapping[str, Any]] = {}

    @property
    def features(self) -> frozenset[str]:
        """The piece."""
        return frozenset({self.piece})

    def make(self, ctx: moderngl.Context) -> None:  # noqa: ARG002 - as of all effects
        """Keep nothing on the GPU."""
        return

    def prepare(self, kept: Any, draw: Draw) -> Mapping[str, Any]:  # noqa: ARG002 - as of all effects
        """Return no textures."""
        return {}

    def set_uniforms(self, kept: Any, program: Any, draw: Draw) -> None:  # noqa: ARG002 - as of all effects
        """Set the number."""
        program.SetUniformf(self.uniform, self.value)
