"""Synthetic tractograms with the look and statistics of whole-brain tracking: points, or compressed sets."""

from __future__ import annotations

from .brain import brain
from .tracking import BUNDLES, LENGTHS, SMALLEST_RADIUS, brain_streamlines, iter_brain_streamlines, streamline_count
from .tubes import TUBE_SETS, tube_set

__all__ = [
    "BUNDLES",
    "LENGTHS",
    "SMALLEST_RADIUS",
    "TUBE_SETS",
    "brain",
    "brain_streamlines",
    "iter_brain_streamlines",
    "streamline_count",
    "tube_set",
]
