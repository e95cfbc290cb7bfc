"""Estimate of fiblets that are splines: bytes a point beside those of today, at the same bounds. None are built.

Usage: ``python docs/benchmarks/spline_fiblets.py FILE ...``; its table is in ``spline-fiblets.md``.

A streamline is cut greedily into cubic Hermite segments, each as long as the bounds allow: of every point (`promise`),
and of every direction (10 degrees, of segments that count). Nodes are coded in closed loop, from the decoded node
before: how many points it spans, its place less the straight continuation, and its tangent less that of a parabola,
each in three signed bytes of the frame of the tangent before.
"""

import math
import sys
from pathlib import Path

import numba
import numpy as np

import pvfiblets as pf
from pvfiblets.codec.tangents import PIXELS
from pvfiblets.synthetic.trackers import ALGORITHMS, tracked_streamlines

LONGEST = 62  # points that a segment spans
STRAIGHT = math.cos(math.radians(10.0))
NODE = 7.0  # bytes
RECORD = 22.0 / 8  # bytes a node of a fiblet's record, of eight nodes
LINES = 1500  # streamlines of a set that are coded


@numba.njit
def frame_of(tangent, frame):
    """Rows: the tangent, and two directions across."""
    frame[0] = tangent / math.sqrt((tangent**2).sum())
    across = np.zeros(3)
    across[np.argmin(np.abs(frame[0]))] = 1.0
    across -= (across * frame[0]).sum() * frame[0]
    frame[1] = across / math.sqrt((across**2).sum())
    frame[2] = np.cross(frame[0], frame[1])


@numba.njit
def slope(points, at, width):
    """Change of place from point to point about one of them, by a regression."""
    low, high = max(at - width, 0), min(at + width, len(points) - 1)
    middle, total, change = 0.5 * (low + high), 0.0, np.zeros(3)
    for j in range(low, high + 1):
        total += (j - middle) ** 2
        change += (j - middle) * points[j]
    return change / total


@numba.njit
def quantised(vector, frame, unit, codes):
    """Round a vector in a frame; its codes, and whether they fit."""
    found = np.zeros(3)
    fits = True
    for k in range(3):
        codes[k] = round((vector * frame[k]).sum() / unit)
        found += codes[k] * unit * frame[k]
        fits = fits and abs(codes[k]) <= 127
    return found, fits


@numba.njit
def fits(points, first, n, place, tangent, end, out, promise, least, drawn):
    """Whether a segment keeps the bounds; `drawn` gets its points."""
    drawn[0] = place
    for m in range(1, n + 1):
        x = m / n
        drawn[m] = (
            (2 * x**3 - 3 * x**2 + 1) * place + (x**3 - 2 * x**2 + x) * n * tangent
            + (3 * x**2 - 2 * x**3) * end + (x**3 - x**2) * n * out
        )  # fmt: skip
        if ((drawn[m] - points[first + m]) ** 2).sum() > promise**2:
            return False
        true, made = points[first + m] - points[first + m - 1], drawn[m] - drawn[m - 1]
        lengths = math.sqrt((true**2).sum() * (made**2).sum())
        if math.sqrt((true**2).sum()) > least and (true * made).sum() < STRAIGHT * lengths:
            return False
    return True


@numba.njit
def nodes_of(points, promise, least, codes, decoded):
    """Code a streamline; returns its nodes after the first, 0 where bytes or bounds do not suffice."""
    frame, drawn, best = np.empty((3, 3)), np.empty((LONGEST + 1, 3)), np.empty((LONGEST + 1, 3))
    place, tangent, first, nodes = points[0].copy(), slope(points, 0, 1), 0, 0
    own, bend = np.zeros(3), np.zeros(3)
    decoded[0] = place
    while first < len(points) - 1:
        frame_of(tangent, frame)
        good, missed = 0, 0
        end_kept, out_kept = place, tangent
        for n in range(1, min(LONGEST, len(points) - 1 - first) + 1):
            found = False
            straight = place + n * tangent
            moved, fine = quantised(points[first + n] - straight, frame, 0.7 * promise, own)
            end = straight + moved
            parabola = 2.0 * (end - place) / n - tangent
            for width in range(4):
                wanted = parabola if width == 3 else slope(points, first + n, width + 1)
                turned, close = quantised(wanted - parabola, frame, 1.5 * promise / n, bend)
                out = parabola + turned
                if fine and close and fits(points, first, n, place, tangent, end, out, promise, least, drawn):
                    found = True
                    break
            if found:
                good, end_kept, out_kept, missed = n, end, out, 0
                best[: n + 1] = drawn[: n + 1]
                codes[nodes, 0], codes[nodes, 1:4], codes[nodes, 4:7] = n, own, bend
            else:
                missed += 1
                if missed > 6:
                    break
        if good == 0 or not (out_kept**2).sum() > 0.0:
            return 0
        decoded[first : first + good + 1] = best[: good + 1]
        place, tangent, first, nodes = end_kept, out_kept, first + good, nodes + 1
    return nodes


def entropy(values):
    """Bits of a value."""
    share = np.unique(values, return_counts=True)[1] / len(values)
    return -(share * np.log2(share)).sum()


def coded(chosen, promise, least):
    """Return bytes a point of plain and entropy-coded nodes, points a node, share left, mean error, error of length."""
    taken = nodes = left = 0
    codes, errors, lengths = [], [], []
    for points in chosen:
        made, decoded = np.zeros((len(points), 7), np.int16), np.empty((len(points), 3))
        n = nodes_of(points, promise, least, made, decoded)
        if n == 0:
            left += len(points)
            continue
        taken, nodes = taken + len(points), nodes + n
        codes.append(made[:n])
        errors.append(np.linalg.norm(decoded - points, axis=1))
        long, true = (np.linalg.norm(np.diff(line, axis=0), axis=1).sum() for line in (decoded, points))
        lengths.append(abs(long / true - 1.0))
    if not nodes:
        return None
    packed = sum(map(entropy, np.concatenate(codes).T)) / 8
    sizes = [(size + RECORD) * nodes / taken for size in (NODE, packed)]
    return *sizes, taken / nodes, left / (left + taken), float(np.concatenate(errors).mean()), max(lengths)


def row(name, lines):
    """Measure a set."""
    fiblets = pf.compress(lines, exact=False, per_point="none")
    today = fiblets.nbytes / fiblets.n_points
    least = float(np.linalg.norm(np.ptp(lines.points, axis=0)) / PIXELS)
    chosen = [np.asarray(lines[i], np.float64) for i in np.random.default_rng(0).permutation(len(lines))[:LINES]]
    chosen = [points for points in chosen if len(points) > 3]
    step = float(np.median(np.linalg.norm(np.diff(lines.points, axis=0), axis=1)))
    ours = float(np.linalg.norm(fiblets.decompress().points - lines.points, axis=1).mean())
    cells = [name, f"{step:.3g}", f"{today:.2f}, {ours / step:.4f}"]
    for bound in (fiblets.promise, fiblets.promise / 5):
        found = coded(chosen, bound, least)
        if found is None:
            cells += ["none fits", "", ""]
            continue
        size, packed, spanned, left, error, length = found
        rest = f", {100 * left:.0f} % left" if left else ""
        cells += [f"{spanned:.1f}{rest}", f"{size:.2f} ({size / today:.2f}), {packed:.2f}"]
        cells.append(f"{error / step:.4f}, {100 * length:.2g} %")
    return f"| {' | '.join(cells)} |"


if __name__ == "__main__":
    for path in map(Path, sys.argv[1:]):
        print(row(path.name, pf.read(path)), flush=True)
    for algorithm in ALGORITHMS:
        print(row(f"{algorithm}, 0.1 mm", tracked_streamlines(algorithm, 400, 0.1)), flush=True)
    print(row("iFOD1, 0.5 mm", tracked_streamlines("iFOD1", 400, 0.5)), flush=True)
