"""Effects of mappers beside colours: pieces of the resolve that have textures and uniforms of their own.

An effect is a value: it names its pieces of ``shaders/resolve`` and its inputs from the engine. Its
GPU data are made once for each window and live in the window's slot. A mapper without effects draws as if this
module did not exist.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, ClassVar, Protocol, TypeVar

if TYPE_CHECKING:
    import moderngl

    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.engine.view import Style
    from pvfiblets.mappers.frames.scene import Frame
    from pvfiblets.mappers.frames.windows import Slot

AnyStyle = TypeVar("AnyStyle", bound="Style")


@dataclass(frozen=True, eq=False)
class Draw:
    """One draw of a mapper, as its effects see it."""

    ctx: moderngl.Context  # of the window; current
    engine: Any  # the engine's renderer
    buffer: Any  # its G-buffer, up to date
    frame: Frame  # viewport and matrices
    view: Any  # as given to the engine
    style: Any
    renderer: Any
    fiblets: FibletSet  # the drawn data
    actor: Any  # of the mapper
    colouring: Any = None  # where its colours come from
    textures: Mapping[str, Any] = field(default_factory=dict)  # of the colours, by the names of their samplers


class GpuResource(Protocol):
    """GPU memory of an effect in one window."""

    def release(self) -> None:
        """Give it back; twice is harmless."""
        ...


class MapperEffect(Protocol):
    """A piece of looks beside the colours. Instances do not change: set another one to change a setting."""

    @property
    def features(self) -> frozenset[str]:
        """Pieces of the resolve (`pvfiblets.mappers.effects.resolve.FEATURES`)."""
        ...

    @property
    def style(self) -> Mapping[str, Any]:
        """Fields of the engine's ``Style`` that it sets."""
        ...

    def make(self, ctx: moderngl.Context) -> GpuResource | None:
        """Make its GPU resources for a window; another effect of the same name and class reuses them."""
        ...

    def prepare(self, kept: Any, draw: Draw) -> Mapping[str, Any]:
        """Bring textures up to date and return them by the names of their samplers. OpenGL state is free to change."""
        # A name that is there already (`fibletDepthMap`) is replaced.
        ...

    def set_uniforms(self, kept: Any, program: Any, draw: Draw) -> None:
        """Set uniforms of the ``vtkShaderProgram``, which is bound."""
        ...


class ShaderEffect:
    """The base of most effects: nothing of their own on the GPU, and no requests to the engine."""

    @property
    def features(self) -> frozenset[str]:
        """No pieces of the resolve."""
        return frozenset()

    translucent: ClassVar[bool] = False
    """Whether VTK must draw the actor in its translucent pass, whatever its opacity is."""

    smooth_edges: ClassVar[bool] = True  # whether the edges of the nearest lines are edges of the picture

    @property
    def style(self) -> Mapping[str, Any]:
        """Nothing of the engine."""
        return {}

    @property
    def looks_at_pixel(self) -> bool:
        """Whether it needs only the G-buffer's pixel."""
        return type(self).prepare is ShaderEffect.prepare

    def make(self, ctx: moderngl.Context) -> Any:  # noqa: ARG002 - as of all effects
        """Keep nothing on the GPU."""
        return None

    def prepare(self, kept: Any, draw: Draw) -> Mapping[str, Any]:  # noqa: ARG002 - as of all effects
        """Return no textures."""
        return {}

    def set_uniforms(self, kept: Any, program: Any, draw: Draw) -> None:
        """Set no uniforms."""


def styled(style: AnyStyle, effects: Iterable[MapperEffect]) -> AnyStyle:
    """Return a style with what effects want of it."""
    for effect in effects:
        if effect.style:
            style = replace(style, **effect.style)
    return style


def prepare_effects(slot: Slot, effects: Mapping[str, MapperEffect], draw: Draw) -> dict[str, Any]:
    """Return the textures of all effects, and release what those kept that are gone."""
    for name in set(slot.effects) - set(effects):
        slot.drop_effect(name)
    textures: dict[str, Any] = {}
    for name, effect in effects.items():
        if name in slot.effects and slot.effects[name][0] is not type(effect):
            slot.drop_effect(name)
        if name not in slot.effects:
            slot.effects[name] = type(effect), effect.make(draw.ctx)
        textures |= effect.prepare(slot.effects[name][1], draw)
    return textures


def set_effect_uniforms(slot: Slot, effects: Mapping[str, MapperEffect], program: Any, draw: Draw) -> None:
    """Set the uniforms of all effects."""
    for name, effect in effects.items():
        effect.set_uniforms(slot.effects[name][1], program, draw)
