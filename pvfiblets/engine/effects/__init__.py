"""Effects in screen space: passes over the whole picture that read a G-buffer and write a texture each.

They see pixels, not lines: their cost depends on the picture's size alone. Each is a
`pvfiblets.engine.effects.screen.ScreenEffect`, made when it is first wanted; OpenGL 3.3 suffices for all.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...support.lazy_imports import names_from

if TYPE_CHECKING:
    from .ambient_occlusion import AmbientOcclusionPass
    from .halos import HaloPass
    from .outline import OutlinePass
    from .projection import Projection
    from .screen import ScreenEffect


__all__ = ["AmbientOcclusionPass", "HaloPass", "OutlinePass", "Projection", "ScreenEffect"]

_HOME = {
    "AmbientOcclusionPass": "ambient_occlusion",
    "HaloPass": "halos",
    "Projection": "projection",
    "OutlinePass": "outline",
    "ScreenEffect": "screen",
}

__getattr__, __dir__ = names_from(__name__, _HOME)
