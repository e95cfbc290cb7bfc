"""GPU times of pictures, available some pictures later: nothing is waited for."""

from __future__ import annotations

import ctypes
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Protocol, TypeAlias

from .moderngl_extras import GLExtras

Which: TypeAlias = tuple[int, bool]  # label of a frame, chosen by the caller

_TIMESTAMP, _RESULT, _AVAILABLE = 0x8E28, 0x8866, 0x8867


class PictureClock(Protocol):
    """Times the drawing inside a ``with`` statement."""

    @contextmanager
    def timed(self, what: Which) -> Iterator[None]:
        """Time a frame, and remember its label."""
        ...

    def finished(self) -> list[tuple[Which, float]]:
        """Return the labels and seconds of frames that ended since the last call, in order."""
        ...

    def release(self) -> None:
        """Give everything back; twice is harmless."""
        ...


class CallClock:
    """Seconds until a call returns: where OpenGL works on the CPU before it returns."""

    def __init__(self, clock: Callable[[], float] = time.perf_counter) -> None:
        self._clock = clock
        self._found: list[tuple[Which, float]] = []

    @contextmanager
    def timed(self, what: Which) -> Iterator[None]:
        """Time a frame, and remember its label."""
        begin = self._clock()
        yield
        self._found.append((what, self._clock() - begin))

    def finished(self) -> list[tuple[Which, float]]:
        """Return the labels and seconds since the last call."""
        found, self._found = self._found, []
        return found

    def release(self) -> None:
        """Do nothing."""


class TimestampClock:
    """Seconds between two marks in the GPU's own queue; marks may lie around timer queries, which cannot be nested."""

    def __init__(self, gl: GLExtras) -> None:
        self._gl = gl
        self._running: list[tuple[Which, int, int]] = []

    @contextmanager
    def timed(self, what: Which) -> Iterator[None]:
        """Time a frame, and remember its label."""
        names = (ctypes.c_uint * 2)()
        self._gl.function("glGenQueries")(2, names)
        self._running.append((what, names[0], names[1]))
        self._gl.function("glQueryCounter")(names[0], _TIMESTAMP)
        yield
        self._gl.function("glQueryCounter")(names[1], _TIMESTAMP)

    def finished(self) -> list[tuple[Which, float]]:
        """Return the labels and seconds of frames that ended since the last call, in order."""
        found = []
        while self._running and self._ask(self._running[0][2], _AVAILABLE):
            what, first, last = self._running.pop(0)
            found.append((what, 1e-9 * (self._ask(last, _RESULT) - self._ask(first, _RESULT))))
            self._delete(first, last)
        return found

    def _ask(self, name: int, what: int) -> int:
        value = ctypes.c_uint64(0)
        self._gl.function("glGetQueryObjectui64v")(name, what, ctypes.byref(value))
        return value.value

    def _delete(self, *names: int) -> None:
        self._gl.function("glDeleteQueries")(len(names), (ctypes.c_uint * len(names))(*names))

    def release(self) -> None:
        """Give all queries back; twice is harmless."""
        for _, first, last in self._running:
            self._delete(first, last)
        self._running.clear()
