"""Spline tubes that hardly are any: rays hit the same on the GPU as in float64."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from pvfiblets.engine import View
from pvfiblets.engine.gbuffer import EMPTY
from pvfiblets.engine.tubes.options import TubeStyle
from pvfiblets.engine.tubes.renderer import TubeRenderer
from pvfiblets.report.studies.tubes import reference
from pvfiblets.report.studies.tubes.solver_probe import SolverProbe
from pvfiblets.tubes.curves import controls, sample_spheres
from pvfiblets.tubes.spline_tubes import SplineTubes

from ...cameras import unit
from .case import Cases, Outcome, Setting, refused, worst
from .render_checks import Array, camera, moved_camera, pixel_rays

__all__ = ["CASES"]

CASES = Cases("spline tubes", draws=True)
SIZE = (72, 54)
RAYS = 250
LINE = [[-1.0, 0, 0], [0, 0, 0], [1, 0, 0]]
MET = "hits within a thousandth of the size of the float64 hits, for 99 % of the rays that do not graze"
SHARE = "of the rays are off"
SHOWN = "all pixels but 2 in 1,000 as in float64, where a fiftieth of the radius does not decide"


def size_of(half: Array) -> float:
    """Extent of a half, mm."""
    return float(np.abs(half[:, :3]).max() + half[:, 3].max() + 1e-300)


def rays_at(half: Array) -> tuple[Array, Array]:
    """Rays past a half: at random, and along its axes, exactly and nearly."""
    rng = np.random.default_rng(0)
    size = size_of(half)
    weights = rng.dirichlet((0.7, 0.7, 0.7), RAYS)
    aims = weights @ half[:, :3] + rng.normal(0.0, 0.6, (RAYS, 3)) * (weights @ half[:, 3])[:, None]
    d = unit(rng.normal(size=(RAYS, 3)))
    axes = np.concatenate([np.eye(3), -np.eye(3), [[1, 1e-6, 0], [1, 0, 1e-20], [-1, 1e-12, 1e-12]]])
    d[: 8 * len(axes)] = unit(np.repeat(axes, 8, axis=0))
    aims[: 8 * len(axes) : 8] = 0.0
    aims[1 : 8 * len(axes) : 8] = half[0, :3]
    return aims - 3.0 * size * d, d


def halves(setting: Setting, *given: tuple[Any, Any]) -> Outcome:
    """Meet halves with rays at three scales, and compare with float64."""
    probe = SolverProbe(setting.gl, "illinois", chain=True)
    found = []
    try:
        for places, radii in given:
            half = np.column_stack([np.asarray(places, np.float64), np.asarray(radii, np.float64)])
            o, d = rays_at(half)
            points, size = np.repeat(half[None], RAYS, axis=0), size_of(half)
            wanted, vague = reference.hits(points, o, d), _vague(points, o, d, size)
            for scale in (1.0, 1e-6, 1e6):
                place, t, kind = probe.hits(points * scale, o * scale, d)
                met = kind > 0
                if not np.isfinite(place[met]).all() or not ((t >= 0.0) & (t <= 1.0)).all():
                    return Outcome(np.inf, 0.01, SHARE, "not finite")
                apart = np.abs(place / scale - wanted.l) > 1e-3 * size
                off = ~vague & ((met != (wanted.kind > 0)) | (met & (wanted.kind > 0) & apart))
                note = f"{int((~vague).sum())} of {RAYS} rays, × {scale:g}"
                found.append(Outcome(float(off.mean()), 0.01, SHARE, note))
    finally:
        probe.release()
    return worst(found)


def _vague(points: Array, o: Array, d: Array, size: float) -> npt.NDArray[np.bool_]:
    """Rays whose hit hangs on 1e-4 of the radius, on a millionth of the size, or on a place without radius."""
    every = []
    for factor, more in ((1.0, 0.0), (1.0 + 1e-4, 0.0), (1.0 - 1e-4, 0.0), (1.0, 1e-6 * size)):
        changed = points.copy()
        changed[..., 3] = changed[..., 3] * factor + more
        every.append(reference.hits(changed, o, d).kind > 0)
    every += [reference.hits(points, o + 1e-6 * size * axis, d).kind > 0 for axis in (*np.eye(3), -np.ones(3))]
    balls = sample_spheres(points, 129)
    beside = np.linalg.norm(np.cross(balls[..., :3] - o[:, None], d[:, None]), axis=2)
    touched = np.abs(beside - balls[..., 3]) < 1e-6 * size
    touched[:, 1:-1] &= ((beside - balls[..., 3])[:, :-2] * (beside - balls[..., 3])[:, 2:]) > 0.0
    thin = np.maximum(beside, balls[..., 3]) < 1e-4 * size
    vague: npt.NDArray[np.bool_] = (np.array(every) != every[0]).any(axis=0) | touched.any(axis=1) | thin.any(axis=1)
    return vague


@CASES.add("ends and waists without radius", "radius 0 at the start, the end and in the middle", MET)
def _points(setting: Setting) -> Outcome:
    return halves(setting, (LINE, [0.0, 0.2, 0.4]), (LINE, [0.4, 0.2, 0.0]), (LINE, [0.5, 0.0, 0.5]))


@CASES.add(
    "radius 0, and denormal, everywhere",
    "tubes of radius 0, 1e-40 and 1e-3 mm",
    "finite; as in float64 where rays do not graze",
)
def _none(setting: Setting) -> Outcome:
    return halves(setting, (LINE, [0.0, 0.0, 0.0]), (LINE, [1e-40, 2e-40, 1e-40]), (LINE, [1e-3, 1e-3, 1e-3]))


@CASES.add("radius that grows faster than the length", "by nine times the length, straight and bent", MET)
def _outruns(setting: Setting) -> Outcome:
    bent = [[0.0, 0.0, 0.0], [0.1, 0.2, 0.0], [0.3, 0.1, 0.0]]
    return halves(setting, (LINE, [0.1, 3.0, 9.0]), (bent, [2.0, 0.1, 5.0]))


@CASES.add("balls a million times their length", "length 0, 1e-3 and 1e-6 of the radius", MET)
def _balls(setting: Setting) -> Outcome:
    short = np.array([[0.0, 0.0, 0.0], [0.5, 0.1, 0.0], [1.0, 0.0, 0.0]])
    still = np.zeros((3, 3))
    ones = [1.0, 1.0, 1.0]
    return halves(setting, (1e-3 * short, ones), (1e-6 * short, ones), (still, ones), (still, [0.5, 2.0, 1.0]))


@CASES.add("curves that return upon themselves", "there and back, a cusp, a hairpin, backwards first", MET)
def _return(setting: Setting) -> Outcome:
    return halves(
        setting,
        ([[0, 0, 0], [0, 2, 0], [0, 0, 0]], [0.3, 0.2, 0.3]),
        ([[0, 0, 0], [3, 0, 0], [1, 0, 0]], [0.2, 0.2, 0.2]),
        ([[-1, 0, 0], [30, 0.01, 0], [-1, 0.02, 0]], [0.2, 0.3, 0.2]),
        ([[0, 0, 0], [-1, 0, 0], [1, 0, 0]], [0.2, 0.1, 0.2]),
    )


@CASES.add("almost straight, almost even", "bends of 1e-7, radii that change by 1e-8, tangents 100 times too long", MET)
def _almost(setting: Setting) -> Outcome:
    return halves(
        setting,
        ([[-1, 0, 0], [0, 1e-7, 0], [1, 0, 0]], [0.3, 0.3, 0.3]),
        (LINE, [0.3, 0.3 + 1e-8, 0.3]),
        ([[0, 0, 0], [100, 0, 0], [50, 50, 0]], [0.5, 0.5, 0.5]),
    )


def winding(scale: float = 1.0, shift: float = 0.0, radius: float = 2.0) -> SplineTubes:
    """A tube through twelve nodes about 0, elsewhere and of another size."""
    t, m = np.linspace(0.0, 1.0, 12), 12
    places = np.stack([40.0 * t - 20.0, 10.0 * np.sin(4.0 * t), 6.0 * np.cos(3.0 * t)], axis=1)
    sizes = radius * (1.0 + 0.3 * np.sin(9.0 * t))
    return SplineTubes(
        scale * places + shift, np.stack([np.arange(m - 1), np.arange(1, m)], axis=1), scale * sizes,
        scale * np.gradient(places, axis=0), scale * np.gradient(sizes), False, np.zeros(m - 1, np.int64), 1,
    )  # fmt: skip


def compare(setting: Setting, tubes: SplineTubes, matrix: Array, size: tuple[int, int] = SIZE) -> Outcome:
    """Compare a picture with the hits of all pixels' rays in float64."""
    renderer = TubeRenderer(setting.gl, tubes)
    try:
        buffer = renderer.render(View(size, matrix), TubeStyle(min_width=0.0))
        key = np.frombuffer(buffer.depth.read(), "<u4")
        place = np.frombuffer(buffer.position.read(), "<f4").reshape(-1, 2)[:, 0]
    finally:
        renderer.release()
    there = key != EMPTY
    o, d = pixel_rays(matrix, size)
    curves = controls(tubes).reshape(-1, 3, 4)
    kinds, depths = [], []
    for factor in (1.0, 0.98, 1.02):
        changed = curves.copy()
        changed[..., 3] *= factor
        met = reference.nearest_hits(changed, o, d, start=0.0)
        clip = np.column_stack([o + np.nan_to_num(met.l)[:, None] * d, np.ones(len(o))]) @ matrix.T
        depth = (clip[:, 2] / clip[:, 3] + 1.0) / 2.0
        kinds.append((met.kind == reference.ENTRY) & (depth <= 1.0))
        depths.append(depth)
    sure = (kinds[0] == kinds[1]) & (kinds[0] == kinds[2])
    both = there & kinds[0] & sure
    off = np.abs(key / 4294967296.0 - depths[0]) > 2.0**-22 + np.abs(depths[2] - depths[0])
    wrong = (sure & (there != kinds[0])) | (both & off)
    if not np.isfinite(place[there]).all() or not there.any():
        return Outcome(np.inf, 2.0, "pixels in 1,000", "nothing drawn, or not finite")
    return Outcome(1e3 * float(wrong.mean()), 2.0, "pixels in 1,000", f"{int(both.sum())} pixels drawn")


@CASES.add("offsets of ±1e7 mm", "a tube and its camera moved by 1e7 mm either way", SHOWN)
def _far_away(setting: Setting) -> Outcome:
    matrix = camera(SIZE, eye=(0.0, -60.0, 20.0), near=5.0, far=200.0)
    shifts = (1e7, -1e7)
    return worst([compare(setting, winding(shift=s), moved_camera(matrix, 1.0, s)) for s in shifts])


@CASES.add("sizes of 1e-6 and 1e6", "a tube and its camera scaled by a millionth and by a million", SHOWN)
def _sizes(setting: Setting) -> Outcome:
    matrix = camera(SIZE, eye=(0.0, -60.0, 20.0), near=5.0, far=200.0)
    sizes = (1e-6, 1e6)
    return worst([compare(setting, winding(s), moved_camera(matrix, s, 0.0)) for s in sizes])


@CASES.add("near plane at a millionth of the far", "near 0.001 mm, far 1000 mm", SHOWN)
def _near(setting: Setting) -> Outcome:
    return compare(setting, winding(), camera(SIZE, eye=(0.0, -40.0, 10.0), near=1e-3, far=1e3))


@CASES.add("a huge radius", "a tube 1000 mm thick, seen from 3000 mm", SHOWN, long=True)
def _huge(setting: Setting) -> Outcome:
    return compare(setting, winding(radius=1e3), camera(SIZE, eye=(0.0, -3000.0, 900.0), near=100.0, far=1e4))


@CASES.add("windows of 1 × 1 and one pixel high or wide", "four sizes", SHOWN)
def _small(setting: Setting) -> Outcome:
    sizes = ((1, 1), (1, 50), (60, 1), (3, 2))
    return worst(
        [
            compare(
                setting,
                winding(radius=8.0),
                camera(s, eye=(0.0, -60.0, 20.0), target=(0.0, 9.1, 0.4), near=5.0, far=200.0, height=12.0),
                s,
            )
            for s in sizes
        ]
    )


@CASES.add("no tubes", "no segments; spheres of radius 0 alone", "an empty picture")
def _nothing(setting: Setting) -> Outcome:
    none, no_segments, pixels = np.zeros((0, 3)), np.zeros((0, 2), np.int64), 0
    empty = SplineTubes(none, no_segments, np.zeros(0), none, np.zeros(0), False, np.zeros(0, np.int64), 0)
    still, own = np.zeros((3, 3)), np.array([[0, 0], [1, 1]])
    dots = SplineTubes(np.eye(3), own, np.zeros(3), still, np.zeros(3), False, np.arange(2), 2)
    for tubes in (empty, dots):
        renderer = TubeRenderer(setting.gl, tubes)
        try:
            buffer = renderer.render(View(SIZE, camera(SIZE, eye=(0.0, -60.0, 20.0))), TubeStyle(min_width=0.0))
            pixels += int((np.frombuffer(buffer.depth.read(), "<u4") != EMPTY).sum())
        finally:
            renderer.release()
    return Outcome(float(pixels), 0.0, "pixels shown")


@CASES.add("tubes that are none", "NaN places, negative and NaN radii, missing nodes", "an error each", draws=False)
def _bad(_: Setting) -> Outcome:
    def tube(x: float = 1.0, radius: float = 1.0, last: int = 1) -> SplineTubes:
        points, radii = np.array([[0.0, 0.0, 0.0], [x, 0.0, 0.0]]), np.array([1.0, radius])
        ends = np.array([[0, last]])
        return SplineTubes(points, ends, radii, np.zeros((2, 3)), np.zeros(2), False, np.zeros(1, np.int64), 1)

    return refused(
        ValueError,
        "finite|expected 0 or more|segment",
        lambda: tube(x=np.nan),
        lambda: tube(radius=-1.0),
        lambda: tube(radius=np.nan),
        lambda: tube(last=7),
    )
