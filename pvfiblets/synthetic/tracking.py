"""Made-up tractograms that look and measure like tracking on a whole brain.

Every streamline is a Bézier curve of degree five around the course of one anatomical bundle. The
curve's ends fan out independently of each other and are pushed onto a folded ellipsoid, the cortex.
The curve is then *tracked*: at every step the streamline goes exactly ``step`` mm along the
curve's tangent, turned by a slow wander (as in any tracking) and, when asked for, by an independent
random angle at every step (as in probabilistic tracking such as MRtrix' iFOD1). So steps are
constant and turns are distributed as in real files, which is what a codec meets.

Coordinates are RAS+ mm, lengths lie between 20 and 200 mm, and a seed fixes every number.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import comb

import numpy as np

from pvfiblets.streamlines import Streamlines

LENGTHS = (20.0, 200.0)
SMALLEST_RADIUS = 2.5  # mm, of a bundle's bends
CHUNK = 8192  # streamlines made at a time; each chunk has its own random stream

_CENTRE = np.array([0.0, -18.0, 8.0])
_HALF_AXES = np.array([68.0, 86.0, 62.0])

_Points = list[tuple[float, float, float]]

# Per bundle: share of all streamlines; six control points (mm, right side); how far one unit of
# the sheet coordinate in [-1, 1] moves each of them; spread (mm) per point; which ends are cortex.
_BUNDLES: dict[str, tuple[float, _Points, _Points, list[float], tuple[bool, bool]]] = {
    "callosum": (
        0.20,
        [(-45, -18, 62), (-34, -18, 38), (-14, -16, 20),
         (14, -16, 20), (34, -18, 38), (45, -18, 62)],
        [(8, 66, -22), (4, 52, -14), (0, 34, -4), (0, 34, -4), (-4, 52, -14), (-8, 66, -22)],
        [13, 6, 2, 2, 6, 13],
        (True, True),
    ),
    "corona": (
        0.14,
        [(34, -18, 70), (28, -17, 45), (25, -14, 20), (20, -14, -2), (11, -18, -22), (6, -28, -50)],
        [(2, 48, -12), (2, 32, -6), (1, 14, 0), (0, 6, 0), (0, 2, 0), (0, 1, 0)],
        [11, 6, 3, 2, 1.6, 2],
        (True, False),
    ),
    "thalamic": (
        0.10,
        [(40, -20, 60), (34, -20, 42), (28, -18, 26), (22, -18, 14), (16, -18, 9), (9, -18, 7)],
        [(-4, 72, -38), (0, 54, -22), (2, 34, -12), (2, 16, -5), (1, 7, -1), (0, 5, 0)],
        [12, 7, 4, 2.5, 2, 2.5],
        (True, False),
    ),
    "arcuate": (
        0.07,
        [(50, 28, 14), (38, 10, 32), (36, -18, 36), (38, -52, 34), (50, -50, 2), (60, -22, -14)],
        [(0, 12, 8), (0, 3, 3), (0, 0, 2), (0, -2, 2), (0, -2, 4), (0, 12, 6)],
        [9, 4, 2.5, 3, 4, 9],
        (True, True),
    ),
    "cingulum": (
        0.05,
        [(9, 42, -4), (10, 46, 24), (9, 8, 40), (9, -46, 48), (14, -66, 6), (24, -30, -18)],
        [(0, 2, -3), (0, 2, 2), (0, 0, 2), (0, -2, 2), (0, -2, 0), (0, 4, 0)],
        [4, 2, 1.8, 1.8, 2, 4],
        (False, False),
    ),
    "fronto-occipital": (
        0.06,
        [(28, 56, 4), (30, 28, -6), (32, 4, -10), (38, -34, 2), (32, -64, 2), (20, -96, 4)],
        [(0, 0, 14), (0, 0, 6), (0, 0, 2), (0, 0, 2), (0, 0, 6), (0, 0, 12)],
        [10, 5, 2, 3, 5, 9],
        (True, True),
    ),
    "longitudinal": (
        0.05,
        [(48, 6, -34), (46, -12, -26), (44, -34, -16), (40, -54, -8), (34, -74, -4), (26, -96, 0)],
        [(0, 4, 8), (0, 0, 5), (0, 0, 4), (0, 0, 4), (0, 0, 8), (0, 0, 12)],
        [7, 4, 3, 3, 5, 8],
        (True, True),
    ),
    "uncinate": (
        0.03,
        [(26, 50, -10), (30, 30, -6), (36, 8, -2), (40, -6, -16), (40, 2, -30), (44, 12, -36)],
        [(4, 0, 4), (2, 0, 2), (0, 0, 1), (0, 0, 1), (0, 2, 1), (0, 4, 4)],
        [7, 4, 2, 2, 3, 6],
        (True, True),
    ),
    "optic": (
        0.04,
        [(22, -24, -3), (34, -8, -8), (46, -22, -12), (38, -56, -2), (26, -78, 2), (12, -100, 2)],
        [(0, 0, 1), (0, 6, -4), (0, 0, -5), (0, 0, 2), (0, 0, 6), (0, 0, 10)],
        [1.5, 2, 2.5, 3, 4, 7],
        (False, True),
    ),
    "cerebellar": (
        0.08,
        [(32, -62, -50), (26, -62, -46), (20, -54, -40),
         (10, -44, -36), (-8, -26, -38), (-14, -40, -34)],
        [(6, 14, 11), (4, 10, 8), (2, 4, 4), (0, 2, 1), (0, 1, 1), (-4, 0, 4)],
        [4, 3, 2.5, 2, 2, 3],
        (False, False),
    ),
    "short": (0.20, [], [], [], (True, True)),  # U-fibres between neighbouring gyri, made apart
}
BUNDLES = tuple(_BUNDLES)


def streamline_count(segments: float, step: float) -> int:
    """Return how many streamlines of a step, mm, have about so many segments: they are 94 mm long on average."""
    return max(round(segments * step / 94.0), 1)


def brain_streamlines(
    n_streamlines: int,
    step: float = 0.5,
    seed: int = 0,
    *,
    noise: float = 0.0,
    wander: float = 4.0,
    fa: bool = False,
) -> Streamlines:
    """Make a whole-brain-like tractogram of constant step.

    Parameters
    ----------
    n_streamlines : int
        How many streamlines.
    step : float, default: 0.5
        Distance between consecutive points, mm.
    seed : int, default: 0
        The same seed gives the same numbers.
    noise : float, default: 0.0
        Standard deviation, in degrees per axis, of an independent turn at every step; about 4 at
        a step of 0.2 mm resembles probabilistic tracking.
    wander : float, default: 4.0
        Standard deviation, in degrees per axis, of a slow turning to and fro along the streamline.
    fa : bool, default: False
        Also make the per-point array ``fa``, high in the deep white matter, low near the ends.

    Returns
    -------
    Streamlines
        float32 points, the per-streamline array ``bundle`` (uint8, an index into ``BUNDLES``) and
        one group per bundle.

    Raises
    ------
    ValueError
        If ``n_streamlines`` is negative or ``step`` is not between 0 and 20 mm.
    """
    chunks = list(
        iter_brain_streamlines(n_streamlines, step, seed, noise=noise, wander=wander, fa=fa)
    )
    if not chunks:
        return Streamlines(np.zeros((0, 3), np.float32), np.zeros(1, np.int64))
    points = np.concatenate([chunk.points for chunk in chunks])
    lengths = np.concatenate([np.diff(chunk.offsets) for chunk in chunks])
    bundle = np.concatenate([chunk.per_streamline["bundle"] for chunk in chunks])
    per_point = {}
    if fa:
        per_point["fa"] = np.concatenate([chunk.per_point["fa"] for chunk in chunks])
    groups = {name: np.flatnonzero(bundle == index) for index, name in enumerate(BUNDLES)}
    return Streamlines(
        points,
        np.concatenate([[0], np.cumsum(lengths, dtype=np.int64)]),
        per_point=per_point,
        per_streamline={"bundle": bundle},
        groups={name: members for name, members in groups.items() if len(members)},
    )


def iter_brain_streamlines(
    n_streamlines: int,
    step: float = 0.5,
    seed: int = 0,
    *,
    noise: float = 0.0,
    wander: float = 4.0,
    fa: bool = False,
) -> Iterator[Streamlines]:
    """Make the streamlines of :func:`brain_streamlines` in chunks of at most ``CHUNK`` each, without groups."""
    if n_streamlines < 0:
        raise ValueError(f"n_streamlines is {n_streamlines}; give 0 or more")
    if not 0.0 < step <= LENGTHS[0]:
        raise ValueError(f"step is {step} mm; give a value above 0 and up to {LENGTHS[0]:g} mm")
    for index, begin in enumerate(range(0, n_streamlines, CHUNK)):
        rng = np.random.default_rng([seed, index])
        yield _chunk(min(CHUNK, n_streamlines - begin), step, rng, noise, wander, fa)


def _chunk(
    n: int, step: float, rng: np.random.Generator, noise: float, wander: float, fa: bool
) -> Streamlines:
    """Make ``n`` streamlines with one random stream."""
    shares = np.array([bundle[0] for bundle in _BUNDLES.values()])
    kinds = rng.choice(len(shares), size=n, p=shares / shares.sum()).astype(np.uint8)
    control = np.empty((n, 6, 3))
    redo = np.ones(n, bool)
    for _ in range(12):  # tracking does not turn on the spot: such curves are drawn again
        for index, name in enumerate(BUNDLES):
            members = np.flatnonzero(redo & (kinds == index))
            make = _u_fibres if name == "short" else _bundle
            control[members] = make(name, len(members), rng)
        redo = _tightest_radius(control) < SMALLEST_RADIUS
        if not redo.any():
            break
    control[:, :, 0] *= rng.choice([-1.0, 1.0], size=n)[:, None]  # left or right

    tangents, fraction, lengths = _tangents(control, step)
    offsets = np.concatenate([[0], np.cumsum(lengths)])
    if wander > 0.0:
        tangents = _turned(tangents, _slow(offsets, step, np.radians(wander), rng))
    if noise > 0.0:
        tangents = _turned(tangents, rng.normal(0.0, np.radians(noise), tangents.shape))

    # Tracking: a point is its predecessor plus one step along the tangent there. Summing within
    # each streamline is one running sum over all, less the sum at its start.
    running = np.zeros_like(tangents)
    np.cumsum(step * tangents[:-1], axis=0, out=running[1:])
    start = np.repeat(running[offsets[:-1]] - control[:, 0], lengths, axis=0)
    points = (running - start).astype(np.float32)
    per_point = {}
    if fa:
        ends = np.minimum(fraction, 1.0 - fraction)
        speckle = rng.normal(0.0, 0.03, len(points))
        per_point["fa"] = np.clip(0.15 + 1.1 * ends + speckle, 0.0, 1.0).astype(np.float32)
    return Streamlines(points, offsets, per_point=per_point, per_streamline={"bundle": kinds})


def _bundle(name: str, n: int, rng: np.random.Generator) -> np.ndarray:
    """Return (n, 6, 3) control points of one anatomical bundle, right side."""
    _, course, sheet, spread, cortex = _BUNDLES[name]
    where = rng.uniform(-1.0, 1.0, (n, 1, 1))
    control = np.asarray(course, float) + where * np.asarray(sheet, float)
    # The two ends fan independently; the middle is a blend of both.
    weight = np.linspace(0.0, 1.0, 6)[None, :, None]
    fan = (1.0 - weight) * rng.normal(size=(n, 1, 3)) + weight * rng.normal(size=(n, 1, 3))
    control = control + np.asarray(spread, float)[None, :, None] * fan
    for end, ends_there in zip((0, 5), cortex, strict=True):
        if ends_there:
            control[:, end] = _on_cortex(control[:, end])
    return control


def _u_fibres(_name: str, n: int, rng: np.random.Generator) -> np.ndarray:
    """Return (n, 6, 3) control points of short fibres that dip under one sulcus."""
    normal = rng.normal(size=(n, 3))
    normal[:, 0] = np.abs(normal[:, 0]) + 0.1
    normal[:, 2] = np.where(normal[:, 2] < -0.4, -normal[:, 2], normal[:, 2])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    along = np.cross(normal, rng.normal(size=(n, 3)))
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    middle = _on_cortex(_CENTRE + _HALF_AXES * normal)
    reach = rng.uniform(9.0, 24.0, (n, 1))
    depth = rng.uniform(0.6, 1.1, (n, 1)) * reach
    first, last = _on_cortex(middle - reach * along), _on_cortex(middle + reach * along)
    inward = -depth * normal
    jitter = rng.normal(0.0, 1.0, (2, n, 3))
    return np.stack(
        [first, first + 0.8 * inward, first + 0.35 * (last - first) + 1.3 * inward + jitter[0],
         last - 0.35 * (last - first) + 1.3 * inward + jitter[1], last + 0.8 * inward, last],
        axis=1,
    )


def _on_cortex(points: np.ndarray) -> np.ndarray:
    """Move points along their ray from the centre onto a folded ellipsoid with a flat underside."""
    direction = (points - _CENTRE) / _HALF_AXES
    direction /= np.linalg.norm(direction, axis=1, keepdims=True) + 1e-12
    x, y, z = direction.T
    folds = 0.025 * np.sin(17 * y + 5 * x) + 0.02 * np.sin(19 * z - 7 * y)
    cleft = 0.10 * np.exp(-((x / 0.12) ** 2))  # between the hemispheres
    underside = 0.22 * np.clip(-z, 0.0, 1.0) ** 2
    return _CENTRE + _HALF_AXES * direction * (1.0 + folds - cleft - underside)[:, None]


def _tightest_radius(control: np.ndarray) -> np.ndarray:
    """Return each curve's smallest radius of curvature, mm, from 49 samples."""
    t = np.linspace(0.0, 1.0, 49)
    first = 5.0 * _bernstein(4, t) @ np.diff(control, axis=1)
    second = 20.0 * _bernstein(3, t) @ np.diff(control, 2, axis=1)
    speed = np.linalg.norm(first, axis=2)
    bend = np.linalg.norm(np.cross(first, second), axis=2)
    return (speed**3 / np.maximum(bend, 1e-9)).min(axis=1)


def _tangents(control: np.ndarray, step: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return unit tangents at every ``step`` mm, the fraction along, and points per streamline."""
    n = len(control)
    t = np.linspace(0.0, 1.0, 49)
    positions = _bernstein(5, t) @ control
    arc = np.zeros((n, len(t)))
    np.cumsum(np.linalg.norm(np.diff(positions, axis=1), axis=2), axis=1, out=arc[:, 1:])
    total = np.clip(arc[:, -1], LENGTHS[0], LENGTHS[1])
    lengths = np.floor(total / step + 1e-9).astype(np.int64) + 1
    # Too short a curve is tracked as if it were scaled up; too long a one is cut.
    arc *= np.maximum(1.0, LENGTHS[0] / np.maximum(arc[:, -1:], 1e-9))
    lengths = np.where(lengths - 1 < LENGTHS[0] / step - 1e-9, lengths + 1, lengths)

    which = np.repeat(np.arange(n), lengths)
    within = np.arange(len(which)) - np.repeat(np.cumsum(lengths) - lengths, lengths)
    # One interpolation for all: each curve's arc lengths lie in a stretch of their own.
    stretch = 2.0 * arc.max() + 1.0
    flat = arc + stretch * np.arange(n)[:, None]
    u = np.interp(stretch * which + step * within, flat.ravel(), np.tile(t, n))
    # The curve's derivative is a Bézier curve of degree four.
    hodograph = np.diff(control, axis=1)[which]
    tangents = np.einsum("pk,pkd->pd", _bernstein(4, u), hodograph)
    tangents /= np.linalg.norm(tangents, axis=1, keepdims=True) + 1e-12
    return tangents, within / np.maximum(lengths[which] - 1, 1), lengths


def _slow(
    offsets: np.ndarray, step: float, size: float, rng: np.random.Generator
) -> np.ndarray:
    """Return (n_points, 3) turns that vary over 6 to 30 mm, of standard deviation ``size``."""
    lengths = np.diff(offsets)
    arc = step * (np.arange(offsets[-1]) - np.repeat(offsets[:-1], lengths))
    turns = np.zeros((offsets[-1], 3))
    for shortest, longest in ((6.0, 12.0), (12.0, 30.0)):
        rate = 2.0 * np.pi / rng.uniform(shortest, longest, (len(lengths), 3))
        phase = rng.uniform(0.0, 2.0 * np.pi, (len(lengths), 3))
        for axis in range(3):
            turns[:, axis] += size * np.sin(
                np.repeat(rate[:, axis], lengths) * arc + np.repeat(phase[:, axis], lengths)
            )
    return turns


def _turned(tangents: np.ndarray, turns: np.ndarray) -> np.ndarray:
    """Add small turns (radians) across the tangents and bring these back to length one."""
    turned = tangents + turns
    turned /= np.linalg.norm(turned, axis=1, keepdims=True)
    return turned


def _bernstein(degree: int, t: np.ndarray) -> np.ndarray:
    """Return the (len(t), degree + 1) Bernstein polynomials."""
    t = t[:, None]
    k = np.arange(degree + 1)
    binomial = np.array([comb(degree, int(i)) for i in k], float)
    return binomial * t**k * (1.0 - t) ** (degree - k)
