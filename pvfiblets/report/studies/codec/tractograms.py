"""The study of whole tractograms: size and error by algorithm and step (table 1 of the fiblets paper)."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain
from pathlib import Path

import numpy as np

from pvfiblets.streamlines import Streamlines

from ...record import Axes, Figure, Record
from ...study import Options, Study
from ...timing import Comparison, Turns
from .data_sets import QUICK_STEPS, SMALL, STEPS, DataSet, files_of
from .errors import median_step
from .study import DEFAULT, Variant, measured, one_thread, variants

METHODS = ("fiblets", "QFib", "paper's fiblets")
BITS = "8 bits"  # of QFib, as in the paper
POINTS, QUICK_POINTS = 1_000_000, 20_000  # of a made-up set
RAW_BYTES = 12.0  # of a point of a .tck file, and of what ends a streamline


def run(options: Options) -> Iterator[Record]:
    """Yield a record for every set and method."""
    chosen = [
        variant
        for variant in variants(quick=True)
        if variant.name in METHODS and variant.setting in (DEFAULT, BITS, "")
    ]
    with one_thread():
        for data in chain(trackings(options), whole_files(options)):
            if not options.budget.allows():
                options.leave_out(data.name, "the time given was used up")
                continue
            yield from _measured(data, chosen, options)

def trackings(options: Options) -> Iterator[DataSet]:
    """Make sets of all algorithms and steps, one after the other."""
    from pvfiblets.synthetic import streamline_count
    from pvfiblets.synthetic.trackers import ALGORITHMS, tracked_streamlines

    points = min(QUICK_POINTS, options.points) if options.quick else POINTS
    for algorithm in ALGORITHMS:
        for step in QUICK_STEPS if options.quick else STEPS:
            made = tracked_streamlines(algorithm, streamline_count(points, step), step, options.seed)
            yield DataSet(f"{algorithm}-like, {step:g} mm", algorithm, made)


def whole_files(options: Options) -> Iterator[DataSet]:
    """Read whole files, the largest first."""
    from pvfiblets import formats

    paths, reason = files_of(options.files)
    if reason:
        options.leave_out("real files", reason)
    for path in paths[:2] if options.quick else paths:
        try:
            found = formats.read(path)
        except (ValueError, OSError) as error:
            options.leave_out(path.name, _one_line(error, path))
            continue
        if found.n_points < SMALL or not np.isfinite(found.points).all():
            options.leave_out(path.name, f"it has fewer than {SMALL:,} points, or some that are not finite")
            continue
        yield DataSet(path.name, "files", Streamlines(found.points, found.offsets))


def _one_line(error: Exception, path: Path) -> str:
    return " ".join(str(error).replace(str(path), path.name).split())


def _measured(data: DataSet, chosen: list[Variant], options: Options) -> Iterator[Record]:
    points, offsets = data.streamlines.points, np.asarray(data.streamlines.offsets, np.int64)
    step = median_step(points, offsets)
    compared = Comparison(data.name, options, Turns(), len(points), "point")
    raw = RAW_BYTES * (len(points) + len(offsets) - 1) / len(points)
    for variant in chosen:
        try:
            record, calls = measured(data, variant, points, offsets, step)
        except ValueError as error:
            compared.refuse(f"{variant.name} {variant.setting}".strip(), error)
            continue
        kept = {name: record.errors[name] for name in ("max", "mean")}
        record.errors = kept | {
            f"{name} of a step": Figure(100.0 * figure.value / step, "%") for name, figure in kept.items()
        }
        record.costs["ratio"] = Figure(raw / record.costs["size"].value, "to 1")
        compared.add(record, **calls)
    yield from compared.finish()


STUDY = Study(
    name="tractograms",
    title="Whole tractograms",
    approximates="Points of whole tractograms kept in fewer bytes, by tracking algorithm and step.",
    axes=(
        Axes("ratio", "costs/size", "errors/max of a step", "bytes per point", "largest error, % of a step"),
        Axes("average", "costs/size", "errors/mean of a step", "bytes per point", "mean error, % of a step"),
    ),
    across=(
        "costs/ratio",
        "errors/max",
        "errors/mean",
        "errors/max of a step",
        "errors/mean of a step",
        "times/compress",
        "times/decompress",
    ),
    notes=(
        "Table 1 of Schertzer et al. 2022 with other data: synthetic tractograms with the turns of four tracking "
        "algorithms (see pvfiblets/synthetic/trackers.py), of steps from 0.05 to 1 mm and about "
        f"{POINTS / 1e6:g} million points each, and whole files: nothing is left out of a set. The paper's has iFOD1 "
        "and SD_STREAM at 0.05 and 0.1 mm.",
        "*ratio*: bytes of the .tck file, 12 a point and 12 a streamline, over those of the method; *max*, *mean*: "
        "distances of decoded points from the originals, as float64, point by point; a step is the median one. "
        "*fiblets*: at their default error bound, a tenth of the step; *QFib*, *paper's fiblets*: from their "
        "description (pvfiblets/report/studies/codec/baselines/directions.py). Times are of one thread, in memory. "
        "Sizes and errors "
        "do not depend on the machine.",
    ),
    run=run,
)
