"""The parcels of an atlas that streamlines connect."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ...images.sources import as_image
from ..selection.endpoints import end_points

if TYPE_CHECKING:
    from ...codec.fibletset import FibletSet


def end_parcels(fiblets: FibletSet, atlas: Any, names: Mapping[int, str] | None = None) -> npt.NDArray[np.str_]:
    """Return the names of the two parcels in which each streamline ends, in either order.

    Parameters
    ----------
    fiblets : FibletSet
        Of each streamline only the last fiblet is decoded.
    atlas : image
        Whole numbers ``(i, j, k)``, 0 for no parcel: a path, an image of nibabel, ``(array, affine)`` or an ImageData.
        A point has the number of the voxel that it lies in.
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
        If the atlas is not an image.
    ValueError
        If it has other than three axes, or fractions, or an affine that flattens space.
    """
    image = as_image(atlas, "the atlas")
    labels, inverse = image.labels, image.inverse
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
