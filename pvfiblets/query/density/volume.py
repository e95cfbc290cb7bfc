"""Volumes of density: what streamlines add up to in every voxel of a grid (track density imaging).

With ``w_s`` the weight of streamline ``s``, ``L_s(v)`` the length of it inside voxel ``v``, and ``|t|`` the magnitudes
of its unit tangent's components:

===============  ============================================================================  ====
contrast         value of voxel ``v``                                                          unit
===============  ============================================================================  ====
``'count'``      sum of ``w_s`` over the streamlines that visit it
``'length'``     sum of ``w_s L_s(v)``                                                         mm
``'direction'``  mean of ``|t|`` over all length in the voxel, each mm of weight ``w_s``
array            mean of the values, linear between points, in the same way                    its
===============  ============================================================================  ====

Sources: Calamante et al. 2010, "Track-density imaging (TDI): super-resolution white matter imaging using whole-brain
track-density mapping"; the directions follow Pajevic and Pierpaoli 1999, section "absolute value RGB".

Every segment is cut at the faces of the voxels that it crosses (:mod:`.density_kernels`), so that lengths are exact up
to the rounding of float64, whatever the step. Points are decoded, cut and added up chunk by chunk: besides the map
there are never more than about 150 MB. Threads own voxels: sums are the same, bit by bit, on any number of them.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from ...codec.progress import Progress
from ...support.memory import check_room, of_machine, shown
from ...support.ragged import blocks
from ..measures.measures import Distance, Values
from .density_map import DensityMap
from .density_sources import Part, Source, as_source
from .voxel_grid import VoxelGrid, grid_about, grid_like

CONTRASTS = ("count", "length", "direction")
Contrast = Literal["count", "length", "direction"]
PIECES = 1 << 20  # held together
SHARE = 0.8  # of the machine's memory, beyond which it would only swap


def density(
    source: Any,
    voxel_size: float | npt.ArrayLike | None = None,
    *,
    like: Any = None,
    weights: str | npt.ArrayLike | None = None,
    contrast: Contrast | str | Distance | Values | npt.ArrayLike = "count",
    ends_only: bool = False,
    progress: Progress = False,
) -> DensityMap:
    """Return a map of streamlines on a grid of voxels: counts, lengths, directions or means of values.

    Parameters
    ----------
    source : FibletSet, Streamlines, str or PathLike
        The tractogram; files of any format are read in pieces.
    voxel_size : float or array_like, optional
        Voxel size in mm, one number or one per axis. The grid is axis-aligned, encloses all points, and has faces at
        whole multiples of the size. Give either this or `like`.
    like : object, optional
        An image whose grid is used: a path, an image of nibabel, a :class:`pyvista.ImageData`, ``(array, affine)``,
        ``(shape, affine)``, or another map. Oblique, flipped and sheared grids are exact too. Parts of streamlines
        outside the grid do not count.
    weights : str or array_like, optional
        Finite numbers of 0 or more, one per streamline, such as SIFT2's, or the name of such an array.
    contrast : str, Distance, Values or array_like, default: 'count'
        ``'count'``: number of streamlines with a point or some length in the voxel. ``'length'``: their length in it,
        mm. ``'direction'``: mean magnitudes of the tangent's x, y and z. Anything else gives the mean of a value in
        the voxel: an array with one number per streamline or per point, the name of a stored array, an image, or for a
        FibletSet a measure such as ``'curvature'``.
    ends_only : bool, default: False
        Count end points only; means are over end points. A streamline of one point has one end.
    progress : bool or callable, default: False
        Show a progress bar; or call this with the name of the step and its finished share, 0 to 1.

    Returns
    -------
    DensityMap
        Has ``values``, ``affine``, ``to_image()`` for PyVista and ``save()`` for NIfTI.

    Raises
    ------
    FormatError
        If a file is damaged.
    KeyError
        If no array has that name.
    TypeError
        If `source` or `like` has another type.
    ValueError
        If neither or both of `voxel_size` and `like` are given, a number is out of range, an array has the wrong
        length, a point is not finite, or the grid does not fit into memory.

    Notes
    -----
    A voxel contains its lower faces, not its upper ones. A path exactly in a face counts for the voxel above.
    """
    if (voxel_size is None) == (like is None):
        raise ValueError("give either voxel_size= (mm) or like= (an image whose grid is taken)")
    by_name = isinstance(contrast, str) and contrast in CONTRASTS
    if ends_only and isinstance(contrast, str) and contrast == "length":
        raise ValueError(
            "contrast is 'length', which end points have none of; with ends_only=True give 'count' or an array"
        )
    grid = None if like is None else grid_like(like)
    made = as_source(source, weights, None if by_name else contrast)
    if grid is None:
        assert voxel_size is not None
        grid = grid_about(*made.box(progress), voxel_size)
    name = str(contrast) if by_name else made.name
    sums = _Sums(grid, name if by_name else "mean", made, ends_only, plain=weights is None)
    for part in made.parts(progress):
        sums.add(part)
    unit = {"length": "mm"}.get(name, "") if by_name else made.unit
    return DensityMap(sums.result(), grid, name, unit, sums.share_outside)


class _Sums:
    """Sums over the voxels of a grid."""

    def __init__(self, grid: VoxelGrid, what: str, source: Source, ends_only: bool, *, plain: bool) -> None:
        from . import density_kernels as kernels

        self._kernels, self._grid, self._source, self._ends_only = kernels, grid, source, ends_only
        self._counts = what == "count"
        self._whole = self._counts and plain
        codes = {"count": kernels.COUNT, "length": kernels.AMOUNT, "direction": kernels.DIRECTION}
        self._what = kernels.AMOUNT if self._counts and ends_only else codes.get(what, kernels.VALUE)
        rows = {kernels.COUNT: 1, kernels.AMOUNT: 1, kernels.VALUE: 2, kernels.DIRECTION: 4}[self._what]
        marks = np.dtype(np.int32 if source.most_streamlines < np.iinfo(np.int32).max else np.int64)
        visits = self._what == kernels.COUNT
        _check_memory(grid, grid.n_voxels * (8 * rows + (4 + marks.itemsize if visits else 0)))
        self._sums = np.zeros((rows, grid.n_voxels))
        self._visitor = np.zeros(grid.n_voxels if visits else 0, marks)
        self._lines = 0
        self._all = self._within = 0.0  # mm, or end points
        _compile(marks)
        source.compile()

    def add(self, part: Part) -> None:
        """Add some streamlines, which follow those before."""
        n_lines, n = len(part.offsets) - 1, len(part.points)
        line = np.repeat(np.arange(n_lines), np.diff(part.offsets))
        u, lengths = np.empty((n, 3)), np.empty(n)
        grid, kernels = self._grid, self._kernels
        bad = kernels.place(part.points, line, grid.corner, grid.linear, u, lengths)
        if bad:
            raise ValueError(f"{bad} points are not finite, or so far away that lengths are not; remove them first")
        if self._ends_only:
            self._all += float(np.minimum(np.diff(part.offsets), 2).sum())
            voxel, item = np.empty(2 * n_lines, np.int64), np.empty(2 * n_lines, np.int64)
            share, middle = np.empty(2 * n_lines), np.empty(2 * n_lines)
            kernels.cut_ends(u, part.offsets, grid.shape, voxel, item, share, middle)
            self._within += float((voxel >= 0).sum())
            self._add_up(2 * n_lines, voxel, item, share, middle, part, line, lengths)
        else:
            self._all += float(lengths.sum())
            self._cut(part, u, line, lengths)
        self._lines += n_lines

    def _cut(self, part: Part, u: Any, line: Any, lengths: Any) -> None:
        for within, n, voxel, item, share, middle in _pieces(self._grid, u, line, lengths):
            self._within += within
            self._add_up(n, voxel, item, share, middle, part, line, lengths)

    def _add_up(
        self, n: int, voxel: Any, item: Any, share: Any, middle: Any, part: Part, line: Any, lengths: Any
    ) -> None:
        self._kernels.add_up(
            self._what, not self._ends_only, _tiles(), n, voxel, item, share, middle, part.points, line, lengths,
            part.weights, part.values, self._source.per_point, self._lines, self._visitor, self._sums,
        )  # fmt: skip

    @property
    def share_outside(self) -> float:
        """Share of the sum that lies outside the grid."""
        return max(1.0 - self._within / self._all, 0.0) if self._all > 0.0 else 0.0

    def result(self) -> npt.NDArray[Any]:
        """``(nx, ny, nz)`` or ``(nx, ny, nz, 3)``, x running fastest in memory."""
        sums, kernels = self._sums, self._kernels
        if self._what in (kernels.DIRECTION, kernels.VALUE):
            # Where nothing was added the mean is 0, and so the map has no NaN.
            some = sums[-1] > 0.0
            means = sums[:-1]
            np.divide(means, sums[-1], out=means, where=some)
            means[:, ~some] = 0.0
            sums = means
        if self._whole:
            sums = sums.astype(np.int32)
        volume = sums.reshape(len(sums), *self._grid.shape[::-1]).transpose(3, 2, 1, 0)
        return volume if self._what == kernels.DIRECTION else volume[..., 0]


class Visits:
    """How many voxels of a grid each of some bundles visits."""

    def __init__(self, grid: VoxelGrid, n_bundles: int) -> None:
        _check_memory(grid, 4 * grid.n_voxels)
        self._grid = grid
        self._visitor = np.zeros(grid.n_voxels, np.int32)
        self.counts = np.zeros(n_bundles, np.int64)
        _compile(self._visitor.dtype)

    def add(self, points: npt.NDArray[np.floating[Any]], line: Any, owner: Any) -> None:
        """Add points, ``(n, 3)`` mm: ``line`` is the streamline of each, ``owner`` its bundle, which never falls."""
        # Points that are not finite end a line.
        from . import density_kernels as kernels

        known = np.isfinite(points).all(axis=1)
        if not known.all():
            points, line, owner = points[known], (line + np.cumsum(~known))[known], owner[known]
        points = np.ascontiguousarray(points, np.float64)
        u, lengths = np.empty((len(points), 3)), np.empty(len(points))
        kernels.place(points, line, self._grid.corner, self._grid.linear, u, lengths)
        for _, n, voxel, item, _, _ in _pieces(self._grid, u, line, lengths):
            kernels.count_visits(n, voxel, item, owner, self._visitor, self.counts)


def _pieces(grid: VoxelGrid, u: Any, line: Any, lengths: Any) -> Iterator[tuple[float, int, Any, Any, Any, Any]]:
    """Cut segments at the faces of voxels: mm within the grid, number of pieces, and the pieces, block by block."""
    from . import density_kernels as kernels

    counts = np.empty(len(u), np.int64)
    kernels.count_pieces(u, line, grid.shape, counts)
    starts = np.concatenate([[0], np.cumsum(counts)])
    for a, b in blocks(starts, PIECES):
        n = int(starts[b] - starts[a])
        voxel, item, share, middle = np.empty(n, np.int64), np.empty(n, np.int64), np.empty(n), np.empty(n)
        within = kernels.cut(u, line, lengths, grid.shape, starts, a, b, voxel, item, share, middle)
        yield within, n, voxel, item, share, middle


def _tiles() -> int:
    """Number of threads, rounded up to a power of two."""
    import numba

    return 1 << (numba.get_num_threads() - 1).bit_length()


def _check_memory(grid: VoxelGrid, needed: int) -> None:
    """Refuse a grid that does not fit into memory, before any is taken."""
    machine = of_machine()
    if machine and needed > SHARE * machine:
        sides = " x ".join(map(str, grid.shape))
        raise ValueError(
            f"a grid of {sides} voxels takes {shown(needed)} of the {shown(machine)} that this machine has; give a "
            "larger voxel_size, or an image of fewer voxels"
        )
    check_room(needed)


@cache
def _compile(marks: np.dtype[Any]) -> None:
    """Compile the kernels by adding nothing up."""
    from . import density_kernels as kernels

    whole, lone, grid = np.empty(0, np.int64), np.empty(0), (1, 1, 1)
    kernels.place(np.empty((0, 3)), whole, np.zeros(3), np.eye(3), np.empty((0, 3)), lone)
    kernels.count_pieces(np.empty((0, 3)), whole, grid, whole)
    kernels.cut(np.empty((0, 3)), whole, lone, grid, np.zeros(1, np.int64), 0, 0, whole, whole, lone, lone)
    kernels.cut_ends(np.empty((0, 3)), np.zeros(1, np.int64), grid, whole, whole, lone, lone)
    kernels.count_visits(0, whole, whole, whole, np.empty(0, marks), whole)
    kernels.add_up(
        kernels.COUNT, True, 1, 0, whole, whole, lone, lone, np.empty((0, 3)), whole, lone, lone, lone, False, 0,
        np.empty(0, marks), np.empty((1, 0)),
    )  # fmt: skip
