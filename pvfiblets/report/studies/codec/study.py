"""The study of the codec: bytes, errors and speed of fiblets and of other variants of keeping streamlines."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from pvfiblets.codec.small_sets import prefer_kernels
from pvfiblets.streamlines import Streamlines

from ...record import Axes, Figure, Record
from ...study import Options, Study
from ...timing import Comparison, Turns
from .baselines.directions import PaperFiblets, QFib
from .baselines.linearised import linearised
from .baselines.numbers import float16, int16, squeezed_by_zlib, squeezed_by_zstd
from .data_sets import SMALL, DataSet, data_sets
from .errors import direction_figures, distances, error_figures, median_step

if TYPE_CHECKING:
    from pvfiblets.codec.fibletset import FibletSet

BOUNDS = (0.02, 0.05, 0.1, 0.2, 0.5)  # steps
QUICK_BOUNDS = (0.05, 0.1, 0.2)
LOOK_AHEAD_BOUNDS = (0.05, 0.1, 0.2)  # it takes ten times as long
DEFAULT = "default"  # the promise that the set's steps and extent give
RECORD_POINTS = (15, 30)  # besides 60
QUICK_POINTS = 20_000

Points = npt.NDArray[np.floating]
Offsets = npt.NDArray[np.int64]


@dataclass(frozen=True)
class Variant:
    """One method of packing. ``make(step)`` gives the function that packs points and offsets of that step."""

    name: str
    setting: str
    make: Callable[[float], Callable[[Points, Offsets], Any]]
    ours: bool = False
    default: bool = False


@dataclass
class _Fiblets:
    """A set of fiblets as the baselines are."""

    fiblets: FibletSet
    nbytes: int

    def points(self) -> Points:
        points: Points = self.fiblets.decompress().points
        return points


def _fiblets(error_bound: float | None, effort: Any, record: int | None = None) -> Callable[[float], Any]:
    def make(step: float) -> Callable[[Points, Offsets], _Fiblets]:
        from pvfiblets.codec.parameters import DEFAULT_ANGLE
        from pvfiblets.report.studies.codec.coded import compress

        def pack(points: Points, offsets: Offsets) -> _Fiblets:
            cut = offsets if record is None else recut(offsets, record)
            max_error = error_bound * step if error_bound is not None and step > 0.0 else None
            angle = DEFAULT_ANGLE if error_bound is None else None  # a bound of distances alone, as other methods have
            made = compress(Streamlines(points, cut), max_error=max_error, max_angle=angle, effort=effort)
            # Only the last fiblet of a streamline has an end vector. Cut streamlines have too many.
            return _Fiblets(made, made.nbytes - made.ends.itemsize * (len(cut) - len(offsets)))

        return pack

    return make


def recut(offsets: Offsets, record: int) -> Offsets:
    """Cut streamlines every ``record`` points, so that no fiblet has more."""
    counts = np.diff(offsets)
    pieces = np.maximum(-(-counts // record), 1)
    nth = np.arange(pieces.sum()) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    cut: Offsets = np.append(np.repeat(offsets[:-1], pieces) + record * nth, offsets[-1])
    return cut


def variants(quick: bool) -> list[Variant]:
    """Return all variants, the most important first: where time runs out, the last are left out."""
    found = [
        Variant("fiblets", DEFAULT, _fiblets(None, "fast"), ours=True, default=True),
        Variant("fiblets, look-ahead", DEFAULT, _fiblets(None, "high"), ours=True),
        Variant("fiblets, splines", DEFAULT, _fiblets(None, "small"), ours=True),
        Variant("QFib", "8 bits", lambda _: QFib(8)),
        Variant("QFib", "16 bits", lambda _: QFib(16)),
        Variant("paper's fiblets", "", lambda _: PaperFiblets()),
        Variant("float16", "", lambda _: float16),
        Variant("int16 over bounds", "", lambda _: int16),
        Variant("zlib of float32", "", lambda _: squeezed_by_zlib(6)),
        Variant("zstd of float32", "", lambda _: squeezed_by_zstd(3)),
    ]
    found += [
        Variant("fiblets", f"{error_bound} steps", _fiblets(error_bound, "fast"), ours=True)
        for error_bound in (QUICK_BOUNDS if quick else BOUNDS)
    ]
    found += [
        Variant("dipy linearised", f"{tolerance} steps", _dipy(tolerance))
        for tolerance in ((0.1,) if quick else (0.02, 0.1, 0.5))
    ]
    found += [
        Variant(f"fiblets of {record} points", DEFAULT, _fiblets(None, "fast", record), True)
        for record in ((30,) if quick else RECORD_POINTS)
    ]
    if not quick:
        found += [
            Variant("fiblets, look-ahead", f"{error_bound} steps", _fiblets(error_bound, "high"), ours=True)
            for error_bound in LOOK_AHEAD_BOUNDS
        ]
    return found


def _dipy(tolerance: float) -> Callable[[float], Any]:
    return lambda step: linearised(tolerance * step)


def _measured(
    data: DataSet, chosen: list[Variant], missing: set[str], options: Options
) -> Iterator[Record]:
    points, offsets = data.streamlines.points, np.asarray(data.streamlines.offsets, np.int64)
    step = median_step(points, offsets)
    compared = Comparison(data.name, options, Turns(), len(points), "point")
    for variant in chosen:
        label = f"{variant.name} {variant.setting}".strip()
        if variant.name in missing or not compared.allows(label):
            continue
        try:
            record, calls = measured(data, variant, points, offsets, step)
            compared.add(record, **calls)
        except ImportError as error:
            missing.add(variant.name)
            options.leave_out(variant.name, f"{error.name or error} is not installed")
        except ValueError as error:
            compared.refuse(label, error)
    yield from compared.finish()


def run(options: Options) -> Iterator[Record]:
    """Yield a record for every data set and variant."""
    if options.quick:
        options.points = min(options.points, QUICK_POINTS)
    chosen = variants(options.quick)
    missing: set[str] = set()
    prefer_kernels("coding")  # a set of so few points would be coded without
    prefer_kernels("decoding")
    with one_thread():
        for data in data_sets(options):
            yield from _measured(data, chosen, missing, options)

def measured(
    data: DataSet, variant: Variant, points: Points, offsets: Offsets, step: float
) -> tuple[Record, dict[str, Callable[[], object]]]:
    """Pack and unpack in one variant; return a record of errors and bytes, and the calls that are to be timed."""
    pack = variant.make(step)
    packed = pack(points, offsets)
    calls: dict[str, Callable[[], object]] = {"compress": lambda: pack(points, offsets)}
    if hasattr(packed, "points"):
        decoded = packed.points()
        firsts = packed.fiblets.fiblet_points() if isinstance(packed, _Fiblets) else None
        apart, angles = distances(points, decoded), direction_figures(points, decoded, offsets, firsts)
        calls["decompress"] = packed.points
    else:
        apart, angles = packed.distances(points, offsets), {}
    record = Record(
        data=data.name,
        group=data.group,
        approximation="points of streamlines",
        method=variant.name,
        setting=variant.setting,
        errors=error_figures(apart, step) | angles,
        costs={"size": Figure(packed.nbytes / len(points), "bytes/point")},
        ours=variant.ours,
        default=variant.default,
    )
    return record, calls


@contextmanager
def one_thread() -> Iterator[None]:
    """Run compiled loops on one thread: speeds are then of one core, like other methods' speeds."""
    import numba

    before = numba.get_num_threads()
    numba.set_num_threads(1)
    try:
        yield
    finally:
        numba.set_num_threads(before)


STUDY = Study(
    name="codec",
    title="Compressed streamlines",
    approximates="Points of streamlines kept in fewer bytes: fiblets, beside other variants of keeping them.",
    axes=(
        Axes("size-max", "costs/size", "errors/max in steps", "bytes per point", "largest error, steps"),
        Axes("size-mean", "costs/size", "errors/mean in steps", "bytes per point", "mean error, steps"),
        Axes("compress", "times/compress", "errors/max in steps", "compress, ns per point", "largest error, steps"),
        Axes(
            "decompress", "times/decompress", "errors/max in steps", "decompress, ns per point", "largest error, steps"
        ),
    ),
    notes=(
        "Errors are distances of decoded points from the originals, as float64, point by point. A step is the median "
        "distance between consecutive points. *direction* is the angle between the tangents of the original and of the "
        "decoded line, over both ends of all segments longer than a pixel of a full-screen view, a 2000th of the "
        "bounds' diagonal; a tangent is the mean direction of the two segments at a point; at its first point, a "
        "fiblet is drawn with the direction of its first segment. "
        "Raw points are float32: 12 bytes each. All variants count 4 bytes a "
        "streamline for its number of points where decoding needs it. Times are of one thread, in memory: no file is "
        "read or written. "
        "Sets are cut to a bounded number of points by leaving streamlines out evenly, which their names say. Those of "
        f"fewer than {SMALL:,} points are measured but not drawn: their times are the cost of a call.",
        "*fiblets*: greedy encoder, with the error bound as the setting (*default*: a tenth of the step, where steps "
        "vary or are coarse a 4000th of a view's diagonal at most, and directions within 10°; others do not bound "
        "directions); *look-ahead*: effort high; *splines*: effort small; *fiblets of 30 "
        "points*: records of at most 30 points instead of 60. *QFib*, *paper's fiblets*: from their description "
        "in Schertzer et al. 2022 (pvfiblets/report/studies/codec/baselines/directions.py says what it leaves open), "
        "with the file's "
        "median step: what steps vary by adds up. *dipy linearised*: `compress_streamlines` with the tolerance as the "
        "setting; its points cannot be had back, so its error is the distance from the remaining line, and nothing is "
        "decompressed. *zlib* (level 6) and *zstd* (level 3) lose nothing.",
        "Made-up sets: whole-brain-like tracking of constant step (pvfiblets.synthetic); *noisy* ones turn by an "
        "independent random angle at every step as well, 4° per axis at 0.2 mm and in proportion to the step's root "
        "otherwise, much as iFOD1 does.",
    ),
    run=run,
)
