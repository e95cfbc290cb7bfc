"""Brain-like tractograms in compressed form, of any size.

Some ten thousand streamlines are tracked (:mod:`.tracking`), turned by a few degrees into a few variants, and coded:
the *pool*. All others are copies of the pool's, moved by a few millimetres (:mod:`pvfiblets.codec.editing.copies`), so
that bundles stay bundles, fan, and end in the cortex, and a copy costs no more than its bytes.
"""

from __future__ import annotations

from collections.abc import Iterator
from os import PathLike
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from pvfiblets.streamlines import Streamlines
from pvfiblets.support.progress_bar import progress_bar

from .tracking import BUNDLES, iter_brain_streamlines

if TYPE_CHECKING:
    from pvfiblets.codec.encoding.ordering import Order
    from pvfiblets.codec.fibletset import FibletSet

TRACKED = 16_384  # streamlines tracked, where steps are 0.1 mm or longer; fewer of shorter steps: equal points in all
TURNS = 4  # variants of each, the first as tracked
TURN = 2.0  # degrees: standard deviation of the turn about each axis
LARGEST_TURN = 5.0  # degrees
SPREAD = 4.0  # mm: largest move of a copy along an axis


def brain(
    n_streamlines: int,
    step: float = 0.1,
    seed: int = 0,
    *,
    order: Order = "input",
    path: str | PathLike[str] | None = None,
    progress: bool = False,
) -> FibletSet:
    """Make a compressed whole-brain-like tractogram, up to billions of segments.

    Parameters
    ----------
    n_streamlines : int
        How many streamlines; each has 94 mm of segments on average: 940 at a step of 0.1 mm.
    step : float, default: 0.1
        Distance between consecutive points, mm.
    seed : int, default: 0
        The same seed gives the same set.
    order : {'input', 'hilbert'}, default: 'input'
        'input' mixes bundles, as whole-brain tracking does. 'hilbert' puts the same streamlines along a space-filling
        curve (:mod:`pvfiblets.codec.encoding.ordering`), so that pages are compact in space.
    path : str or PathLike, optional
        A ``.fiblets`` file to write page by page, in memory that does not grow with it.
    progress : bool, default: False
        Show a progress bar.

    Returns
    -------
    FibletSet
        In memory, or mapped from ``path``; with the per-streamline array ``bundle`` (uint8, an index into ``BUNDLES``)
        and one group per bundle.

    Raises
    ------
    ValueError
        If ``n_streamlines`` is negative, ``step`` is not between 0 and 20 mm, or there is no such order.
    OSError
        If the file cannot be written.

    Notes
    -----
    In the order of the input, streamline ``i`` is a rigidly moved copy of streamline ``i % n`` of
    ``brain_streamlines(n, step, seed)``, where ``n = min(n_streamlines, 16384)`` (or fewer, in proportion, for steps
    below 0.1 mm): turned by at most 5 degrees about its middle, moved by at most 4 mm along each axis. Every point lies
    within the set's error bound, a tenth of a step, of the copy so defined.

    Tracking, turning and coding take up to half a minute and 2 GB, copying some seconds for 10^9 segments.
    """
    from pvfiblets.codec.editing.copies import Copies
    from pvfiblets.codec.encoding.compress import compress
    from pvfiblets.codec.encoding.ordering import check_order

    check_order(order)

    n_tracked = min(n_streamlines, TRACKED, max(int(TRACKED * step / 0.1), 1))
    tracked = list(iter_brain_streamlines(n_tracked, step, seed))
    if n_streamlines == 0:
        fiblets = compress(Streamlines(np.zeros((0, 3)), [0]), max_error=0.1 * step)
        if path is None:
            return fiblets
        fiblets.save(path)
        return type(fiblets).open(path)
    turns = min(TURNS, -(-n_streamlines // n_tracked))
    pool, boxes, sequence = _pool(tracked, turns, seed, progress)
    copies = Copies(pool, boxes, n_streamlines, SPREAD, seed, sequence if order == "hilbert" else None)
    bundles = np.concatenate([chunk.per_streamline["bundle"] for chunk in tracked])
    bundle = bundles[copies.copies_at(0, n_streamlines) % n_tracked]
    groups = {name: np.flatnonzero(bundle == index) for index, name in enumerate(BUNDLES)}
    groups = {name: members for name, members in groups.items() if len(members)}
    return copies.make({"bundle": bundle}, groups, path, progress)


def _pool(
    tracked: list[Streamlines], turns: int, seed: int, progress: bool
) -> tuple[FibletSet, npt.NDArray[np.float64], npt.NDArray[np.int64]]:
    """Code all variants, on a grid with room for moves; the box of each, ``(n, 6)`` mm; their order on the curve."""
    from pvfiblets.codec.encoding.encode import Encoder
    from pvfiblets.codec.encoding.ordering import ends_order
    from pvfiblets.codec.encoding.record_writer import join
    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.codec.parameters import Parameters, bounds_of, survey

    found = survey(_variants(tracked, turns, seed))
    bounds = bounds_of(found)
    room = SPREAD * 1.001 + 1e-3 * (found.upper - found.lower)  # and a little, for rounding to the grid
    found.lower, found.upper = found.lower - room, found.upper + room
    encoder = Encoder(Parameters.choose(found))
    records, boxes, firsts, lasts = [], [], [], []
    with progress_bar(progress, desc="coding", total=found.n_points, unit="points", unit_scale=True) as bar:
        for chunk in _variants(tracked, turns, seed):
            starts = np.asarray(chunk.offsets)[:-1]
            least, most = np.minimum.reduceat(chunk.points, starts), np.maximum.reduceat(chunk.points, starts)
            boxes.append(np.concatenate([least, most], axis=1).astype(np.float64))
            firsts.append(chunk.points[starts])
            lasts.append(chunk.points[np.asarray(chunk.offsets)[1:] - 1])
            records.append(encoder.add(chunk))
            bar.update(chunk.n_points)
    pool = FibletSet(
        parameters=encoder.parameters,
        pages=encoder.page_table(),
        bounds=bounds,
        n_streamlines=encoder.n_streamlines,
        **join(records),
    )
    return pool, np.concatenate(boxes), ends_order(np.concatenate(firsts), np.concatenate(lasts))


def _variants(tracked: list[Streamlines], turns: int, seed: int) -> Iterator[Streamlines]:
    """All streamlines as tracked, then all again for each turn, each turned about the middle of its box."""
    for variant in range(turns):
        for index, chunk in enumerate(tracked):
            if variant == 0:
                yield Streamlines(chunk.points, chunk.offsets)
                continue
            rng = np.random.default_rng([seed, index, variant])
            offsets = np.asarray(chunk.offsets)
            vectors = np.radians(TURN) * rng.normal(size=(len(chunk), 3))
            angles = np.linalg.norm(vectors, axis=1, keepdims=True)
            vectors *= np.minimum(1.0, np.radians(LARGEST_TURN) / angles)
            points = chunk.points.astype(np.float64)
            least, most = np.minimum.reduceat(points, offsets[:-1]), np.maximum.reduceat(points, offsets[:-1])
            lengths = np.diff(offsets)
            middle = np.repeat(0.5 * (least + most), lengths, axis=0)
            matrices = np.repeat(_rotations(vectors), lengths, axis=0)
            points = middle + np.einsum("pij,pj->pi", matrices, points - middle)
            yield Streamlines(points.astype(np.float32), offsets)


def _rotations(vectors: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Matrices ``(n, 3, 3)`` of rotation vectors ``(n, 3)``, radians (Rodrigues' formula)."""
    angles = np.maximum(np.linalg.norm(vectors, axis=1), 1e-300)[:, None, None]
    x, y, z = (vectors / angles[:, 0]).T
    zero = np.zeros_like(x)
    cross = np.stack([zero, -z, y, z, zero, -x, -y, x, zero], axis=1).reshape(-1, 3, 3)
    rotations: npt.NDArray[np.float64] = np.eye(3) + np.sin(angles) * cross + (1.0 - np.cos(angles)) * cross @ cross
    return rotations
