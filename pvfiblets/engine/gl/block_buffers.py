"""Buffers of uniform blocks, made when something is first written."""

from __future__ import annotations

from typing import TYPE_CHECKING

import moderngl

from .bindings import BLOCKS

if TYPE_CHECKING:
    from .uniform_struct import UniformStruct


class BlockBuffers:
    """Uniform blocks of one set, by name in ``buffers``."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self.buffers: dict[str, moderngl.Buffer] = {}

    def put(self, name: str, struct: UniformStruct, data: bytes | None) -> bool:
        """Write a block and bind it, or, of None, give it back; return True if it is there."""
        if data is None:
            if name in self.buffers:
                self.buffers.pop(name).release()
            return False
        if name not in self.buffers:
            self.buffers[name] = self._ctx.buffer(reserve=struct.nbytes)
        self.buffers[name].write(data)
        self.buffers[name].bind_to_uniform_block(BLOCKS[struct.name])
        return True

    def release(self) -> None:
        """Give the buffers back; twice is harmless."""
        for buffer in self.buffers.values():
            buffer.release()
        self.buffers.clear()
