"""`DelayedRead`: numbers of a frame that are read some frames later, without waiting for the GPU.

What is read goes into a buffer on the GPU, behind it a fence; once the GPU has passed that, the buffer is read at no
cost. There are a few such buffers, in turn: where all are still on their way, the newest picture is not read at all.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import moderngl
import numpy as np
import numpy.typing as npt

from .moderngl_extras import GLExtras

AT_ONCE = 3  # pictures that may be on their way: drivers queue two or three

_FLOAT = 4


class _Read(NamedTuple):
    """A read under way."""

    buffer: moderngl.Buffer
    fence: int
    tag: Any
    shape: tuple[int, int, int]


class DelayedRead:
    """Reads float32 numbers of framebuffers, later."""

    def __init__(self, ctx: moderngl.Context, gl: GLExtras) -> None:
        self._ctx, self._gl = ctx, gl
        self._free: list[moderngl.Buffer] = []
        self._reads: list[_Read] = []  # the oldest first

    def start(
        self,
        framebuffer: moderngl.Framebuffer,
        area: tuple[int, int, int, int],
        components: int,
        tag: Any = None,
        *,
        attachment: int = 0,
    ) -> bool:
        """Request a read of an area, unless too many are under way."""
        if len(self._reads) >= AT_ONCE:
            return False
        _, _, width, height = area
        buffer = self._buffer(_FLOAT * components * width * height)
        framebuffer.read_into(buffer, area, components, attachment=attachment, dtype="f4", alignment=1)
        fence = self._gl.fence()
        self._reads.append(_Read(buffer, fence, tag, (height, width, components)))
        return True

    def _buffer(self, size: int) -> moderngl.Buffer:
        """Return an unused buffer of sufficient size."""
        while self._free:
            buffer = self._free.pop()
            if buffer.size >= size:
                return buffer
            buffer.release()
        return self._ctx.buffer(reserve=size, dynamic=True)

    def arrived(self) -> tuple[Any, npt.NDArray[np.float32]] | None:
        """Return the tag and the ``(height, width, components)`` numbers of the newest that came since the last call.

        None if none has. Those before it are dropped.
        """
        last = None
        while self._reads and self._gl.passed(self._reads[0].fence):
            if last is not None:
                self._free.append(last.buffer)
            last = self._reads.pop(0)
        if last is None:
            return None
        size = _FLOAT * int(np.prod(last.shape))
        numbers = np.frombuffer(last.buffer.read(size), "<f4").reshape(last.shape)
        self._free.append(last.buffer)
        return last.tag, numbers

    def forget(self) -> None:
        """Drop all that is on its way."""
        for read in self._reads:
            self._gl.drop_fence(read.fence)
            self._free.append(read.buffer)
        self._reads.clear()

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory."""
        return sum(buffer.size for buffer in (*self._free, *(read.buffer for read in self._reads)))

    def release(self) -> None:
        """Give everything on the GPU back; twice is harmless."""
        self.forget()
        for buffer in self._free:
            buffer.release()
        self._free.clear()
