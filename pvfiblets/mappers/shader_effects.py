"""What a mapper can be given beside colours: pieces of the resolve that have textures and uniforms of their own.

An extra is a value: it says which pieces of ``shaders/resolve`` it takes and what it wants of the engine. What it keeps
on the GPU is made once for each window and lives in the window's slot. A mapper without extras draws as if this module
did not exist.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar, Protocol, TypeVar

if TYPE_CHECKING:
    from pvfiblets.engine.view import Style
    from pvfiblets.mappers.scene import Frame
    from pvfiblets.mappers.windows import Slot

__all__ = ["Draw", "Extra", "Kept", "Piece", "prepare_extras", "set_extra_uniforms", "styled"]

AnyStyle = TypeVar("AnyStyle", bound="Style")


@dataclass(frozen=True, eq=False)
class Draw:
    """One draw of a mapper, as its extras see it.

    Attributes
    ----------
    ctx : moderngl.Context
        Of the window; current.
    engine : Any
        The engine's renderer.
    buffer : Any
        Its G-buffer, up to date.
    frame : Frame
        Viewport and matrices.
    view, style : Any
        As given to the engine.
    renderer : vtkRenderer
    fiblets : FibletSet
        What is drawn.
    actor : vtkActor
        Of the mapper.
    """

    ctx: Any
    engine: Any
    buffer: Any
    frame: Frame
    view: Any
    style: Any
    renderer: Any
    fiblets: Any
    actor: Any


class Kept(Protocol):
    """What an extra keeps on the GPU of one window."""

    def release(self) -> None:
        """Give it back; twice is harmless."""
        ...


class Extra(Protocol):
    """A piece of looks beside the colours. Instances do not change: set another one to change a setting."""

    @property
    def features(self) -> frozenset[str]:
        """Pieces of the resolve (`pvfiblets.mappers.resolve.FEATURES`)."""
        ...

    @property
    def style(self) -> Mapping[str, Any]:
        """Fields of the engine's ``Style`` that it sets."""
        ...

    def make(self, ctx: Any) -> Kept | None:
        """Make what it keeps on the GPU of a window; another extra of the same name and class takes that over."""
        ...

    def prepare(self, kept: Any, draw: Draw) -> Mapping[str, Any]:
        """Bring textures up to date and return them by the names of their samplers. OpenGL state is free to change.

        A name that is there already (``fibletDepthMap``) is replaced.
        """
        ...

    def set_uniforms(self, kept: Any, program: Any, draw: Draw) -> None:
        """Set uniforms of the ``vtkShaderProgram``, which is bound."""
        ...


class Piece:
    """What most extras have in common: nothing of their own on the GPU, and no wishes to the engine."""

    features: ClassVar[frozenset[str]]

    @property
    def style(self) -> Mapping[str, Any]:
        """Nothing of the engine."""
        return {}

    def make(self, ctx: Any) -> Any:  # noqa: ARG002 - as of all extras
        """Keep nothing on the GPU."""
        return None

    def prepare(self, kept: Any, draw: Draw) -> Mapping[str, Any]:  # noqa: ARG002 - as of all extras
        """Have no textures."""
        return {}

    def set_uniforms(self, kept: Any, program: Any, draw: Draw) -> None:
        """Have no uniforms."""


def styled(style: AnyStyle, extras: Iterable[Extra]) -> AnyStyle:
    """Return a style with what extras want of it."""
    for extra in extras:
        if extra.style:
            style = replace(style, **extra.style)
    return style


def prepare_extras(slot: Slot, extras: Mapping[str, Extra], draw: Draw) -> dict[str, Any]:
    """Return the textures of all extras, and release what those kept that are gone."""
    for name in set(slot.extras) - set(extras):
        slot.drop_extra(name)
    textures: dict[str, Any] = {}
    for name, extra in extras.items():
        if name in slot.extras and slot.extras[name][0] is not type(extra):
            slot.drop_extra(name)
        if name not in slot.extras:
            slot.extras[name] = type(extra), extra.make(draw.ctx)
        textures |= extra.prepare(slot.extras[name][1], draw)
    return textures


def set_extra_uniforms(slot: Slot, extras: Mapping[str, Extra], program: Any, draw: Draw) -> None:
    """Set the uniforms of all extras."""
    for name, extra in extras.items():
        extra.set_uniforms(slot.extras[name][1], program, draw)
