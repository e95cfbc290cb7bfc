"""Smooth edges of lines in a picture that is drawn already: each pixel shows what lines cover of it.

The engine keeps one line a pixel, and where its edges run (``GBuffer.edges``). From the lines of a pixel and its eight
neighbours `Coverage` finds what share of the pixel each of them covers, nearest first, and mixes their colours in the
finished picture. ``shaders/effects/picture/coverage.frag`` says how.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import moderngl

from ..gbuffer import GBuffer
from .picture import Attachment, PictureEffects

__all__ = ["Coverage", "SmoothedLines"]


@dataclass(frozen=True)
class SmoothedLines:
    """What one drawable shows of a picture.

    Attributes
    ----------
    buffer : GBuffer
        With ``edges``, of the viewport's size.
    narrower : float
        Pixels by which its lines are thinner than they were drawn: those below one pixel are drawn one pixel wide.
    rectangle : tuple of 4 ints
        x, y, width, height of the part of the viewport that it can be in.
    """

    buffer: GBuffer
    narrower: float
    rectangle: tuple[int, int, int, int]


class Coverage(PictureEffects):
    """Smooths edges in one context.

    Parameters
    ----------
    ctx : moderngl.Context
        Current, as for every method. Nothing is made on it until a picture is smoothed.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        super().__init__(ctx)

    def smooth(
        self,
        colour: Attachment,
        depth: Attachment,
        viewport: tuple[int, int, int, int],
        drawn: Sequence[SmoothedLines],
        *,
        alike: bool = False,
    ) -> None:
        """Smooth the edges of lines.

        Parameters
        ----------
        colour, depth : Attachment
            What the picture consists of. Colours are changed, of all samples of a pixel alike.
        viewport : tuple of 4 ints
            x, y, width, height of the part of the attachments that counts.
        drawn : sequence of SmoothedLines
            Of every drawable in it.
        alike : bool
            Whether all samples of a pixel are the same, where it has several: then one of them is read.

        Raises
        ------
        EngineError
            If memory does not suffice.
        """
        x, y, width, height = viewport
        drawn = [lines for lines in drawn if lines.buffer.edges is not None and lines.buffer.size == (width, height)]
        left, low, right, top = _union([lines.rectangle for lines in drawn])
        if right <= left or top <= low:
            return
        size = width + 2, height + 2
        self._texture("shown", size, 4, "u4")
        features = ["PICTURE_SAMPLES"] if colour.samples else []
        uniforms = {"samples": 1 if alike else colour.samples, "origin": (x, y)}
        outside = {"drawn": self._outside(colour, 4), "depths": self._outside(depth, 1)}
        with self._plain_state():
            target = self._framebuffer(("shown",))
            target.viewport = (left, low, right - left + 2, top - low + 2)
            for index, lines in enumerate(drawn):
                textures = {**outside, "keys": lines.buffer.depth, "edges": lines.buffer.edges}
                state = {"narrower": lines.narrower, "first": index == 0}
                self._pass("visible_edges", target, textures, uniforms | state, features)
            picture = self._ctx.framebuffer([self._outside(colour, 4, (x + width, y + height))])
            try:
                picture.viewport = (x + left, y + low, right - left, top - low)
                shown, shift = {"shown": self._textures["shown"]}, {"shift": (1 - x, 1 - y)}
                self._pass("coverage", picture, shown, shift)
            finally:
                picture.release()


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
