"""What the studies that draw share: a context of their own, and a clock that sees what drawing costs.

Software OpenGL draws on threads of this process: the processor time of all of them is what a picture costs, and other
programs disturb it little. What a card does shows in no processor time, so there the clock on the wall is read.
"""

from __future__ import annotations

import contextlib
import re
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Any, TypeAlias

import numpy as np

from .record import LeftOut, Record, Timing
from .studies.codec.errors_and_times import Turns
from .study import Options, Unavailable

__all__ = ["LATE", "Part", "WindowPart", "clock_of", "data_bytes", "drawing_context", "run_parts", "timing", "turns_of"]

Part: TypeAlias = Callable[[Any, Options, list[LeftOut]], Iterator[Record]]
"""Of a study: from a context and options to records."""

WindowPart: TypeAlias = Callable[[Options, list[LeftOut]], Iterator[Record]]
"""Of a study: draws in windows."""

LATE = "the time given was used up"
"""Why something was left out."""

OF_THE_PICTURE = ("gbuffer", "occlusion", "framebuffer", "depth", "depth of tubes", "marks of tubes")
"""Buffers that grow with the picture, not with the data."""

SOFTWARE = re.compile("llvmpipe|softpipe|swrast|swiftshader|software", re.IGNORECASE)


@contextlib.contextmanager
def drawing_context(options: Options) -> Iterator[Any]:
    """Make a bare OpenGL context for a study, and give it back."""
    try:
        from pvfiblets.engine.errors import EngineError
        from pvfiblets.engine.gl.standalone import bare_context

        ctx = bare_context()
    except ImportError as error:
        raise Unavailable(f"{error.name} is not installed") from error
    except EngineError as error:
        raise Unavailable(str(error)) from error
    options.driver = f"{ctx.info['GL_RENDERER']}, {ctx.info['GL_VERSION']}"
    try:
        with ctx:  # what was current before is so again afterwards
            yield ctx
    finally:
        ctx.release()


def run_parts(
    parts: Mapping[Part, float],
    options: Options,
    left_out: list[LeftOut],
    windows: Mapping[WindowPart, float] = MappingProxyType({}),
) -> Iterator[Record]:
    """Yield records part by part, each with its share of what time is left, by weights.

    Parts in windows come after the bare context is gone: a window that VTK closes takes older ones' display along.
    """
    weights = [*parts.values(), *windows.values()]

    def share(number: int) -> Options:
        return replace(options, budget=options.budget.share(weights[number] / sum(weights[number:])))

    with drawing_context(options) as ctx:
        for number, part in enumerate(parts):
            yield from part(ctx, share(number), left_out)
    for number, drawn in enumerate(windows, len(parts)):
        try:
            yield from drawn(share(number), left_out)
        except ImportError as error:
            left_out.append(LeftOut("pictures in windows", f"{error.name} is not installed"))


def clock_of(ctx: Any) -> tuple[Callable[[], float], str]:
    """Return the clock that sees what a context's pictures cost, and its name as in :class:`.Timing`."""
    if SOFTWARE.search(str(ctx.info["GL_RENDERER"])):
        return time.process_time, "cpu"
    return time.perf_counter, "wall"


def turns_of(ctx: Any) -> Turns:
    """Return turns that are timed by a context's clock; what they call must end with ``ctx.finish()``."""
    return Turns(*clock_of(ctx))


def timing(seconds: list[float], items: float, item: str, clock: str) -> Timing:
    """Return what repeats of one call took, which handles so many items."""
    return Timing(float(np.median(seconds)), min(seconds), max(seconds), len(seconds), float(items), item, clock)


def data_bytes(explained: Mapping[str, Any]) -> int:
    """Return the bytes on the GPU that grow with the data, of what a renderer or an actor explains."""
    return sum(buffer["bytes"] for buffer in explained["buffers"] if buffer["name"] not in OF_THE_PICTURE)
