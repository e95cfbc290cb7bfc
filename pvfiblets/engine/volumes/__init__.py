"""Volumes, ray cast into a G-buffer (Lesar 2015), on a moderngl context. No VTK, no PyVista.

>>> renderer = VolumeRenderer(ctx, volume)                                     # doctest: +SKIP
>>> gbuffer = renderer.render(View(size, matrix), VolumeStyle(casting=casting))   # doctest: +SKIP

One pass over the picture: every pixel's ray runs through the volume's octree and samples what is left
(``shaders/volumes/cast.frag``).
"""

from __future__ import annotations

from .renderer import VolumeRenderer, VolumeStyle

__all__ = ["VolumeRenderer", "VolumeStyle"]
