"""Made-up lines and points of the sizes that the paper on halos measures (Everts et al. 2009, table 1).

Each has exactly the paper's number of lines and vertices, and is like it in all that costs time: how long lines are
and how far apart their vertices, how much lies behind one pixel, and how far apart in memory neighbours are. Numbers
are fixed by the seed.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from pvfiblets.halos import HaloLines, HaloPoints
from pvfiblets.support.ragged import offsets_from_counts

from .tracking import brain_streamlines

HALO_SIZES: dict[str, tuple[int | None, int]] = {
    "shape-small": (None, 172_973),
    "fibres-subset": (11_306, 260_836),
    "office": (786, 278_849),
    "shape-large": (None, 437_645),
    "fibres": (150_352, 1_625_472),
    "water": (1_400, 2_603_605),
    "terrain": (None, 4_440_900),
    "water-dense": (4_475, 7_910_911),
}
"""Lines, None for sets of points, and vertices of each set."""

HALO_SETS = tuple(HALO_SIZES)

FIBRE_STEP = 2.5  # mm between neighbouring vertices: coarse, as tracking from voxel to voxel is
COPIES = 6  # tracts that are pieces of one streamline, each moved by some millimetres
SLICE = 9.0  # mm to the right of the middle: the sagittal slice that picks the subset

ROOM = (6000.0, 4000.0, 3000.0)  # mm
TANK = (1000.0, 500.0, 400.0)  # mm
LAND = 1e6  # mm, length of the terrain's sides
TREE = 8e3  # mm between neighbouring trees

_Floats = npt.NDArray[np.floating]
_Ints = npt.NDArray[np.int64]


def halo_set(name: str, seed: int = 0) -> HaloLines | HaloPoints:
    """Make one of the sets.

    Parameters
    ----------
    name : str
        One of `HALO_SETS`. ``'fibres'``: short pieces of tracts all over a brain, 150,352 lines, 1,625,472 vertices
        (the paper's figure 10a). ``'fibres-subset'``: longer pieces of another set that cross a sagittal slice, 11,306,
        260,836 (figures 1, 8b). ``'office'``: air turning about in a room, 786, 278,849 (figures 8a, 11).
        ``'water'``: water swirling in a tank, 1,400, 2,603,605 (figure 12). ``'water-dense'``: more of the
        same, 4,475, 7,910,911 (figure 13). ``'shape-small'`` and ``'shape-large'``: points on a scanned, bumpy, closed
        surface, 172,973 and 437,645 (figure 15). ``'terrain'``: points on hills, hedges and woods, 4,440,900
        (figure 14).
    seed : int, default: 0
        The same seed gives the same set.

    Returns
    -------
    HaloLines or HaloPoints
        float32, mm. Values: ``"fa"`` of fibres, in 0..1; ``"speed"`` of air and water, of the swiftest 1; ``"height"``
        of points, mm above the lowest.

    Raises
    ------
    ValueError
        If there is no such set.
    """
    if name not in HALO_SIZES:
        raise ValueError(f"there is no halo set {name!r}; choose one of {', '.join(map(repr, HALO_SETS))}")
    # Both sets of water show the same flow.
    stream = HALO_SETS.index("water" if name == "water-dense" else name)
    rng = np.random.default_rng([seed, stream])
    n_lines, n_points = HALO_SIZES[name]
    if n_lines is None:
        points = _terrain(n_points, rng) if name == "terrain" else _shape(n_points, rng)
        return HaloPoints(points, {"height": points[:, 2] - points[:, 2].min()})
    if name.startswith("fibres"):
        return _fibres(n_lines, n_points, rng, crossing=name == "fibres-subset")
    if name == "office":
        return _flow(n_lines, n_points, rng, sides=ROOM, step=45.0, rake=40)
    return _flow(n_lines, n_points, rng, sides=TANK, step=3.0, rake=14)


def _exact_counts(share: _Floats, total: int, least: int, most: int | _Ints) -> _Ints:
    """Vertices of each line: nearly in proportion to its share, from least to most, together exactly so many."""

    def counts_at(scale: float) -> _Ints:
        return np.clip(np.rint(scale * share), least, most).astype(np.int64)

    low, high = 0.0, 2.0 * total / float(share.min())
    for _ in range(80):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if counts_at(middle).sum() <= total else (low, middle)
    counts = counts_at(low)
    counts[np.flatnonzero(counts < most)[: total - int(counts.sum())]] += 1
    return counts


# ------------------------------------------------------------------------------------------------------------- fibres


def _fibres(n: int, n_points: int, rng: np.random.Generator, *, crossing: bool) -> HaloLines:
    """Pieces of streamlines; if asked for, pieces that contain where these cross the slice."""
    share = 0.25 if crossing else 1.0  # of the streamlines that cross the slice; more than enough are made
    base = brain_streamlines(int(n / COPIES / share), FIBRE_STEP, int(rng.integers(1 << 31)), fa=True)
    begins, lengths = base.offsets[:-1], base.counts
    chosen = np.arange(len(lengths))
    if crossing:
        line = np.repeat(chosen, lengths)
        right = base.points[:, 0] > SLICE
        there = np.flatnonzero((right[1:] != right[:-1]) & (line[1:] == line[:-1]))
        chosen, first = np.unique(line[there], return_index=True)
        crossed = there[first] - begins[chosen]
    of = np.sort(np.arange(n) % len(chosen))  # neighbours in memory are neighbours in space, as seeds are
    room = lengths[chosen][of]
    wanted = rng.gamma(3.0 if crossing else 1.1, size=n) + 0.05
    counts = _exact_counts(wanted, n_points, 2, room)
    first_most = room - counts
    start = np.rint(rng.random(n) * first_most).astype(np.int64)
    if crossing:
        at = crossed[of]
        start = np.clip(start, np.maximum(at + 2 - counts, 0), np.minimum(at, first_most))
    offsets = offsets_from_counts(counts)
    rows = np.repeat(begins[chosen][of] + start - offsets[:-1], counts) + np.arange(n_points)
    moved = rng.normal(0.0, 1.5, (n, 3)).astype(np.float32)
    points = base.points[rows] + np.repeat(moved, counts, axis=0)
    return HaloLines(points, offsets, {"fa": base.per_point["fa"][rows]})


# -------------------------------------------------------------------------------------------------------------- flows


def _flow(
    n: int, n_points: int, rng: np.random.Generator, *, sides: tuple[float, float, float], step: float, rake: int
) -> HaloLines:
    """Streamlines of one flow in a box, seeded on short rakes of so many; neighbouring vertices lie ``step`` apart."""
    box = np.array(sides, np.float32)
    field = _field(rng)
    n_rakes = -(-n // rake)
    ends = rng.uniform(0.08, 0.92, (n_rakes, 3))
    along = rng.normal(size=(n_rakes, 3))
    along *= 0.12 / np.linalg.norm(along, axis=1, keepdims=True)
    of, where = np.divmod(np.arange(n), rake)
    seeds = ends[of] + (where / rake)[:, None] * along[of] + rng.normal(0.0, 0.002, (n, 3))
    place = np.clip(seeds, 0.02, 0.98).astype(np.float32).T.copy()
    counts = _exact_counts(rng.uniform(0.65, 1.35, n), n_points, 2, n_points)
    offsets = offsets_from_counts(counts)
    # The longest first: those still to be followed are then the first columns, whatever the number of steps.
    longest = np.argsort(-counts, kind="stable")
    place, row = place[:, longest], offsets[:-1][longest]
    alive = np.searchsorted(-counts[longest], -np.arange(counts.max()), side="left")
    points, speed = np.empty((n_points, 3), np.float32), np.empty(n_points, np.float32)
    for k, count in enumerate(alive):
        now = place[:, :count]
        slope, fast = _slope(field, now, box)
        points[row[:count] + k] = now.T
        speed[row[:count] + k] = fast
        h = np.float32(step)
        second = _slope(field, now + h / 2 * slope, box)[0]
        third = _slope(field, now + h / 2 * second, box)[0]
        fourth = _slope(field, now + h * third, box)[0]
        now += h / 6 * (slope + 2 * (second + third) + fourth)
    return HaloLines(points * box, offsets, {"speed": speed / speed.max()})


def _field(rng: np.random.Generator) -> Callable[[_Floats], _Floats]:
    """Return a flow in the unit cube that has no sources and goes along the walls: (3, n) places to (3, n) velocities.

    It is the curl of a potential, each of whose components is a sum of ``sin(j pi y) sin(k pi z) cos(m pi x)`` and
    the like, which vanish on the walls beside it: there nothing flows through.
    """
    # Large eddies about every axis, mostly about x, and two of half their size.
    modes = [(1, 2, 0), (2, 1, 1), (1, 1, 0), (2, 2, 1), (1, 1, 0)]
    axes = [0, 0, 1, 1, 2]
    sizes = [0.55, 0.22, 0.30, 0.10, 0.30] * np.where(rng.random(5) < 0.5, -1, 1) * rng.uniform(0.8, 1.2, 5)
    terms = [(axis, *mode, np.float32(size)) for axis, mode, size in zip(axes, modes, sizes, strict=True)]

    def flow(place: _Floats) -> _Floats:
        once, other = np.sin(np.pi * place), np.cos(np.pi * place)
        sine = [None, once, 2 * once * other]  # of double angles: cheaper than further sines
        cosine = [np.ones_like(place), other, 1 - 2 * once * once]
        velocity = np.zeros_like(place)
        for a, j, k, m, size in terms:
            b, c = (a + 1) % 3, (a + 2) % 3
            common = size * cosine[m][a]
            velocity[b] += k * common * sine[j][b] * cosine[k][c]
            velocity[c] -= j * common * cosine[j][b] * sine[k][c]
        return velocity

    return flow


def _slope(field: Callable[[_Floats], _Floats], place: _Floats, box: _Floats) -> tuple[_Floats, _Floats]:
    """Return by how much places in the unit cube change per mm along the flow, and how fast it is."""
    velocity = field(place)
    across = velocity * box[:, None]
    speed = np.sqrt((across * across).sum(axis=0)) + np.float32(1e-9)  # 0 only where water stands still
    return velocity / speed, speed


# ------------------------------------------------------------------------------------------------------------- points


def _shape(n: int, rng: np.random.Generator) -> npt.NDArray[np.float32]:
    """Points spread evenly on a ball of 60 mm with limbs and ripples, in the order of a scan: ring by ring."""
    many = 5 * n // 2
    height = 1.0 - 2.0 * (np.arange(many) + 0.5) / many
    angle = np.arange(many) * (np.pi * (3.0 - np.sqrt(5.0))) % (2.0 * np.pi)
    level = np.sqrt(1.0 - height**2)
    direction = np.stack([level * np.cos(angle), level * np.sin(angle), height], axis=1)
    limbs = rng.normal(size=(9, 3))
    limbs /= np.linalg.norm(limbs, axis=1, keepdims=True)
    sharp, long_ = rng.uniform(8.0, 40.0, 9), rng.uniform(0.25, 0.7, 9)
    radius, slope = np.ones(many), np.zeros((many, 3))
    for limb, narrow, length in zip(limbs, sharp, long_, strict=True):
        bump = length * np.exp(narrow * (direction @ limb - 1.0))
        radius += bump
        slope += (narrow * bump)[:, None] * limb
    slope -= np.einsum("ij,ij->i", slope, direction)[:, None] * direction
    # A scan has an even density of points on its surface, however steep: candidates stay by their share of the area.
    area = radius * np.sqrt(radius**2 + np.einsum("ij,ij->i", slope, slope))
    keys = np.log(area) + rng.gumbel(size=many)
    kept = np.sort(np.argpartition(-keys, n - 1)[:n])
    ripples = 0.008 * np.sin(23.0 * direction @ limbs[:3].T + 4.0 * height[:, None]).sum(axis=1)
    points = 60.0 * (radius + ripples)[kept, None] * direction[kept]
    ring = np.floor(0.5 * (1.0 - height[kept]) * np.sqrt(n / 4.0)).astype(np.int64)
    order = np.lexsort((angle[kept], ring))
    return points[order].astype(np.float32)


def _terrain(n: int, rng: np.random.Generator) -> npt.NDArray[np.float32]:
    """Points as an aircraft measures them: hills, with trees in woods and in hedges, flight line by flight line."""
    # Two irrational steps (the powers of the plastic number) fill a square evenly with any number of points.
    index = np.arange(n)
    x, y = index * 0.7548776662466927 % 1.0, index * 0.5698402909980532 % 1.0
    order = np.lexsort((x, np.floor(y * np.sqrt(n) / 4.0)))
    x, y = x[order], y[order]
    hills, woods = _rough(512, 3.2, rng), _rough(512, 2.6, rng)
    ground = 1.5e4 * _sampled(hills, x, y)
    cells = int(LAND / TREE)
    column, row = (np.minimum((at * cells).astype(np.int64), cells - 1) for at in (x, y))
    middles = (np.arange(cells) + 0.5) / cells
    tree = _sampled(woods, *(grid.ravel() for grid in np.meshgrid(middles, middles))).reshape(cells, cells) > 0.8
    tree[rng.choice(cells, cells // 16, replace=False)] = True
    tree[:, rng.choice(cells, cells // 25, replace=False)] = True
    tree &= rng.random((cells, cells)) < 0.9
    # A crown stays within its cell, so that each point has one tree at most to look at.
    width, height = rng.uniform(0.28, 0.42, tree.shape), rng.uniform(7e3, 16e3, tree.shape)
    middle = 0.5 + rng.uniform(-1.0, 1.0, (2, *tree.shape)) * (0.5 - width)
    away = np.hypot(x * cells - column - middle[0][row, column], y * cells - row - middle[1][row, column])
    share = away / width[row, column]
    hit = tree[row, column] & (share < 1.0) & (rng.random(n) < 0.85)  # the rest falls through to the ground
    crown = height[row, column] * (0.35 + 0.65 * np.sqrt(np.maximum(1.0 - share**2, 0.0)))
    lift = np.where(hit, crown * rng.uniform(0.85, 1.0, n), rng.normal(0.0, 60.0, n))
    return np.stack([LAND * x, LAND * y, ground + lift], axis=1).astype(np.float32)


def _rough(size: int, steepness: float, rng: np.random.Generator) -> _Floats:
    """Periodic random heights whose waves shrink with their frequency to that power, of standard deviation 1."""
    wave = np.hypot(np.fft.fftfreq(size)[:, None], np.fft.rfftfreq(size)[None]) * size
    wave[0, 0] = np.inf
    spectrum = np.fft.rfft2(rng.normal(size=(size, size))) * (wave + 1.0) ** (-steepness / 2.0 - 0.5)
    heights = np.fft.irfft2(spectrum, s=(size, size))
    return heights / heights.std()


def _sampled(grid: _Floats, x: _Floats, y: _Floats) -> _Floats:
    """Return a periodic grid's heights at places in the unit square, linear between its nodes."""
    size = len(grid)
    u, v = x * size, y * size
    i, j = u.astype(np.int64), v.astype(np.int64)
    u, v = u - i, v - j
    i, j, right, up = i % size, j % size, (i + 1) % size, (j + 1) % size
    return (1 - v) * ((1 - u) * grid[j, i] + u * grid[j, right]) + v * ((1 - u) * grid[up, i] + u * grid[up, right])
