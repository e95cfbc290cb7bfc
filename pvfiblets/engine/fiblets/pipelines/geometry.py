"""The geometry pipeline (OpenGL 3.3): a point a fiblet goes in, lines come out, decoded while they are emitted.

Paper: Schertzer et al. 2022, section 4.5. The sources are in ``shaders/fiblets/geometry``, and beside it in
``hardware_raster`` and ``segments``.

Budget of a geometry stage: OpenGL promises 256 vertices and 1024 components of all vertices together. With the
components of ``shaders/fiblets/hardware_raster/varyings.glsl``, of the nearest lines and of lines that are added up:

===========================  ==============  ==============  =========================================================
drawn                        components      vertices        segments of a share
===========================  ==============  ==============  =========================================================
thin, uncut                  10; 15 summed   1024 // 15: 68  60: all of them, by 61 vertices
thin, may be cut             10; 16 summed   1024 // 16: 64  30: each may be a strip of its own; 60 where nothing is cut
wide, tubes                  15; 17 layered  1024 // 17: 60  15: four vertices each, 60 in four shares
wide, tubes, summed          at most 21      1024 // 21: 48  12: 60 in five shares
wide, caller's planes        at most 27      1024 // 27: 37  9: 60 in seven shares
===========================  ==============  ==============  =========================================================

A fiblet is drawn in several shares, depending on its segments; every share walks along the fiblet from its first point.
"""

from __future__ import annotations

from collections.abc import Mapping

import moderngl

from ....codec.layout import MAX_POINTS
from .constants import SHARES
from .draw_request import DrawRequest
from .textured import TexturedPipeline


class GeometryPipeline(TexturedPipeline):
    """Draws chunks through geometry stages; parameters as for :class:`RasterPipeline`."""

    name = "geometry"
    mode = moderngl.POINTS

    def _stages(self, request: DrawRequest) -> Mapping[str, str]:
        geometry, fragment = ("capsules", "capsule") if request.wide else ("lines", "line")
        return {
            "vertex": "fiblets/hardware_raster/survivors.vert",
            "geometry": f"fiblets/geometry/{geometry}.geom",
            "fragment": f"fiblets/hardware_raster/{fragment}.frag",
        }

    def _shares(self, request: DrawRequest) -> int:
        # The geometry stages choose by the same features.
        if request.wide:
            painted = "painted_" if "PAINTED" in request.gathering else ""
            share = SHARES["cut_capsule" if request.planes else f"{painted}capsule"]
        else:
            share = SHARES["cut_line" if request.clipping else "line"]
        return -(-MAX_POINTS // share)
