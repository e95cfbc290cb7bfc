"""Depth of what VTK has drawn before the fiblets, which hides some of them.

VTK draws opaque actors in the order in which they were added, so a mesh that was added before the fiblets is there and
one that was added later is not; translucent actors are drawn after all of them. The depth belongs to one moment:
a picture that was culled by it must not be used again for the next frame, in which the other actors may have moved.
"""

from __future__ import annotations

import ctypes
from typing import Any

import moderngl
from vtkmodules.vtkRenderingCore import vtkMapper, vtkRenderer

from pvfiblets.engine.gl.moderngl_extras import GLExtras
from pvfiblets.engine.gl.shaders import read_shader

_DRAW_FRAMEBUFFER, _DEPTH_ATTACHMENT = 0x8CA9, 0x8D00
_OBJECT_TYPE, _OBJECT_NAME, _TEXTURE_LEVEL = 0x8CD0, 0x8CD1, 0x8CD2
_TEXTURE, _TEXTURE_0, _TEXTURE_2D, _TEXTURE_2D_MULTISAMPLE = 0x1702, 0x84C0, 0x0DE1, 0x9100

_COVER = """#version 330
void main() { gl_Position = vec4(gl_VertexID % 2 * 4 - 1, gl_VertexID / 2 * 4 - 1, 0.0, 1.0); }
"""


class OutsideDepth:
    """Copies the depth of VTK's framebuffer into a texture of keys."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx  # of the window
        self._gl = GLExtras(ctx)
        self._programs: dict[int, tuple[Any, Any]] = {}
        self._target: moderngl.Framebuffer | None = None
        self._texture: moderngl.Texture | None = None

    def copy(self, viewport: tuple[int, int, int, int], *, moved: bool = False) -> moderngl.Texture | None:
        """Copy the depth of the framebuffer that is bound for drawing."""
        if (vtkMapper.GetResolveCoincidentTopology() and not moved) or not self._is_texture():
            return None
        return self._copy(self._attachment(_OBJECT_NAME), self._gl.get_integer("GL_SAMPLES"), viewport)

    def copy_of_window(self, renderer: vtkRenderer, size: tuple[int, int]) -> moderngl.Texture | None:
        """Copy the depth of a renderer's part of its window's own framebuffer, whichever is bound."""
        # Depth peeling draws translucent actors into other framebuffers, when all opaque ones are in that one.
        window: Any = renderer.GetRenderWindow()  # an OpenGL one
        framebuffer = window.GetRenderFramebuffer()
        depth = None if framebuffer is None else framebuffer.GetDepthAttachmentAsTextureObject()
        if depth is None or renderer.GetPass() is not None or tuple(renderer.GetSize()) != tuple(size):
            return None
        return self._copy(depth.GetHandle(), depth.GetSamples(), (*renderer.GetOrigin(), *size))

    def _copy(self, name: int, samples: int, viewport: tuple[int, int, int, int]) -> moderngl.Texture | None:
        """Copy a part of a texture."""
        with self._gl.framebuffers_kept():
            target = self._resize(viewport[2:])
            program, array = self._program(samples)
            unit = self._ctx.default_texture_unit
            kind = _TEXTURE_2D_MULTISAMPLE if samples else _TEXTURE_2D
            self._gl.function("glActiveTexture")(_TEXTURE_0 + unit)
            self._gl.function("glBindTexture")(kind, name)
            program["source"] = unit
            program["origin"] = viewport[:2]
            self._ctx.enable_only(moderngl.NOTHING)
            target.use()
            array.render(moderngl.TRIANGLES, 3)
            self._gl.function("glBindTexture")(kind, 0)
        return self._texture

    def _is_texture(self) -> bool:
        """Whether there is a depth attachment to be sampled: the window's own framebuffer, 0, has none."""
        if self._gl.get_integer("GL_DRAW_FRAMEBUFFER_BINDING") == 0:
            return False
        return self._attachment(_OBJECT_TYPE) == _TEXTURE and self._attachment(_TEXTURE_LEVEL) == 0

    def _attachment(self, what: int) -> int:
        value = ctypes.c_int(0)
        self._gl.function("glGetFramebufferAttachmentParameteriv")(
            _DRAW_FRAMEBUFFER, _DEPTH_ATTACHMENT, what, ctypes.byref(value)
        )
        return value.value

    def _program(self, samples: int) -> tuple[Any, Any]:
        if samples not in self._programs:
            source = read_shader("frame/scene_depth.frag").replace(
                "#version 330\n", f"#version 330\n#define SAMPLES {samples}\n", 1
            )
            program = self._ctx.program(vertex_shader=_COVER, fragment_shader=source)
            self._programs[samples] = program, self._ctx.vertex_array(program, [])
        return self._programs[samples]

    def _resize(self, size: tuple[int, int]) -> moderngl.Framebuffer:
        if self._target is None or self._target.size != size:
            self._drop_target()
            self._texture = self._ctx.texture(size, 1, dtype="u4")
            self._texture.filter = moderngl.NEAREST, moderngl.NEAREST
            self._target = self._ctx.framebuffer([self._texture])
        return self._target

    def _drop_target(self) -> None:
        for thing in (self._target, self._texture):
            if thing is not None:
                thing.release()
        self._target = self._texture = None

    def release(self) -> None:
        """Give everything on the GPU back; twice is harmless."""
        self._drop_target()
        for things in self._programs.values():
            for thing in things[::-1]:
                thing.release()
        self._programs.clear()
