"""The geometry pipeline (OpenGL 3.3): a point a fiblet goes in, lines come out, decoded while they are emitted.

Paper: Schertzer et al. 2022, section 4.5. The sources are in ``shaders/fiblets/geometry``, and beside it in
``hardware_raster`` and ``segments``.

Budget of a geometry stage: OpenGL promises 256 vertices and 1024 components of all vertices together. With the
components of ``shaders/fiblets/hardware_raster/varyings.glsl``, with or without edges and per-point values:

==============================  ==========  ==============  =======================================================
drawn                           components  vertices        segments of a share
==============================  ==========  ==============  =======================================================
thin, uncut                     16          1024 // 16: 64  60: all of them, by 61 vertices
thin, uncut, with values        18          1024 // 18: 56  30
thin, may be cut                17          1024 // 17: 60  30: every segment may be a strip of its own
thin, may be cut, with values   19          1024 // 19: 53  20
wide                            20          1024 // 20: 51  12: four vertices each, 60 in five shares
wide, with values               22          1024 // 22: 46  10: 60 in six shares
wide, caller's planes, either   28          1024 // 28: 36  9: 60 in seven shares
==============================  ==========  ==============  =======================================================

A fiblet is drawn in several shares, depending on its segments; every share walks along the fiblet from its first point.
"""

from __future__ import annotations

from collections.abc import Mapping

import moderngl

from ....codec.layout import MAX_POINTS
from .constants import SHARES
from .draw_request import DrawRequest
from .textured import TexturedPipeline

_HANDED_OVER = {"VALUES_ARC_LENGTH", "VALUES_VOLUME"}
"""Values that vertices carry; of a stored one fragments look up the codes."""


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
        valued = "valued_" if _HANDED_OVER.intersection(request.values) else ""
        if request.wide:
            share = SHARES["cut_capsule" if request.planes else f"{valued}capsule"]
        else:
            share = SHARES[f"cut_{valued}line" if request.clipping else f"{valued}line"]
        return -(-MAX_POINTS // share)
