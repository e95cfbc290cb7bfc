"""Lines and points with depth-dependent halos (Everts et al. 2009). NumPy; no OpenGL, no VTK."""

from __future__ import annotations

from .look import Look
from .things import HaloLines, HaloPoints

__all__ = ["HaloLines", "HaloPoints", "Look"]
