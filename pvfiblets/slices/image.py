"""Images in layers of slices: numbers, colours, vectors or labels per voxel, on any grid and affine."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from pvfiblets.images.sources import as_image, colour_fields
from pvfiblets.slices.fixels import Fixels, read_fixels

Array = npt.NDArray[np.float64]

KINDS = ("scalars", "rgb", "direction", "labels")  # meanings of the numbers of a voxel

BAND = 32  # part of a side that the edges of an image are thick
SIGNAL = 0.25  # part of the window that the outside of a head stays below
SAMPLED = 1_000_000  # number of voxels for percentiles; of larger images every n-th


@dataclass(frozen=True, eq=False)
class SliceImage:
    """An image and its position.

    Parameters
    ----------
    values : numpy.ndarray
        ``(nx, ny, nz, n)``: the last axis counts times, volumes or components.
    affine : numpy.ndarray
        ``(4, 4)`` voxel indices to mm; sheared ones, too.
    name : str
    is_labels : bool
        Whether the file marks its numbers as labels.
    is_colours : bool
        Whether they are bytes of red, green, blue and maybe opacity.
    fixels : Fixels, optional
        Directions in its voxels; numbers are then how many a voxel has, or the greatest of theirs.
    """

    values: npt.NDArray[Any]
    affine: Array
    name: str = "image"
    is_labels: bool = False
    is_colours: bool = False
    fixels: Fixels | None = None
    _percentiles: dict[tuple[float, float, int], tuple[float, float]] = field(default_factory=dict, repr=False)
    _outside: dict[int | None, float | None] = field(default_factory=dict, repr=False)

    def __post_init__(self) -> None:
        affine = np.asarray(self.affine, np.float64)
        if affine.shape != (4, 4) or not np.isfinite(affine).all() or not abs(np.linalg.det(affine[:3, :3])) > 0.0:
            raise ValueError(
                f"the affine of {self.name} is {affine.tolist()}; give an invertible (4, 4) matrix from voxels to mm"
            )
        if self.values.ndim != 4 or not self.values.size:
            raise ValueError(
                f"{self.name} has the shape {self.values.shape}; give (nx, ny, nz) or (nx, ny, nz, n) numbers"
            )
        if self.values.dtype.kind not in "biuf":
            raise ValueError(f"{self.name} holds {self.values.dtype}; give real numbers, such as abs() of complex ones")
        object.__setattr__(self, "affine", affine)

    @property
    def shape(self) -> tuple[int, int, int]:
        """Voxels along each axis."""
        nx, ny, nz = self.values.shape[:3]
        return nx, ny, nz

    @property
    def n_volumes(self) -> int:
        """Numbers per voxel."""
        return int(self.values.shape[3])

    @cached_property
    def inverse(self) -> Array:
        """``(4, 4)`` mm to voxel indices."""
        inverse: Array = np.asarray(np.linalg.inv(self.affine), np.float64)
        return inverse

    @cached_property
    def voxel_size(self) -> Array:
        """``(3,)`` mm between voxels along each axis."""
        sizes: Array = np.linalg.norm(self.affine[:3, :3], axis=0)
        return sizes

    @cached_property
    def corners(self) -> Array:
        """``(8, 3)`` mm: corners of the voxels' outer faces."""
        ends = [(-0.5, n - 0.5) for n in self.shape]
        at = np.stack(np.meshgrid(*ends, indexing="ij"), axis=-1).reshape(-1, 3)
        return at @ self.affine[:3, :3].T + self.affine[:3, 3]

    @property
    def center(self) -> Array:
        """``(3,)`` mm: the middle of the image."""
        return self.corners.mean(axis=0)

    def percentiles(self, low: float, high: float, index: int = 0) -> tuple[float, float]:
        """Return two percentiles of a volume's finite numbers other than 0, the background of a head."""
        key = low, high, index
        if key not in self._percentiles:
            self._percentiles[key] = window_of(self.values[..., index], low, high)
        return self._percentiles[key]

    def outside(self, index: int | None = 0) -> float | None:
        """Return the level of a volume's outside; None if there is none. Without index, of the greatest component."""
        if index not in self._outside:
            volume = self.values.max(axis=-1) if index is None else self.values[..., index]
            self._outside[index] = outside_level(volume)
        return self._outside[index]

    def voxel_at(self, position: npt.ArrayLike) -> tuple[int, int, int] | None:
        """Return the voxel that holds a position in mm; None outside of the image."""
        found = self.inverse[:3, :3] @ np.asarray(position, np.float64) + self.inverse[:3, 3]
        i, j, k = (int(n) for n in np.floor(found + 0.5))
        return (i, j, k) if all(0 <= v < n for v, n in zip((i, j, k), self.shape, strict=True)) else None


def as_slice_image(source: Any, name: str | None = None) -> SliceImage:
    """Take an image from any source."""
    if isinstance(source, SliceImage):
        return source
    if isinstance(source, (str, os.PathLike)):
        found = read_fixels(Path(source).expanduser())
        if found is not None:
            return _of_fixels(*found, name)
    image = as_image((source, np.eye(4)) if isinstance(source, np.ndarray) else source)
    values, colours = image.values, False
    if values.dtype.names is not None:
        values = colour_fields(values)
        colours = True
    if values.ndim > 4:  # NIfTI keeps components of vectors on the fifth axis, with one time before them
        values = values.reshape(*values.shape[:3], -1, order="F")
    if values.ndim == 3:
        values = values[..., None]
    if values.dtype.kind == "b":
        values = values.view(np.uint8)
    colours = colours or (values.dtype == np.uint8 and values.ndim == 4 and values.shape[3] in (3, 4))
    return SliceImage(values, image.affine, name or image.name or "image", image.is_labels, bool(colours))


def _of_fixels(fixels: Fixels, affine: Array, own: str, name: str | None) -> SliceImage:
    """Return fixels as an image: how many a voxel has, or the greatest of the numbers that they were opened for."""
    values = fixels.of_grid(None if fixels.shown is None else fixels.numbers(fixels.shown))
    return SliceImage(values[..., None], np.asarray(affine, np.float64), name or own, fixels=fixels)


def outside_level(values: Array) -> float | None:
    """Return the level that noise around a head stays below, from the twelve edges of an image.

    Tissue may touch faces of an image, as a neck does, but seldom its edges. None if nothing is dark there.
    """
    parts = []
    for axis in range(3):
        across, down = (one for one in range(3) if one != axis)
        for first in (False, True):
            for second in (False, True):
                at: list[slice] = [slice(None)] * 3
                for one, last in ((across, first), (down, second)):
                    thick = max(1, values.shape[one] // BAND)
                    at[one] = slice(-thick, None) if last else slice(thick)
                parts.append(values[tuple(at)].ravel())
    edges = np.concatenate(parts).astype(np.float64)
    edges = edges[np.isfinite(edges)]
    if not len(edges):
        return None
    middle, high = np.percentile(edges, (50.0, 99.0))
    level = float(middle + 2.0 * (high - middle))  # of Rayleigh's noise, one voxel in 100,000 is above
    low, top = window_of(values, 1.0, 99.0)
    return level if level <= low + SIGNAL * (top - low) else None


def window_of(values: Array, low: float, high: float) -> tuple[float, float]:
    """Return two percentiles of an image's finite numbers other than 0, the background of a head."""
    flat = values.ravel(order="K")
    flat = flat[:: max(1, flat.size // SAMPLED)].astype(np.float64)
    flat = flat[np.isfinite(flat)]
    found = flat[flat != 0.0] if (flat != 0.0).any() else flat
    a, b = (float(v) for v in np.percentile(found, (low, high))) if len(found) else (0.0, 1.0)
    if not a < b:  # one number throughout, as masks have: nothing is below it
        a, b = min(a, 0.0), max(b, 0.0)
        b = b if a < b else a + 1.0
    return a, b
