"""How much one call may ask of a graphics card, so that it ends within a second on the slowest that one meets.

A system takes a card for hung, and resets it with all that it holds, when it cannot be interrupted for some seconds
(two on Windows), and interruptions are certain only between calls. While one runs, nothing else is drawn either: no
mouse pointer moves.

What cards do in a second is an estimate. Mesa's software OpenGL decodes and draws 34 million segments a second on two
cores of some 0.15 TFLOPS; other devices are assumed to be proportional to theirs:

============  ==============================  =======  ==================  ==========================
card          the slowest that is thought of  TFLOPS   segments a second   texture samples a second
============  ==============================  =======  ==================  ==========================
integrated    Intel UHD 620                   0.4      90 million          1 thousand million
of its own    NVIDIA GTX 1650                 3        700 million         8 thousand million
============  ==============================  =======  ==================  ==========================

A call has fiblets of 60 segments for 0.7 s, if all are in view and none is hidden; or samples along rays for half a
second. The compute pipeline cuts its lists for integrated cards into calls of a tenth of a second: there a buffer is as
large as it may be, and calls without work cost next to nothing. Software has no such limits: no
watchdog resets a processor.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import NamedTuple

import moderngl

from .passes import is_software


class WorkLimits(NamedTuple):
    """Greatest work of one call."""

    fiblets: int  # to be decoded and drawn
    samples: int  # along rays through volumes, of all pixels
    listed: int = 1 << 31  # fiblets of one of several calls that share the drawing of a list

    @classmethod
    def from_context(cls, ctx: moderngl.Context) -> WorkLimits:
        """Return the limits for a context's card; one of no known name counts as integrated."""
        if is_software(ctx):
            return SOFTWARE
        name = f"{ctx.info['GL_VENDOR']} {ctx.info['GL_RENDERER']}"
        return DISCRETE if _DISCRETE.search(name) else INTEGRATED

    def bands(self, size: tuple[int, int], samples: float) -> list[tuple[int, int, int, int]]:
        """Cut a picture into bands of rows for a call each: x, y, width, height in pixels."""
        width, height = size
        rows = max(int(self.samples / max(width * samples, 1.0)), 1)
        return [(0, first, width, min(rows, height - first)) for first in range(0, height, rows)]

    def draw(self, framebuffer: moderngl.Framebuffer, samples: float, render: Callable[[], object]) -> None:
        """Draw a picture of rays in so many calls; the framebuffer has no scissor afterwards."""
        bands = self.bands(framebuffer.size, samples)
        try:
            for band in bands:
                if len(bands) > 1:
                    framebuffer.scissor = band
                framebuffer.use()
                render()
        finally:
            if len(bands) > 1:
                framebuffer.scissor = None  # type: ignore[assignment]  # none, to moderngl


INTEGRATED = WorkLimits(1 << 20, 500_000_000, 1 << 17)
DISCRETE = WorkLimits(1 << 23, 4_000_000_000, 1 << 23)
SOFTWARE = WorkLimits(1 << 31, 1 << 62)

_DISCRETE = re.compile(
    r"\b(nvidia|geforce|quadro|tesla|rtx|gtx|radeon (rx|pro|vii|instinct)|instinct|firepro|arc\(tm\)|arc [ab]\d)", re.I
)
