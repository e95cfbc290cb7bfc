"""Similar streamlines and clusters: streamlines a second, and how far they are from a reference.

    python benchmarks/similarity.py [--streamlines 1e4 1e5 1e6] [--reference 1e4] [--file FILE…] [--output DIR]

Brain-like sets are made (0.5 mm between points, some 190 points a streamline); files are real ones. Each set is asked,
from its compressed form: which streamlines run within 8 mm of one, of 5 and of 100 of its own, and which clusters
(QuickBundles) it has at 20 and at 10 mm. Decoding and resampling are part of each. Beside it stand, for sets of up to
``--reference`` streamlines, dipy's ``QuickBundles`` and its MDF distance of the same lines, decoded and resampled
beforehand, which its time leaves out. Errors: streamlines in another cluster than dipy's, and found or not found
otherwise than by lines resampled and compared in NumPy's float64; the greatest difference of a distance from these.

The processor's time is what one core would take; medians of the repeats.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from common import record

import pvfiblets
from pvfiblets import FibletSet, Streamlines
from pvfiblets.report.machine import about
from pvfiblets.synthetic import brain

LIKE = (1, 5, 100)
REACH = 8.0  # mm
THRESHOLDS = (20.0, 10.0)  # mm
POINTS = 12


def timed(act: Callable[[], Any], repeats: int) -> tuple[Any, float, float]:
    """Return what it gives, and medians of seconds by the clock and of the processor."""
    rows = []
    for _ in range(repeats):
        wall, cpu = time.perf_counter(), time.process_time()
        found = act()
        rows.append((time.perf_counter() - wall, time.process_time() - cpu))
    return found, *np.median(rows, axis=0)


def mdf64(lines: np.ndarray, others: np.ndarray) -> np.ndarray:
    """MDF distance of each line from the nearest of others, in float64: the definition."""
    best = np.full(len(lines), np.inf)
    for other in others:
        for turned in (other, other[::-1]):
            best = np.minimum(best, np.linalg.norm(lines - turned, axis=2).mean(axis=1))
    return best


def equal_arcs(lines: Streamlines) -> np.ndarray:
    """Resample in float64, by NumPy's own interpolation."""
    out = np.empty((len(lines), POINTS, 3))
    for row, line in zip(out, lines, strict=True):
        line = np.asarray(line, np.float64)
        along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
        for axis in range(3):
            row[:, axis] = np.interp(np.linspace(0.0, along[-1], POINTS), along, line[:, axis])
    return out


def reference(data: FibletSet, found: dict[float, Any], like: np.ndarray, near: Any) -> dict[str, Any]:
    """Return dipy's clusters of the same lines, how long they take, and errors against it and against float64."""
    from dipy.segment.clustering import QuickBundles
    from dipy.segment.metric import AveragePointwiseEuclideanMetric
    from dipy.tracking.distances import bundles_distances_mdf

    from pvfiblets.query.bundles.resampled import resampled

    lines = data.decompress()
    few = list(resampled(lines, POINTS))
    metric = AveragePointwiseEuclideanMetric()  # its usual one resamples again
    rows: dict[str, Any] = {}
    for threshold in THRESHOLDS:
        clusters, wall, _ = timed(lambda t=threshold: QuickBundles(t, metric=metric).cluster(few), 1)
        labels = np.full(len(few), -1)
        for number, cluster in enumerate(clusters):
            labels[cluster.indices] = number
        rows[f"clusters {threshold:g}"] = {"dipy_s": wall, "elsewhere": int((labels != found[threshold].labels).sum())}
    _, wall, _ = timed(lambda: bundles_distances_mdf(few, [few[i] for i in like]), 1)
    exact = equal_arcs(lines)
    apart = mdf64(exact, exact[like])
    inside = apart <= REACH
    rows[f"like {len(like)}"] = {
        "dipy_s": wall,
        "elsewhere": int((inside != near.mask).sum()),
        "mm": float(np.abs(near.distances - apart[near.ids]).max()),
    }
    return rows


def measure(name: str, data: FibletSet, repeats: int, beside: int) -> list[dict[str, Any]]:
    """Rows of one set."""
    rng = np.random.default_rng(0)
    rows, near, found = [], None, {}
    many = len(data)
    for number in LIKE:
        like = np.sort(rng.choice(many, number, replace=False))
        near, wall, cpu = timed(lambda ids=like: data.similar(ids, distance=REACH), repeats)
        rows.append({"act": f"like {number}", "s": wall, "cpu_s": cpu, "found": len(near)})
    for threshold in THRESHOLDS:
        found[threshold], wall, cpu = timed(lambda t=threshold: data.clusters(threshold=t), max(repeats // 2, 1))
        rows.append({"act": f"clusters {threshold:g}", "s": wall, "cpu_s": cpu, "found": len(found[threshold])})
    told = reference(data, found, like, near) if many <= beside else {}
    return [
        {"set": name, "streamlines": many, "points": data.n_points, **row, **told.get(row["act"], {})} for row in rows
    ]


def to_page(facts: dict[str, Any], rows: list[dict[str, Any]]) -> str:
    """Return the page."""
    lines = [
        "# Similar streamlines and clusters", "",
        f"{facts['cores']} CPU cores ({facts['processor']}), {facts['date']}, load {facts.get('load', '?')} when it "
        "was begun. Streamlines a second by the clock, decoding and resampling to 12 points included; medians. "
        f"*like n*: within {REACH:g} mm of n streamlines; *clusters t*: QuickBundles at t mm. dipy's times leave out "
        "that lines were decoded and resampled beforehand.", "",
        "| set | streamlines | points | act | found | s | processor, s | streamlines a second | dipy, s "
        "| in another place than the reference | greatest error, mm |",
        "|---|---|---|---|---|---|---|---|---|---|---|",
    ]  # fmt: skip
    for r in rows:
        beside = f"{r['dipy_s']:.2f} | {r['elsewhere']}" if "dipy_s" in r else " | "
        error = f"{r['mm']:.1e}" if "mm" in r else ""
        lines.append(
            f"| {r['set']} | {r['streamlines']:,} | {r['points']:,} | {r['act']} | {r['found']:,} | {r['s']:.3f} "
            f"| {r['cpu_s']:.3f} | {r['streamlines'] / r['s']:,.0f} | {beside} | {error} |"
        )
    return "\n".join(lines) + "\n"


def main() -> None:
    """Run the benchmark and write its table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--streamlines", type=float, nargs="*", default=[1e4, 1e5, 1e6], help="of brain-like sets")
    parser.add_argument(
        "--reference", type=float, default=1e4, help="streamlines up to which dipy and float64 are asked"
    )
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--file", type=Path, nargs="*", default=[], help="real sets, of any format")
    parser.add_argument("--output", type=Path, help="a folder for similarity.json and similarity.md")
    options = parser.parse_args()
    facts, rows = about(0, quick=False), []
    small = brain(100, 0.5)
    small.clusters()
    small.similar([0])  # compiled
    sets = [(path.stem, lambda path=path: pvfiblets.compress(pvfiblets.read(path))) for path in options.file]
    sets += [("brain", lambda n=int(n): brain(n, 0.5)) for n in options.streamlines]
    for name, make in sets:
        for row in measure(name, make(), options.repeats, int(options.reference)):
            rows.append(row)
            print(json.dumps(row), flush=True)
    page = to_page(facts, rows)
    print(page)
    if options.output is not None:
        record("similarity", {"about": facts, "rows": rows}, page, options.output)


if __name__ == "__main__":
    main()
