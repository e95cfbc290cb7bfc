"""Smooth edges of lines in a picture that is drawn already: each pixel shows what lines cover of it.

The engine keeps one line a pixel, and where its edges run (``GBuffer.edges``). From the lines of a pixel and its eight
neighbours `Coverage` finds what share of the pixel each of them covers, nearest first, and mixes their colours in the
finished picture. ``shaders/effects/picture/antialias_coverage.frag`` says how.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import moderngl

from ..gbuffer import GBuffer
from .picture_passes import Attachment, PicturePasses

__all__ = ["Coverage", "SmoothedLines"]

TILE = 32  # pixels of the side of the squares that are looked at, or are not since no line is near


@dataclass(frozen=True)
class SmoothedLines:
    """What one drawable shows of a picture."""

    buffer: GBuffer  # with `edges`, of the viewport's size
    # excess of the drawn width over the line's, in pixels: lines below one pixel are drawn one pixel wide
    narrower: float
    rectangle: tuple[int, int, int, int]  # x, y, width, height of the part of the viewport that it can be in


class Coverage(PicturePasses):
    """Smooths edges in one context."""

    def __init__(self, ctx: moderngl.Context) -> None:
        super().__init__(ctx, {"tile": TILE})
        self._arrays: dict[moderngl.Program, moderngl.VertexArray] = {}

    def smooth(
        self,
        colour: Attachment,
        depth: Attachment,
        viewport: tuple[int, int, int, int],
        drawn: Sequence[SmoothedLines],
        *,
        alike: bool = False,
    ) -> None:
        """Smooth the edges of lines."""
        x, y, width, height = viewport
        drawn = [lines for lines in drawn if lines.buffer.edges is not None and lines.buffer.size == (width, height)]
        left, low, right, top = _union([lines.rectangle for lines in drawn])
        if right <= left or top <= low:
            return
        size = width + 2, height + 2
        self._texture("shown", size, 4, "u4")
        begin = left // TILE, low // TILE
        tiles = -(-right // TILE) - begin[0], -(-top // TILE) - begin[1]
        self._texture("tiles", (-(-width // TILE), -(-height // TILE)), 1, "f1")
        features = colour.features(alike=alike)
        squares = {"start": (1, 1), "size": size, "border": 1}
        uniforms = squares | {"samples": colour.samples, "origin": (x, y)}
        tiled = {"tiles": self._textures["tiles"]}
        outside = tiled | {"drawn": self._outside(colour, 4), "depths": self._outside(depth, 1)}
        with self._plain_state():
            occupied = self._framebuffer(("tiles",))
            occupied.clear()
            occupied.viewport = (*begin, *tiles)
            for lines in drawn:
                self._pass("line_tiles", occupied, {"keys": lines.buffer.depth}, {})
            target = self._framebuffer(("shown",))
            target.viewport = (0, 0, *size)
            for index, lines in enumerate(drawn):
                seen = outside | {"keys": lines.buffer.depth, "edges": lines.buffer.edges}
                thinner = {"narrower": lines.narrower, "first": int(index == 0)}
                self._tile_pass("visible_edges", target, seen, {**uniforms, **thinner}, features)
            with self._onto(colour, viewport) as picture:
                textures = tiled | {"shown": self._textures["shown"]}
                squares = {"start": (0, 0), "size": (width, height), "border": 0}
                self._tile_pass("antialias_coverage", picture, textures, {"shift": (1 - x, 1 - y), **squares})

    def _tile_pass(
        self,
        name: str,
        target: moderngl.Framebuffer,
        textures: Mapping[str, Any],
        uniforms: Mapping[str, Any],
        features: Iterable[str] = (),
    ) -> None:
        """Run a fragment stage on the pixels of squares that have lines."""
        stages = {"vertex": "effects/picture/line_tiles.vert", "fragment": f"effects/picture/{name}.frag"}
        program = self._programs.render(stages, features)
        if program not in self._arrays:
            self._arrays[program] = self._ctx.vertex_array(program, [])
        self._use(program, target, textures, uniforms)
        columns, rows = self._textures["tiles"].size
        self._arrays[program].render(moderngl.TRIANGLES, vertices=6 * columns * rows)

    def release(self) -> None:
        """Give everything on the GPU back; twice is harmless."""
        for array in self._arrays.values():
            array.release()
        self._arrays.clear()
        super().release()


def _union(rectangles: Sequence[tuple[int, int, int, int]]) -> tuple[int, int, int, int]:
    """Return left, low, right and top of what holds all rectangles."""
    if not rectangles:
        return 0, 0, 0, 0
    return (
        min(x for x, _, _, _ in rectangles),
        min(y for _, y, _, _ in rectangles),
        max(x + width for x, _, width, _ in rectangles),
        max(y + height for _, y, _, height in rectangles),
    )
