"""Files of any number of points that are never held in memory, and what converting one takes: time and memory.

Lines like those of whole-brain tracking (0.5 mm steps, 250 points each) are written as a file, piece by piece, and
converted by ``pvfiblets.compress_file`` or, for other targets, by what ``pvfiblets convert`` calls.
"""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from pvfiblets import formats
from pvfiblets.formats.spool import gathered
from pvfiblets.streamlines import Streamlines

STEP, LENGTH, LINES = 0.5, 250, 2000
SEED = 0

# The peak is set back before each conversion. Not getrusage: that also remembers the process that started this one.
CONVERSIONS = """
import json, sys, time
import numba
from pvfiblets.cli.files import rewrite
from pvfiblets.codec.files import convert
from pvfiblets.codec import parameters
from pvfiblets.codec.small_sets import STATES

for state in STATES.values():
    state.loaded = True  # kernels, whose memory would be taken for growth where they are loaded halfway

def convert_one(source, target, chunk):
    if target.endswith(".fiblets"):
        convert.CHUNK_POINTS = chunk
        return convert.compress_file(source, target)
    return rewrite(source, target, chunk)

for source, target, chunk in json.loads(sys.argv[1]):
    parameters.SAMPLE = min(parameters.SAMPLE, chunk)  # kept lengths of segments; smaller where pieces are
    with open("/proc/self/clear_refs", "w") as peak:
        peak.write("5")
    wall, cpu = time.perf_counter(), time.process_time()
    result = convert_one(source, target, chunk)
    status = dict(line.split(":", 1) for line in open("/proc/self/status"))
    print(json.dumps({
        "points": result["points"], "streamlines": result["streamlines"], "bytes": result["bytes"],
        "error_mm": result["error_mm"], "promise_mm": result.get("promise_mm"), "dropped": result["dropped"],
        "seconds": time.perf_counter() - wall, "cpu_seconds": time.process_time() - cpu,
        "peak_mb": int(status["VmHWM"].split()[0]) / 1024, "threads": numba.get_num_threads(),
    }))
"""


def chunks(n_points: int, seed: int = SEED) -> Iterator[Streamlines]:
    """Yield lines of `n_points` points in all: one block of smooth walks, turned and moved anew each time."""
    rng = np.random.default_rng(seed)
    turns = rng.normal(size=(LINES, LENGTH, 3)) * 0.05
    turns[:, 0] = rng.normal(size=(LINES, 3))
    directions = np.cumsum(turns, axis=1)
    directions /= np.linalg.norm(directions, axis=2, keepdims=True)
    block = np.cumsum(STEP * directions, axis=1) + rng.uniform(-60.0, 60.0, (LINES, 1, 3))
    left = n_points
    while left > 0:
        turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
        points = (block.reshape(-1, 3) @ turn + rng.uniform(-10.0, 10.0, 3)).astype(np.float32)[:left]
        offsets = np.arange(0, len(points) + LENGTH, LENGTH)
        offsets[-1] = len(points)
        yield Streamlines(points, np.unique(offsets))
        left -= len(points)


def made(path: Path, n_points: int) -> Path:
    """Write a file of so many points without ever holding them, and return it."""
    with gathered(chunks(n_points), path.parent) as streamlines:
        formats.write(path, streamlines)
    return path


def converted(*jobs: tuple[Path, Path], chunk_points: int = 1 << 20) -> list[dict[str, Any]]:
    """Convert files, one after the other, in a process of their own; return what each took."""
    listed = json.dumps([(str(source), str(target), chunk_points) for source, target in jobs])
    done = subprocess.run([sys.executable, "-c", CONVERSIONS, listed], capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"the conversion of {jobs[0][0]} ended with {done.returncode}: {done.stderr}")
    rows = [json.loads(line) for line in done.stdout.splitlines()]
    for row, (source, target) in zip(rows, jobs, strict=True):
        row |= {"source": source.suffix, "target": target.suffix, "source_bytes": source.stat().st_size}
    return rows


def slope(rows: list[dict[str, Any]]) -> float:
    """Return bytes of peak memory per point, by least squares over conversions of unlike sizes."""
    points, peaks = (np.array([row[key] for row in rows], float) for key in ("points", "peak_mb"))
    return float(np.polyfit(points, peaks, 1)[0] * 2**20)
