"""Glyphs of the voxels that a plane goes through: lines of peaks and fixels, ellipsoids, lobes of harmonics."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from pvfiblets.slices.image import SliceImage
from pvfiblets.slices.spherical_harmonics import degrees, sh_matrix
from pvfiblets.slices.vectors import check_axes, fsl_axes

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

KINDS = ("peaks", "tensor", "sh", "fixels")
LINES = ("peaks", "fixels")  # kinds that are drawn as lines

TENSORS = {
    "mrtrix": (0, 3, 4, 3, 1, 5, 4, 5, 2), "dipy": (0, 1, 3, 1, 2, 4, 3, 4, 5), "fsl": (0, 1, 2, 1, 3, 4, 2, 4, 5),
}  # fmt: skip
"""Parts of the matrix in six volumes, row by row, by program."""


@dataclass(frozen=True, eq=False)
class Glyphs:
    """Points of all glyphs of a plane, and their colours."""

    points: Array  # `(n, m, 3)` mm: m points of each of n glyphs
    colours: npt.NDArray[np.uint8]  # `(n, m, 3)` uint8: directions to the right, front and up as red, green and blue


def axes_of_glyphs(kind: str, tensor: str, vectors: str | None) -> str:
    """Return the axes of peaks and tensors: FSL's for tensors in FSL's order, else the scanner's, unless given."""
    if vectors is None:
        return "fsl" if kind == "tensor" and tensor == "fsl" else "scanner"
    if check_axes(vectors) != "scanner" and kind not in ("peaks", "tensor"):
        raise ValueError(f"vectors is of peaks and tensors, but kind is {kind!r}; leave it out")
    return vectors


def check_glyphs(image: SliceImage, kind: str, basis: str, full: bool, tensor: str) -> None:
    """Refuse an image that does not hold such glyphs."""
    n = image.n_volumes
    if kind not in KINDS:
        raise ValueError(f"kind is {kind!r}; choose one of {KINDS}")
    if kind == "fixels" and image.fixels is None:
        raise ValueError(f"{image.name} has no fixels; give a fixel directory of MRtrix, or one of its files")
    if kind == "peaks" and n % 3:
        raise ValueError(f"{image.name} has {n} numbers per voxel; peaks are three each")
    if kind == "tensor" and n != 6:
        raise ValueError(f"{image.name} has {n} numbers per voxel; a tensor has 6")
    if tensor not in TENSORS:
        raise ValueError(f"tensor is {tensor!r}; choose one of {tuple(TENSORS)}")
    if kind == "sh":
        sh_matrix([(0.0, 0.0, 1.0)], degrees(n, full), basis, full)


def voxels_on_plane(image: SliceImage, position: Array, normal: Array) -> Ints:
    """Return ``(n, 3)`` the voxels nearest to a plane: along a grid's axis one layer, not all zero and all finite."""
    # For fixels, voxels with any.
    step = image.affine[:3, :3].T @ normal
    start = float((image.affine[:3, 3] - position) @ normal)
    thick = float(abs(step).max())
    i, j, k = (np.arange(n, dtype=np.float64) * part for n, part in zip(image.shape, step, strict=True))
    away = (start + i)[:, None, None] + j[None, :, None] + k[None, None, :]
    # The lower face belongs to a voxel and the upper one to the next; digits beyond the ninth decide nothing.
    share = np.round(away / thick, 9)
    at = np.argwhere((share > -0.5) & (share <= 0.5))
    if image.fixels is not None:
        return at[image.fixels.counts[tuple(at.T)] > 0]
    values = image.values[tuple(at.T)]
    return at[np.isfinite(values).all(axis=1) & (values != 0).any(axis=1)]


def _centres(image: SliceImage, voxels: Ints) -> Array:
    return voxels @ image.affine[:3, :3].T + image.affine[:3, 3]


def _reach(image: SliceImage) -> float:
    """Return half the smallest side of a voxel, mm."""
    return 0.5 * float(image.voxel_size.min())


def _of_direction(directions: Array) -> npt.NDArray[np.uint8]:
    length = np.linalg.norm(directions, axis=-1, keepdims=True)
    unit = np.divide(directions, length, out=np.zeros_like(directions), where=length > 0.0)
    return np.rint(255.0 * abs(unit)).astype(np.uint8)


def _normalised(radii: Array, each: bool) -> Array:
    """Return lengths per the greatest of each glyph, or of all, ``(n, m)``."""
    top = radii.max(axis=1, keepdims=True) if each else np.full((len(radii), 1), radii.max(initial=0.0))
    return np.divide(radii, top, out=np.zeros_like(radii), where=top > 0.0)


def lines_of_peaks(image: SliceImage, voxels: Ints, size: float, longest: float | None) -> Glyphs:
    """Return two ends of each peak; zero and NaN peaks are left out."""
    vectors = image.values[tuple(voxels.T)].astype(np.float64).reshape(len(voxels), -1, 3)
    length = np.linalg.norm(vectors, axis=-1)
    which, peak = np.nonzero(length > 0.0)
    vectors, length = vectors[which, peak], length[which, peak]
    half = vectors * (size * _reach(image) / (length if longest is None else np.full_like(length, longest)))[:, None]
    middle = _centres(image, voxels[which])
    points = np.stack([middle - half, middle + half], axis=1)
    return Glyphs(points, np.repeat(_of_direction(vectors)[:, None], 2, axis=1))


def lines_of_fixels(
    image: SliceImage, voxels: Ints, size: float, lengths: npt.NDArray[np.float32] | None, longest: float
) -> tuple[Glyphs, Ints]:
    """Return two ends of each fixel of some voxels, coloured by direction, and the numbers ``(k,)`` of the fixels."""
    assert image.fixels is not None
    fixels, which = image.fixels.of_voxels(voxels)
    share = np.ones(len(fixels)) if lengths is None else lengths[fixels].astype(np.float64) / longest
    directions = image.fixels.directions[fixels].astype(np.float64)
    norm = np.linalg.norm(directions, axis=1, keepdims=True)
    there = (share > 0.0) & np.isfinite(share) & (norm > 0.0).all(axis=1)
    fixels, which, share, directions = fixels[there], which[there], share[there], directions[there]
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    half = directions * (size * _reach(image) * share)[:, None]
    middle = _centres(image, voxels[which])
    points = np.stack([middle - half, middle + half], axis=1)
    return Glyphs(points, np.repeat(_of_direction(directions)[:, None], 2, axis=1)), fixels


def ellipsoids(
    image: SliceImage, voxels: Ints, sphere: Array, size: float, each: bool, tensor: str, vectors: str | None = None
) -> Glyphs:
    """Return a unit sphere's points ``(m, 3)`` under each voxel's tensor: half axes are its eigenvalues."""
    values = image.values[tuple(voxels.T)].astype(np.float64)
    matrices = values[:, TENSORS[tensor]].reshape(-1, 3, 3)
    if axes_of_glyphs("tensor", tensor, vectors) == "fsl":
        turn = fsl_axes(image.affine)
        matrices = turn @ matrices @ turn.T
    own, directions = np.linalg.eigh(matrices)
    own = np.maximum(own, 0.0)  # noise makes eigenvalues below 0, which have no extent
    matrices = np.einsum("nij,nj,nkj->nik", directions, own, directions)
    scale = _normalised(own, each)[:, -1] / np.where(own[:, -1] > 0.0, own[:, -1], 1.0)
    points = np.einsum("nij,mj->nmi", matrices * (scale * size * _reach(image))[:, None, None], sphere)
    colours = np.repeat(_of_direction(directions[:, :, -1])[:, None], len(sphere), axis=1)
    return Glyphs(points + _centres(image, voxels)[:, None], colours)


def lobes(
    image: SliceImage, voxels: Ints, sphere: Array, size: float, each: bool, basis: str, full: bool
) -> Glyphs:
    """Return a unit sphere's points as far out as the function of each voxel is there; below 0 at the middle."""
    matrix = sh_matrix(sphere, degrees(image.n_volumes, full), basis, full)
    radii = np.maximum(image.values[tuple(voxels.T)].astype(np.float64) @ matrix.T, 0.0)
    points = (_normalised(radii, each) * size * _reach(image))[..., None] * sphere + _centres(image, voxels)[:, None]
    return Glyphs(points, np.repeat(_of_direction(sphere)[None], len(voxels), axis=0))
