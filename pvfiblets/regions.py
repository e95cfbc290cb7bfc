"""Regions of space, for choosing streamlines and for cutting what is shown.

Shapes are combined by ``&`` (both), ``|`` (either), ``~`` (not) and ``-`` (without)::

    from pvfiblets import regions

    lesion = regions.Sphere((10.0, -22.0, 31.0), 8.0)
    left = regions.Plane((-1.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    region = lesion & left

Positions are mm. See :mod:`pvfiblets.codec.query.shapes` for how a region is kept.
"""

from __future__ import annotations

from .codec.query.shapes import Box, Plane, Region, Shape, Slab, Sphere

__all__ = ["Box", "Plane", "Region", "Shape", "Slab", "Sphere"]
