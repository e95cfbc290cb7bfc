"""Made-up sets of spline tubes of the sizes that the paper measures (Russig et al. 2020, section 4).

Each has exactly the numbers of tubes and segments of the paper's set of that name, and is like it in all that costs
time: how long a segment is for its radius, how much lies behind one pixel, and the whole size. Numbers are fixed by the
seed. All have ``values["value"]`` at every node; all but "brain" vary in radius along each tube.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from pvfiblets.streamlines import Streamlines
from pvfiblets.support.ragged import offsets_from_counts
from pvfiblets.tubes.build import as_spline_tubes
from pvfiblets.tubes.spline_tubes import SplineTubes

from .tracking import brain_streamlines

SIZES = {
    "fibers": (241, 3530),
    "hotroom": (722, 30948),
    "bundle": (1250, 105640),
    "brain": (1701, 114489),
    "furball": (10000, 787327),
}
"""Tubes and segments of each set."""

TUBE_SETS = tuple(SIZES)

_Array = npt.NDArray[np.float64]
_Ints = npt.NDArray[np.int64]
_Made = tuple[_Ints, _Array, _Array, _Array]
"""Nodes of each tube; positions (n, 3) in mm, radii (n,) in mm and values (n,) of all nodes."""


def tube_set(name: str, seed: int = 0) -> SplineTubes:
    """Make one of the sets.

    Parameters
    ----------
    name : {'fibers', 'hotroom', 'bundle', 'brain', 'furball'}
        ``'fibers'``: 241 coarse tubes, 3530 segments, a bundle of fibres spread to a bent sheet. ``'hotroom'``: 722,
        30948, air rising over heaters, spreading under the ceiling and sinking; segments are much shorter than the
        radius, and many a tube starts in a blob of dozens of them. ``'bundle'``: 1250, 105640, strands twisted to
        strands of strands. ``'brain'``: 1701, 114489, thin tubes of one radius through a made-up tractogram.
        ``'furball'``: 10000, 787327, wavy hairs on a ball.
    seed : int, default: 0
        The same seed gives the same set.

    Returns
    -------
    SplineTubes
        Derivatives by length (``scaled``), ``values["value"]`` in 0..1.

    Raises
    ------
    ValueError
        If there is no such set.
    """
    makers = {"fibers": _fibers, "hotroom": _hotroom, "bundle": _bundle, "brain": _brain, "furball": _furball}
    if name not in makers:
        raise ValueError(f"there is no tube set {name!r}; choose one of {', '.join(map(repr, TUBE_SETS))}")
    rng = np.random.default_rng([seed, TUBE_SETS.index(name)])
    counts, points, radius, value = makers[name](*SIZES[name], rng)
    lines = Streamlines(points, offsets_from_counts(counts), {"value": np.clip(value, 0.0, 1.0)})
    return as_spline_tubes(lines, radius=radius, scalars="value")


def _counts(share: npt.ArrayLike, n_segments: int) -> _Ints:
    """Nodes of each tube, its segments in proportion to its share, and together exactly so many."""
    total = np.cumsum(share, dtype=np.float64)
    ends = np.rint(total / total[-1] * n_segments).astype(np.int64)
    return np.diff(ends, prepend=0) + 1


def _unlike(n_tubes: int, n_segments: int, rng: np.random.Generator) -> tuple[_Ints, _Ints, _Array]:
    """Nodes of tubes that are unlike each other by about a third, and what :func:`_places` says of them."""
    counts = _counts(rng.uniform(0.65, 1.35, n_tubes), n_segments)
    return counts, *_places(counts)


def _places(counts: _Ints) -> tuple[_Ints, _Array]:
    """The tube of each node, and how far along it the node is, 0 to 1."""
    tube = np.repeat(np.arange(len(counts)), counts)
    within = np.arange(len(tube)) - np.repeat(np.cumsum(counts) - counts, counts)
    return tube, within / (counts[tube] - 1)


def _unit(vectors: _Array) -> _Array:
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def _fibers(n: int, n_segments: int, rng: np.random.Generator) -> _Made:
    """A round bundle that fans out to a bent sheet."""
    counts, tube, t = _unlike(n, n_segments, rng)
    # Sunflower seeds fill the bundle's cross section evenly.
    ring, angle = np.sqrt((np.arange(n) + 0.5) / n), np.arange(n) * np.pi * (3.0 - np.sqrt(5.0))
    across = np.stack([ring * np.cos(angle), ring * np.sin(angle)], axis=1) + rng.normal(0.0, 0.02, (n, 2))
    begin, end = rng.uniform(-4.0, 4.0, n), rng.uniform(-10.0, 6.0, n)
    along = begin[tube] + t * (100.0 + end - begin)[tube]
    open_ = 1.0 / (1.0 + np.exp(-(along - 55.0) / 9.0))
    u, v = across[tube].T
    wave = rng.uniform(0.0, 2.0 * np.pi, (2, n))[:, tube]
    x = (9.0 + 36.0 * open_) * u + 0.7 * np.sin(along / 7.0 + wave[0])
    # The sheet bends about the way the bundle runs, and droops towards its edges.
    y = (9.0 - 6.0 * open_) * v + 18.0 * open_ * (u**2 - 0.3) + 0.7 * np.sin(along / 9.0 + wave[1])
    points = np.stack([x, y, along + 12.0 * open_ * u**2], axis=1)
    thick = 0.55 + 0.45 * np.sin(np.pi * t) + 0.25 * np.sin(9.0 * t + wave[0]) ** 2
    radius = rng.uniform(0.28, 0.55, n)[tube] * thick
    return counts, points, radius, 0.5 + 0.5 * np.sin(3.0 * t + 2.0 * u)


def _hotroom(n: int, n_segments: int, rng: np.random.Generator) -> _Made:
    """Air in a room of 6 x 4 x 3 m with three heaters, its paths in mm; what starts near the floor lingers there."""
    counts, tube, t = _unlike(n, n_segments, rng)
    heaters = np.array([[1300.0, 1100.0], [4500.0, 1500.0], [2900.0, 3100.0]])
    of = rng.integers(0, len(heaters), n)
    place = np.empty((n, 3))
    place[:, :2] = heaters[of] + rng.normal(0.0, 260.0, (n, 2))
    place[:, 2] = rng.uniform(80.0, 300.0, n)
    stray = rng.random(n) < 0.3
    place[stray] = rng.uniform([300.0, 300.0, 300.0], [5700.0, 3700.0, 2700.0], (int(stray.sum()), 3))
    phase = rng.uniform(0.0, 2.0 * np.pi, (6, n))
    lingers = ~stray & (rng.random(n) < 0.8)
    longest = int(counts.max())
    paths = np.empty((longest, n, 3))
    step = rng.uniform(24.0, 62.0, n)
    for k in range(longest):
        paths[k] = place
        flow = _air(place, heaters) + 0.35 * np.sin(place[:, [1, 2, 0]] / 310.0 + phase[:3].T + 0.05 * k)
        # Slow air at the start: dozens of nodes a few millimetres apart, in a tube that is thick there.
        slow = np.where(lingers, 0.06 + 0.94 / (1.0 + np.exp(-(k - 24.0) / 3.0)), 1.0)
        place = place + _unit(flow) * (step * slow)[:, None]
        place = np.clip(place, 60.0, np.array([5940.0, 3940.0, 2940.0]) - 2.0 * np.sin(phase[3:].T + k))
    within = np.rint(t * (counts[tube] - 1)).astype(np.int64)
    points = paths[within, tube]
    blob = np.where(lingers[tube], 1.0 / (1.0 + np.exp((within - 27.0) / 1.5)), 0.0)
    thin = (70.0 + 30.0 * np.sin(5.0 * t + phase[0][tube])) * (0.6 + 0.4 * np.cos(np.pi * t)) + 25.0
    radius = thin + blob * (rng.uniform(100.0, 160.0, n)[tube] + 8.0 * np.cos(0.3 * within) - thin)
    return counts, points, radius, 0.75 * np.exp(-2.0 * t) + 0.25 * points[:, 2] / 3000.0


def _air(place: _Array, heaters: _Array) -> _Array:
    """Direction of the air: up over heaters, outwards under the ceiling, down along walls, back over the floor."""
    flow = np.zeros(place.shape)
    height = place[:, 2] / 3000.0
    for heater in heaters:
        away = place[:, :2] - heater
        distance = np.linalg.norm(away, axis=1) + 1.0
        plume = np.exp(-((distance / 520.0) ** 2))
        flow[:, 2] += 1.6 * plume - 0.16
        turn = np.stack([-away[:, 1], away[:, 0]], axis=1)
        radial = np.tanh(5.0 * (height - 0.72)) * np.exp(-distance / 2600.0)
        flow[:, :2] += (radial[:, None] * away + 0.3 * turn) / distance[:, None]
    flow[:, 2] *= np.clip(4.0 * (1.02 - height), 0.0, 1.0) * np.where(flow[:, 2] < 0, np.clip(5.0 * height, 0, 1), 1.0)
    return flow


def _bundle(n: int, n_segments: int, rng: np.random.Generator) -> _Made:
    """A rope: strands about strands about one bent axis, each level twisted the other way."""
    counts, tube, t = _unlike(n, n_segments, rng)
    along = (t - 0.5) * 240.0 + rng.uniform(-5.0, 5.0, n)[tube]
    # 5 strands of 10 yarns of 25 tubes; sunflower seeds again, at each level.
    levels = ((5, 13.0, 0.030), (10, 4.6, -0.075), (25, 1.25, 0.17))
    index = np.arange(n)
    offset = np.zeros((len(tube), 2))
    loose = 1.0 + 0.8 * (along / 120.0) ** 4
    for size, width, twist in levels:
        member, index = index % size, index // size
        ring = width * np.sqrt((member + 0.5) / size) + rng.normal(0.0, 0.02 * width, n)
        angle = member * np.pi * (3.0 - np.sqrt(5.0)) + rng.normal(0.0, 0.05, n)
        turned = angle[tube] + twist * along + 0.25 * np.sin(0.05 * along + 3.0 * angle[tube])
        offset += (ring[tube] * loose)[:, None] * np.stack([np.cos(turned), np.sin(turned)], axis=1)
    bend = 18.0 * np.sin(along / 60.0)
    points = np.stack([offset[:, 0] + bend, offset[:, 1] + 0.4 * bend * np.cos(along / 45.0), along], axis=1)
    phase = rng.uniform(0.0, 2.0 * np.pi, n)[tube]
    radius = rng.uniform(0.10, 0.19, n)[tube] * (1.0 + 0.35 * np.sin(0.21 * along + phase))
    return counts, points, radius, 0.5 + 0.5 * np.sin(0.05 * along + 0.3 * phase)


def _brain(n: int, n_segments: int, rng: np.random.Generator) -> _Made:
    """Nodes at even distances on streamlines; the longer a streamline the more nodes it has."""
    lines = brain_streamlines(n, 1.0, int(rng.integers(1 << 31)))
    counts = _counts(lines.counts - 1, n_segments)
    tube, t = _places(counts)
    row = lines.offsets[tube] + t * (lines.counts - 1)[tube]
    first = np.minimum(row.astype(np.int64), lines.offsets[tube + 1] - 2)
    part = (row - first)[:, None]
    given = lines.points.astype(np.float64)
    points = (1.0 - part) * given[first] + part * given[first + 1]
    return counts, points, np.full(len(points), 0.25), np.clip(1.2 * np.minimum(t, 1.0 - t) + 0.3, 0.0, 1.0)


def _furball(n: int, n_segments: int, rng: np.random.Generator) -> _Made:
    """Wavy hairs of 60 to 110 mm on a ball of 40 mm, thick at the root, thin at the tip."""
    counts, tube, t = _unlike(n, n_segments, rng)
    height = 1.0 - 2.0 * (np.arange(n) + 0.5) / n
    angle = np.arange(n) * np.pi * (3.0 - np.sqrt(5.0))
    level = np.sqrt(1.0 - height**2)
    normal = np.stack([level * np.cos(angle), level * np.sin(angle), height], axis=1)
    normal = _unit(normal + rng.normal(0.0, 0.01, (n, 3)))
    side = _unit(np.cross(normal, rng.normal(size=(n, 3))))
    up = np.cross(normal, side)
    length = rng.uniform(60.0, 110.0, n)
    phase, rate = rng.uniform(0.0, 2.0 * np.pi, (2, n)), rng.uniform(9.0, 17.0, n)
    reach = 40.0 + t * length[tube]
    swing = length[tube] * 0.05 * t
    curl = rate[tube] * t
    points = reach[:, None] * normal[tube]
    points += (swing * np.sin(curl + phase[0][tube]) + 22.0 * t**2)[:, None] * side[tube]
    points += (swing * np.cos(1.13 * curl + phase[1][tube]))[:, None] * up[tube]
    points[:, 2] -= 26.0 * t**2  # hair hangs
    radius = rng.uniform(0.16, 0.30, n)[tube] * (1.0 - 0.75 * t) * (1.0 + 0.2 * np.sin(2.0 * curl))
    return counts, points, radius, t
