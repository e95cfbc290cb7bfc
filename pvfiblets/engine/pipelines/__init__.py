"""How fiblets become pixels: one module per pipeline, each filling the same G-buffer from the same chunks."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .. import filtering, regions
from ..measures import ComputeMeasurer, FeedbackMeasurer, Measurer
from . import compute, geometry, mesh
from .compute import ComputePipeline
from .geometry import GeometryPipeline
from .job import Job, Pipeline
from .limits import TEXTURED, Limits
from .mesh import MeshPipeline
from .tessellation import TessellationPipeline

if TYPE_CHECKING:
    import moderngl

    from ..opengl import OpenGL
    from ..shaders import Programs

__all__ = ["CONSTANTS", "ComputePipeline", "Job", "Limits", "Pipeline", "make_measurer", "make_pipeline"]

CONSTANTS = {
    **compute.CONSTANTS,
    **geometry.CONSTANTS,
    **mesh.CONSTANTS,
    **filtering.CONSTANTS,
    **regions.CONSTANTS,
}
"""Of all pipelines' sources."""


def make_pipeline(
    name: str, ctx: moderngl.Context, gl: OpenGL, programs: Programs, n_fiblets: int, n_chunks: int, limits: Limits
) -> Pipeline:
    """Make a pipeline by its name, which the context must support."""
    if name in ("mesh", "mesh-serial"):
        return MeshPipeline(ctx, gl, programs, n_fiblets, serial=name == "mesh-serial")
    if name == "tessellation":
        return TessellationPipeline(ctx, gl, programs, n_fiblets)
    if name == "geometry":
        return GeometryPipeline(ctx, gl, programs, n_fiblets)
    return ComputePipeline(ctx, programs, n_fiblets, n_chunks, limits.groups)


def make_measurer(name: str, ctx: moderngl.Context, gl: OpenGL, programs: Programs, limits: Limits) -> Measurer:
    """Make what measures fiblets beside a pipeline."""
    if name in TEXTURED:
        return FeedbackMeasurer(ctx, gl, programs)
    return ComputeMeasurer(ctx, programs, limits.groups)
