"""How fast tractogram files load, beside nibabel, in one run.

    python benchmarks/loading.py [--tck FILE] [--repeat N] [--json OUT]

Without ``--tck`` a file of 15 million points is made: the real whole-brain file of
``../shared/data`` (or ``PVFIBLETS_DATA``) five times over, or random walks where it is missing.
Readers take turns, so that other load on the machine meets all of them alike; the table gives
the median and the best of N runs, and the ratio of the medians. The page cache is warm.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import tempfile
import time
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from pvfiblets import formats
from pvfiblets.streamlines import Streamlines

TILES = 5
REAL = "wholebrain_eudx_0.5mm_fifth.tck"


def made_file(folder: Path) -> Path:
    """Write a tck file of about 15 million points."""
    data = Path(os.environ.get("PVFIBLETS_DATA", Path(__file__).parents[2] / "shared" / "data"))
    if (data / REAL).is_file():
        part = formats.read(data / REAL)
    else:
        rng = np.random.default_rng(0)
        counts = rng.integers(20, 280, 20_500)
        steps = rng.normal(size=(counts.sum(), 3)).astype(np.float32)
        part = Streamlines(np.cumsum(steps, axis=0), np.concatenate([[0], np.cumsum(counts)]))
    path = folder / "large.tck"
    formats.write(path, Streamlines.concatenate([part] * TILES))
    return path


def nibabel_load(path: Path) -> Any:
    """Load with nibabel, which warns of what headers lack."""
    import nibabel

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return nibabel.streamlines.load(path).streamlines


def seconds_of(read: Callable[[Path], Any], path: Path) -> float:
    """Return the seconds that one reading takes, its result freed outside of the clock."""
    start = time.perf_counter()
    result = read(path)
    seconds = time.perf_counter() - start
    del result
    return seconds


def stream(path: Path) -> int:
    """Read piece by piece and keep nothing but the count."""
    return sum(piece.n_points for piece in formats.iter_chunks(path))


def measure(tck: Path, folder: Path, repeat: int) -> list[dict[str, Any]]:
    """Measure every format that holds the streamlines of `tck`."""
    whole = formats.read(tck)
    paths = [tck]
    for suffix in (".trk", ".trx"):
        paths.append(folder / f"large{suffix}")
        formats.write(paths[-1], whole)
    n_points, n_streamlines = whole.n_points, len(whole)
    del whole
    rows = []
    for path in paths:
        readers: dict[str, Callable[[Path], Any]] = {"ours": formats.read, "ours, in pieces": stream}
        if path.suffix != ".trx":
            readers["nibabel"] = nibabel_load
        times: dict[str, list[float]] = {name: [] for name in readers}
        for _ in range(repeat):
            for name, read in readers.items():
                times[name].append(seconds_of(read, path))
        medians = {name: statistics.median(t) for name, t in times.items()}
        for name, t in times.items():
            row = {
                "file": path.suffix,
                "reader": name,
                "streamlines": n_streamlines,
                "points": n_points,
                "bytes": path.stat().st_size,
                "seconds_median": medians[name],
                "seconds_best": min(t),
                "points_per_second": n_points / medians[name],
            }
            if "nibabel" in medians and name != "nibabel":
                row["times_nibabel"] = medians["nibabel"] / medians[name]
            rows.append(row)
    return rows


def main() -> None:
    """Run the benchmark and print its table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--tck", type=Path, help="file to measure with instead of the made one")
    parser.add_argument("--repeat", type=int, default=7)
    parser.add_argument("--json", type=Path, help="where to write the figures")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        rows = measure(options.tck or made_file(folder), folder, options.repeat)
    print(f"{'file':6} {'reader':16} {'median ms':>10} {'best ms':>9} {'M points/s':>11} {'ratio':>7}")
    for row in rows:
        ratio = f"{row['times_nibabel']:7.1f}" if "times_nibabel" in row else ""
        print(
            f"{row['file']:6} {row['reader']:16} {row['seconds_median'] * 1e3:10.1f} "
            f"{row['seconds_best'] * 1e3:9.1f} {row['points_per_second'] / 1e6:11.1f} {ratio:>7}"
        )
    if options.json:
        options.json.write_text(json.dumps(rows, indent=1))


if __name__ == "__main__":
    main()
