"""Pictures of float32 on top of each other that are drawn one by one and read by layer."""

from __future__ import annotations

from collections.abc import Sequence

import moderngl

from .errors import EngineError
from .opengl import OpenGL

__all__ = ["LayerStack"]


class LayerStack:
    """Texture arrays of one size, and for every layer a framebuffer with that layer of each.

    Parameters
    ----------
    ctx : moderngl.Context
    gl : OpenGL
    size : tuple of int
        Pixels.
    layers : int
    components : sequence of int
        Of each array, 1, 2 or 4.

    Raises
    ------
    EngineError
        If there are more layers than this OpenGL's arrays have, or memory does not suffice.

    Attributes
    ----------
    textures : list of moderngl.TextureArray
        Undefined until drawn. Nearest neighbours, not mixtures, are read.
    framebuffers : list of moderngl.Framebuffer
    """

    def __init__(
        self, ctx: moderngl.Context, gl: OpenGL, size: tuple[int, int], layers: int, components: Sequence[int]
    ) -> None:
        self.size = size
        self.layers = layers
        self.textures: list[moderngl.TextureArray] = []
        self.framebuffers: list[moderngl.Framebuffer] = []
        self._components = tuple(components)
        limit = int(ctx.info["GL_MAX_ARRAY_TEXTURE_LAYERS"])
        if layers > limit:
            raise EngineError(
                f"cutting by this region takes {layers} layers along a pixel's ray, of which this OpenGL has {limit}; "
                "cut by fewer or simpler shapes"
            )
        stand_ins = []  # moderngl attaches no layers; these give it the number of attachments
        try:
            for count in components:
                texture = ctx.texture_array((*size, layers), count, dtype="f4")
                texture.filter = moderngl.NEAREST, moderngl.NEAREST
                self.textures.append(texture)
                stand_ins.append(ctx.texture((1, 1), count, dtype="f4"))
            for layer in range(layers):
                framebuffer = ctx.framebuffer(stand_ins)
                self.framebuffers.append(framebuffer)
                for attachment, texture in enumerate(self.textures):
                    gl.attach_layer(framebuffer, texture, layer, attachment)
        except moderngl.Error as error:
            self.release()
            raise EngineError(f"no memory for {self.nbytes} bytes of layers to cut by: {error}") from error
        finally:
            for texture in stand_ins:
                texture.release()

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
