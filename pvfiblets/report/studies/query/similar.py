"""Similar streamlines and clusters beside dipy's, and beside the definition in float64."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np
import numpy.typing as npt

from pvfiblets import FibletSet
from pvfiblets.streamlines import Streamlines

from ...record import Figure, Record
from ...study import Options
from ...timing import Comparison, Turns

LIKE = 100  # streamlines that others are compared with
REACH = 8.0  # mm
THRESHOLDS = (20.0, 10.0)  # mm
POINTS = 12
REFERENCE = 10_000  # streamlines up to which the references are computed

Floats = npt.NDArray[np.float64]


def similar(fiblets: FibletSet, options: Options) -> Iterator[Record]:
    """Yield records of one set."""
    like = np.sort(np.random.default_rng(options.seed).choice(len(fiblets), LIKE, replace=False))
    compared = Comparison(f"{len(fiblets):,} streamlines", options, Turns(), len(fiblets), "streamline")
    small = len(fiblets) <= REFERENCE
    lines = fiblets.decompress() if small else None
    baselines = _dipy(lines, like, options) if lines is not None else {}

    def add(query: str, method: str, errors: dict[str, Figure], ask: Callable[[], Any]) -> None:
        record = Record(
            data=f"{len(fiblets):,} streamlines, {query}",
            group="similar",
            approximation="an answer by resampled streamlines",
            method=method,
            setting="",
            errors=errors,
            ours=method == "fiblets",
            default=method == "fiblets",
        )
        compared.add(record, answer=ask)

    name = f"like {LIKE}"
    near = fiblets.similar(like, distance=REACH)
    errors = {}
    if lines is not None:
        exact = equal_arcs(lines)
        apart = mdf_distances(exact, exact[like])
        errors = _elsewhere(near.mask != (apart <= REACH))
        errors["apart"] = Figure(float(np.abs(near.distances - apart[near.ids]).max(initial=0.0)), "mm")
    add(name, "fiblets", errors, partial(fiblets.similar, like, distance=REACH))
    if name in baselines:
        add(name, "dipy", {}, baselines[name])
    for threshold in THRESHOLDS:
        name = f"clusters at {threshold:g} mm"
        found = fiblets.clusters(threshold=threshold)
        errors = {}
        if name in baselines:
            labels = np.full(len(fiblets), -1)
            for number, cluster in enumerate(baselines[name]()):
                labels[cluster.indices] = number
            errors = _elsewhere(labels != found.labels)
        add(name, "fiblets", errors, partial(fiblets.clusters, threshold=threshold))
        if name in baselines:
            add(name, "dipy", _elsewhere(np.zeros(1, bool)), baselines[name])
    yield from compared.finish()


def _elsewhere(wrong: npt.NDArray[np.bool_]) -> dict[str, Figure]:
    return {"elsewhere": Figure(100.0 * float(wrong.mean()), "%")}


def _dipy(lines: Streamlines, like: Any, options: Options) -> dict[str, Callable[[], Any]]:
    """Return dipy's queries of the same lines, resampled beforehand."""
    from pvfiblets.query.bundles.resampled import resampled

    try:
        from dipy.segment.clustering import QuickBundles
        from dipy.segment.metric import AveragePointwiseEuclideanMetric
        from dipy.tracking.distances import bundles_distances_mdf
    except ImportError:
        options.leave_out("dipy's queries", "dipy is not installed")
        return {}
    few = list(resampled(lines, POINTS))
    metric = AveragePointwiseEuclideanMetric()  # its usual one resamples again
    found: dict[str, Callable[[], Any]] = {f"like {LIKE}": partial(bundles_distances_mdf, few, [few[i] for i in like])}
    for threshold in THRESHOLDS:
        found[f"clusters at {threshold:g} mm"] = partial(QuickBundles(threshold, metric=metric).cluster, few)
    return found


def mdf_distances(lines: Floats, others: Floats) -> Floats:
    """Return the MDF distance of each line, ``(n, points, 3)``, from the nearest of others: the definition."""
    best = np.full(len(lines), np.inf)
    for other in others:
        for turned in (other, other[::-1]):
            best = np.minimum(best, np.linalg.norm(lines - turned, axis=2).mean(axis=1))
    return best


def equal_arcs(lines: Streamlines) -> Floats:
    """Return lines resampled by NumPy's own interpolation, ``(n, points, 3)``."""
    out = np.empty((len(lines), POINTS, 3))
    for row, points in zip(out, lines, strict=True):
        line = np.asarray(points, np.float64)
        along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
        for axis in range(3):
            row[:, axis] = np.interp(np.linspace(0.0, along[-1], POINTS), along, line[:, axis])
    return out
