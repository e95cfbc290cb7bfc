"""Hermite spline tubes, ray cast into a G-buffer (Russig et al. 2020), on a moderngl context. No VTK, no PyVista.

>>> renderer = TubeRenderer(ctx, tubes)                                                     # doctest: +SKIP
>>> gbuffer = renderer.render(View((1920, 1080), model_view_projection), TubeStyle())       # doctest: +SKIP

Every segment covers what it may show with silhouettes (:mod:`.silhouettes`); the fragment stage meets the pixel's ray
with it (``shaders/tubes/solver.glsl``) and keeps segment, place and depth; one pass over the picture finds all else.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...support.lazy_imports import names_from

if TYPE_CHECKING:
    from .options import SILHOUETTES, SOLVERS, TubeStyle, check_choices
    from .renderer import TubeRenderer


__all__ = ["SILHOUETTES", "SOLVERS", "TubeRenderer", "TubeStyle", "check_choices"]

_HOME = {
    "SILHOUETTES": "options",
    "SOLVERS": "options",
    "TubeRenderer": "renderer",
    "TubeStyle": "options",
    "check_choices": "options",
}

__getattr__, __dir__ = names_from(__name__, _HOME)
