"""Pipelines from fiblets to pixels: one module each, all filling the same G-buffer from the same chunks."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ..data.measures import ComputeMeasurer, FeedbackMeasurer, Measurer
from .compute import ComputePipeline
from .constants import CONSTANTS
from .draw_request import DrawRequest, Pipeline
from .limits import TEXTURED, Limits

if TYPE_CHECKING:
    import moderngl

    from ...gl.moderngl_extras import GLExtras
    from ...gl.shaders import Programs

__all__ = ["CONSTANTS", "ComputePipeline", "DrawRequest", "Limits", "Pipeline", "make_measurer", "make_pipeline"]


def make_pipeline(
    name: str,
    ctx: moderngl.Context,
    gl: GLExtras,
    programs: Programs,
    sizes: Sequence[int],
    limits: Limits,
    alike: int | None = None,
) -> Pipeline:
    """Make a pipeline for chunks of these sizes, by a name that the context must support.

    It shares the programs of sets with `alike` fiblets.
    """
    n_fiblets = sum(sizes)
    if name in ("mesh", "mesh-serial"):
        from .mesh import MeshPipeline

        return MeshPipeline(ctx, gl, programs, n_fiblets, serial=name == "mesh-serial")
    if name == "tessellation":
        from .tessellation import TessellationPipeline

        return TessellationPipeline(ctx, gl, programs, n_fiblets)
    if name == "geometry":
        from .geometry import GeometryPipeline

        return GeometryPipeline(ctx, gl, programs, n_fiblets)
    return ComputePipeline(ctx, programs, sizes, limits.groups, limits.call, alike)


def make_measurer(name: str, ctx: moderngl.Context, gl: GLExtras, programs: Programs, limits: Limits) -> Measurer:
    """Make what measures fiblets beside a pipeline."""
    if name in TEXTURED:
        return FeedbackMeasurer(ctx, gl, programs)
    return ComputeMeasurer(ctx, programs, limits.groups)
