"""A model of regions painted on the voxels of an image, for whatever shows them: named, coloured, undone, saved."""

from __future__ import annotations

import csv
import os
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ...errors import FormatError
from ...images.files import stem_of
from ...images.sources import as_image
from ..bundles.colours import as_colour, distinct_colour, hex_colour
from ..density.map_files import write_map
from ..density.voxel_grid import VoxelGrid, grid_like
from ..regions.labels import Labels
from ..regions.placement import finite_vector, positive

Ints = npt.NDArray[np.int64]
Flags = npt.NDArray[np.bool_]
MOST_STEPS = 200  # strokes that can be undone


@dataclass(frozen=True, eq=False)
class Stroke:
    """The changes of a stroke.

    Attributes
    ----------
    voxels : numpy.ndarray
        ``(n,)`` int64 places in the flat grid, in C order.
    before, after : numpy.ndarray
        ``(n,)`` uint16 labels, 0 for none.
    """

    voxels: Ints
    before: npt.NDArray[np.uint16]
    after: npt.NDArray[np.uint16]

    def __len__(self) -> int:
        return len(self.voxels)


@dataclass
class PaintedRegion:
    """Name, label (1 and up) and colour (red, green, blue, from 0 to 1) of a region, and whether it is shown."""

    name: str
    label: int
    color: tuple[float, float, float]
    visible: bool = True


class RegionPainter:
    """Regions painted on a grid of voxels; a voxel is in at most one region.

    Parameters
    ----------
    like : image
        Image that defines the grid, as for :func:`pvfiblets.density`: a path, ``(shape, affine)``, …

    Attributes
    ----------
    labels : numpy.ndarray
        ``(i, j, k)`` uint16, 0 for no region. Only strokes change it.
    listeners : list of callable
        Called with each :class:`Stroke`, undo included.
    """

    def __init__(self, like: Any) -> None:
        self.grid: VoxelGrid = grid_like(like)
        self.labels = np.zeros(self.grid.shape, np.uint16)
        self.regions: dict[str, PaintedRegion] = {}
        self.listeners: list[Callable[[Stroke], None]] = []
        self._done: list[Stroke] = []
        self._undone: list[Stroke] = []

    # ------------------------------------------------------------------------------------------------------- regions

    def add(self, name: str, color: Any = None) -> PaintedRegion:
        """Add an empty region with a new `name` and a colour."""
        if not name.strip() or name in self.regions:
            raise ValueError(f"a region {name!r} is there already, or is no name; give another one")
        label = max((r.label for r in self.regions.values()), default=0) + 1
        if label > np.iinfo(np.uint16).max:
            raise ValueError("there are 65,535 regions; no more fit")
        made = PaintedRegion(name, label, distinct_colour(label - 1) if color is None else as_colour(color))
        self.regions[name] = made
        return made

    def rename(self, name: str, new: str) -> None:
        """Rename a region; its place in the list stays."""
        self.label(name)
        if not new.strip() or (new in self.regions and new != name):
            raise ValueError(f"a region {new!r} is there already, or is no name; give another one")
        self.regions = {new if key == name else key: region for key, region in self.regions.items()}
        self.regions[new].name = new

    def remove(self, name: str) -> None:
        """Remove a region and its voxels. This cannot be undone."""
        self.clear(name)
        label = self.regions.pop(name).label
        self._done = [s for s in self._done if not ((s.before == label) | (s.after == label)).any()]
        self._undone = []

    def label(self, name: str) -> int:
        """Return a region's number in `labels`; a KeyError that lists the regions if there is none of that name."""
        if name not in self.regions:
            raise KeyError(f"there is no region {name!r}; there are: {', '.join(map(repr, self.regions)) or 'none'}")
        return self.regions[name].label

    def mask(self, name: str) -> Flags:
        """Return a region's voxels, ``(i, j, k)`` bool."""
        return np.asarray(self.labels == self.label(name))

    def region(self, name: str) -> Labels:
        """Return a copy of a region, for ``regions.passes`` and others; ValueError if it has no voxel."""
        return Labels(self.mask(name), self.grid.affine)

    # ------------------------------------------------------------------------------------------------------- brushes

    def paint(self, name: str | None, path: npt.ArrayLike, radius: float, *, plane: int | None = None) -> Stroke:
        """Paint with a round brush.

        Parameters
        ----------
        name : str or None
            Name of the region; None erases.
        path : array_like
            ``(3,)`` or ``(n, 3)`` mm: position of the brush, or the polyline along which it moves.
        radius : float
            mm: voxels with centres within this distance of the path are painted, and the voxels of its corners.
        plane : {0, 1, 2}, optional
            Paint in two dimensions: only in the slice across this axis at the path's first position.

        Returns
        -------
        Stroke
        """
        reach = positive(radius, "radius")
        places = np.atleast_2d(np.asarray(path, np.float64))
        if places.ndim != 2 or places.shape[1] != 3 or not len(places) or not np.isfinite(places).all():
            raise ValueError(f"path has the shape {places.shape}; give a position (3,) or several (n, 3), finite mm")
        found = [self._ball(a, b, reach) for a, b in pairwise(places)]
        found += [self._ball(places[0], places[0], reach)] if len(places) == 1 else []
        at = np.concatenate([*found, self._voxels(places)])
        at = at[self._within(at)]
        if plane is not None:
            at = at[at[:, self._axis(plane)] == self._voxels(places[:1])[0, plane]]
        return self._put(name, np.unique(self._flat(at)))

    def erase(self, path: npt.ArrayLike, radius: float, *, plane: int | None = None) -> Stroke:
        """Remove voxels from their regions; parameters as for :meth:`paint`."""
        return self.paint(None, path, radius, plane=plane)

    def sphere(self, name: str | None, center: npt.ArrayLike, radius: float) -> Stroke:
        """Paint all voxels whose centres lie within a `radius` (mm) of a `center` (mm)."""
        return self.paint(name, finite_vector(center, "center"), radius)

    def polygon(self, name: str | None, points: npt.ArrayLike, plane: int) -> Stroke:
        """Paint the voxels of a slice whose centres lie in a polygon.

        Parameters
        ----------
        name : str or None
            Name of the region; None erases.
        points : array_like
            ``(n, 3)`` mm: 3 corners or more of a polygon, filled by the even-odd rule.
        plane : {0, 1, 2}
            Axis of voxels across the slice, which is the first corner's.
        """
        axis = self._axis(plane)
        corners = np.asarray(points, np.float64)
        if corners.ndim != 2 or corners.shape[1] != 3 or len(corners) < 3 or not np.isfinite(corners).all():
            raise ValueError(f"points have the shape {corners.shape}; give three corners or more, (n, 3) finite mm")
        u = (corners - self.grid.corner) @ self.grid.linear.T - 0.5
        slice_ = int(np.floor(u[0, axis] + 0.5))
        i, j = (k for k in range(3) if k != axis)
        x, y = np.meshgrid(np.arange(self.grid.shape[i]), np.arange(self.grid.shape[j]), indexing="ij")
        inside = np.zeros(x.shape, bool)
        for a, b in zip(u, np.roll(u, -1, axis=0), strict=True):
            crosses = (a[j] > y) != (b[j] > y)
            with np.errstate(divide="ignore", invalid="ignore"):
                inside ^= crosses & (x < (b[i] - a[i]) * (y - a[j]) / (b[j] - a[j]) + a[i])
        at = np.empty((int(inside.sum()), 3), np.int64)
        at[:, axis], at[:, i], at[:, j] = slice_, x[inside], y[inside]
        return self._put(name, np.sort(self._flat(at[self._within(at)])))

    def fill(self, name: str | None, seed: npt.ArrayLike, *, plane: int | None = None) -> Stroke:
        """Paint the connected voxels around a position that have its label (a region, or none).

        Parameters
        ----------
        name : str or None
            Name of the region; None erases.
        seed : array_like
            ``(3,)`` mm.
        plane : {0, 1, 2}, optional
            Only within the slice across this axis.
        """
        at = self._seed(seed)
        return self._put(name, self._grown(at, self.labels == self.labels[tuple(at)], plane))

    def grow(
        self, name: str | None, seed: npt.ArrayLike, image: npt.ArrayLike, low: float, high: float,
        *, radius: float | None = None, plane: int | None = None,
    ) -> Stroke:  # fmt: skip
        """Paint the connected voxels around a position whose image values are in a range.

        Parameters
        ----------
        name : str or None
            Name of the region; None erases.
        seed : array_like
            ``(3,)`` mm; nothing is painted if its value is out of range.
        image : array_like
            ``(i, j, k)`` numbers on this grid.
        low, high : float
            Smallest and largest value, both included.
        radius : float, optional
            Largest distance from the seed, mm.
        plane : {0, 1, 2}, optional
            Only within the slice across this axis.
        """
        values = np.asarray(image)
        if values.shape != self.grid.shape:
            raise ValueError(f"the image has the shape {values.shape}; the grid's is {self.grid.shape}")
        if not low <= high:
            raise ValueError(f"low is {low} and high is {high}; give the lower one first")
        at = self._seed(seed)
        open_ = (values >= low) & (values <= high)
        if radius is not None:
            near = np.zeros(self.grid.shape, bool)
            center = np.asarray(seed, np.float64)
            ball = self._ball(center, center, positive(radius, "radius"))
            near[tuple(ball[self._within(ball)].T)] = True
            open_ &= near
        return self._put(name, self._grown(at, open_, plane))

    def set_voxels(self, name: str, voxels: npt.ArrayLike) -> Stroke:
        """Add `voxels` to a region: ``(n,)`` indices in the flat grid, in C order."""
        places = np.asarray(voxels)
        if places.dtype.kind not in "iu" or places.ndim != 1 or not self._holds(places):
            raise ValueError(f"voxels are {places.dtype} of shape {places.shape}; give whole numbers (n,) in the grid")
        return self._put(name, np.unique(places.astype(np.int64)))

    def clear(self, name: str) -> Stroke:
        """Remove all voxels of a region."""
        return self._put(None, np.flatnonzero(self.labels.ravel() == self.label(name)))

    # ---------------------------------------------------------------------------------------------------------- undo

    def undo(self) -> Stroke | None:
        """Undo the last stroke, and return the reverse stroke; None if there is none."""
        if not self._done:
            return None
        last = self._done.pop()
        self._undone.append(last)
        return self.apply(Stroke(last.voxels, last.after, last.before))

    def redo(self) -> Stroke | None:
        """Redo the last undone stroke, and return it; None if there is none."""
        if not self._undone:
            return None
        last = self._undone.pop()
        self._done.append(last)
        return self.apply(last)

    # --------------------------------------------------------------------------------------------------------- files

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write a label volume, and beside it a BIDS table of its ``index``, ``name`` and ``color``.

        Parameters
        ----------
        path : str or PathLike
            Ends in ``.nii``, ``.nii.gz``, ``.mif``, ``.mif.gz`` or ``.vti``.

        Returns
        -------
        Path
            The table's: the same name, ``.tsv``.
        """
        target = Path(path).expanduser()
        table = target.with_name(f"{stem_of(target.name)}.tsv")
        write_map(target, self.labels, self.grid, "labels")
        with table.open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, delimiter="\t", lineterminator="\n")
            writer.writerow(["index", "name", "color"])
            for r in self.regions.values():
                writer.writerow([r.label, r.name, hex_colour(r.color)])
        return table

    @classmethod
    def open(cls, path: str | os.PathLike[str]) -> RegionPainter:
        """Read what :meth:`save` wrote, or any label volume; labels without a name are called by their number.

        Raises
        ------
        FormatError
            If the volume has fractions, or labels below 0 or above 65,535.
        """
        target = Path(path).expanduser()
        table = target.with_name(f"{stem_of(target.name)}.tsv")
        image = as_image(target)
        found = np.unique(image.labels)
        if not ((found >= 0) & (found <= 65535)).all():
            raise FormatError(target, None, f"labels from {found.min()} to {found.max()}", "labels from 0 to 65,535")
        made = cls(image)
        made.labels[...] = image.labels
        if table.exists():
            with table.open(newline="", encoding="utf-8") as file:
                for row in csv.DictReader(file, delimiter="\t"):
                    try:
                        label, name, color = int(row["index"]), row["name"], row.get("color")
                    except (KeyError, TypeError, ValueError) as error:
                        raise FormatError(table, None, f"a row {row}", "columns index, name and color") from error
                    usual = distinct_colour(max(label, 1) - 1)
                    made.regions[name] = PaintedRegion(name, label, as_colour(color) if color else usual)
        known = {r.label for r in made.regions.values()}
        for label in found[found > 0].astype(int).tolist():
            if label not in known:
                made.regions[str(label)] = PaintedRegion(str(label), label, distinct_colour(label - 1))
        return made

    # -------------------------------------------------------------------------------------------------------- inside

    def _put(self, name: str | None, voxels: Ints) -> Stroke:
        label = 0 if name is None else self.label(name)
        flat = self.labels.reshape(-1)
        voxels = voxels[flat[voxels] != label]
        stroke = Stroke(voxels, flat[voxels].copy(), np.full(len(voxels), label, np.uint16))
        if len(voxels):
            self._done = [*self._done, stroke][-MOST_STEPS:]
            self._undone = []
            self.apply(stroke)
        return stroke

    def apply(self, stroke: Stroke) -> Stroke:
        """Apply a stroke's voxels without a step to undo, for callers with their own history."""
        self.labels.reshape(-1)[stroke.voxels] = stroke.after
        for listener in list(self.listeners):
            listener(stroke)
        return stroke

    def _holds(self, places: npt.NDArray[Any]) -> bool:
        return not len(places) or (int(places.min()) >= 0 and int(places.max()) < self.grid.n_voxels)

    def _voxels(self, places: npt.NDArray[np.float64]) -> Ints:
        return np.floor((places - self.grid.corner) @ self.grid.linear.T).astype(np.int64)

    def _within(self, at: Ints) -> Flags:
        return np.asarray(((at >= 0) & (at < self.grid.shape)).all(axis=1))

    def _flat(self, at: Ints) -> Ints:
        return np.ravel_multi_index(tuple(at.T), self.grid.shape).astype(np.int64)

    def _axis(self, plane: int) -> int:
        if plane not in (0, 1, 2):
            raise ValueError(f"plane is {plane!r}; give 0, 1 or 2, the axis of voxels across the slice")
        return int(plane)

    def _seed(self, seed: npt.ArrayLike) -> Ints:
        at = self._voxels(finite_vector(seed, "seed")[None])
        if not self._within(at)[0]:
            raise ValueError(f"seed is {np.asarray(seed).tolist()}, outside of the grid")
        return at[0]

    def _ball(self, a: npt.NDArray[np.float64], b: npt.NDArray[np.float64], reach: float) -> Ints:
        """Voxels whose centres lie within `reach` of a segment, ``(n, 3)``, also outside of the grid's sides."""
        u = (np.stack([a, b]) - self.grid.corner) @ self.grid.linear.T
        most = reach * np.linalg.norm(self.grid.linear, axis=1)
        low = np.maximum(np.floor(u.min(axis=0) - most), 0).astype(np.int64)
        high = np.minimum(np.ceil(u.max(axis=0) + most), self.grid.shape).astype(np.int64)
        if (high <= low).any():
            return np.empty((0, 3), np.int64)
        at = np.stack(np.meshgrid(*map(np.arange, low, high), indexing="ij"), axis=-1).reshape(-1, 3)
        centres = at @ self.grid.affine[:3, :3].T + self.grid.affine[:3, 3]
        d = b - a
        square = float(d @ d)
        t = np.clip((centres - a) @ d / square, 0.0, 1.0) if square > 0.0 else np.zeros(len(centres))
        return np.asarray(at[np.linalg.norm(centres - a - t[:, None] * d, axis=1) <= reach])

    def _grown(self, at: Ints, open_: Flags, plane: int | None) -> Ints:
        """Flat places of the open voxels that hang together with one by faces."""
        if plane is not None:
            only = np.zeros_like(open_)
            part = [slice(None)] * 3
            part[self._axis(plane)] = slice(int(at[plane]), int(at[plane]) + 1)
            only[tuple(part)] = open_[tuple(part)]
            open_ = only
        from .fill_kernels import connected

        return np.sort(connected(np.ascontiguousarray(open_).ravel(), self.grid.shape, int(self._flat(at[None])[0])))
