"""Pictures drawn by workers: frames a second, bytes moved, and a model of both for more workers than there are.

    python benchmarks/cluster.py [--streamlines N] [--workers N ...] [--frames N] [--card-rate N] [--json OUT]

Each row is a cluster of processes on this machine. Its *model* is made of what one worker measures that draws the same
number of parts one after another: the time of each part, of each pair of pictures that is put together, and what is
left of a frame (*rest*), which dask's messages take. Parts are given to whichever processor is free, pairs to one each;
what is sent is sent at the rate that a copy between two workers was measured at. A software OpenGL draws by one thread
in each worker, which stands for its card: by default one worker would take all processors already. The second table
uses the same parts for workers with one graphics card each: how fast that draws is given, and stands in the table's
title; nothing here has measured it.
"""

from __future__ import annotations

import argparse
import heapq
import json
import math
import os
import statistics
import tempfile
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

import pvfiblets
from pvfiblets.cluster.connection import connected
from pvfiblets.engine import FibletStyle, View
from pvfiblets.engine.fiblets.parts.cluster_renderer import ClusterRenderer
from pvfiblets.engine.gl.standalone import bare_context
from pvfiblets.report.studies.stability.render_checks import camera
from pvfiblets.synthetic import brain_streamlines

PIXEL_BYTES = 24  # of a pixel that shows something: place, depth, part, streamline, tangent, position, value


@dataclass(frozen=True)
class Measured:
    """Medians over the frames of one cluster.

    Attributes
    ----------
    workers, parts : int
    frame, rest : float
        Seconds of a frame, and what of it neither drawing nor merging explains.
    draws, merges : list of float
        Seconds of each part, and of each pair.
    bytes : float
        Of all pictures that were made, about as many as are moved.
    pixels : float
        That show something.
    """

    workers: int
    parts: int
    frame: float
    rest: float
    draws: list[float]
    merges: list[float]
    bytes: float
    pixels: float


def frames_of(ctx: Any, fiblets: Any, workers: int, parts: int, frames: int, size: tuple[int, int]) -> Measured:
    """Draw a turn of the camera."""
    style = FibletStyle()
    with connected(None, workers, None, dashboard=False) as client:
        renderer = ClusterRenderer(ctx, fiblets, client, count=parts)
        seconds, told = [], []
        for number in range(frames + 2):  # two to warm up: contexts, programs, records
            angle = 0.05 * number
            eye = (300.0 * math.sin(angle), -300.0 * math.cos(angle), 40.0)
            view = View(size, camera(size, eye=eye, target=(0, -10, 20), far=900.0))
            begun = time.perf_counter()
            renderer.render(view, style)
            ctx.finish()
            seconds.append(time.perf_counter() - begun)
            told.append(renderer.explain()["cluster"])
        renderer.release()
    told, seconds = told[2:], seconds[2:]
    draws = np.median([sorted(one["draw_ms"]) for one in told], axis=0) / 1e3
    merges = np.median([sorted(one["merge_ms"]) for one in told], axis=0) / 1e3 if parts > 1 else np.zeros(0)
    frame = statistics.median(seconds)
    moved = statistics.median(one["bytes"] for one in told)
    pixels = moved / (2 * parts - 1) / PIXEL_BYTES
    return Measured(
        workers, parts, frame, frame - draws.sum() - merges.sum(), draws.tolist(), merges.tolist(), moved, pixels
    )


def predicted(alone: Measured, workers: int, processors: int) -> float:
    """Seconds of a frame of so many workers, by what one has measured that draws as many parts."""
    slots = [0.0] * min(workers, processors)
    for seconds in sorted(alone.draws, reverse=True):
        heapq.heappush(slots, heapq.heappop(slots) + seconds)
    levels = math.ceil(math.log2(alone.parts)) if alone.parts > 1 else 0
    merge = statistics.mean(alone.merges) if alone.merges else 0.0
    return max(slots) + levels * merge + alone.rest


def rest_of(found: list[tuple[int, float]]) -> Callable[[int], float]:
    """Return what dask takes of a frame by the number of parts: a line through what was measured."""
    if len(found) < 2:
        return lambda parts: found[0][1] * parts
    slope, at_none = np.polyfit([parts for parts, _ in found], [rest for _, rest in found], 1)
    return lambda parts: float(max(at_none, 0.0) + max(slope, 0.0) * parts)


def far(
    segments: float, workers: int, rate: float, pixels: int, merge: float, rest: Callable[[int], float], network: float
) -> dict[str, Any]:
    """Return what a frame of many workers with a card each takes: seconds of drawing, merging, sending and the rest."""
    levels = math.ceil(math.log2(workers))
    sent = pixels * PIXEL_BYTES
    return {
        "workers": workers,
        "draw": segments / workers / rate,
        "merge": levels * merge * pixels,
        "send": (levels + 1) * sent / network,
        "rest": rest(workers),
        "gigabytes": 1.4 * segments / workers / 1e9,
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--streamlines", type=int, default=20_000)
    parser.add_argument("--workers", type=int, nargs="+", default=[1, 2, 3, 4])
    parser.add_argument("--frames", type=int, default=7)
    parser.add_argument("--size", type=int, nargs=2, default=(1280, 720))
    parser.add_argument("--card-rate", type=float, default=1e9, help="segments/s of a card (default 1e9)")
    parser.add_argument("--network", type=float, default=1.25e9, help="bytes a second between workers (default 1.25e9)")
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    size, processors = tuple(options.size), len(os.sched_getaffinity(0))
    rows: list[dict[str, Any]] = []
    os.environ.setdefault("LP_NUM_THREADS", "1")  # workers inherit it
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "brain.fiblets"
        pvfiblets.compress(brain_streamlines(options.streamlines, 0.5)).save(path)
        fiblets = pvfiblets.FibletSet.open(path)
        segments = fiblets.n_points - fiblets.n_ranks
        ctx = bare_context()
        where = f"{processors} processors, {ctx.info['GL_RENDERER']}"
        print(f"{segments / 1e6:.1f} M segments, {size[0]} x {size[1]}, {where}")
        print("\n| workers | frame, ms | model, ms | off, % | drawing, ms | merging, ms | rest, ms | moved, MB |")
        print("|---|---|---|---|---|---|---|---|")
        merges, rests = [], []
        for workers in options.workers:
            alone = frames_of(ctx, fiblets, 1, workers, options.frames, size)
            found = alone if workers == 1 else frames_of(ctx, fiblets, workers, workers, options.frames, size)
            model = predicted(alone, workers, processors)
            merges += [seconds / alone.pixels for seconds in alone.merges]
            rests.append((workers, alone.rest))
            rows.append({"alone": asdict(alone), "found": asdict(found), "model": model})
            print(
                f"| {workers} | {1e3 * found.frame:.0f} | {1e3 * model:.0f} | {100 * (model / found.frame - 1):+.0f} | "
                f"{1e3 * max(found.draws):.0f} | {1e3 * sum(found.merges):.0f} | {1e3 * alone.rest:.0f} | "
                f"{found.bytes / 1e6:.1f} |",
                flush=True,
            )
    merge = statistics.median(merges) if merges else 0.0
    pixels = size[0] * size[1]
    print(
        f"\n10^11 segments, every pixel covered, if a card draws {options.card_rate:.3g} segments/s (not measured) and "
        f"{options.network:.3g} bytes/s go between workers:\n"
    )
    print("| workers | drawing, ms | merging, ms | sending, ms | dask, ms | frame, ms | memory of a card, GB |")
    print("|---|---|---|---|---|---|---|")
    more = [
        far(1e11, n, options.card_rate, pixels, merge, rest_of(rests), options.network) for n in (16, 32, 64, 128, 256)
    ]
    for one in more:
        parts = [1e3 * one[name] for name in ("draw", "merge", "send", "rest")]
        shown = " | ".join(f"{part:.0f}" for part in (*parts, sum(parts)))
        print(f"| {one['workers']} | {shown} | {one['gigabytes']:.1f} |")
    if options.json:
        options.json.write_text(json.dumps({"local": rows, "far": more}, indent=1))


if __name__ == "__main__":
    main()
