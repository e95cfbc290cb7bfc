"""Lines and points with depth-dependent halos, drawn into a G-buffer (Everts et al. 2009), on a moderngl context.

>>> renderer = HaloRenderer(ctx, lines)                                                             # doctest: +SKIP
>>> gbuffer = renderer.render(View((1920, 1080), model_view_projection), HaloDrawStyle(look=look))      # doctest: +SKIP

No VTK, no PyVista. Every segment is a strip of two triangles that the vertex stage widens towards the viewer, every
point a square; fragments find line or halo, move halos back, and keep what they are (``shaders/halos/halo.frag``); one
pass over the picture finds all else.
"""

from __future__ import annotations

from .renderer import HaloDrawStyle, HaloRenderer

__all__ = ["HaloDrawStyle", "HaloRenderer"]
