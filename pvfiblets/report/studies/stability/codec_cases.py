"""Extreme streamlines through the codec: every point within the error bound, or one clear error."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from pvfiblets.codec.encoding.resample import resample
from pvfiblets.codec.parameters import Effort
from pvfiblets.codec.point_values import code_values
from pvfiblets.report.studies.codec.coded import compress
from pvfiblets.streamlines import Streamlines

from .case import Cases, Outcome, Setting, refused, worst
from .synthetic_lines import differences, from_segments, helix, lines_of, tracking, turning, zigzag

CASES = Cases("codec")
WITHIN = "every decoded point within the promise of its original; counts as they were"
BOUND = "of the error bound"
EFFORTS: tuple[Effort, ...] = ("fast", "high", "small")
ANGLES = np.geomspace(1e-6, np.pi, 25)  # radians
SIZES = (1e-6, 1e-3, 1.0, 1e3, 1e6)  # mm
MANY, LONG, LONG_IN_TESTS = 1_000_000, 10_000_000, 1_000_000


def _kept(
    sets: Iterable[Streamlines], efforts: Iterable[Effort] = EFFORTS, max_error: float | None = None, note: str = ""
) -> Outcome:
    """Compress with every effort and decode in float64; measure the largest error over the error bound."""
    found = []
    efforts = tuple(efforts)
    for streamlines in sets:
        for effort in efforts:
            fiblets = compress(streamlines, effort=effort, max_error=max_error)
            fiblets.verify()
            decoded = fiblets.decompress(dtype=np.float64)
            if not np.array_equal(decoded.offsets, streamlines.offsets) or not np.isfinite(decoded.points).all():
                return Outcome(np.inf, 1.0, BOUND, "counts changed, or points are not finite")
            largest = float(differences(decoded.points, streamlines.points).max(initial=0.0))
            said = (
                note or f"promise {fiblets.promise:.3g} mm, {fiblets.nbytes / max(streamlines.n_points, 1):.3g} B/point"
            )
            found.append(Outcome(largest / fiblets.promise, 1.0, BOUND, said))
    return worst(found)


@CASES.add("turns from 1e-6 to π", "25 lines of constant step, each with one angle at every point", WITHIN, long=True)
def _angles(_: Setting) -> Outcome:
    alone = _kept([lines_of(turning(angle)) for angle in ANGLES], ["fast"])
    return worst([alone, _kept([lines_of(*map(turning, ANGLES))])])


@CASES.add("alternating turns of 180°", "500 points back and forth between two places", WITHIN)
def _back_and_forth(_: Setting) -> Outcome:
    return _kept([lines_of(zigzag())])


@CASES.add("exactly straight", "lines along ±x, ±y, ±z and a diagonal: cap angle 0", WITHIN)
def _straight(_: Setting) -> Outcome:
    directions = np.concatenate([np.eye(3), -np.eye(3), [[1.0, 1.0, 1.0]]])
    return _kept([lines_of(*(0.5 * np.arange(300)[:, None] * direction for direction in directions))])


@CASES.add("helix at the step's Nyquist", "turns of π − 0.001 from point to point, pitch 0.01 mm", WITHIN)
def _helix(_: Setting) -> Outcome:
    return _kept([lines_of(helix()), lines_of(helix(turn=np.pi, pitch=1e-5))])


@CASES.add("steps from 1e-6 to 1e6 mm", "tracking of one constant step each, over twelve decades", WITHIN)
def _steps(_: Setting) -> Outcome:
    base = tracking(4)
    return _kept([Streamlines(base.points * size, base.offsets) for size in SIZES])


@CASES.add("steps from 1e-6 to 1e6 mm in one streamline", "400 random steps over twelve decades", WITHIN)
def _mixed_steps(_: Setting) -> Outcome:
    rng = np.random.default_rng(3)
    steps = 10.0 ** rng.uniform(-6.0, 6.0, (400, 1)) * rng.normal(size=(400, 3))
    return _kept([lines_of(np.cumsum(steps, axis=0)), lines_of(np.cumsum(steps, axis=0), tracking(1).points)])


@CASES.add("one step of 1e5 mm among steps of 0.5 mm", "a jump within a line of constant step", WITHIN)
def _jump(_: Setting) -> Outcome:
    line = np.array(tracking(1).points)
    line[60:] += 1e5
    return _kept([lines_of(line)])


@CASES.add("offsets of ±1e7 mm", "tracking moved by 1e7 mm either way, in float64 and in float32", WITHIN)
def _offsets(_: Setting) -> Outcome:
    base = tracking(4)
    far = [base.points + sign * 1e7 for sign in (1.0, -1.0)]
    kinds = (np.float64, np.float32)
    return _kept([Streamlines(points.astype(kind), base.offsets) for points in far for kind in kinds])


@CASES.add("steps of no length", "every point four times; all points of a line the same", WITHIN)
def _no_length(_: Setting) -> Outcome:
    rng = np.random.default_rng(4)
    return _kept([lines_of(np.repeat(rng.normal(size=(30, 3)), 4, axis=0)), lines_of(np.full((100, 3), 7.25))])


@CASES.add("denormal coordinates", "coordinates of 1e-310 mm and of 1e-40 mm", WITHIN)
def _denormals(_: Setting) -> Outcome:
    some = np.random.default_rng(5).normal(size=(70, 3))
    return _kept([lines_of(some * 1e-310), lines_of(some * 1e-40)])


@CASES.add("huge coordinates", "coordinates of 1e34 mm, near float32's end", WITHIN)
def _huge(_: Setting) -> Outcome:
    return _kept([lines_of(np.random.default_rng(5).normal(size=(70, 3)) * 1e34)])


@CASES.add("nothing, or hardly anything", "no streamlines; empty ones among others; only ones of one point", WITHIN)
def _nothing(_: Setting) -> Outcome:
    points = tracking(1, 10).points
    none = np.empty((0, 3))
    sets = [
        Streamlines(none, [0]),
        Streamlines(none, [0, 0, 0]),
        Streamlines(points, [0, 0, 4, 4, 10, 10]),
        Streamlines(points, np.arange(11)),
    ]
    return _kept(sets)


@CASES.add("a million streamlines of 2 points", "random short segments within 200 mm", WITHIN, long=True)
def _many(_: Setting) -> Outcome:
    rng = np.random.default_rng(6)
    first = rng.uniform(-100.0, 100.0, (MANY, 1, 3)).astype(np.float32)
    points = np.concatenate([first, first + rng.normal(0.0, 1.0, (MANY, 1, 3)).astype(np.float32)], axis=1)
    return _kept([Streamlines(points.reshape(-1, 3), 2 * np.arange(MANY + 1))], ["fast"])


@CASES.add(
    "one streamline of 10 million points",
    "tracking of one line that never ends (the tests: of a million points, the whole report: of ten)",
    WITHIN,
    long=True,
)
def _long(setting: Setting) -> Outcome:
    n = LONG if setting.whole else LONG_IN_TESTS
    t = np.arange(n) * (0.2 / 40.0)
    points = np.empty((n, 3), np.float32)  # about 40 mm round, and 0.2 mm from point to point
    points[:, 0], points[:, 1], points[:, 2] = 40.0 * np.cos(t), 40.0 * np.sin(t), 20.0 * np.sin(0.01 * t)
    return _kept([Streamlines(points, [0, n])], ["fast"], note=f"{n:,} points")


@CASES.add("promises from 1e-6 mm to 1e4 steps", "two millionths of a step, and far coarser ones", WITHIN)
def _promises(_: Setting) -> Outcome:
    return worst([_kept([tracking(3)], max_error=promise) for promise in (1e-6, 1e-3, 1.0, 5e3)])


@CASES.add("all streamlines the same, in Hilbert order", "50 copies, and 50 single points at one place", WITHIN)
def _same(_: Setting) -> Outcome:
    found = []
    for line in (np.asarray(tracking(1).points), np.full((1, 3), -3.5)):
        lines = lines_of(*[line] * 50)
        fiblets = compress(lines, order="hilbert")
        fiblets.verify()
        decoded = fiblets.decompress(dtype=np.float64)
        found.append(Outcome(float(differences(decoded.points, lines.points).max()) / fiblets.promise, 1.0, BOUND))
    return worst(found)


@CASES.add("coordinates that are none", "NaN and infinity in one point of many", "the line is cut there, or an error")
def _not_finite(_: Setting) -> Outcome:
    whole = tracking(2)
    first = int(whole.offsets[np.searchsorted(whole.offsets, 77, "right") - 1])

    def broken(value: float) -> Streamlines:
        points = np.array(whole.points)
        points[77, 1] = value
        return Streamlines(points, whole.offsets)

    values = (np.nan, np.inf, -np.inf)
    wrong = 0
    for value in values:
        found = compress(broken(value)).decompress()
        cut = list(np.diff(found.offsets)).count(77 - first)
        wrong += not (len(found) == len(whole) + 1 and len(found.points) == len(whole.points) - 1 and cut)
    makers = [lambda value=value: compress(broken(value), nan="error") for value in values]
    refusals = refused(ValueError, r"^point 77 is .*finite coordinates in mm are needed", *makers)
    return worst([Outcome(float(wrong), 0.0, refusals.unit, refusals.note), refusals])


@CASES.add("coordinates beyond float32", "coordinates of 1e36 mm", "an error that names the coordinate and the limit")
def _too_large(_: Setting) -> Outcome:
    lines = lines_of(np.random.default_rng(5).normal(size=(70, 3)) * 1e36)
    return refused(ValueError, r"beyond 1e\+35 mm, where float32 ends: check the units", lambda: compress(lines))


@CASES.add("promises that cannot be kept", "0, negative, NaN, and 1e-12 mm at 1e7 mm", "an error that says which can")
def _bad_promises(_: Setting) -> Outcome:
    base = tracking(2)
    far = Streamlines(base.points + 1e7, base.offsets)
    none = refused(
        ValueError,
        "a positive length in mm is needed",
        *(lambda promise=promise: compress(base, max_error=promise) for promise in (0.0, -1.0, np.nan, np.inf)),
    )
    fine = refused(ValueError, "the finest promise is", lambda: compress(far, max_error=1e-12))
    return worst([fine, none])


@CASES.add(
    "numbers per point that hardly are any",
    "constant, denormal, over 1e±30, and with NaN and infinity among them, in 8 and in 16 bits",
    "within 1/255 of the middle 98 % of the original, NaN where it was not finite",
)
def _numbers(_: Setting) -> Outcome:
    rng = np.random.default_rng(7)
    some = rng.normal(size=1000)
    holes = np.where(np.arange(1000) % 7 == 0, np.nan, np.where(np.arange(1000) % 11 == 0, np.inf, some))
    found = []
    for values in (np.full(1000, 3.25), some * 1e-40, some * 1e30, some * 1e-30, some + 1e6, holes):
        finite = np.isfinite(values)
        low, high = np.quantile(values[finite], [0.01, 0.99])
        for bits in (8, 16):
            coded = code_values(values, bits)
            decoded = coded.values().astype(np.float64)
            if not np.array_equal(np.isfinite(decoded), finite):
                return Outcome(np.inf, 1.0, "levels", "NaN where there was a number, or the other way round")
            level = max((high - low) / 255.0, np.spacing(high))
            found.append(Outcome(float(np.abs(decoded - values)[finite].max()) / (1.0001 * level), 1.0, "levels"))
    return worst(found)


@CASES.add(
    "resampling to steps from 1e-3 to 1e6 mm",
    "lines of 65 mm, of no length, and of one point",
    "both ends kept, all points on the line, finite",
)
def _resampled(_: Setting) -> Outcome:
    lines = lines_of(tracking(1).points, np.full((5, 3), 2.0), [[1.0, 2.0, 3.0]], zigzag(9))
    found = []
    for step in (1e-3, 0.7, 64.0, 1e6):
        made = resample(lines, step)
        for before, after in zip(lines, made, strict=True):
            ends = differences(before[[0, -1]], after[[0, -1]]).max()
            a, b = before[:-1], before[1:]
            some = after[:: max(len(after) // 400, 1)]
            off = from_segments(some, a, b) if len(a) else np.zeros(1)
            found.append(Outcome(float(max(ends, off.max())), 1e-9, "mm"))
    return worst(found)
