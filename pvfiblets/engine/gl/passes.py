"""Timed passes, and dispatches folded into what the driver allows per axis."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Iterator
from typing import Any

import moderngl

from ..errors import EngineError
from .bindings import STORAGE
from .gl_version import version_of
from .moderngl_extras import GLExtras
from .queries import Timers

SOFTWARE = ("llvmpipe", "softpipe", "swrast")


def is_software(ctx: moderngl.Context) -> bool:
    """Return whether OpenGL runs on the CPU."""
    renderer = str(ctx.info["GL_RENDERER"]).lower()
    return any(name in renderer for name in SOFTWARE)


class Passes:
    """Milliseconds of each pass of the last redraw.

    A GPU is measured with timer queries. Mesa's software OpenGL returns 0 from them for compute work, but runs it
    before the dispatching call returns: there the clock is read instead.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        self._timers = Timers(GLExtras(ctx))
        self._software = is_software(ctx)
        self._clock: dict[str, float] = {}
        self._ran: list[str] = []
        self._away = 0.0

    def begin(self) -> None:
        """Forget the last redraw."""
        self._ran.clear()

    def timed(self, name: str) -> contextlib.AbstractContextManager[Any]:
        """Time the GL commands of a pass."""
        if self._software:
            return self._clocked(name)
        self._ran.append(name)
        return self._timers.timed(name)

    @contextlib.contextmanager
    def _clocked(self, name: str) -> Iterator[None]:
        started = self.clock()
        yield
        self._ran.append(name)
        self._clock[name] = (self.clock() - started) * 1e3

    def clock(self) -> float:
        """Return seconds, without the time in :meth:`away`."""
        return time.perf_counter() - self._away

    @contextlib.contextmanager
    def away(self) -> Iterator[None]:
        """Leave out the time in which a picture waits for others."""
        began = time.perf_counter()
        try:
            yield
        finally:
            self._away += time.perf_counter() - began

    def report(self) -> list[dict[str, object]]:
        """Wait for the last redraw and return its passes as ``{'name', 'ms'}``, in order."""
        if self._software:
            return [{"name": name, "ms": self._clock[name]} for name in self._ran]
        return [{"name": name, "ms": self._timers.ms(name)} for name in self._ran]

    def release(self) -> None:
        """Give all queries back; twice is harmless."""
        self._timers.release()
        self._ran.clear()


GROUP_SIZE = 64  # invocations of a compute work group, `group_size` to the sources


@contextlib.contextmanager
def nowhere(ctx: moderngl.Context, gl: GLExtras) -> Iterator[None]:
    """Draw into an unused pixel: every drawing call needs a target, even one that only counts."""
    with gl.framebuffers_kept():
        pixel = ctx.renderbuffer((1, 1))
        target = ctx.framebuffer([pixel])
        try:
            target.use()
            yield
        finally:
            target.release()
            pixel.release()


def work_groups(ctx: moderngl.Context) -> int:
    """Return how many work groups a dispatch may have along its first axis."""
    # moderngl does not ask contexts that say they are older than 4.3; OpenGL promises so many.
    return int(ctx.info.get("GL_MAX_COMPUTE_WORK_GROUP_COUNT", (65535,))[0])


def has_storage(ctx: moderngl.Context, name: str) -> bool:
    """Return whether a compute program may use the storage buffers up to the one of this name; eight are certain."""
    if version_of(ctx) < 430:
        return False
    limits = "GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS", "GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS"
    return min(map(GLExtras(ctx).get_integer, limits)) > STORAGE[name]


def dispatch(program: moderngl.ComputeShader, groups: int, max_groups: int) -> None:
    """Run work groups, in rows where there are more than one axis may have."""
    # The shader's `group_index()` undoes the folding; groups past the last find nothing to do.
    if groups <= 0:
        return
    if groups <= max_groups:
        program.run(groups)
        return
    rows = -(-groups // max_groups)
    if rows > max_groups:
        raise EngineError(f"{groups} work groups are more than {max_groups} x {max_groups}")
    program.run(min(groups, max_groups), rows)
