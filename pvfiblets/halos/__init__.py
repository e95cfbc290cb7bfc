"""Lines and points with depth-dependent halos (Everts et al. 2009). NumPy; no OpenGL, no VTK."""

from __future__ import annotations

from .geometry import HaloLines, HaloPoints
from .style import HaloStyle

__all__ = ["HaloLines", "HaloPoints", "HaloStyle"]
