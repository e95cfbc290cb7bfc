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
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ...support.array_types import Float64s, Int32s, UInt8s
from ..direction_codebook import CAP_DEGREES, CODES, cap_ratios, directions
from ..jit import kernel

CELLS = 256
TILE = 16  # cells along an edge of those whose candidates are first chosen together
EXTENT = 1.25  # turns a little beyond the cap angle are common in closed loop


class Candidates(NamedTuple):
    """Candidate codes of all cells of one cap angle, in compressed rows."""

    start: npt.NDArray[np.int32]  # (CELLS * CELLS + 1,)
    codes: npt.NDArray[np.uint8]


@kernel
def _direction(u: float, v: float, ratio: float) -> tuple[float, float, float]:
    """Direction at a point of the disc; beyond the antipode there is none, and the antipode stands in."""
    rho2 = u * u + v * v
    x = 1.0 - ratio * rho2
    if x <= -1.0:
        return -1.0, 0.0, 0.0
    lateral = math.sqrt(ratio * (1.0 + x))
    return x, lateral * u, lateral * v


@kernel
def _squared(a: Float64s, b: Float64s) -> float:
    return (a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 + (a[2] - b[2]) ** 2


@kernel
def _cell(i: int, j: int, ratio: float) -> tuple[float, ...]:
    """Direction of a cell's middle, and the largest chord from there to one of its corners."""
    size = 2.0 * EXTENT / CELLS
    x, y, z = _direction((i + 0.5) * size - EXTENT, (j + 0.5) * size - EXTENT, ratio)
    radius = 0.0
    for corner in range(4):
        a, b, c = _direction((i + (corner & 1)) * size - EXTENT, (j + (corner >> 1)) * size - EXTENT, ratio)
        radius = max(radius, math.sqrt((a - x) ** 2 + (b - y) ** 2 + (c - z) ** 2))
    return x, y, z, radius


@kernel
def _list_candidates(table: Float64s, ratio: float, start: Int32s, codes: UInt8s) -> int:
    tiles = CELLS // TILE
    cells = np.empty((CELLS, CELLS, 4))
    for j in range(CELLS):
        for i in range(CELLS):
            cells[j, i, 0], cells[j, i, 1], cells[j, i, 2], cells[j, i, 3] = _cell(i, j, ratio)
    # A code that a cell lists is no farther from the tile's middle m than the nearest code is, plus 2 max|cell - m| and
    # 2.2 radii.
    listed, count = np.empty((tiles, tiles, CODES), np.uint8), np.zeros((tiles, tiles), np.int64)
    distance = np.empty(CODES)
    for q in range(tiles):
        for p in range(tiles):
            middle = cells[q * TILE + TILE // 2, p * TILE + TILE // 2]
            reach = radius = 0.0
            for j in range(q * TILE, (q + 1) * TILE):
                for i in range(p * TILE, (p + 1) * TILE):
                    reach = max(reach, math.sqrt(_squared(cells[j, i], middle)))
                    radius = max(radius, cells[j, i, 3])
            nearest = 9.0
            for code in range(CODES):
                distance[code] = _squared(table[code], middle)
                nearest = min(nearest, distance[code])
            bound = (math.sqrt(nearest) + 2.0 * reach + 2.2 * radius + 2e-6) ** 2
            for code in range(CODES):
                if distance[code] <= bound:
                    listed[q, p, count[q, p]] = code
                    count[q, p] += 1
    total = 0
    for j in range(CELLS):
        for i in range(CELLS):
            start[j * CELLS + i] = total
            q, p = j // TILE, i // TILE
            nearest = 9.0
            for k in range(count[q, p]):
                distance[k] = _squared(table[listed[q, p, k]], cells[j, i])
                nearest = min(nearest, distance[k])
            # 2.2 radii instead of 2: the map from disc to sphere is not quite linear within a cell.
            bound = (math.sqrt(nearest) + 2.2 * cells[j, i, 3] + 1e-6) ** 2
            for k in range(count[q, p]):
                if distance[k] <= bound:
                    codes[total] = listed[q, p, k]
                    total += 1
    start[CELLS * CELLS] = total
    return total


@cache
def candidates(cap: int) -> Candidates:
    """Candidates of one cap angle."""
    if not 0 <= cap < len(CAP_DEGREES):
        raise IndexError(f"cap index {cap} is not in 0..{len(CAP_DEGREES) - 1}")
    start = np.empty(CELLS * CELLS + 1, np.int32)
    codes = np.empty(CELLS * CELLS * CODES, np.uint8)
    total = _list_candidates(directions()[cap], float(cap_ratios()[cap]), start, codes)
    return Candidates(start, codes[:total].copy())
