"""Compiled kernels: segments of spline tubes merged within an error bound.

Source: the outlook of Russig, Gumhold and Salm, "GPU-based raycasting of Hermite spline tubes" (2020), section 5: "a
pre-processor that automatically merges segments, observing a user-defined error bound".

A run of segments becomes the one Hermite segment ``q`` between its first and its last node. To bound the error, each
old segment is cut into two cubics, and each end of these gets its place ``t`` on ``q``: the nearest one, never before
the last. Between two places both curves are cubics of one parameter, and so is their difference, which does not leave
the hull of its Bezier points. The bound is hence exact, whatever the places are: good places make it tight. As they
cover ``q`` in order, it holds for distances both ways (it bounds the Fréchet distance).

Columns are scaled so that each may differ by 1: x, y, z (together), the radius, and values.
"""

from __future__ import annotations

import numba
import numpy as np

from pvfiblets.codec.jit import kernel, parallel_kernel
from pvfiblets.support.array_types import Bools, Float64s, Int64s

_STEPS = 2  # of Gauss and Newton's method, from a place in proportion to length to the nearest place
_DRAWN = 1.0 / 54.0  # `curves.py`: the drawn halves leave a cubic by at most this share of its third difference


@kernel
def find_chains(follower: Int64s, order: Int64s, offsets: Int64s) -> int:
    """Put segments into the order in which they follow each other, and return the number of chains."""
    n = len(follower)
    is_follower, done = np.zeros(n, np.bool_), np.zeros(n, np.bool_)
    for each in follower:
        if each >= 0:
            is_follower[each] = True
    count, place = 0, 0
    for rings in (False, True):  # the remaining segments, without a first one
        for first in range(n):
            if done[first] or (is_follower[first] and not rings):
                continue
            at = first
            while at >= 0 and not done[at]:
                done[at] = True
                order[place] = at
                place += 1
                at = follower[at]
            count += 1
            offsets[count] = place
    return count


@kernel
def _value(t: float, chord: float, slope: float, end_slope: float) -> float:
    """Return the Hermite cubic that begins at 0."""
    return t * t * (3.0 - 2.0 * t) * chord + t * (1.0 - t) ** 2 * slope - t * t * (1.0 - t) * end_slope


@kernel
def _derivative(t: float, chord: float, slope: float, end_slope: float) -> float:
    rest = 1.0 - t
    return 6.0 * t * rest * chord + rest * (1.0 - 3.0 * t) * slope + t * (3.0 * t - 2.0) * end_slope


@kernel
def _controls(start: float, stop: float, slope: float, end_slope: float, half: int) -> tuple[float, ...]:
    """Return the Bezier points of the first or the second half of a Hermite cubic."""
    b, c = start + slope / 3.0, stop - end_slope / 3.0
    ab, bc, cd = 0.5 * (start + b), 0.5 * (b + c), 0.5 * (c + stop)
    abc, bcd = 0.5 * (ab + bc), 0.5 * (bc + cd)
    middle = 0.5 * (abc + bcd)
    if half == 0:
        return start, ab, abc, middle
    return middle, bcd, cd, stop


@kernel
def _nearest(nodes: Float64s, slopes: Float64s, first: int, last: int, scales: Float64s, aim: Float64s, t: float,
             least: float) -> float:  # fmt: skip
    """Return where the merged segment is nearest to a point, which counts from its start; not before `least`."""
    for _ in range(_STEPS):
        along, square = 0.0, 0.0
        for k in range(3):
            chord = nodes[last, k] - nodes[first, k]
            slope, end_slope = scales[0] * slopes[first, k], scales[1] * slopes[last, k]
            speed = _derivative(t, chord, slope, end_slope)
            along += (aim[k] - _value(t, chord, slope, end_slope)) * speed
            square += speed * speed
        if square > 0.0:
            t += along / square
        t = min(max(t, least), 1.0)
    return t


@kernel
def _fits(nodes: Float64s, slopes: Float64s, chords: Float64s, scaled: bool, tolerance: float, first: int, last: int,
          scales: Float64s, aim: Float64s) -> bool:  # fmt: skip
    """Return whether the segment from row `first` to row `last` stays within the bound of the rows between."""
    # Comparisons are such that NaN, as where numbers overflow, does not fit.
    total, square = 0.0, 0.0
    for row in range(first, last):
        total += chords[row]
    for k in range(3):
        square += (nodes[last, k] - nodes[first, k]) ** 2
    if scaled:
        scales[:] = tolerance * np.sqrt(square)
    else:
        scales[0], scales[1] = total / chords[first], total / chords[last - 1]
    # The halves that are drawn in place of the cubic may not leave the bound either, nor may `curves.controls` have
    # to raise their radii to 0.
    square = 0.0
    for k in range(3):
        chord = nodes[last, k] - nodes[first, k]
        square += (scales[0] * slopes[first, k] + scales[1] * slopes[last, k] - 2.0 * chord) ** 2
    drawn = _DRAWN * np.sqrt(square)
    if not (drawn <= 1.0 and nodes[first, 3] + 0.25 * scales[0] * slopes[first, 3] >= 0.0
            and nodes[last, 3] - 0.25 * scales[1] * slopes[last, 3] >= 0.0):  # fmt: skip
        return False
    passed, begin = 0.0, 0.0
    for row in range(first, last):
        scale = chords[row] if scaled else 1.0
        for half in range(2):
            passed += 0.5 * chords[row]
            end = 1.0
            if half == 0 or row + 1 < last:
                for k in range(3):
                    aim[k] = nodes[row + half, k] - nodes[first, k]
                    if half == 0:
                        aim[k] += 0.5 * (nodes[row + 1, k] - nodes[row, k])
                        aim[k] += 0.125 * scale * (slopes[row, k] - slopes[row + 1, k])
                guess = passed / total if total > 0.0 else (row - first) / (last - first)
                end = _nearest(nodes, slopes, first, last, scales, aim, guess, begin)
            third = (end - begin) / 3.0
            s0 = s1 = s2 = s3 = 0.0
            for k in range(nodes.shape[1]):
                chord = nodes[last, k] - nodes[first, k]
                slope, end_slope = scales[0] * slopes[first, k], scales[1] * slopes[last, k]
                start, stop = _value(begin, chord, slope, end_slope), _value(end, chord, slope, end_slope)
                a, b, c, d = _controls(nodes[row, k] - nodes[first, k], nodes[row + 1, k] - nodes[first, k],
                                       scale * slopes[row, k], scale * slopes[row + 1, k], half)  # fmt: skip
                a -= start
                b -= start + third * _derivative(begin, chord, slope, end_slope)
                c -= stop - third * _derivative(end, chord, slope, end_slope)
                d -= stop
                if k < 3:
                    s0, s1, s2, s3 = s0 + a * a, s1 + b * b, s2 + c * c, s3 + d * d
                else:
                    rest = 1.0 - _DRAWN * abs(slope + end_slope - 2.0 * chord)
                    if not (abs(a) <= rest and abs(b) <= rest and abs(c) <= rest and abs(d) <= rest):
                        return False
            rest = (1.0 - drawn) ** 2
            if not (s0 <= rest and s1 <= rest and s2 <= rest and s3 <= rest):
                return False
            begin = end
    return True


@parallel_kernel
def merge(nodes: Float64s, slopes: Float64s, chords: Float64s, ids: Int64s, offsets: Int64s, scaled: bool,
          tolerance: float, kept: Bools) -> None:  # fmt: skip
    """Keep few rows of each chain: from each kept row on, a run that is as long as fits, found by bisection."""
    for chain in numba.prange(len(offsets) - 1):
        scales, aim = np.empty(2), np.empty(3)
        first, end = offsets[chain], offsets[chain + 1] - 1
        kept[first] = True
        while first < end:
            good, step, bad = 1, 2, end - first + 1
            while good + 1 < bad:
                # A ring that became one segment would have no length.
                if ids[first] != ids[first + step] and _fits(
                    nodes, slopes, chords, scaled, tolerance, first, first + step, scales, aim
                ):
                    good = step
                else:
                    bad = step
                step = min(2 * good, bad - 1) if bad > end - first else (good + bad) // 2
            first += good
            kept[first] = True
