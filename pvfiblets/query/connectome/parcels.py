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
    from ...streamlines import Streamlines


def end_parcels(
    data: FibletSet | Streamlines, atlas: Any, names: Mapping[int, str] | None = None
) -> npt.NDArray[np.str_]:
    """Return the names of the two parcels that each streamline connects.

    Parameters
    ----------
    data : FibletSet or Streamlines
        The tractogram. Only the last fiblet of each streamline is decoded.
    atlas : image
        Whole numbers ``(i, j, k)``, 0 for no parcel: a path, an image of nibabel, ``(array, affine)`` or an ImageData.
        The parcel of an end is that of its voxel.
    names : mapping of int to str, optional
        Names of the parcels; others are named by their number.

    Returns
    -------
    numpy.ndarray
        ``(n_streamlines,)`` text such as ``"3 - 17"``, the lower number first; empty if an end lies in no parcel.
        As ``scalars``, each pair is a category with its own colour.

    Raises
    ------
    TypeError
        If the atlas is not an image.
    ValueError
        If the atlas does not have three axes, holds fractions, or has a singular affine.
    """
    image = as_image(atlas, "the atlas")
    labels, inverse = image.labels, image.inverse
    ends = end_points(data).reshape(-1, 3)
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
