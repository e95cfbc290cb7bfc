"""The study of measures: what tables, maps and matrices of coded sets are off by."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from functools import partial
from itertools import chain
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from pvfiblets.codec.fibletset import FibletSet
from pvfiblets.streamlines import Streamlines

from ...record import Axes, Figure, Record
from ...study import Options, Study
from ...timing import Comparison, Turns
from .data_sets import DataSet
from .errors import median_step
from .tractograms import trackings, whole_files

if TYPE_CHECKING:
    from pvfiblets.query.measures.table import Table

VOXEL, PARCEL = 1.0, 16.0  # mm, sides of voxels of maps and of parcels of matrices
OTHERS = (0.25, 4.0)  # times the default's error bound

Floats = npt.NDArray[np.float64]
Source = FibletSet | Streamlines


def run(options: Options) -> Iterator[Record]:
    """Yield a record for every set and error bound."""
    for data in chain(trackings(options), whole_files(options)):
        if not options.allows(data.name):
            continue
        yield from _measured(data, options)

def _measured(data: DataSet, options: Options) -> Iterator[Record]:
    from pvfiblets import compress

    lines = data.streamlines
    step, truth = median_step(lines.points, np.asarray(lines.offsets, np.int64)), _numbers(lines, lines)
    usual = compress(lines, exact=False)
    sets = {"default": usual} | {
        f"{factor:g} times": compress(lines, exact=False, max_error=factor * usual.promise) for factor in OTHERS
    }
    compared = Comparison(data.name, options, Turns(), lines.n_points, "point")
    for setting, fiblets in sets.items():
        figures = _errors(truth, _numbers(fiblets, lines), step)
        record = Record(data.name, data.group, "measures", "fiblets", setting, figures, ours=True,
                        default=setting == "default")  # fmt: skip
        record.costs["size"] = Figure(fiblets.nbytes / max(lines.n_points, 1), "bytes/point")
        compared.add(record, table=partial(_table, fiblets))
    yield from compared.finish()


def _table(source: Source) -> Table:
    """Return the table of a set, without warnings: their subject is measured here."""
    from pvfiblets.query.measures.table import table

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return table(source)


def _numbers(source: Source, original: Streamlines) -> dict[str, Floats]:
    """Return the measures of a set, on grids about the original points."""
    from pvfiblets.query.connectome.matrix import connectome
    from pvfiblets.query.density.volume import density

    points = (source if isinstance(source, Streamlines) else source.decompress()).points.astype(np.float64)
    rows = _table(source)
    low = original.points.min(axis=0) - 2.0 * VOXEL
    extent = original.points.max(axis=0) + 2.0 * VOXEL - low
    found = {name: np.asarray(rows[name], np.float64) for name in ("length", "mean_curvature")}
    found["ends"] = np.stack([rows[f"{end}_{axis}"] for end in ("start", "end") for axis in "xyz"], axis=1)
    segments = np.diff(points, axis=0)
    segments[np.asarray(original.offsets)[1:-1] - 1] = 0.0  # from one streamline to the next
    found["segments"] = segments
    for name, side in (("density", VOXEL), ("connectome", PARCEL)):
        shape = np.ceil(extent / side).astype(int)
        affine = np.diag([side, side, side, 1.0])
        affine[:3, 3] = low + 0.5 * side
        if name == "density":
            found[name] = np.asarray(density(source, like=(tuple(shape), affine)).values, np.float64)
        else:
            labels = np.arange(1, shape.prod() + 1).reshape(shape)
            found[name] = np.asarray(connectome(source, (labels, affine), radius=0.0).matrix, np.float64)
    return found


def _errors(truth: dict[str, Floats], found: dict[str, Floats], step: float) -> dict[str, Figure]:
    """Return what one set's numbers are off by beside another's."""
    lengths, usual = truth["length"], float(np.nanmedian(truth["mean_curvature"]))
    longer = lengths > step
    one, other = truth["segments"], found["segments"]
    sizes = np.linalg.norm(one, axis=1) * np.linalg.norm(other, axis=1)
    cosines = (one * other).sum(axis=1)[sizes > 0.0] / sizes[sizes > 0.0]
    bent = np.abs(found["mean_curvature"] - truth["mean_curvature"])
    return {
        "length": Figure(100.0 * float((np.abs(found["length"] - lengths)[longer] / lengths[longer]).max()), "%"),
        "ends": Figure(float(np.nanmax(np.linalg.norm((found["ends"] - truth["ends"]).reshape(-1, 3), axis=1))), "mm"),
        "direction": Figure(float(np.degrees(np.arccos(np.clip(cosines, -1.0, 1.0))).mean()), "°"),
        "curvature": Figure(100.0 * float(np.nanquantile(bent, 0.99)) / usual, "%"),
        **{name: Figure(100.0 * float(np.abs(found[name] - truth[name]).sum() / truth[name].sum()), "%")
           for name in ("density", "connectome")},
    }  # fmt: skip


STUDY = Study(
    name="measures",
    title="Measures of coded sets",
    approximates="Measures of coded points, beside the measures of the original points.",
    axes=(
        Axes("length", "costs/size", "errors/length", "bytes per point", "largest error of a length, %"),
        Axes("density", "costs/size", "errors/density", "bytes per point", "streamlines counted in other voxels, %"),
    ),
    across=("costs/size", "errors/length", "errors/ends", "errors/direction", "errors/curvature", "errors/density",
              "errors/connectome", "times/table"),
    notes=(
        "*default*: the usual error bound of a tenth of a step; others are multiples of it. *length*: largest error "
        "of a streamline's length, %. *ends*: largest distance of a first or last point, mm. *direction*: mean angle "
        "between the segments of both, degrees. *curvature*: the error of mean curvature that 99 % of the streamlines "
        f"keep, % of the set's median. *density*: visits of streamlines to voxels of {VOXEL:g} mm that only one of the "
        "two maps has, % of all visits. *connectome*: the same of connections between parcels, cubes of "
        f"{PARCEL:g} mm.",
        "Curvature is measured over chords that the error bound leaves right: a finer bound makes it that of the "
        "points. Where it is not within 2 %, ``table`` warns and names the error bound that is needed.",
    ),
    run=run,
)
