"""Exact nearest code without trying all 256: candidates by cell of the disc.

The disc of :mod:`~pvfiblets.codec.direction_codebook` is cut into square cells. For each cap angle and cell the codes
that can be nearest to *some* direction of the cell are listed: those no farther from the cell's middle than the
nearest one plus the cell's own diameter. Most cells list one code; where they list more, the encoder compares them, so
that the answer is the same as that of a search through the whole table. Directions beyond the cells are searched in
full.
"""

from __future__ import annotations

import math
from functools import cache
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .direction_codebook import CAP_DEGREES, CODES, cap_ratios, directions
from .jit import kernel

__all__ = ["CELLS", "EXTENT", "Candidates", "candidates"]

CELLS = 256
EXTENT = 1.25  # turns a little beyond the cap angle are common in closed loop


class Candidates(NamedTuple):
    """Candidate codes of all cells of one cap angle, in compressed rows."""

    start: npt.NDArray[np.int32]  # (CELLS * CELLS + 1,)
    codes: npt.NDArray[np.uint8]


@kernel
def _direction(u: float, v: float, ratio: float) -> Any:
    """Direction at a point of the disc; beyond the antipode there is none, and the antipode stands in."""
    rho2 = u * u + v * v
    x = 1.0 - ratio * rho2
    if x <= -1.0:
        return -1.0, 0.0, 0.0
    lateral = math.sqrt(ratio * (1.0 + x))
    return x, lateral * u, lateral * v


@kernel
def _list_candidates(table: Any, ratio: float, start: Any, codes: Any) -> int:
    cell = 2.0 * EXTENT / CELLS
    distance = np.empty(CODES)
    tx, ty, tz = table[:, 0].copy(), table[:, 1].copy(), table[:, 2].copy()
    total = 0
    for j in range(CELLS):
        for i in range(CELLS):
            start[j * CELLS + i] = total
            x, y, z = _direction((i + 0.5) * cell - EXTENT, (j + 0.5) * cell - EXTENT, ratio)
            radius = 0.0
            for corner in range(4):
                a, b, c = _direction((i + (corner & 1)) * cell - EXTENT, (j + (corner >> 1)) * cell - EXTENT, ratio)
                radius = max(radius, math.sqrt((a - x) ** 2 + (b - y) ** 2 + (c - z) ** 2))
            nearest = 9.0
            for code in range(CODES):
                distance[code] = (tx[code] - x) ** 2 + (ty[code] - y) ** 2 + (tz[code] - z) ** 2
                nearest = min(nearest, distance[code])
            # 2.2 radii instead of 2: the map from disc to sphere is not quite linear within a cell.
            bound = (math.sqrt(nearest) + 2.2 * radius + 1e-6) ** 2
            for code in range(CODES):
                if distance[code] <= bound:
                    codes[total] = code
                    total += 1
    start[CELLS * CELLS] = total
    return total


@cache
def candidates(cap: int) -> Candidates:
    """Candidates of one cap angle.

    Parameters
    ----------
    cap : int
        Index into :data:`~pvfiblets.codec.direction_codebook.CAP_DEGREES`.

    Returns
    -------
    Candidates
        Row ``j * CELLS + i`` lists the codes of the cell whose lower corner is ``(i, j) * 2 EXTENT / CELLS - EXTENT``.
    """
    if not 0 <= cap < len(CAP_DEGREES):
        raise IndexError(f"cap index {cap} is not in 0..{len(CAP_DEGREES) - 1}")
    start = np.empty(CELLS * CELLS + 1, np.int32)
    codes = np.empty(CELLS * CELLS * CODES, np.uint8)
    total = _list_candidates(directions()[cap], float(cap_ratios()[cap]), start, codes)
    return Candidates(start, codes[:total].copy())
