"""Occlusion: depth pyramid and coverage buffer, each a texture that shaders test fiblets against."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...support.lazy_imports import names_from
from ..errors import EngineError
from .occlusion import Occlusion

if TYPE_CHECKING:
    import moderngl

    from ...codec.fibletset import FibletSet
    from ..gl.moderngl_extras import GLExtras
    from ..gl.shaders import Programs
    from .coverage import CoverageBuffer
    from .pyramid import DepthPyramid

__all__ = ["CoverageBuffer", "DepthPyramid", "Occlusion", "make_occlusion"]

_HOME = {"CoverageBuffer": "coverage", "DepthPyramid": "pyramid"}

__getattr__, __dir__ = names_from(__name__, _HOME)


def make_occlusion(
    culling: str | None, ctx: moderngl.Context, gl: GLExtras, programs: Programs, fiblets: FibletSet
) -> Occlusion | None:
    """Return what a kind of culling tests against; None for none."""
    if culling in (None, "none"):
        return None
    if culling in ("two-phase", "auto"):
        from .pyramid import DepthPyramid

        return DepthPyramid(ctx, gl, programs)
    if culling == "coverage":
        from .coverage import CoverageBuffer

        return CoverageBuffer(ctx, gl, programs, fiblets)
    raise EngineError(f"culling is {culling!r}; choose 'two-phase', 'coverage' or None")
