"""Effects in screen space: passes over the whole picture that read a G-buffer and write a texture each.

They know no lines, only pixels: what they cost depends on the picture's size alone. Each is a
`pvfiblets.engine.effects.screen.ScreenEffect`, made when it is first wanted; OpenGL 3.3 suffices for all.
"""

from __future__ import annotations

from .ambient_occlusion import AmbientOcclusionPass
from .halos import HaloPass
from .lens import Lens
from .outline import OutlinePass
from .screen import ScreenEffect

__all__ = ["AmbientOcclusionPass", "HaloPass", "Lens", "OutlinePass", "ScreenEffect"]
