"""Hangs the engine on VTK: a ``vtkPolyDataMapper`` of fiblets, spline tubes, what has halos, volumes. No PyVista here.

>>> from pvfiblets.mappers import FibletMapper            # doctest: +SKIP
>>> FibletMapper(fiblets).attach(actor)                    # doctest: +SKIP
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from pvfiblets.later import names_from

if TYPE_CHECKING:
    from pvfiblets.mappers.colouring import Colouring
    from pvfiblets.mappers.engines import EngineOptions
    from pvfiblets.mappers.halos import HaloMapper, HaloOptions
    from pvfiblets.mappers.mapper import FibletMapper
    from pvfiblets.mappers.raycast import RaycastMapper, RayHit
    from pvfiblets.mappers.splines import SplineMapper, SplineOptions


__all__ = [
    "Colouring",
    "EngineOptions",
    "FibletMapper",
    "HaloMapper",
    "HaloOptions",
    "RayHit",
    "RaycastMapper",
    "SplineMapper",
    "SplineOptions",
]

_HOME = {
    "Colouring": "colouring",
    "EngineOptions": "engines",
    "FibletMapper": "mapper",
    "HaloMapper": "halos",
    "HaloOptions": "halos",
    "RayHit": "raycast",
    "RaycastMapper": "raycast",
    "SplineMapper": "splines",
    "SplineOptions": "splines",
}

__getattr__, __dir__ = names_from(__name__, _HOME)
