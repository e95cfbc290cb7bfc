"""Label volumes as regions: the voxels of a segmentation that hold chosen labels."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ...images.affines import affine as checked
from ...images.affines import invert_affine
from ...images.image import three_axes
from .placement import Bounds
from .shapes import LABELS, Shape

if TYPE_CHECKING:
    from .fields import Field
    from .surfaces import Mesh

Array = npt.NDArray[np.float64]
Flags = npt.NDArray[np.bool_]


class Volume:
    """Chosen voxels, and data derived from them at first use."""

    def __init__(self, mask: Flags, to_mm: Array) -> None:
        self.mask = mask  # `(i, j, k)` bool
        self.mask.flags.writeable = False
        self.to_mm = to_mm  # `(4, 4)` voxel to mm
        chosen = [np.nonzero(mask.any(axis=tuple({0, 1, 2} - {axis})))[0] for axis in range(3)]
        self.low = np.array([float(n[0]) for n in chosen])
        self.high = np.array([float(n[-1]) for n in chosen])

    @cached_property
    def field(self) -> Field:
        """Signed distance bounds at voxel centres."""
        from .fields import label_field

        return label_field(self.mask, self.to_mm[:3, :3])

    @cached_property
    def faces(self) -> tuple[Array, npt.NDArray[np.int64]]:
        """Faces between a chosen voxel and another: points (n, 3) in voxel coordinates, and triangles (m, 3)."""
        padded = np.pad(self.mask, 1)
        quads = []
        for axis in range(3):
            low = [slice(None)] * 3
            high = [slice(None)] * 3
            low[axis], high[axis] = slice(None, -1), slice(1, None)
            change = np.argwhere(padded[tuple(low)] != padded[tuple(high)]).astype(np.float64) - 1.0
            change[:, axis] += 0.5
            one, other = np.eye(3)[[i for i in range(3) if i != axis]] / 2
            quads.append(change[:, None] + np.stack([-one - other, one - other, one + other, other - one]))
        points = np.concatenate(quads).reshape(-1, 3)
        corner = 4 * np.arange(len(points) // 4)[:, None]
        return points, np.concatenate([corner + (0, 1, 2), corner + (0, 2, 3)])


class Labels(Shape):
    """The voxels of a label volume with chosen labels; a position has the label of its nearest voxel.

    Parameters
    ----------
    volume : array_like
        ``(i, j, k)`` integers, or bool. Of floats, NaN is no label.
    affine : array_like
        ``(4, 4)``: voxel (i, j, k), whose centre is at integers, to mm.
    labels : int or sequence of int, optional
        Labels of the region; all except 0 by default.

    Raises
    ------
    ValueError
        If the volume does not have three axes, is empty or has none of the labels, or the affine is singular.

    Notes
    -----
    Positions outside the volume are outside the region. The nearest voxel of ``v`` is ``floor(v + 0.5)``.
    """

    def __init__(self, volume: npt.ArrayLike, affine: npt.ArrayLike, labels: npt.ArrayLike | None = None) -> None:
        values = three_axes(volume)
        if values.ndim != 3 or not values.size or values.dtype.kind not in "biuf":
            raise ValueError(
                f"the volume has shape {values.shape} and type {values.dtype}; give (i, j, k) integers, one time step"
            )
        given = checked(affine, "affine")
        inverse = invert_affine(given, "affine")
        self._volume = Volume(_chosen(values, labels), given)
        self._baked: Mesh | None = None
        super().__init__(LABELS, inverse[:3, :3], given[:3, 3])

    @property
    def mask(self) -> Flags:
        """``(i, j, k)`` bool: voxels that are in."""
        return self._volume.mask

    @property
    def field(self) -> Field:
        """Signed distance bounds at voxel centres, made when first asked for and shared by moved copies."""
        return self._volume.field

    @property
    def _data(self) -> object:
        return self._volume

    def _shared(self) -> dict[str, Any]:
        return {"_volume": self._volume, "_baked": None}

    def holds(self, points: Array) -> Flags:
        """See :meth:`.Shape.holds`."""
        from .field_kernels import look_up

        found = np.empty(len(points), np.bool_)
        look_up(self.mask, self._linear, self._centre, np.ascontiguousarray(points), found)
        return found

    def spans(self, a: Array, b: Array) -> tuple[npt.NDArray[np.int64], Array]:
        """See :meth:`.Shape.spans`."""
        from .segment_kernels import label_spans
        from .segments import counted_spans

        return counted_spans(label_spans, (self.mask, self._linear, self._centre), a, b)

    def apart(self, points: Array) -> Array:
        """Exact up to rounding, under any matrix: to the nearest chosen voxel's box."""
        from .surfaces import Mesh

        if self._baked is None:
            corners, triangles = self._volume.faces
            self._baked = Mesh(corners @ np.linalg.inv(self._linear).T + self._centre, triangles)
        found = np.zeros(len(points))
        outside = ~self.holds(points)
        found[outside] = self._baked.distances(points[outside])
        return found

    def extents(self) -> tuple[Bounds, Bounds]:
        """See :meth:`.Shape.extents`."""
        edges = np.linalg.inv(self._linear)
        middle = edges @ ((self._volume.low + self._volume.high) / 2) + self._centre
        reach = np.abs(edges) @ ((self._volume.high - self._volume.low + 1.0) / 2)
        return Bounds(middle - reach, middle + reach), Bounds.everything()

    def __repr__(self) -> str:
        return f"Labels(<{' x '.join(map(str, self.mask.shape))}, {int(self.mask.sum())} voxels in>)"


def _chosen(values: npt.NDArray[Any], labels: npt.ArrayLike | None) -> Flags:
    if labels is None:
        found: Flags = (values != 0) & (values == values)
        if not found.any():
            raise ValueError("no voxel of the volume is chosen: all are 0; give a volume with labels")
        return np.ascontiguousarray(found)
    wanted = np.atleast_1d(np.asarray(labels)).ravel()
    if wanted.size == 0 or wanted.dtype.kind not in "biuf":
        raise ValueError(f"labels are {wanted.tolist()}; give one label, or several")
    found = np.isin(values, wanted)
    if not found.any():
        there = np.unique(values[values == values])
        some = ", ".join(str(n) for n in there[:20].tolist()) + (", …" if len(there) > 20 else "")
        raise ValueError(f"no voxel has a label of {wanted.tolist()}; there are {some}")
    return np.ascontiguousarray(found)
