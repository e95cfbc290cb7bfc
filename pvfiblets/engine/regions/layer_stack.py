"""Pictures of float32 on top of each other, drawn one by one and read by layer, and what the CPU asks of them."""

from __future__ import annotations

from collections.abc import Sequence

import moderngl
import numpy as np
import numpy.typing as npt

from ..errors import EngineError
from ..gl.delayed_read import DelayedRead
from ..gl.moderngl_extras import GLExtras
from ..gl.shaders import Programs

Array = npt.NDArray[np.float32]
Rectangle = tuple[int, int, int, int]  # pixels: left, lower, right, upper

SQUARE = 4  # pixels of a side of the squares that a program of `Squares` reduces; the programs state it too


class LayerStack:
    """Texture arrays of one size, and framebuffers for their layers."""

    def __init__(
        self,
        ctx: moderngl.Context,
        gl: GLExtras,
        size: tuple[int, int],  # pixels
        layers: int,
        components: Sequence[int],  # of each array, 1, 2 or 4
        # how many layers of each array a framebuffer has, one array after the other; `layers` is a multiple of it
        together: int = 1,
    ) -> None:
        self.size = size
        self.layers = layers
        self.together = together
        # undefined until drawn. Nearest neighbours, not mixtures, are read.
        self.textures: list[moderngl.TextureArray] = []
        self.framebuffers: list[moderngl.Framebuffer] = []
        self._components = tuple(components)
        limit = int(ctx.info["GL_MAX_ARRAY_TEXTURE_LAYERS"])
        if layers > limit:
            raise EngineError(
                f"cutting by this region needs {layers} layers along a pixel's ray, and this OpenGL has {limit}; "
                "cut by fewer or simpler shapes"
            )
        stand_ins: list[moderngl.Texture] = []  # moderngl attaches no layers; these give it the number of attachments
        try:
            for count in components:
                texture = ctx.texture_array((*size, layers), count, dtype="f4")
                texture.filter = moderngl.NEAREST, moderngl.NEAREST
                self.textures.append(texture)
                stand_ins += [ctx.texture((1, 1), count, dtype="f4") for _ in range(together)]
            for first in range(0, layers, together):
                framebuffer = ctx.framebuffer(stand_ins)
                self.framebuffers.append(framebuffer)
                for attachment in range(len(stand_ins)):
                    array, layer = divmod(attachment, together)
                    gl.attach_layer(framebuffer, self.textures[array], first + layer, attachment)
        except moderngl.Error as error:
            self.release()
            raise EngineError(f"no memory for {self.nbytes} bytes of layers to cut by: {error}") from error
        finally:
            for stand_in in stand_ins:
                stand_in.release()

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory."""
        return 4 * sum(self._components) * self.size[0] * self.size[1] * self.layers

    def release(self) -> None:
        """Give everything on the GPU back; twice is harmless."""
        for framebuffer in self.framebuffers:
            framebuffer.release()
        self.framebuffers.clear()
        for texture in self.textures:
            texture.release()
        self.textures.clear()


class Squares:
    """Reads back what a program says of each square of pixels, two numbers each."""

    def __init__(self, ctx: moderngl.Context, gl: GLExtras, programs: Programs) -> None:
        self._ctx = ctx
        self._gl = gl
        self._programs = programs
        self._stack: LayerStack | None = None

    def program(self, name: str, rectangle: Rectangle) -> moderngl.Program:
        """Return the program of a fragment stage, told its rectangle."""
        program, _ = self._programs.screen(name, ["PEEL"])
        program["rectangle"] = rectangle
        return program

    def ask(self, name: str, rectangle: Rectangle) -> Array:
        """Run a program on all squares of a rectangle, and wait for it."""
        framebuffer = self._run(name, rectangle)
        found: Array = np.frombuffer(framebuffer.read(framebuffer.viewport, 2, dtype="f4"), "<f4").reshape(-1, 2)
        return found

    def ask_later(self, name: str, rectangle: Rectangle, reads: DelayedRead, tag: object = None) -> None:
        """Run a program on all squares of a rectangle, and pass its results to some reads."""
        framebuffer = self._run(name, rectangle)
        reads.start(framebuffer, framebuffer.viewport, 2, tag)

    def _run(self, name: str, rectangle: Rectangle) -> moderngl.Framebuffer:
        _, array = self._programs.screen(name, ["PEEL"])
        width, height = (-(-(rectangle[k + 2] - rectangle[k]) // SQUARE) for k in (0, 1))
        held = self._stack
        if held is None or held.size[0] < width or held.size[1] < height:
            self.release()
            self._stack = held = LayerStack(self._ctx, self._gl, (width, height), 1, (2,))
        framebuffer = held.framebuffers[0]
        framebuffer.viewport = 0, 0, width, height
        framebuffer.use()
        self._ctx.enable_only(moderngl.NOTHING)
        array.render(moderngl.TRIANGLES, vertices=3)
        return framebuffer

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory."""
        return 0 if self._stack is None else self._stack.nbytes

    def release(self) -> None:
        """Give everything on the GPU back; twice is harmless."""
        if self._stack is not None:
            self._stack.release()
            self._stack = None
