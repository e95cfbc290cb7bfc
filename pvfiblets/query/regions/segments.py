"""The parts of a segment in a region, exactly: in shares ``t`` of the segment, from 0 to 1, in float64.

Each shape holds some spans of a segment:

- a plane's half-space, a slab, a box or a ball one span, from the segment's ends in the shape's unit coordinates: where
  linear functions change sign, and the roots of a quadratic one. Its ends belong to it: what touches, is in.
- a closed surface the spans between the triangles that the segment meets where the winding number is not 0.
- labels the spans of the walk through their voxels, as density maps count them: a voxel touched only at
  an edge or a corner is not passed.

The spans' ends of all shapes cut a segment into parts, each wholly inside or outside of every shape; so the
region's expression is evaluated once on each part and once on each end. Ends that differ by less than `TOGETHER` of the
segment's length count as one: where two shapes share a face, rounding puts their crossings side by side.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .region import pack_rows

if TYPE_CHECKING:
    from .region import Region

TOGETHER = 1e-9


def segment_flags(
    region: Region, a: npt.NDArray[np.float64], b: npt.NDArray[np.float64]
) -> npt.NDArray[np.uint8]:
    """Return of segments from ``a`` to ``b``, ``(m, 3)`` mm: 1 if some place between is in, plus 2 if some is not."""
    from . import segment_kernels as kernels

    ops, rows = pack_rows(region)
    places = np.full(len(region.leaves), -1)
    firsts: list[npt.NDArray[np.int64]] = []
    spans: list[npt.NDArray[np.float64]] = []
    total = 0
    for i, leaf in enumerate(region.leaves):
        found = leaf.spans(a, b)
        if found is not None:
            places[i] = len(firsts)
            firsts.append(found[0] + total)
            spans.append(found[1])
            total += len(found[1])
    first = np.stack(firsts) if firsts else np.zeros((0, 0), np.int64)
    held = np.concatenate(spans) if spans else np.zeros((0, 2))
    out = np.empty(len(a), np.uint8)
    kernels.combine(ops, rows, places, first, held, a, b, TOGETHER if len(rows) > 1 else 0.0, out)
    return out


def counted_spans(
    kernel: Any, shape: tuple[Any, ...], a: npt.NDArray[np.float64], b: npt.NDArray[np.float64]
) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.float64]]:
    """Return the spans of a kernel that counts them first, such as :func:`.segment_kernels.label_spans`."""
    first = np.zeros(len(a) + 1, np.int64)
    kernel(*shape, a, b, first, np.empty((0, 2)), False)
    np.cumsum(first, out=first)
    spans = np.empty((int(first[-1]), 2))
    kernel(*shape, a, b, first, spans, True)
    return first, spans
