"""Painted regions: how soon streamlines are told after a stroke, with the spatial index and without.

    python benchmarks/regions.py [--streamlines 1e5 1e6 1e7] [--radius 2 5 10] [--folder DIR] [--output DIR]

Brain-like sets are made, each with its index in a second file. On a grid of 1 mm, balls of each radius are painted at
points of streamlines, then one is dragged along a streamline by 1 mm at a time, then balls are erased. Each answer is
the number of streamlines that pass the region, and which. Beside it stands the query that takes no index
(``fiblets.select(passes(region, sampling="points"))``), of the region after the stroke. It tests the points alone: how
many streamlines it misses that pass between two points is its error. The index's own answer is compared with that of a
new region whose near fiblets are all decoded.

Ten million streamlines take 3.7 GB of disk and 2 GB of memory.
"""

from __future__ import annotations

import argparse
import json
import tempfile
import time
from collections.abc import Callable
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from common import record

from pvfiblets import FibletSet, regions
from pvfiblets.query.painting.live import LiveRegion
from pvfiblets.report.machine import about
from pvfiblets.synthetic import brain

STROKES = 15  # of each radius; one more is not counted
DRAGGED = 30


def made(folder: Path, streamlines: int, step: float) -> Path:
    """Return a file of a set that has no index."""
    path = folder / f"{streamlines}-{step:g}.fiblets"
    if not path.exists():
        brain(streamlines, step, path=path)
    return path


def indexed(path: Path) -> tuple[Path, dict[str, Any]]:
    """Return a file of the same set with its index, and what that takes."""
    data, target = FibletSet.open(path), path.with_suffix(".indexed.fiblets")
    regions.index_of(data[:100])  # compiles
    cpu, index = time.process_time(), regions.index_of(data)
    facts = {"index_bytes": index.nbytes, "index_seconds": index.seconds, "index_cpu": time.process_time() - cpu}
    data.save(target)
    return target, facts | {"bytes": path.stat().st_size, "fiblets": data.n_fiblets}


class Strokes:
    """A region on a grid of 1 mm about a set, and how long its answers take."""

    def __init__(self, data: FibletSet) -> None:
        low = np.floor(np.array(data.bounds)[::2]) - 1.0
        place = np.eye(4)
        place[:3, 3] = low
        shape = tuple(int(n) for n in np.ceil(np.array(data.bounds)[1::2] - low) + 2)
        self.painter = regions.RegionPainter((shape, place))
        self.painter.add("a")
        self.live = regions.LiveRegions(data, self.painter)
        self.region = self.live.region("a")
        self.rows: list[tuple[float, float, int, int]] = []

    def do(self, stroke: Callable[[], Any]) -> None:
        """Paint, ask, and note wall and processor time, and fiblets."""
        wall, cpu = time.perf_counter(), time.process_time()
        stroke()
        self.live.select(include="a")
        taken = time.perf_counter() - wall, time.process_time() - cpu
        self.rows.append((*taken, self.region.looked_at, self.region.decoded))

    def told(self) -> dict[str, Any]:
        """Medians of the strokes but the first, and the worst."""
        rows, self.rows = np.array(self.rows[1:]), []
        wall, cpu, near, decoded = np.median(rows, axis=0)
        return {"ms": 1e3 * wall, "cpu_ms": 1e3 * cpu, "worst_ms": 1e3 * float(rows[:, 0].max()),
                "near": int(near), "decoded": int(decoded)}  # fmt: skip


def measure(path: Path, radii: list[float], *, query: bool) -> list[dict[str, Any]]:
    """Rows of one set."""
    data, rows = FibletSet.open(path), []
    rng = np.random.default_rng(0)
    lines = data.decompress(np.sort(rng.choice(len(data), 40, replace=False)))
    places = lines.points[rng.integers(len(lines.points), size=STROKES + 1)]
    longest = lines[int(np.argmax(lines.lengths()))]
    way = longest[:: max(round(1.0 / max(data.step, 1e-9)), 1)][: DRAGGED + 2]
    for radius in radii:
        strokes = Strokes(data)
        painter = strokes.painter
        for at in places:
            strokes.do(partial(painter.paint, "a", at, radius))
        rows.append({"radius": radius, "act": "balls painted", **strokes.told(), **without(data, strokes, query=query)})
        for at in places[::-1]:
            strokes.do(partial(painter.erase, at, radius))
        rows.append({"radius": radius, "act": "balls erased", **strokes.told()})
        painter.paint("a", way[0], radius)
        for a, b in pairwise(way):
            strokes.do(partial(painter.paint, "a", [a, b], radius))
        rows.append({"radius": radius, "act": "dragged by 1 mm", **strokes.told()})
    return rows


def without(data: FibletSet, strokes: Strokes, *, query: bool) -> dict[str, Any]:
    """In how many streamlines decoding all near fiblets differs; and the same region asked of all points at once."""
    exact, painter = strokes.live.select(include="a"), strokes.painter
    decoded = LiveRegion(data, painter.grid)
    there = np.flatnonzero(painter.mask("a").ravel())
    decoded.change(there, np.ones(len(there), bool))
    differs = int(((decoded.flags() & 1 != 0) != exact).sum())  # flags begins anew, and decodes all that is near
    found = {"passing": int(exact.sum()), "differs": differs}
    if not query:
        return found
    begin, cpu = time.perf_counter(), time.process_time()
    points = data.select(regions.passes(painter.region("a"), sampling="points"))
    taken = {"query_ms": 1e3 * (time.perf_counter() - begin), "query_cpu_ms": 1e3 * (time.process_time() - cpu)}
    return found | taken | {"missed": int((exact & ~points).sum()), "added": int((points & ~exact).sum())}


def to_page(facts: dict[str, Any], sets: list[dict[str, Any]]) -> str:
    """Return the page."""
    lines = [
        "# Painted regions: answers after a stroke", "",
        f"{facts['cores']} CPU cores ({facts['processor']}), {facts['date']}. Milliseconds by the clock and of the "
        "processor, all cores together: medians, and the worst by the clock.", "",
        "| streamlines | fiblets | file, MB | index, MB | bytes a fiblet | made in, s (of the processor) |",
        "|---|---|---|---|---|---|",
    ]  # fmt: skip
    lines += [
        f"| {s['streamlines']:,} | {s['fiblets']:,} | {s['bytes'] / 1e6:.0f} | {s['index_bytes'] / 1e6:.0f} "
        f"| {s['index_bytes'] / s['fiblets']:.1f} | {s['index_seconds']:.1f} ({s['index_cpu']:.1f}) |"
        for s in sets
    ]
    lines += ["", "| streamlines | radius, mm | stroke | ms | processor | worst | fiblets near | decoded "
              "| without index: ms | processor |", "|---|---|---|---|---|---|---|---|---|---|"]  # fmt: skip
    for s in sets:
        for row in s["rows"]:
            asked = f"{row['query_ms']:.0f} | {row['query_cpu_ms']:.0f}" if "query_ms" in row else " | "
            lines.append(
                f"| {s['streamlines']:,} | {row['radius']:g} | {row['act']} | {row['ms']:.0f} | {row['cpu_ms']:.0f} | "
                f"{row['worst_ms']:.0f} | {row['near']:,} | {row['decoded']:,} | {asked} |"
            )
    lines += ["", "| streamlines | radius, mm | pass | differ from decoding all | missed by points alone | added |",
              "|---|---|---|---|---|---|"]  # fmt: skip
    lines += [
        f"| {s['streamlines']:,} | {r['radius']:g} | {r['passing']:,} | {r['differs']} | {r.get('missed', '')} "
        f"| {r.get('added', '')} |"
        for s in sets
        for r in s["rows"]
        if "differs" in r
    ]
    return "\n".join(lines) + "\n"


def main() -> None:
    """Run the benchmark and write its table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--streamlines", type=float, nargs="+", default=[1e5, 1e6, 1e7])
    parser.add_argument("--step", type=float, default=0.5, help="mm between points")
    parser.add_argument("--radius", type=float, nargs="+", default=[2.0, 5.0, 10.0], help="mm, of the brush")
    parser.add_argument("--query", type=float, default=1e5, help="streamlines up to which all points are asked, too")
    parser.add_argument("--folder", type=Path, help="where the sets are kept; a temporary one if left out")
    parser.add_argument("--output", type=Path, help="a folder for regions.json and regions.md")
    options = parser.parse_args()
    sets = []
    with tempfile.TemporaryDirectory() as spare:
        folder = options.folder or Path(spare)
        folder.mkdir(parents=True, exist_ok=True)
        for number in map(int, options.streamlines):
            path, facts = indexed(made(folder, number, options.step))
            rows = measure(path, options.radius, query=number <= options.query)
            sets.append({"streamlines": number, **facts, "rows": rows})
            print(json.dumps(sets[-1]), flush=True)
    facts = about(0, quick=False)
    page = to_page(facts, sets)
    print(page)
    if options.output is not None:
        record("regions", {"about": facts, "sets": sets}, page, options.output)


if __name__ == "__main__":
    main()
