"""The study of decoding: what order, number format, table and algebra cost, and how far points drift over a fiblet."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from pvfiblets.codec.direction_codebook import CAP_DEGREES, quaternions

from ...record import Axes, Figure, Record
from ...study import Options, Study
from ...timing import Comparison, Turns
from ..codec.errors import error_figures
from . import decoders
from .reference import first_frame, product, rotate_x

STEPS = (0.05, 0.1, 0.2, 0.5, 1.0)  # mm
QUICK_STEPS = (0.1, 1.0)
CAPS = (0, 3, 6, 9, 12, 15)
QUICK_CAPS = (0, 15)
USUAL_STEP, USUAL_CAP = 0.2, 7
FIBLETS = 2000
QUICK_FIBLETS = 300
REPEATS = 3  # times as many as other studies make: a call takes a millisecond
BOX = 100.0  # mm: anchors are as far as this from the middle, as in a brain
DRIFT_AT = (1, 2, 4, 8, 16, 32, 45, 59)  # points whose errors are given one by one

ORDERS = {"sequential": decoders.SEQUENTIAL, "prefix": decoders.PREFIX}
ALGEBRAS = {"quaternions": decoders.QUATERNION, "matrices": decoders.MATRIX}
SOURCES = {"table": decoders.TABLE, "closed form": decoders.CLOSED, "closed form, rounded": decoders.ROUNDED}
NUMBERS = {"float32": np.float32, "float64": np.float64}


@dataclass(frozen=True)
class Made:
    """Fiblets of random directions and codes: all turns that a cap angle has are equally frequent."""

    anchors: npt.NDArray[np.float64]
    frames: npt.NDArray[np.float64]
    codes: npt.NDArray[np.uint8]
    cap: int
    step: float


def made(n: int, cap: int, step: float, seed: int) -> Made:
    """Make fiblets of 60 points, whose anchors float32 holds exactly."""
    rng = np.random.default_rng([seed, cap, round(1e6 * step)])
    words = rng.integers(0, 65535, (n, 2)) - 32767
    frames = np.stack([first_frame(int(u & 0xFFFF) | int(v & 0xFFFF) << 16)[1] for u, v in words])
    anchors = rng.uniform(-BOX, BOX, (n, 3)).astype(np.float32).astype(np.float64)
    codes = rng.integers(0, 256, (n, decoders.POINTS - 2)).astype(np.uint8)
    return Made(anchors, frames, codes, cap, step)


def exact(fiblets: Made) -> npt.NDArray[np.longdouble]:
    """Decode in NumPy's longest number (64 bits of mantissa on x86): what the codes mean, ``(n, 60, 3)``."""
    # The meaning is that of `reference`: products of the table's quaternions as they are stored.
    long = np.longdouble
    table = quaternions()[fiblets.cap].astype(long)
    q = fiblets.frames.astype(long).T
    points = np.empty((*fiblets.codes.shape[:1], decoders.POINTS, 3), long)
    points[:, 0] = fiblets.anchors
    for i in range(1, decoders.POINTS):
        if i > 1:
            q = product(q, table[fiblets.codes[:, i - 2]].T)
        points[:, i] = points[:, i - 1] + long(fiblets.step) * rotate_x(q).T
    return points


def run(options: Options) -> Iterator[Record]:
    """Yield a record for every set and variant."""
    n = QUICK_FIBLETS if options.quick else FIBLETS
    steps, caps = (QUICK_STEPS, QUICK_CAPS) if options.quick else (STEPS, CAPS)
    sets = [("steps", step, USUAL_CAP) for step in steps] + [("caps", USUAL_STEP, cap) for cap in caps]
    for group, step, cap in sets:
        name = f"steps of {step:g} mm, cap angle {CAP_DEGREES[cap]:g}°"
        fiblets = made(n, cap, step, options.seed)
        truth = exact(fiblets)
        often = replace(options, repeats=REPEATS * options.repeats)
        compared = Comparison(name, often, Turns(), n * decoders.POINTS, "point")
        for combination in _combinations():
            if compared.allows(", ".join(combination)):
                record, decode = measured(fiblets, truth, combination)
                record.data, record.group = name, group
                compared.add(record, decode=decode)
        yield from compared.finish()

def _combinations() -> list[tuple[str, str, str, str]]:
    """Return order, number format, algebra and source of all variants, the codec's own first."""
    every = [(o, n, a, s) for s in SOURCES for a in ALGEBRAS for o in ORDERS for n in NUMBERS]
    return sorted(every, key=lambda variant: variant[2:] != ("quaternions", "table"))


def measured(
    fiblets: Made, truth: Any, combination: tuple[str, str, str, str]
) -> tuple[Record, Callable[[], None]]:
    """Decode by one variant; return a record of errors, and the call that is to be timed."""
    order, number, algebra, source = combination
    dtype = NUMBERS[number]
    arrays = [np.ascontiguousarray(a.astype(dtype)) for a in (fiblets.anchors, fiblets.frames)]
    step = np.array([fiblets.step], dtype)
    scratch = tuple(np.zeros((decoders.ELEMENTS, width), dtype) for width in (4, 9, 3))
    tables = decoders.inputs(dtype)
    out = np.empty(truth.shape, dtype)
    how = (ORDERS[order], ALGEBRAS[algebra], SOURCES[source])

    def run() -> None:
        decoders.decode(*arrays, fiblets.codes, fiblets.cap, step, how, tables, scratch, out)

    run()
    apart = np.sqrt(((out - truth) ** 2).sum(axis=2)).astype(np.float64)
    errors = error_figures(apart.ravel(), fiblets.step)
    for i in DRIFT_AT:
        errors[f"mean at point {i}"] = Figure(float(apart[:, i].mean()) / fiblets.step, "steps")
    own = (algebra, source) == ("quaternions", "table")
    record = Record(
        data="",
        group="",
        approximation="decoded points",
        method=f"{order}, {number}",
        setting=f"{algebra}, {source}",
        errors=errors,
        ours=own and (order, number) != ("prefix", "float64"),
        default=own and (order, number) == ("sequential", "float32"),
    )
    return record, run


STUDY = Study(
    name="decode",
    title="Decoding of fiblets",
    approximates=(
        "Points that codes stand for, by finite numbers: sequential or parallel prefix, float32 or float64, rotations "
        "as quaternions or matrices, from a table or by its closed form."
    ),
    axes=(
        Axes("max", "times/decode", "errors/max in steps", "ns per point", "largest error, steps"),
        Axes("mean", "times/decode", "errors/mean in steps", "ns per point", "mean error, steps"),
        Axes("drift", "", "errors/mean at point ", "point of the fiblet", "mean error, steps", series=True),
    ),
    notes=(
        "Fiblets of 60 points with random first directions and codes, their anchors up to 100 mm from the middle along "
        "each axis: rounding coordinates of that size alone costs float32 up to 7 nm at every addition. Errors are "
        "distances from the same products in NumPy's longest number format. The codec's own variants: "
        "sequential, quaternions, table, in float32 on graphics cards and in float64 on the CPU; prefix, quaternions, "
        "table, float32 where a work group decodes a fiblet together.",
        "*closed form*: the formula that the table was made by, without the table's rounding to 16-bit integers, so "
        "that it is another direction by up to that; *rounded*: with it, where float32 may still fall on the other "
        "side. The table's quaternions are float32, so of unit length within 1e-7 only. What they mean is their "
        "product as the sequential decoder takes it; matrices, the prefix network and the closed form take them in "
        "another order, or as exact rotations, which is all that float64 shows of these: no digits are lost, and it is "
        "far below any promise.",
        "Times are of one thread of the CPU, all variants compiled alike. The prefix network does "
        "more work (six passes of up to 32 products) so that 32 threads of a graphics card can share it: its time here "
        "is that of the work alone.",
    ),
    run=run,
)
