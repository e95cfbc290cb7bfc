"""The study of queries of compressed sets: beside dipy, and beside queries that take no index."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from ...record import Axes, Record
from ...study import Options, Study
from .painted import painted
from .similar import similar

STREAMLINES, QUICK_STREAMLINES = (10_000, 100_000, 1_000_000), (2_000,)
STEP = 0.5  # mm


def run(options: Options) -> Iterator[Record]:
    """Yield records set by set."""
    from pvfiblets.synthetic import brain

    warm: Any = brain(100, STEP)
    warm.clusters()
    warm.similar([0])  # compiled
    for count in QUICK_STREAMLINES if options.quick else STREAMLINES:
        if not options.allows(f"{count:,} streamlines"):
            continue
        fiblets = brain(count, STEP, seed=options.seed)
        yield from similar(fiblets, options)
        yield from painted(fiblets, options)
        options.log(f"query: {count:,} streamlines")


STUDY = Study(
    name="query",
    title="Similar streamlines, clusters, painted regions",
    approximates=(
        "Streamlines found after resampling (similar ones, QuickBundles), and by the spatial index of painted regions."
    ),
    axes=(
        Axes("answer", "times/answer", "errors/elsewhere", "ns per streamline", "streamlines answered otherwise, %"),
    ),
    notes=(
        "Synthetic whole brains, 0.5 mm between points; queries are of compressed sets, decoding and resampling "
        "included. Times are CPU times of all threads. *elsewhere*: streamlines on which the reference differs.",
        "*like n*: streamlines within 8 mm of n of the set's own. The reference resamples and compares in NumPy's "
        "float64; *apart*: the greatest difference of a distance from it. *clusters*: QuickBundles; the reference is "
        "dipy's, of the same lines. dipy's times leave out that lines were decoded and resampled beforehand.",
        "*balls*: a ball is painted at a streamline, or erased, or dragged along one by 1 mm, on a grid of 1 mm; each "
        "answer is the streamlines that pass all painted regions. *index*: the spatial index; *decoded*: the share of "
        "the fiblets near the stroke that it decodes. The reference decodes all fiblets near it. *points*: only points "
        "are tested, which misses streamlines that pass between two.",
    ),
    run=run,
)
