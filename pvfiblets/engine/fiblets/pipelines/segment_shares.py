"""Shares of fiblets' segments that an invocation draws at a time, where software OpenGL limits its loops."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable

from ....codec.layout import MAX_POINTS
from ...errors import EngineError
from ...gl.passes import GROUP_SIZE
from .constants import GROUP_WORDS

SOFTWARE_ITERATIONS = 60_000
"""What one invocation may loop under Mesa's software OpenGL, which leaves all loops of a shader for good after 65,535
iterations in sum and says nothing."""

WIDEST_IN_SOFTWARE = 100
"""Greatest line width in pixels at which one segment of each fiblet stays within that."""


def segment_shares(line_width: float, segment: Callable[[], float]) -> list[tuple[int, int]]:
    """Cut the segments of a fiblet into ranges whose pixels software OpenGL draws before it leaves the loops.

    An invocation draws ``32 * GROUP_WORDS / GROUP_SIZE`` fiblets or fewer, and waits for its neighbours' segments.
    Over each pixel of a segment's longer side stand at most sqrt(2) widths, 1.2 on average.
    """
    if line_width == 0.0:
        return [(0, MAX_POINTS)]
    fiblets = 32 * GROUP_WORDS // GROUP_SIZE
    count = int(SOFTWARE_ITERATIONS / ((1.2 * line_width + 1.0) * fiblets * (segment() + line_width)))
    if count < 1 and line_width > WIDEST_IN_SOFTWARE:
        raise EngineError(
            f"a line width of {line_width:g} pixels is more than software OpenGL draws whole; give at most "
            f"{WIDEST_IN_SOFTWARE}"
        )
    ranges = math.ceil(MAX_POINTS / max(count, 1))
    edges = [MAX_POINTS * i // ranges for i in range(ranges + 1)]
    return list(itertools.pairwise(edges))
