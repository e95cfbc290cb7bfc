"""Regions of space, for choosing streamlines and for cutting actors.

Shapes are combined by ``&`` (both), ``|`` (either), ``~`` (not) and ``-`` (without)::

    from pvfiblets import regions

    lesion = regions.Sphere((10.0, -22.0, 31.0), 8.0)
    left = regions.Plane((-1.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    region = lesion & left

Streamlines are chosen by where they lie: ``passes(region)``, ``ends_in(region)`` and ``stays_in(region)``, joined by
``&``, ``|`` and ``~``, for :meth:`.FibletSet.select`. A streamline is the line through its points; with
``sampling="points"`` only the points count, as for MRtrix's ``tckedit``. ``Distance(region)`` measures how near the
points come.

``RegionPainter`` paints regions on the voxels of an image, with undo, and ``LiveRegions`` finds which streamlines
pass them after each stroke.

Positions are mm. See :mod:`pvfiblets.query.regions.shapes` for how a region is kept.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from .support.lazy_imports import names_from

if TYPE_CHECKING:
    from .query.measures.measures import Distance
    from .query.painting.fiblet_index import FibletIndex, index_of
    from .query.painting.live import LiveRegion, LiveRegions
    from .query.painting.painter import PaintedRegion, RegionPainter, Stroke
    from .query.regions.classify import classify
    from .query.regions.labels import Labels
    from .query.regions.shapes import Box, Plane, Region, Shape, Slab, Sphere
    from .query.regions.surfaces import Surface
    from .query.selection.predicates import Predicate, ends_in, passes, stays_in

__all__ = [
    "Box",
    "Distance",
    "FibletIndex",
    "Labels",
    "LiveRegion",
    "LiveRegions",
    "PaintedRegion",
    "Plane",
    "Predicate",
    "Region",
    "RegionPainter",
    "Shape",
    "Slab",
    "Sphere",
    "Stroke",
    "Surface",
    "classify",
    "ends_in",
    "index_of",
    "passes",
    "stays_in",
]

_HOME = {
    "Box": ".query.regions.shapes",
    "Distance": ".query.measures.measures",
    "FibletIndex": ".query.painting.fiblet_index",
    "Labels": ".query.regions.labels",
    "LiveRegion": ".query.painting.live",
    "LiveRegions": ".query.painting.live",
    "PaintedRegion": ".query.painting.painter",
    "Plane": ".query.regions.shapes",
    "Predicate": ".query.selection.predicates",
    "Region": ".query.regions.shapes",
    "RegionPainter": ".query.painting.painter",
    "Shape": ".query.regions.shapes",
    "Slab": ".query.regions.shapes",
    "Sphere": ".query.regions.shapes",
    "Stroke": ".query.painting.painter",
    "Surface": ".query.regions.surfaces",
    "classify": ".query.regions.classify",
    "ends_in": ".query.selection.predicates",
    "index_of": ".query.painting.fiblet_index",
    "passes": ".query.selection.predicates",
    "stays_in": ".query.selection.predicates",
}

__getattr__, __dir__ = names_from(__name__, _HOME)
