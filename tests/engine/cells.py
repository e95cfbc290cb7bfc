"""The pixels of thin lines (``fiblets/segments/thin_line_rule.glsl``), in integers and float64, without the engine."""

from typing import NamedTuple

import numpy as np

from .polylines import inside_part, segments, to_clip, to_window

SHIFT_256 = np.array([23, 23])
"""CELL_SHIFT in 256ths of a pixel."""


def line_cells(p, q):
    """Pixels (n, 2) of a segment from pixel p to pixel q without the last, and place (n,) of each; exact."""
    run = np.asarray(q) - p
    major = int(abs(run[1]) > abs(run[0]))
    minor, n = 1 - major, int(np.abs(run).max())
    sign = -1 if run[major] < 0 else 1
    i = np.arange(n)
    at = np.empty((n, 2), np.int64)
    at[:, major] = sign * i
    # floor(1/2 + e_minor + (i - sign e_major) run_minor / n), over the common denominator 256 n
    top = (128 + SHIFT_256[minor]) * n + (256 * i - sign * SHIFT_256[major]) * int(run[minor])
    at[:, minor] = top // (256 * max(n, 1))
    place = ((at - SHIFT_256 / 256.0) @ run) / max(int(run @ run), 1)
    return p + at, place


class Reference(NamedTuple):
    """What thin lines are in a picture."""

    depth: np.ndarray  # (h, w), infinite where nothing is drawn
    streamline: np.ndarray  # (h, w)
    place: np.ndarray  # (h, w) along the streamline
    clear: np.ndarray  # (h, w) nothing that rounding may decide is near
    alone: np.ndarray  # (h, w) no other segment's depth is so near that rounding may decide


def thin_lines(lines, matrix, size, *, near_edge=2e-3, near_depth=4e-6):
    """Draw polylines by the rule.

    A point less than ``near_edge`` pixels from an edge between pixels may be rounded into either: pixels next to its
    segments are not ``clear``.
    """
    samples, doubtful = line_samples(lines, matrix, size, near_edge=near_edge)
    return _nearest(samples, doubtful, size, near_depth)


def line_samples(lines, matrix, size, *, near_edge=2e-3):
    """All pixels that polylines take by the rule.

    Returns
    -------
    samples : list of numpy.ndarray
        (n, 6) of each segment: x, y, depth, streamline, place along it, segment.
    doubtful : list of numpy.ndarray
        (n, 2) pixels of those segments an end of which may be rounded into another pixel.
    """
    a, b, streamline, first = segments(lines)
    ca, cb = to_clip(a, matrix), to_clip(b, matrix)
    low, high, kept = inside_part(ca, cb)
    last = np.array([i == max(len(lines[s]) - 2, 0) for s, i in zip(streamline, first, strict=True)])
    cap = last | (high < 1.0)  # where no segment goes on in the picture
    with np.errstate(divide="ignore", invalid="ignore"):
        wa, wb = (to_window(ca + t[:, None] * (cb - ca), size) for t in (low, high))
    top = np.array(size) - 0.01
    samples, doubtful = [], []
    for i in np.flatnonzero(kept):
        ends = np.array([wa[i, :2], wb[i, :2]])
        unsure = (np.abs(ends - np.rint(ends)) < near_edge).any()
        p, q = np.clip(ends, 0.0, top).astype(int)
        at, t = line_cells(p, q)
        if cap[i]:
            at, t = np.r_[at, [q]], np.r_[t, 1.0]
        if unsure:
            doubtful.append(np.r_[at, [p], [q]])
        if not len(at):
            continue
        z = (wa[i, 2] + (wb[i, 2] - wa[i, 2]) * t).clip(0.0, 1.0)
        u = np.clip(t * wa[i, 3] / np.maximum((1 - t) * wb[i, 3] + t * wa[i, 3], 1e-30), 0.0, 1.0)
        place = first[i] + (low[i] + (high[i] - low[i]) * u) * (len(lines[streamline[i]]) > 1)
        samples.append(np.c_[at, z, np.full(len(at), streamline[i]), place, np.full(len(at), i)])
    return samples, doubtful


def clear_of(doubtful, size):
    """(h, w) whether nothing that rounding may decide is near."""
    clear = np.ones((size[1], size[0]), bool)
    for at in doubtful:
        for dx in (-1, 0, 1):
            for dy in (-1, 0, 1):
                cells = (at + [dx, dy]).clip(0, np.array(size) - 1)
                clear[cells[:, 1], cells[:, 0]] = False
    return clear


def _nearest(samples, doubtful, size, near_depth):
    shape, clear = (size[1], size[0]), clear_of(doubtful, size)
    rows = np.concatenate(samples)
    cell = rows[:, 1].astype(int) * size[0] + rows[:, 0].astype(int)
    order = np.lexsort((rows[:, 2], cell))
    rows, cell = rows[order], cell[order]
    begins = np.r_[True, np.diff(cell) != 0]
    rival = np.r_[~begins[1:] & (np.diff(rows[:, 2]) < near_depth) & (np.diff(rows[:, 5]) != 0), False]
    depth, streamline, place = np.full(shape, np.inf), np.full(shape, -1), np.full(shape, np.nan)
    alone = np.ones(shape, bool)
    at = np.unravel_index(cell[begins], shape)
    depth[at], streamline[at], place[at] = rows[begins, 2], rows[begins, 3], rows[begins, 4]
    alone[at] = ~rival[begins]
    return Reference(depth, streamline, place, clear, alone)


def decided_by(p, q):
    """Pixels by which the nearest of all decisions along a segment was made."""
    run = np.asarray(q) - p
    major = int(abs(run[1]) > abs(run[0]))
    n, sign = int(np.abs(run).max()), -1 if run[major] < 0 else 1
    top = (128 + SHIFT_256[1 - major]) * n + (256 * np.arange(n) - sign * SHIFT_256[major]) * int(run[1 - major])
    rest = top % (256 * max(n, 1))
    return np.minimum(rest, 256 * n - rest).min(initial=256 * n) / (256 * max(n, 1))
