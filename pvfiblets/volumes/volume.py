"""The volume that rays are cast through: numbers on a regular grid, and where it lies."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from pvfiblets.support.value_reference import relative, value_reference

FILTERS = ("nearest", "trilinear", "tricubic")  # reconstructions of the field between voxel centres

KEPT = (np.uint8, np.uint16, np.int16, np.float32)
WIDENED = {"b1": np.uint8, "i1": np.int16, "f2": np.float32}
SINGULAR = 1e-12  # an affine whose columns span less than this part of their lengths' product flattens space
SPAN = (1e-28, 1e38)
"""Between which the values' range must lie: differences of values, and products with them, are taken in float32, which
ends at 3.4e38 and has few digits, or none on GPUs, below 1.2e-38."""

Array = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class RaycastVolume:
    """Numbers at the nodes of a regular grid, and the field between them.

    The field is defined on the box of the voxel centres, ``[0, n - 1]`` voxels along each axis, as VTK's volume mappers
    have it, by one of the filters `FILTERS`: that of the nearest voxel (a tie goes to the higher index), trilinear, or
    tricubic: Catmull-Rom's cubic along each axis, which goes through the voxels and, but for the outermost cells, where
    the last voxel is repeated, is exact for quadratic fields.

    Two volumes are the same only if they are one object: make another one to have a changed array looked at again.

    Parameters
    ----------
    values : array_like
        ``(nx, ny, nz)`` numbers. uint8, uint16, int16 and float32 are kept as they are, memory maps included; bool
        becomes uint8, int8 int16, and everything else float32. For values far from 0 for their range,
        as 1e8 to 1e8 + 100, `offset` is subtracted first: true numbers are `values` plus `offset`. Not to be changed
        afterwards. NaN counts as the least value and infinities as the nearest finite one: `values` of the
        volume holds those instead (a copy, where there are any), so that they are all finite.
    affine : array_like, optional
        ``(4, 4)`` voxel indices, whole at the voxels' centres as in NIfTI, to mm; may be oblique. Default: identity.
    name : str, default: 'values'
        Of the numbers, for people.
    colours : numpy.ndarray, optional
        ``(nx, ny, nz, 3)`` uint8, the voxels' own RGB: `values` are then alpha, and light has these colours.
    offset : float, default: 0.0
        What `values` are less than the true numbers by; of values that are stored as they are, as was given.

    Raises
    ------
    ValueError
        If there are other than three axes or one has fewer than two voxels, if the numbers are complex or structured or
        they or their range do not fit float32, or if the affine is not a finite, invertible ``(4, 4)`` matrix that ends
        in (0, 0, 0, 1).
    """

    values: npt.NDArray[Any]
    affine: Array = None  # type: ignore[assignment]
    name: str = field(default="values", kw_only=True)
    colours: npt.NDArray[np.uint8] | None = field(default=None, kw_only=True)
    offset: float = field(default=0.0, kw_only=True)
    inverse: Array = field(init=False, repr=False)  # (4, 4) mm to voxel indices
    missing: npt.NDArray[np.bool_] | None = field(init=False, repr=False)  # (nx, ny, nz) where NaN was; None: nowhere

    def __post_init__(self) -> None:
        values, offset = _checked_values(self.values)
        affine, inverse = _checked_affine(self.affine)
        values, missing = _finite(values)
        if self.colours is not None and (self.colours.shape != (*values.shape, 3) or self.colours.dtype != np.uint8):
            raise ValueError(
                f"the voxels' colours have the shape {self.colours.shape} and the type {self.colours.dtype}; expected "
                f"{(*values.shape, 3)} and uint8"
            )
        object.__setattr__(self, "values", values)
        object.__setattr__(self, "offset", self.offset + offset)
        object.__setattr__(self, "missing", missing)
        object.__setattr__(self, "affine", affine)
        object.__setattr__(self, "inverse", inverse)

    @property
    def shape(self) -> tuple[int, int, int]:
        """Voxels along each axis."""
        nx, ny, nz = self.values.shape
        return nx, ny, nz

    @property
    def dims(self) -> tuple[int, int, int]:
        """The same, by VTK's name for it."""
        return self.shape

    @property
    def n_points(self) -> int:
        """Voxels."""
        return self.values.size

    @property
    def n_streamlines(self) -> int:
        """One: colours by streamline mean nothing to a volume."""
        return 1

    @property
    def promise(self) -> float:
        """Nothing lies outside the bounds."""
        return 0.0

    @property
    def nbytes(self) -> int:
        """Bytes of the voxels."""
        return self.values.nbytes + (0 if self.colours is None else self.colours.nbytes)

    @cached_property
    def n_missing(self) -> int:
        """Voxels that were NaN."""
        return 0 if self.missing is None else int(np.count_nonzero(self.missing))

    @cached_property
    def value_range(self) -> tuple[float, float]:
        """Least and greatest finite number, `offset` included; (0, 0) where there is none."""
        low, high = _range(self.values)
        return low + self.offset, high + self.offset

    @property
    def numbers(self) -> npt.NDArray[Any]:
        """``(nx, ny, nz)`` true numbers: `values`, or a copy in float64 plus `offset`, and with NaN where it was."""
        values = self.values.astype(np.float64) + self.offset if self.offset else self.values
        return values if self.missing is None else np.where(self.missing, np.float32(np.nan), values)

    def value_reference(self, name: Any = None) -> float:  # noqa: ARG002 - of other drawables
        """Return `offset`: the number to subtract from values on the graphics card."""
        return self.offset

    @cached_property
    def least_positive(self) -> float:
        """Least value above 0, where a logarithmic scale may begin; 1e-6 where there is none."""
        least = -self.offset
        found = [float(slab[slab > least].min()) + self.offset for slab in _slabs(self.values) if (slab > least).any()]
        return min(found, default=1e-6)

    @cached_property
    def spacing(self) -> Array:
        """``(3,)`` mm between neighbouring voxel centres along each axis of the grid."""
        return np.linalg.norm(self.affine[:3, :3], axis=0)

    @cached_property
    def diagonal(self) -> float:
        """The longest way through the volume, mm, or a little more."""
        return float(np.linalg.norm(np.abs(self.affine[:3, :3]) @ np.array(self.shape, np.float64)))

    @cached_property
    def bounds(self) -> tuple[float, float, float, float, float, float]:
        """(xmin, xmax, ymin, ymax, zmin, zmax) of the outermost voxels' centres, mm."""
        ends = np.stack(np.meshgrid(*[(0.0, n - 1.0) for n in self.shape], indexing="ij"), axis=-1).reshape(-1, 3)
        corners = ends @ self.affine[:3, :3].T + self.affine[:3, 3]
        x, y, z = zip(corners.min(axis=0).tolist(), corners.max(axis=0).tolist(), strict=True)
        return (*x, *y, *z)


def _checked_values(given: Any) -> tuple[npt.NDArray[Any], float]:
    """Numbers of a supported type, on three axes, and the subtracted reference; still with NaN and infinities."""
    values = np.asarray(given)  # of a memory map still only a view
    if values.dtype.names is not None:
        what = ", ".join(values.dtype.names)
        raise ValueError(f"the volume's voxels hold the fields {what}; one number each is needed: take one field of it")
    if values.dtype.kind not in "buif":
        raise ValueError(f"the volume is of type {values.dtype}; give bool, integers or floats")
    if values.ndim != 3:
        hint = ", such as image[..., 0]" if values.ndim > 3 else ""
        raise ValueError(f"the volume has the shape {values.shape}; give three axes (nx, ny, nz){hint}")
    if values.size == 0:
        raise ValueError(f"the volume has the shape {values.shape} and so no voxels; give some")
    if min(values.shape) < 2:
        raise ValueError(
            f"the volume has the shape {values.shape}, a 2-D image; rays need two voxels or more along each axis: "
            "repeat the slice, or show it as a picture"
        )
    native = values.dtype.newbyteorder("=")
    if native.type in KEPT:
        return values.astype(native, copy=False), 0.0
    if native.str[1:] in WIDENED:
        return values.astype(WIDENED[native.str[1:]]), 0.0
    return _as_floats(values)


def _as_floats(values: npt.NDArray[Any]) -> tuple[npt.NDArray[np.float32], float]:
    """Wider numbers less an offset as float32, if it can hold them, and the offset."""
    offset = value_reference(values)
    with np.errstate(over="ignore", under="ignore"):
        floats = (relative(values, offset) if offset else values).astype(np.float32)
    low, high = _range(values)
    limit = float(np.finfo(np.float32).max)
    if not -limit <= low <= high <= limit:
        raise ValueError(f"the volume's values run from {low:g} to {high:g}, beyond float32's {limit:g}: scale them")
    return floats, offset


def _finite(values: npt.NDArray[Any]) -> tuple[npt.NDArray[Any], npt.NDArray[np.bool_] | None]:
    """The values with all that are not finite replaced, and where NaN was; unchanged where all are finite."""
    if values.dtype.kind != "f":
        return values, None
    with np.errstate(invalid="ignore"):
        ends = [(float(slab.min()), float(slab.max())) for slab in _slabs(values)]  # NaN where there is any
    whole = bool(np.isfinite(ends).all())
    low, high = np.min(ends), np.max(ends)
    if not whole:
        low, high = _range(values)
    if low < high and not SPAN[0] <= high - low <= SPAN[1]:
        raise ValueError(
            f"the volume's values run from {low:g} to {high:g}, a range that float32, in which rays are cast, cannot "
            f"compute with: scale them to one between {SPAN[0]:g} and {SPAN[1]:g}"
        )
    if whole:
        return values, None
    missing = np.isnan(values)
    return np.nan_to_num(values, copy=True, nan=low, posinf=high, neginf=low), missing if missing.any() else None


def _range(values: npt.NDArray[Any]) -> tuple[float, float]:
    """Least and greatest finite value, slab by slab to avoid a copy; (0, 0) without any."""
    low, high = np.inf, -np.inf
    for slab in _slabs(values):
        finite = slab[np.isfinite(slab)] if slab.dtype.kind == "f" else slab
        if finite.size:
            low, high = min(low, float(finite.min())), max(high, float(finite.max()))
    return (low, high) if low <= high else (0.0, 0.0)


def _slabs(values: npt.NDArray[Any]) -> Iterator[npt.NDArray[Any]]:
    """Slices of the array that each lie together in memory."""
    yield from np.moveaxis(values, int(np.argmax(np.abs(values.strides))), 0)


def _checked_affine(given: Any) -> tuple[Array, Array]:
    """The affine and its inverse, not to be written to."""
    affine = np.eye(4) if given is None else np.array(given, np.float64)
    if affine.shape != (4, 4) or not np.isfinite(affine).all() or not np.array_equal(affine[3], (0, 0, 0, 1)):
        raise ValueError(
            f"the volume's affine is {affine.tolist()}; give a finite (4, 4) matrix from voxels to mm that ends in the "
            "row (0, 0, 0, 1)"
        )
    lengths = np.linalg.norm(affine[:3, :3], axis=0)
    # Of the columns' directions, so that spacings of 1e-6 mm are no matter.
    if not lengths.all() or abs(np.linalg.det(affine[:3, :3] / lengths)) < SINGULAR:
        raise ValueError(
            f"the volume's affine {affine.tolist()} flattens space (spacing {lengths.tolist()} mm); give an invertible "
            "one, with a spacing above 0"
        )
    inverse = np.asarray(np.linalg.inv(affine), np.float64)
    if not np.isfinite(inverse).all():
        raise ValueError(f"the volume's affine {affine.tolist()} has no finite inverse; give another spacing")
    affine.flags.writeable = inverse.flags.writeable = False
    return affine, inverse
