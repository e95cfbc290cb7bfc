"""Fiblets of splines (``effort="small"``) beside those of directions, at the same bounds.

Usage: ``python docs/benchmarks/spline_fiblets.py FILE ...``; the table is in ``spline-fiblets.md``.
"""

import sys
import tempfile
import time
from functools import partial
from pathlib import Path

import numpy as np

import pvfiblets as pf
from pvfiblets.codec.small_sets import STATES
from pvfiblets.synthetic.trackers import ALGORITHMS, tracked_streamlines


def seconds(function):
    """Return the least time of five calls and what the last one returned."""
    times = []
    for _ in range(5):
        begin = time.perf_counter()
        found = function()
        times.append(time.perf_counter() - begin)
    return min(times), found


def row(name, lines):
    """Measure a set."""
    cells = [name, f"{np.median(np.linalg.norm(np.diff(lines.points[:10_000], axis=0), axis=1)):.3g}"]
    sizes, figures = [], []
    for effort in ("fast", "small"):
        coding, fiblets = seconds(partial(pf.compress, lines, exact=False, per_point="none", effort=effort))
        decoding, decoded = seconds(partial(fiblets.decompress, dtype=np.float32))
        with tempfile.TemporaryDirectory() as folder:
            fiblets.save(Path(folder) / "a.fiblets", small=True)
            packed = (Path(folder) / "a.fiblets").stat().st_size
        error, lengths = pf.measure_error(lines, fiblets), lines.lengths()
        longer = np.abs(decoded.lengths() / np.where(lengths > 0.0, lengths, 1.0) - 1.0)[lengths > 0.0].max()
        sizes.append((fiblets.nbytes / fiblets.n_points, packed / fiblets.n_points))
        figures.append(
            f"{error.mean_steps:.3f}, {error.max_steps:.2f} | "
            + ("no segment" if np.isnan(error.max_degrees) else f"{error.mean_degrees:.1f}, {error.max_degrees:.1f}")
            + f" | {100 * longer:.2g} | {1e9 * coding / fiblets.n_points:.0f}, {1e9 * decoding / fiblets.n_points:.1f}"
        )
    (fast, fast_file), (small, small_file) = sizes
    cells += [f"{fast:.2f}, {small:.2f} ({small / fast:.2f})", f"{fast_file:.2f}, {small_file:.2f}", *figures]
    return f"| {' | '.join(cells)} |"


if __name__ == "__main__":
    for state in STATES.values():
        state.loaded = True
    row("", tracked_streamlines("EuDX", 20, 0.5))  # compiles
    for path in map(Path, sys.argv[1:]):
        print(row(path.name, pf.read(path)), flush=True)
    for algorithm in ALGORITHMS:
        print(row(f"{algorithm}, 0.1 mm", tracked_streamlines(algorithm, 400, 0.1)), flush=True)
    print(row("iFOD1, 0.5 mm", tracked_streamlines("iFOD1", 400, 0.5)), flush=True)
