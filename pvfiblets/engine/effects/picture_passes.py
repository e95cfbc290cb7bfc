"""Passes over every pixel of a picture of another renderer, in textures of that renderer's framebuffer."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import moderngl

from ..errors import EngineError
from ..gl.bindings import FIRST_UNIT
from ..gl.moderngl_extras import GLExtras
from ..gl.shaders import Programs

_BYTES = {"f1": 1, "f4": 4, "u4": 4}


@dataclass(frozen=True)
class Attachment:
    """A texture of somebody else's framebuffer."""

    name: int  # OpenGL's
    samples: int  # per pixel; 0 for a plain texture
    floats: bool = False  # whether its colours are floats, not bytes

    def features(self, *, alike: bool = False) -> list[str]:
        """Return features of shaders that read it; `alike`: all samples of a pixel are the same."""
        return ["PICTURE_SAMPLES", *(["PICTURE_ALIKE"] if alike else [])] if self.samples else []


class PicturePasses:
    """Programs, textures and framebuffers of passes over a picture.

    Nothing is made on the context until a picture is changed.
    """

    def __init__(self, ctx: moderngl.Context, constants: Mapping[str, object]) -> None:
        self._ctx = ctx
        self._gl = GLExtras(ctx)
        self._programs = Programs(ctx, constants)
        self._textures: dict[str, moderngl.Texture] = {}
        self._framebuffers: dict[tuple[str, ...], moderngl.Framebuffer] = {}
        self._lent: moderngl.Framebuffer | None = None

    def _plain_state(self) -> Any:
        """Return a scope that restores the bound framebuffers; inside, drawing is neither blended nor depth-tested."""
        self._ctx.scissor = None
        self._ctx.enable_only(moderngl.NOTHING)
        return self._gl.framebuffers_kept()

    def _outside(self, attachment: Attachment, components: int, size: tuple[int, int] = (1, 1)) -> moderngl.Texture:
        """Return somebody else's texture as one of moderngl's, which never deletes it."""
        dtype = "f4" if attachment.floats else "f1"
        return self._ctx.external_texture(attachment.name, size, components, attachment.samples, dtype)

    @contextmanager
    def _onto(self, attachment: Attachment, viewport: tuple[int, int, int, int]) -> Iterator[moderngl.Framebuffer]:
        """Lend what draws into a part of somebody else's texture, within :meth:`_plain_state`."""
        # The framebuffer is kept, its attachment is not: its owner may delete it, and its name may be used again.
        if self._lent is None:
            x, y, width, height = viewport
            self._lent = self._ctx.framebuffer([self._outside(attachment, 4, (x + width, y + height))])
        else:
            self._gl.attach_outside(self._lent, attachment.name, attachment.samples)
        try:
            self._lent.viewport = viewport
            yield self._lent
        finally:
            self._gl.attach_outside(self._lent, 0)

    def _texture(self, name: str, size: tuple[int, int], components: int, dtype: str) -> moderngl.Texture:
        """Return a texture, made anew for another size or kind."""
        old = self._textures.get(name)
        if old is not None and (old.size, old.dtype) == (size, dtype):
            return old
        if old is not None:
            self._drop(name)
        try:
            texture = self._ctx.texture(size, components, dtype=dtype)
        except moderngl.Error as error:
            raise EngineError(f"no memory for an effect on a picture of {size[0]} x {size[1]} pixels") from error
        texture.filter = moderngl.NEAREST, moderngl.NEAREST
        self._textures[name] = texture
        return texture

    def _drop(self, name: str) -> None:
        for names in [names for names in self._framebuffers if name in names]:
            self._framebuffers.pop(names).release()
        self._textures.pop(name).release()

    def _framebuffer(self, names: tuple[str, ...]) -> moderngl.Framebuffer:
        """Return what draws into textures."""
        if names not in self._framebuffers:
            with self._gl.framebuffers_kept():
                self._framebuffers[names] = self._ctx.framebuffer([self._textures[name] for name in names])
        return self._framebuffers[names]

    def _pass(
        self,
        name: str,
        target: moderngl.Framebuffer,
        textures: Mapping[str, Any],
        uniforms: Mapping[str, Any],
        features: Iterable[str] = (),
    ) -> None:
        """Run a fragment stage of ``shaders/effects/picture`` on every pixel of a target's viewport."""
        program, array = self._programs.screen(f"effects/picture/{name}.frag", features)
        self._use(program, target, textures, uniforms)
        array.render(moderngl.TRIANGLES, vertices=3)

    def _use(
        self,
        program: moderngl.Program,
        target: moderngl.Framebuffer,
        textures: Mapping[str, Any],
        uniforms: Mapping[str, Any],
    ) -> None:
        """Get a program ready to draw into a target."""
        for unit, (sampler, texture) in enumerate(textures.items(), start=FIRST_UNIT):
            if sampler in program:
                texture.use(unit)
                program[sampler] = unit
        for uniform, value in uniforms.items():
            if uniform in program:
                program[uniform] = value
        target.use()

    @property
    def nbytes(self) -> int:
        """Bytes of textures on the GPU."""
        return sum(texture.width * texture.height * bytes_of(texture) for texture in self._textures.values())

    def release(self) -> None:
        """Give everything on the GPU back; twice is harmless."""
        for name in list(self._textures):
            self._drop(name)
        if self._lent is not None:
            self._lent.release()
            self._lent = None
        self._programs.release()


def bytes_of(texture: moderngl.Texture) -> int:
    """Return bytes of a texel."""
    return texture.components * _BYTES[texture.dtype]
