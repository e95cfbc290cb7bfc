"""Regions of space, for choosing streamlines and for cutting what is shown.

Shapes are combined by ``&`` (both), ``|`` (either), ``~`` (not) and ``-`` (without)::

    from pvfiblets import regions

    lesion = regions.Sphere((10.0, -22.0, 31.0), 8.0)
    left = regions.Plane((-1.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    region = lesion & left

Streamlines are chosen by where their points lie: ``passes(region)``, ``ends_in(region)`` and ``stays_in(region)``,
joined by ``&``, ``|`` and ``~``, for :meth:`.FibletSet.select`. ``Distance(region)`` measures how near they come.

Positions are mm. See :mod:`pvfiblets.codec.query.shapes` for how a region is kept.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from .later import names_from

if TYPE_CHECKING:
    from .codec.query.classify import classify
    from .codec.query.labels import Labels
    from .codec.query.measures import Distance
    from .codec.query.predicates import Predicate, ends_in, passes, stays_in
    from .codec.query.shapes import Box, Plane, Region, Shape, Slab, Sphere
    from .codec.query.surfaces import Surface

__all__ = [
    "Box",
    "Distance",
    "Labels",
    "Plane",
    "Predicate",
    "Region",
    "Shape",
    "Slab",
    "Sphere",
    "Surface",
    "classify",
    "ends_in",
    "passes",
    "stays_in",
]

_HOME = {
    "Box": ".codec.query.shapes",
    "Distance": ".codec.query.measures",
    "Labels": ".codec.query.labels",
    "Plane": ".codec.query.shapes",
    "Predicate": ".codec.query.predicates",
    "Region": ".codec.query.shapes",
    "Shape": ".codec.query.shapes",
    "Slab": ".codec.query.shapes",
    "Sphere": ".codec.query.shapes",
    "Surface": ".codec.query.surfaces",
    "classify": ".codec.query.classify",
    "ends_in": ".codec.query.predicates",
    "passes": ".codec.query.predicates",
    "stays_in": ".codec.query.predicates",
}

__getattr__, __dir__ = names_from(__name__, _HOME)
