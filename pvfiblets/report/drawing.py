"""The base of studies that draw: a context of their own, parts that share the time, and bytes on the GPU."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Mapping
from types import MappingProxyType
from typing import Any, TypeAlias

from .record import Record
from .study import Options, Unavailable

Part: TypeAlias = Callable[[Any, Options], Iterator[Record]]  # A part of a study: from a context and options to records

WindowPart: TypeAlias = Callable[[Options], Iterator[Record]]  # A part of a study that draws in windows

OF_THE_PICTURE = ("gbuffer", "occlusion", "framebuffer", "depth", "depth of tubes", "marks of tubes")
"""Buffers that grow with the picture, not with the data."""


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
        with ctx:  # restores the previous context afterwards
            yield ctx
    finally:
        ctx.release()


def run_parts(
    parts: Mapping[Part, float],
    options: Options,
    windows: Mapping[WindowPart, float] = MappingProxyType({}),
) -> Iterator[Record]:
    """Yield records part by part, each with its share of what time is left, by weights."""
    # Parts in windows come after the bare context is gone: a window that VTK closes takes older ones' display along.
    weights = [*parts.values(), *windows.values()]

    def share(number: int) -> Options:
        return options.share(weights[number] / sum(weights[number:]))

    with drawing_context(options) as ctx:
        for number, part in enumerate(parts):
            yield from part(ctx, share(number))
    for number, drawn in enumerate(windows, len(parts)):
        try:
            yield from drawn(share(number))
        except ImportError as error:
            options.leave_out("pictures in windows", f"{error.name} is not installed")


def data_bytes(explained: Mapping[str, Any]) -> int:
    """Return the bytes on the GPU that grow with the data, of what a renderer or an actor explains."""
    return sum(buffer["bytes"] for buffer in explained["buffers"] if buffer["name"] not in OF_THE_PICTURE)
