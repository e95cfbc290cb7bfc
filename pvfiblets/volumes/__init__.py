"""Volumes for ray casting (Lesar 2015), their octrees and transfer functions. NumPy; no OpenGL, no VTK."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..support.lazy_imports import names_from

if TYPE_CHECKING:
    from .octree import Octree, build_octree
    from .smoothing import smoothed
    from .sources import as_raycast_volume
    from .transfer import Transfer
    from .volume import FILTERS, RaycastVolume


__all__ = ["FILTERS", "Octree", "RaycastVolume", "Transfer", "as_raycast_volume", "build_octree", "smoothed"]

_HOME = {
    "FILTERS": "volume",
    "Octree": "octree",
    "RaycastVolume": "volume",
    "Transfer": "transfer",
    "as_raycast_volume": "sources",
    "build_octree": "octree",
    "smoothed": "smoothing",
}

__getattr__, __dir__ = names_from(__name__, _HOME)
