"""Programs of task and mesh stages, by GL_EXT_mesh_shader, which moderngl cannot make, or by GL_NV_mesh_shader.

A :class:`MeshProgram` has what the engine uses of a ``moderngl.Program``, so that those who set uniforms need not know
which of the two they have.
"""

from __future__ import annotations

import ctypes
from collections.abc import Iterable, Mapping
from typing import Any

import moderngl

from ..errors import EngineError
from .moderngl_extras import GLExtras, Uniform

_STAGES = {"fragment_shader": 0x8B30, "mesh_shader": 0x9559, "task_shader": 0x955A}
_COMPILE_STATUS, _LINK_STATUS, _LOG_LENGTH = 0x8B81, 0x8B82, 0x8B84
_ACTIVE_UNIFORMS, _INVALID_INDEX = 0x8B86, 0xFFFFFFFF
_STRICT = {"flat perprimitive": "perprimitive", "#extension GL_NV_mesh_shader : enable\n": "\n"}
"""How a fragment stage declares a primitive's data for Khronos' compiler, and the form that drivers take: Mesa's wants
no ``flat`` there, and OpenGL programs on NVIDIA's cards have neither that nor the extension's name."""
_LONGEST = 256  # characters of a uniform's name, the closing zero included

# Of a uniform's type: components, and the letters of the function that sets it. Others are samplers, of one int.
_KINDS = {
    0x1406: (1, "f"), 0x8B50: (2, "f"), 0x8B51: (3, "f"), 0x8B52: (4, "f"),
    0x1404: (1, "i"), 0x8B53: (2, "i"), 0x8B54: (3, "i"), 0x8B55: (4, "i"),
    0x1405: (1, "ui"), 0x8DC6: (2, "ui"), 0x8DC7: (3, "ui"), 0x8DC8: (4, "ui"),
    0x8B56: (1, "i"), 0x8B57: (2, "i"), 0x8B58: (3, "i"), 0x8B59: (4, "i"),
}  # fmt: skip
_WORDS = {"f": ctypes.c_float, "i": ctypes.c_int, "ui": ctypes.c_uint}


class MeshProgram:
    """A linked program of a task, a mesh and a fragment stage, whose sources have moderngl's names.

    ``nvidia`` sources are of GL_NV_mesh_shader. ``blocks`` are bindings of uniform blocks; missing ones are skipped.
    """

    def __init__(
        self, ctx: moderngl.Context, sources: Mapping[str, str], blocks: Mapping[str, int], *, nvidia: bool = False
    ) -> None:
        self._gl = GLExtras(ctx)
        self._nvidia = nvidia
        self.extra: Any = None  # whatever its users keep about it, as programs of moderngl have it
        self.glo = 0
        self._link_either(sources)
        self._array = ctypes.c_uint(0)
        self._call("glGenVertexArrays", 1, ctypes.byref(self._array))
        self._uniforms = self._active()
        for block, binding in blocks.items():
            index = self._call("glGetUniformBlockIndex", self.glo, block.encode())
            if index != _INVALID_INDEX:
                self._call("glUniformBlockBinding", self.glo, index, binding)

    def _call(self, name: str, *arguments: Any) -> Any:
        return self._gl.function(name)(*arguments)

    def _link_either(self, sources: Mapping[str, str]) -> None:
        """Link the stages as they are; if that fails, with the fragment stage in the form that drivers take."""
        try:
            self._link(sources)
        except moderngl.Error:
            fragment = sources["fragment_shader"]
            for strict, lax in _STRICT.items():
                fragment = fragment.replace(strict, lax)
            if fragment == sources["fragment_shader"]:
                raise
            self._link({**sources, "fragment_shader": fragment})

    def _link(self, sources: Mapping[str, str]) -> None:
        self.glo, shaders = self._call("glCreateProgram"), []
        try:
            for name, source in sources.items():
                shaders.append(self._compiled(name, source))
                self._call("glAttachShader", self.glo, shaders[-1])
            self._call("glLinkProgram", self.glo)
            self._check("Program", self.glo, _LINK_STATUS, "the program")
        except moderngl.Error:
            self.release()
            raise
        finally:
            for shader in shaders:
                self._call("glDeleteShader", shader)

    def _compiled(self, name: str, source: str) -> int:
        shader: int = self._call("glCreateShader", _STAGES[name])
        text = source.encode()
        held, length = ctypes.c_char_p(text), ctypes.c_int(len(text))
        self._call("glShaderSource", shader, 1, ctypes.byref(held), ctypes.byref(length))
        self._call("glCompileShader", shader)
        try:
            self._check("Shader", shader, _COMPILE_STATUS, name)
        except moderngl.Error:
            self._call("glDeleteShader", shader)
            raise
        return shader

    def _integer(self, of: str, thing: int, what: int) -> int:
        value = ctypes.c_int(0)
        self._call(f"glGet{of}iv", thing, what, ctypes.byref(value))
        return value.value

    def _check(self, of: str, thing: int, status: int, name: str) -> None:
        if self._integer(of, thing, status):
            return
        size = max(self._integer(of, thing, _LOG_LENGTH), 1)
        said = ctypes.create_string_buffer(size)
        self._call(f"glGet{of}InfoLog", thing, size, None, said)
        raise moderngl.Error(f"{name}: {said.value.decode(errors='replace').strip()}")

    def _active(self) -> dict[str, Uniform]:
        """Every uniform outside of blocks."""
        found = {}
        name = ctypes.create_string_buffer(_LONGEST)
        size, kind = ctypes.c_int(0), ctypes.c_uint(0)
        for i in range(self._integer("Program", self.glo, _ACTIVE_UNIFORMS)):
            self._call(
                "glGetActiveUniform", self.glo, i, _LONGEST, None, ctypes.byref(size), ctypes.byref(kind), name
            )
            location = self._call("glGetUniformLocation", self.glo, name.value)
            if location >= 0:
                found[name.value.decode().removesuffix("[0]")] = Uniform(location, kind.value)
        return found

    def __contains__(self, name: str) -> bool:
        return name in self._uniforms

    def __setitem__(self, name: str, value: Any) -> None:
        """Set a uniform: a number, or numbers, one after the other where it is an array."""
        if name not in self._uniforms:
            raise KeyError(name)
        location, kind = self._uniforms[name]
        size, letters = _KINDS.get(kind, (1, "i"))
        word: Any = _WORDS[letters]
        numbers = [(float if letters == "f" else int)(number) for number in _flat(value)]
        if not numbers or len(numbers) % size:
            raise EngineError(f"{name} takes numbers by {size}, not {len(numbers)}")
        data = (word * len(numbers))(*numbers)
        self._call(f"glProgramUniform{size}{letters}v", self.glo, location, len(numbers) // size, data)

    def get(self, name: str, default: Any) -> Any:
        """Return where a uniform is, or `default` if there is none outside of blocks."""
        return self._uniforms.get(name, default)

    def draw_mesh_tasks(self, count: int) -> None:
        """Run `count` task work groups."""
        self._call("glUseProgram", self.glo)
        self._call("glBindVertexArray", self._array)  # of nothing: OpenGL's core profile draws with none
        if self._nvidia:
            self._call("glDrawMeshTasksNV", 0, count)
        else:
            self._call("glDrawMeshTasksEXT", count, 1, 1)

    def release(self) -> None:
        """Delete it; twice is harmless."""
        if self.glo:
            self._call("glDeleteProgram", self.glo)
            self.glo = 0
            if getattr(self, "_array", None):
                self._call("glDeleteVertexArrays", 1, ctypes.byref(self._array))


def _flat(value: Any) -> Iterable[Any]:
    if hasattr(value, "__len__"):
        for part in value:
            yield from _flat(part)
    else:
        yield value
