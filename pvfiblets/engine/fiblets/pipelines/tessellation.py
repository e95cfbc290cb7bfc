"""The tessellation pipeline (OpenGL 4.1): a fiblet is a patch, which is decoded, and isolines become its segments.

Paper: Schertzer et al. 2022, section 4.5. The sources are in ``shaders/fiblets/tessellation``, with their budgets, and
in ``hardware_raster`` and ``segments`` beside it.
"""

from __future__ import annotations

from collections.abc import Mapping

import moderngl

from .draw_request import DrawRequest
from .textured import TexturedPipeline


class TessellationPipeline(TexturedPipeline):
    """Draws chunks through tessellation stages; parameters as for :class:`RasterPipeline`."""

    name = "tessellation"
    mode = moderngl.PATCHES
    software_batch = 512
    """Mesa's software OpenGL numbers what the evaluation stage makes of a call in 16 bits, and says nothing when they
    do not suffice: 512 fiblets make 512 * 60 * 2 = 61,440 vertices at most."""

    def _stages(self, request: DrawRequest) -> Mapping[str, str]:
        stages = {
            "vertex": "fiblets/hardware_raster/survivors.vert",
            "tess_control": "fiblets/tessellation/decode.tesc",
        }
        if not request.wide:
            return {
                **stages,
                "tess_evaluation": "fiblets/tessellation/lines.tese",
                "fragment": "fiblets/hardware_raster/line.frag",
            }
        return {
            **stages,
            "tess_evaluation": "fiblets/tessellation/capsules.tese",
            "geometry": "fiblets/tessellation/capsules.geom",
            "fragment": "fiblets/hardware_raster/capsule.frag",
        }

    def _shares(self, request: DrawRequest) -> int:  # noqa: ARG002 (of one vertex each)
        self._ctx.patch_vertices = 1
        return 1
