"""Connects the engine to VTK: ``vtkPolyDataMapper`` classes for fiblets, tubes, halos and volumes. No PyVista here.

>>> from pvfiblets.mappers import FibletMapper            # doctest: +SKIP
>>> FibletMapper(fiblets).attach(actor)                    # doctest: +SKIP
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from pvfiblets.support.lazy_imports import names_from

if TYPE_CHECKING:
    from pvfiblets.mappers.colouring import Colouring
    from pvfiblets.mappers.engine_options import EngineOptions
    from pvfiblets.mappers.fiblets import FibletMapper
    from pvfiblets.mappers.halos import HaloMapper, HaloOptions
    from pvfiblets.mappers.tubes import TubeMapper, TubeOptions
    from pvfiblets.mappers.volumes import RayHit, VolumeMapper
    from pvfiblets.mappers.vtk_pipeline.readable_lines import readable
    from pvfiblets.mappers.vtk_pipeline.vtk_overrides import follow


__all__ = [
    "Colouring",
    "EngineOptions",
    "FibletMapper",
    "HaloMapper",
    "HaloOptions",
    "RayHit",
    "TubeMapper",
    "TubeOptions",
    "VolumeMapper",
    "follow",
    "readable",
]

_HOME = {
    "Colouring": "colouring",
    "EngineOptions": "engine_options",
    "FibletMapper": "fiblets",
    "HaloMapper": "halos",
    "HaloOptions": "halos",
    "RayHit": "volumes",
    "VolumeMapper": "volumes",
    "TubeMapper": "tubes",
    "TubeOptions": "tubes",
    "follow": "vtk_pipeline.vtk_overrides",
    "readable": "vtk_pipeline.readable_lines",
}

__getattr__, __dir__ = names_from(__name__, _HOME)
