"""Layers of a picture on the GPU, for depth peeling (`pvfiblets.engine.fiblets.gather.depth_peeling`)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import moderngl

from ...errors import GPUMemoryError
from ...gbuffer import RELIEF, GBuffer
from ...gl.bindings import LAYER_COPY, PEELING

if TYPE_CHECKING:
    from ...gl.moderngl_extras import GLExtras
    from ...gl.shaders import Programs


class LayeredBuffer:
    """Layers of a picture: texture arrays with the content of the G-buffer's textures, layer 0 the nearest.

    A layer is empty where those before it left nothing.
    """

    def __init__(self, ctx: moderngl.Context, gl: GLExtras, target: GBuffer, count: int) -> None:
        self.size, self.count = target.size, count
        self.relief = target.relief
        self.nbytes = 0
        self._things: list[Any] = []
        self.across: moderngl.TextureArray | None = None  # if the G-buffer has it
        try:
            self.depth = self._array(ctx, 1, "u4")
            self.ids = self._array(ctx, 2, "u4")
            self.position = self._array(ctx, 2, "f4")
            if self.relief is not None:
                self.across = self._array(ctx, 1, RELIEF[self.relief])
            self._framebuffers = [self._framebuffer(ctx, gl, target, layer) for layer in range(count)]
        except moderngl.Error as error:
            self.release()
            width, height = self.size
            raise GPUMemoryError(f"no memory for {count} layers of {width} x {height} pixels: {error}") from error

    def _array(self, ctx: moderngl.Context, components: int, dtype: str) -> moderngl.TextureArray:
        array = ctx.texture_array((*self.size, self.count), components, dtype=dtype)
        array.filter = moderngl.NEAREST, moderngl.NEAREST
        self._things.append(array)
        self.nbytes += self.size[0] * self.size[1] * self.count * components * int(dtype[1])
        return array

    @property
    def arrays(self) -> dict[str, moderngl.TextureArray]:
        """All of them, by name."""
        across = {} if self.across is None else {"across": self.across}
        return {"depth": self.depth, "ids": self.ids, "position": self.position, **across}

    def _framebuffer(self, ctx: moderngl.Context, gl: GLExtras, target: GBuffer, layer: int) -> moderngl.Framebuffer:
        # moderngl attaches whole textures: the picture's textures hold the places.
        framebuffer = ctx.framebuffer([getattr(target, name) for name in self.arrays])
        self._things.append(framebuffer)
        for attachment, array in enumerate(self.arrays.values()):
            gl.attach_layer(framebuffer, array, layer, attachment)
        return framebuffer

    def keep(self, ctx: moderngl.Context, gl: GLExtras, programs: Programs, drawn: GBuffer, layer: int) -> None:
        """Copy a picture into a layer."""
        features = {None: [], "across": ["CROSS_LINE"], "normal": ["CROSS_LINE", "TUBES"]}[self.relief]
        program, array = programs.screen("fiblets/layers/copy.frag", features)
        for name in self.arrays:
            getattr(drawn, name).use(LAYER_COPY[name])
            program[f"drawn_{name}"] = LAYER_COPY[name]
        with gl.framebuffers_kept():
            ctx.enable_only(moderngl.NOTHING)
            self._framebuffers[layer].use()
            array.render(moderngl.TRIANGLES, vertices=3)

    def release(self) -> None:
        """Give the textures back; twice is harmless."""
        for thing in reversed(self._things):
            thing.release()
        self._things.clear()


@dataclass(frozen=True)
class Peel:
    """The layers in front of a picture."""

    layers: LayeredBuffer
    drawn: int  # how many of them there are so far

    def bind(self, program: Any) -> None:
        """Bind the layers, and tell a program how many count."""
        if "peeled_layers" in program:
            program["peeled_layers"] = self.drawn
            self.layers.depth.use(PEELING["peeled_depth"])
            self.layers.ids.use(PEELING["peeled_ids"])
            self.layers.position.use(PEELING["peeled_position"])
