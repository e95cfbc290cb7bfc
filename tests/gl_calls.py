"""Records which OpenGL functions a program calls, and which of them wait for the GPU.

KHR_debug tells of some waits on some drivers. Here nothing goes past: moderngl asks a loader for the address of each
function it will ever call, and so does the engine for the few that moderngl lacks. Both are given the address of a few
machine instructions that count the call and go on to the function, whatever its arguments. Functions that may wait go
through Python, which looks at their arguments.
"""

from __future__ import annotations

import ctypes
import mmap
import platform
import struct
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, Self
from unittest.mock import patch

import _moderngl
import moderngl

from pvfiblets.engine.gl import gl_loader, moderngl_extras, passes

__all__ = ["Calls", "possible", "recording"]

_PACK = 0x88EB  # GL_PIXEL_PACK_BUFFER: what is read goes there, later
_RESULT = 0x8866  # GL_QUERY_RESULT; whether it is available, and the result without waiting, are others
_MAP_READ, _INVALIDATE, _UNSYNCHRONISED = 0x1, 0x4 | 0x8, 0x20
_SIGNALLED = (0x911A, 0x911C)  # already, or within the timeout

_U, _I, _P, _U64 = ctypes.c_uint, ctypes.c_int, ctypes.c_void_p, ctypes.c_uint64
_WATCHED: dict[str, tuple[Any, ...]] = {
    # name: result, arguments
    "glFinish": (None,),
    "glReadPixels": (None, _I, _I, _I, _I, _U, _U, _P),
    "glGetTexImage": (None, _U, _I, _U, _U, _P),
    "glGetTextureImage": (None, _U, _I, _U, _U, _I, _P),
    "glGetBufferSubData": (None, _U, ctypes.c_ssize_t, ctypes.c_ssize_t, _P),
    "glMapBuffer": (_P, _U, _U),
    "glMapBufferRange": (_P, _U, ctypes.c_ssize_t, ctypes.c_ssize_t, _U),
    "glBindBuffer": (None, _U, _U),
    "glGetQueryObjectiv": (None, _U, _U, _P),
    "glGetQueryObjectuiv": (None, _U, _U, _P),
    "glGetQueryObjecti64v": (None, _U, _U, _P),
    "glGetQueryObjectui64v": (None, _U, _U, _P),
    "glFenceSync": (_P, _U, _U),
    "glClientWaitSync": (_U, _P, _U, _U64),
}
_ROOM = 1 << 17
_ANSWERS = {"glGetIntegerv", "glGetInteger64v", "glGetFramebufferAttachmentParameteriv"}
"""What answers even when all others do nothing: who asks goes by it."""


def possible() -> bool:
    """Say whether calls can be recorded here: the instructions that count them are those of x86-64."""
    return platform.machine() in ("x86_64", "AMD64") and platform.system() == "Linux"


class Calls:
    """Counts calls.

    Attributes
    ----------
    waits : list of str
        Calls since :meth:`forget` that waited for the GPU, or might have.
    """

    def __init__(self) -> None:
        self.waits: list[str] = []
        self._silent = ctypes.c_uint8(0)
        self._code = mmap.mmap(-1, _ROOM, prot=mmap.PROT_READ | mmap.PROT_WRITE | mmap.PROT_EXEC)
        self._base = ctypes.addressof(ctypes.c_char.from_buffer(self._code))
        self._used = 0
        self._numbers: dict[str, Any] = {}
        self._before: Counter[str] = Counter()
        self._thunks: dict[tuple[str, int], int] = {}
        self._kept: list[Any] = []
        self._bound: dict[int, int] = {}  # buffers by target
        self._steps = 0  # what is counted up by fences and by what fills buffers
        self._done = -1  # the last step that the GPU is known to be through with
        self._fences: dict[int, int] = {}
        self._filled: dict[int, int] = {}  # step in which a buffer was last read into

    def wrapped(self, name: str, address: int) -> int:
        """Return the address to call instead."""
        if not address:
            return 0
        if (name, address) not in self._thunks:
            target = self._watched(name, address) if name in _WATCHED else address
            self._thunks[name, address] = self._thunk(name, target)
        return self._thunks[name, address]

    def _thunk(self, name: str, target: int) -> int:
        number = self._numbers.setdefault(name, ctypes.c_uint64(0))
        # mov r11, number; inc qword [r11]
        code = b"\x49\xbb" + struct.pack("<Q", ctypes.addressof(number)) + b"\x49\xff\x03"
        # mov r11, silent; cmp byte [r11], 0; je past the next three; xor eax, eax; ret
        if name not in _ANSWERS:
            code += b"\x49\xbb" + struct.pack("<Q", ctypes.addressof(self._silent)) + b"\x41\x80\x3b\x00"
            code += b"\x74\x03\x31\xc0\xc3"
        # mov r11, target; jmp r11
        code += b"\x49\xbb" + struct.pack("<Q", target) + b"\x41\xff\xe3"
        at = self._used
        self._used += -(-len(code) // 16) * 16
        assert self._used <= _ROOM
        self._code[at : at + len(code)] = code
        return self._base + at

    def _watched(self, name: str, address: int) -> int:
        kind = ctypes.CFUNCTYPE(*_WATCHED[name])
        function = kind(address)

        def call(*arguments: Any) -> Any:
            result = function(*arguments)
            self._look(name, arguments, result)
            return result

        callback = kind(call)
        self._kept += [function, callback]
        return ctypes.cast(callback, _P).value or 0

    def _look(self, name: str, arguments: tuple[Any, ...], result: Any) -> None:
        if name == "glBindBuffer":
            self._bound[arguments[0]] = arguments[1]
        elif name == "glFenceSync":
            self._steps += 1
            self._fences[result] = self._steps
        elif name == "glClientWaitSync":
            if arguments[2]:
                self.waits.append(f"glClientWaitSync for {arguments[2]} ns")
            if result in _SIGNALLED:
                self._done = max(self._done, self._fences.get(arguments[0], -1))
        elif name in ("glReadPixels", "glGetTexImage", "glGetTextureImage"):
            if buffer := self._bound.get(_PACK, 0):
                self._steps += 1
                self._filled[buffer] = self._steps
            else:
                self.waits.append(name)
        elif name.startswith("glGetQueryObject"):
            if arguments[1] == _RESULT:
                self.waits.append(f"{name} of a result")
        elif name == "glMapBufferRange":
            if arguments[3] & (_INVALIDATE | _UNSYNCHRONISED) == 0:
                self._read(name, arguments[0])
        elif name in ("glMapBuffer", "glGetBufferSubData"):
            self._read(name, arguments[0])
        else:
            self.waits.append(name)

    def _read(self, name: str, target: int) -> None:
        """A buffer is read: at once, if a fence after what filled it has been passed."""
        filled = self._filled.get(self._bound.get(target, 0))
        if filled is None or filled > self._done:
            self.waits.append(name)

    @property
    def silent(self) -> bool:
        """Whether calls are counted, and nothing comes of them: what is left of a frame is the program's own time."""
        return bool(self._silent.value)

    @silent.setter
    def silent(self, silent: bool) -> None:
        self._silent.value = silent

    def forget(self) -> None:
        """Begin to count anew."""
        self.waits.clear()
        self._before = Counter({name: number.value for name, number in self._numbers.items()})

    @property
    def counts(self) -> dict[str, int]:
        """Calls since :meth:`forget` by name, without those that were not called."""
        every = Counter({name: number.value for name, number in self._numbers.items()})
        every.subtract(self._before)
        return {name: count for name, count in sorted(every.items()) if count}


class _Loader:
    """What moderngl asks for addresses."""

    def __init__(self, calls: Calls, look_up: Callable[[str], int]) -> None:
        self._calls, self._look_up = calls, look_up

    def load_opengl_function(self, name: str) -> int:
        return self._calls.wrapped(name, self._look_up(name))

    load = load_opengl_function

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        return None

    def release(self) -> None:
        return None


@contextmanager
def recording() -> Iterator[Calls]:
    """Record what moderngl's contexts call that are made meanwhile on current contexts, and what the engine calls.

    Some OpenGL context must be current whenever one is made. `moderngl.init_context` makes one on it. Passes are timed
    as on a graphics card, by queries.
    """
    calls, honest = Calls(), gl_loader.loader

    class Default(_Loader):
        def __init__(self) -> None:
            super().__init__(calls, honest())

    def loader() -> Callable[[str], int]:
        look_up = honest()
        return lambda name: calls.wrapped(name, look_up(name))

    before = getattr(moderngl._store, "default_context", None)
    with (
        patch.object(_moderngl, "DefaultLoader", Default),
        patch.object(moderngl_extras, "loader", loader),
        patch.object(passes.Passes, "_software", property(lambda _: False, lambda *_: None), create=True),
    ):
        try:
            yield calls
        finally:
            moderngl._store.default_context = before
