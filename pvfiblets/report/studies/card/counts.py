"""How many lines each pixel has, by the rule of thin lines in whole numbers: for the card's check.

The rule (``shaders/fiblets/segments/thin_line_rule.glsl``): a segment runs from the pixel ``p`` of its first point to
the pixel ``q`` of its last, and takes ``n = max(|q - p|)`` pixels, ``q`` itself only where the polyline ends. Along its
longer axis it steps from pixel to pixel; across, it is at ``floor(1/2 + s + (i - t) run / n)``, where the shift
``(s, t)`` of 23/256 of a pixel decides what would be a tie.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

SHIFT = 23  # of 256

Array = npt.NDArray[np.float64]


def counted(lines: Sequence[Array], matrix: Array, size: tuple[int, int]) -> Array:
    """Return how many segments' pixels each pixel is: ``(height, width)`` float64, row 0 at the bottom."""
    clip = np.concatenate([line.astype(np.float64) for line in lines])
    clip = np.c_[clip, np.ones(len(clip))] @ np.asarray(matrix, np.float64).T
    if not (np.abs(clip[:, :3]) < clip[:, 3:]).all():
        raise ValueError("a point lies outside the view volume; look from where all can be seen")
    cells = np.floor((clip[:, :2] / clip[:, 3:] + 1.0) / 2.0 * size).astype(np.int64)
    ends = np.cumsum([len(line) for line in lines]) - 1
    joined = np.ones(len(cells), bool)
    joined[ends] = False
    p = cells[joined]
    run = cells[np.flatnonzero(joined) + 1] - p
    count = np.abs(run).max(axis=1)
    of = np.repeat(np.arange(len(p)), count)
    i = np.arange(len(of)) - np.repeat(np.cumsum(count) - count, count)
    major = (np.abs(run[:, 1]) > np.abs(run[:, 0])).astype(np.int64)[of]
    n, sign = count[of], np.sign(run[of, major])
    at = np.empty((len(of), 2), np.int64)
    at[np.arange(len(of)), major] = sign * i
    top = (128 + SHIFT) * n + (256 * i - sign * SHIFT) * run[of, 1 - major]
    at[np.arange(len(of)), 1 - major] = top // (256 * n)
    found = np.zeros((size[1], size[0]))
    for where in (p[of] + at, cells[ends]):
        np.add.at(found, (where[:, 1].clip(0, size[1] - 1), where[:, 0].clip(0, size[0] - 1)), 1.0)
    return found
