"""Which parcels of an atlas streamlines connect."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ...support.nifti_space import affine_of
from ..measures.image_samples import three_axes
from ..selection.endpoints import end_points

if TYPE_CHECKING:
    from ...codec.fibletset import FibletSet

__all__ = ["end_parcels", "read_atlas"]


def end_parcels(
    fiblets: FibletSet, atlas: Any, names: Mapping[int, str] | None = None
) -> npt.NDArray[np.str_]:
    """Name the two parcels in which each streamline ends, whichever end comes first.

    Parameters
    ----------
    fiblets : FibletSet
        Of each streamline only the last fiblet is decoded.
    atlas : nibabel image, path of one, or (array, affine)
        Whole numbers ``(i, j, k)``, 0 for no parcel, and the ``(4, 4)`` matrix from voxel indices to mm. A point has
        the number of the voxel that it lies in.
    names : mapping of int to str, optional
        Of the parcels; those without one are called by their number.

    Returns
    -------
    numpy.ndarray
        ``(n_streamlines,)`` text such as ``"3 - 17"``, the lower number first; empty where an end lies in no parcel.
        Given as ``scalars``, each pair is a category with a colour of its own.

    Raises
    ------
    TypeError
        If the atlas is something else.
    ValueError
        If it has other than three axes, or fractions, or an affine that flattens space.
    """
    labels, affine = read_atlas(atlas)
    inverse = np.linalg.inv(affine)
    ends = end_points(fiblets).reshape(-1, 3)
    at = np.rint(ends @ inverse[:3, :3].T + inverse[:3, 3])  # NaN of streamlines without points stays
    inside = ((at >= 0) & (at < labels.shape)).all(axis=1)
    found = np.zeros(len(ends), np.int64)
    found[inside] = labels[tuple(at[inside].astype(np.int64).T)]
    pairs = np.sort(found.reshape(-1, 2), axis=1)
    known, which = np.unique(pairs, axis=0, return_inverse=True)
    called = {int(number): str(name) for number, name in (names or {}).items()}
    words = [" - ".join(called.get(number, str(number)) for number in pair) for pair in known.tolist()]
    texts = np.array(["" if 0 in pair else word for pair, word in zip(known.tolist(), words, strict=True)], dtype=str)
    return texts[which.ravel()] if len(texts) else np.zeros(0, dtype=str)


def read_atlas(given: Any) -> tuple[npt.NDArray[Any], npt.NDArray[np.float64]]:
    """Return labels ``(i, j, k)`` and the ``(4, 4)`` matrix from their indices to mm."""
    if isinstance(given, (str, os.PathLike)):
        import nibabel

        given = nibabel.load(Path(given).expanduser())
    if hasattr(given, "dataobj") and hasattr(given, "affine"):
        given = np.asanyarray(given.dataobj), affine_of(given)
    if not isinstance(given, (tuple, list)) or len(given) != 2:
        raise TypeError(f"atlas is a {type(given).__name__}; give a NIfTI image, its path, or (array, affine)")
    labels, affine = three_axes(given[0]), np.asarray(given[1], np.float64)
    if labels.ndim != 3:
        raise ValueError(f"the atlas has shape {labels.shape}; give whole numbers on three axes (i, j, k)")
    if labels.dtype.kind not in "bui" and not bool((labels == np.rint(labels)).all()):
        raise ValueError("the atlas holds fractions; give whole numbers, one for each parcel")
    if affine.shape != (4, 4) or not np.isfinite(affine).all() or abs(np.linalg.det(affine)) == 0.0:
        raise ValueError(f"the atlas's affine is {affine.tolist()}; give an invertible (4, 4) matrix from voxels to mm")
    return labels, affine
