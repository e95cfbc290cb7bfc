"""Textures for samplers of arrays that have nothing to read."""

from __future__ import annotations

from typing import Any

import moderngl


class BlankArrays:
    """Arrays of one texel, zero; no other kind of texture will do for such a sampler."""

    def __init__(self, ctx: moderngl.Context, said: str) -> None:
        self._ctx = ctx
        self._said = said  # what `buffers` adds to their names
        self._made: dict[str, Any] = {}

    def named(self, name: str, components: int, dtype: str) -> Any:
        """Return the one of a name."""
        if name not in self._made:
            data = bytes(components * int(dtype[1]))
            self._made[name] = self._ctx.texture_array((1, 1, 1), components, data, alignment=1, dtype=dtype)
            self._made[name].filter = moderngl.NEAREST, moderngl.NEAREST
        return self._made[name]

    def buffers(self) -> list[dict[str, Any]]:
        """Return name and bytes of each."""
        return [
            {"name": f"{name} ({self._said})", "bytes": array.components * int(array.dtype[1])}
            for name, array in self._made.items()
        ]

    def release(self) -> None:
        """Give everything back; twice is harmless."""
        for array in self._made.values():
            array.release()
        self._made.clear()
