"""OpenGL queries between two commands: nanoseconds taken, or samples drawn.

moderngl's own query objects are not used: they cannot be released, so that their names in OpenGL are never free again,
and they read 32 bits, which nanoseconds exceed after 4.3 s.
"""

from __future__ import annotations

import ctypes

from .moderngl_extras import GLExtras

_TARGETS = {"time": 0x88BF, "samples": 0x8914}
_RESULT = 0x8866


class Query:
    """Measures nanoseconds on the GPU (``time``) or ``samples`` that pass all tests in a ``with`` block.

    Another one of the same kind must not begin in it.
    """

    def __init__(self, gl: GLExtras, kind: str) -> None:
        self._gl = gl
        self._target = _TARGETS[kind]
        name = ctypes.c_uint(0)
        gl.function("glGenQueries")(1, ctypes.byref(name))
        self._glo = name.value
        self._measured = False

    def __enter__(self) -> None:
        self._gl.function("glBeginQuery")(self._target, self._glo)

    def __exit__(self, *_: object) -> None:
        self._gl.function("glEndQuery")(self._target)
        self._measured = True

    @property
    def glo(self) -> int:
        """OpenGL's name of the query; 0 once released."""
        return self._glo

    def value(self) -> int:
        """Wait for the commands, and return their time or count; 0 before any, and after `release`."""
        if not self._glo or not self._measured:
            return 0
        found = ctypes.c_uint64(0)
        self._gl.function("glGetQueryObjectui64v")(self._glo, _RESULT, ctypes.byref(found))
        return found.value

    def release(self) -> None:
        """Give the query back; twice is harmless. The context must be current."""
        if self._glo:
            self._gl.function("glDeleteQueries")(1, ctypes.byref(ctypes.c_uint(self._glo)))
            self._glo = 0


class Timers:
    """Milliseconds on the GPU of passes that have names; each keeps its query until it is dropped."""

    def __init__(self, gl: GLExtras) -> None:
        self._gl = gl
        self._queries: dict[str, Query] = {}

    def timed(self, name: str) -> Query:
        """Return what times the GL commands of a ``with`` block."""
        if name not in self._queries:
            self._queries[name] = Query(self._gl, "time")
        return self._queries[name]

    def ms(self, name: str) -> float:
        """Wait for a pass that was timed, and return how long it took when it last ran."""
        return self._queries[name].value() / 1e6

    @property
    def names(self) -> list[str]:
        """Passes that were timed, in the order of their first time."""
        return list(self._queries)

    def drop(self, name: str) -> None:
        """Forget a pass; one that was never timed does no harm."""
        if (query := self._queries.pop(name, None)) is not None:
            query.release()

    def release(self) -> None:
        """Give all queries back; twice is harmless. The context must be current."""
        for name in self.names:
            self.drop(name)
