"""Writing the numbers of a grid as NIfTI, as MRtrix's MIF and as VTK's image."""

from __future__ import annotations

import gzip
from collections.abc import Iterator
from contextlib import contextmanager
from os import PathLike, fspath
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ...support.whole_files import replacing
from .voxel_grid import VoxelGrid

if TYPE_CHECKING:
    import pyvista

NIFTI, MIF, VTI = (".nii", ".nii.gz"), (".mif", ".mif.gz"), (".vti",)
SUFFIXES = (*NIFTI, *MIF, *VTI)
NIFTI1_MOST = 32767  # voxels along an axis that a NIfTI-1 header can name

Array = npt.NDArray[np.float64]


def check_suffix(path: str | PathLike[str]) -> str:
    """Return the suffix of a file that can be written; ValueError for others."""
    lower = fspath(path).lower()
    found = max((one for one in SUFFIXES if lower.endswith(one)), key=len, default=None)
    if found is None:
        raise ValueError(f"{fspath(path)} is no name of an image; let it end in {', '.join(SUFFIXES)}")
    return found


def write_map(path: str | PathLike[str], values: npt.NDArray[Any], grid: VoxelGrid, name: str) -> None:
    """Write numbers ``(nx, ny, nz, ...)`` of a grid; the file appears under its name when it is whole."""
    suffix = check_suffix(path)
    if suffix in NIFTI:
        _write_nifti(path, values, grid, name)
    elif suffix in MIF:
        _write_mif(path, values, grid.affine, name)
    else:
        with replacing(path) as file:
            made = Path(f"{file.name}.vti")
            try:
                image_of(values, grid.affine, name).save(made)
                file.write(made.read_bytes())
            finally:
                made.unlink(missing_ok=True)


def image_of(values: npt.NDArray[Any], affine: Array, name: str) -> pyvista.ImageData:
    """Return numbers ``(i, j, k, ...)`` as an image whose points are the voxels' centres, where an affine puts them."""
    import pyvista

    image = pyvista.ImageData(dimensions=values.shape[:3])
    spacing = np.linalg.norm(affine[:3, :3], axis=0)
    image.origin, image.spacing = affine[:3, 3], spacing
    image.direction_matrix = affine[:3, :3] / spacing
    image.point_data[name] = values.reshape(-1, *values.shape[3:], order="F")
    image.set_active_scalars(name)
    return image


@contextmanager
def _opened(path: str | PathLike[str]) -> Iterator[IO[bytes]]:
    with replacing(path) as file:
        if not fspath(path).lower().endswith(".gz"):
            yield file
            return
        with gzip.GzipFile("", "wb", 6, file, mtime=0) as packed:
            yield packed  # type: ignore[misc]


def _write_nifti(path: str | PathLike[str], values: npt.NDArray[Any], grid: VoxelGrid, name: str) -> None:
    import nibabel

    kinds = nibabel.Nifti1Image if max(grid.shape) <= NIFTI1_MOST else nibabel.Nifti2Image
    image = kinds(values, grid.affine, dtype=values.dtype)
    image.set_sform(grid.affine, grid.space_code)
    image.set_qform(grid.affine, grid.space_code if _is_rigid(grid.affine) else 0)  # a quaternion holds no shear
    image.header.set_xyzt_units("mm")
    image.header["descrip"] = f"pvfiblets: {name}".encode()[:79]
    with _opened(path) as file:
        image.to_stream(file)


def _write_mif(path: str | PathLike[str], values: npt.NDArray[Any], affine: Array, name: str) -> None:
    """Write a header and the numbers, the first axis running fastest."""
    sizes = np.linalg.norm(affine[:3, :3], axis=0)
    rows = np.column_stack([affine[:3, :3] / sizes, affine[:3, 3]])
    data = np.asarray(values, values.dtype.newbyteorder("<"))
    kinds = {"i": "Int", "u": "UInt", "f": "Float"}
    bits = 8 * data.dtype.itemsize
    if data.dtype.kind not in kinds or data.dtype == np.float16:
        raise ValueError(f"{fspath(path)}: MIF has no {data.dtype}; give dtype='float32' or an integer type")
    lines = [
        "mrtrix image",
        f"dim: {','.join(map(str, data.shape))}",
        f"vox: {','.join([*(repr(float(size)) for size in sizes), *['nan'] * (data.ndim - 3)])}",
        f"layout: {','.join(f'+{axis}' for axis in range(data.ndim))}",
        f"datatype: {kinds[data.dtype.kind]}{bits}{'LE' if bits > 8 else ''}",
        *(f"transform: {','.join(repr(float(part)) for part in row)}" for row in rows),
        f"comments: pvfiblets: {' '.join(name.split())}",
    ]
    text = "\n".join(lines)
    start = len(text.encode()) + 40
    start += -start % 4
    head = f"{text}\nfile: . {start}\nEND\n".encode()
    with _opened(path) as file:
        file.write(head.ljust(start, b"\0"))
        file.write(data.tobytes(order="F"))


def _is_rigid(affine: Array) -> bool:
    """Whether an affine's axes stand at right angles."""
    axes = affine[:3, :3] / np.linalg.norm(affine[:3, :3], axis=0)
    return bool(np.abs(axes.T @ axes - np.eye(3)).max() < 1e-6)
