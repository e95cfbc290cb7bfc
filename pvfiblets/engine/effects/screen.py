"""The base of all effects: textures of the picture's size, and passes that fill them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import moderngl

from ..errors import EngineError
from ..gl.bindings import FIRST_UNIT
from ..gl.moderngl_extras import GLExtras
from ..gl.queries import Timers
from ..gl.shaders import Programs


class ScreenEffect:
    """Base of the effects: keeps programs and textures, and what the last picture was made of."""

    def __init__(self, ctx: moderngl.Context, constants: Mapping[str, object]) -> None:
        self._ctx = ctx
        self._gl = GLExtras(ctx)
        self._programs = Programs(ctx, constants)
        self._timers = Timers(self._gl)
        self._targets: dict[str, tuple[moderngl.Texture, moderngl.Framebuffer]] = {}
        self._made_of: tuple[object, ...] | None = None
        self._features: frozenset[str] = frozenset()

    def _once(self, made_of: tuple[object, ...], draw: Callable[[], None]) -> None:
        """Draw, unless the last picture was made of the same."""
        if made_of == self._made_of:
            return
        self._made_of = None  # until it has come out well
        with self._gl.framebuffers_kept():  # one of ours must not stay bound when it is released
            self._ctx.scissor = None
            self._ctx.enable_only(moderngl.NOTHING)
            with self._programs.noting() as features:
                draw()
        self._features = frozenset(features)
        self._made_of = made_of

    def _target(self, name: str, size: tuple[int, int], dtype: str) -> moderngl.Texture:
        """Return a texture of one component, made anew for another size."""
        old = self._targets.get(name)
        if old is not None and old[0].size == size:
            return old[0]
        if old is not None:
            self._drop(name)
        try:
            texture = self._ctx.texture(size, 1, dtype=dtype)
        except moderngl.Error as error:
            raise EngineError(f"no memory for an effect on a picture of {size[0]} x {size[1]} pixels") from error
        texture.filter = moderngl.NEAREST, moderngl.NEAREST  # integer textures are incomplete otherwise
        self._targets[name] = texture, self._ctx.framebuffer([texture])
        return texture

    def _pass(
        self,
        name: str,
        target: str,
        textures: Mapping[str, Any],
        uniforms: Mapping[str, Any],
        features: Sequence[str] = (),
    ) -> None:
        """Run the fragment stage of ``shaders/effects`` on every pixel of a target."""
        program, array = self._programs.screen(f"effects/{name}.frag", features)
        for unit, (sampler, texture) in enumerate(textures.items(), start=FIRST_UNIT):
            texture.use(unit)
            program[sampler] = unit
        for uniform, value in uniforms.items():
            if uniform in program:
                program[uniform] = value
        with self._timers.timed(name):
            self._targets[target][1].use()
            array.render(moderngl.TRIANGLES, vertices=3)

    def explain(self) -> dict[str, list[Any]]:
        """Return its parts."""
        sizes = {"f1": 1, "u1": 1, "f2": 2, "f4": 4, "u4": 4}
        buffers: list[dict[str, object]] = [
            {"name": f"{name} (effect)", "bytes": texture.width * texture.height * sizes[texture.dtype]}
            for name, texture in self._textures().items()
        ]
        passes: list[dict[str, object]] = [
            {"name": f"{name} (effect)", "ms": self._timers.ms(name)} for name in self._timers.names
        ]
        return {"passes": passes, "features": sorted(self._features), "buffers": buffers}

    def _textures(self) -> dict[str, moderngl.Texture]:
        return {name: texture for name, (texture, _) in self._targets.items()}

    def _drop(self, name: str) -> None:
        for thing in self._targets.pop(name)[::-1]:
            thing.release()

    def release(self) -> None:
        """Give everything on the GPU back; twice is harmless."""
        for name in list(self._targets):
            self._drop(name)
        self._programs.release()
        self._timers.release()
        self._made_of = None
