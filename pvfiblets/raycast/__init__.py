"""Volumes for ray casting (Lesar 2015), their octrees and transfer functions. NumPy; no OpenGL, no VTK."""

from __future__ import annotations

from .octree import Octree, build_octree
from .transfer import Transfer
from .volume import FILTERS, RaycastVolume

__all__ = ["FILTERS", "Octree", "RaycastVolume", "Transfer", "build_octree"]
