"""Cuts of streamlines, as a page has them: planes, and regions of other shapes."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from pvfiblets.engine.regions.clip_planes import placed_sides, planes_of
from pvfiblets.engine.view import MAX_CLIP_PLANES
from pvfiblets.query.regions.shapes import SPHERE, SURFACE

OF_THE_READER = 2  # planes of the slab that a page's reader may cut with, which shares the places of clip planes


def cuts_of(planes: npt.NDArray[np.float64], region: Any) -> tuple[dict[str, Any], bool]:
    """Return what cuts streamlines."""
    flat, rest = planes_of(region, max(MAX_CLIP_PLANES - OF_THE_READER - len(planes), 0))
    planes = np.concatenate([planes, flat])
    found: dict[str, Any] = {"planes": planes.tolist()} if len(planes) else {}
    if rest is None:
        return found, True
    if any(leaf.kind == SURFACE for leaf in rest.leaves):
        return found, False
    leaves = []
    for leaf in rest.leaves:
        shape = {"ball": leaf.matrix[:3]} if leaf.kind == SPHERE else {"planes": placed_sides(leaf)}
        leaves.append({"centre": leaf.centre.tolist(), **{key: rows.tolist() for key, rows in shape.items()}})
    return {**found, "cut": {"leaves": leaves, "program": list(rest.program)}}, True
