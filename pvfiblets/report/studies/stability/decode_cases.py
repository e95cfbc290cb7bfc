"""Decoding, and bounds without it: the same numbers by every method, and every point in its capsule."""

from __future__ import annotations

import numpy as np

from pvfiblets.codec.fibletset import FibletSet
from pvfiblets.codec.layout import DIRECTION, FIELDS, PAGE_BITS, STEP_LEVELS, unpack
from pvfiblets.engine import FibletStyle, View
from pvfiblets.query.density.volume import CONTRASTS
from pvfiblets.query.measures.measures import measure
from pvfiblets.query.selection.endpoints import end_points
from pvfiblets.report.studies.codec.coded import compress
from pvfiblets.streamlines import Streamlines

from ..decode import decoders, reference
from ..decode.study import Made, exact, made
from .case import Cases, Outcome, Setting, worst
from .render_checks import Array, camera, drawing
from .synthetic_lines import differences, helix, lines_of, tracking, turning, zigzag

CASES = Cases("decode")
OF_POINTS = ("length", "end_distance", "mean_curvature", "curvature", "arc_length")
ALIKE = "compiled decoding as the literal one in NumPy, in float64"
IN_STEPS = "steps"


def stiff() -> dict[str, Streamlines]:
    """Lines that need every way of the codec, at the limits of its input."""
    rng = np.random.default_rng(3)
    mixed = np.cumsum(10.0 ** rng.uniform(-6.0, 6.0, (200, 1)) * rng.normal(size=(200, 3)), axis=0)
    base = tracking(3)
    return {
        "turns of 1e-6 to π": lines_of(*map(turning, np.geomspace(1e-6, np.pi, 9))),
        "back and forth, and a helix": lines_of(zigzag(200), helix(200)),
        "steps of 1e-6 to 1e6 mm": lines_of(mixed),
        "1e7 mm away": Streamlines(base.points - 1e7, base.offsets),
        "sizes of 1e-6": Streamlines(base.points * 1e-6, base.offsets),
        "sizes of 1e6": Streamlines(base.points * 1e6, base.offsets),
        "no length": lines_of(np.full((100, 3), 7.25), [[1.0, 2.0, 3.0]]),
        "denormal": lines_of(rng.normal(size=(70, 3)) * 1e-40),
    }


def _literal(fiblets: FibletSet, f: int) -> Array:
    """Points of one fiblet as the codec's reference decodes them, mm."""
    number = {name: int(unpack(name, getattr(fiblets, field.array)[f])) for name, field in FIELDS.items()}
    anchor = np.array([number[f"anchor_{axis}"] for axis in "xyz"], np.float64)
    if fiblets.anchors_low is not None:
        anchor = anchor * 65536.0 + fiblets.anchors_low[f]
    anchor = anchor * fiblets.anchor_scale
    codes = np.asarray(fiblets.codes[int(fiblets.pages[f >> PAGE_BITS, 1]) + number["code"] :][:256])
    p, count = fiblets.parameters, number["last"] + 1
    if number["kind"] == DIRECTION:
        step = p.step_lo + number["step"] * (p.step_hi - p.step_lo) / STEP_LEVELS
        points = reference.decode_direction(anchor, number["shape"], step, number["cap"], codes, count)
    else:
        edge = p.lattice * 0.5 ** number["cap"]
        points = reference.decode_lattice(anchor, number["kind"], number["shape"], number["step"], edge, codes, count)
    return points + fiblets.origin


@CASES.add("stiff lines by two decoders", "eight sets: turns, steps, sizes and places at their ends", ALIKE)
def _two_decoders(_: Setting) -> Outcome:
    found = []
    for name, lines in stiff().items():
        fiblets = compress(lines)
        decoded = np.asarray(fiblets.decompress(dtype=np.float64).points)
        starts = np.append(fiblets.fiblet_points(), fiblets.n_points)
        for f in range(min(fiblets.n_fiblets, 40)):
            mine = _literal(fiblets, f)
            off = float(differences(decoded[starts[f] : starts[f + 1]], mine).max(initial=0.0))
            rounding = 64.0 * float(np.spacing(np.abs(mine).max() + np.abs(fiblets.origin).max()))
            found.append(Outcome(off / (rounding + 1e-9 * fiblets.promise), 1.0, "of rounding", name))
    return worst(found)


@CASES.add(
    "60 points in float32 at every cap angle",
    "random codes at all sixteen cap angles, sequentially and by parallel prefix",
    "within a thousandth of a step of the same products in the longest number format",
)
def _drift(_: Setting) -> Outcome:
    tables, found = decoders.inputs(np.float32), []
    scratch = tuple(np.zeros((decoders.ELEMENTS, width), np.float32) for width in (4, 9, 3))
    for cap in range(16):
        some = made(40, cap, 0.2, 0)
        here = Made(np.zeros_like(some.anchors), some.frames, some.codes, cap, some.step)
        right = exact(here)
        for name, order in (("sequential", decoders.SEQUENTIAL), ("prefix", decoders.PREFIX)):
            out = np.empty(right.shape, np.float32)
            arrays = [np.ascontiguousarray(a.astype(np.float32)) for a in (here.anchors, here.frames)]
            how = (order, decoders.QUATERNION, decoders.TABLE)
            decoders.decode(*arrays, here.codes, cap, np.array([here.step], np.float32), how, tables, scratch, out)
            off = float(np.sqrt(((out - right) ** 2).sum(axis=2)).max()) / here.step
            found.append(Outcome(off, 1e-3, IN_STEPS, f"cap angle {cap}, {name}"))
    return worst(found)


@CASES.add(
    "lengths on the GPU",
    "tracking at sizes of 1e-6, 1 and 1e6, and 1e7 mm away: arc lengths that shaders add up",
    "the longest streamline's length within 1e-4 of float64's",
    draws=True,
)
def _lengths(setting: Setting) -> Outcome:
    base, found = tracking(4), []
    for name, points in (
        ("1e-6", base.points * 1e-6),
        ("1", base.points),
        ("1e6", base.points * 1e6),
        ("1e7 mm away", base.points + 1e7),
    ):
        fiblets = compress(Streamlines(points, base.offsets))
        length = float(fiblets.decompress(dtype=np.float64).lengths().max())
        with drawing(setting.gl, fiblets) as renderer:
            renderer.render(View((8, 8), camera((8, 8))), FibletStyle(values="arc_length"))
            most = renderer.value_range("arc_length")[1]
        found.append(Outcome(abs(most - length) / length, 1e-4, "of the length", name))
    return worst(found)


@CASES.add(
    "measures of coded sets",
    "arcs of 20 to 80 mm radius at steps of 0.02 to 0.5 mm: coded as against kept exactly",
    "lengths, ends, curvatures, directions, densities and connections within 2 %",
)
def _measures(_: Setting) -> Outcome:
    found = []
    for step in (0.02, 0.1, 0.5):
        t = np.arange(1000)[:, None] * step
        arcs = lines_of(*(r * np.hstack([np.cos(t / r), np.sin(t / r), 0.2 * t / r]) + 0.1 for r in (20.0, 40.0, 80.0)))
        kept, coded = (_all_measures(compress(arcs, exact=exact)) for exact in (True, False))
        for name, true in kept.items():
            off = float(np.abs(coded[name] - true).mean() / np.abs(true).mean())
            found.append(Outcome(off, 0.02, "of the mean", f"{name}, steps of {step} mm"))
    return worst(found)


def _all_measures(fiblets: FibletSet) -> dict[str, Array]:
    """Numbers of every measure that is taken of points; of angles the codec's own study tells."""
    found = {name: np.asarray(measure(fiblets, name).array(), np.float64) for name in OF_POINTS}
    found |= {f"density of {what}": fiblets.density(4.0, contrast=what).values for what in CONTRASTS}
    parcels = np.arange(1, 28).reshape(3, 3, 3), np.array([*(80.0 * np.eye(3, 4) - [0, 0, 0, 80.0]), [0, 0, 0, 1]])
    return found | {"ends": end_points(fiblets), "connectome": fiblets.connectome(parcels, radius=0.0).matrix}


@CASES.add("curvatures of stiff lines", "straight, back and forth, at one place", "finite, 0 where straight")
def _curvatures(_: Setting) -> Outcome:
    straight = compress(lines_of(0.5 * np.arange(200)[:, None] * [1.0, 0.0, 0.0]), max_error=1e-5)
    curvature = np.asarray(measure(straight, "curvature").array())
    rest = [measure(compress(lines), "curvature").array() for name, lines in stiff().items() if name != "denormal"]
    finite = all(np.isfinite(found).all() for found in rest)
    return Outcome(float(np.abs(curvature).max()) if finite else np.inf, 1e-3, "1/mm")
