"""The tessellation pipeline (OpenGL 4.1): a fiblet is a patch, which is decoded, and isolines become its segments.

Paper: Schertzer et al. 2022, section 4.5. The sources are in ``shaders/tessellation``, with their budgets, and in
``shaders/raster``.
"""

from __future__ import annotations

from collections.abc import Mapping

import moderngl

from .job import Job
from .textured import TexturedPipeline

__all__ = ["TessellationPipeline"]


class TessellationPipeline(TexturedPipeline):
    """Draws chunks through tessellation stages; parameters as for :class:`RasterPipeline`."""

    name = "tessellation"
    mode = moderngl.PATCHES
    software_batch = 512
    """Mesa's software OpenGL numbers what the evaluation stage makes of a call in 16 bits, and says nothing when they
    do not suffice: 512 fiblets make 512 * 60 * 2 = 61,440 vertices at most."""

    def _stages(self, job: Job) -> Mapping[str, str]:
        stages = {"vertex": "raster/survivors.vert", "tess_control": "tessellation/decode.tesc"}
        if not job.wide:
            return {**stages, "tess_evaluation": "tessellation/lines.tese", "fragment": "raster/line.frag"}
        return {
            **stages,
            "tess_evaluation": "tessellation/capsules.tese",
            "geometry": "tessellation/capsules.geom",
            "fragment": "raster/capsule.frag",
        }

    def _shares(self, job: Job) -> int:  # noqa: ARG002 (of one vertex each)
        self._ctx.patch_vertices = 1
        return 1
