"""Made-up volumes to cast rays through: vessels as an angiogram shows them, and a head of nested, folded shells.

What they show is fixed by the seed in mm; more voxels show the same more finely, so that times of 64^3 and 512^3 can be
compared.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from pvfiblets.volumes.volume import RaycastVolume

if TYPE_CHECKING:
    import pyvista

__all__ = ["brain_like", "vessel_lines", "vessel_tree"]

PEAKS = {"uint8": 255.0, "uint16": 4095.0, "int16": 4095.0, "float32": 1.0}
"""Full brightness of each type: angiographs have 8 or 12 bits."""

VESSEL_SIDE = 160.0  # mm, the field of view of a head's angiogram
ROOTS = 3  # arteries that enter from below
ROOT_RADIUS = 2.8  # mm
LEAST_RADIUS = 0.35  # mm: finer ones end
EDGE = 0.5  # mm over which a vessel's edge blurs; at least 1.2 voxels
LARGEST_SEGMENTS = 100_000
TOGETHER = 32  # slices that are drawn at the same time

HEAD_SIDE = 200.0  # mm
WAVES = 14  # that make up the folds
WAVELENGTH = (18.0, 34.0)  # mm, of folds on the brain's surface

_Array = npt.NDArray[np.float64]
_Floats = npt.NDArray[np.float32]


def vessel_tree(n: int, seed: int = 0, dtype: Any = "uint8", *, noise: float = 0.0) -> RaycastVolume:
    """Make an angiogram-like volume: bright trees of vessels, about 1 % of it, in empty space.

    Vessels fork by Murray's law (the cubes of the branches' radii sum to the trunk's, and the angles take the least
    work), wind, taper from 2.8 mm to 0.35 mm, and are the brighter the wider they are; one carries an aneurysm.

    Parameters
    ----------
    n : int
        Voxels along each side of a cube of 160 mm around (0, 0, 0); 2 or more.
    seed : int, default: 0
        The same seed gives the same vessels at every ``n``.
    dtype : {'uint8', 'uint16', 'int16', 'float32'}, default: 'uint8'
        The brightest voxels may reach 255, 4095, 4095 and 1.
    noise : float, default: 0.0
        Largest brightness of noise, added everywhere, as a part of the full brightness; 0.05 is usual.

    Returns
    -------
    RaycastVolume

    Raises
    ------
    ValueError
        If ``n`` is less than 2, there is no such type, or noise is not from 0 to 1.
    """
    from .vessel_kernels import draw_vessels

    peak, kind = _checked(n, dtype, noise)
    segments = _grown(seed)
    spacing = VESSEL_SIDE / (n - 1)
    edge = max(EDGE, 1.2 * spacing)
    # Segments of each slice, so that slices can be drawn at the same time.
    reach = np.maximum(segments[:, 3], segments[:, 7]) + 0.5 * edge
    low = np.minimum(segments[:, 2], segments[:, 6]) - reach
    high = np.maximum(segments[:, 2], segments[:, 6]) + reach
    first = np.clip(np.ceil((low + 0.5 * VESSEL_SIDE) / spacing), 0, n).astype(np.int64)
    last = np.clip(np.floor((high + 0.5 * VESSEL_SIDE) / spacing), -1, n - 1).astype(np.int64)
    counts = np.maximum(last - first + 1, 0)
    which = np.repeat(np.arange(len(segments)), counts)
    slices = np.arange(len(which)) - np.repeat(np.cumsum(counts) - counts, counts) + np.repeat(first, counts)
    order = np.argsort(slices, kind="stable")
    offsets = np.concatenate([[0], np.cumsum(np.bincount(slices, minlength=n))])
    which = which[order]

    def draw(begin: int, out: _Floats) -> None:
        draw_vessels(segments, which, offsets, 0.5 * VESSEL_SIDE, spacing, edge, float(noise), seed, begin, out)

    return _drawn(draw, n, peak, kind, VESSEL_SIDE, "angiogram")


def vessel_lines(seed: int = 0) -> pyvista.PolyData:
    """Make the centre lines of the vessels in :func:`vessel_tree`, without the aneurysm.

    Parameters
    ----------
    seed : int, default: 0
        The same seed gives the vessels of that volume.

    Returns
    -------
    pyvista.PolyData
        A line per branch, in mm. A branch begins at the last point of its parent. The point data ``"radius"`` (mm) have
        the parent's radius there.
    """
    import pyvista as pv

    segments = _grown(seed)[:-1]
    ends = np.concatenate([segments[:, :3], segments[:, 4:7]])
    points, nodes = np.unique(ends, axis=0, return_inverse=True)
    start, end = nodes.reshape(2, -1)
    radius = np.empty(len(points))
    radius[start] = segments[:, 3]
    radius[end] = segments[:, 7]
    new = (start[1:] != end[:-1]) | (segments[1:, 3] != segments[:-1, 3])
    branches = np.split(np.arange(len(segments)), 1 + np.flatnonzero(new))
    cells = [[1 + len(branch), start[branch[0]], *end[branch]] for branch in branches]
    lines = pv.PolyData(points, lines=np.concatenate(cells))
    lines["radius"] = radius
    return lines


def brain_like(n: int, seed: int = 0, dtype: Any = "uint8", *, noise: float = 0.0) -> RaycastVolume:
    """Make a volume like a T1-weighted picture of a head: scalp, skull, fluid, folded cortex, white matter, ventricles.

    Parameters
    ----------
    n : int
        Voxels along each side of a cube of 200 mm around (0, 0, 0), in which x is right, y front and z up; 2 or more.
    seed : int, default: 0
        The same seed gives the same folds at every ``n``.
    dtype, noise
        As of :func:`vessel_tree`.

    Returns
    -------
    RaycastVolume
        Of full brightness are: scalp 0.9, skull 0.1, fluid 0.2, cortex 0.45, white matter 0.7; air 0.

    Raises
    ------
    ValueError
        As of :func:`vessel_tree`.
    """
    from .vessel_kernels import draw_head

    peak, kind = _checked(n, dtype, noise)
    rng = np.random.default_rng([seed, 1])
    ways = rng.normal(size=(WAVES, 3))
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    # Of directions, as on a sphere of the brain's size: sulci go straight inwards.
    waves = np.empty((WAVES, 4))
    waves[:, :3] = ways * (2.0 * np.pi * 75.0 / rng.uniform(*WAVELENGTH, (WAVES, 1)))
    waves[:, 3] = rng.uniform(0.0, 2.0 * np.pi, WAVES)
    spacing = HEAD_SIDE / (n - 1)
    edge = max(1.0, 1.2 * spacing)

    def draw(begin: int, out: _Floats) -> None:
        draw_head(waves, 0.5 * HEAD_SIDE, spacing, edge, float(noise), seed, begin, out)

    return _drawn(draw, n, peak, kind, HEAD_SIDE, "head")


def _checked(n: int, dtype: Any, noise: float) -> tuple[float, np.dtype[Any]]:
    """Full brightness, and the type."""
    if n < 2:
        raise ValueError(f"n={n!r}; expected 2 voxels or more along each side")
    kind = np.dtype(dtype)
    if kind.name not in PEAKS:
        raise ValueError(f"dtype={dtype!r}; choose one of {', '.join(map(repr, PEAKS))}")
    if not 0.0 <= noise <= 1.0:
        raise ValueError(f"noise={noise!r}; expected a part of the full brightness, 0 to 1")
    return PEAKS[kind.name], kind


def _drawn(
    draw: Callable[[int, _Floats], None], n: int, peak: float, kind: np.dtype[Any], side: float, name: str
) -> RaycastVolume:
    """The volume of slices (z, y, x) of a cube around the origin, which ``draw(first, slices)`` draws some of."""
    slices = np.empty((n, n, n), kind)
    bright = np.empty((min(TOGETHER, n), n, n), np.float32)
    for begin in range(0, n, TOGETHER):
        some = bright[: min(TOGETHER, n - begin)]
        draw(begin, some)
        slices[begin : begin + TOGETHER] = np.rint(some * np.float32(peak)) if peak > 1.0 else some
    affine = np.diag([side / (n - 1)] * 3 + [1.0])
    affine[:3, 3] = -0.5 * side
    return RaycastVolume(slices.T, affine, name=name)


@lru_cache(maxsize=4)
def _grown(seed: int) -> _Array:
    """``(n, 8)`` segments of all vessels: x, y, z, radius of both ends, mm."""
    rng = np.random.default_rng([seed, 0])
    segments: list[_Array] = []
    growing = []  # place, direction, radius
    for root in range(ROOTS):
        angle = 2.0 * np.pi * (root + rng.uniform(-0.2, 0.2)) / ROOTS
        place = np.array([22.0 * np.cos(angle), 22.0 * np.sin(angle), -82.0])
        growing.append((place, _unit(np.array([0.0, 0.0, 1.0]) + rng.normal(0.0, 0.1, 3)), ROOT_RADIUS))
    forks = []
    while growing and len(segments) < LARGEST_SEGMENTS:
        place, way, radius = growing.pop()
        length = radius * rng.uniform(9.0, 22.0)
        steps = max(int(length / max(1.5 * radius, 0.8)), 2)
        bend = rng.normal(0.0, 0.16, 3)
        for _ in range(steps):
            bend = 0.8 * bend + rng.normal(0.0, 0.09, 3)
            # What nears the edge of the head turns back.
            out = place / np.array([62.0, 68.0, 70.0])
            home = -1.5 * out * max(np.linalg.norm(out) - 0.75, 0.0)
            way = _unit(way + bend + home)
            after = place + way * (length / steps)
            segments.append(np.concatenate([place, [radius], after, [radius]]))
            place = after
        if radius > 1.2:
            forks.append((place, radius))
        # Murray: cubes of radii sum up; angles from the trunk's way take the least work.
        share = rng.uniform(0.25, 0.75)
        first, second = radius * np.cbrt(share), radius * np.cbrt(1.0 - share)
        side = _unit(np.cross(way, rng.normal(size=3)))
        for child, other, sign in ((first, second, 1.0), (second, first, -1.0)):
            if child < LEAST_RADIUS:
                continue
            cosine = (radius**4 + child**4 - other**4) / (2.0 * radius**2 * child**2)
            sine = sign * np.sqrt(max(1.0 - cosine**2, 0.0))
            growing.append((place, _unit(cosine * way + sine * side), child))
    place, radius = forks[int(rng.integers(len(forks)))]
    blob = place + radius * _unit(rng.normal(size=3))
    segments.append(np.concatenate([place, [2.2 * radius], blob, [2.6 * radius]]))
    grown = np.stack(segments)
    grown.flags.writeable = False
    return grown


def _unit(vector: _Array) -> _Array:
    return vector / np.linalg.norm(vector)
