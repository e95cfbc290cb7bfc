"""Axes of vectors and tensors of images: the scanner's, or FSL's."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from pvfiblets.slices.image import SliceImage

Array = npt.NDArray[np.float64]

AXES = ("scanner", "fsl")


def check_axes(vectors: str) -> str:
    """Return a word of `AXES`; ValueError for others."""
    if vectors not in AXES:
        raise ValueError(f"vectors is {vectors!r}; choose 'scanner' (right, front, up) or 'fsl' (as of FSL's dtifit)")
    return vectors


def fsl_axes(affine: npt.ArrayLike) -> Array:
    """Return FSL's axes as columns ``(3, 3)``: the image's, the first reversed if the determinant is above 0."""
    linear = np.asarray(affine, np.float64)[:3, :3]
    axes: Array = linear / np.linalg.norm(linear, axis=0)
    axes[:, 0] *= -1.0 if np.linalg.det(linear) > 0.0 else 1.0
    return axes


def in_scanner_axes(image: SliceImage, vectors: str) -> SliceImage:
    """Return an image of vectors, three numbers each, whose parts point to the right, to the front and up."""
    if check_axes(vectors) == "scanner":
        return image
    if image.n_volumes % 3:
        raise ValueError(f"{image.name} has {image.n_volumes} numbers per voxel; vectors are three each")
    kind = np.result_type(image.values.dtype, np.float32)
    parts = image.values.reshape(*image.shape, -1, 3).astype(kind)
    turned = (parts @ fsl_axes(image.affine).T.astype(kind)).reshape(image.values.shape)
    return replace(image, values=turned, is_colours=False, _percentiles={})
